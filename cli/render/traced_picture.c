#include "cli/render/render_request.h"

#include "base/clock.h"
#include "cli/base/progress.h"

#include "validation/trace/bounded_trace.h"
#include "validation/trace/checked_picture.h"

/* Photons a side of a pass that checks: few, so that a coarse picture is checked soon. */
enum { CHECK_PHOTONS = 256 };
/* Seed of passes that check: no traced picture has it. */
#define CHECK_SEED 77003u
/* For the writing of results and the end of the process. */
static const double end_s = 0.02;

static abbe_trace_desc describe(const abbe_traced_picture_desc *d, size_t photons) {
  return (abbe_trace_desc){.no_map = true,
                           .width = d->width,
                           .height = d->height,
                           .min_nm = d->min_nm,
                           .max_nm = d->max_nm,
                           .space = d->space,
                           .observer = d->observer,
                           .photons = photons * photons};
}

abbe_result abbe_traced_picture_make(abbe_picture_choice *choice, const abbe_scene *scene,
                                     const abbe_traced_picture_desc *desc, abbe_image *out,
                                     abbe_error *error) {
  abbe_progress progress;
  abbe_bounded_trace told;
  const abbe_picture_point *point = choice->point;
  const abbe_bounded_trace_desc trace = {.trace = describe(desc, point->photons),
                                         .passes = point->passes,
                                         .filtered = point->tool == ABBE_PICTURE_TRACE_FILTER,
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

abbe_result abbe_traced_picture_check(abbe_picture_choice *choice, const abbe_scene *scene,
                                      const abbe_traced_picture_desc *desc, bool may_trace,
                                      const abbe_image *picture, abbe_image *traced,
                                      abbe_error *error) {
  abbe_progress progress;
  abbe_checked_picture told;
  const double most = choice->request.max_error;
  const abbe_checked_picture_desc check = {.trace = describe(desc, CHECK_PHOTONS),
                                           .max_error = most,
                                           .only_check = !may_trace,
                                           .progress = abbe_progress_update,
                                           .user = &progress,
                                           .stop = abbe_progress_stopped()};
  abbe_progress_begin(&progress, "check", desc->quiet);
  abbe_result result = abbe_checked_picture_make(scene, &check, picture, traced, &told, error);
  abbe_progress_end(&progress);
  if (result != ABBE_OK) return result;
  choice->passes = told.passes;
  choice->met = told.given;
  choice->others = true;
  choice->traced_instead = may_trace && !(told.given.bound <= most) && told.traced.bound <= most;
  if (choice->traced_instead) {
    choice->met = told.traced;
    choice->others = false;
  } else {
    abbe_image_free(traced);
  }
  return ABBE_OK;
}

/* What is left of the budget when results are written and the process ends in time. */
static double seconds_left(void *user) {
  const abbe_picture_choice *c = user;
  return 1e-3 * c->request.budget_ms - abbe_clock_process_seconds() - end_s;
}

abbe_result abbe_traced_picture_check_in_time(abbe_picture_choice *choice, const abbe_scene *scene,
                                              const abbe_traced_picture_desc *desc,
                                              const abbe_image *picture, abbe_error *error) {
  abbe_progress progress;
  abbe_checked_picture told;
  abbe_image traced;
  abbe_checked_picture_desc check = {
      .trace = describe(desc, CHECK_PHOTONS),
      .max_error = choice->promised_error,
      .only_check = true,
      .progress = abbe_progress_update,
      .user = &progress,
      .left = {seconds_left, choice},
      .first_s = abbe_picture_choice_pass_s(choice, CHECK_PHOTONS * CHECK_PHOTONS)};
  check.trace.seed = CHECK_SEED;
  if (!(choice->promised_error > 0)) return ABBE_OK; /* nothing is lit through refractors */
  abbe_progress_begin(&progress, "check", desc->quiet);
  check.stop = abbe_progress_stopped_after(seconds_left(choice));
  abbe_result result = abbe_checked_picture_make(scene, &check, picture, &traced, &told, error);
  abbe_progress_end(&progress);
  if (result != ABBE_OK) return result;
  abbe_image_free(&traced);
  choice->passes = told.passes;
  choice->others = true;
  choice->timed_out = told.timed_out;
  choice->met = told.given;
  return ABBE_OK;
}
