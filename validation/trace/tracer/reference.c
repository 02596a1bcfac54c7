#include "validation/trace/tracer/reference.h"

#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/trace_run.h"

#include <unistd.h>

static const double checkpoint_every_s = 30;

abbe_result abbe_reference_trace(const abbe_scene *scene, const abbe_reference_desc *desc,
                                 abbe_image *picture, abbe_image *map, abbe_error *error) {
  const abbe_trace_run_desc run = {.passes =
                                       desc->passes > 0 ? desc->passes : ABBE_REFERENCE_PASSES,
                                   .checkpoint = desc->checkpoint,
                                   .checkpoint_s = checkpoint_every_s,
                                   .progress = desc->progress,
                                   .user = desc->user,
                                   .stop = desc->stop};
  abbe_tracer *tracer = NULL;
  abbe_image shown = {0}, landed = {0};
  *picture = *map = (abbe_image){0};
  abbe_result result = abbe_tracer_make(scene, &desc->trace, &tracer, error);
  if (result == ABBE_OK && desc->checkpoint != NULL && access(desc->checkpoint, F_OK) == 0)
    result = abbe_checkpoint_load(tracer, desc->checkpoint, error);
  if (result == ABBE_OK) result = abbe_trace_run(tracer, &run, error);
  if (result == ABBE_CANCELLED && abbe_trace_keep(tracer, &run, error) != ABBE_OK) result = ABBE_IO;
  if (result == ABBE_OK && !desc->trace.no_picture)
    result = abbe_tracer_picture(tracer, &shown, error);
  if (result == ABBE_OK && !desc->trace.no_map) result = abbe_tracer_map(tracer, &landed, error);
  abbe_tracer_free(tracer);
  if (result == ABBE_OK) {
    *picture = shown;
    *map = landed;
    return ABBE_OK;
  }
  abbe_image_free(&shown);
  abbe_image_free(&landed);
  return result;
}
