#include "scenes/import/scene_reading.h"

#include "base/maths.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/upsampling.h"
#include "scenes/environment/environment_picture.h"
#include "scenes/import/scene_value.h"

#include <stdlib.h>

enum { LEAST_SIZE = 64, MOST_SIZE = 4096, DEFAULT_SIZE = 1024 };

/* What no colour can be lifted under is refused where it is named. */
static abbe_result read_illuminant(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                   abbe_environment *out, abbe_error *error) {
  abbe_upsampling ignored;
  abbe_result result = abbe_scene_value_illuminant(yaml, node, folder, &out->illuminant,
                                                   &out->illuminant_path, error);
  if (result != ABBE_OK) return result;
  result = abbe_upsampling_make(&out->illuminant, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM,
                                &ignored, error);
  const abbe_yaml_node at = abbe_yaml_get(yaml, node, "illuminant");
  return result == ABBE_OK ? result : abbe_scene_value_locate(yaml, at, result, error);
}

static abbe_result read_turn(abbe_yaml *yaml, abbe_yaml_node node, double to_map[9],
                             abbe_error *error) {
  const abbe_yaml_node tilt = abbe_yaml_get(yaml, node, "tilt");
  double rotate = 0, axis[3] = {0}, angle = 0;
  abbe_yaml_node ignored;
  abbe_result result = abbe_yaml_get_number(yaml, node, "rotate", -3600, 3600, &rotate, error);
  if (result == ABBE_OK && tilt.id) {
    if (!abbe_yaml_is_mapping(yaml, tilt))
      return abbe_yaml_fail(yaml, tilt, error, "'tilt' wants {axis: [x, y, z], angle: degrees}");
    result = abbe_scene_value_point(yaml, tilt, "axis", axis, error);
    if (result == ABBE_OK) result = abbe_yaml_require(yaml, tilt, "angle", &ignored, error);
    if (result == ABBE_OK)
      result = abbe_yaml_get_number(yaml, tilt, "angle", -3600, 3600, &angle, error);
    if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, tilt, "'tilt'", error);
    if (result == ABBE_OK && !abbe_vector_normalise(axis))
      result = abbe_yaml_fail(yaml, tilt, error, "'axis' is zero; it must point somewhere");
  }
  if (result == ABBE_OK)
    abbe_environment_turn(rotate * ABBE_DEGREE, tilt.id ? axis : NULL, angle * ABBE_DEGREE, to_map);
  return result;
}

static abbe_result read_picture(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                abbe_environment *out, abbe_error *error) {
  static const char *const layouts[] = {"latlong", "cube", NULL};
  const abbe_yaml_node file = abbe_yaml_get(yaml, node, "file");
  const abbe_yaml_node size = abbe_yaml_get(yaml, node, "size");
  const bool stated = abbe_yaml_get(yaml, node, "layout").id != 0;
  char *name = NULL;
  int layout = 0;
  if (size.id)
    return abbe_yaml_fail(yaml, size, error,
                          "'size' is for surroundings that are computed; a picture has its own");
  abbe_result result = abbe_yaml_get_string(yaml, node, "file", &name, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_choice(yaml, node, "layout", layouts, &layout, error);
  if (result == ABBE_OK) {
    out->path = abbe_scene_value_path(folder, name);
    result = out->path ? abbe_environment_picture_read(out->path,
                                                       !stated       ? ABBE_LAYOUT_BY_ASPECT
                                                       : layout == 0 ? ABBE_LAYOUT_LATLONG
                                                                     : ABBE_LAYOUT_CUBE,
                                                       &out->map, error)
                       : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result != ABBE_OK) abbe_scene_value_locate(yaml, file, result, error);
    if (out->path != NULL) out->path[abbe_exr_file_length(out->path)] = '\0';
  }
  free(name);
  return result;
}

/* The map of what is computed, black at first. */
static abbe_result read_size(abbe_yaml *yaml, abbe_yaml_node node, abbe_environment *out,
                             abbe_error *error) {
  const abbe_yaml_node layout = abbe_yaml_get(yaml, node, "layout");
  size_t size = DEFAULT_SIZE;
  if (layout.id)
    return abbe_yaml_fail(yaml, layout, error, "'layout' says nothing without a 'file'");
  abbe_result result = abbe_yaml_get_count(yaml, node, "size", LEAST_SIZE, MOST_SIZE, &size, error);
  if (result == ABBE_OK && size % 2 != 0)
    result = abbe_yaml_fail(yaml, abbe_yaml_get(yaml, node, "size"), error,
                            "'size' is the map's width in texels, an even number");
  return result == ABBE_OK ? abbe_radiance_map_make(size, &out->map, error) : result;
}

static abbe_result read_scale(abbe_yaml *yaml, abbe_yaml_node node, abbe_radiance_map *map,
                              abbe_error *error) {
  double scale = 1;
  const abbe_result result =
      abbe_yaml_get_number(yaml, node, "scale", 1e-12, ABBE_SCENE_BRIGHTEST, &scale, error);
  for (size_t i = 0; result == ABBE_OK && scale != 1 && i < 3 * map->width * map->height; i++)
    map->rgb[i] = (float)((double)map->rgb[i] * scale);
  return result;
}

abbe_result abbe_environment_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                  abbe_environment *out, abbe_error *error) {
  size_t sources = 0;
  if (!abbe_yaml_is_mapping(yaml, node))
    return abbe_yaml_fail(yaml, node, error, "'environment' must be a mapping (key: value)");
  const bool file = abbe_yaml_get(yaml, node, "file").id != 0;
  abbe_result result = read_turn(yaml, node, out->to_map, error);
  if (result == ABBE_OK) result = read_illuminant(yaml, node, folder, out, error);
  if (result == ABBE_OK)
    result =
        file ? read_picture(yaml, node, folder, out, error) : read_size(yaml, node, out, error);
  if (result == ABBE_OK)
    result = abbe_environment_read_sources(yaml, node, &out->map, &sources, error);
  if (result == ABBE_OK) result = read_scale(yaml, node, &out->map, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "'environment'", error);
  if (result == ABBE_OK && !file && sources == 0)
    result = abbe_yaml_fail(yaml, node, error,
                            "'environment' has no light: give it a 'file', or one or more of "
                            "uniform, sky, sun, softboxes, spots, dome");
  if (result != ABBE_OK) return result;
  result = abbe_environment_prepare(out, error);
  return result == ABBE_OK ? result : abbe_scene_value_locate(yaml, node, result, error);
}
