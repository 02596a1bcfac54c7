#include "scenes/volume/sphere_mesh.h"

#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

static abbe_result make_one(const double axis[3], abbe_light_nodes *out, abbe_error *error) {
  out->direction = malloc(sizeof *out->direction);
  if (out->direction == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a node");
  memcpy(out->direction[0], axis, sizeof out->direction[0]);
  out->count = 1;
  if (abbe_vector_normalise(out->direction[0])) return ABBE_OK;
  abbe_light_nodes_free(out);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a node's direction has no length");
}

abbe_result abbe_light_nodes_make(size_t count, const double axis[3], abbe_light_nodes *out,
                                  abbe_error *error) {
  *out = (abbe_light_nodes){0};
  if (count == 1) return make_one(axis, out, error);
  for (size_t levels = 0; levels <= 4; levels++) {
    if (count != ((size_t)10 << 2 * levels) + 2) continue;
    abbe_result result = abbe_sphere_mesh_geodesic(levels, &out->mesh, error);
    out->count = result == ABBE_OK ? count : 0;
    out->direction = out->mesh.corner;
    return result;
  }
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%zu light nodes; it may be 1, 12, 42, 162, 642 or 2562", count);
}

void abbe_light_nodes_free(abbe_light_nodes *nodes) {
  if (nodes == NULL) return;
  if (nodes->direction != nodes->mesh.corner) free(nodes->direction);
  abbe_sphere_mesh_free(&nodes->mesh);
  *nodes = (abbe_light_nodes){0};
}

void abbe_light_nodes_blend(const abbe_light_nodes *nodes, const double to_light[3],
                            abbe_node_blend *out) {
  *out = (abbe_node_blend){.count = 1, .weight = {1}};
  if (nodes->count < 2) return;
  const size_t face = abbe_sphere_mesh_find(&nodes->mesh, to_light);
  out->count = 3;
  for (int k = 0; k < 3; k++) out->node[k] = nodes->mesh.face[face][k];
  abbe_sphere_mesh_weights(&nodes->mesh, face, to_light, out->weight);
}

void abbe_light_nodes_nearest(const abbe_light_nodes *nodes, const double to_light[3],
                              abbe_node_blend *out) {
  abbe_node_blend three;
  abbe_light_nodes_blend(nodes, to_light, &three);
  /* triangles of the geodesic are acute: the nearest corner of all is one of the triangle's */
  size_t best = three.node[0];
  for (size_t k = 1; k < three.count; k++)
    if (abbe_vector_dot(nodes->direction[three.node[k]], to_light) >
        abbe_vector_dot(nodes->direction[best], to_light))
      best = three.node[k];
  *out = (abbe_node_blend){.count = 1, .node = {best}, .weight = {1}};
}

void abbe_light_nodes_turn(const double from[3], const double to[3], double turn[9]) {
  double axis[3], c = abbe_vector_dot(from, to);
  abbe_vector_cross(from, to, axis);
  double s = abbe_vector_length(axis);
  if (!(s > 1e-12)) {
    const double other[3] = {fabs(from[0]) < 0.6, fabs(from[0]) >= 0.6, 0};
    abbe_vector_cross(from, other, axis);
    c = c < 0 ? -1 : 1;
    s = 0;
  }
  abbe_vector_normalise(axis);
  const double x = axis[0], y = axis[1], z = axis[2], v = 1 - c;
  const double rows[9] = {c + x * x * v,     x * y * v - z * s, x * z * v + y * s,
                          x * y * v + z * s, c + y * y * v,     y * z * v - x * s,
                          x * z * v - y * s, y * z * v + x * s, c + z * z * v};
  memcpy(turn, rows, sizeof rows);
}
