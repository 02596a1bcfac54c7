/* gem_lamps.h: a room of small lamps before a stone, in which its fire and its blinking are seen.
 *
 * Sixty lamps, 2 to 10 degrees across and of luminance 1, spread evenly over the hemisphere about
 * the eye's line as a spiral has it; all else is dark, and so is a lamp behind the head. They stay
 * with the eye while the stone is rocked. Each repeat turns the room by another angle, so that the
 * errors hold the lamps' places too.
 */
#ifndef ABBE_VALIDATION_GEM_GEM_LAMPS_H
#define ABBE_VALIDATION_GEM_GEM_LAMPS_H

#include "validation/gem/gem_eye.h"
#include "validation/gem/gem_path.h"

enum { ABBE_GEM_LAMPS = 60 };
#define ABBE_GEM_LAMP_MIN_DEG 2.0 /* across */
#define ABBE_GEM_LAMP_MAX_DEG 10.0

typedef struct abbe_gem_lamps {
  float x[64], y[64], z[64], cos_radius[64]; /* the stone's axes; those past the last have none */
} abbe_gem_lamps;

/* head_rad: half angle, 0: no head. */
abbe_gem_lamps abbe_gem_lamps_make(const abbe_gem_eye *eye, size_t repeat, double head_rad);

/* The share of the path's light that comes from lamps. */
float abbe_gem_lamps_light(const abbe_gem_lamps *lamps, const abbe_gem_path *path);

#endif
