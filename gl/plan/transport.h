/* transport.h: which model follows light through a refractor, and whether one after another.
 *
 * What the plan reads off the scene's objects; it adds nothing to the plan itself.
 */
#ifndef ABBE_GL_PLAN_TRANSPORT_H
#define ABBE_GL_PLAN_TRANSPORT_H

#include "base/error.h"
#include "gl/plan/plan_facts.h"
#include "scenes/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Signed distance of a point from the plane of a parallelogram (corner, edges u and v), m. */
double abbe_transport_side(const double parallelogram[9], const double at[3]);

/* Whether two refractors may overlap, to judge by their bounds. */
bool abbe_transport_overlap(const abbe_object *a, const abbe_object *b);

/* Whether light goes through the object as through air: clear, of air's index, and no bubble. The
 * plan's request is resolved. */
bool abbe_transport_invisible(const abbe_scene *scene, const abbe_object *object,
                              const abbe_plan *plan);

/* Why light that has left a refractor may meet one again, or a receiver within, as a sentence's
 * part; NULL: it cannot, or is not followed there. */
const char *abbe_transport_walk(const abbe_scene *scene, const abbe_plan *plan);

/* ABBE_UNSUPPORTED, by the object's name, where the model that is asked for cannot serve it. */
abbe_result abbe_transport_check(const abbe_object *object, const abbe_plan *plan,
                                 abbe_error *error);

/* The object's model and why, as a sentence's part, and why it is no better one; plan->walk is
 * known. */
abbe_refractor_model abbe_transport_model(const abbe_object *object, const abbe_plan *plan);
void abbe_transport_reason(const abbe_object *object, const abbe_plan *plan, char *text,
                           size_t size);

#ifdef __cplusplus
}
#endif
#endif
