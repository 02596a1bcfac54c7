/* haze_model.h: what the renderer makes of media that scatter: one number each for all wavelengths
 * in the air and around the eye, and what it leaves out.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_HAZE_MODEL_H
#define ABBE_GL_PLAN_EXAMINE_HAZE_MODEL_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* Fills the plan's facts; of a scene without haze nothing. */
void abbe_haze_model_choose(const abbe_scene *scene, abbe_plan *plan);
/* Its entry and notes, when all other facts are known. */
void abbe_haze_model_note(const abbe_scene *scene, abbe_plan *plan);

#endif
