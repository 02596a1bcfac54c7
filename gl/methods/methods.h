/* methods.h: the published methods as the renderer knows them: one that the plan chooses is made,
 * run and read, whichever it is. Internal to gl/.
 */
#ifndef ABBE_GL_METHODS_METHODS_H
#define ABBE_GL_METHODS_METHODS_H

#include "gl/methods/image_space/method.h"

/* *out stays NULL where the plan's profile has no passes of its own. Errors of its parts. */
abbe_result abbe_method_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                             abbe_method **out, abbe_error *error);
/* And none: *method is NULL afterwards. */
void abbe_method_free(abbe_method **method);
/* lit: the light's passes have run and hold, so that the camera's alone run where they keep it.
 * ABBE_GL. */
abbe_result abbe_method_run(abbe_method *method, bool lit, abbe_error *error);
/* Whether a moved camera leaves what the light's passes make as it is: maps in the light's image,
 * or photons, that hold no frames before. abbe_method_look then follows the camera; the picture's
 * size is as it was. */
bool abbe_method_keeps_light(const abbe_render_desc *desc);
void abbe_method_look(abbe_method *method);

/* The frames that a filter over time goes on with, from a method (or NULL) that is freed to the one
 * that is made in its place, where their images are alike; what is left of them is the caller's to
 * drop. */
void abbe_method_leave(abbe_method *method, abbe_method_history *out);
void abbe_method_follow(abbe_method *method, abbe_method_history *frames);

/* As of abbe_renderer_read and _read_map; filled: after the method's gap fill, where it has one. */
abbe_result abbe_method_read(const abbe_method *method, abbe_image *out, abbe_error *error);
abbe_result abbe_method_read_map(abbe_method *method, bool filled, abbe_image *out,
                                 abbe_error *error);
/* Counts for the last frame with statistics: photons, their cells, polygons over a pixel. */
void abbe_method_count(const abbe_method *method, abbe_statistics *statistics);

#endif
