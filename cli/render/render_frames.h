/* render_frames.h: frames of `abbe render --turntable` and `--frames A:B`, and the PNG that moves.
 *
 * A turntable's camera goes around its target about its own upward direction; nothing else moves,
 * so lights' passes are drawn once; or the piece turns the other way and they stay. Over time the
 * scene is read again for each frame, and the
 * renderer finds out what has moved. Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_RENDER_FRAMES_H
#define ABBE_CLI_RENDER_RENDER_FRAMES_H

#include "cli/render/render_request.h"

#include <argp.h>

/* --turntable and what goes with it. Its input is the request's abbe_frame_series. */
extern const struct argp abbe_render_frames_argp;

/* Draws and writes all frames of the request, with a bar: FILE-0001.exr and FILE-0001.png and so
 * on, and FILE.png of all, beside and renamed; of a part, its frames alone. statistics receives the
 * last frame's, and stays as it is where --resume leaves none to draw. The renderer holds the scene
 * itself again then. ABBE_CANCELLED by Ctrl-C: the frames so far are kept. */
abbe_result abbe_render_frames_draw(const abbe_render_request *request, const abbe_scene *scene,
                                    const abbe_render_desc *desc, abbe_renderer *renderer,
                                    const abbe_context *context, abbe_statistics *statistics,
                                    abbe_error *error);

#endif
