#include "cli/render/traced_picture.h"

#include "cli/base/progress.h"

#include "validation/passes/bounded_trace.h"

abbe_result abbe_traced_picture_make(abbe_picture_choice *choice, const abbe_scene *scene,
                                     const abbe_traced_picture_desc *desc, abbe_image *out,
                                     abbe_error *error) {
  abbe_progress progress;
  abbe_bounded_trace told;
  const abbe_sweep_setting *setting = &choice->point->setting;
  const abbe_bounded_trace_desc trace = {.trace = {.no_map = true,
                                                   .width = desc->width,
                                                   .height = desc->height,
                                                   .min_nm = desc->min_nm,
                                                   .max_nm = desc->max_nm,
                                                   .space = desc->space,
                                                   .photons = setting->photons * setting->photons},
                                         .passes = setting->passes,
                                         .filtered =
                                             choice->point->tool == ABBE_PICTURE_TRACE_FILTER,
                                         .max_error = choice->request.max_error,
                                         .progress = abbe_progress_update,
                                         .user = &progress,
                                         .stop = abbe_progress_stopped()};
  abbe_progress_begin(&progress, "trace", desc->quiet);
  abbe_result result = abbe_bounded_trace_make(scene, &trace, out, &told, error);
  abbe_progress_end(&progress);
  if (result != ABBE_OK) return result;
  choice->passes = told.passes;
  choice->met = told.own;
  return ABBE_OK;
}
