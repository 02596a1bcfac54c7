/* layer_detail.h: how finely a mesh that is known by its layers has to be drawn.
 *
 * A layer is read by photon cells and by samples of the picture; faces far below either tell
 * nothing of it. This says where that is so, and to within what distance a mesh then has to be
 * kept.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_LAYER_DETAIL_H
#define ABBE_GL_PLAN_EXAMINE_LAYER_DETAIL_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/view/view.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fewer faces are drawn as they are: they cost no more than the layer's own texels. */
enum { ABBE_LAYER_DETAIL_FACES = 2048 };

/* Whether refractor i's layers may be drawn with fewer faces than its mesh has. */
bool abbe_layer_detail_asks(const abbe_scene *scene, const abbe_plan *plan, size_t i);

/* Of those the one with the most faces, or NULL. */
const abbe_object *abbe_layer_detail_finest(const abbe_scene *scene, const abbe_plan *plan);

/* Whether there is one, and why, in a line for the plan. */
bool abbe_layer_detail_reason(const abbe_scene *scene, const abbe_plan *plan, char reason[160]);

/* Width, in metres, of one of the view's steps[0] x steps[1] parts (the narrower side of it) where
 * the mesh is nearest; 0 where some of the mesh lies beside or behind a perspective view. */
double abbe_layer_detail_step(const abbe_view *view, const size_t steps[2], const abbe_mesh *mesh);

/* Distance, in metres, to within which a mesh is kept: a share of the narrowest photon cell that
 * meets it and of the eye's narrowest sample, which may be INFINITY where nothing asks. */
double abbe_layer_detail_distance(double cell_m, double sample_m);

/* Whether so many of a mesh's faces are few enough to be drawn in place of all. */
bool abbe_layer_detail_saves(size_t kept, size_t faces);

#ifdef __cplusplus
}
#endif
#endif
