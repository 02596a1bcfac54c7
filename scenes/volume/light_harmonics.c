#include "scenes/volume/light_harmonics.h"

#include "base/gsl_guard.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>

#define PI 3.14159265358979323846

/* Associated Legendre functions over sin^m are polynomials of z; times the real and imaginary parts
 * of (x + i y)^m they need no angle. */
void abbe_light_harmonics_at(size_t degree, const double d[3], double *value) {
  double real = 1, imaginary = 0, first = sqrt(1 / (4 * PI));
  for (size_t m = 0; m <= degree; m++) {
    double before = 0, now = first; /* of degrees l - 1 and l, each with its norm */
    for (size_t l = m; l <= degree; l++) {
      const double both = m > 0 ? sqrt(2) : 1;
      value[l * (l + 1) + m] = both * now * real;
      if (m > 0) value[l * (l + 1) - m] = both * now * imaginary;
      const double n = (double)l + 1, mm = (double)(m * m);
      const double a = sqrt((4 * n * n - 1) / (n * n - mm));
      const double b = l > m ? sqrt(((n - 1) * (n - 1) - mm) / (4 * (n - 1) * (n - 1) - 1)) : 0;
      const double after = a * (d[2] * now - b * before);
      before = now;
      now = after;
    }
    const double next = real * d[0] - imaginary * d[1];
    imaginary = real * d[1] + imaginary * d[0];
    real = next;
    first *= sqrt((2 * (double)m + 3) / (2 * (double)m + 2));
  }
}

/* (B^T B)^-1 B^T of the harmonics B at the nodes. */
abbe_result abbe_light_harmonics_fit(const abbe_light_nodes *nodes, size_t degree, double *fit,
                                     abbe_error *error) {
  const size_t count = abbe_light_harmonics_count(degree);
  if (degree > ABBE_LIGHT_HARMONICS_MOST || count > nodes->count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "harmonics to degree %zu: it may be at most %d, and %zu coefficients ask "
                          "for as many nodes, of which there are %zu",
                          degree, ABBE_LIGHT_HARMONICS_MOST, count, nodes->count);
  abbe_gsl_guard_enter();
  gsl_matrix *square = gsl_matrix_calloc(count, count);
  abbe_gsl_guard_leave();
  if (square == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for harmonics");
  for (size_t j = 0; j < nodes->count; j++) {
    double value[ABBE_LIGHT_HARMONICS_MOST_COUNT];
    abbe_light_harmonics_at(degree, nodes->direction[j], value);
    for (size_t a = 0; a < count; a++)
      for (size_t b = 0; b < count; b++)
        gsl_matrix_set(square, a, b, gsl_matrix_get(square, a, b) + value[a] * value[b]);
  }
  abbe_gsl_guard_enter();
  const bool solved =
      gsl_linalg_cholesky_decomp1(square) == 0 && gsl_linalg_cholesky_invert(square) == 0;
  abbe_gsl_guard_leave();
  for (size_t j = 0; solved && j < nodes->count; j++) {
    double value[ABBE_LIGHT_HARMONICS_MOST_COUNT];
    abbe_light_harmonics_at(degree, nodes->direction[j], value);
    for (size_t a = 0; a < count; a++) {
      fit[a * nodes->count + j] = 0;
      for (size_t b = 0; b < count; b++)
        fit[a * nodes->count + j] += gsl_matrix_get(square, a, b) * value[b];
    }
  }
  gsl_matrix_free(square);
  return solved ? ABBE_OK
                : abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                                 "%zu nodes do not tell harmonics to degree %zu apart",
                                 nodes->count, degree);
}
