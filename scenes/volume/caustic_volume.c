#include "scenes/volume/caustic_volume.h"

#include "base/gsl_guard.h"
#include "base/maths.h"
#include "scenes/volume/half.h"
#include "scenes/volume/volume_tree.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 64 }; /* of values at a time: they stay in the cache */

/* value[BATCH][nodes] of the places from `from` on; their number. */
static size_t take_chunk(size_t nodes, size_t each, const uint16_t *value, size_t from,
                         double *out) {
  const size_t count = each - from < BATCH ? each - from : BATCH;
  for (size_t j = 0; j < nodes; j++)
    for (size_t i = 0; i < count; i++)
      out[i * nodes + j] = abbe_half_value(value[j * each + from + i]);
  return count;
}

/* Products of the values at each two nodes, the lower half: square[nodes][nodes]. */
static void multiply(size_t nodes, size_t each, const uint16_t *value, double *chunk,
                     double *square) {
  for (size_t from = 0; from < each; from += BATCH) {
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
  double *chunk = malloc(BATCH * nodes * sizeof *chunk);
  bool good = square != NULL && chunk != NULL;
  if (good) multiply(nodes, each, value, chunk, square);
  good = good && decompose(nodes, square, singular, mode);
  free(square);
  free(chunk);
  return good
             ? ABBE_OK
             : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the modes of %zu nodes", nodes);
}

/* Associated Legendre functions over sin^m are polynomials of z; times the real and imaginary parts
 * of (x + i y)^m they need no angle. */
void abbe_light_harmonics_at(size_t degree, const double d[3], double *value) {
  double real = 1, imaginary = 0, first = sqrt(1 / (4 * ABBE_PI));
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

static const double unit_matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static size_t count_of(const abbe_caustic_volume *v) {
  return abbe_caustic_volume_blocks(v) * v->region.cells * abbe_caustic_volume_channels(v);
}

abbe_result abbe_caustic_volume_allocate(abbe_caustic_volume *v, abbe_error *error) {
  const size_t each = v->region.cells * abbe_caustic_volume_channels(v);
  if (each == 0 || v->nodes.count == 0 || v->kind == ABBE_VOLUME_EXITS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a volume without nodes, cells or values");
  if (abbe_caustic_volume_blocks(v) > ABBE_CAUSTIC_VOLUME_MOST / each)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu nodes of %zu cells are more than a volume holds: ask for fewer of "
                          "either",
                          v->nodes.count, v->region.cells);
  v->value = calloc(count_of(v), sizeof *v->value);
  v->mode = v->rank > 0 ? calloc(v->rank * v->nodes.count, sizeof *v->mode) : NULL;
  if (v->value != NULL && (v->mode != NULL || v->rank == 0)) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu nodes of %zu cells",
                        v->nodes.count, v->region.cells);
}

void abbe_caustic_volume_free(abbe_caustic_volume *v) {
  if (v == NULL) return;
  abbe_volume_region_free(&v->region);
  abbe_light_nodes_free(&v->nodes);
  abbe_light_exits_free(&v->exits);
  free(v->value);
  free(v->mode);
  *v = (abbe_caustic_volume){0};
}

size_t abbe_caustic_volume_bytes(const abbe_caustic_volume *v) {
  if (v->kind == ABBE_VOLUME_EXITS) return abbe_light_exits_bytes(&v->exits);
  return count_of(v) * (v->kind == ABBE_VOLUME_PRINTED ? 1 : sizeof *v->value) +
         v->rank * v->nodes.count * sizeof *v->mode;
}

abbe_volume_lookup abbe_caustic_volume_resolve(const abbe_caustic_volume *v,
                                               abbe_volume_lookup lookup) {
  if (abbe_caustic_volume_is_sum(v)) return ABBE_VOLUME_LOOKUP_BLEND;
  if (v->nodes.count == 1) return ABBE_VOLUME_LOOKUP_TURN;
  if (lookup != ABBE_VOLUME_LOOKUP_AUTO) return lookup;
  return v->body.ball ? ABBE_VOLUME_LOOKUP_TURN : ABBE_VOLUME_LOOKUP_BLEND;
}

static void look_at_harmonics(const abbe_caustic_volume *v, const double to_light[3],
                              abbe_volume_sight *out) {
  out->count = abbe_light_harmonics_count(v->degree);
  abbe_light_harmonics_at(v->degree, to_light, out->weight);
  for (size_t k = 0; k < out->count; k++) out->block[k] = k;
}

/* A mode between nodes is the mean of its values there. */
static void look_at_modes(const abbe_caustic_volume *v, const abbe_node_blend *blend,
                          abbe_volume_sight *out) {
  out->count = v->rank;
  for (size_t k = 0; k < v->rank; k++) {
    out->block[k] = k;
    out->weight[k] = 0;
    for (size_t i = 0; i < blend->count; i++)
      out->weight[k] +=
          blend->weight[i] * abbe_half_value(v->mode[k * v->nodes.count + blend->node[i]]);
  }
}

void abbe_caustic_volume_look(const abbe_caustic_volume *v, abbe_volume_lookup lookup,
                              const double to_light[3], abbe_volume_sight *out) {
  abbe_node_blend blend;
  lookup = abbe_caustic_volume_resolve(v, lookup);
  for (size_t k = 0; k < 3; k++) memcpy(out->turn[k], unit_matrix, sizeof unit_matrix);
  if (v->degree > 0) {
    look_at_harmonics(v, to_light, out);
    return;
  }
  if (lookup == ABBE_VOLUME_LOOKUP_NEAREST)
    abbe_light_nodes_nearest(&v->nodes, to_light, &blend);
  else
    abbe_light_nodes_blend(&v->nodes, to_light, &blend);
  if (v->rank > 0) {
    look_at_modes(v, &blend, out);
    return;
  }
  out->count = blend.count;
  for (size_t k = 0; k < blend.count; k++) {
    out->block[k] = blend.node[k];
    out->weight[k] = blend.weight[k];
    if (lookup == ABBE_VOLUME_LOOKUP_TURN)
      abbe_light_nodes_turn(to_light, v->nodes.direction[blend.node[k]], out->turn[k]);
  }
}

void abbe_caustic_volume_sum(const abbe_caustic_volume *v, const abbe_volume_sight *sight,
                             float *sums) {
  enum { CHUNK = 8192 }; /* sums that stay in the cache while blocks go by */
  const size_t each = v->region.cells * abbe_caustic_volume_channels(v);
#pragma omp parallel for
  for (size_t from = 0; from < each; from += CHUNK) {
    const size_t to = each - from < CHUNK ? each : from + CHUNK;
    memset(sums + from, 0, (to - from) * sizeof *sums);
    for (size_t k = 0; k < sight->count; k++) {
      const uint16_t *value = v->value + sight->block[k] * each;
      const float weight = (float)sight->weight[k];
      for (size_t i = from; i < to; i++) sums[i] += weight * (float)abbe_half_value(value[i]);
    }
  }
}

/* In place of values at nodes, sums of them by weights fit[count][nodes]. */
static abbe_result combine(abbe_caustic_volume *v, size_t count, const double *fit,
                           abbe_error *error) {
  const size_t nodes = v->nodes.count;
  const size_t each = v->region.cells * abbe_caustic_volume_channels(v);
  uint16_t *value = malloc(count * each * sizeof *value);
  if (value == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu sums of nodes", count);
#pragma omp parallel for
  for (size_t i = 0; i < each; i++)
    for (size_t k = 0; k < count; k++) {
      double sum = 0;
      for (size_t j = 0; j < nodes; j++)
        sum += fit[k * nodes + j] * abbe_half_value(v->value[j * each + i]);
      value[k * each + i] = abbe_half_of(sum);
    }
  free(v->value);
  v->value = value;
  return ABBE_OK;
}

abbe_result abbe_caustic_volume_project(abbe_caustic_volume *v, size_t degree, abbe_error *error) {
  const size_t nodes = v->nodes.count, count = abbe_light_harmonics_count(degree);
  if (v->kind != ABBE_VOLUME_VECTOR || degree == 0 || abbe_caustic_volume_is_sum(v) ||
      v->value == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "harmonics are made of a volume of vectors at nodes, to degree 1 to %d",
                          ABBE_LIGHT_HARMONICS_MOST);
  double *fit = malloc(count * nodes * sizeof *fit);
  abbe_result result = fit != NULL
                           ? abbe_light_harmonics_fit(&v->nodes, degree, fit, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for harmonics");
  if (result == ABBE_OK) result = combine(v, count, fit, error);
  free(fit);
  if (result == ABBE_OK) v->degree = degree;
  return result;
}

/* The values by the modes, over the number of nodes; the modes themselves as halves. */
static abbe_result keep_modes(abbe_caustic_volume *v, size_t rank, double *mode,
                              abbe_error *error) {
  const size_t count = rank * v->nodes.count;
  uint16_t *half = malloc(count * sizeof *half);
  if (half == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu modes", rank);
  for (size_t i = 0; i < count; i++) {
    half[i] = abbe_half_of(mode[i]);
    mode[i] /= (double)v->nodes.count;
  }
  const abbe_result result = combine(v, rank, mode, error);
  if (result != ABBE_OK) {
    free(half);
    return result;
  }
  v->mode = half;
  v->rank = rank;
  return ABBE_OK;
}

abbe_result abbe_caustic_volume_reduce(abbe_caustic_volume *v, size_t rank, double *left,
                                       abbe_error *error) {
  const size_t nodes = v->nodes.count;
  if (v->kind != ABBE_VOLUME_VECTOR || abbe_caustic_volume_is_sum(v) || v->value == NULL ||
      rank == 0 || rank > nodes || rank > ABBE_CAUSTIC_VOLUME_MOST_RANK)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu modes: they are made of a volume of vectors at nodes, 1 to %d of "
                          "them and to as many as there are nodes, %zu",
                          rank, ABBE_CAUSTIC_VOLUME_MOST_RANK, nodes);
  double *mode = malloc((nodes + 1) * nodes * sizeof *mode);
  if (mode == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu modes", nodes);
  double *singular = mode + nodes * nodes, all = 0, out = 0;
  abbe_result result = abbe_light_modes_find(
      nodes, v->region.cells * abbe_caustic_volume_channels(v), v->value, singular, mode, error);
  for (size_t k = nodes; result == ABBE_OK && k-- > 0;) {
    all += singular[k] * singular[k];
    if (k >= rank) out = all;
  }
  if (result == ABBE_OK) result = keep_modes(v, rank, mode, error);
  free(mode);
  *left = result == ABBE_OK && all > 0 ? sqrt(out / all) : 0;
  return result;
}

abbe_result abbe_caustic_volume_join(abbe_caustic_volume *v, double tolerance, size_t *bytes,
                                     abbe_error *error) {
  const size_t channels = abbe_caustic_volume_channels(v), each = v->region.cells * channels;
  abbe_volume_order order;
  *bytes = 0;
  if (v->kind != ABBE_VOLUME_VECTOR || v->value == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "cells of vectors alone are joined");
  abbe_result result = abbe_volume_order_make(&v->region, &order, error);
  for (size_t k = 0; k < abbe_caustic_volume_blocks(v) && result == ABBE_OK; k++) {
    abbe_volume_tree tree;
    result = abbe_volume_tree_make(&order, channels, v->value + k * each, tolerance, &tree, error);
    if (result != ABBE_OK) break;
    *bytes += abbe_volume_tree_bytes(&tree, channels);
    abbe_volume_tree_expand(&tree, &order, channels, v->value + k * each);
    abbe_volume_tree_free(&tree);
  }
  abbe_volume_order_free(&order);
  return result;
}

/* Into the region, towards its centre or away from it; the share of the distance that is left. */
static double clamp_place(const abbe_volume_region *r, const double p[3], double q[3]) {
  const bool grid = r->desc.kind == ABBE_REGION_GRID;
  const double most = 1 - 1e-9;
  double size = grid ? fmax(fmax(fabs(p[0]), fabs(p[1])), fabs(p[2])) : abbe_vector_length(p);
  double scale = size > most * r->desc.outer ? most * r->desc.outer / size : 1;
  if (!grid && size < r->desc.inner && size > 0) scale = r->desc.inner * (1 + 1e-9) / size;
  for (int k = 0; k < 3; k++) q[k] = scale * p[k];
  return scale;
}

static void apply(const double m[9], const double p[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = abbe_vector_dot(&m[3 * i], p);
}

static const uint16_t *values_at(const abbe_caustic_volume *v, size_t block, size_t cell) {
  return v->value + (block * v->region.cells + cell) * abbe_caustic_volume_channels(v);
}

void abbe_caustic_volume_flux(const abbe_caustic_volume *v, const abbe_volume_sight *sight,
                              const double p[3], double f[3][3]) {
  double q[3];
  const double scale = fmin(clamp_place(&v->region, p, q), 1);
  memset(f, 0, 9 * sizeof(double));
  for (size_t k = 0; k < sight->count; k++) {
    const double *turn = sight->turn[k < 3 ? k : 0];
    double at[3], weight[8], sum[9] = {0};
    size_t cell[8];
    apply(turn, q, at);
    const size_t count = abbe_volume_region_between(&v->region, at, cell, weight);
    for (size_t i = 0; i < count; i++) {
      const uint16_t *value = values_at(v, sight->block[k], cell[i]);
      for (int c = 0; c < 9; c++) sum[c] += weight[i] * abbe_half_value(value[c]);
    }
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) /* turned back */
          f[c][i] += sight->weight[k] * scale * scale * turn[3 * j + i] * sum[3 * c + j];
  }
}

void abbe_caustic_volume_ratio(const abbe_caustic_volume *v, const abbe_volume_sight *sight,
                               const double p[3], double rgb[3]) {
  double q[3];
  clamp_place(&v->region, p, q);
  for (int c = 0; c < 3; c++) rgb[c] = 0;
  for (size_t k = 0; k < sight->count; k++) {
    double at[3];
    size_t cell;
    apply(sight->turn[k], q, at);
    if (!abbe_volume_region_look_up(&v->region, at, &cell)) continue;
    const uint16_t *value = values_at(v, sight->block[k], cell);
    for (int c = 0; c < 3; c++) rgb[c] += sight->weight[k] * v->byte * abbe_half_value(value[c]);
  }
}
