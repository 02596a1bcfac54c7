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
