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
