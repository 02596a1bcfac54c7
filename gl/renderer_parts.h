/* renderer_parts.h: the parts of a renderer made, changed and drawn: which of them a difference in
 * the scene or the request makes anew, and which passes a frame then runs. Its context is current.
 * Internal to gl/.
 */
#ifndef ABBE_GL_RENDERER_PARTS_H
#define ABBE_GL_RENDERER_PARTS_H

#include "gl/renderer_state.h"

/* Plans the scene, makes what it asks for, and takes over from what is there all that depends on
 * nothing that differs. Where the plan refuses the scene the renderer stays as it was; where a part
 * fails later it has none, and can be changed again. Errors as of abbe_renderer_change. */
abbe_result abbe_renderer_parts_change(abbe_renderer *r, const abbe_scene *scene,
                                       const abbe_render_desc *desc, abbe_error *error);
/* All, and the device's. */
void abbe_renderer_parts_free(abbe_renderer *r);

/* Runs what has not been run since it was made or changed. As abbe_renderer_frame. */
abbe_result abbe_renderer_parts_draw(abbe_renderer *r, abbe_render_progress progress, void *user,
                                     abbe_statistics *statistics, abbe_error *error);

/* ABBE_INVALID_ARGUMENT where the parts are not all there. */
abbe_result abbe_renderer_parts_check(const abbe_renderer *r, abbe_error *error);

/* As abbe_renderer_baseline. */
abbe_result abbe_renderer_parts_baseline(abbe_renderer *r, double *ms, abbe_error *error);

#endif
