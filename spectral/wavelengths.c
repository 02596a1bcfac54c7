#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>

static abbe_result check(size_t count, double min_nm, double max_nm, abbe_error *error) {
  if (count < 1 || count > ABBE_WAVELENGTHS_MAX_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu wavelengths are asked for; 1 to %d are possible", count,
                          ABBE_WAVELENGTHS_MAX_COUNT);
  if (!isfinite(min_nm) || !isfinite(max_nm) || min_nm <= 0 || min_nm >= max_nm)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g:%g nm is not one; two finite wavelengths above 0, the "
                          "smaller first, are needed, such as 380:780",
                          min_nm, max_nm);
  return ABBE_OK;
}

/* Evenly spaced; both ends are exact. */
static double node(size_t i, size_t count, double min_nm, double max_nm) {
  if (count == 1) return min_nm + (max_nm - min_nm) / 2;
  if (i == count - 1) return max_nm;
  return min_nm + (max_nm - min_nm) * ((double)i / (double)(count - 1));
}

static abbe_result make(size_t count, const double *lambda_nm, double min_nm, double max_nm,
                        abbe_wavelengths *out, abbe_error *error) {
  *out = (abbe_wavelengths){0};
  ABBE_TRY(check(count, min_nm, max_nm, error));
  abbe_wavelengths made = {.count = count,
                           .lambda_nm = malloc(count * sizeof(double)),
                           .edge_nm = malloc((count + 1) * sizeof(double))};
  if (made.lambda_nm == NULL || made.edge_nm == NULL) {
    abbe_wavelengths_free(&made);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu wavelengths", count);
  }
  for (size_t i = 0; i < count; i++)
    made.lambda_nm[i] = lambda_nm != NULL ? lambda_nm[i] : node(i, count, min_nm, max_nm);
  made.edge_nm[0] = min_nm;
  made.edge_nm[count] = max_nm;
  for (size_t i = 1; i < count; i++)
    made.edge_nm[i] = made.lambda_nm[i - 1] + (made.lambda_nm[i] - made.lambda_nm[i - 1]) / 2;
  for (size_t i = 0; i < count; i++) {
    if (made.edge_nm[i] < made.edge_nm[i + 1]) continue;
    abbe_wavelengths_free(&made);
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %.17g:%.17g nm is too narrow to hold %zu wavelengths", min_nm,
                          max_nm, count);
  }
  *out = made;
  return ABBE_OK;
}

abbe_result abbe_wavelengths_make(size_t count, double min_nm, double max_nm, abbe_wavelengths *out,
                                  abbe_error *error) {
  return make(count, NULL, min_nm, max_nm, out, error);
}

abbe_result abbe_wavelengths_of_nodes(size_t count, const double *lambda_nm, double min_nm,
                                      double max_nm, abbe_wavelengths *out, abbe_error *error) {
  return make(count, lambda_nm, min_nm, max_nm, out, error);
}

void abbe_wavelengths_free(abbe_wavelengths *wavelengths) {
  if (wavelengths == NULL) return;
  free(wavelengths->lambda_nm);
  free(wavelengths->edge_nm);
  *wavelengths = (abbe_wavelengths){0};
}
