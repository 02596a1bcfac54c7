#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/map_options.h"
#include "cli/base/progress.h"
#include "cli/base/scene_input.h"

#include "base/clock.h"
#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/screen_png.h"
#include "scenes/import/scene_file.h"
#include "validation/denoise/denoise.h"
#include "validation/sweep/matched_physics.h"
#include "validation/tracer/checkpoint.h"
#include "validation/tracer/trace_run.h"
#include "validation/tracer/tracer.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
  OPTION_PNG = 0x400,
  OPTION_SPP,
  OPTION_TIME,
  OPTION_UNTIL_ERROR,
  OPTION_PHYSICS,
  OPTION_PHOTONS,
  OPTION_SIZE,
  OPTION_MAP,
  OPTION_BANDS,
  OPTION_RANGE,
  OPTION_SPACE,
  OPTION_HALF,
  OPTION_FILTER,
  OPTION_SEED,
  OPTION_THREADS,
  OPTION_MATERIALS,
  OPTION_RESUME,
  OPTION_CHECKPOINT,
  OPTION_EVERY,
  OPTION_VIEW,
  OPTION_EXPOSURE,
  OPTION_STATS,
  OPTION_JSON,
  OPTION_RATES
};

enum { DEFAULT_PASSES = 64, MOST_PASSES = 1000000 };

typedef struct request {
  const char *program, *scene, *materials;
  abbe_scene_input_changes changes;
  const char *exr, *png, *stats, *checkpoint;
  const char *of_png; /* an option that the PNG alone has */
  abbe_map_options map;
  abbe_trace_desc desc;
  size_t passes;
  double seconds, until, every;
  bool resume, json, quiet, rates, half, filter;
  double filter_seconds; /* spent */
  abbe_display_desc display;
  char *checkpoint_path;
} request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE.exr", ABBE_ARGUMENT_WRITES,
     "the scene-linear picture with its standard errors", 0},
    {"png", OPTION_PNG, "FILE.png", ABBE_ARGUMENT_WRITES,
     "the picture for a display, through OpenColorIO", 0},
    {"stats", OPTION_STATS, "FILE", ABBE_ARGUMENT_WRITES,
     "passes, rays, times and the energy ledger as JSON", 0},
    {"json", OPTION_JSON, NULL, 0, "the same on standard output", 0},
    {"quiet", 'q', NULL, 0, "no progress, no summary", 0},
    {"spp", OPTION_SPP, "N", 0, "passes: a sample a pixel or more, each with its photons (64)", 1},
    {"time", OPTION_TIME, "SECONDS", 0, "stop after this time", 1},
    {"until-error", OPTION_UNTIL_ERROR, "X", 0,
     "stop when the relative standard error is below X, 0.01 say", 1},
    {"photons", OPTION_PHOTONS, "N", 0, "photons a pass (1048576, or four a pixel)", 1},
    {"physics", OPTION_PHYSICS, "NAME", 0,
     "full, or matched: what the renderer's plan models and no more", 1},
    {"size", OPTION_SIZE, "WxH", 0, "pixels; the scene's own without", 1},
    {"map", OPTION_MAP, "N|WxH", 0, "texels a side of the receiver map, or across and down (512)",
     1},
    {"bands", OPTION_BANDS, "N", 0, "spectral layers too, N bands over the range", 1},
    {"range", OPTION_RANGE, "FROM:TO", 0, "wavelengths in nm (380:780)", 1},
    {"space", OPTION_SPACE, "NAME", 0, "of the picture: acescg, rec709, xyz (acescg)", 1},
    {"filter", OPTION_FILTER, NULL, 0,
     "take noise off the picture, by non-local means; what was traced is kept as raw.*", 1},
    {"half", OPTION_HALF, NULL, 0, "files in half precision: 11 bits, and half the size", 1},
    {"seed", OPTION_SEED, "N", 0, "of the random numbers (0)", 1},
    {"threads", OPTION_THREADS, "N", 0, "all cores without; the result is the same", 1},
    ABBE_SCENE_INPUT_OPTIONS(1),
    {"materials", OPTION_MATERIALS, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1},
    {"resume", OPTION_RESUME, NULL, 0, "go on from the checkpoint, where there is one", 2},
    {"checkpoint", OPTION_CHECKPOINT, "FILE", ABBE_ARGUMENT_WRITES,
     "keep it there, also when all is done (OUTPUT.checkpoint, until all is done)", 2},
    {"checkpoint-every", OPTION_EVERY, "SECONDS", 0, "how often it is written (30)", 2},
    {"view", OPTION_VIEW, "NAME", 0, "of the display, for the PNG", 2},
    {"exposure", OPTION_EXPOSURE, "STOPS", 0, "for the PNG (0)", 2},
    {"rates", OPTION_RATES, NULL, 0, "rays a second, beside Embree's own rate on the same rays", 2},
    {0}};

#define ABBE_NAME_OF_3(code, name, ocio) name,
static const char *const spaces[] = {ABBE_RGB_SPACES(ABBE_NAME_OF_3)};
static const char *const physics[] = {"full", "matched"};

static error_t parse_work(int key, char *text, request *q) {
  abbe_trace_desc *d = &q->desc;
  const char *p = q->program;
  switch (key) {
  case OPTION_SPP:
    q->passes = abbe_command_count(p, "--spp", text, 1, MOST_PASSES);
    return 0;
  case OPTION_TIME:
    q->seconds = abbe_command_number(p, "--time", text, 0.001, 1e9);
    return 0;
  case OPTION_UNTIL_ERROR:
    q->until = abbe_command_number(p, "--until-error", text, 1e-9, 1e9);
    return 0;
  case OPTION_PHOTONS:
    d->photons = abbe_command_count(p, "--photons", text, 1, ABBE_TRACER_MAX_PHOTONS);
    return 0;
  case OPTION_PHYSICS:
    d->physics.matched = abbe_command_choice(p, "--physics", text, physics, 2) == 1;
    return 0;
  case OPTION_SIZE:
    abbe_command_size(p, "--size", text, ABBE_TRACER_MAX_SIDE, &d->width, &d->height);
    return 0;
  case OPTION_MAP:
    if (strchr(text, 'x') != NULL)
      abbe_command_size(p, "--map", text, ABBE_TRACER_MAX_SIDE, &d->map_width, &d->map_height);
    else
      d->map_width = d->map_height = abbe_command_count(p, "--map", text, 1, ABBE_TRACER_MAX_SIDE);
    return 0;
  case OPTION_BANDS:
    d->bands = abbe_command_count(p, "--bands", text, 1, 256);
    return 0;
  case OPTION_RANGE:
    abbe_command_range(p, "--range", text, &d->min_nm, &d->max_nm);
    return 0;
  case OPTION_SPACE:
    d->space =
        (abbe_rgb_space)abbe_command_choice(p, "--space", text, spaces, ABBE_RGB_SPACE_COUNT);
    return 0;
  case OPTION_SEED:
    d->seed = (uint32_t)abbe_command_count(p, "--seed", text, 0, UINT32_MAX);
    return 0;
  case OPTION_THREADS:
    d->threads = abbe_command_count(p, "--threads", text, 1, ABBE_TRACER_MAX_THREADS);
    return 0;
  default:
    return abbe_scene_input_take(&q->changes, key, text, p);
  }
}

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case ARGP_KEY_INIT:
    state->child_inputs[0] = &q->map;
    return 0;
  case 'o':
    q->exr = abbe_command_target(state->name, "-o", text, ".exr");
    return 0;
  case OPTION_PNG:
    q->png = abbe_command_target(state->name, "--png", text, ".png");
    return 0;
  case OPTION_STATS:
    q->stats = abbe_command_target(state->name, "--stats", text, ".json");
    return 0;
  case OPTION_JSON:
    q->json = true;
    return 0;
  case 'q':
    q->quiet = true;
    return 0;
  case OPTION_MATERIALS:
    q->materials = text;
    return 0;
  case OPTION_HALF:
    q->half = true;
    return 0;
  case OPTION_FILTER:
    q->filter = q->desc.guides = true;
    return 0;
  case OPTION_RESUME:
    q->resume = true;
    return 0;
  case OPTION_CHECKPOINT:
    q->checkpoint = text;
    return 0;
  case OPTION_EVERY:
    q->every = abbe_command_number(q->program, "--checkpoint-every", text, 0, 1e9);
    return 0;
  case OPTION_VIEW:
    q->of_png = "--view";
    q->display.view = text;
    return 0;
  case OPTION_EXPOSURE:
    q->of_png = "--exposure";
    q->display.exposure = abbe_command_number(q->program, "--exposure", text, -30, 30);
    return 0;
  case OPTION_RATES:
    q->rates = true;
    return 0;
  case ARGP_KEY_ARG:
    if (q->scene != NULL) argp_error(state, "one scene at a time: what is '%s'?", text);
    q->scene = text;
    return 0;
  case ARGP_KEY_END:
    if (q->scene == NULL) argp_error(state, "which scene? Try scenes/sphere.yaml");
    if (q->exr == NULL && q->png == NULL && q->map.save == NULL && q->stats == NULL && !q->json &&
        !q->rates)
      argp_error(state, "where to? Give -o FILE.exr, --save-map FILE.exr or both");
    if (q->filter && ((q->exr == NULL && q->png == NULL) || q->passes == 1))
      argp_error(state, "--filter needs a picture (-o, --png) of two passes or more (--spp 2)");
    if (q->of_png != NULL && q->png == NULL)
      argp_error(state, "%s is for the PNG: give --png FILE.png too", q->of_png);
    return 0;
  default:
    return parse_work(key, text, q);
  }
}

/* ---- before the work ---- */

static abbe_result check_targets(const request *q, abbe_error *error) {
  const char *const targets[] = {q->exr, q->png, q->map.save, q->stats, q->checkpoint};
  abbe_result targeted = abbe_command_check_targets(targets, 5, error);
  if (targeted != ABBE_OK) return targeted;
  if (q->png == NULL) return ABBE_OK;
  abbe_display *display = NULL;
  abbe_display_desc desc = q->display;
  desc.source_space = abbe_rgb_space_ocio_name(q->desc.space);
  abbe_result result = abbe_display_make(&desc, &display, error);
  abbe_display_free(display);
  return result;
}

/* The checkpoint stands beside the first output. */
static abbe_result name_checkpoint(request *q, abbe_error *error) {
  const char *beside = q->exr ? q->exr : q->map.save ? q->map.save : q->png;
  if (q->checkpoint == NULL && beside == NULL) return ABBE_OK;
  size_t size = strlen(q->checkpoint ? q->checkpoint : beside) + sizeof ".checkpoint";
  q->checkpoint_path = malloc(size);
  if (q->checkpoint_path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  snprintf(q->checkpoint_path, size, "%s%s", q->checkpoint ? q->checkpoint : beside,
           q->checkpoint ? "" : ".checkpoint");
  if (q->checkpoint == NULL)
    abbe_arguments_add(q->program, ABBE_ARGUMENT_WRITES, "the checkpoint", q->checkpoint_path);
  return ABBE_OK;
}

/* ---- the work ---- */

/* ABBE_CANCELLED where the user stopped it: what is done is to be saved all the same. */
static abbe_result run_passes(const request *q, const abbe_trace_run_desc *run, abbe_tracer *tracer,
                              abbe_error *error) {
  abbe_progress progress;
  abbe_trace_run_desc own = *run;
  own.progress = abbe_progress_update;
  own.user = &progress;
  own.stop = abbe_progress_stopped();
  abbe_progress_begin(&progress, "trace", q->quiet);
  abbe_result result = abbe_trace_run(tracer, &own, error);
  abbe_progress_end(&progress);
  return result;
}

/* ---- results ---- */

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
}

static abbe_result write_stats(const request *q, const abbe_tracer *tracer, abbe_error *error) {
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

static abbe_result write_png(const request *q, const abbe_image *image, abbe_error *error) {
  abbe_screen_png_desc desc = {.display = q->display};
  desc.display.source_space = abbe_rgb_space_ocio_name(q->desc.space);
  return abbe_screen_png_write(q->png, image, &desc, error);
}

static abbe_result write_exr(const request *q, const char *path, const abbe_image *image,
                             abbe_error *error) {
  return q->half ? abbe_exr_write_half(path, image, error) : abbe_exr_write(path, image, error);
}

/* A trace that was stopped after one pass has nothing to go by: its picture stays as it is. */
static abbe_result filter(request *q, size_t passes, abbe_image *image, abbe_error *error) {
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

static abbe_result write_results(request *q, const abbe_tracer *tracer, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_image image = {0};
  if (q->exr != NULL || q->png != NULL) {
    result = abbe_tracer_picture(tracer, &image, error);
    if (result == ABBE_OK) result = filter(q, abbe_tracer_passes(tracer), &image, error);
    if (result == ABBE_OK && q->exr != NULL) result = write_exr(q, q->exr, &image, error);
    if (result == ABBE_OK && q->png != NULL) result = write_png(q, &image, error);
    abbe_image_free(&image);
  }
  if (result == ABBE_OK && q->map.save != NULL) {
    result = abbe_tracer_map(tracer, &image, error);
    if (result == ABBE_OK) result = write_exr(q, q->map.save, &image, error);
    abbe_image_free(&image);
  }
  if (result == ABBE_OK) result = write_stats(q, tracer, error);
  return result;
}

static void summarise(const request *q, const abbe_tracer *tracer) {
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
    if (s.ledger.trapped > 0)
      fprintf(stderr, ", %.2f %% trapped, which is not modelled", whole * s.ledger.trapped);
  }
  fprintf(stderr, "\n");
  if (s.cuts > 0)
    fprintf(stderr, "note: %llu contributions were too bright to be kept whole\n",
            (unsigned long long)s.cuts);
}

static abbe_result print_rates(const request *q, abbe_tracer *tracer, abbe_error *error) {
  if (!q->rates) return ABBE_OK;
  double walk, embree;
  abbe_result result = abbe_tracer_rates(tracer, &walk, &embree, error);
  if (result == ABBE_OK)
    printf("photon walk %.2f million rays/s a thread; Embree alone on the same rays %.2f; share "
           "%.0f %%\n",
           1e-6 * walk, 1e-6 * embree, 100 * walk / embree);
  return result;
}

/* The image of fewer passes is not in a checkpoint of more. */
static abbe_result resume(const request *q, abbe_tracer *tracer, abbe_error *error) {
  if (!q->resume || q->checkpoint_path == NULL || access(q->checkpoint_path, F_OK) != 0)
    return ABBE_OK;
  abbe_result result = abbe_checkpoint_load(tracer, q->checkpoint_path, error);
  size_t passes = abbe_tracer_passes(tracer);
  if (result != ABBE_OK || passes <= q->passes) return result;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s holds %zu passes already, more than the %zu that are asked for: ask "
                        "with --spp for as many, or start anew without --resume",
                        q->checkpoint_path, passes, q->passes);
}

/* A user's stop keeps what is done: results are written, and the checkpoint to go on from. */
static abbe_result trace(request *q, abbe_tracer *tracer, abbe_error *error) {
  const abbe_trace_run_desc run = {.passes = q->passes,
                                   .seconds = q->seconds,
                                   .error = q->until,
                                   .checkpoint = q->checkpoint_path,
                                   .checkpoint_s = q->every};
  abbe_result result = resume(q, tracer, error);
  if (result != ABBE_OK) return result;
  result = run_passes(q, &run, tracer, error);
  bool stopped = result == ABBE_CANCELLED;
  if (result != ABBE_OK && !stopped) return result;
  size_t passes = abbe_tracer_passes(tracer);
  if (stopped && passes == 0)
    return abbe_error_set(error, ABBE_CANCELLED,
                          "stopped before the first pass was done; nothing "
                          "was written");
  result = write_results(q, tracer, error);
  if (result == ABBE_OK && (stopped || q->checkpoint != NULL))
    result = abbe_trace_keep(tracer, &run, error);
  else if (result == ABBE_OK && q->checkpoint_path != NULL)
    unlink(q->checkpoint_path);
  if (result == ABBE_OK) summarise(q, tracer);
  if (result == ABBE_OK && stopped)
    return abbe_error_set(error, ABBE_CANCELLED,
                          "stopped after %zu passes; what is done is saved, and the same command "
                          "with --resume goes on",
                          passes);
  return result;
}

static abbe_result run(request *q, const abbe_scene *scene, abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_result result = abbe_map_options_resolve(&q->map, scene, false, error);
  if (result != ABBE_OK) return result;
  q->desc.map_light = q->map.light_index;
  if (q->map.like != NULL) {
    q->desc.layout = &q->map.layout;
    if (q->desc.map_width == 0) q->desc.map_width = q->desc.map_height = q->map.side;
  }
  q->desc.no_picture = q->exr == NULL && q->png == NULL && q->map.save != NULL;
  q->desc.no_map = q->map.save == NULL && !q->desc.no_picture;
  if (q->desc.physics.matched)
    result = abbe_matched_physics(scene, q->desc.min_nm, q->desc.max_nm, &q->desc.physics, error);
  if (result == ABBE_OK) result = abbe_tracer_make(scene, &q->desc, &tracer, error);
  if (result == ABBE_OK) result = print_rates(q, tracer, error);
  if (result == ABBE_OK && (q->exr || q->png || q->map.save || q->stats || q->json))
    result = trace(q, tracer, error);
  abbe_tracer_free(tracer);
  return result;
}

int abbe_command_trace(int argc, char **argv) {
  static const struct argp_child children[] = {{&abbe_map_options_argp, 0, "Receiver map:", 3},
                                               {0}};
  static const struct argp argp = {
      options,
      parse,
      "SCENE.yaml",
      "Traces what light really does in a scene, with standard errors: the reference.\v"
      "Examples:\n"
      "  abbe trace scenes/sphere.yaml -o sphere.exr --png sphere.png\n"
      "  abbe trace scenes/gem.yaml -o gem.exr --until-error 0.01\n"
      "  abbe trace scenes/ring.yaml -o ring.exr --spp 4 --filter\n"
      "  abbe trace scenes/prism.yaml --save-map prism-map.exr --spp 256 --bands 40\n"
      "  abbe trace scenes/bunny.yaml -o bunny.exr --time 600 --resume\n"
      "  abbe trace scenes/gem.yaml -o matched.exr --physics matched\n",
      children,
      NULL,
      NULL};
  request q = {.program = argv[0], .every = 30};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  if (q.passes == 0) q.passes = q.seconds > 0 || q.until > 0 ? MOST_PASSES : DEFAULT_PASSES;
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_result result = check_targets(&q, &error);
  if (result == ABBE_OK) result = name_checkpoint(&q, &error);
  if (result == ABBE_OK)
    result = abbe_scene_input_load_with(argv[0], q.scene, q.materials, &q.changes, &scene, &error);
  if (result == ABBE_OK && !q.quiet) abbe_scene_input_note(&scene);
  if (result == ABBE_OK) result = run(&q, &scene, &error);
  free(q.checkpoint_path);
  abbe_scene_free(&scene);
  return abbe_command_end(argv[0], result, &error);
}
