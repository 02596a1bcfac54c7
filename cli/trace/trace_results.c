#include "cli/trace/trace_request.h"

#include "cli/base/command.h"

#include "base/clock.h"
#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "validation/trace/denoise.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add_ledger(cJSON *root, const abbe_light_ledger *l, bool map) {
  cJSON *energy = cJSON_AddObjectToObject(root, "energy");
  cJSON_AddNumberToObject(energy, "reached", l->reached);
  cJSON_AddNumberToObject(energy, "deposited", l->deposited);
  cJSON_AddNumberToObject(energy, "contact", l->contact);
  cJSON_AddNumberToObject(energy, "hidden", map ? l->hidden : NAN); /* null */
  cJSON_AddNumberToObject(energy, "absorbed", l->absorbed);
  cJSON_AddNumberToObject(energy, "missed", l->missed);
  cJSON_AddNumberToObject(energy, "trapped", l->trapped);
  cJSON_AddNumberToObject(energy, "lost", l->lost);
  cJSON_AddNumberToObject(energy, "scattered", l->scattered);
}

static abbe_result write_stats(const abbe_trace_request *q, const abbe_tracer *tracer,
                               abbe_error *error) {
  if (q->stats == NULL && !q->json) return ABBE_OK;
  abbe_trace_statistics s;
  abbe_tracer_statistics(tracer, &s);
  cJSON *root = cJSON_CreateObject();
  cJSON_AddNumberToObject(root, "passes", (double)s.passes);
  cJSON_AddNumberToObject(root, "photons", (double)s.photons);
  cJSON_AddNumberToObject(root, "light_rays", (double)s.light_rays);
  cJSON_AddNumberToObject(root, "eye_rays", (double)s.eye_rays);
  cJSON_AddNumberToObject(root, "light_seconds", s.light_seconds);
  cJSON_AddNumberToObject(root, "eye_seconds", s.eye_seconds);
  if (q->filter) cJSON_AddNumberToObject(root, "filter_seconds", q->filter_seconds);
  cJSON_AddNumberToObject(root, "relative_error", abbe_tracer_error(tracer));
  cJSON_AddNumberToObject(root, "cut", (double)s.cuts);
  cJSON_AddNumberToObject(root, "gather_radius_m", s.radius);
  add_ledger(root, &s.ledger, !q->desc.no_map);
  char *text = abbe_command_json_text(root);
  cJSON_Delete(root);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the statistics");
  if (q->json) fputs(text, stdout);
  abbe_result result = ABBE_OK;
  if (q->stats != NULL) result = abbe_file_write(q->stats, text, strlen(text), error);
  free(text);
  return result;
}

static abbe_result write_exr(const abbe_trace_request *q, const char *path, const abbe_image *image,
                             abbe_error *error) {
  return q->half ? abbe_exr_write_half(path, image, error) : abbe_exr_write(path, image, error);
}

/* A trace that was stopped after one pass has nothing to go by: its picture stays as it is. */
static abbe_result filter(abbe_trace_request *q, size_t passes, abbe_image *image,
                          abbe_error *error) {
  if (!q->filter || passes < 2) return ABBE_OK;
  const abbe_denoise_desc desc = {.threads = q->desc.threads};
  abbe_image filtered;
  const double start = abbe_clock_seconds();
  abbe_result result = abbe_denoise_picture(image, &desc, &filtered, error);
  q->filter_seconds = abbe_clock_seconds() - start;
  if (result != ABBE_OK) return result;
  abbe_image_free(image);
  *image = filtered;
  return ABBE_OK;
}

abbe_result abbe_trace_write(abbe_trace_request *q, const abbe_tracer *tracer, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_image image = {0};
  const bool part = q->part_end > 0; /* its checkpoint is all that is written of it */
  if (!part && (q->exr != NULL || q->png != NULL)) {
    result = abbe_tracer_picture(tracer, &image, error);
    if (result == ABBE_OK) result = filter(q, abbe_tracer_passes(tracer), &image, error);
    if (result == ABBE_OK && q->screen.alpha)
      result = abbe_scene_input_add_alpha(q->traced, ABBE_SCENE_INPUT_ALPHA_SAMPLES, &image, error);
    if (result == ABBE_OK && q->series.count > 0)
      result = abbe_frame_series_mark(&q->series, q->frame, &image, error);
    if (result == ABBE_OK && q->exr != NULL) result = write_exr(q, q->exr, &image, error);
    if (result == ABBE_OK && q->png != NULL)
      result = abbe_screen_options_write(&q->screen, q->png, &image, NULL, NULL, error);
    abbe_image_free(&image);
  }
  if (result == ABBE_OK && !part && q->map.save != NULL) {
    result = abbe_tracer_map(tracer, &image, error);
    if (result == ABBE_OK) result = write_exr(q, q->map.save, &image, error);
    abbe_image_free(&image);
  }
  if (result == ABBE_OK) result = write_stats(q, tracer, error);
  return result;
}

void abbe_trace_summarise(const abbe_trace_request *q, const abbe_tracer *tracer) {
  if (q->quiet || q->json) return;
  abbe_trace_statistics s;
  abbe_tracer_statistics(tracer, &s);
  double seconds = s.light_seconds + s.eye_seconds;
  fprintf(stderr, "%zu pass%s", s.passes, s.passes == 1 ? "" : "es");
  if (seconds > 0) fprintf(stderr, " in %.1f s", seconds);
  fprintf(stderr, ", %.3g million photons, %.3g million rays; ", 1e-6 * (double)s.photons,
          1e-6 * (double)(s.light_rays + s.eye_rays));
  if (s.passes < 2)
    fprintf(stderr, "no standard errors, which take two passes or more (--spp 2)");
  else
    fprintf(stderr, "%srelative standard error %.2g", q->filter ? "unfiltered " : "",
            abbe_tracer_error(tracer));
  if (s.ledger.reached > 0) {
    double whole = 100 / s.ledger.reached;
    fprintf(stderr,
            "; of the light that met refractors %.2f %% is on receivers, %.2f %% absorbed, %.2f %% "
            "missed, %.2g %% lost",
            whole * s.ledger.deposited, whole * s.ledger.absorbed, whole * s.ledger.missed,
            whole * s.ledger.lost);
    if (s.ledger.hidden > 0)
      fprintf(stderr, ", %.2f %% where receivers hide it from its lamp, in no map",
              whole * s.ledger.hidden);
    if (s.ledger.scattered > 0)
      fprintf(stderr, ", %.2f %% scattered on its way", whole * s.ledger.scattered);
    if (s.ledger.trapped > 0)
      fprintf(stderr, ", %.2f %% trapped, which is not modelled", whole * s.ledger.trapped);
  }
  fprintf(stderr, "\n");
  if (!q->desc.no_picture && s.faintest < ABBE_TRACER_FAINTEST)
    fprintf(
        stderr,
        "note: the dimmest of the scene's lights has %.1g of the brightest's radiance; light below "
        "%.1g of that is lost in the sums\n",
        s.faintest, ABBE_TRACER_FAINTEST);
  if (s.cuts > 0)
    fprintf(stderr, "note: %llu contributions were too bright to be kept whole\n",
            (unsigned long long)s.cuts);
}
