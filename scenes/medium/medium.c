#include "scenes/medium/medium.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>

static abbe_result copy_spectrum(const abbe_spectrum *s, abbe_spectrum **out, abbe_error *error) {
  *out = NULL;
  if (s == NULL) return ABBE_OK;
  return abbe_spectrum_make(abbe_spectrum_lambda_nm(s), abbe_spectrum_value(s),
                            abbe_spectrum_count(s), abbe_spectrum_interpolation(s), out, error);
}

abbe_result abbe_medium_copy(const abbe_medium *m, abbe_medium **out, abbe_error *error) {
  *out = NULL;
  if (m == NULL) return ABBE_OK;
  abbe_medium *copy = malloc(sizeof *copy);
  if (copy == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a medium");
  *copy = *m;
  copy->absorption = NULL;
  abbe_result result = copy_spectrum(m->scattering, &copy->scattering, error);
  if (result == ABBE_OK) result = copy_spectrum(m->absorption, &copy->absorption, error);
  if (result == ABBE_OK)
    *out = copy;
  else
    abbe_medium_free(copy);
  return result;
}

void abbe_medium_free(abbe_medium *m) {
  if (m == NULL) return;
  abbe_spectrum_free(m->scattering);
  abbe_spectrum_free(m->absorption);
  free(m);
}

static double value_at(const abbe_spectrum *s, double lambda_nm) {
  return s != NULL ? abbe_spectrum_at(s, lambda_nm) : 0;
}

double abbe_medium_scattering(const abbe_medium *m, double lambda_nm) {
  return m != NULL ? value_at(m->scattering, lambda_nm) : 0;
}

double abbe_medium_absorption(const abbe_medium *m, double lambda_nm) {
  return m != NULL ? value_at(m->absorption, lambda_nm) : 0;
}

/* Linear between its points, so it varies where the range's ends or points within it differ. */
static bool varies(const abbe_spectrum *s, double low_nm, double high_nm) {
  if (s == NULL) return false;
  const double first = abbe_spectrum_at(s, low_nm);
  bool found = abbe_spectrum_at(s, high_nm) != first;
  for (size_t i = 0; i < abbe_spectrum_count(s); i++) {
    const double at = abbe_spectrum_lambda_nm(s)[i];
    found = found || (at > low_nm && at < high_nm && abbe_spectrum_value(s)[i] != first);
  }
  return found;
}

bool abbe_medium_is_coloured(const abbe_medium *m, double low_nm, double high_nm) {
  return m != NULL &&
         (varies(m->scattering, low_nm, high_nm) || varies(m->absorption, low_nm, high_nm));
}

double abbe_medium_phase(double g, double cosine) {
  const double square = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * ABBE_PI * square * sqrt(square));
}

bool abbe_medium_clip(const double min[3], const double max[3], const double o[3],
                      const double d[3], double *from, double *to) {
  for (int k = 0; k < 3; k++) {
    if (d[k] == 0) {
      if (!(o[k] >= min[k] && o[k] <= max[k])) return false;
      continue;
    }
    const double a = (min[k] - o[k]) / d[k], b = (max[k] - o[k]) / d[k];
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
  }
  return *from < *to;
}
