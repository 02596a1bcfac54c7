/* view_app.h: the viewer as a whole, frame by frame: events in, jobs given and taken, a window's
 * picture drawn into the current context's framebuffer.
 *
 * It owns no window: cli/view/view_window.h and cli/view/view_script.h lend it a context and
 * events.
 */
#ifndef ABBE_CLI_VIEW_VIEW_APP_H
#define ABBE_CLI_VIEW_VIEW_APP_H

#include "cli/view/view_session.h"
#include "gl/device/context.h"

typedef struct abbe_view_app_desc {
  const abbe_view_document *document;
  const char *materials;             /* or NULL */
  const char *keep;                  /* what saved files are called, without an ending; or NULL */
  const char *ocio;                  /* configuration, or NULL */
  const char *volume_path;           /* or NULL; what it holds: */
  const abbe_caustic_volume *volume; /* that caustics are looked up in, for as long as it runs */
  abbe_view_stage last;              /* where refining ends; NONE: nowhere */
  void (*wake)(void);                /* or NULL */
} abbe_view_app_desc;

/* The context is current and stays so, with the widgets' in it. Errors of abbe_view_worker_make,
 * abbe_display_make, abbe_ui_make. */
abbe_result abbe_view_app_begin(abbe_view_session *app, const abbe_view_app_desc *desc,
                                abbe_context *context, abbe_error *error);
void abbe_view_app_end(abbe_view_session *app);

/* A key that is no widget's. */
void abbe_view_app_key(abbe_view_session *app, int key, bool down, int modifiers, double now_s);
/* One frame of a window of that size. */
void abbe_view_app_frame(abbe_view_session *app, const abbe_ui_input *input, double now_s);
/* How long nothing will change by itself, s; below 0: until the next event. */
double abbe_view_app_wait(abbe_view_session *app, double now_s);
/* Nothing is being done that a change has made obsolete. */
bool abbe_view_app_stopped(const abbe_view_session *app);
/* The window shows the picture that stands. */
bool abbe_view_app_painted(const abbe_view_session *app);
/* Everything that was asked for is drawn. */
bool abbe_view_app_rests(abbe_view_session *app, double now_s);

#endif
