#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"

#include <stdio.h>

typedef struct request {
  abbe_gem_stone_input stone;
  const char *out, *maps, *picture, *ideal;
  double head_deg, tilt_deg, step_deg;
  size_t size, repeats, threads;
  bool csv;
} request;

static const abbe_option options[] = {
    {"output", 'o', "FILE.pdf", ABBE_ARGUMENT_WRITES, "the report as pages", 0,
     ABBE_TAKE_TARGET(request, out, ".pdf")},
    {"csv", 0, NULL, 0, "all numbers as CSV", 0, ABBE_TAKE_FLAG(request, csv)},
    {"maps", 0, "FOLDER", ABBE_ARGUMENT_ONCE,
     "maps.exr and a PNG of each map, into a folder that is there", 0,
     ABBE_TAKE_TEXT(request, maps)},
    {"picture", 0, "FILE.png", ABBE_ARGUMENT_READS,
     "of the stone, by abbe render, for the first page of -o, on its white where it is "
     "transparent; without it, its light return",
     0, ABBE_TAKE_TEXT(request, picture)},
    {"ideal", 0, "FILE", ABBE_ARGUMENT_READS,
     "design that stands beside it on that page; without it, angles of an ideal round "
     "brilliant, or those that return most light",
     0, ABBE_TAKE_TEXT(request, ideal)},
    {"axis", 0, "X,Y,Z", 0,
     "the optic axis of a crystal in its cut, z up; of one of three indices six numbers, its axes "
     "z "
     "and x. Without it, 0,0,1",
     0, ABBE_TAKE_TEXT(request, stone.axis)},
    {"head-shadow", 0, "DEGREES", 0,
     "half angle of the viewer's head, 0 to below 45; without it, 15", 0,
     ABBE_TAKE_NUMBER(request, head_deg, 0, 44.999)},
    {"tilt", 0, "DEGREES", 0,
     "rock the stone so far to either side, up to 90; 0: not at all, and no fire. Without it, 30",
     0, ABBE_TAKE_NUMBER(request, tilt_deg, 0, 90)},
    {"step", 0, "DEGREES", 0, "of the tilt; without it, 2", 0,
     ABBE_TAKE_NUMBER(request, step_deg, 0.1, 90)},
    {"range", 0, "FROM:TO", 0, "wavelengths, nm; without it, 380:780", 0,
     ABBE_TAKE_RANGE(request, stone.from_nm, stone.to_nm)},
    {"wavelengths", 0, "N", 0, "how many; without it, 16", 0,
     ABBE_TAKE_COUNT(request, stone.count, 1, 256)},
    {"size", 0, "PIXELS", 0, "a side of the maps, eight times that of each tilt; without it, 96", 0,
     ABBE_TAKE_COUNT(request, size, 8, ABBE_GEM_MOST_SIDE)},
    {"repeats", 0, "N", 0, "rays in a pixel, 3 to 64; without it, 4", 0,
     ABBE_TAKE_COUNT(request, repeats, 3, ABBE_GEM_MOST_REPEATS)},
    {"threads", 0, "N", 0, "without it, all; results do not depend on it", 0,
     ABBE_TAKE_COUNT(request, threads, 1, 1024)},
    ABBE_OPTIONS(request, &abbe_gem_input_argp, stone.in, NULL, 0),
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  (void)arg;
  const request *q = state->input;
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
  static const abbe_parser argp = {
      options, parse, "FILE",
      "Judges a cut in a stone by what an eye above it sees: brightness, leakage, ASET, "
      "extinction, contrast, fire and scintillation, each with its standard error.\v"
      "Without --width the stone is 6.5 mm wide, which matters where it has colour. What each "
      "number means is in docs/gem-measures.md.\n\n"
      "Examples:\n"
      "  abbe gem report brilliant.asc --material diamond\n"
      "  abbe gem report brilliant.asc --material quartz -o report.pdf --maps maps\n"
      "  abbe gem report brilliant.asc --material ruby --width 6mm -o ruby.pdf --picture ruby.png\n"
      "  abbe gem report brilliant.asc --material diamond --head-shadow 10 --tilt 0 --json\n"};
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
