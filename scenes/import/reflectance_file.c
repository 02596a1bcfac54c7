#include "scenes/import/scene_reading.h"

#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"
#include "scenes/import/scene_value.h"
#include "spectral/dispersion/csv_points.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>

static abbe_result load(const char *path, const char *column, abbe_spectrum **out,
                        abbe_error *error) {
  abbe_csv_points points;
  const abbe_csv_options options = {.quantity = ABBE_CSV_REFLECTANCE, .column = column};
  abbe_result result = abbe_csv_points_load(path, &options, &points, NULL, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < points.power.count && result == ABBE_OK; i++)
    if (points.power.point[i].value > 1)
      result = abbe_error_set(error, ABBE_SCHEMA,
                              "%s: the reflectance at %g nm is %g; it is 0 to 1 (of per cent: "
                              "divide by 100)",
                              path, points.power.point[i].lambda_nm, points.power.point[i].value);
  if (result == ABBE_OK)
    result = abbe_points_spectrum(&points.power, ABBE_INTERPOLATION_LINEAR, out, error);
  abbe_csv_points_free(&points);
  return result;
}

static abbe_result load_file(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                             const char *name, abbe_object *out, abbe_error *error) {
  char *column = NULL;
  abbe_result result = abbe_yaml_get_string(yaml, node, "column", &column, error);
  if (result == ABBE_OK) {
    out->spectrum_path = abbe_scene_value_path(folder, name);
    result = out->spectrum_path ? load(out->spectrum_path, column, &out->spectrum, error)
                                : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result != ABBE_OK)
      abbe_scene_value_locate(yaml, abbe_yaml_get(yaml, node, "spectrum"), result, error);
  }
  free(column);
  return result;
}

/* Its linear Rec.709 under D65, kept within 0 to 1. */
static abbe_result find_colour(abbe_object *out, abbe_error *error) {
  const abbe_illuminant d65 = {0};
  abbe_reflected_light *light = NULL;
  const abbe_result result = abbe_reflected_light_make(&d65, ABBE_WAVELENGTH_MIN_NM,
                                                       ABBE_WAVELENGTH_MAX_NM, &light, error);
  if (result != ABBE_OK) return result;
  double xyz[3][3], matrix[9];
  abbe_reflected_light_xyz(light, out->spectrum, xyz);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz[0], out->reflectance);
  for (int k = 0; k < 3; k++) out->reflectance[k] = fmin(fmax(out->reflectance[k], 0), 1);
  abbe_reflected_light_free(light);
  return ABBE_OK;
}

abbe_result abbe_reflectance_file_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                       abbe_object *out, abbe_error *error) {
  char *patch = NULL, *file = NULL;
  abbe_result result = abbe_yaml_get_string(yaml, node, "patch", &patch, error);
  if (result == ABBE_OK) result = abbe_yaml_get_string(yaml, node, "spectrum", &file, error);
  const bool column = abbe_yaml_get(yaml, node, "column").id != 0;
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "'reflectance'", error);
  if (result == ABBE_OK && ((patch == NULL) == (file == NULL) || (patch != NULL && column)))
    result =
        abbe_yaml_fail(yaml, node, error,
                       "a measured 'reflectance' is either {spectrum: FILE} with a 'column' if "
                       "the file has several, or {patch: NAME} of the ColorChecker");
  if (result == ABBE_OK && file != NULL) result = load_file(yaml, node, folder, file, out, error);
  if (result == ABBE_OK && patch != NULL) {
    result = abbe_colour_checker_make(patch, &out->spectrum, error);
    if (result != ABBE_OK)
      abbe_scene_value_locate(yaml, abbe_yaml_get(yaml, node, "patch"), result, error);
  }
  free(patch);
  free(file);
  return result == ABBE_OK ? find_colour(out, error) : result;
}
