#include "spectral/materials/record_reading.h"

#include <stdlib.h>

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

abbe_result abbe_record_tell(abbe_record_reading *r, abbe_yaml_node list, const char *key,
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
    result = abbe_record_tell(r, list, key, result, &why);
  }
  abbe_record_rows_free(&pairs);
  return result;
}

abbe_result abbe_record_read_range(abbe_record_reading *r, abbe_yaml_node where, const char *key,
                                   double *min_nm, double *max_nm) {
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

abbe_result abbe_record_read_interpolation(abbe_record_reading *r, abbe_yaml_node where,
                                           abbe_interpolation *interpolation) {
  int choice = (int)*interpolation;
  abbe_result result =
      abbe_yaml_get_choice(r->yaml, where, "interpolation", interpolations, &choice, r->error);
  *interpolation = (abbe_interpolation)choice;
  return result;
}
