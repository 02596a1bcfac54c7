#include "spectral/materials/material_record.h"

#include "spectral/materials/absorption.h"
#include "spectral/materials/conductor.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A record being read: where complaints go, and what fills. */
typedef struct reader {
  abbe_yaml *yaml;
  abbe_yaml_node record;
  abbe_material *material;
  abbe_error *error;
  bool lenient; /* for a record that is to be examined */
} reader;

/* What the lenient reading goes without. */
static abbe_result require(reader *r, const char *key, abbe_yaml_node *node) {
  if (!r->lenient) return abbe_yaml_require(r->yaml, r->record, key, node, r->error);
  *node = abbe_yaml_get(r->yaml, r->record, key);
  return ABBE_OK;
}

static const char *const interpolations[] = {"linear", "monotone", "spline", NULL};

/* ---- points and ranges ---- */

/* Rows of a list: wavelengths, and one or two values of each. */
typedef struct rows {
  size_t columns, count;
  double *column[3];
} rows;

static void free_rows(rows *list) {
  for (size_t k = 0; k < 3; k++) free(list->column[k]);
}

static abbe_result refuse_row(reader *r, abbe_yaml_node row, const char *key, size_t columns) {
  if (columns == 2)
    return abbe_yaml_fail(r->yaml, row, r->error, "'%s' wants pairs such as [550, 1.5]", key);
  bool pair = abbe_yaml_is_sequence(r->yaml, row) && abbe_yaml_count(r->yaml, row) == 2;
  return abbe_yaml_fail(r->yaml, row, r->error,
                        "'%s' of a conductor wants [nm, n, k] such as [550, 0.06, 3.6]%s", key,
                        pair ? "; this one has no k" : "");
}

/* [[nm, value], …] or, with three columns, [[nm, n, k], …], values in [min, max]; the rows are
 * freed by the caller, also after a failure. */
static abbe_result read_rows(reader *r, abbe_yaml_node list, const char *key, double min,
                             double max, rows *out) {
  const size_t count = abbe_yaml_count(r->yaml, list), columns = out->columns;
  if (!abbe_yaml_is_sequence(r->yaml, list) || count == 0 || count > ABBE_SPECTRUM_MAX_COUNT)
    return abbe_yaml_fail(r->yaml, list, r->error, "'%s' wants a list of 1 to %d %s", key,
                          ABBE_SPECTRUM_MAX_COUNT,
                          columns == 2 ? "pairs [nm, value]" : "points [nm, n, k]");
  out->count = count;
  for (size_t k = 0; k < columns; k++) {
    out->column[k] = malloc(count * sizeof(double));
    if (out->column[k] == NULL)
      return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for %zu points", count);
  }
  const double *lambda_nm = out->column[0];
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node row = abbe_yaml_item(r->yaml, list, i);
    if (!abbe_yaml_is_sequence(r->yaml, row) || abbe_yaml_count(r->yaml, row) != columns)
      return refuse_row(r, row, key, columns);
    for (size_t k = 0; k < columns; k++) {
      abbe_result result = abbe_yaml_number(
          r->yaml, abbe_yaml_item(r->yaml, row, k), key, k == 0 ? ABBE_SPECTRUM_LOW_NM : min,
          k == 0 ? ABBE_SPECTRUM_HIGH_NM : max, &out->column[k][i], r->error);
      if (result != ABBE_OK) return result;
    }
    if (i > 0 && lambda_nm[i] <= lambda_nm[i - 1])
      return abbe_yaml_fail(r->yaml, row, r->error,
                            "'%s': %g nm follows %g nm; wavelengths must ascend", key, lambda_nm[i],
                            lambda_nm[i - 1]);
  }
  return ABBE_OK;
}

/* What a spectrum cannot be made of, as a complaint about the list. */
static abbe_result tell(reader *r, abbe_yaml_node list, const char *key, abbe_result result,
                        const abbe_error *why) {
  if (result == ABBE_INVALID_ARGUMENT)
    return abbe_yaml_fail(r->yaml, list, r->error, "'%s': %s", key, why->text);
  return result == ABBE_OK ? ABBE_OK : abbe_error_set(r->error, result, "%s", why->text);
}

static abbe_result read_points(reader *r, abbe_yaml_node list, const char *key, double min,
                               double max, abbe_interpolation interpolation, abbe_spectrum **out) {
  rows pairs = {.columns = 2};
  abbe_error why = {0};
  abbe_result result = read_rows(r, list, key, min, max, &pairs);
  if (result == ABBE_OK) {
    abbe_spectrum_free(*out);
    result =
        abbe_spectrum_make(pairs.column[0], pairs.column[1], pairs.count, interpolation, out, &why);
    result = tell(r, list, key, result, &why);
  }
  free_rows(&pairs);
  return result;
}

static abbe_result read_range(reader *r, abbe_yaml_node where, const char *key, double *min_nm,
                              double *max_nm) {
  double range[2] = {*min_nm, *max_nm};
  double low = r->lenient ? 1e-3 : ABBE_SPECTRUM_LOW_NM; /* a range in um is one to find */
  abbe_result result =
      abbe_yaml_get_numbers(r->yaml, where, key, 2, low, ABBE_SPECTRUM_HIGH_NM, range, r->error);
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

static abbe_result read_conductor(reader *r, abbe_yaml_node points) {
  rows list = {.columns = 3};
  abbe_error why = {0};
  abbe_result result = read_rows(r, points, "points", 0, 1e3, &list);
  if (result == ABBE_OK) {
    result = abbe_conductor_make(list.column[0], list.column[1], list.column[2], list.count,
                                 &r->material->dispersion, &why);
    result = tell(r, points, "points", result, &why);
  }
  free_rows(&list);
  return result;
}

static abbe_result read_tabulated(reader *r) {
  abbe_material *m = r->material;
  abbe_yaml_node points;
  abbe_interpolation interpolation = ABBE_INTERPOLATION_MONOTONE;
  abbe_result result = abbe_yaml_require(r->yaml, r->record, "points", &points, r->error);
  if (result == ABBE_OK) result = read_interpolation(r, r->record, &interpolation);
  if (result == ABBE_OK)
    result = abbe_material_is_conductor(m)
                 ? read_conductor(r, points)
                 : read_points(r, points, "points", 1e-3, 1e3, interpolation, &m->dispersion.table);
  if (result != ABBE_OK) return result;
  const double *lambda_nm = abbe_spectrum_lambda_nm(m->dispersion.table);
  double low = lambda_nm[0], high = lambda_nm[abbe_spectrum_count(m->dispersion.table) - 1];
  m->min_nm = low;
  m->max_nm = high;
  if (abbe_yaml_get(r->yaml, r->record, "range_nm").id != 0)
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
  abbe_yaml_node node = {0};
  m->min_nm = ABBE_SPECTRUM_LOW_NM;
  m->max_nm = ABBE_SPECTRUM_HIGH_NM;
  if (m->dispersion.model != ABBE_DISPERSION_CONSTANT) result = require(r, "range_nm", &node);
  if (r->lenient && node.id == 0 && m->dispersion.model != ABBE_DISPERSION_CONSTANT) {
    m->min_nm = m->max_nm = 0;
    return ABBE_OK;
  }
  return result != ABBE_OK ? result : read_range(r, r->record, "range_nm", &m->min_nm, &m->max_nm);
}

/* A key that the model does not read would be silently without effect. */
static abbe_result check_idle_keys(reader *r) {
  static const char *const of_points[] = {"coefficients", NULL};
  static const char *const of_formulas[] = {"points", "interpolation", NULL};
  static const char *const of_conductors[] = {
      "coefficients", "interpolation", "extrapolate", "absorption", "fit", "n_d", "v_d", NULL};
  abbe_dispersion_model model = r->material->dispersion.model;
  const char *const *idle = model == ABBE_DISPERSION_CONDUCTOR   ? of_conductors
                            : model == ABBE_DISPERSION_TABULATED ? of_points
                                                                 : of_formulas;
  for (; *idle != NULL; idle++) {
    abbe_yaml_node node = abbe_yaml_get(r->yaml, r->record, *idle);
    if (node.id != 0)
      return abbe_yaml_fail(r->yaml, node, r->error, "the model %s has no use for '%s'",
                            abbe_dispersion_model_name(model), *idle);
  }
  return ABBE_OK;
}

static abbe_result read_dispersion(reader *r) {
  abbe_dispersion *d = &r->material->dispersion;
  abbe_result result = read_model(r, &d->model);
  if (result == ABBE_OK) result = check_idle_keys(r);
  if (result != ABBE_OK) return result;
  bool points = d->model == ABBE_DISPERSION_TABULATED || d->model == ABBE_DISPERSION_CONDUCTOR;
  result = points ? read_tabulated(r) : read_formula(r);
  if (result != ABBE_OK || r->lenient) return result;
  abbe_error why;
  if (abbe_material_check(r->material, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, r->record, r->error, "%s", why.text);
  return ABBE_OK;
}

/* ---- absorption ---- */

static abbe_result read_colour(reader *r, abbe_yaml_node where) {
  double colour[3] = {1, 1, 1}, distance_m = 0;
  abbe_yaml_node node;
  abbe_result result = abbe_yaml_require(r->yaml, where, "distance_m", &node, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, where, "distance_m", 1e-9, 1e9, &distance_m, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_numbers(r->yaml, where, "colour", 3, 1e-6, 1, colour, r->error);
  if (result != ABBE_OK) return result;
  return abbe_absorption_spectrum_of_colour(colour, distance_m, &r->material->attenuation,
                                            r->error);
}

static abbe_result read_attenuation(reader *r, abbe_yaml_node where) {
  abbe_interpolation interpolation = ABBE_INTERPOLATION_LINEAR;
  abbe_result result = read_interpolation(r, where, &interpolation);
  if (result != ABBE_OK) return result;
  return read_points(r, abbe_yaml_get(r->yaml, where, "attenuation_per_m"), "attenuation_per_m", 0,
                     1e15, interpolation, &r->material->attenuation);
}

/* Pairs into points, for what is converted. */
static abbe_result read_list(reader *r, abbe_yaml_node where, const char *key, double max,
                             abbe_points *points) {
  rows pairs = {.columns = 2};
  abbe_result result = read_rows(r, abbe_yaml_get(r->yaml, where, key), key, 0, max, &pairs);
  for (size_t i = 0; result == ABBE_OK && i < pairs.count; i++)
    result = abbe_points_add(
        points, (abbe_point){.lambda_nm = pairs.column[0][i], .value = pairs.column[1][i]},
        r->error);
  free_rows(&pairs);
  return result;
}

static abbe_result read_k(reader *r, abbe_yaml_node where) {
  abbe_points points = {0};
  abbe_result result = read_list(r, where, "k", 1e3, &points);
  if (result == ABBE_OK)
    result = abbe_absorption_spectrum_of_k(&points, &r->material->attenuation, r->error);
  abbe_points_free(&points);
  return result;
}

static abbe_result read_transmittance(reader *r, abbe_yaml_node where) {
  abbe_points points = {0};
  double thickness_m = 0;
  abbe_yaml_node node;
  abbe_result result = abbe_yaml_require(r->yaml, where, "thickness_m", &node, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, where, "thickness_m", 1e-9, 1e9, &thickness_m, r->error);
  if (result == ABBE_OK) result = read_list(r, where, "transmittance", 1, &points);
  if (result == ABBE_OK)
    result = abbe_absorption_spectrum_of_transmittance(&points, thickness_m,
                                                       &r->material->attenuation, r->error);
  abbe_points_free(&points);
  return result;
}

/* The ways to say what absorbs, and the keys that go with each. */
static const struct {
  const char *key;
  abbe_result (*read)(reader *r, abbe_yaml_node where);
} ways[] = {
    {"attenuation_per_m", read_attenuation},
    {"transmittance", read_transmittance},
    {"k", read_k},
    {"colour", read_colour},
};
#define WAYS                                                                                       \
  "'attenuation_per_m', 'k', 'transmittance' and 'thickness_m', or 'colour' and 'distance_m'"

static abbe_result read_absorption(reader *r) {
  abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "absorption");
  if (where.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, where))
    return abbe_yaml_fail(r->yaml, where, r->error, "'absorption' wants " WAYS);
  size_t found = 0, which = 0;
  for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
    if (abbe_yaml_get(r->yaml, where, ways[i].key).id == 0) continue;
    found++;
    which = i;
  }
  if (found != 1) {
    /* a mistyped key is the likelier mistake, and says more */
    static const char *const rest[] = {"distance_m", "thickness_m", "interpolation"};
    for (int i = 0; i < 3; i++) abbe_yaml_get(r->yaml, where, rest[i]);
    abbe_result result = abbe_yaml_check_keys(r->yaml, where, "'absorption'", r->error);
    if (result != ABBE_OK) return result;
    return abbe_yaml_fail(r->yaml, where, r->error, "'absorption' wants one of " WAYS);
  }
  abbe_result result = ways[which].read(r, where);
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

/* ---- what the source prints besides ---- */

static abbe_result read_published(reader *r) {
  abbe_material *m = r->material;
  abbe_result result =
      abbe_yaml_get_number(r->yaml, r->record, "n_d", 1e-3, 1e3, &m->published_n_d, r->error);
  if (result == ABBE_OK)
    result =
        abbe_yaml_get_number(r->yaml, r->record, "v_d", -1e6, 1e6, &m->published_v_d, r->error);
  return result;
}

static abbe_result read_numbers(reader *r, abbe_yaml_node where, const char *key, size_t count,
                                double *out) {
  return abbe_yaml_get_numbers(r->yaml, where, key, count, -ABBE_MATERIAL_CATALOGUE_MOST,
                               ABBE_MATERIAL_CATALOGUE_MOST, out, r->error);
}

/* A key of the record; tables written before it was one have it in the catalogue. */
static abbe_result read_density(reader *r) {
  double *density_g_cm3 = &r->material->catalogue.density_g_cm3;
  const char *const key = "density_g_cm3";
  abbe_yaml_node catalogue = abbe_yaml_get(r->yaml, r->record, "catalogue");
  abbe_yaml_node twice = {0};
  if (catalogue.id != 0) twice = abbe_yaml_get(r->yaml, catalogue, key);
  if (twice.id != 0 && abbe_yaml_get(r->yaml, r->record, key).id != 0)
    return abbe_yaml_fail(r->yaml, twice, r->error,
                          "'%s' stands in the record and in its catalogue; leave it out here", key);
  return abbe_yaml_get_number(r->yaml, twice.id != 0 ? catalogue : r->record, key, 0,
                              ABBE_MATERIAL_DENSITY_MOST, density_g_cm3, r->error);
}

static abbe_result read_catalogue(reader *r) {
  abbe_material_catalogue *c = &r->material->catalogue;
  abbe_yaml_node where = abbe_yaml_get(r->yaml, r->record, "catalogue");
  if (where.id == 0) return ABBE_OK;
  abbe_result result = abbe_yaml_get_string(r->yaml, where, "code", &c->code, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, where, "status", &c->status, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, where, "melt_frequency", 0, ABBE_MATERIAL_MELT_MOST,
                                  &c->melt_frequency, r->error);
  if (result == ABBE_OK) result = read_numbers(r, where, "expansion_per_k", 2, c->expansion_per_k);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, where, "dpgf", -ABBE_MATERIAL_DPGF_MOST,
                                  ABBE_MATERIAL_DPGF_MOST, &c->dpgf, r->error);
  if (result == ABBE_OK) result = read_numbers(r, where, "thermal", 6, c->thermal);
  if (result == ABBE_OK) result = read_numbers(r, where, "ratings", 6, c->ratings);
  if (abbe_yaml_get(r->yaml, where, "ratings").id != 0) c->rating_count = 6;
  return result != ABBE_OK ? result : abbe_yaml_check_keys(r->yaml, where, "'catalogue'", r->error);
}

/* ---- records ---- */

static abbe_result check_name(reader *r) {
  abbe_error why;
  if (abbe_material_check_name(r->material->name, &why) == ABBE_OK) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->record, "name"), r->error, "'name': %s",
                        why.text);
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
  if (result == ABBE_OK) result = require(r, "source", &node);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "source", &m->source, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "warning", &m->warning, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_string(r->yaml, r->record, "comment", &m->comment, r->error);
  return result;
}

/* Every key is asked for before the values are judged by what is missing, so that a mistyped key
 * is reported as such. */
static abbe_result check_record_keys(reader *r) {
  static const char *const keys[] = {
      "name",     "description", "model",      "coefficients",  "points",    "interpolation",
      "range_nm", "extrapolate", "absorption", "temperature_c", "source",    "warning",
      "fit",      "n_d",         "v_d",        "comment",       "catalogue", "density_g_cm3"};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    abbe_yaml_get(r->yaml, r->record, keys[i]);
  return abbe_yaml_check_keys(r->yaml, r->record, "a material", r->error);
}

static abbe_result read_record(reader *r) {
  abbe_material *m = r->material;
  m->line = abbe_yaml_line(r->yaml, r->record);
  m->temperature_c = NAN;
  abbe_result result = check_record_keys(r);
  if (result == ABBE_OK) result = read_texts(r);
  if (result == ABBE_OK) result = read_dispersion(r);
  if (result == ABBE_OK)
    result = abbe_yaml_get_bool(r->yaml, r->record, "extrapolate", &m->extrapolate, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, r->record, "temperature_c", -273.15, 1e4,
                                  &m->temperature_c, r->error);
  if (result == ABBE_OK) result = read_absorption(r);
  if (result == ABBE_OK) result = read_published(r);
  if (result == ABBE_OK) result = read_density(r);
  if (result == ABBE_OK) result = read_catalogue(r);
  return result == ABBE_OK ? read_fits(r) : result;
}

abbe_result abbe_material_record_read(abbe_yaml *yaml, abbe_yaml_node record,
                                      abbe_material *material, abbe_error *error) {
  ABBE_REQUIRE(yaml && material, error);
  reader r = {yaml, record, material, error, false};
  return read_record(&r);
}

abbe_result abbe_material_record_read_lenient(abbe_yaml *yaml, abbe_yaml_node record,
                                              abbe_material *material, abbe_error *error) {
  ABBE_REQUIRE(yaml && material, error);
  reader r = {yaml, record, material, error, true};
  return read_record(&r);
}
