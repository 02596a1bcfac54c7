/* view_hidden.h: the viewer in a window that nobody sees: EGL without a surface, and a picture of
 * it that can be read. Scripts lead it, and the page that is served. Internal to cli/view/. */
#ifndef ABBE_CLI_VIEW_VIEW_HIDDEN_H
#define ABBE_CLI_VIEW_VIEW_HIDDEN_H

#include "cli/view/view_app.h"

typedef struct abbe_view_hidden {
  abbe_view_session session;
  abbe_ui_input input; /* input of the next frame; wheel and text are used up by it */
  size_t width, height;
  abbe_context *context;
  const abbe_gl *gl;
  GLuint framebuffer, colour;
  double last_s;
} abbe_view_hidden;

/* There is one at a time. The pointer is outside at first. Errors of abbe_context_make and
 * abbe_view_app_begin; there is then nothing to end. */
abbe_result abbe_view_hidden_begin(abbe_view_hidden *hidden, const abbe_view_app_desc *desc,
                                   size_t width, size_t height, abbe_error *error);
void abbe_view_hidden_end(abbe_view_hidden *hidden);

/* Another size from the next frame on, pixels. */
void abbe_view_hidden_resize(abbe_view_hidden *hidden, size_t width, size_t height);
/* One frame. */
void abbe_view_hidden_frame(abbe_view_hidden *hidden);
/* As a window does between frames: until a worker has made something, or something changes by
 * itself, at most for so long, s. Only where the description says nobody else to be woken. */
void abbe_view_hidden_sleep(abbe_view_hidden *hidden, double most_s);
/* What it looks like: R, G, B a byte each, rows downward, malloc'd; NULL without memory. */
unsigned char *abbe_view_hidden_read(abbe_view_hidden *hidden);

/* The viewer led by a script, without a display: events, waiting, pictures of the whole window,
 * and assertions. docs/view.md has the commands. */

/* Runs the script in a window of that size that nobody sees. Errors name file, line and command:
 * ABBE_PARSE for what is no command, ABBE_TOLERANCE for what was asserted and is not so; and those
 * of abbe_context_make, abbe_view_app_begin. */
abbe_result abbe_view_script_run(const char *path, const abbe_view_app_desc *desc, size_t width,
                                 size_t height, abbe_error *error);

#endif
