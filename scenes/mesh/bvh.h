/* bvh.h: a bounding volume hierarchy over triangles, and the nearest triangle on a ray.
 *
 * Binned by the surface area heuristic [Wald2007], flat, two children side by side, in single
 * precision boxes that hold the triangles' corners in double. The renderer's shaders traverse the
 * same nodes. It knows no normals and no materials.
 */
#ifndef ABBE_SCENES_MESH_BVH_H
#define ABBE_SCENES_MESH_BVH_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_BVH_MAX_DEPTH 56

/* As the shaders read it: two vec4. */
typedef struct abbe_bvh_node {
  float min[3];
  int32_t first; /* leaf: first triangle in the BVH's order; else first of two children */
  float max[3];
  int32_t count; /* leaf: triangles; else 0 */
} abbe_bvh_node;

typedef struct abbe_bvh {
  size_t node_count;   /* the root is the first */
  abbe_bvh_node *node; /* [node_count] */
  size_t triangle_count;
  uint32_t *triangle; /* [triangle_count] the BVH's order: index of the triangle given */
  size_t depth; /* inner nodes on the longest path down: what a traversal stacks at the most */
} abbe_bvh;

/* triangle[i]: three corners, metres; finite. ABBE_GEOMETRY without triangles, ABBE_CANCELLED by
 * the thread's watch (base/thread/watch.h), ABBE_NO_MEMORY; *out is then zeroed. */
abbe_result abbe_bvh_make(const double (*triangle)[9], size_t count, abbe_bvh *out,
                          abbe_error *error);
void abbe_bvh_free(abbe_bvh *bvh);

typedef struct abbe_bvh_hit {
  double t, u, v; /* barycentric, of the second and third corner */
  size_t index;   /* index of the triangle given */
} abbe_bvh_hit;

/* Nearest triangle on o + t d with t_min < t < t_max. side 1: only those that the ray meets against
 * their normal (counter-clockwise corners), -1: along it, 0: all. triangle: as it was made from. */
bool abbe_bvh_trace(const abbe_bvh *bvh, const double (*triangle)[9], const double o[3],
                    const double d[3], int side, double t_min, double t_max, abbe_bvh_hit *hit);

/* Meets one triangle, by the same rules. */
bool abbe_bvh_meet(const double triangle[9], const double o[3], const double d[3], int side,
                   double t_min, double t_max, abbe_bvh_hit *hit);

/* Corners of a mesh's faces, malloc'd; NULL: no memory. */
double (*abbe_bvh_triangles(const abbe_mesh *mesh))[9];

/* Parts of a mesh within which its normals do not break: group[face], from 0. Faces that share a
 * corner with its normal are of one part. Returns their number; 0: no memory. */
size_t abbe_bvh_parts(const abbe_mesh *mesh, uint32_t *group);

#endif
