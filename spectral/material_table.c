#include "spectral/material_table.h"

#include "spectral/nearest.h"
#include "spectral/wavelengths.h"
#include "spectral/yaml.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

extern const unsigned char abbe_embedded_materials[];
extern const size_t abbe_embedded_materials_size;
extern const unsigned char abbe_embedded_thesis[];
extern const size_t abbe_embedded_thesis_size;

enum { MAX_MATERIALS = 10000, MAX_NAME = 80 };

/* Wide enough for any optical data, and narrow enough that no formula overflows. */
static const double LAMBDA_LOW_NM = 1, LAMBDA_HIGH_NM = 1e6;

/* A record being read: where complaints go, and what fills. */
typedef struct reader {
  abbe_yaml *yaml;
  abbe_yaml_node record;
  abbe_material *material;
  abbe_error *error;
} reader;

static const char *const interpolations[] = {"linear", "monotone", "spline", NULL};

/* ---- points and ranges ---- */

/* [[nm, value], …] with values in [min, max]; the two arrays are freed by the caller. */
static abbe_result read_pairs(reader *r, abbe_yaml_node list, const char *key, double min,
                              double max, double **lambda_nm, double **value) {
  size_t count = abbe_yaml_count(r->yaml, list);
  if (!abbe_yaml_is_sequence(r->yaml, list) || count == 0 || count > ABBE_SPECTRUM_MAX_COUNT)
    return abbe_yaml_fail(r->yaml, list, r->error, "'%s' wants a list of 1 to %d pairs [nm, value]",
                          key, ABBE_SPECTRUM_MAX_COUNT);
  *lambda_nm = malloc(count * sizeof(double));
  *value = malloc(count * sizeof(double));
  if (*lambda_nm == NULL || *value == NULL)
    return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for %zu points", count);
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node pair = abbe_yaml_item(r->yaml, list, i);
    if (!abbe_yaml_is_sequence(r->yaml, pair) || abbe_yaml_count(r->yaml, pair) != 2)
      return abbe_yaml_fail(r->yaml, pair, r->error, "'%s' wants pairs such as [550, 1.5]", key);
    abbe_result result = abbe_yaml_number(r->yaml, abbe_yaml_item(r->yaml, pair, 0), key,
                                          LAMBDA_LOW_NM, LAMBDA_HIGH_NM, *lambda_nm + i, r->error);
    if (result == ABBE_OK)
      result = abbe_yaml_number(r->yaml, abbe_yaml_item(r->yaml, pair, 1), key, min, max,
                                *value + i, r->error);
    if (result != ABBE_OK) return result;
    if (i > 0 && (*lambda_nm)[i] <= (*lambda_nm)[i - 1])
      return abbe_yaml_fail(r->yaml, pair, r->error,
                            "'%s': %g nm follows %g nm; wavelengths must ascend", key,
                            (*lambda_nm)[i], (*lambda_nm)[i - 1]);
  }
  return ABBE_OK;
}

static abbe_result read_points(reader *r, abbe_yaml_node list, const char *key, double min,
                               double max, abbe_interpolation interpolation, abbe_spectrum **out) {
  double *lambda_nm = NULL, *value = NULL;
  abbe_result result = read_pairs(r, list, key, min, max, &lambda_nm, &value);
  if (result == ABBE_OK) {
    abbe_error why = {0};
    abbe_spectrum_free(*out);
    result = abbe_spectrum_make(lambda_nm, value, abbe_yaml_count(r->yaml, list), interpolation,
                                out, &why);
    if (result == ABBE_INVALID_ARGUMENT)
      result = abbe_yaml_fail(r->yaml, list, r->error, "'%s': %s", key, why.text);
    else if (result != ABBE_OK)
      abbe_error_set(r->error, result, "%s", why.text);
  }
  free(lambda_nm);
  free(value);
  return result;
}

static abbe_result read_range(reader *r, abbe_yaml_node where, const char *key, double *min_nm,
                              double *max_nm) {
  double range[2] = {*min_nm, *max_nm};
  abbe_result result =
      abbe_yaml_get_numbers(r->yaml, where, key, 2, LAMBDA_LOW_NM, LAMBDA_HIGH_NM, range, r->error);
  if (result != ABBE_OK) return result;
  if (range[0] >= range[1])
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, where, key), r->error,
                          "'%s: [%g, %g]' must name the smaller wavelength first", key, range[0],
                          range[1]);
  *min_nm = range[0];
  *max_nm = range[1];
  return ABBE_OK;
}

static abbe_result read_interpolation(reader *r, abbe_yaml_node where,
                                      abbe_interpolation *interpolation) {
  int choice = (int)*interpolation;
  abbe_result result =
      abbe_yaml_get_choice(r->yaml, where, "interpolation", interpolations, &choice, r->error);
  *interpolation = (abbe_interpolation)choice;
  return result;
}

/* ---- dispersion ---- */

static abbe_result read_model(reader *r, abbe_dispersion_model *model) {
  const char *names[ABBE_DISPERSION_MODEL_COUNT + 1] = {NULL};
  for (int i = 0; i < ABBE_DISPERSION_MODEL_COUNT; i++)
    names[i] = abbe_dispersion_model_name((abbe_dispersion_model)i);
  abbe_yaml_node node;
  abbe_result result = abbe_yaml_require(r->yaml, r->record, "model", &node, r->error);
  int choice = 0;
  if (result == ABBE_OK)
    result = abbe_yaml_get_choice(r->yaml, r->record, "model", names, &choice, r->error);
  *model = (abbe_dispersion_model)choice;
  return result;
}

static abbe_result read_tabulated(reader *r) {
  abbe_material *m = r->material;
  abbe_yaml_node points;
  abbe_interpolation interpolation = ABBE_INTERPOLATION_MONOTONE;
  abbe_result result = abbe_yaml_require(r->yaml, r->record, "points", &points, r->error);
  if (result == ABBE_OK) result = read_interpolation(r, r->record, &interpolation);
  if (result == ABBE_OK)
    result = read_points(r, points, "points", 1e-3, 1e3, interpolation, &m->dispersion.table);
  if (result != ABBE_OK) return result;
  const double *lambda_nm = abbe_spectrum_lambda_nm(m->dispersion.table);
  double low = lambda_nm[0], high = lambda_nm[abbe_spectrum_count(m->dispersion.table) - 1];
  m->min_nm = low;
  m->max_nm = high;
  result = read_range(r, r->record, "range_nm", &m->min_nm, &m->max_nm);
  if (result == ABBE_OK && (m->min_nm < low || m->max_nm > high))
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->record, "range_nm"), r->error,
                          "'range_nm: [%g, %g]' is wider than the points, which reach from %g to "
                          "%g nm",
                          m->min_nm, m->max_nm, low, high);
  return result;
}

static abbe_result read_coefficients(reader *r) {
  abbe_dispersion *d = &r->material->dispersion;
  abbe_yaml_node node;
  abbe_result result = abbe_yaml_require(r->yaml, r->record, "coefficients", &node, r->error);
  if (result != ABBE_OK) return result;
  double *c = NULL;
  result = abbe_yaml_get_list(r->yaml, r->record, "coefficients", ABBE_DISPERSION_MAX_COEFFICIENTS,
                              &c, &d->count, r->error);
  if (result != ABBE_OK) return result;
  memcpy(d->c, c, d->count * sizeof *c);
  free(c);
  abbe_error why;
  if (abbe_dispersion_check(d, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, node, r->error, "'coefficients': %s", why.text);
  return ABBE_OK;
}

static abbe_result read_formula(reader *r) {
  abbe_material *m = r->material;
  abbe_result result = read_coefficients(r);
  if (result != ABBE_OK) return result;
  abbe_yaml_node node;
  m->min_nm = LAMBDA_LOW_NM;
  m->max_nm = LAMBDA_HIGH_NM;
  if (m->dispersion.model != ABBE_DISPERSION_CONSTANT)
    result = abbe_yaml_require(r->yaml, r->record, "range_nm", &node, r->error);
  return result != ABBE_OK ? result : read_range(r, r->record, "range_nm", &m->min_nm, &m->max_nm);
}

/* A formula that has a pole or no root inside its own range was copied wrongly, most often with
 * coefficients in another unit. */
static abbe_result check_index(reader *r) {
  const abbe_material *m = r->material;
  enum { STEPS = 1000 };
  for (int i = 0; i <= STEPS; i++) {
    double lambda_nm = m->min_nm + (m->max_nm - m->min_nm) * i / STEPS;
    if (!isnan(abbe_dispersion_n(&m->dispersion, lambda_nm))) continue;
    return abbe_yaml_fail(r->yaml, r->record, r->error,
                          "%s: its %s formula has no real index at %g nm, inside its range; check "
                          "the coefficients (wavelengths in micrometres)",
                          m->name, abbe_dispersion_model_name(m->dispersion.model), lambda_nm);
  }
  return ABBE_OK;
}

static abbe_result read_dispersion(reader *r) {
  abbe_dispersion *d = &r->material->dispersion;
  abbe_result result = read_model(r, &d->model);
  if (result != ABBE_OK) return result;
  result = d->model == ABBE_DISPERSION_TABULATED ? read_tabulated(r) : read_formula(r);
  return result == ABBE_OK ? check_index(r) : result;
}

/* ---- absorption ---- */

/* Dominant wavelengths of the Rec.709 primaries, blue to red: where a colour's three
 * transmittances are taken to hold. Linear between them, held beyond. */
static const double PRIMARY_NM[3] = {464.2, 549.1, 611.4};

static abbe_result read_colour(reader *r, abbe_yaml_node where) {
  double colour[3] = {1, 1, 1}, distance_m = 0, attenuation[3];
  abbe_yaml_node node;
  abbe_result result = abbe_yaml_require(r->yaml, where, "distance_m", &node, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, where, "distance_m", 1e-9, 1e9, &distance_m, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_numbers(r->yaml, where, "colour", 3, 1e-6, 1, colour, r->error);
  if (result != ABBE_OK) return result;
  for (int i = 0; i < 3; i++) attenuation[i] = fabs(log(colour[2 - i])) / distance_m;
  return abbe_spectrum_make(PRIMARY_NM, attenuation, 3, ABBE_INTERPOLATION_LINEAR,
                            &r->material->attenuation, r->error);
}

static abbe_result read_absorption(reader *r) {
  abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "absorption");
  if (where.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, where))
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'absorption' wants 'attenuation_per_m', or 'colour' and 'distance_m'");
  abbe_yaml_node spectrum = abbe_yaml_get(r->yaml, where, "attenuation_per_m");
  abbe_yaml_node colour = abbe_yaml_get(r->yaml, where, "colour");
  if ((spectrum.id == 0) == (colour.id == 0)) {
    /* a mistyped key is the likelier mistake, and says more */
    abbe_yaml_get(r->yaml, where, "distance_m");
    abbe_yaml_get(r->yaml, where, "interpolation");
    abbe_result result = abbe_yaml_check_keys(r->yaml, where, "'absorption'", r->error);
    if (result != ABBE_OK) return result;
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'absorption' wants either 'attenuation_per_m', or 'colour' and "
                          "'distance_m'");
  }
  abbe_result result;
  abbe_interpolation interpolation = ABBE_INTERPOLATION_LINEAR;
  if (colour.id != 0) {
    result = read_colour(r, where);
  } else {
    result = read_interpolation(r, where, &interpolation);
    if (result == ABBE_OK)
      result = read_points(r, spectrum, "attenuation_per_m", 0, 1e12, interpolation,
                           &r->material->attenuation);
  }
  return result != ABBE_OK ? result
                           : abbe_yaml_check_keys(r->yaml, where, "'absorption'", r->error);
}

/* ---- fits ---- */

static abbe_result read_fit(reader *r, abbe_yaml_node fits, const char *key, size_t terms,
                            abbe_material_fit *out) {
  abbe_yaml_node where = abbe_yaml_get(r->yaml, fits, key), node;
  if (where.id == 0) return ABBE_OK;
  abbe_material_fit fit = {
      .terms = terms, .min_nm = ABBE_WAVELENGTH_MIN_NM, .max_nm = ABBE_WAVELENGTH_MAX_NM};
  abbe_result result = abbe_yaml_require(r->yaml, where, "coefficients", &node, r->error);
  if (result == ABBE_OK)
    result =
        abbe_yaml_get_numbers(r->yaml, where, "coefficients", terms, -1e12, 1e12, fit.c, r->error);
  if (result == ABBE_OK) result = abbe_yaml_require(r->yaml, where, "max_error", &node, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, where, "max_error", 0, 1e12, &fit.max_error, r->error);
  if (result == ABBE_OK) result = read_range(r, where, "range_nm", &fit.min_nm, &fit.max_nm);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(r->yaml, where, key, r->error);
  if (result == ABBE_OK) *out = fit;
  return result;
}

static abbe_result read_fits(reader *r) {
  abbe_yaml_node fits = abbe_yaml_get(r->yaml, r->record, "fit");
  if (fits.id == 0) return ABBE_OK;
  abbe_result result = read_fit(r, fits, "cauchy2", 2, &r->material->fit[0]);
  if (result == ABBE_OK) result = read_fit(r, fits, "cauchy3", 3, &r->material->fit[1]);
  return result != ABBE_OK ? result : abbe_yaml_check_keys(r->yaml, fits, "'fit'", r->error);
}

/* ---- records ---- */

static abbe_result check_name(reader *r) {
  const char *name = r->material->name;
  abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "name");
  size_t length = strlen(name);
  bool good = length <= MAX_NAME && name[0] != ' ' && name[length - 1] != ' ';
  for (size_t i = 0; i < length; i++)
    good = good && (unsigned char)name[i] >= 0x20 && name[i] != 0x7f;
  if (good) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, where, r->error,
                        "'name: %.100s' is not a name; up to %d printable characters, no space at "
                        "the ends",
                        name, MAX_NAME);
}

static abbe_result read_texts(reader *r) {
  abbe_material *m = r->material;
  abbe_yaml_node node;
  abbe_result result = abbe_yaml_require(r->yaml, r->record, "name", &node, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "name", &m->name, r->error);
  if (result == ABBE_OK) result = check_name(r);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "description", &m->description, r->error);
  if (result == ABBE_OK) result = abbe_yaml_require(r->yaml, r->record, "source", &node, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "source", &m->source, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "warning", &m->warning, r->error);
  return result;
}

/* Every key is asked for before the values are judged by what is missing, so that a mistyped key
 * is reported as such. */
static abbe_result check_record_keys(reader *r) {
  static const char *const keys[] = {"name",       "description",   "model",    "coefficients",
                                     "points",     "interpolation", "range_nm", "extrapolate",
                                     "absorption", "temperature_c", "source",   "warning",
                                     "fit"};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    abbe_yaml_get(r->yaml, r->record, keys[i]);
  return abbe_yaml_check_keys(r->yaml, r->record, "a material", r->error);
}

/* A key that the model does not read would be silently without effect. */
static abbe_result check_idle_keys(reader *r) {
  bool tabulated = r->material->dispersion.model == ABBE_DISPERSION_TABULATED;
  const char *idle[] = {tabulated ? "coefficients" : "points",
                        tabulated ? "coefficients" : "interpolation"};
  for (int i = 0; i < 2; i++) {
    abbe_yaml_node node = abbe_yaml_get(r->yaml, r->record, idle[i]);
    if (node.id != 0)
      return abbe_yaml_fail(r->yaml, node, r->error, "the model %s has no use for '%s'",
                            abbe_dispersion_model_name(r->material->dispersion.model), idle[i]);
  }
  return ABBE_OK;
}

static abbe_result read_record(reader *r) {
  abbe_material *m = r->material;
  m->line = abbe_yaml_line(r->yaml, r->record);
  m->temperature_c = NAN;
  abbe_result result = check_record_keys(r);
  if (result == ABBE_OK) result = read_texts(r);
  if (result == ABBE_OK) result = read_dispersion(r);
  if (result == ABBE_OK) result = check_idle_keys(r);
  if (result == ABBE_OK)
    result = abbe_yaml_get_bool(r->yaml, r->record, "extrapolate", &m->extrapolate, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, r->record, "temperature_c", -273.15, 1e4,
                                  &m->temperature_c, r->error);
  if (result == ABBE_OK) result = read_absorption(r);
  return result == ABBE_OK ? read_fits(r) : result;
}

/* ---- tables ---- */

static abbe_result check_unique(const abbe_material_table *t, size_t index, abbe_yaml *yaml,
                                abbe_yaml_node record, abbe_error *error) {
  const char *name = t->material[index].name;
  for (size_t i = 0; i < index; i++)
    if (strcasecmp(t->material[i].name, name) == 0)
      return abbe_yaml_fail(yaml, record, error,
                            "the material '%s' stands here a second time; the first is on line "
                            "%zu",
                            name, t->material[i].line);
  return ABBE_OK;
}

static abbe_result read_records(abbe_yaml *yaml, abbe_yaml_node list, abbe_material_table *t,
                                abbe_error *error) {
  size_t count = abbe_yaml_count(yaml, list);
  if (!abbe_yaml_is_sequence(yaml, list) || count == 0 || count > MAX_MATERIALS)
    return abbe_yaml_fail(yaml, list, error, "'materials' wants a list of 1 to %d records",
                          MAX_MATERIALS);
  t->material = calloc(count, sizeof *t->material);
  if (t->material == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu materials", count);
  for (size_t i = 0; i < count; i++) {
    reader r = {yaml, abbe_yaml_item(yaml, list, i), &t->material[i], error};
    t->count = i + 1; /* so that a half-read record is freed too */
    abbe_result result = read_record(&r);
    if (result == ABBE_OK) result = check_unique(t, i, yaml, r.record, error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

static abbe_result read_table(abbe_yaml *yaml, const char *name, abbe_material_table *t,
                              abbe_error *error) {
  abbe_yaml_node root = abbe_yaml_root(yaml), list;
  t->path = strdup(name);
  if (t->path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", name);
  abbe_yaml_get(yaml, root, "materials");
  abbe_result result = abbe_yaml_get_string(yaml, root, "description", &t->description, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, root, "a material table", error);
  if (result == ABBE_OK) result = abbe_yaml_require(yaml, root, "materials", &list, error);
  return result == ABBE_OK ? read_records(yaml, list, t, error) : result;
}

abbe_result abbe_material_table_parse(const char *text, size_t size, const char *name,
                                      abbe_material_table *out, abbe_error *error) {
  *out = (abbe_material_table){0};
  abbe_yaml *yaml = NULL;
  abbe_result result = abbe_yaml_parse(text, size, name, &yaml, error);
  if (result == ABBE_OK) result = read_table(yaml, name, out, error);
  if (result != ABBE_OK) abbe_material_table_free(out);
  abbe_yaml_free(yaml);
  return result;
}

abbe_result abbe_material_table_load(const char *path, abbe_material_table *out,
                                     abbe_error *error) {
  *out = (abbe_material_table){0};
  if (path == NULL || strcmp(path, "default") == 0)
    return abbe_material_table_parse((const char *)abbe_embedded_materials,
                                     abbe_embedded_materials_size, "default", out, error);
  if (strcmp(path, "thesis") == 0)
    return abbe_material_table_parse((const char *)abbe_embedded_thesis, abbe_embedded_thesis_size,
                                     "thesis", out, error);
  abbe_yaml *yaml = NULL;
  abbe_result result = abbe_yaml_load(path, &yaml, error);
  if (result == ABBE_OK) result = read_table(yaml, path, out, error);
  if (result != ABBE_OK) abbe_material_table_free(out);
  abbe_yaml_free(yaml);
  return result;
}

void abbe_material_table_free(abbe_material_table *table) {
  for (size_t i = 0; i < table->count; i++) abbe_material_free(&table->material[i]);
  free(table->material);
  free(table->path);
  free(table->description);
  *table = (abbe_material_table){0};
}

static abbe_result not_found(const abbe_material_table *table, const char *name,
                             abbe_error *error) {
  const char **names = malloc((table->count + 1) * sizeof *names);
  if (names == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  char list[700] = "";
  size_t used = 0;
  for (size_t i = 0; i < table->count; i++) {
    names[i] = table->material[i].name;
    if (used < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
  }
  const char *near = abbe_nearest_word(name, names, table->count);
  free(names);
  if (near != NULL)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the table '%.200s' has no material '%.60s'; did you mean '%s'?",
                          table->path, name, near);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "the table '%.100s' has no material '%.60s'; it has %s", table->path, name,
                        list);
}

abbe_result abbe_material_table_find(const abbe_material_table *table, const char *name,
                                     const abbe_material **out, abbe_error *error) {
  for (size_t i = 0; i < table->count; i++) {
    if (strcasecmp(table->material[i].name, name) != 0) continue;
    *out = &table->material[i];
    return ABBE_OK;
  }
  return not_found(table, name, error);
}
