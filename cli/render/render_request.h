/* render_request.h: all that `abbe render` is asked, and what it writes of a picture.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_RENDER_REQUEST_H
#define ABBE_CLI_RENDER_RENDER_REQUEST_H

#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/frame_series.h"
#include "cli/options/picture_options.h"
#include "cli/render/render_options.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "gl/device/context.h"
#include "library/choice/picture_choice.h"

/* The picture of `abbe render` where the tracer serves the request best. */

typedef struct abbe_traced_picture_desc {
  size_t width, height; /* pixels; 0: the scene's */
  double min_nm, max_nm;
  abbe_rgb_space space;
  abbe_observer observer;
  bool quiet;
} abbe_traced_picture_desc;

/* Traces the choice's point, with a bar; where an error is requested, until its own passes show
 * that it is kept. Sets the choice's passes and met. Errors of abbe_bounded_trace_make. */
abbe_result abbe_traced_picture_make(abbe_picture_choice *choice, const abbe_scene *scene,
                                     const abbe_traced_picture_desc *desc, abbe_image *out,
                                     abbe_error *error);

/* Compares the picture, with its caustic's layers, with traced passes of other chance, with a bar,
 * in the time that the budget leaves, until they show whether its error is what was expected. Sets
 * the choice's passes, others, timed_out and met. Errors of abbe_checked_picture_make. */
abbe_result abbe_traced_picture_check_in_time(abbe_picture_choice *choice, const abbe_scene *scene,
                                              const abbe_traced_picture_desc *desc,
                                              const abbe_image *picture, abbe_error *error);

/* Holds the rendered picture, with its caustic's layers, against traced passes, with a bar. Sets
 * the choice's passes and met. `traced` receives what the passes made where that keeps the error
 * that is requested and the picture does not, and the choice's traced_instead then says so; else it
 * is left without pixels, as it is without `may_trace`. Errors of abbe_checked_picture_make. */
abbe_result abbe_traced_picture_check(abbe_picture_choice *choice, const abbe_scene *scene,
                                      const abbe_traced_picture_desc *desc, bool may_trace,
                                      const abbe_image *picture, abbe_image *traced,
                                      abbe_error *error);

typedef struct abbe_render_request {
  abbe_render_options render;
  abbe_map_options map;
  abbe_preset_options preset;
  abbe_preset_choice choice;   /* choice of a frame's settings */
  abbe_picture_choice picture; /* or of what makes the picture; without a point: not requested */
  bool overridden;             /* the request or the scene stands against the picture's choice */
  bool may_trace;              /* where the rendered picture does not keep its bound */
  const char *picture_note;    /* on how that was chosen, or NULL */
  abbe_error_options errors;
  abbe_frame_series series; /* --turntable, --frames A:B; zeroed but for program */
  const char *exr, *png, *stats;
  bool aovs, quiet, json;
  size_t frames, bands;
  abbe_context_backend backend;
  abbe_screen_options screen;
} abbe_render_request;

/* Since the program was started. */
double abbe_render_process_ms(void);

/* The statistics as JSON, where they are requested. */
abbe_result abbe_render_write_stats(const abbe_render_request *request,
                                    const abbe_statistics *statistics, const abbe_error_bars *bars,
                                    const abbe_context *context, abbe_error *error);
/* The same of a traced picture. */
abbe_result abbe_render_write_traced_stats(const abbe_render_request *request, abbe_error *error);

/* Says in the picture what made it. */
abbe_result abbe_render_annotate(const abbe_render_request *request, const abbe_renderer *renderer,
                                 const abbe_context *context, abbe_image *image, abbe_error *error);
/* Adds the request's bands to the picture that the context's renderer has drawn. */
abbe_result abbe_render_add_bands(const abbe_render_request *request, const abbe_scene *scene,
                                  abbe_context *context, abbe_image *picture, abbe_error *error);
abbe_result abbe_render_write_png(const abbe_render_request *request, const abbe_image *image,
                                  abbe_error *error);
abbe_result abbe_render_save_map(const abbe_render_request *request, abbe_renderer *renderer,
                                 abbe_error *error);
/* A frame's time and where the light went, on stderr. */
void abbe_render_summarise(const abbe_render_request *request, const abbe_statistics *statistics,
                           double prepared_s);

/* The part of `abbe render` that estimates a picture's error by traced passes. */

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

/* Frames of `abbe render --turntable` and `--frames A:B`, and the picture that moves.
 *
 * A turntable's camera goes around its target about its own upward direction; nothing else moves,
 * so lights' passes are drawn once; or the piece turns the other way and they stay. Over time the
 * scene is read again for each frame, and the renderer finds out what has moved. */

/* --turntable and what goes with it. Its input is the request's abbe_frame_series. */
extern const abbe_parser abbe_render_frames_argp;

/* Draws and writes all frames of the request, with a bar: FILE-0001.exr and FILE-0001.png and so
 * on, and FILE.png of all, beside and renamed; of a part, its frames alone. statistics receives the
 * last frame's, and stays as it is where --resume leaves none to draw. The renderer holds the scene
 * itself again then. ABBE_CANCELLED by Ctrl-C: the frames so far are kept. */
abbe_result abbe_render_frames_draw(const abbe_render_request *request, const abbe_scene *scene,
                                    const abbe_render_desc *desc, abbe_renderer *renderer,
                                    const abbe_context *context, abbe_statistics *statistics,
                                    abbe_error *error);

#endif
