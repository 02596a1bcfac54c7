/* turntable.h: a scene from all around: frames of `abbe render --turntable`, and the PNG that
 * moves.
 *
 * The camera goes around its target about its own upward direction; nothing else moves, so lights'
 * passes are drawn once. */
#ifndef ABBE_CLI_RENDER_TURNTABLE_H
#define ABBE_CLI_RENDER_TURNTABLE_H

#include "cli/render/render_request.h"

#include <argp.h>

#define ABBE_TURNTABLE_MAX_FRAMES 9999

/* --turntable and what goes with it. Its input is the request's abbe_turntable_options. */
extern const struct argp abbe_turntable_argp;

/* Draws and writes all frames of the request, with a bar: FILE-0001.exr and FILE-0001.png and so
 * on, and FILE.png of all, beside and renamed; of a part, its frames alone. statistics receives the
 * last frame's. The renderer holds the scene's own camera then. ABBE_CANCELLED by Ctrl-C: the
 * frames so far are kept. */
abbe_result abbe_turntable_draw(const abbe_render_request *request, const abbe_scene *scene,
                                const abbe_render_desc *desc, abbe_renderer *renderer,
                                const abbe_context *context, abbe_statistics *statistics,
                                abbe_error *error);

/* FILE.png of the numbered frames that other processes drew. Errors of abbe_animated_png_write. */
abbe_result abbe_turntable_merge(const abbe_render_request *request, abbe_error *error);

#endif
