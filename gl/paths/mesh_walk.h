/* mesh_walk.h: light's way from interface to interface of clear, isotropic meshes, and to receivers
 * that are parallelograms, on the processor's own threads, as walk.glsl has it on the device; its
 * names are that one's. Internal to gl/.
 */
#ifndef ABBE_GL_PATHS_MESH_WALK_H
#define ABBE_GL_PATHS_MESH_WALK_H

#include "gl/device/shader_maths.h"
#include "gl/scene/shader_variant.h"

#include <stddef.h>

enum { ABBE_WALK_PENDING = 4 };
#define ABBE_WALK_TOUCH 1e-5f /* receiver.glsl: in radii of the refractors' bounds */

/* Refractor and Receiver of common.glsl. */
typedef struct abbe_walk_refractor {
  float sphere[4];
  int model, root, planes, first_same;
} abbe_walk_refractor;
typedef struct abbe_walk_receiver {
  float anchor[4], u[4], v[4], normal[4], du[4], dv[4];
} abbe_walk_receiver;

typedef struct abbe_walk_scene {
  const abbe_gpu_scene *scene;
  const float (*triangles)[4], (*corners)[4];
  const abbe_walk_refractor *refractors;
  const abbe_walk_receiver *receivers;
  float refractor_radius, share_limit, least_share;
  int refractor_count, receiver_count, exits;
} abbe_walk_scene;

/* PathState, and how a path that ends left its last interface. */
typedef struct abbe_walk_path {
  v3 p, d, interface_n;
  float share;
  uint32_t inside, path;
  int interfaces, refractor;
  bool transmitted;
} abbe_walk_path;

typedef struct abbe_walk_interface {
  v3 p, n, face_n;
  float t;
  int refractor, facet;
} abbe_walk_interface;

/* Of one wavelength or band, in which refractor r has the index n[r * apart]. */
typedef struct abbe_walk {
  const abbe_walk_scene *of;
  const float *n;
  size_t apart;
  abbe_walk_path pending[ABBE_WALK_PENDING];
} abbe_walk;

/* Whether this follows what shaders of the variant would: where a processor would run them. */
bool abbe_walk_serves(const abbe_gpu_scene *scene, const abbe_shader_variant *variant);
/* The scene's tables, until abbe_gpu_unmap(). */
void abbe_walk_map(abbe_gpu_maps *maps, const abbe_gpu_scene *scene, int exits, float share_limit,
                   float least_share, abbe_walk_scene *out);

static inline int abbe_walk_medium(uint32_t inside) {
  return 31 - __builtin_clz(inside);
}
static inline float abbe_walk_n(const abbe_walk *w, uint32_t inside) {
  return inside == 0 ? 1 : w->n[(size_t)abbe_walk_medium(inside) * w->apart];
}
static inline float abbe_walk_dot4(const float plane[4], v3 x) {
  return dot(vector_at(plane), x);
}

/* The next interface on each of so many paths, at most ABBE_RAYS, that has light left; returns a
 * bit for each that meets one. Neighbours side by side cost least. */
unsigned abbe_walk_next(const abbe_walk_scene *of, const abbe_walk_path *const *at, int count,
                        abbe_walk_interface *out);
/* Both branches; false where the medium does not change. */
bool abbe_walk_split(const abbe_walk *w, abbe_walk_path *at, const abbe_walk_interface *h,
                     abbe_walk_path *mirrored);
/* The stronger branch goes on and the other waits; returns the share that is not followed. */
float abbe_walk_branch(abbe_walk *w, abbe_walk_path *at, const abbe_walk_interface *h);
/* The strongest branch that waits; of share 0: none does. */
abbe_walk_path abbe_walk_take(abbe_walk *w);
/* The nearest receiver with t_min < *t < t_max; -1: there is none. */
int abbe_walk_receiver_at(const abbe_walk_scene *of, v3 o, v3 d, float t_min, float t_max,
                          float *t);

#endif
