/* gem_path.h: all that becomes of the light along one ray of the eye in a cut stone.
 *
 * By reciprocity the eye's ray is followed backwards. A stone is convex: what leaves it never comes
 * back, so at each face one part leaves for good and one goes on, and the tree of all paths is a
 * chain. Both are followed by their shares, by Fresnel's law (the mean of both polarisations,
 * abbe_interface_reflectance); nothing is decided by chance. Between faces the material absorbs.
 */
#ifndef ABBE_VALIDATION_GEM_GEM_PATH_H
#define ABBE_VALIDATION_GEM_GEM_PATH_H

#include "validation/gem/gem_stone.h"

#include <stdbool.h>
#include <stddef.h>

/* A path ends where it carries less than this share of the ray's light, or at its most faces; what
 * it still carries is kept account of. */
#define ABBE_GEM_LEAST_SHARE 1e-4f
enum { ABBE_GEM_MOST_FACES = 4096, ABBE_GEM_MOST_EXITS = 512 };

typedef struct abbe_gem_exit {
  float d[3];  /* unit, away from the stone: where light would come from */
  float share; /* of the ray's light */
} abbe_gem_exit;

/* The shares of all exits, absorbed and left add up to 1. */
typedef struct abbe_gem_path {
  size_t count;
  abbe_gem_exit exit[ABBE_GEM_MOST_EXITS]; /* the first is the outer face's reflection */
  float absorbed, left;
} abbe_gem_path;

/* Where the line o + t d, unit d, meets the stone from outside: the place and the outward normal of
 * the plane that it enters through; false where it passes by. */
bool abbe_gem_path_enter(const abbe_gem_stone *stone, const double o[3], const double d[3],
                         double p[3], double n[3]);

/* From a place and normal of abbe_gem_path_enter, at wavelength k of the stone. */
void abbe_gem_path_follow(const abbe_gem_stone *stone, size_t k, const double p[3],
                          const double n[3], const double d[3], abbe_gem_path *out);

#endif
