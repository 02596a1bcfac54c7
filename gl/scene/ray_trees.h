/* ray_trees.h: rays meeting the triangles of hierarchies on the processor's own threads, as
 * hierarchy.glsl does on the device: of the same triangles the same are met. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_RAY_TREES_H
#define ABBE_GL_SCENE_RAY_TREES_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ABBE_RAY_CHILDREN = 8 };

/* Box and cone of normals of each child, and what it leads to: a node, or the complement of a
 * leaf's first triangle << 3 | count. A missing child's box is empty. */
typedef struct abbe_ray_node {
  float low[3][ABBE_RAY_CHILDREN], high[3][ABBE_RAY_CHILDREN];
  float axis[3][ABBE_RAY_CHILDREN], sine[ABBE_RAY_CHILDREN];
  int32_t child[ABBE_RAY_CHILDREN];
} abbe_ray_node;

typedef struct abbe_ray_trees {
  abbe_ray_node *node;
  size_t count, capacity;
} abbe_ray_trees;

/* Adds the tree at texel `root` of nodes as abbe_bvh_nodes_pack() makes them; *at: its node.
 * ABBE_NO_MEMORY. */
abbe_result abbe_ray_trees_add(abbe_ray_trees *trees, const uint32_t (*texel)[4], size_t root,
                               size_t *at, abbe_error *error);
void abbe_ray_trees_free(abbe_ray_trees *trees);

/* As hierarchy.glsl has them. */
typedef struct abbe_ray_hit {
  float t, u, v;
  int triangle; /* -1: none */
} abbe_ray_hit;

/* The nearest triangle of the tree at node `root` with t_min < t < hit->t, which goes to *hit.
 * side 1: only those that the ray meets against their normal, -1: along it. triangle: a corner and
 * two edges each. */
bool abbe_ray_trees_meet(const abbe_ray_trees *trees, size_t root, const float (*triangle)[4],
                         const float o[3], const float d[3], float side, float t_min,
                         abbe_ray_hit *hit);

#endif
