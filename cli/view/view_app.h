/* view_app.h: the viewer as a whole, frame by frame: events in, jobs given and taken, a window's
 * picture drawn into the current context's framebuffer.
 *
 * It owns no window: view_window.c and view_hidden.c lend it a context and
 * events. Internal to cli/view/.
 */
#ifndef ABBE_CLI_VIEW_VIEW_APP_H
#define ABBE_CLI_VIEW_VIEW_APP_H

#include "cli/view/view_session.h"
#include "gl/device/context.h"

/* Pictures over the network protocol of tev [Tev], from this machine alone (127.0.0.1): a thread
 * receives what up to 8 programs send, in packets of up to 256 MiB, and closes the connection of
 * what is no packet. */

/* Listens at *port, 0: at a free one, which it becomes. ABBE_IO where it is taken, ABBE_NO_MEMORY;
 * *out is to be ended then too. */
abbe_result abbe_view_listen_begin(unsigned *port, abbe_view_listener **out, abbe_error *error);
/* Begins to receive; wake may be NULL, and is called after each packet. */
abbe_result abbe_view_listen_start(abbe_view_listener *listener, void (*wake)(void),
                                   abbe_error *error);
/* The next packet, malloc'd and not checked against any picture; of size 0 a sentence, or NULL: why
 * a connection was closed. False: there is none. */
bool abbe_view_listen_take(abbe_view_listener *listener, unsigned char **bytes, size_t *size);
/* Nothing wakes any more. */
void abbe_view_listen_stop(abbe_view_listener *listener);
void abbe_view_listen_end(abbe_view_listener *listener);

typedef struct abbe_view_app_desc {
  const abbe_view_document *document;
  const char *materials;             /* or NULL */
  const char *keep;                  /* what saved files are called, without an ending; or NULL */
  const char *ocio;                  /* configuration, or NULL */
  const char *volume_path;           /* or NULL; what it holds: */
  const abbe_caustic_volume *volume; /* that caustics are looked up in, for as long as it runs */
  abbe_inspect *pictures;       /* instead of a document; NULL: none. They outlive the viewer */
  abbe_view_listener *listener; /* of pictures; or NULL */
  abbe_view_stage last;         /* where refining ends; NONE: nowhere */
  void (*wake)(void);           /* or NULL */
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
/* Everything that was requested is drawn. */
bool abbe_view_app_rests(abbe_view_session *app, double now_s);

/* What a viewer requests of its last picture at rest: the spectral map, where the picked pixel's
 * light has come in, and its spectrum.
 *
 * Each is requested once, of the worker that has drawn the picture. */

/* The next question, into the request; false: there is none. */
bool abbe_view_asks_want(const abbe_view_session *session, abbe_view_request *out);
/* The request has been given to a worker. */
void abbe_view_asks_note(abbe_view_session *session, const abbe_view_request *request);
/* Takes over what the worker has found. */
void abbe_view_asks_take(abbe_view_session *session, abbe_view_result *result);
/* The session's spectrum, if there is one, is that of the picked pixel as it is seen now. */
bool abbe_view_asks_has_spot(const abbe_view_session *session);

/* Light return, ISO and windows of the scene's first designs (`shape: cut`) at the angles that
 * their sliders have, as the library's gem report has them. */

/* Takes what has been judged, and begins what is to be judged next. */
void abbe_view_judge_frame(abbe_view_session *session);
void abbe_view_judge_end(abbe_view_session *session);
/* Nothing is judged and nothing is left to be. */
bool abbe_view_judge_rests(const abbe_view_session *session);
bool abbe_view_judge_has_design(const abbe_view_session *session);
/* Keeps what is seen and begins KEEP-report.pdf, the report of the first design as it is cut now,
 * by abbe gem retarget and report; a note says when it is there. Errors of abbe_view_keep;
 * ABBE_INVALID_ARGUMENT where there is no design. */
abbe_result abbe_view_report_begin(abbe_view_session *session, abbe_error *error);
void abbe_view_report_frame(abbe_view_session *session);
/* What is known of the outline's object; NULL: nothing. */
const abbe_view_judged *abbe_view_judge_of(const abbe_view_session *session,
                                           const abbe_view_object *object);

/* What is drawn over the picture: handles, the picked pixel, and what feeds that. */

/* Between abbe_ui_begin and the panel. */
void abbe_view_marks_draw(const abbe_view_session *session);

/* The panel beside the picture: scene, settings, errors, plan, ledger, a pixel. */

/* Within an open panel. What it changes goes into the session's state. */
void abbe_view_panel_draw(abbe_view_session *session, double now_s);
/* A name and a value, as printf has it. */
void abbe_view_panel_pair(const char *name, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* The list of displays and views. */
void abbe_view_panel_display(abbe_view_session *session);

/* Pictures instead of a scene (cli/view/inspect): the same window, where session->pictures is not
 * NULL. Each is what the function abbe_view_app_... of that name does. */

abbe_result abbe_view_inspect_begin(abbe_view_session *session, abbe_error *error);
void abbe_view_inspect_end(abbe_view_session *session);
void abbe_view_inspect_key(abbe_view_session *session, int key);
void abbe_view_inspect_frame(abbe_view_session *session, const abbe_ui_input *input);

/* The turntable of the viewer: pictures from all around, kept as PNG, and one PNG that moves. */

enum { ABBE_VIEW_TURN_FRAMES = 36 };
#define ABBE_VIEW_TURN_PER_SECOND 12.0

/* Begins: KEEP-turn-0001.png and so on, and KEEP-turn.png at the end; a note says how far it is. A
 * change of anything ends it. ABBE_INVALID_ARGUMENT where no picture has come to rest. */
abbe_result abbe_view_turn_begin(abbe_view_session *session, abbe_error *error);
/* The next frame as a request; false where none is wanted. */
bool abbe_view_turn_wants(const abbe_view_session *session, abbe_view_request *out);
/* Keeps a frame that was requested. */
void abbe_view_turn_take(abbe_view_session *session, const abbe_view_result *result);

/* The viewer in a window, by GLFW. */

/* Until the window is closed. ABBE_GL where there is no display, or one without OpenGL 4.5; errors
 * of abbe_view_app_begin. */
abbe_result abbe_view_window_run(const abbe_view_app_desc *desc, size_t width, size_t height,
                                 abbe_error *error);

/* The viewer as a page for a browser, for those who work on a server: the window that nobody sees,
 * over HTTP on the loopback, for who has the token. */

/* Prints the address with its token on standard output and serves until SIGINT, SIGTERM or SIGHUP
 * come. port 0: any free one. ABBE_UNSUPPORTED in a build without libmicrohttpd, ABBE_IO where the
 * port is taken; errors of abbe_view_hidden_begin.
 *
 *   GET  /?token=T                    the page
 *   GET  /picture?token=T&after=N     the window as PNG, its number in X-Abbe-Frame; 204 where none
 *                                     later than N has come within a second
 *   POST /events?token=T              lines, at most 64 KiB: move X Y; down B [shift] [control]; up
 *                                     B; wheel CLICKS; key NAME down|up [shift] [control]; size W H
 *
 * Moves that follow each other are one, and sizes; turns of the wheel are added up. Signals are
 * obeyed within a second whatever waits. 403 without the token, with a Host that is not this
 * machine's or an Origin that is not this page's; the connection ends then. 404 and 405 elsewhere,
 * 400 with the line that is wrong, 413, and 503 while too many events wait. */
abbe_result abbe_view_serve_run(unsigned port, const abbe_view_app_desc *desc, size_t width,
                                size_t height, abbe_error *error);

/* The viewer in a window that nobody sees: EGL without a surface, and a picture of it that can be
 * read. Scripts lead it, and the page that is served. */

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
