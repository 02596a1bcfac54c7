#include "validation/trace/checked_picture.h"

#include "validation/trace/tracer/trace_run.h"

#include <math.h>
#include <stddef.h>

double abbe_time_left_seconds(const abbe_time_left *left) {
  return left->seconds != NULL ? left->seconds(left->user) : INFINITY;
}

bool abbe_time_left_holds(const abbe_time_left *left, double seconds) {
  return left->seconds == NULL || ABBE_TIME_LEFT_ROOM * seconds <= abbe_time_left_seconds(left);
}

static bool is_over(const abbe_checked_picture_desc *d) {
  return !(abbe_time_left_seconds(&d->left) > 0);
}

static bool watch_time(void *user, double done) {
  const abbe_checked_picture_desc *d = user;
  return !is_over(d) && (d->progress == NULL || d->progress(d->user, done));
}

/* On to so many passes in all. */
static abbe_result go_on(const abbe_checked_picture_desc *d, abbe_tracer *tracer, size_t passes,
                         abbe_image *out, abbe_error *error) {
  const abbe_trace_run_desc run = {
      .passes = passes, .progress = watch_time, .user = (void *)d, .stop = d->stop};
  ABBE_TRY(abbe_trace_run(tracer, &run, error));
  return abbe_tracer_picture(tracer, out, error);
}

/* Below it, by as much chance as above. */
static bool is_above(const abbe_pass_error *e, double bound) {
  return 2 * e->estimate * e->estimate - e->bound * e->bound > bound * bound;
}

/* What is too noisy to decide goes on, unless there is no caustic. */
static bool is_decided(const abbe_checked_picture_desc *d, const abbe_checked_picture *c) {
  return c->given.bound <= d->max_error || c->traced.bound <= d->max_error ||
         isnan(c->traced.bound) || (d->only_check && is_above(&c->given, d->max_error));
}

/* From half of so many passes, whose picture `traced` is, to all of them. */
static abbe_result tell(const abbe_checked_picture_desc *d, abbe_tracer *tracer, size_t passes,
                        const abbe_image *picture, abbe_image *traced, abbe_checked_picture *out,
                        abbe_error *error) {
  ABBE_OWNED(abbe_image, part) = *traced;
  *traced = (abbe_image){0};
  if (part.data == NULL) ABBE_TRY(go_on(d, tracer, passes / 2, &part, error));
  ABBE_TRY(go_on(d, tracer, passes, traced, error));
  const abbe_pass_pictures all = {
      .part = &part, .whole = traced, .part_passes = passes / 2, .passes = passes};
  ABBE_TRY(abbe_pass_error_make(&all, &out->traced, error));
  ABBE_TRY(abbe_pass_error_of_picture(&all, picture, &out->given, error));
  out->passes = passes;
  return ABBE_OK;
}

/* Twice as many passes take as long again as those before them took, of which the first two have
 * the tracer's making in their time. */
static abbe_result check(const abbe_checked_picture_desc *d, const abbe_scene *scene,
                         const abbe_image *picture, abbe_image *traced, abbe_checked_picture *out,
                         abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_result result = ABBE_OK;
  double expected_s = d->first_s;
  for (size_t passes = 2; result == ABBE_OK; passes *= 2) {
    const double before_s = abbe_time_left_seconds(&d->left);
    out->timed_out = !abbe_time_left_holds(&d->left, expected_s);
    if (out->timed_out) break;
    if (tracer == NULL) result = abbe_tracer_make(scene, &d->trace, &tracer, error);
    if (result == ABBE_OK) result = tell(d, tracer, passes, picture, traced, out, error);
    if (result != ABBE_OK || is_decided(d, out) || 2 * passes > ABBE_CHECKED_PICTURE_MOST_PASSES)
      break;
    expected_s = (passes > 2 ? 2 : 1) * (before_s - abbe_time_left_seconds(&d->left));
  }
  abbe_tracer_free(tracer);
  return result;
}

abbe_result abbe_checked_picture_make(const abbe_scene *scene,
                                      const abbe_checked_picture_desc *desc,
                                      const abbe_image *picture, abbe_image *traced,
                                      abbe_checked_picture *out, abbe_error *error) {
  abbe_error why = {0};
  *traced = (abbe_image){0};
  *out = (abbe_checked_picture){.given = {NAN, NAN}, .traced = {NAN, NAN}};
  if (!(desc->max_error > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "an error of %g cannot be kept",
                          desc->max_error);
  abbe_result result = check(desc, scene, picture, traced, out, &why);
  if (result == ABBE_CANCELLED && is_over(desc)) {
    out->timed_out = true;
    result = ABBE_OK;
  }
  if (result != ABBE_OK || out->timed_out) abbe_image_free(traced);
  if (result != ABBE_OK && error != NULL) *error = why;
  return result;
}
