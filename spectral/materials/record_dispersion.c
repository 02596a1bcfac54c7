#include "spectral/materials/record_reading.h"

#include "spectral/materials/absorption.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_record_require(abbe_record_reading *r, const char *key, abbe_yaml_node *node) {
  if (!r->lenient) return abbe_yaml_require(r->yaml, r->record, key, node, r->error);
  *node = abbe_yaml_get(r->yaml, r->record, key);
  return ABBE_OK;
}

static const char *const interpolations[] = {"linear", "monotone", "spline", NULL};

void abbe_record_rows_free(abbe_record_rows *list) {
  for (size_t k = 0; k < 3; k++) free(list->column[k]);
}

static abbe_result refuse_row(abbe_record_reading *r, abbe_yaml_node row, const char *key,
                              size_t columns) {
  if (columns == 2)
    return abbe_yaml_fail(r->yaml, row, r->error, "'%s' wants pairs such as [550, 1.5]", key);
  bool pair = abbe_yaml_is_sequence(r->yaml, row) && abbe_yaml_count(r->yaml, row) == 2;
  return abbe_yaml_fail(r->yaml, row, r->error,
                        "'%s' of a conductor wants [nm, n, k] such as [550, 0.06, 3.6]%s", key,
                        pair ? "; this one has no k" : "");
}

abbe_result abbe_record_rows_read(abbe_record_reading *r, abbe_yaml_node list, const char *key,
                                  double min, double max, abbe_record_rows *out) {
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
      ABBE_TRY(abbe_yaml_number(
          r->yaml, abbe_yaml_item(r->yaml, row, k), key, k == 0 ? ABBE_SPECTRUM_LOW_NM : min,
          k == 0 ? ABBE_SPECTRUM_HIGH_NM : max, &out->column[k][i], r->error));
    }
    if (i > 0 && lambda_nm[i] <= lambda_nm[i - 1])
      return abbe_yaml_fail(r->yaml, row, r->error,
                            "'%s': %g nm follows %g nm; wavelengths must ascend", key, lambda_nm[i],
                            lambda_nm[i - 1]);
  }
  return ABBE_OK;
}

/* What a spectrum cannot be made of, as a complaint about the list. */
static abbe_result record_tell(abbe_record_reading *r, abbe_yaml_node list, const char *key,
                               abbe_result result, const abbe_error *why) {
  if (result == ABBE_INVALID_ARGUMENT)
    return abbe_yaml_fail(r->yaml, list, r->error, "'%s': %s", key, why->text);
  return result == ABBE_OK ? ABBE_OK : abbe_error_set(r->error, result, "%s", why->text);
}

abbe_result abbe_record_read_points(abbe_record_reading *r, abbe_yaml_node list, const char *key,
                                    double min, double max, abbe_interpolation interpolation,
                                    abbe_spectrum **out) {
  abbe_record_rows pairs = {.columns = 2};
  abbe_error why = {0};
  abbe_result result = abbe_record_rows_read(r, list, key, min, max, &pairs);
  if (result == ABBE_OK) {
    abbe_spectrum_free(*out);
    result =
        abbe_spectrum_make(pairs.column[0], pairs.column[1], pairs.count, interpolation, out, &why);
    result = record_tell(r, list, key, result, &why);
  }
  abbe_record_rows_free(&pairs);
  return result;
}

abbe_result abbe_record_read_range(abbe_record_reading *r, abbe_yaml_node where, const char *key,
                                   double *min_nm, double *max_nm) {
  double range[2] = {*min_nm, *max_nm};
  double low = r->lenient ? 1e-3 : ABBE_SPECTRUM_LOW_NM; /* a range in um is one to find */
  ABBE_TRY(
      abbe_yaml_get_numbers(r->yaml, where, key, 2, low, ABBE_SPECTRUM_HIGH_NM, range, r->error));
  if (range[0] >= range[1])
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, where, key), r->error,
                          "'%s: [%g, %g]' must name the smaller wavelength first", key, range[0],
                          range[1]);
  *min_nm = range[0];
  *max_nm = range[1];
  return ABBE_OK;
}

abbe_result abbe_record_read_interpolation(abbe_record_reading *r, abbe_yaml_node where,
                                           abbe_interpolation *interpolation) {
  int choice = (int)*interpolation;
  ABBE_TRY(
      abbe_yaml_get_choice(r->yaml, where, "interpolation", interpolations, &choice, r->error));
  *interpolation = (abbe_interpolation)choice;
  return ABBE_OK;
}

static abbe_result read_model(abbe_record_reading *r, abbe_yaml_node where,
                              abbe_dispersion_model *model) {
  const char *names[ABBE_DISPERSION_MODEL_COUNT + 1] = {NULL};
  for (int i = 0; i < ABBE_DISPERSION_MODEL_COUNT; i++)
    names[i] = abbe_dispersion_model_name((abbe_dispersion_model)i);
  abbe_yaml_node node;
  ABBE_TRY(abbe_yaml_require(r->yaml, where, "model", &node, r->error));
  int choice = 0;
  ABBE_TRY(abbe_yaml_get_choice(r->yaml, where, "model", names, &choice, r->error));
  *model = (abbe_dispersion_model)choice;
  return ABBE_OK;
}

static abbe_result read_conductor(abbe_record_reading *r, abbe_yaml_node points) {
  abbe_record_rows list = {.columns = 3};
  abbe_error why = {0};
  abbe_result result = abbe_record_rows_read(r, points, "points", 0, 1e3, &list);
  if (result == ABBE_OK) {
    result = abbe_conductor_make(list.column[0], list.column[1], list.column[2], list.count,
                                 &r->material->dispersion, &why);
    result = record_tell(r, points, "points", result, &why);
  }
  abbe_record_rows_free(&list);
  return result;
}

/* Pairs of nm and n, and how they are joined. */
static abbe_result read_pairs(abbe_record_reading *r, abbe_yaml_node where, abbe_dispersion *d) {
  abbe_yaml_node points;
  abbe_interpolation interpolation = ABBE_INTERPOLATION_MONOTONE;
  abbe_result result = abbe_yaml_require(r->yaml, where, "points", &points, r->error);
  if (result == ABBE_OK) result = abbe_record_read_interpolation(r, where, &interpolation);
  if (result != ABBE_OK || d->model == ABBE_DISPERSION_CONDUCTOR)
    return result == ABBE_OK ? read_conductor(r, points) : result;
  return abbe_record_read_points(r, points, "points", 1e-3, 1e3, interpolation, &d->table);
}

static abbe_result read_tabulated(abbe_record_reading *r, abbe_yaml_node own) {
  abbe_material *m = r->material;
  ABBE_TRY(read_pairs(r, own, &m->dispersion));
  const double *lambda_nm = abbe_spectrum_lambda_nm(m->dispersion.table);
  double low = lambda_nm[0], high = lambda_nm[abbe_spectrum_count(m->dispersion.table) - 1];
  m->min_nm = low;
  m->max_nm = high;
  if (abbe_yaml_get(r->yaml, r->record, "range_nm").id != 0)
    ABBE_TRY(abbe_record_read_range(r, r->record, "range_nm", &m->min_nm, &m->max_nm));
  if ((m->min_nm < low || m->max_nm > high))
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->record, "range_nm"), r->error,
                          "'range_nm: [%g, %g]' is wider than the points, which reach from %g to "
                          "%g nm",
                          m->min_nm, m->max_nm, low, high);
  return ABBE_OK;
}

static abbe_result read_coefficients(abbe_record_reading *r, abbe_yaml_node where,
                                     abbe_dispersion *d) {
  abbe_yaml_node node;
  ABBE_TRY(abbe_yaml_require(r->yaml, where, "coefficients", &node, r->error));
  double *c = NULL;
  ABBE_TRY(abbe_yaml_get_list(r->yaml, where, "coefficients", ABBE_DISPERSION_MAX_COEFFICIENTS, &c,
                              &d->count, r->error));
  memcpy(d->c, c, d->count * sizeof *c);
  free(c);
  abbe_error why;
  if (abbe_dispersion_check(d, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, node, r->error, "'coefficients': %s", why.text);
  return ABBE_OK;
}

static abbe_result read_formula(abbe_record_reading *r, abbe_yaml_node own) {
  abbe_material *m = r->material;
  abbe_result result = read_coefficients(r, own, &m->dispersion);
  if (result != ABBE_OK) return result;
  abbe_yaml_node node = {0};
  m->min_nm = ABBE_SPECTRUM_LOW_NM;
  m->max_nm = ABBE_SPECTRUM_HIGH_NM;
  if (m->dispersion.model != ABBE_DISPERSION_CONSTANT)
    result = abbe_record_require(r, "range_nm", &node);
  if (r->lenient && node.id == 0 && m->dispersion.model != ABBE_DISPERSION_CONSTANT) {
    m->min_nm = m->max_nm = 0;
    return ABBE_OK;
  }
  return result != ABBE_OK
             ? result
             : abbe_record_read_range(r, r->record, "range_nm", &m->min_nm, &m->max_nm);
}

/* A key that the model does not read would be silently without effect. */
static abbe_result check_idle_keys(abbe_record_reading *r, abbe_yaml_node where,
                                   abbe_dispersion_model model) {
  static const char *const of_points[] = {"coefficients", NULL};
  static const char *const of_formulas[] = {"points", "interpolation", NULL};
  static const char *const of_conductors[] = {
      "coefficients", "interpolation", "extrapolate",   "absorption", "fit",
      "n_d",          "v_d",           "extraordinary", "biaxial",    NULL};
  const char *const *idle = model == ABBE_DISPERSION_CONDUCTOR   ? of_conductors
                            : model == ABBE_DISPERSION_TABULATED ? of_points
                                                                 : of_formulas;
  for (; *idle != NULL; idle++) {
    abbe_yaml_node node = abbe_yaml_get(r->yaml, where, *idle);
    if (node.id != 0)
      return abbe_yaml_fail(r->yaml, node, r->error, "the model %s has no use for '%s'",
                            abbe_dispersion_model_name(model), *idle);
  }
  return ABBE_OK;
}

/* An index besides, over the range of the record's own: model and numbers under the key. */
static abbe_result read_second(abbe_record_reading *r, abbe_yaml_node parent, const char *key,
                               abbe_dispersion *d) {
  const abbe_yaml_node where = abbe_yaml_get(r->yaml, parent, key);
  char what[40];
  snprintf(what, sizeof what, "'%s'", key);
  if (!abbe_yaml_is_mapping(r->yaml, where))
    return abbe_yaml_fail(r->yaml, where, r->error,
                          "'%s' wants a model and its numbers, such as {model: cauchy, "
                          "coefficients: [1.48, 0.003]}",
                          key);
  static const char *const keys[] = {"model", "coefficients", "points", "interpolation"};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) abbe_yaml_get(r->yaml, where, keys[i]);
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, where, what, r->error));
  ABBE_TRY(read_model(r, where, &d->model));
  if (d->model == ABBE_DISPERSION_CONDUCTOR)
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, where, "model"), r->error,
                          "'%s' is a real index; the model conductor has n and k", key);
  ABBE_TRY(check_idle_keys(r, where, d->model));
  return d->model == ABBE_DISPERSION_TABULATED ? read_pairs(r, where, d)
                                               : read_coefficients(r, where, d);
}

/* The second index of a uniaxial crystal, or the outer two of a biaxial one. */
static abbe_result read_crystal(abbe_record_reading *r) {
  static const char *const names[] = {"alpha", "gamma"};
  abbe_material *m = r->material;
  abbe_result result = ABBE_OK;
  if (abbe_yaml_get(r->yaml, r->record, "extraordinary").id != 0)
    result = read_second(r, r->record, "extraordinary", &m->extraordinary);
  const abbe_yaml_node three = abbe_yaml_get(r->yaml, r->record, "biaxial");
  if (three.id == 0 || result != ABBE_OK) return result;
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    if (abbe_yaml_get(r->yaml, three, names[i]).id == 0)
      return abbe_yaml_fail(r->yaml, three, r->error, "'biaxial' wants '%s' too", names[i]);
    result = read_second(r, three, names[i], &m->outer[i]);
  }
  return result == ABBE_OK ? abbe_yaml_check_keys(r->yaml, three, "'biaxial'", r->error) : result;
}

/* Where the record's own index stands: in itself or, of a biaxial crystal, under beta. */
static abbe_result find_own(abbe_record_reading *r, abbe_yaml_node *own) {
  static const char *const keys[] = {"model", "coefficients", "points", "interpolation"};
  const abbe_yaml_node three = abbe_yaml_get(r->yaml, r->record, "biaxial");
  *own = r->record;
  if (three.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, three))
    return abbe_yaml_fail(r->yaml, three, r->error,
                          "'biaxial' wants 'alpha', 'beta' and 'gamma', each a model and its "
                          "numbers");
  const abbe_yaml_node beta = abbe_yaml_get(r->yaml, three, "beta");
  if (beta.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, beta))
    return abbe_yaml_fail(r->yaml, beta, r->error, "'beta' wants a model and its numbers");
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
    const abbe_yaml_node twice = abbe_yaml_get(r->yaml, r->record, keys[i]);
    if (twice.id != 0)
      return abbe_yaml_fail(r->yaml, twice, r->error,
                            "'%s' stands beside 'biaxial', whose 'beta' is the record's own index",
                            keys[i]);
    abbe_yaml_get(r->yaml, beta, keys[i]);
  }
  *own = beta;
  return abbe_yaml_check_keys(r->yaml, beta, "'beta'", r->error);
}

abbe_result abbe_record_read_dispersion(abbe_record_reading *r) {
  abbe_dispersion *d = &r->material->dispersion;
  abbe_yaml_node own;
  ABBE_TRY(find_own(r, &own));
  ABBE_TRY(read_model(r, own, &d->model));
  ABBE_TRY(check_idle_keys(r, r->record, d->model));
  bool points = d->model == ABBE_DISPERSION_TABULATED || d->model == ABBE_DISPERSION_CONDUCTOR;
  ABBE_TRY(points ? read_tabulated(r, own) : read_formula(r, own));
  ABBE_TRY(read_crystal(r));
  if (r->lenient) return ABBE_OK;
  abbe_error why;
  if (abbe_material_check(r->material, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, r->record, r->error, "%s", why.text);
  return ABBE_OK;
}
