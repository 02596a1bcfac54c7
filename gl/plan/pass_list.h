/* pass_list.h: the plan's entries of a frame's passes, each with the fact that asks for it.
 *
 * Written when all facts are known; whether a pass runs is the table's to say (gl/plan/facts/passes.h).
 */
#ifndef ABBE_GL_PLAN_PASS_LIST_H
#define ABBE_GL_PLAN_PASS_LIST_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* Adds maps, passes and what stands between them in the order in which they run. */
void abbe_pass_list_add(const abbe_scene *scene, abbe_plan *plan);

#endif
