#include "validation/trace/checked_picture.h"

#include "validation/trace/denoise.h"
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

/* More than noise requires, because the bound itself is uncertain. */
static const double ahead = 1.1;

/* Pictures after a part of the passes and after all, and what the filter makes of them. */
typedef struct pictures {
  abbe_image part, whole, filtered_part, filtered;
} pictures;

static void free_pictures(pictures *p) {
  abbe_image_free(&p->part);
  abbe_image_free(&p->whole);
  abbe_image_free(&p->filtered_part);
  abbe_image_free(&p->filtered);
}

/* On to so many passes in all. */
static abbe_result bounded_trace_go_on(const abbe_bounded_trace_desc *d, abbe_tracer *tracer,
                                       size_t passes, abbe_image *picture, abbe_image *filtered,
                                       abbe_error *error) {
  const abbe_trace_run_desc run = {
      .passes = passes, .progress = d->progress, .user = d->user, .stop = d->stop};
  const abbe_denoise_desc denoise = {.threads = d->trace.threads};
  ABBE_TRY(abbe_trace_run(tracer, &run, error));
  ABBE_TRY(abbe_tracer_picture(tracer, picture, error));
  return d->filtered ? abbe_denoise_picture(picture, &denoise, filtered, error) : ABBE_OK;
}

static abbe_result trace(const abbe_bounded_trace_desc *d, abbe_tracer *tracer, size_t passes,
                         pictures *p, abbe_pass_error *own, abbe_error *error) {
  const size_t part = passes / 2;
  const bool tells = d->filtered ? d->max_error > 0 : part > 0;
  *own = (abbe_pass_error){NAN, NAN};
  if (tells) ABBE_TRY(bounded_trace_go_on(d, tracer, part, &p->part, &p->filtered_part, error));
  ABBE_TRY(bounded_trace_go_on(d, tracer, passes, &p->whole, &p->filtered, error));
  if (!tells) return ABBE_OK;
  const abbe_pass_pictures all = {.part = &p->part,
                                  .whole = &p->whole,
                                  .part_passes = part,
                                  .passes = passes,
                                  .filtered_part = d->filtered ? &p->filtered_part : NULL,
                                  .filtered = d->filtered ? &p->filtered : NULL};
  return abbe_pass_error_make(&all, own, error);
}

/* How many passes may keep the bound, at least twice as many; 0: too many. By noise, which falls as
 * one over the root of the passes: blur falls slower and is asked about again. */
static size_t find_more(const abbe_bounded_trace_desc *d, const abbe_bounded_trace *t,
                        size_t most) {
  const double least = (double)t->passes * pow(t->own.bound / d->max_error, 2);
  if (least > (double)most || 2 * t->passes > most) return 0;
  return 2 * (size_t)ceil(fmin(fmax(ahead * least / 2, (double)t->passes), (double)most / 2));
}

abbe_result abbe_bounded_trace_make(const abbe_scene *scene, const abbe_bounded_trace_desc *desc,
                                    abbe_image *picture, abbe_bounded_trace *out,
                                    abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_trace_desc own = desc->trace;
  const size_t least = desc->filtered ? 2 : 1, bounded = desc->max_error > 0 ? 2 * least : least;
  *picture = (abbe_image){0};
  if (desc->passes < least)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu passes are too few, at least %zu",
                          desc->passes, least);
  own.guides = desc->filtered;
  *out = (abbe_bounded_trace){.passes = desc->passes > bounded ? desc->passes : bounded};
  const size_t most = out->passes * ABBE_BOUNDED_TRACE_MOST_TIMES;
  pictures p = {0};
  abbe_result result = abbe_tracer_make(scene, &own, &tracer, error);
  if (result == ABBE_OK) result = trace(desc, tracer, out->passes, &p, &out->own, error);
  while (result == ABBE_OK && desc->max_error > 0 && out->own.bound > desc->max_error) {
    const size_t more = find_more(desc, out, most);
    if (more == 0) break;
    free_pictures(&p);
    out->passes = more;
    result = trace(desc, tracer, more, &p, &out->own, error);
  }
  if (result == ABBE_OK) {
    abbe_image *made = desc->filtered ? &p.filtered : &p.whole;
    *picture = *made;
    *made = (abbe_image){0};
  }
  free_pictures(&p);
  abbe_tracer_free(tracer);
  return result;
}
