/* render_request.h: all that `abbe render` is asked, and what it writes of a picture.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_RENDER_REQUEST_H
#define ABBE_CLI_RENDER_RENDER_REQUEST_H

#include "cli/base/command.h"
#include "cli/base/rank_job.h"
#include "cli/options/frame_series.h"
#include "cli/options/map_options.h"
#include "cli/options/screen_options.h"
#include "cli/render/error_options.h"
#include "cli/render/preset_options.h"
#include "cli/render/render_options.h"

#include "gl/device/context.h"

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
  abbe_rank_job *job;       /* the ranks that share the frames; NULL: one process */
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

#endif
