#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"

#include <argp.h>
#include <stdio.h>

enum {
  KEY_CSV = 0x100,
  KEY_MAPS,
  KEY_PICTURE,
  KEY_IDEAL,
  KEY_HEAD,
  KEY_AXIS,
  KEY_TILT,
  KEY_STEP,
  KEY_RANGE,
  KEY_WAVELENGTHS,
  KEY_SIZE,
  KEY_REPEATS,
  KEY_THREADS
};

typedef struct request {
  abbe_gem_stone_input stone;
  const char *out, *maps, *picture, *ideal;
  double head_deg, tilt_deg, step_deg;
  size_t size, repeats, threads;
  bool csv;
} request;

static const struct argp_option options[] = {
    {"output", 'o', "FILE.pdf", ABBE_ARGUMENT_WRITES, "the report as pages", 0},
    {"csv", KEY_CSV, NULL, 0, "all numbers as CSV", 0},
    {"maps", KEY_MAPS, "FOLDER", ABBE_ARGUMENT_ONCE,
     "maps.exr and a PNG of each map, into a folder that is there", 0},
    {"picture", KEY_PICTURE, "FILE.png", ABBE_ARGUMENT_READS,
     "of the stone, by abbe render, for the first page of -o; without it, its light return", 0},
    {"ideal", KEY_IDEAL, "FILE", ABBE_ARGUMENT_READS,
     "design that stands beside it on that page; without it, angles of an ideal round "
     "brilliant, or those that return most light",
     0},
    {"axis", KEY_AXIS, "X,Y,Z", 0,
     "the optic axis of a crystal in its cut, z up; of one of three indices six numbers, its axes "
     "z "
     "and x. Without it, 0,0,1",
     0},
    {"head-shadow", KEY_HEAD, "DEGREES", 0,
     "half angle of the viewer's head, 0 to below 45; without it, 15", 0},
    {"tilt", KEY_TILT, "DEGREES", 0,
     "rock the stone so far to either side, up to 90; 0: not at all, and no fire. Without it, 30",
     0},
    {"step", KEY_STEP, "DEGREES", 0, "of the tilt; without it, 2", 0},
    {"range", KEY_RANGE, "FROM:TO", 0, "wavelengths, nm; without it, 380:780", 0},
    {"wavelengths", KEY_WAVELENGTHS, "N", 0, "how many; without it, 16", 0},
    {"size", KEY_SIZE, "PIXELS", 0,
     "a side of the maps, eight times that of each tilt; without it, 96", 0},
    {"repeats", KEY_REPEATS, "N", 0, "rays in a pixel, 3 to 64; without it, 4", 0},
    {"threads", KEY_THREADS, "N", 0, "without it, all; results do not depend on it", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TARGET(request, 'o', out, ".pdf"),
    ABBE_TAKE_FLAG(request, KEY_CSV, csv),
    ABBE_TAKE_TEXT(request, KEY_PICTURE, picture),
    ABBE_TAKE_TEXT(request, KEY_IDEAL, ideal),
    ABBE_TAKE_TEXT(request, KEY_MAPS, maps),
    ABBE_TAKE_TEXT(request, KEY_AXIS, stone.axis),
    ABBE_TAKE_NUMBER(request, KEY_HEAD, head_deg, 0, 44.999),
    ABBE_TAKE_NUMBER(request, KEY_TILT, tilt_deg, 0, 90),
    ABBE_TAKE_NUMBER(request, KEY_STEP, step_deg, 0.1, 90),
    ABBE_TAKE_CHILD(request, 0, stone.in),
    ABBE_TAKE_RANGE(request, KEY_RANGE, stone.from_nm, stone.to_nm),
    ABBE_TAKE_COUNT(request, KEY_WAVELENGTHS, stone.count, 1, 256),
    ABBE_TAKE_COUNT(request, KEY_SIZE, size, 8, ABBE_GEM_MOST_SIDE),
    ABBE_TAKE_COUNT(request, KEY_REPEATS, repeats, 3, ABBE_GEM_MOST_REPEATS),
    ABBE_TAKE_COUNT(request, KEY_THREADS, threads, 1, 1024),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  const request *q = state->input;
  if (abbe_take_option(takes, key, arg, state)) return 0;
  if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
  if ((q->picture != NULL || q->ideal != NULL) && q->out == NULL)
    argp_error(state, "--%s: on which page? Give -o FILE.pdf",
               q->picture != NULL ? "picture" : "ideal");
  if (q->stone.in.json && q->csv) argp_error(state, "--json and --csv: one of them");
  return 0;
}

static abbe_gem_judgement_desc describe(const request *q, abbe_progress *progress) {
  size_t steps = (size_t)(q->tilt_deg / q->step_deg + 0.5);
  if (steps < 1) steps = 1;
  return (abbe_gem_judgement_desc){
      .view = {.head_rad = q->head_deg * ABBE_PI / 180,
               .side = q->size,
               .repeats = q->repeats,
               .threads = q->threads},
      .tilts = q->tilt_deg > 0,
      .rocked = {.most_rad = q->tilt_deg * ABBE_PI / 180,
                 .steps = steps < ABBE_GEM_MOST_STEPS ? steps : ABBE_GEM_MOST_STEPS,
                 .progress = abbe_progress_update,
                 .user = progress}};
}

static abbe_result say(const request *q, const abbe_gem_report_facts *f, abbe_error *error) {
  if (q->out != NULL) ABBE_TRY(abbe_gem_report_sheet(q->out, f, error));
  if (q->maps != NULL) ABBE_TRY(abbe_gem_report_maps(q->maps, f->judgement, error));
  if (q->stone.in.json) return abbe_gem_report_print_json(f, error);
  if (q->csv)
    abbe_gem_report_print_csv(f);
  else
    abbe_gem_report_print(f);
  return ABBE_OK;
}

/* That a folder is missing is found out before the work. */
static abbe_result check_targets(const request *q, abbe_error *error) {
  char path[4096];
  const char *target[2] = {q->out, NULL};
  if (q->maps != NULL) {
    snprintf(path, sizeof path, "%s/maps.exr", q->maps);
    target[1] = path;
  }
  return abbe_command_check_targets(target, 2, error);
}

static abbe_result run(request *q, abbe_error *error) {
  abbe_gem_judgement judgement = {0};
  abbe_gem_report_page page = {0};
  abbe_result result = check_targets(q, error);
  if (result == ABBE_OK) result = abbe_gem_stone_input_load(&q->stone, error);
  if (result == ABBE_OK) {
    abbe_progress progress;
    abbe_progress_begin(&progress, "judging", q->stone.in.quiet);
    const abbe_gem_judgement_desc desc = describe(q, &progress);
    result = abbe_gem_judgement_make(&q->stone.stone, &q->stone.weights, &desc, &judgement, error);
    if (result == ABBE_OK && q->out != NULL)
      result = abbe_gem_report_page_make(&q->stone, &desc.view, q->picture, q->ideal, &page, error);
    const abbe_gem_report_facts facts = {.input = &q->stone,
                                         .page = q->out != NULL ? &page : NULL,
                                         .judgement = &judgement,
                                         .head_deg = q->head_deg,
                                         .seconds = abbe_progress_seconds(&progress)};
    abbe_progress_end(&progress);
    if (result == ABBE_OK) result = say(q, &facts, error);
  }
  abbe_gem_report_page_free(&page);
  abbe_gem_judgement_free(&judgement);
  abbe_gem_stone_input_free(&q->stone);
  return result;
}

int abbe_gem_report(int argc, char **argv) {
  static const struct argp_child children[] = {{&abbe_gem_input_argp, 0, NULL, 0}, {0}};
  static const struct argp argp = {
      options,
      parse,
      "FILE",
      "Judges a cut in a stone by what an eye above it sees: brightness, leakage, ASET, "
      "extinction, contrast, fire and scintillation, each with its standard error.\v"
      "Without --width the stone is 6.5 mm wide, which matters where it has colour. What each "
      "number means is in docs/gem-measures.md.\n\n"
      "Examples:\n"
      "  abbe gem report brilliant.asc --material diamond\n"
      "  abbe gem report brilliant.asc --material quartz -o report.pdf --maps maps\n"
      "  abbe gem report brilliant.asc --material ruby --width 6mm -o ruby.pdf --picture ruby.png\n"
      "  abbe gem report brilliant.asc --material diamond --head-shadow 10 --tilt 0 --json\n",
      children,
      NULL,
      NULL};
  request q = {.stone = {.in = {.program = argv[0]}, .count = 16},
               .head_deg = ABBE_GEM_HEAD_DEG,
               .tilt_deg = 30,
               .step_deg = 2,
               .size = 96,
               .repeats = 4};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_error error = {0};
  const abbe_result result = run(&q, &error);
  return abbe_command_end(argv[0], result, &error);
}
