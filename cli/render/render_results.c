#include "cli/base/command.h"

#include "base/clock.h"
#include "base/file.h"
#include "cli/base/progress.h"
#include "cli/render/render_request.h"
#include "colorimetry/image/exr.h"
#include "gl/band_picture.h"
#include "validation/trace/checked_picture.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

typedef abbe_render_request request;

double abbe_render_process_ms(void) {
  return 1e3 * abbe_clock_process_seconds();
}

/* estimate: by error bars, where passes give none; below 0: neither does. */
static void describe_picture(const request *q, double estimate, cJSON *root) {
  const double error_met =
      abbe_picture_choice_tells(&q->picture) ? q->picture.met.estimate : estimate;
  cJSON_AddNumberToObject(root, "process_ms", abbe_render_process_ms());
  abbe_preset_options_describe_picture(&q->picture, abbe_render_process_ms(), error_met, root);
  cJSON *promise = cJSON_GetObjectItemCaseSensitive(root, "promise");
  if (q->picture.point != NULL && promise != NULL)
    cJSON_AddBoolToObject(promise, "overridden", q->overridden);
}

static cJSON *describe(const request *q, const abbe_statistics *s, const abbe_error_bars *bars,
                       const abbe_context *context) {
  cJSON *root = cJSON_CreateObject();
  cJSON_AddNumberToObject(root, "frame_ms", s->frame_ms);
  if (s->baseline_ms > 0) cJSON_AddNumberToObject(root, "baseline_ms", s->baseline_ms);
  cJSON *passes = cJSON_AddArrayToObject(root, "passes");
  for (size_t i = 0; i < s->pass_count; i++) {
    cJSON *pass = cJSON_CreateObject();
    cJSON_AddStringToObject(pass, "name", abbe_plan_item_text(s->pass[i].pass));
    cJSON_AddNumberToObject(pass, "ms", s->pass[i].ms);
    cJSON_AddItemToArray(passes, pass);
  }
  cJSON_AddNumberToObject(root, "photons", (double)s->photons);
  cJSON_AddNumberToObject(root, "wavelengths", (double)s->wavelengths);
  cJSON_AddNumberToObject(root, "refractor_share", s->refractor_share);
  if (s->polygon_layers > 0) cJSON_AddNumberToObject(root, "polygon_layers", s->polygon_layers);
  cJSON *energy = cJSON_AddObjectToObject(root, "energy");
  cJSON_AddNumberToObject(energy, "reached", s->energy.reached);
  cJSON_AddNumberToObject(energy, "reflected", s->energy.reflected);
  cJSON_AddNumberToObject(energy, "absorbed", s->energy.absorbed);
  cJSON_AddNumberToObject(energy, "trapped", s->energy.trapped);
  cJSON_AddNumberToObject(energy, "missed", s->energy.missed);
  cJSON_AddNumberToObject(energy, "deposited", s->energy.deposited);
  cJSON_AddNumberToObject(energy, "on_tiles", s->energy.on_tiles);
  cJSON_AddNumberToObject(energy, "interpolated", s->energy.interpolated);
  cJSON_AddNumberToObject(energy, "imbalance", abbe_ledger_imbalance(&s->energy));
  cJSON_AddNumberToObject(root, "device_bytes", (double)s->device_bytes);
  struct rusage usage;
  if (getrusage(RUSAGE_SELF, &usage) == 0)
    cJSON_AddNumberToObject(root, "peak_bytes", 1024.0 * (double)usage.ru_maxrss);
  cJSON_AddStringToObject(root, "device", abbe_context_description(context));
  abbe_error_options_describe(&q->errors, bars, root);
  double estimate = bars->caustic.pixels > 0 ? bars->caustic.ciede2000 : -1;
  abbe_preset_options_describe(&q->choice, s, estimate, root);
  describe_picture(q, estimate, root);
  return root;
}

abbe_result abbe_render_write_stats(const request *q, const abbe_statistics *s,
                                    const abbe_error_bars *bars, const abbe_context *context,
                                    abbe_error *error) {
  if (q->stats == NULL && !q->json) return ABBE_OK;
  return abbe_command_write_json(describe(q, s, bars, context), true, q->json, q->stats, error);
}

abbe_result abbe_render_write_traced_stats(const request *q, abbe_error *error) {
  if (q->stats == NULL && !q->json) return ABBE_OK;
  cJSON *root = cJSON_CreateObject();
  describe_picture(q, -1, root);
  return abbe_command_write_json(root, true, q->json, q->stats, error);
}

abbe_result abbe_render_annotate(const request *q, const abbe_renderer *renderer,
                                 const abbe_context *context, abbe_image *image,
                                 abbe_error *error) {
  const abbe_render_desc *d = &abbe_renderer_plan(renderer)->desc;
  char text[512];
  snprintf(text, sizeof text,
           "profile %s, %zu wavelengths %g:%g nm, photons %zu, map %zu, samples %zu, upsample %zu, "
           "adaptive %zu, fill %s, "
           "share %g, exits %zu",
           abbe_profile_name(d->profile), d->wavelengths, d->min_nm, d->max_nm, d->photons,
           d->map_size, d->supersample, d->upsample, d->adaptive, abbe_fill_name(d->fill),
           d->energy_share, d->exits);
  ABBE_TRY(abbe_image_set_attribute(image, "abbe:settings", text, error));
  ABBE_TRY(abbe_image_set_attribute(image, "abbe:scene", q->render.scene, error));
  ABBE_TRY(
      abbe_image_set_attribute(image, "abbe:device", abbe_context_description(context), error));
  return abbe_image_set_attribute(
      image, "abbe:unit",
      abbe_method_of(d->profile)->printed ? "display brightness" : "radiance, W/(m2 sr)", error);
}

abbe_result abbe_render_add_bands(const request *q, const abbe_scene *scene, abbe_context *context,
                                  abbe_image *picture, abbe_error *error) {
  abbe_progress progress;
  abbe_image bands = {0};
  abbe_progress_begin(&progress, "bands", q->quiet);
  abbe_result result = abbe_band_picture_make(context, scene, &q->render.desc, q->bands,
                                              abbe_progress_update, &progress, &bands, error);
  abbe_progress_end(&progress);
  if (result == ABBE_OK) result = abbe_image_append(picture, &bands, error);
  abbe_image_free(&bands);
  return result;
}

abbe_result abbe_render_write_png(const request *q, const abbe_image *image, abbe_error *error) {
  return abbe_screen_options_write(&q->screen, q->png, image, NULL, NULL, error);
}

abbe_result abbe_render_save_map(const request *q, abbe_renderer *renderer, abbe_error *error) {
  ABBE_OWNED(abbe_image, map) = {0};
  bool thesis = abbe_method_of(abbe_renderer_plan(renderer)->desc.profile)->printed;
  ABBE_TRY(
      q->bands > 0
          ? abbe_renderer_read_map_bands(renderer, q->map.light_index, q->bands, &map, error)
          : abbe_renderer_read_map(renderer, q->map.light_index, !q->render.unfilled, &map, error));
  ABBE_TRY(abbe_image_set_attribute(&map, "abbe:unit",
                                    thesis ? "display brightness" : "flux a texel, W", error));
  ABBE_TRY(abbe_image_set_attribute(&map, "abbe:scene", q->render.scene, error));
  return abbe_exr_write(q->map.save, &map, error);
}

void abbe_render_summarise(const request *q, const abbe_statistics *s, double prepared_s) {
  if (q->quiet || q->json) return;
  if (q->series.count > 0 && s->frame_ms == 0) {
    fprintf(stderr, "no frame is left to draw: their files are there\n");
    return;
  }
  fprintf(stderr, "a frame of %.0f ms, prepared in %.1f s, %zu photons x %zu wavelengths",
          s->frame_ms, prepared_s, s->photons, s->wavelengths);
  const abbe_ledger *e = &s->energy;
  if (e->reached > 0)
    fprintf(stderr,
            "; of the light that met refractors %.1f %% is in the map, %.1f %% reflected, %.1f %% "
            "absorbed, %.1f %% trapped, %.1f %% missed (balance %.1e)",
            100 * e->deposited / e->reached, 100 * e->reflected / e->reached,
            100 * e->absorbed / e->reached, 100 * e->trapped / e->reached,
            100 * e->missed / e->reached, abbe_ledger_imbalance(e));
  fprintf(stderr, "\n");
}

typedef abbe_render_request request;

bool abbe_render_is_checked(const request *q) {
  return q->picture.point != NULL && q->picture.request.max_error > 0;
}

abbe_traced_picture_desc abbe_render_describe_traced(const request *q) {
  const abbe_render_desc *d = &q->render.desc;
  return (abbe_traced_picture_desc){.width = d->width,
                                    .height = d->height,
                                    .min_nm = d->min_nm,
                                    .max_nm = d->max_nm,
                                    .space = d->space,
                                    .observer = d->observer,
                                    .quiet = q->quiet};
}

/* Whether a time is requested and nothing has estimated the error. */
static bool is_open(const request *q) {
  const abbe_picture_choice *c = &q->picture;
  return c->point != NULL && c->request.budget_ms > 0 && !abbe_picture_choice_tells(c);
}

abbe_result abbe_render_check_in_time(request *q, const abbe_scene *scene,
                                      const abbe_image *picture, abbe_error *error) {
  const abbe_traced_picture_desc desc = abbe_render_describe_traced(q);
  if (!is_open(q)) return ABBE_OK;
  return abbe_traced_picture_check_in_time(&q->picture, scene, &desc, picture, error);
}

abbe_result abbe_render_check_frame_in_time(request *q, const abbe_scene *scene,
                                            abbe_renderer *renderer, abbe_error *error) {
  ABBE_OWNED(abbe_image, layers) = {0};
  if (!is_open(q) || !abbe_renderer_plan(renderer)->caustics) return ABBE_OK;
  ABBE_TRY(abbe_renderer_read(renderer, true, &layers, error));
  return abbe_render_check_in_time(q, scene, &layers, error);
}

abbe_result abbe_render_check_frame(request *q, const abbe_scene *scene, abbe_renderer *renderer,
                                    abbe_image *image, abbe_error *error) {
  abbe_image layers = {0}, traced = {0};
  if (!abbe_render_is_checked(q) || !abbe_renderer_plan(renderer)->caustics) return ABBE_OK;
  const abbe_traced_picture_desc desc = abbe_render_describe_traced(q);
  abbe_result result = abbe_renderer_read(renderer, true, &layers, error);
  if (result == ABBE_OK)
    result =
        abbe_traced_picture_check(&q->picture, scene, &desc, q->may_trace, &layers, &traced, error);
  if (result == ABBE_OK && q->picture.traced_instead) {
    abbe_image_free(image);
    *image = traced;
  }
  abbe_image_free(&layers);
  return result;
}

/* Photons a side of a pass that checks: few, so that a coarse picture is checked soon. */
enum { CHECK_PHOTONS = 256 };
/* Seed of passes that check: no traced picture has it. */
#define CHECK_SEED 77003u
/* For the writing of results and the end of the process. */
static const double end_s = 0.02;

static abbe_trace_desc traced_picture_describe(const abbe_traced_picture_desc *d, size_t photons) {
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
  const abbe_bounded_trace_desc trace = {.trace = traced_picture_describe(desc, point->photons),
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
  const abbe_checked_picture_desc check = {.trace = traced_picture_describe(desc, CHECK_PHOTONS),
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
      .trace = traced_picture_describe(desc, CHECK_PHOTONS),
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
