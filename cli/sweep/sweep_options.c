#include "cli/sweep/sweep_options.h"

#include "cli/base/arguments.h"
#include "cli/base/command.h"

#include "base/nearest.h"
#include "gl/plan/plan.h"
#include "library/choice/sweep_setting.h"
#include "validation/tracer/tracer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  OPTION_PLOT = 0x500,
  OPTION_REPORT,
  OPTION_WRITE_PRESETS,
  OPTION_PRESETS,
  OPTION_SCALING,
  OPTION_ESTIMATORS,
  OPTION_GRID,
  OPTION_PROFILES,
  OPTION_WAVELENGTHS,
  OPTION_PHOTONS,
  OPTION_MAP,
  OPTION_SAMPLES,
  OPTION_UPSAMPLE,
  OPTION_FILL,
  OPTION_EXITS,
  OPTION_MODEL,
  OPTION_SHARE,
  OPTION_HISTORY,
  OPTION_POLYGONS,
  OPTION_DIRECTION,
  OPTION_FRAMES,
  OPTION_SIZE,
  OPTION_ERROR,
  OPTION_TIME,
  OPTION_PROCESSES,
  OPTION_PASSES,
  OPTION_REFERENCE,
  OPTION_REFERENCE_MAP,
  OPTION_SPP,
  OPTION_TRACED_PHOTONS,
  OPTION_TEXELS,
  OPTION_PHYSICS,
  OPTION_DECOMPOSE,
  OPTION_TRACE_ONLY,
  OPTION_MATERIALS,
  OPTION_BACKEND,
  OPTION_LIST,
  OPTION_PART,
  OPTION_JSON
};

typedef abbe_sweep_options request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE.csv", ABBE_ARGUMENT_WRITES,
     "the table; rows that it holds are not measured again. Given tables: all of their rows", 0},
    {"plot", OPTION_PLOT, "FILE", ABBE_ARGUMENT_WRITES,
     "error against time, log-log: a .png or .svg; of several tables a row of charts each", 0},
    {"report", OPTION_REPORT, "FILE.md", ABBE_ARGUMENT_WRITES,
     "a page with the Pareto front and pictures beside it", 0},
    {"write-presets", OPTION_WRITE_PRESETS, "FILE.yaml", ABBE_ARGUMENT_WRITES,
     "presets off the Pareto fronts of the given tables", 0},
    {"presets", OPTION_PRESETS, "FILE.yaml", ABBE_ARGUMENT_READS,
     "say what these promise beside what was met (the shipped ones)", 0},
    {"scaling", OPTION_SCALING, NULL, 0,
     "instead: how the time scales with photons, wavelengths, pixels, faces, share of the view", 0},
    {"estimators", OPTION_ESTIMATORS, NULL, 0,
     "instead: how far from the truth the estimators of shah2007 are, by iterations and lookups; "
     "of "
     "--map and --photons the first (768, 128)",
     0},
    {"error", OPTION_ERROR, "COLUMN", 0,
     "that makes the Pareto front: caustic_de, map_rmse, picture_de, ... (caustic_de)", 0},
    {"time", OPTION_TIME, "frame|camera|warm|cold", 0,
     "that makes the Pareto front: a frame once the scene stands, one after a "
     "camera's move, or a whole process with its "
     "shaders cached or not (frame)",
     0},
    {"json", OPTION_JSON, NULL, 0, "all rows as JSON on standard output", 0},
    {"quiet", 'q', NULL, 0, "no progress", 0},
    {"grid", OPTION_GRID, "quick|full|thin|presets|volume|pinhole", 0,
     "a named set of settings; presets: do they keep their promise here? volume, pinhole: ways for "
     "the light by what is computed beforehand, and by samples of mirrors, with their bytes and "
     "what frames of a moving light take (quick)",
     1},
    {"profiles", OPTION_PROFILES, "LIST", 0,
     "default,thesis,thesis-cie,shah2007,shah2007-cie,wyman2006,wyman2006-cie,wand2003,trace,"
     "trace-filter,pinhole-64,pinhole-256,pinhole-1024 "
     "(all)",
     1},
    {"wavelengths", OPTION_WAVELENGTHS, "LIST", 0, "such as 3,7,21", 1},
    {"photons", OPTION_PHOTONS, "LIST", 0, "sides of the photon grid", 1},
    {"map", OPTION_MAP, "LIST", 0, "sides of the spectral map", 1},
    {"samples", OPTION_SAMPLES, "LIST", 0, "a pixel side", 1},
    {"upsample", OPTION_UPSAMPLE, "LIST", 0, "pixels a sample side", 1},
    {"fill", OPTION_FILL, "LIST", 0, "auto,none; of wyman2006 points,quads,...", 1},
    {"model", OPTION_MODEL, "LIST", 0, "of transport: auto, layers, hierarchy, ...", 1},
    {"exits", OPTION_EXITS, "LIST", 0, "followed at the most", 1},
    {"share", OPTION_SHARE, "LIST", 0, "of their light below which paths end", 1},
    {"polygons", OPTION_POLYGONS, "LIST", 0,
     "of wyman2006's quads and triangles: plain,even,corners,culled,in-light, and sums such as "
     "even+culled",
     1},
    {"direction", OPTION_DIRECTION, "LIST", 0,
     "that wyman2006's photons take light from: own,mean,direct", 1},
    {"history", OPTION_HISTORY, "LIST", 0,
     "frames that a picture is made of, 1 to 4: the error after 1, 2, 4 and 8", 1},
    {"passes", OPTION_PASSES, "LIST", 0, "of the tracer, each of photons x photons photons", 1},
    {"frames", OPTION_FRAMES, "N", 0, "warm up, then the median of N (5)", 1},
    {"processes", OPTION_PROCESSES, NULL, 0,
     "time whole processes too: warm ones, and cold ones of each contestant's front", 1},
    {"size", OPTION_SIZE, "WxH", 0, "pixels; the scene's own without", 1},
    {"backend", OPTION_BACKEND, "NAME", 0, "cpu, gpu, or auto: a GPU where there is one (auto)", 1},
    {"materials", OPTION_MATERIALS, "TABLE", ABBE_ARGUMENT_READS, "a table instead of the scene's",
     1},
    {"list", OPTION_LIST, NULL, 0, "only say which settings the grid has", 1},
    {"part", OPTION_PART, "K/N", 0,
     "only every N-th setting from the K-th on, 0/8 to 7/8, into a table of its own", 1},
    {"reference", OPTION_REFERENCE, "FILE.exr", ABBE_ARGUMENT_READS,
     "a traced picture (traced and kept beside it)", 2},
    {"reference-map", OPTION_REFERENCE_MAP, "FILE.exr", ABBE_ARGUMENT_READS,
     "a traced receiver map", 2},
    {"spp", OPTION_SPP, "N", 0, "passes of the reference (64)", 2},
    {"traced-photons", OPTION_TRACED_PHOTONS, "N", 0, "photons a pass (1048576)", 2},
    {"texels", OPTION_TEXELS, "N", 0, "side of the reference's map (256)", 2},
    {"decompose", OPTION_DECOMPOSE, NULL, 0,
     "trace matched physics too: what is the model's, and what is sampling's?", 2},
    {"trace-only", OPTION_TRACE_ONLY, NULL, 0,
     "trace the references, for sweeps to come, and measure nothing", 2},
    {"physics", OPTION_PHYSICS, "NAME", 0, "of the reference: full or matched (full)", 2},
    {0}};

/* Lists */

/* Calls take for every word of a list such as "3,7,21". */
static void each_word(const request *q, const char *option, const char *text, size_t *count,
                      void (*take)(const request *q, const char *option, const char *word,
                                   size_t at, void *out),
                      void *out) {
  *count = 0;
  for (const char *at = text; at != NULL;) {
    size_t length = strcspn(at, ",");
    char word[32];
    if (length == 0 || length >= sizeof word || *count == ABBE_SWEEP_MAX_VALUES) {
      fprintf(stderr, "%s: %s '%s' is not a list such as 3,7,21 of at most %d values\n", q->program,
              option, text, ABBE_SWEEP_MAX_VALUES);
      exit(ABBE_EXIT_USAGE);
    }
    snprintf(word, sizeof word, "%.*s", (int)length, at);
    take(q, option, word, (*count)++, out);
    at = at[length] == ',' ? at + length + 1 : NULL;
  }
}

static void take_count(const request *q, const char *option, const char *word, size_t at,
                       void *out) {
  size_t most = strcmp(option, "--samples") == 0       ? 4
                : strcmp(option, "--upsample") == 0    ? 4
                : strcmp(option, "--exits") == 0       ? ABBE_RENDER_MAX_EXITS
                : strcmp(option, "--history") == 0     ? ABBE_RENDER_MAX_HISTORY
                : strcmp(option, "--wavelengths") == 0 ? ABBE_RENDER_MAX_WAVELENGTHS
                : strcmp(option, "--passes") == 0      ? 65536
                                                       : ABBE_RENDER_MAX_PHOTONS;
  ((abbe_sweep_values *)out)->value[at] = abbe_command_count(q->program, option, word, 1, most);
}

static void take_share(const request *q, const char *option, const char *word, size_t at,
                       void *out) {
  ((double *)out)[at] = abbe_command_number(q->program, option, word, 1e-9, 1);
}

#define ABBE_NAME_OF(code, name) name,
static const char *const fills[] = {ABBE_FILLS(ABBE_NAME_OF)};
static const char *const models[] = {ABBE_MODELS(ABBE_NAME_OF)};
static const char *const times[ABBE_SWEEP_TIMES] = {"frame", "camera", "warm", "cold"};
static const char *const backends[] = {ABBE_CONTEXT_BACKENDS(ABBE_NAME_OF)};

static void take_name(const request *q, const char *option, const char *word, size_t at,
                      void *out) {
  const struct {
    const char *option;
    const char *const *names;
    int count;
  } lists[] = {{"--profiles", abbe_sweep_profiles, ABBE_SWEEP_PROFILE_COUNT},
               {"--model", models, ABBE_MODEL_COUNT},
               {"--polygons", abbe_sweep_polygons, ABBE_POLYGONS_ALL + 1},
               {"--direction", abbe_sweep_directions, ABBE_DIRECTION_COUNT},
               {"--fill", fills, ABBE_FILL_COUNT}};
  size_t i = 0;
  while (strcmp(lists[i].option, option) != 0) i++;
  ((abbe_sweep_values *)out)->value[at] =
      (size_t)abbe_command_choice(q->program, option, word, lists[i].names, lists[i].count);
}

static void parse_error(request *q, const char *text, struct argp_state *state) {
  const char *names[ABBE_SWEEP_NUMBER_COUNT];
  char list[400] = "";
  size_t count = 0, used = 0;
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) {
    if (!abbe_sweep_number_is_error((abbe_sweep_number)i)) continue;
    names[count] = abbe_sweep_number_name((abbe_sweep_number)i);
    used += (size_t)snprintf(list + used, sizeof list - used, " %s", names[count++]);
  }
  q->work.error = abbe_sweep_number_find(text);
  if (abbe_sweep_number_is_error(q->work.error)) return;
  const char *near = abbe_nearest_word(text, names, count);
  argp_error(state, "--error '%s' is no error%s%s%s; one is:%s", text,
             near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
             near != NULL ? "'?" : "", list);
}

static error_t parse_list(int key, const char *text, request *q) {
  abbe_sweep_grid *g = &q->list;
  const struct {
    int key;
    const char *option;
    abbe_sweep_values *values;
  } lists[] = {{OPTION_WAVELENGTHS, "--wavelengths", &g->wavelengths},
               {OPTION_PHOTONS, "--photons", &g->photons},
               {OPTION_MAP, "--map", &g->map},
               {OPTION_SAMPLES, "--samples", &g->samples},
               {OPTION_UPSAMPLE, "--upsample", &g->upsample},
               {OPTION_EXITS, "--exits", &g->exits},
               {OPTION_HISTORY, "--history", &g->history},
               {OPTION_PASSES, "--passes", &g->passes},
               {OPTION_PROFILES, "--profiles", &g->profiles},
               {OPTION_MODEL, "--model", &g->models},
               {OPTION_POLYGONS, "--polygons", &g->polygons},
               {OPTION_DIRECTION, "--direction", &g->directions},
               {OPTION_FILL, "--fill", &g->fills}};
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
    if (lists[i].key != key) continue;
    bool words = key == OPTION_PROFILES || key == OPTION_FILL || key == OPTION_MODEL ||
                 key == OPTION_POLYGONS || key == OPTION_DIRECTION;
    each_word(q, lists[i].option, text, &lists[i].values->count, words ? take_name : take_count,
              lists[i].values);
    q->listed = true;
    return 0;
  }
  if (key != OPTION_SHARE) return ARGP_ERR_UNKNOWN;
  each_word(q, "--share", text, &g->share_count, take_share, g->share);
  q->listed = true;
  return 0;
}

static error_t parse_reference(int key, char *text, request *q) {
  static const char *const physics[] = {"full", "matched"};
  abbe_sweep_request *w = &q->work;
  switch (key) {
  case OPTION_REFERENCE:
    w->reference = text;
    return 0;
  case OPTION_REFERENCE_MAP:
    w->reference_map = text;
    return 0;
  case OPTION_SPP:
    w->traced.passes = abbe_command_count(q->program, "--spp", text, 2, 1000000);
    break;
  case OPTION_TRACED_PHOTONS:
    w->traced.photons =
        abbe_command_count(q->program, "--traced-photons", text, 1, ABBE_TRACER_MAX_PHOTONS);
    break;
  case OPTION_TEXELS:
    w->traced.texels = abbe_command_count(q->program, "--texels", text, 1, ABBE_RENDER_MAX_MAP);
    break;
  case OPTION_PHYSICS:
    w->traced.matched = abbe_command_choice(q->program, "--physics", text, physics, 2) == 1;
    break;
  case OPTION_TRACE_ONLY:
    w->trace_only = true;
    break;
  case OPTION_DECOMPOSE:
    w->decompose = true;
    break;
  default:
    return parse_list(key, text, q);
  }
  q->traced = true;
  return 0;
}

bool abbe_sweep_options_compares_transports(const abbe_sweep_options *q) {
  abbe_transport_contestant list[ABBE_TRANSPORT_STUDY_MOST];
  return q->grid != NULL && abbe_transport_study_contestants(q->grid, list) > 0;
}

bool abbe_sweep_options_is_table(const char *path) {
  size_t length = strlen(path);
  return length > 4 && strcmp(path + length - 4, ".csv") == 0;
}

/* What a job of ranks does not share. */
static void check_ranks(const request *q, struct argp_state *state) {
  const char *alone = q->part.parts > 0    ? "--part"
                      : q->list_only       ? "--list"
                      : q->scaling         ? "--scaling"
                      : q->estimators      ? "--estimators"
                      : q->processes       ? "--processes"
                      : q->work.trace_only ? "--trace-only"
                                           : NULL;
  if (q->job == NULL) return;
  if (alone != NULL) argp_error(state, "%s is for one process: abbe sweep", alone);
  if (abbe_sweep_options_is_table(q->argument[0]))
    argp_error(state, "'%s' is a table: it is shown by one process, abbe sweep", q->argument[0]);
}

static void finish(request *q, struct argp_state *state) {
  abbe_sweep_request *w = &q->work;
  if (q->argument_count == 0) argp_error(state, "which scene? Give a file such as scenes/gem.yaml");
  check_ranks(q, state);
  if (abbe_sweep_options_is_table(q->argument[0])) {
    if (q->part.parts > 0 || q->listed || q->grid != NULL || q->scaling || q->estimators)
      argp_error(state, "'%s' is a table: it is shown, and nothing is measured", q->argument[0]);
    return;
  }
  if (q->write_presets != NULL)
    argp_error(state, "--write-presets reads tables: give SWEEP.csv..., and no scene");
  q->scene = q->argument[0];
  if (q->argument_count > 1)
    argp_error(state, "one scene at a time: '%s' and '%s'", q->scene, q->argument[1]);
  if (q->estimators && (q->grid != NULL || q->traced || q->report != NULL || q->json ||
                        q->scaling || q->plot != NULL || q->list_only || w->reference != NULL))
    argp_error(state, "--estimators draws nothing: it goes with -o, --map, --photons and "
                      "--materials alone");
  if (w->table == NULL && !q->list_only && !q->estimators)
    argp_error(state, "where to? Give -o FILE.csv");
  if (q->listed && q->grid != NULL)
    argp_error(state, "--grid and lists such as --wavelengths 3,7: one or the other");
  if (q->scaling && (q->listed || q->grid != NULL || q->traced || q->report != NULL || q->json ||
                     w->traced.width != w->traced.height || q->list_only))
    argp_error(state,
               "--scaling times frames: it goes with -o, --plot, --frames, --backend, --materials "
               "and a square --size alone");
  if (abbe_sweep_options_compares_transports(q) &&
      (w->reference == NULL || q->traced || q->report != NULL || q->json || q->plot != NULL ||
       q->list_only || q->part.parts > 0 || w->reference_map != NULL || q->processes))
    argp_error(state,
               "--grid %s draws beside a traced picture: it goes with -o, --reference FILE.exr, "
               "--frames, --backend and --materials alone",
               q->grid);
  bool named = w->reference != NULL || w->reference_map != NULL;
  if (named && q->traced)
    argp_error(state,
               "--spp, --texels, --physics, --decompose, --trace-only and --traced-photons are "
               "for a reference "
               "that is traced, and one is given");
  if (w->decompose && w->traced.matched)
    argp_error(state,
               "--decompose traces full and matched physics; --physics asks for one of them");
  if (w->reference != NULL && w->traced.width != 0)
    argp_error(state, "--size goes with a reference that is traced; the given one has its own");
}

/* The name of a grid that there is, or "presets". */
static const char *choose_grid(const request *q, const char *text) {
#define ABBE_STUDY_NAME(name, code) name,
  static const char *const studies[] = {ABBE_TRANSPORT_STUDIES(ABBE_STUDY_NAME)};
  enum { STUDIES = sizeof studies / sizeof *studies };
  const char *names[ABBE_SWEEP_MAX_GRIDS + 1 + STUDIES];
  size_t count = q->grids->count;
  for (size_t i = 0; i < count; i++) names[i] = q->grids->grid[i].name;
  names[count++] = "presets";
  for (size_t i = 0; i < STUDIES; i++) names[count++] = studies[i];
  return names[abbe_command_choice(q->program, "--grid", text, names, (int)count)];
}

static error_t parse(int key, char *text, struct argp_state *state) {
  request *q = state->input;
  abbe_sweep_request *w = &q->work;
  switch (key) {
  case 'o':
    w->table = abbe_command_target(state->name, "-o", text, ".csv");
    return 0;
  case OPTION_PLOT:
    q->plot = text;
    return 0;
  case OPTION_REPORT:
    q->report = text;
    return 0;
  case OPTION_WRITE_PRESETS:
    q->write_presets = text;
    return 0;
  case OPTION_SCALING:
    q->scaling = true;
    return 0;
  case OPTION_ESTIMATORS:
    q->estimators = true;
    return 0;
  case OPTION_PRESETS:
    q->write_presets = text;
    return 0;
  case OPTION_ERROR:
    parse_error(q, text, state);
    return 0;
  case OPTION_TIME:
    w->time =
        abbe_sweep_times[abbe_command_choice(q->program, "--time", text, times, ABBE_SWEEP_TIMES)];
    return 0;
  case OPTION_PROCESSES:
    q->processes = true;
    return 0;
  case OPTION_JSON:
    q->json = true;
    return 0;
  case 'q':
    q->quiet = true;
    return 0;
  case OPTION_GRID:
    q->grid = choose_grid(q, text);
    return 0;
  case OPTION_FRAMES:
    w->frames = abbe_command_count(q->program, "--frames", text, 1, 1000);
    return 0;
  case OPTION_SIZE:
    abbe_command_size(q->program, "--size", text, ABBE_RENDER_MAX_SIDE, &w->traced.width,
                      &w->traced.height);
    return 0;
  case OPTION_BACKEND:
    q->backend = (abbe_context_backend)abbe_command_choice(q->program, "--backend", text, backends,
                                                           ABBE_CONTEXT_BACKEND_COUNT);
    return 0;
  case OPTION_MATERIALS:
    q->materials = text;
    return 0;
  case OPTION_PART:
    abbe_command_read_part(q->program, text, &q->part);
    return 0;
  case OPTION_LIST:
    q->list_only = true;
    return 0;
  case ARGP_KEY_ARG:
    if (q->argument_count == ABBE_SWEEP_MAX_ARGUMENTS)
      argp_error(state, "at most %d tables at a time", ABBE_SWEEP_MAX_ARGUMENTS);
    q->argument[q->argument_count++] = text;
    return 0;
  case ARGP_KEY_END:
    finish(q, state);
    return 0;
  default:
    return parse_reference(key, text, q);
  }
}

const struct argp abbe_sweep_options_argp = {
    options,
    parse,
    "SCENE.yaml -o FILE.csv\nFILE.csv... [-o ALL.csv]",
    "Draws a scene with many settings and says what each costs, in time, and how far it is from "
    "a traced reference: which settings are worth their time, and what published methods "
    "give for it.\v"
    "The same command goes on where it was stopped. Given tables, it shows them.\n\n"
    "Examples:\n"
    "  abbe sweep scenes/gem.yaml -o gem.csv --plot gem.png\n"
    "  abbe sweep scenes/gem.yaml -o gem.csv --grid full --frames 9 --spp 256\n"
    "  abbe sweep scenes/prism.yaml -o slit.csv --wavelengths 3,7,21 --photons 64,256\n"
    "  abbe sweep scenes/gem.yaml -o gem.csv --reference gem.exr --reference-map map.exr\n"
    "  abbe sweep gem.csv sphere.csv --report trade.md\n"
    "  abbe sweep scenes/gem.yaml -o part-3.csv --reference gem.exr --reference-map map.exr --part "
    "3/8\n"
    "  abbe sweep part-*.csv -o gem.csv\n"
    "  abbe sweep scenes/gem.yaml -o gem.csv --decompose --report gem.md\n"
    "  abbe sweep scenes/gem.yaml -o scaling.csv --scaling --plot scaling.png\n"
    "  abbe sweep scenes/sphere.yaml -o kinds.csv --profiles wyman2006 --fill quads --polygons "
    "plain,even,culled\n"
    "  abbe sweep scenes/sphere.yaml --estimators\n"
    "  abbe sweep prism.yaml -o prism.csv --grid volume --reference prism.exr\n"
    "  abbe sweep *.csv --write-presets presets.yaml\n",
    NULL,
    NULL,
    NULL};
