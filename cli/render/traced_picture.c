#include "cli/render/traced_picture.h"

#include "cli/base/progress.h"

#include "validation/sweep/sweep_trace.h"
#include "validation/tracer/trace_run.h"

#include <math.h>

abbe_result abbe_traced_picture_make(const abbe_picture_point *point, const abbe_scene *scene,
                                     const abbe_traced_picture_desc *desc, abbe_image *out,
                                     double *error_met, abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_progress progress;
  const bool filtered = point->tool == ABBE_PICTURE_TRACE_FILTER;
  const abbe_trace_desc trace = {.no_map = true,
                                 .guides = filtered,
                                 .width = desc->width,
                                 .height = desc->height,
                                 .min_nm = desc->min_nm,
                                 .max_nm = desc->max_nm,
                                 .space = desc->space,
                                 .photons = point->setting.photons * point->setting.photons};
  const size_t passes = point->setting.passes;
  abbe_trace_run_desc run = {.passes = passes / 2,
                             .progress = abbe_progress_update,
                             .user = &progress,
                             .stop = abbe_progress_stopped()};
  abbe_image half = {0};
  *out = (abbe_image){0};
  *error_met = NAN;
  abbe_result result = abbe_tracer_make(scene, &trace, &tracer, error);
  if (result != ABBE_OK) return result;
  abbe_progress_begin(&progress, "trace", desc->quiet);
  if (passes % 2 == 0 && !filtered) {
    result = abbe_trace_run(tracer, &run, error);
    if (result == ABBE_OK) result = abbe_tracer_picture(tracer, &half, error);
  }
  run.passes = passes;
  if (result == ABBE_OK) result = abbe_trace_run(tracer, &run, error);
  abbe_progress_end(&progress);
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, out, error);
  if (result == ABBE_OK && filtered) result = abbe_sweep_trace_filter(out, error);
  if (result == ABBE_OK && half.data != NULL) *error_met = abbe_sweep_trace_own_error(&half, out);
  abbe_image_free(&half);
  abbe_tracer_free(tracer);
  return result;
}
