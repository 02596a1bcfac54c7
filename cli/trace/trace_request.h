/* trace_request.h: all that `abbe trace` is asked. */
#ifndef ABBE_CLI_TRACE_TRACE_REQUEST_H
#define ABBE_CLI_TRACE_TRACE_REQUEST_H

#include "cli/options/frame_series.h"
#include "cli/options/map_options.h"
#include "cli/options/scene_input.h"
#include "cli/options/screen_options.h"
#include "cli/options/work_options.h"

#include "validation/tracer/ranked_run.h"
#include "validation/tracer/tracer.h"

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
  size_t whole; /* passes of all parts together, by --spp or --passes; 0: it is not said */
  bool merge, incomplete;
  const char **parts; /* files to merge */
  size_t part_count;
  double seconds, until;
  const abbe_ranks *ranks; /* that trace it together; NULL: one process */
  bool json, quiet, rates, half, filter;
  double filter_seconds; /* spent */
  abbe_screen_options screen;
  char *checkpoint_path;
  const abbe_scene *traced; /* while it is */
  size_t frame;             /* of the series, while it is traced */
} abbe_trace_request;

#endif
