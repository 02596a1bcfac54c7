#include "scenes/volume/caustic_volume.h"

#include "base/maths.h"
#include "scenes/volume/half.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double unit_matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static size_t count_of(const abbe_caustic_volume *v) {
  return v->nodes.count * v->region.cells * abbe_caustic_volume_channels(v);
}

abbe_result abbe_caustic_volume_allocate(abbe_caustic_volume *v, abbe_error *error) {
  const size_t each = v->region.cells * abbe_caustic_volume_channels(v);
  if (each == 0 || v->nodes.count == 0 || v->kind == ABBE_VOLUME_EXITS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a volume without nodes, cells or values");
  if (v->nodes.count > ABBE_CAUSTIC_VOLUME_MOST / each)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu nodes of %zu cells are more than a volume holds: ask for fewer of "
                          "either",
                          v->nodes.count, v->region.cells);
  v->value = calloc(count_of(v), sizeof *v->value);
  if (v->value != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu nodes of %zu cells",
                        v->nodes.count, v->region.cells);
}

void abbe_caustic_volume_free(abbe_caustic_volume *v) {
  if (v == NULL) return;
  abbe_volume_region_free(&v->region);
  abbe_light_nodes_free(&v->nodes);
  abbe_light_exits_free(&v->exits);
  free(v->value);
  *v = (abbe_caustic_volume){0};
}

size_t abbe_caustic_volume_bytes(const abbe_caustic_volume *v) {
  if (v->kind == ABBE_VOLUME_EXITS) return abbe_light_exits_bytes(&v->exits);
  return count_of(v) * (v->kind == ABBE_VOLUME_PRINTED ? 1 : sizeof *v->value);
}

abbe_volume_lookup abbe_caustic_volume_resolve(const abbe_caustic_volume *v,
                                               abbe_volume_lookup lookup) {
  if (v->nodes.count == 1) return ABBE_VOLUME_LOOKUP_TURN;
  if (lookup != ABBE_VOLUME_LOOKUP_AUTO) return lookup;
  return v->body.ball ? ABBE_VOLUME_LOOKUP_TURN : ABBE_VOLUME_LOOKUP_BLEND;
}

void abbe_caustic_volume_look(const abbe_caustic_volume *v, abbe_volume_lookup lookup,
                              const double to_light[3], abbe_volume_sight *out) {
  abbe_node_blend blend;
  lookup = abbe_caustic_volume_resolve(v, lookup);
  for (size_t k = 0; k < 3; k++) memcpy(out->turn[k], unit_matrix, sizeof unit_matrix);
  if (lookup == ABBE_VOLUME_LOOKUP_NEAREST)
    abbe_light_nodes_nearest(&v->nodes, to_light, &blend);
  else
    abbe_light_nodes_blend(&v->nodes, to_light, &blend);
  out->count = blend.count;
  for (size_t k = 0; k < blend.count; k++) {
    out->node[k] = blend.node[k];
    out->weight[k] = blend.weight[k];
    if (lookup == ABBE_VOLUME_LOOKUP_TURN)
      abbe_light_nodes_turn(to_light, v->nodes.direction[blend.node[k]], out->turn[k]);
  }
}

abbe_result abbe_caustic_volume_join(abbe_caustic_volume *v, double tolerance, size_t *bytes,
                                     abbe_error *error) {
  const size_t channels = abbe_caustic_volume_channels(v), each = v->region.cells * channels;
  abbe_volume_order order;
  *bytes = 0;
  if (v->kind != ABBE_VOLUME_VECTOR || v->value == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "cells of vectors alone are joined");
  abbe_result result = abbe_volume_order_make(&v->region, &order, error);
  for (size_t k = 0; k < v->nodes.count && result == ABBE_OK; k++) {
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

static const uint16_t *values_at(const abbe_caustic_volume *v, size_t node, size_t cell) {
  return v->value + (node * v->region.cells + cell) * abbe_caustic_volume_channels(v);
}

void abbe_caustic_volume_flux(const abbe_caustic_volume *v, const abbe_volume_sight *sight,
                              const double p[3], double f[3][3]) {
  double q[3];
  const double scale = fmin(clamp_place(&v->region, p, q), 1);
  memset(f, 0, 9 * sizeof(double));
  for (size_t k = 0; k < sight->count; k++) {
    const double *turn = sight->turn[k];
    double at[3], weight[8], sum[9] = {0};
    size_t cell[8];
    apply(turn, q, at);
    const size_t count = abbe_volume_region_between(&v->region, at, cell, weight);
    for (size_t i = 0; i < count; i++) {
      const uint16_t *value = values_at(v, sight->node[k], cell[i]);
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
    const uint16_t *value = values_at(v, sight->node[k], cell);
    for (int c = 0; c < 3; c++) rgb[c] += sight->weight[k] * v->byte * abbe_half_value(value[c]);
  }
}

/* ---- the order ---- */

static bool is_power_of_two(size_t n) {
  return n > 0 && (n & (n - 1)) == 0;
}

/* Bits of both or all three coordinates in turn. */
static size_t interleave(const size_t *at, size_t axes, size_t bits) {
  size_t out = 0;
  for (size_t b = 0; b < bits; b++)
    for (size_t k = 0; k < axes; k++) out |= (at[k] >> b & 1) << (b * axes + k);
  return out;
}

static size_t place_of(const abbe_volume_region *r, size_t cell, size_t levels) {
  const size_t row = cell / r->row, in = cell % r->row, side = r->desc.side;
  if (r->desc.kind == ABBE_REGION_GEODESIC) return cell; /* its faces follow each other by fours */
  const size_t at[3] = {in % side, in / side, row};
  if (r->desc.kind == ABBE_REGION_GRID) return interleave(at, 3, levels);
  return row * r->row + interleave(at, 2, levels);
}

abbe_result abbe_volume_order_make(const abbe_volume_region *r, abbe_volume_order *out,
                                   abbe_error *error) {
  const bool geodesic = r->desc.kind == ABBE_REGION_GEODESIC;
  *out = (abbe_volume_order){0};
  if (r->cells == 0) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a region without cells");
  *out = (abbe_volume_order){.cells = r->cells,
                             .branch = r->desc.kind == ABBE_REGION_GRID ? 8 : 4,
                             .levels = geodesic ? r->desc.levels : 0};
  if (!geodesic && !is_power_of_two(r->desc.side))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "cells are joined where a side has a power of two of them, 16, 32 or 64, "
                          "not %zu",
                          r->desc.side);
  for (size_t side = r->desc.side; !geodesic && side > 1; side /= 2) out->levels++;
  out->place = calloc(r->cells, sizeof *out->place);
  out->volume = calloc(r->cells, sizeof *out->volume);
  if (out->place == NULL || out->volume == NULL) {
    abbe_volume_order_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an order of cells");
  }
  for (size_t i = 0; i < r->cells; i++) {
    out->place[i] = (uint32_t)place_of(r, i, out->levels);
    out->volume[out->place[i]] = abbe_volume_region_volume(r, i);
  }
  return ABBE_OK;
}

void abbe_volume_order_free(abbe_volume_order *order) {
  if (order == NULL) return;
  free(order->place);
  free(order->volume);
  *order = (abbe_volume_order){0};
}

/* ---- joining ---- */

/* State of the joining: values by place, and at the first place of what is joined how far it
 * reaches. */
typedef struct joining {
  const abbe_volume_order *order;
  size_t channels;
  double tolerance;
  uint16_t *value; /* [cells][channels] as they were, by place */
  uint16_t *joint; /* [cells][channels] at the first place of each that is joined */
  uint8_t *level;  /* [cells] */
} joining;

/* The mean of the places [from, from + count); false where a value is too far from it. */
static bool mean_of(const joining *j, size_t from, size_t count, uint16_t *mean) {
  for (size_t c = 0; c < j->channels; c++) {
    double sum = 0, all = 0;
    for (size_t i = from; i < from + count; i++) {
      sum += j->order->volume[i] * abbe_half_value(j->value[i * j->channels + c]);
      all += j->order->volume[i];
    }
    mean[c] = abbe_half_of(sum / all);
    for (size_t i = from; i < from + count; i++) {
      const double was = abbe_half_value(j->value[i * j->channels + c]);
      if (!(fabs(was - abbe_half_value(mean[c])) <= j->tolerance)) return false;
    }
  }
  return true;
}

static void join_level(joining *j, size_t level, size_t count) {
  uint16_t mean[9];
  for (size_t from = 0; from + count <= j->order->cells; from += count) {
    bool whole = true;
    for (size_t k = 0; k < j->order->branch && whole; k++)
      whole = j->level[from + k * (count / j->order->branch)] == level - 1;
    if (!whole || !mean_of(j, from, count, mean)) continue;
    j->level[from] = (uint8_t)level;
    memcpy(j->joint + from * j->channels, mean, j->channels * sizeof *mean);
  }
}

static abbe_result gather(const joining *j, abbe_volume_tree *out, abbe_error *error) {
  size_t *size = calloc(j->order->levels + 1, sizeof *size), leaves = 0;
  for (size_t i = 0; size != NULL && i <= j->order->levels; i++)
    size[i] = i == 0 ? 1 : size[i - 1] * j->order->branch;
  for (size_t i = 0; size != NULL && i < j->order->cells; i += size[j->level[i]]) leaves++;
  *out = (abbe_volume_tree){.leaves = leaves};
  out->first = malloc((leaves + 1) * sizeof *out->first);
  out->value = malloc((leaves + 1) * j->channels * sizeof *out->value);
  const bool room = size != NULL && out->first != NULL && out->value != NULL;
  size_t leaf = 0;
  for (size_t i = 0; room && i < j->order->cells; i += size[j->level[i]], leaf++) {
    out->first[leaf] = (uint32_t)i;
    memcpy(out->value + leaf * j->channels, j->joint + i * j->channels,
           j->channels * sizeof *out->value);
  }
  free(size);
  if (room) return ABBE_OK;
  abbe_volume_tree_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu joint cells", leaves);
}

abbe_result abbe_volume_tree_make(const abbe_volume_order *order, size_t channels,
                                  const uint16_t *value, double tolerance, abbe_volume_tree *out,
                                  abbe_error *error) {
  *out = (abbe_volume_tree){0};
  if (!(tolerance >= 0) || channels < 1 || channels > 9)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu channels joined within %g; it may be 0 and more", channels,
                          tolerance);
  const size_t bytes = order->cells * channels * sizeof *value;
  joining j = {.order = order, .channels = channels, .tolerance = tolerance};
  j.value = malloc(bytes + 1);
  j.joint = malloc(bytes + 1);
  j.level = calloc(order->cells + 1, sizeof *j.level);
  abbe_result result = ABBE_OK;
  if (j.value == NULL || j.joint == NULL || j.level == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory to join cells");
  for (size_t i = 0; result == ABBE_OK && i < order->cells; i++)
    memcpy(j.value + order->place[i] * channels, value + i * channels, channels * sizeof *value);
  if (result == ABBE_OK) {
    memcpy(j.joint, j.value, bytes);
    size_t count = 1;
    for (size_t level = 1; level <= order->levels; level++)
      join_level(&j, level, count *= order->branch);
    result = gather(&j, out, error);
  }
  free(j.value);
  free(j.joint);
  free(j.level);
  return result;
}

void abbe_volume_tree_free(abbe_volume_tree *tree) {
  if (tree == NULL) return;
  free(tree->first);
  free(tree->value);
  *tree = (abbe_volume_tree){0};
}

/* ---- looking up ---- */

size_t abbe_volume_tree_find(const abbe_volume_tree *tree, const abbe_volume_order *order,
                             size_t cell) {
  size_t low = 0, high = tree->leaves;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (tree->first[middle] <= order->place[cell])
      low = middle;
    else
      high = middle;
  }
  return low;
}

void abbe_volume_tree_expand(const abbe_volume_tree *tree, const abbe_volume_order *order,
                             size_t channels, uint16_t *value) {
  for (size_t i = 0; i < order->cells; i++)
    memcpy(value + i * channels, tree->value + abbe_volume_tree_find(tree, order, i) * channels,
           channels * sizeof *value);
}
