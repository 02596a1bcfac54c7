/* trace_request.h: all that `abbe trace` is asked. Internal to cli/trace/. */
#ifndef ABBE_CLI_TRACE_TRACE_REQUEST_H
#define ABBE_CLI_TRACE_TRACE_REQUEST_H

#include "cli/base/arguments.h"
#include "cli/options/frame_series.h"
#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"
#include "validation/trace/tracer/trace_run.h"
#include "validation/trace/tracer/tracer.h"

typedef struct abbe_trace_request {
  const char *program, *scene, *materials;
  abbe_scene_input_changes changes;
  const char *exr, *png, *stats, *checkpoint;
  abbe_map_options map;
  abbe_trace_desc desc;
  abbe_work_options work; /* its wavelengths, seed and threads are the desc's once all is read */
  size_t passes;
  abbe_frame_series series;    /* --frames; zeroed but for program */
  size_t part_first, part_end; /* --passes: of the whole, the end not among them; 0, 0: all */
  size_t whole; /* passes of all parts together, by --spp or --passes; 0: not given */
  bool merge, incomplete;
  const char **parts; /* files to merge */
  size_t part_count;
  double seconds, until;
  bool json, quiet, rates, half, filter;
  double filter_seconds; /* spent */
  abbe_screen_options screen;
  char *checkpoint_path;
  const abbe_scene *traced; /* while it is */
  size_t frame;             /* number in the series, while it is traced */
} abbe_trace_request;

/* Frames of `abbe trace --frames A:B`, and the picture that moves. */

/* --frames and what goes with it. Its input is the request's abbe_frame_series. */
extern const abbe_parser abbe_trace_frames_argp;

/* Ends the program where options of the request do not go together with frames, or without. */
void abbe_trace_frames_check(const abbe_trace_request *q, struct argp_state *state);

typedef abbe_result (*abbe_trace_frame)(abbe_trace_request *q, const abbe_scene *scene,
                                        abbe_error *error);

/* Each frame of the request's series as a request of its own, whose files are numbered, by
 * trace_one on the scene at its time; then the picture that moves of all. What is there is left as
 * it is where the request resumes. */
abbe_result abbe_trace_frames(const abbe_trace_request *q, const abbe_scene *scene,
                              abbe_trace_frame trace_one, abbe_error *error);

/* The passes of `abbe trace`, with a bar. ABBE_CANCELLED where the user stopped it: what is done is
 * to be saved all the same.
 */
abbe_result abbe_trace_passes(const abbe_trace_request *q, const abbe_trace_run_desc *run,
                              abbe_tracer *tracer, abbe_error *error);

/* What `abbe trace` writes of a trace, and says of it. */

/* All files that are requested; notes the time of the filter in the request. */
abbe_result abbe_trace_write(abbe_trace_request *q, const abbe_tracer *tracer, abbe_error *error);

/* A line on stderr, unless it is to be quiet. */
void abbe_trace_summarise(const abbe_trace_request *q, const abbe_tracer *tracer);

#endif
