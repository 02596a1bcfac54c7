#include "scenes/volume/light_modes.h"

#include "base/gsl_guard.h"
#include "scenes/volume/half.h"

#include <gsl/gsl_eigen.h>
#include <stdbool.h>
#include <stdlib.h>

enum { CHUNK = 64 }; /* of values at a time: they stay in the cache */

/* value[CHUNK][nodes] of the places from `from` on; their number. */
static size_t take_chunk(size_t nodes, size_t each, const uint16_t *value, size_t from,
                         double *out) {
  const size_t count = each - from < CHUNK ? each - from : CHUNK;
  for (size_t j = 0; j < nodes; j++)
    for (size_t i = 0; i < count; i++)
      out[i * nodes + j] = abbe_half_value(value[j * each + from + i]);
  return count;
}

/* Products of the values at each two nodes, the lower half: square[nodes][nodes]. */
static void multiply(size_t nodes, size_t each, const uint16_t *value, double *chunk,
                     double *square) {
  for (size_t from = 0; from < each; from += CHUNK) {
    const size_t count = take_chunk(nodes, each, value, from, chunk);
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t j = 0; j < nodes; j++)
      for (size_t i = 0; i < count; i++) {
        const double *at = chunk + i * nodes, own = at[j];
        if (own == 0) continue; /* most cells are dark */
        for (size_t k = 0; k <= j; k++) square[j * nodes + k] += own * at[k];
      }
  }
}

/* Eigenvalues of the products are squares of the singular values. */
static bool decompose(size_t nodes, double *square, double *singular, double *mode) {
  abbe_gsl_guard_enter();
  gsl_eigen_symmv_workspace *room = gsl_eigen_symmv_alloc(nodes);
  gsl_vector_view values = gsl_vector_view_array(singular, nodes);
  gsl_matrix_view products = gsl_matrix_view_array(square, nodes, nodes),
                  vectors = gsl_matrix_view_array(mode, nodes, nodes);
  const bool good =
      room != NULL &&
      gsl_eigen_symmv(&products.matrix, &values.vector, &vectors.matrix, room) == 0 &&
      gsl_eigen_symmv_sort(&values.vector, &vectors.matrix, GSL_EIGEN_SORT_VAL_DESC) == 0 &&
      gsl_matrix_transpose(&vectors.matrix) == 0;
  if (room != NULL) gsl_eigen_symmv_free(room);
  abbe_gsl_guard_leave();
  for (size_t k = 0; good && k < nodes; k++) {
    singular[k] = sqrt(fmax(singular[k], 0));
    for (size_t j = 0; j < nodes; j++) mode[k * nodes + j] *= sqrt((double)nodes);
  }
  return good;
}

abbe_result abbe_light_modes_find(size_t nodes, size_t each, const uint16_t *value,
                                  double *singular, double *mode, abbe_error *error) {
  if (nodes == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "modes of no nodes: 1 and more have some");
  double *square = calloc(nodes * nodes, sizeof *square);
  double *chunk = malloc(CHUNK * nodes * sizeof *chunk);
  bool good = square != NULL && chunk != NULL;
  if (good) multiply(nodes, each, value, chunk, square);
  good = good && decompose(nodes, square, singular, mode);
  free(square);
  free(chunk);
  return good
             ? ABBE_OK
             : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the modes of %zu nodes", nodes);
}
