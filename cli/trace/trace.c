#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/picture_options.h"
#include "cli/options/scene_input.h"
#include "cli/trace/trace_request.h"

#include "library/choice/trace_times.h"
#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/trace_run.h"
#include "validation/trace/tracer/tracer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
  OPTION_PHYSICS = 0x400,
  OPTION_POLARISATION,
  OPTION_MAP,
  OPTION_SPACE,
  OPTION_OBSERVER,
  OPTION_FILTER,
  OPTION_PASSES,
  OPTION_STATS,
  OPTION_MOVE
};

enum { DEFAULT_PASSES = 64, MOST_PASSES = 1000000 };

typedef abbe_trace_request request;

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES,
     "the scene-linear picture with its standard errors, .exr; or that for a display, by its "
     "ending as --png",
     0, ABBE_TAKE_OUTPUT(request, exr, png)},
    {"png", 0, "FILE.png", ABBE_ARGUMENT_WRITES,
     "the picture for a display, through OpenColorIO: .png, .webp, .jpg, .gif or .avif", 0,
     ABBE_TAKE_OUTPUT(request, png, png)},
    {"stats", OPTION_STATS, "FILE|-", ABBE_ARGUMENT_WRITES | ABBE_ARGUMENT_STREAMS,
     "passes, rays, times and the energy ledger as JSON; -: on standard output", 0,
     ABBE_TAKE_BY_KEY},
    {"json", 0, NULL, 0, "the same on standard output", 0, ABBE_TAKE_FLAG(request, json)},
    {"quiet", 'q', NULL, 0, "no progress, no summary", 0, ABBE_TAKE_FLAG(request, quiet)},
    {"spp", 0, "N", 0, "passes: a sample a pixel or more, each with its photons (64)", 1,
     ABBE_TAKE_COUNT(request, passes, 1, MOST_PASSES)},
    {"time", 0, "SECONDS", 0, "stop after this time", 1,
     ABBE_TAKE_NUMBER(request, seconds, 0.001, 1e9)},
    {"until-error", 0, "X", 0, "stop when the relative standard error is below X, 0.01 say", 1,
     ABBE_TAKE_NUMBER(request, until, 1e-9, 1e9)},
    {"photons", 0, "N", 0, "photons a pass (1048576, or four a pixel)", 1,
     ABBE_TAKE_COUNT(request, desc.photons, 1, ABBE_TRACER_MAX_PHOTONS)},
    {"physics", OPTION_PHYSICS, "NAME", 0,
     "full, or matched: what the renderer's plan models and no more", 1, ABBE_TAKE_BY_KEY},
    {"polarisation", OPTION_POLARISATION, "NAME", 0,
     "auto: polarised light where the scene has polarisers, or crystals in line; or on, or off, "
     "which leaves them out",
     1, ABBE_TAKE_BY_KEY},
    {"size", 0, "WxH", 0, "pixels; the scene's own without", 1,
     ABBE_TAKE_SIZE(request, desc.width, desc.height, ABBE_TRACER_MAX_SIDE)},
    {"map", OPTION_MAP, "N|WxH", 0, "texels a side of the receiver map, or across and down (512)",
     1, ABBE_TAKE_BY_KEY},
    {"bands", 0, "N", 0, "spectral layers too, N bands over the range", 1,
     ABBE_TAKE_COUNT(request, desc.bands, 1, 256)},
    {"space", OPTION_SPACE, "NAME", 0, "of the picture: acescg, rec709, xyz (acescg)", 1,
     ABBE_TAKE_BY_KEY},
    {"observer", OPTION_OBSERVER, "NAME", 0, ABBE_OBSERVER_HELP, 1, ABBE_TAKE_BY_KEY},
    {"filter", OPTION_FILTER, NULL, 0,
     "take noise off the picture, by non-local means; what was traced is kept as raw.*", 1,
     ABBE_TAKE_BY_KEY},
    {"half", 0, NULL, 0, "files in half precision: 11 bits, and half the size", 1,
     ABBE_TAKE_FLAG(request, half)},
    ABBE_OPTIONS(request, &abbe_scene_input_options, changes, NULL, 0),
    ABBE_OPTIONS(request, &abbe_studio_options, changes, NULL, 0),
    {"alpha", 0, NULL, 0, ABBE_SCENE_INPUT_ALPHA_HELP, 1, ABBE_TAKE_FLAG(request, changes.alpha)},
    {"materials", 0, "TABLE", ABBE_ARGUMENT_READS,
     "a table instead of the scene's: default, thesis or a file", 1,
     ABBE_TAKE_TEXT(request, materials)},
    ABBE_FRAME_SERIES_MOVE(OPTION_MOVE, 5),
    ABBE_WORK_OPTIONS(request, work, 1, 2),
    {"checkpoint", 0, "FILE", ABBE_ARGUMENT_WRITES,
     "keep it there, also when all is done (OUTPUT.checkpoint, until all is done)", 2,
     ABBE_TAKE_TEXT(request, checkpoint)},
    {"passes", OPTION_PASSES, "A:B", 0,
     "passes A to B - 1 of the whole, of --spp N, alone, into --checkpoint FILE, and no other file",
     2, ABBE_TAKE_BY_KEY},
    {"merge", 0, NULL, 0,
     "trace nothing: put parts together, the checkpoints named behind the scene", 2,
     ABBE_TAKE_FLAG(request, merge)},
    {"incomplete", 0, NULL, 0, "merge also where passes are missing", 2,
     ABBE_TAKE_FLAG(request, incomplete)},
    {"rates", 0, NULL, 0, "rays a second, beside Embree's own rate on the same rays", 2,
     ABBE_TAKE_FLAG(request, rates)},
    ABBE_OPTIONS(request, &abbe_map_options_argp, map, "Receiver map:", 3),
    ABBE_OPTIONS(request, &abbe_screen_options_argp, screen,
                 "How the picture for a display shows it:", 4),
    ABBE_OPTIONS(request, &abbe_trace_frames_argp, series, "Over time:", 5),
    {0}};

#define ABBE_NAME_OF_3(code, name, ocio) name,
static const char *const spaces[] = {ABBE_RGB_SPACES(ABBE_NAME_OF_3)};
static const char *const physics[] = {"full", "matched"};
static const char *const polarisations[] = {"auto", "on", "off"};

/* "8:16". */
static void take_passes(request *q, const char *text) {
  char first[32];
  const size_t length = strcspn(text, ":");
  snprintf(first, sizeof first, "%.*s", (int)length, text);
  q->part_first = q->part_end = 0;
  if (text[length] == ':') {
    q->part_first = abbe_command_count(q->program, "--passes", first, 0, MOST_PASSES);
    q->part_end = abbe_command_count(q->program, "--passes", text + length + 1, 1, MOST_PASSES);
  }
  if (q->part_end <= q->part_first) {
    fprintf(stderr,
            "%s: --passes '%s' are no passes: two numbers, the first pass from 0 on and the "
            "one behind the last, such as 8:16\n",
            q->program, text);
    exit(ABBE_EXIT_USAGE);
  }
}

static error_t parse_work(int key, char *text, request *q) {
  abbe_trace_desc *d = &q->desc;
  const char *p = q->program;
  switch (key) {
  case OPTION_PASSES:
    take_passes(q, text);
    return 0;
  case OPTION_MOVE:
    abbe_frame_series_take_move(&q->series, &q->changes, text);
    return 0;
  case OPTION_PHYSICS:
    d->physics.matched = abbe_command_choice(p, "--physics", text, physics, 2) == 1;
    return 0;
  case OPTION_POLARISATION:
    d->polarisation =
        (abbe_trace_polarisation)abbe_command_choice(p, "--polarisation", text, polarisations, 3);
    return 0;
  case OPTION_MAP:
    if (strchr(text, 'x') != NULL)
      abbe_command_size(p, "--map", text, ABBE_TRACER_MAX_SIDE, &d->map_width, &d->map_height);
    else
      d->map_width = d->map_height = abbe_command_count(p, "--map", text, 1, ABBE_TRACER_MAX_SIDE);
    return 0;
  case OPTION_SPACE:
    d->space =
        (abbe_rgb_space)abbe_command_choice(p, "--space", text, spaces, ABBE_RGB_SPACE_COUNT);
    return 0;
  case OPTION_OBSERVER:
    d->observer = abbe_spectral_options_observer(p, text);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* What goes with --passes and --merge, and what does not. */
static void check_parts(const request *q, struct argp_state *state) {
  const bool part = q->part_end > 0;
  const char *name = part ? "--passes" : "--merge";
  if (!q->merge && q->part_count > 0)
    argp_error(state, "one scene at a time: what is '%s'?", q->parts[0]);
  if (q->merge && abbe_checkpoint_is(q->scene))
    argp_error(state, "--merge: '%s' is a part; the scene stands before its parts", q->scene);
  if (q->merge && part) argp_error(state, "--passes traces a part, and --merge traces nothing");
  if (q->merge && q->part_count == 0)
    argp_error(state, "--merge: which parts? Name their checkpoints behind the scene");
  if (part && q->checkpoint == NULL)
    argp_error(state, "--passes needs a file for its part: --checkpoint FILE");
  if (q->incomplete && !q->merge) argp_error(state, "--incomplete goes with --merge");
  if (!part && !q->merge) return;
  if (q->seconds > 0 || q->until > 0)
    argp_error(state, "%s has its own number of passes: no --time or --until-error", name);
  if (part && q->passes > 0 && q->passes < q->part_end)
    argp_error(state, "--passes ends with pass %zu, and the whole has %zu, by --spp",
               q->part_end - 1, q->passes);
  if (q->incomplete && q->checkpoint != NULL)
    argp_error(state, "--incomplete goes without --checkpoint: what lacks passes is no part");
  if (q->rates || (q->merge && q->work.resume))
    argp_error(state, "%s goes without --%s", name, q->rates ? "rates" : "resume");
}

static void take_part(request *q, const char *path) {
  const char **parts = realloc(q->parts, (q->part_count + 1) * sizeof *parts);
  if (parts == NULL) {
    fprintf(stderr, "%s: no memory for the arguments\n", q->program);
    exit(ABBE_EXIT_FAILED);
  }
  q->parts = parts;
  q->parts[q->part_count++] = path;
}

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case OPTION_STATS:
    if (strcmp(text, "-") == 0)
      q->json = true;
    else
      q->stats = abbe_command_target(state->name, "--stats", text, ".json");
    return 0;
  case OPTION_FILTER:
    q->filter = q->desc.guides = true;
    return 0;
  case ARGP_KEY_ARG:
    if (q->scene == NULL || abbe_studio_is_stone(text))
      abbe_scene_input_take_file(&q->changes, &q->scene, text, state);
    else
      take_part(q, text);
    return 0;
  case ARGP_KEY_END:
    if (q->scene == NULL) argp_error(state, "which scene? Try scenes/sphere.yaml");
    check_parts(q, state);
    abbe_trace_frames_check(q, state);
    if (q->part_end == 0 && q->exr == NULL && q->png == NULL && q->map.save == NULL &&
        q->stats == NULL && !q->json && !q->rates && !q->merge)
      q->png = abbe_scene_input_picture(q->program, q->scene);
    if (q->part_end == 0 && q->exr == NULL && q->png == NULL && q->map.save == NULL &&
        q->stats == NULL && !q->json && !q->rates && !(q->merge && q->checkpoint != NULL))
      argp_error(state, "where to? Give -o FILE.exr, --save-map FILE.exr or both");
    if (q->filter && q->part_end == 0 && ((q->exr == NULL && q->png == NULL) || q->passes == 1))
      argp_error(state, "--filter needs a picture (-o, --png) of two passes or more (--spp 2)");
    q->screen.alpha = q->changes.alpha;
    q->changes.studio.columns = q->desc.width;
    q->changes.studio.rows = q->desc.height;
    q->series.stated = q->screen.stated || q->png == NULL;
    abbe_screen_options_end(&q->screen, q->png, state);
    if (q->screen.exposed && q->series.count > 0)
      argp_error(state, "--exposure auto is of one picture: give the stops that it takes for one");
    if (q->screen.alpha && q->series.count > 0)
      argp_error(state, "--alpha is of one picture: it goes without --frames");
    return 0;
  default:
    return parse_work(key, text, q);
  }
}

/* ---- before the work ---- */

static abbe_result check_targets(const request *q, abbe_error *error) {
  const char *const targets[] = {q->checkpoint, q->stats, q->exr, q->png, q->map.save};
  const bool part = q->part_end > 0;
  abbe_result targeted = abbe_command_check_targets(targets, part ? 2 : 5, error);
  if (targeted != ABBE_OK) return targeted;
  if (q->png == NULL || part) return ABBE_OK;
  return abbe_screen_options_check(&q->screen, q->png, q->desc.space, error);
}

/* The checkpoint stands beside the first output. */
static abbe_result name_checkpoint(request *q, abbe_error *error) {
  const char *beside = q->exr ? q->exr : q->map.save ? q->map.save : q->png;
  if (q->checkpoint == NULL && (beside == NULL || q->merge)) return ABBE_OK;
  const size_t size = strlen(q->checkpoint ? q->checkpoint : beside) + sizeof ".checkpoint";
  q->checkpoint_path = malloc(size);
  if (q->checkpoint_path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  snprintf(q->checkpoint_path, size, "%s%s", q->checkpoint ? q->checkpoint : beside,
           q->checkpoint ? "" : ".checkpoint");
  if (q->checkpoint == NULL)
    abbe_arguments_add(q->program, ABBE_ARGUMENT_WRITES, "the checkpoint", q->checkpoint_path);
  return ABBE_OK;
}

/* ---- the work ---- */

static abbe_result print_rates(const request *q, abbe_tracer *tracer, abbe_error *error) {
  if (!q->rates) return ABBE_OK;
  double walk, embree;
  ABBE_TRY(abbe_tracer_rates(tracer, &walk, &embree, error));
  printf("photon walk %.2f million rays/s a thread; Embree alone on the same rays %.2f; share "
         "%.0f %%\n",
         1e-6 * walk, 1e-6 * embree, 100 * walk / embree);
  return ABBE_OK;
}

/* The image of fewer passes is not in a checkpoint of more, nor that of others. */
static abbe_result resume(const request *q, abbe_tracer *tracer, abbe_error *error) {
  const bool part = q->part_end > 0;
  if (!q->work.resume || q->checkpoint_path == NULL || access(q->checkpoint_path, F_OK) != 0)
    return part ? abbe_tracer_begin_at(tracer, q->part_first, 1, error) : ABBE_OK;
  ABBE_TRY(abbe_checkpoint_load(tracer, q->checkpoint_path, error));
  const size_t passes = abbe_tracer_passes(tracer), first = abbe_tracer_first_pass(tracer);
  if (first != q->part_first || abbe_tracer_step(tracer) != 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s holds %spasses from %zu on, not all from %zu: give each part a file "
                          "of its own, or start anew without --resume",
                          q->checkpoint_path, abbe_tracer_step(tracer) == 1 ? "" : "a rank's ",
                          first, q->part_first);
  if (passes <= q->passes) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s holds %zu passes already, more than the %zu that are asked for: ask "
                        "with %s for as many, or start anew without --resume",
                        q->checkpoint_path, passes, q->passes, part ? "--passes" : "--spp");
}

/* A user's stop keeps what is done: results are written, and the checkpoint to go on from. */
static abbe_result trace(request *q, abbe_tracer *tracer, abbe_error *error) {
  const bool part = q->part_end > 0;
  const abbe_trace_run_desc run = {.passes = q->passes,
                                   .whole = q->whole,
                                   .seconds = q->seconds,
                                   .error = q->until,
                                   .checkpoint = q->checkpoint_path,
                                   .checkpoint_s = q->work.every_s};
  abbe_checkpoint_merging how = {.whole = q->whole, .incomplete = q->incomplete};
  abbe_result result = q->merge
                           ? abbe_checkpoint_merge(tracer, q->parts, q->part_count, &how, error)
                           : resume(q, tracer, error);
  if (result != ABBE_OK) return result;
  if (how.lacks[0] != '\0') fprintf(stderr, "note: %s\n", how.lacks);
  if (!q->merge) result = abbe_trace_passes(q, &run, tracer, error);
  bool stopped = result == ABBE_CANCELLED;
  if (result != ABBE_OK && !stopped) return result;
  size_t passes = abbe_tracer_passes(tracer);
  if (stopped && passes == 0)
    return abbe_error_set(error, ABBE_CANCELLED,
                          "stopped before the first pass was done; nothing "
                          "was written");
  result = abbe_trace_write(q, tracer, error);
  if (result == ABBE_OK && (stopped || q->checkpoint != NULL))
    result = abbe_trace_keep(tracer, &run, error);
  else if (result == ABBE_OK && q->checkpoint_path != NULL)
    unlink(q->checkpoint_path);
  if (result == ABBE_OK) abbe_trace_summarise(q, tracer);
  if (result == ABBE_OK && part && !stopped && !q->quiet)
    fprintf(stderr, "passes %zu to %zu are in %s; --merge puts parts together\n", q->part_first,
            q->part_end - 1, q->checkpoint_path);
  if (result == ABBE_OK && stopped)
    return abbe_error_set(error, ABBE_CANCELLED,
                          "stopped after %zu passes; what is done is saved, and the same command "
                          "with --resume goes on",
                          passes);
  return result;
}

static abbe_result run(request *q, const abbe_scene *scene, abbe_error *error) {
  ABBE_HELD(abbe_tracer, tracer) = NULL;
  q->traced = scene;
  ABBE_TRY(abbe_map_options_resolve(&q->map, scene, false, error));
  q->desc.map_light = q->map.light_index;
  if (q->map.like != NULL) {
    q->desc.layout = &q->map.layout;
    if (q->desc.map_width == 0) q->desc.map_width = q->desc.map_height = q->map.side;
  }
  q->desc.no_picture = q->exr == NULL && q->png == NULL && q->map.save != NULL;
  q->desc.no_map = q->map.save == NULL && !q->desc.no_picture;
  if (q->desc.physics.matched)
    ABBE_TRY(abbe_matched_physics(scene, q->desc.min_nm, q->desc.max_nm, &q->desc.physics, error));
  ABBE_TRY(abbe_tracer_make(scene, &q->desc, &tracer, error));
  ABBE_TRY(print_rates(q, tracer, error));
  const bool wants = q->exr || q->png || q->map.save || q->stats || q->json;
  if ((wants || q->part_end > 0 || q->merge)) ABBE_TRY(trace(q, tracer, error));
  return ABBE_OK;
}

int abbe_command_trace(int argc, char **argv) {
  static const abbe_parser argp = {
      options, parse, "SCENE.yaml\nSTONE.asc...\nSCENE.yaml --merge PART...",
      "Traces what light really does in a scene, with standard errors: the reference.\v"
      "Examples:\n"
      "  abbe trace scenes/sphere.yaml -o sphere.exr --png sphere.png\n"
      "  abbe trace scenes/gem.yaml -o gem.exr --until-error 0.01\n"
      "  abbe trace scenes/ring.yaml -o ring.exr --spp 4 --filter\n"
      "  abbe trace scenes/prism.yaml --save-map prism-map.exr --spp 256 --bands 40\n"
      "  abbe trace scenes/bunny.yaml -o bunny.exr --time 600 --resume\n"
      "  abbe trace scenes/water/pool.yaml --frames 0:24 --png pool.png --spp 8 --filter\n"
      "  abbe trace scenes/gem.yaml -o matched.exr --physics matched\n"
      "  abbe trace scenes/gem.yaml -o gem.exr --spp 64 --passes 8:16 --checkpoint part-1.ck\n"
      "  abbe trace scenes/gem.yaml -o gem.exr --merge part-*.ck\n"};
  request q = {
      .program = argv[0], .screen.program = argv[0], .series.program = argv[0], .work.every_s = 30};
  abbe_error error = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  q.desc.min_nm = q.work.min_nm;
  q.desc.max_nm = q.work.max_nm;
  q.desc.seed = q.work.seed;
  q.desc.threads = q.work.threads;
  const bool open_end = q.seconds > 0 || q.until > 0;
  q.whole = q.passes > 0 ? q.passes : q.part_end > 0 ? q.part_end : 0;
  if (q.part_end > 0) q.passes = q.part_end - q.part_first;
  if (q.passes == 0) q.passes = open_end ? MOST_PASSES : DEFAULT_PASSES;
  if (q.whole == 0 && !q.merge && !open_end) q.whole = q.passes;
  if (open_end) q.whole = 0; /* where it ends is not known */
  abbe_scene scene = {0};
  abbe_result result = check_targets(&q, &error);
  if (result == ABBE_OK) result = name_checkpoint(&q, &error);
  if (result == ABBE_OK)
    result = abbe_scene_input_load_with(argv[0], q.scene, q.materials, &q.changes, &scene, &error);
  if (result == ABBE_OK) result = abbe_scene_input_check_alpha(&scene, &error);
  if (result == ABBE_OK && !q.quiet) abbe_scene_input_note(&scene);
  q.series.resume = q.work.resume;
  if (result == ABBE_OK && q.series.count > 0)
    result = abbe_frame_series_record(&q.series, &scene, &error);
  if (result == ABBE_OK)
    result =
        q.series.count > 0 ? abbe_trace_frames(&q, &scene, run, &error) : run(&q, &scene, &error);
  abbe_frame_series_free(&q.series);
  free(q.checkpoint_path);
  free(q.parts);
  abbe_scene_free(&scene);
  return abbe_command_end(argv[0], result, &error);
}
