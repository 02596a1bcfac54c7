#include "cli/trace/trace_request.h"

#include "base/clock.h"
#include "base/file.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "colorimetry/image/exr.h"
#include "validation/trace/denoise.h"
#include "validation/trace/tracer/checkpoint.h"

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
  cJSON_AddNumberToObject(energy, "turned", l->turned);
  cJSON_AddNumberToObject(energy, "frosted", l->frosted);
  cJSON_AddNumberToObject(energy, "excited", l->excited);
  cJSON_AddNumberToObject(energy, "glowing", l->glowing);
  cJSON_AddNumberToObject(energy, "photons_per_photon",
                          l->quanta[0] > 0 ? l->quanta[1] / l->quanta[0] : NAN); /* null */
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
  return abbe_command_write_json(root, true, q->json, q->stats, error);
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
    if (s.ledger.turned > 0)
      fprintf(stderr, ", %.2f %% scattered inside and followed on", whole * s.ledger.turned);
    if (s.ledger.frosted > 0)
      fprintf(stderr, ", %.2f %% of it met rough faces", whole * s.ledger.frosted);
    if (s.ledger.excited > 0)
      fprintf(stderr, ", %.2f %% taken to glow, and %.2f %% glowing (%.4g photons by photon)",
              whole * s.ledger.excited, whole * s.ledger.glowing,
              s.ledger.quanta[1] / s.ledger.quanta[0]);
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

enum { OPTION_FRAMES = 0x900, OPTION_PART };

static const abbe_option options[] = {
    {"frames", OPTION_FRAMES, "A:B", 0,
     "frames A to B - 1 over time, numbered, and FILE.png, .webp or .gif that moves", 5,
     ABBE_TAKE_BY_KEY},
    {"fps", 0, "F", 0, "frames a second, of time and of the picture that moves (25)", 5,
     ABBE_TAKE_NUMBER(abbe_frame_series, per_second, 0.1, 1000)},
    {"part", OPTION_PART, "K/N", 0, "only every N-th frame from the K-th on, and none that moves",
     5, ABBE_TAKE_BY_KEY},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  abbe_frame_series *s = state->input;
  switch (key) {
  case OPTION_FRAMES:
    abbe_frame_series_take(s, text);
    return 0;
  case OPTION_PART:
    abbe_command_read_part(s->program, text, &s->part);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

const abbe_parser abbe_trace_frames_argp = {.options = options, .parse = parse};

void abbe_trace_frames_check(const abbe_trace_request *q, struct argp_state *state) {
  const abbe_frame_series *s = &q->series;
  abbe_frame_series_check(s, q->png, state);
  if (s->count == 0 && (s->per_second > 0 || s->part.parts > 0))
    argp_error(state, "--%s goes with --frames A:B", s->per_second > 0 ? "fps" : "part");
  if (s->part.parts > 0 && s->part.part >= s->count)
    argp_error(state, "--part %zu/%zu has none of %zu frames", s->part.part, s->part.parts,
               s->count);
  if (s->count > 0 &&
      (q->map.save != NULL || q->stats != NULL || q->json || q->rates || q->checkpoint != NULL ||
       q->part_end > 0 || q->merge || (q->exr == NULL && q->png == NULL)))
    argp_error(state, "--frames writes frames by -o FILE.exr and --png FILE.png, and goes without "
                      "--save-map, --stats, --json, --rates, --checkpoint, --passes and --merge");
}

/* The checkpoint stands beside the frame's first file. */
static abbe_result name_files(abbe_trace_request *own, size_t number, char *name[2],
                              abbe_error *error) {
  ABBE_TRY(abbe_frame_series_name(own->exr, number, &name[0], error));
  ABBE_TRY(abbe_frame_series_name(own->png, number, &name[1], error));
  own->exr = name[0];
  own->png = name[1];
  const char *beside = own->exr != NULL ? own->exr : own->png;
  const size_t size = strlen(beside) + 32;
  own->checkpoint_path = malloc(size);
  if (own->checkpoint_path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  snprintf(own->checkpoint_path, size, "%s.checkpoint", beside);
  return ABBE_OK;
}

static abbe_result trace_frame(const abbe_trace_request *q, const abbe_scene *scene, size_t i,
                               abbe_trace_frame trace_one, abbe_error *error) {
  abbe_trace_request own = *q;
  abbe_scene moved = {0};
  char *name[2] = {NULL, NULL};
  own.checkpoint_path = NULL;
  own.frame = i;
  abbe_result result = name_files(&own, q->series.first + i, name, error);
  if (result == ABBE_OK)
    result =
        abbe_frame_series_scene(&q->series, scene, q->materials, &q->changes, i, &moved, error);
  if (result == ABBE_OK && !q->quiet) fprintf(stderr, "frame %zu of %zu\n", i + 1, q->series.count);
  if (result == ABBE_OK) result = trace_one(&own, &moved, error);
  abbe_scene_free(&moved);
  free(own.checkpoint_path);
  for (int k = 0; k < 2; k++) free(name[k]);
  return result;
}

abbe_result abbe_trace_frames(const abbe_trace_request *q, const abbe_scene *scene,
                              abbe_trace_frame trace_one, abbe_error *error) {
  const abbe_frame_series *s = &q->series;
  for (size_t i = 0; i < s->count; i++)
    if (abbe_frame_series_draws(s, i, q->exr, q->png))
      ABBE_TRY(trace_frame(q, scene, i, trace_one, error));
  if (q->png != NULL && s->part.parts == 0) ABBE_TRY(abbe_frame_series_merge(s, q->png, error));
  return ABBE_OK;
}

abbe_result abbe_trace_passes(const abbe_trace_request *q, const abbe_trace_run_desc *run,
                              abbe_tracer *tracer, abbe_error *error) {
  abbe_progress progress;
  abbe_trace_run_desc own = *run;
  own.progress = abbe_progress_update;
  own.user = &progress;
  own.stop = abbe_progress_stopped();
  abbe_progress_begin(&progress, "trace", q->quiet);
  const abbe_result result = abbe_trace_run(tracer, &own, error);
  abbe_progress_end(&progress);
  return result;
}
