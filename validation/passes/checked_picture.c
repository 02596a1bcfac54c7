#include "validation/passes/checked_picture.h"

#include "validation/tracer/trace_run.h"

#include <math.h>

/* On to so many passes in all. */
static abbe_result go_on(const abbe_checked_picture_desc *d, abbe_tracer *tracer, size_t passes,
                         abbe_image *out, abbe_error *error) {
  const abbe_trace_run_desc run = {
      .passes = passes, .progress = d->progress, .user = d->user, .stop = d->stop};
  abbe_result result = abbe_trace_run(tracer, &run, error);
  return result == ABBE_OK ? abbe_tracer_picture(tracer, out, error) : result;
}

/* What is too noisy to tell goes on, unless there is no caustic. */
static bool is_decided(const abbe_checked_picture_desc *d, const abbe_checked_picture *c) {
  return c->given.bound <= d->max_error || c->traced.bound <= d->max_error ||
         isnan(c->traced.bound);
}

static abbe_result check(const abbe_checked_picture_desc *d, abbe_tracer *tracer,
                         const abbe_image *picture, abbe_image *traced, abbe_checked_picture *out,
                         abbe_error *error) {
  abbe_image part = {0};
  abbe_result result = go_on(d, tracer, 1, traced, error);
  for (out->passes = 2; result == ABBE_OK; out->passes *= 2) {
    abbe_image_free(&part);
    part = *traced;
    *traced = (abbe_image){0};
    result = go_on(d, tracer, out->passes, traced, error);
    const abbe_pass_pictures all = {
        .part = &part, .whole = traced, .part_passes = out->passes / 2, .passes = out->passes};
    if (result == ABBE_OK) result = abbe_pass_error_make(&all, &out->traced, error);
    if (result == ABBE_OK) result = abbe_pass_error_of_picture(&all, picture, &out->given, error);
    if (is_decided(d, out) || 2 * out->passes > ABBE_CHECKED_PICTURE_MOST_PASSES) break;
  }
  abbe_image_free(&part);
  return result;
}

abbe_result abbe_checked_picture_make(const abbe_scene *scene,
                                      const abbe_checked_picture_desc *desc,
                                      const abbe_image *picture, abbe_image *traced,
                                      abbe_checked_picture *out, abbe_error *error) {
  ABBE_REQUIRE(scene && desc && picture && traced && out, error);
  abbe_tracer *tracer = NULL;
  *traced = (abbe_image){0};
  *out = (abbe_checked_picture){.given = {NAN, NAN}, .traced = {NAN, NAN}};
  if (!(desc->max_error > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "an error of %g cannot be kept",
                          desc->max_error);
  abbe_result result = abbe_tracer_make(scene, &desc->trace, &tracer, error);
  if (result == ABBE_OK) result = check(desc, tracer, picture, traced, out, error);
  if (result != ABBE_OK) abbe_image_free(traced);
  abbe_tracer_free(tracer);
  return result;
}
