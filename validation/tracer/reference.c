#include "validation/tracer/reference.h"

#include "validation/tracer/checkpoint.h"

#include <time.h>
#include <unistd.h>

static const double checkpoint_every_s = 30;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static abbe_result keep(const abbe_reference_desc *desc, const abbe_tracer *tracer,
                        abbe_error *error) {
  if (desc->checkpoint == NULL || abbe_tracer_passes(tracer) == 0) return ABBE_OK;
  return abbe_checkpoint_save(tracer, desc->checkpoint, error);
}

static abbe_result run(const abbe_reference_desc *desc, abbe_tracer *tracer, abbe_error *error) {
  size_t passes = desc->passes > 0 ? desc->passes : ABBE_REFERENCE_PASSES;
  double saved = now();
  abbe_result result = ABBE_OK;
  while (result == ABBE_OK && abbe_tracer_passes(tracer) < passes) {
    double done = (double)abbe_tracer_passes(tracer) / (double)passes;
    if (desc->progress != NULL && !desc->progress(desc->user, done))
      result = abbe_error_set(error, ABBE_CANCELLED, "stopped after %zu of %zu passes",
                              abbe_tracer_passes(tracer), passes);
    if (result == ABBE_OK) result = abbe_tracer_pass(tracer, desc->stop, error);
    if (result != ABBE_OK || now() - saved < checkpoint_every_s) continue;
    result = keep(desc, tracer, error);
    saved = now();
  }
  if (result == ABBE_CANCELLED && keep(desc, tracer, error) != ABBE_OK) return ABBE_IO;
  return result;
}

abbe_result abbe_reference_trace(const abbe_scene *scene, const abbe_reference_desc *desc,
                                 abbe_image *picture, abbe_image *map, abbe_error *error) {
  ABBE_REQUIRE(scene && desc && picture && map, error);
  abbe_tracer *tracer = NULL;
  abbe_image shown = {0}, landed = {0};
  *picture = *map = (abbe_image){0};
  abbe_result result = abbe_tracer_make(scene, &desc->trace, &tracer, error);
  if (result == ABBE_OK && desc->checkpoint != NULL && access(desc->checkpoint, F_OK) == 0)
    result = abbe_checkpoint_load(tracer, desc->checkpoint, error);
  if (result == ABBE_OK) result = run(desc, tracer, error);
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
