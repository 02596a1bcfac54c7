/* precision.h: whether single precision and the photon grid resolve a scene's refractors.
 *
 * Shaders compute in floats, and photons are the cells of a grid. A refractor that is lost in
 * either would be drawn wrong or by chance; it is refused with what would be right. Receivers are
 * not judged. Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_PRECISION_H
#define ABBE_GL_PLAN_EXAMINE_PRECISION_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* ABBE_UNSUPPORTED, with a sentence, where some refractor of the plan is so far from a light that
 * its shape is lost (65536 of its radii), so thin that its front and back are one (2^-20 of that
 * distance), or, of the grid of four photons a side or more, less than half a cell wide; or where a
 * light with a cube of views is nearer to one than 1/4096 of half its diagonal. Default profile
 * only. */
abbe_result abbe_precision_check(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

#endif
