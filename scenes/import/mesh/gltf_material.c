#include "scenes/import/mesh/gltf_material.h"

#include "base/file.h"
#include "base/number.h"
#include "scenes/import/mesh/gltf_data.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- one material ---- */

typedef struct reading {
  const char *path, *name;
  abbe_error *error;
} reading;

static abbe_result get(const reading *r, const cJSON *from, const char *key, double least,
                       double most, double *out) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(from, key);
  if (item == NULL) return ABBE_OK;
  if (!cJSON_IsNumber(item) || !(item->valuedouble >= least && item->valuedouble <= most)) {
    char text[ABBE_NUMBER_TEXT_SIZE], low[ABBE_NUMBER_TEXT_SIZE], high[ABBE_NUMBER_TEXT_SIZE];
    return abbe_error_set(
        r->error, ABBE_SCHEMA, "%s: material '%.80s': '%s' is %s; it is a number from %s to %s",
        r->path, r->name, key,
        cJSON_IsNumber(item) ? abbe_number_text(item->valuedouble, text) : "no number",
        abbe_number_text(least, low), abbe_number_text(most, high));
  }
  *out = item->valuedouble;
  return ABBE_OK;
}

static bool transmits(const cJSON *material) {
  const cJSON *factor = cJSON_GetObjectItemCaseSensitive(
      abbe_gltf_extension(material, "KHR_materials_transmission"), "transmissionFactor");
  return cJSON_IsNumber(factor) && factor->valuedouble > 0;
}

static double per_um2(double lambda_nm) {
  return 1e6 / (lambda_nm * lambda_nm);
}

static abbe_result read_index(const reading *r, const cJSON *material, abbe_material *out) {
  double n_d = 1.5, dispersion = 0; /* the extensions' defaults */
  ABBE_TRY(get(r, abbe_gltf_extension(material, "KHR_materials_ior"), "ior", 0, 100, &n_d));
  ABBE_TRY(get(r, abbe_gltf_extension(material, "KHR_materials_dispersion"), "dispersion", 0,
               ABBE_GLTF_MOST_DISPERSION, &dispersion));
  if (!(n_d >= 1))
    return abbe_error_set(r->error, ABBE_UNSUPPORTED,
                          "%s: material '%.80s': an 'ior' of %g stands for no refraction by an "
                          "index; take one from 1 on",
                          r->path, r->name, n_d);
  /* n_F - n_C = (n_d - 1) / V_d, dispersion = 20 / V_d */
  const double slope =
      (n_d - 1) * dispersion / 20 / (per_um2(ABBE_LINE_F_NM) - per_um2(ABBE_LINE_C_NM));
  out->dispersion.model = slope > 0 ? ABBE_DISPERSION_CAUCHY : ABBE_DISPERSION_CONSTANT;
  out->dispersion.count = slope > 0 ? 2 : 1;
  out->dispersion.c[0] = n_d - slope * per_um2(ABBE_LINE_D_NM);
  out->dispersion.c[1] = slope;
  out->min_nm = ABBE_WAVELENGTH_MIN_NM;
  out->max_nm = ABBE_WAVELENGTH_MAX_NM;
  out->extrapolate = true;
  return ABBE_OK;
}

static abbe_result read_volume(const reading *r, const cJSON *material, abbe_material *out) {
  const cJSON *volume = abbe_gltf_extension(material, "KHR_materials_volume");
  const cJSON *colour = cJSON_GetObjectItemCaseSensitive(volume, "attenuationColor");
  double thickness = 0, distance = INFINITY, left[3] = {1, 1, 1};
  ABBE_TRY(get(r, volume, "thicknessFactor", 0, 1e12, &thickness));
  ABBE_TRY(get(r, volume, "attenuationDistance", 1e-12, 1e300, &distance));
  if (!(thickness > 0))
    return abbe_error_set(r->error, ABBE_UNSUPPORTED,
                          "%s: material '%.80s' is a thin wall, not a solid: its "
                          "KHR_materials_volume has no 'thicknessFactor' above 0; name a material "
                          "of the table in place of 'from-file'",
                          r->path, r->name);
  if (colour == NULL || !isfinite(distance)) return ABBE_OK;
  for (int c = 0; c < 3; c++) {
    const cJSON *item = cJSON_GetArrayItem(colour, c);
    if (cJSON_GetArraySize(colour) != 3 || !cJSON_IsNumber(item) ||
        !(item->valuedouble >= 0 && item->valuedouble <= 1))
      return abbe_error_set(r->error, ABBE_SCHEMA,
                            "%s: material '%.80s': 'attenuationColor' is not three numbers from 0 "
                            "to 1",
                            r->path, r->name);
    left[c] = fmax(item->valuedouble, 1e-6);
  }
  if (left[0] == 1 && left[1] == 1 && left[2] == 1) return ABBE_OK;
  return abbe_absorption_spectrum_of_colour(left, distance, &out->attenuation, r->error);
}

/* What of it is left out, in a few words. */
static void read_warning(const cJSON *material, char *text, size_t size) {
  const cJSON *surface = cJSON_GetObjectItemCaseSensitive(material, "pbrMetallicRoughness");
  const cJSON *tint = cJSON_GetObjectItemCaseSensitive(surface, "baseColorFactor");
  const cJSON *rough = cJSON_GetObjectItemCaseSensitive(surface, "roughnessFactor");
  const cJSON *share = cJSON_GetObjectItemCaseSensitive(
      abbe_gltf_extension(material, "KHR_materials_transmission"), "transmissionFactor");
  bool tinted = cJSON_GetObjectItemCaseSensitive(surface, "baseColorTexture") != NULL;
  for (int c = 0; c < 3 && c < cJSON_GetArraySize(tint); c++)
    tinted = tinted || cJSON_GetArrayItem(tint, c)->valuedouble != 1;
  const bool rules[] = {tinted, !cJSON_IsNumber(rough) || rough->valuedouble != 0,
                        share->valuedouble != 1}; /* it transmits */
  static const char *const words[] = {"the tint of its surface", "roughness",
                                      "the share that it does not transmit"};
  text[0] = '\0';
  for (int i = 0; i < 3; i++)
    if (rules[i]) {
      const size_t used = strlen(text);
      snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "glTF's; left out: ", words[i]);
    }
}

static abbe_result read_material(const reading *r, const cJSON *material, abbe_material *out) {
  char text[512];
  ABBE_TRY(read_index(r, material, out));
  ABBE_TRY(read_volume(r, material, out));
  out->temperature_c = NAN;
  out->name = strdup(r->name);
  snprintf(text, sizeof text, "[glTFDispersion] %.400s", abbe_file_name(r->path));
  out->source = strdup(text);
  read_warning(material, text, sizeof text);
  if (text[0] != '\0') out->warning = strdup(text);
  if (out->name == NULL || out->source == NULL || (text[0] != '\0' && out->warning == NULL))
    return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for a material");
  return abbe_material_check(out, r->error);
}

/* ---- which one ---- */

static const char *name_of(const cJSON *material) {
  const char *name = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(material, "name"));
  return name != NULL ? name : "";
}

/* The names of those that transmit. */
static void list_names(const cJSON *materials, char *text, size_t size) {
  const cJSON *item;
  text[0] = '\0';
  cJSON_ArrayForEach(item, materials) {
    const size_t used = strlen(text);
    if (transmits(item) && used + 8 < size)
      snprintf(text + used, size - used, "%s'%.80s'", used > 0 ? ", " : "", name_of(item));
  }
}

static abbe_result choose(const reading *r, const cJSON *materials, const char *part,
                          const cJSON **out) {
  const cJSON *item;
  char names[400];
  int found = 0;
  list_names(materials, names, sizeof names);
  cJSON_ArrayForEach(item, materials) {
    if (part != NULL ? strcmp(name_of(item), part) != 0 : !transmits(item)) continue;
    *out = item;
    found++;
  }
  if (found == 1 && transmits(*out)) return ABBE_OK;
  if (found == 1)
    return abbe_error_set(r->error, ABBE_UNSUPPORTED,
                          "%s: material '%.80s' transmits no light (KHR_materials_transmission); "
                          "those that do: %s",
                          r->path, part, names[0] != '\0' ? names : "none");
  if (part != NULL)
    return abbe_error_set(r->error, ABBE_NOT_FOUND,
                          "%s: %s material is called '%.80s'; those that transmit light: %s",
                          r->path, found > 1 ? "more than one" : "no", part,
                          names[0] != '\0' ? names : "none");
  return abbe_error_set(r->error, ABBE_NOT_FOUND,
                        found == 0
                            ? "%s: no material transmits light "
                              "(KHR_materials_transmission)%s"
                            : "%s: several materials transmit light; say which as 'part': %s",
                        r->path, names);
}

abbe_result abbe_gltf_material_load(const char *path, const char *part, abbe_material *out,
                                    char **name, abbe_error *error) {
  const char *dot = strrchr(path, '.');
  const cJSON *material = NULL;
  abbe_gltf_json json = {0};
  char *data = NULL;
  size_t size = 0;
  memset(out, 0, sizeof *out);
  *name = NULL;
  if (dot == NULL || (strcasecmp(dot, ".glb") != 0 && strcasecmp(dot, ".gltf") != 0))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: a material is read with meshes of .gltf and .glb files alone", path);
  abbe_result result = abbe_file_read(path, ABBE_MESH_FILES_MOST, &data, &size, error);
  if (result == ABBE_OK) result = abbe_gltf_json_parse(path, data, size, &json, error);
  free(data);
  if (result != ABBE_OK) return result;
  const cJSON *materials = cJSON_GetObjectItemCaseSensitive(json.root, "materials");
  reading r = {path, "", error};
  result = choose(&r, materials, part, &material);
  if (result == ABBE_OK) {
    const bool named = abbe_material_check_name(name_of(material), NULL) == ABBE_OK;
    r.name = named ? name_of(material) : "from-file";
    result = read_material(&r, material, out);
  }
  if (result == ABBE_OK && cJSON_GetArraySize(materials) > 1) {
    *name = strdup(name_of(material));
    if (*name == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  }
  cJSON_Delete(json.root);
  if (result != ABBE_OK) abbe_material_free(out);
  return result;
}
