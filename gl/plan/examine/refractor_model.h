/* refractor_model.h: which model follows light through each refractor, and whether one after
 * another.
 *
 * What light does not notice is no refractor.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_REFRACTOR_MODEL_H
#define ABBE_GL_PLAN_EXAMINE_REFRACTOR_MODEL_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* Lists the scene's refractors in the plan, each with its model, and what their materials ask of
 * the wavelengths. ABBE_UNSUPPORTED, by the object's name, where a model that is asked for cannot
 * serve it, or for more than 255 of them; ABBE_OUT_OF_RANGE for an index that is not known. */
abbe_result abbe_refractor_model_choose(const abbe_scene *scene, abbe_plan *plan,
                                        abbe_error *error);

/* Notes what is left out where light is not followed from one to another. */
void abbe_refractor_model_note(const abbe_scene *scene, abbe_plan *plan);

#endif
