/* render_check.h: the part of `abbe render` that estimates a picture's error by traced passes.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_RENDER_CHECK_H
#define ABBE_CLI_RENDER_RENDER_CHECK_H

#include "cli/render/render_request.h"
#include "cli/render/traced_picture.h"

/* Whether passes of the tracer are to estimate the rendered picture's error before it is
 * written. */
bool abbe_render_is_checked(const abbe_render_request *request);

/* The picture that is requested, to the tracer. */
abbe_traced_picture_desc abbe_render_describe_traced(const abbe_render_request *request);

/* The picture becomes what the passes made where that is the one that keeps the bound. */
abbe_result abbe_render_check_frame(abbe_render_request *request, const abbe_scene *scene,
                                    abbe_renderer *renderer, abbe_image *image, abbe_error *error);

/* With the files written, what is left of a budget goes into telling the picture's error: of one
 * with its caustic's layers, and of the frame that the renderer holds. */
abbe_result abbe_render_check_in_time(abbe_render_request *request, const abbe_scene *scene,
                                      const abbe_image *picture, abbe_error *error);
abbe_result abbe_render_check_frame_in_time(abbe_render_request *request, const abbe_scene *scene,
                                            abbe_renderer *renderer, abbe_error *error);

#endif
