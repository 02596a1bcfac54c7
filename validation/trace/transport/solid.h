/* solid.h: refractors that are convex solids or spheres with nothing else inside of them.
 *
 * A ray inside such a refractor leaves it through the nearest of its planes ahead, or at the
 * sphere: no BVH is traversed. The planes are those of the scene's exact surface, which Embree
 * has as triangles. Frame units (geometry.h). A refractor that touches another surface, or is
 * nearer to it than what tells the two apart in single precision, is none.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_SOLID_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_SOLID_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SOLID_LANES 16 /* planes are filled up to a multiple of these */

struct abbe_geometry;

/* Neither a sphere nor of any planes: the refractor is no such solid. */
typedef struct abbe_solid {
  bool sphere;
  float centre[3], radius;
  size_t
      count; /* number of planes; a multiple of ABBE_SOLID_LANES: what fills it up is never met */
  float *plane[4]; /* [count] n . x = plane[3], n unit, outwards */
} abbe_solid;

/* One for each of the geometry's refractors, whose surfaces are known: solids[refractor_count].
 * ABBE_NO_MEMORY. */
abbe_result abbe_solids_make(const struct abbe_geometry *geometry, abbe_solid **solids,
                             abbe_error *error);
void abbe_solids_free(abbe_solid *solids, size_t count);

static inline bool abbe_solid_is(const abbe_solid *solid) {
  return solid->sphere || solid->count > 0;
}

/* Distance along unit d from o, inside the solid or on it, to where the ray leaves it, at least 0;
 * the place, on the sphere exactly, and the unit normal there, outwards. */
float abbe_solid_leave(const abbe_solid *solid, const float o[3], const float d[3], float p[3],
                       float n[3]);

#endif
