/* receiver_model.h: how light and the eye meet receivers, and whether one may hide another.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_RECEIVER_MODEL_H
#define ABBE_GL_PLAN_EXAMINE_RECEIVER_MODEL_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* Parallelograms as they come, as many as there is room for; triangles of all others. */
void abbe_receiver_model_choose(const abbe_scene *scene, abbe_plan *plan);

/* Receivers that bound a convex room with the lights inside cannot shadow one another. */
void abbe_receiver_model_shadows(const abbe_scene *scene, abbe_plan *plan);

/* Whether what it reflects varies over wavelength: that of a texture may. */
bool abbe_receiver_model_is_coloured(const abbe_object *object);

/* Whether light that refractors have spread may fall on a receiver in colours. */
bool abbe_receiver_model_disperses(const abbe_scene *scene, const abbe_plan *plan);

#endif
