#include "base/maths.h"
#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "cli/gem/gem.h"
#include "cli/gem/gem_input.h"

#include "scenes/cuts/cut_stretch.h"
#include "validation/measure/gem/gem_maps.h"
#include "validation/measure/gem/gem_optimum.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { KEY_MEASURE = 0x100, KEY_CROWN, KEY_PAVILION, KEY_TILT, KEY_AXIS, KEY_SEARCH, KEY_PART };

/* Those of which more, or less, is wanted whatever the stone. */
static const struct {
  const char *name, *text;
  abbe_gem_amount amount;
  bool least;
} measures[] = {{"iso", "brightness", ABBE_GEM_ISO, false},
                {"cos", "cosine brightness", ABBE_GEM_COS, false},
                {"gemray-iso", "GemRay's ISO", ABBE_GEM_GEMRAY_ISO, false},
                {"gemray-cos", "GemRay's COS", ABBE_GEM_GEMRAY_COS, false},
                {"gemray-sc2", "GemRay's SC2", ABBE_GEM_GEMRAY_SC2, false},
                {"return", "light return", ABBE_GEM_RETURN, false},
                {"leakage", "leakage", ABBE_GEM_DOWN, true}};
enum { MEASURES = sizeof measures / sizeof measures[0] };

typedef struct request {
  abbe_gem_stone_input stone;
  const char *out, *plot, *pairs;
  abbe_command_part part;
  bool merge;
  const char **table; /* to merge */
  size_t tables;
  double crown[2], pavilion[2], head_deg, tilt_deg, azimuth_deg;
  size_t crowns, pavilions, tilts, azimuths, size, threads; /* tilts 0: no search for axes */
  int measure, search;
} request;

static const abbe_option options[] = {
    {"measure", KEY_MEASURE, "NAME", 0,
     "iso, cos, gemray-iso, gemray-cos, gemray-sc2, return (with the head's shadow) or leakage "
     "(the least of it); without it, iso",
     0, ABBE_TAKE_BY_KEY},
    {"crown", KEY_CROWN, "FROM:TO", 0,
     "degrees of its main facets; without it, 8 to either side of the design's", 0,
     ABBE_TAKE_BY_KEY},
    {"pavilion", KEY_PAVILION, "FROM:TO", 0, "likewise; without it, 4 to either side", 0,
     ABBE_TAKE_BY_KEY},
    {"grid", 0, "CROWNSxPAVILIONS", 0, "angles tried; without it, 21x21", 0,
     ABBE_TAKE_SIZE(request, crowns, pavilions, ABBE_GEM_MOST_ANGLES)},
    {"search", KEY_SEARCH, "NAME", 0,
     "grid; angles (in the same ranges, by derivatives); tiers (every tier by itself, all meets "
     "kept); or front (tiers, for the measure and for fire in four mixtures; FILE.asc becomes "
     "FILE-1.asc and so on); without it, grid",
     0, ABBE_TAKE_BY_KEY},
    {"output", 'o', "FILE.asc", ABBE_ARGUMENT_WRITES, "the best design", 0,
     ABBE_TAKE_TARGET(request, out, ".asc")},
    {"plot", 0, "FILE", ABBE_ARGUMENT_WRITES, "the measure over both angles; .png or .svg", 0,
     ABBE_TAKE_TEXT(request, plot)},
    {"head-shadow", 0, "DEGREES", 0,
     "half angle of the viewer's head, 0 to below 45; without it, 15", 0,
     ABBE_TAKE_NUMBER(request, head_deg, 0, 44.999)},
    {"tilt", KEY_TILT, "DEGREES[,AZIMUTH]", 0,
     "judge the stone so tilted about the horizontal axis of that azimuth; without it, level", 0,
     ABBE_TAKE_BY_KEY},
    {"axis", KEY_AXIS, "X,Y,Z or TILTSxAZIMUTHS", 0,
     "how a crystal lies in its cut, as abbe gem report has it; or so many ways are tried, and the "
     "angles kept",
     0, ABBE_TAKE_BY_KEY},
    {"range", 0, "FROM:TO", 0, "wavelengths, nm; without it, 380:780", 0,
     ABBE_TAKE_RANGE(request, stone.from_nm, stone.to_nm)},
    {"size", 0, "PIXELS", 0, "a side of the view, of 4 rays a pixel; without it, 32", 0,
     ABBE_TAKE_COUNT(request, size, 8, ABBE_GEM_MOST_SIDE)},
    {"threads", 0, "N", 0, "without it, all; results do not depend on it", 0,
     ABBE_TAKE_COUNT(request, threads, 1, 1024)},
    {"part", KEY_PART, "K/N", 0,
     "judge every N-th pair alone, from the K-th on, 0/8 to 7/8; with --pairs", 0,
     ABBE_TAKE_BY_KEY},
    {"pairs", 0, "FILE.csv", ABBE_ARGUMENT_WRITES, "the pairs that were judged", 0,
     ABBE_TAKE_TARGET(request, pairs, ".csv")},
    {"merge", 0, NULL, 0, "judge nothing: take the tables that follow the design", 0,
     ABBE_TAKE_FLAG(request, merge)},
    ABBE_OPTIONS(request, &abbe_gem_input_argp, stone.in, NULL, 0),
    ABBE_NEEDED(request, stone.in.material_name,
                "of which stone? Give --material NAME; 'abbe materials list' has them"),
    {0}};

static void read_angles(const request *q, const char *option, const char *text, double angle[2]) {
  abbe_command_range(q->stone.in.program, option, text, &angle[0], &angle[1]);
  if (angle[1] < 90) return;
  fprintf(stderr, "%s: %s '%s': angles are below 90 degrees\n", q->stone.in.program, option, text);
  exit(ABBE_EXIT_USAGE);
}

static void read_measure(request *q, const char *text) {
  const char *names[MEASURES];
  for (int i = 0; i < MEASURES; i++) names[i] = measures[i].name;
  q->measure = abbe_command_choice(q->stone.in.program, "--measure", text, names, MEASURES);
}

static void read_tilt(request *q, const char *text) {
  const char *end;
  const bool read =
      abbe_number_read(text, &end, &q->tilt_deg) && fabs(q->tilt_deg) <= 90 &&
      (*end == '\0' || (*end == ',' && abbe_number_read(end + 1, &end, &q->azimuth_deg) &&
                        fabs(q->azimuth_deg) <= 360 && *end == '\0'));
  if (read) return;
  fprintf(stderr, "%s: --tilt '%s': it is DEGREES or DEGREES,AZIMUTH, up to 90 and 360\n",
          q->stone.in.program, text);
  exit(ABBE_EXIT_USAGE);
}

enum { SEARCH_GRID, SEARCH_ANGLES, SEARCH_TIERS, SEARCH_FRONT, SEARCHES };
static const char *const searches[SEARCHES] = {"grid", "angles", "tiers", "front"};

/* That the parts' options go together, and which pieces of work there are. */
static void check_parts(const request *q, struct argp_state *state) {
  if (q->tilts > 0 &&
      (q->merge || q->part.parts > 0 || q->pairs != NULL || q->out != NULL || q->plot != NULL))
    argp_error(state, "--axis with so many ways keeps the angles: --part, --merge, --pairs, "
                      "--plot and -o are for angles");
  if (q->search != SEARCH_GRID && (q->tilts > 0 || q->merge || q->part.parts > 0 ||
                                   q->pairs != NULL || (q->plot && q->search != SEARCH_FRONT)))
    argp_error(state,
               "--search %s has no grid: --axis with so many ways, --part, --merge, --pairs "
               "and --plot are for one",
               searches[q->search]);
  if (q->tables > 0 && !q->merge) argp_error(state, "one design; '%s' is too much", q->table[0]);
  if (q->merge && q->tables == 0)
    argp_error(state, "--merge: of which tables? They follow the design");
  if (q->part.parts == 0) return;
  if (q->merge) argp_error(state, "--part judges pairs, and --merge judges nothing");
  if (q->pairs == NULL) argp_error(state, "--part: into which table? Give --pairs FILE.csv");
  if (q->out != NULL || q->plot != NULL)
    argp_error(state, "a part knows no best of all; -o and --plot go with --merge");
  if (q->part.part >= q->crowns * q->pavilions)
    argp_error(state, "--part %zu/%zu has none of %zu pairs", q->part.part, q->part.parts,
               q->crowns * q->pavilions);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *q = state->input;
  switch (key) {
  case KEY_MEASURE:
    read_measure(q, arg);
    return 0;
  case KEY_SEARCH:
    q->search = abbe_command_choice(q->stone.in.program, "--search", arg, searches, SEARCHES);
    return 0;
  case KEY_CROWN:
    read_angles(q, "--crown", arg, q->crown);
    return 0;
  case KEY_PAVILION:
    read_angles(q, "--pavilion", arg, q->pavilion);
    return 0;
  case ARGP_KEY_END:
    check_parts(q, state);
    return 0;
  case ARGP_KEY_ARG:
    if (q->stone.in.path == NULL) return ARGP_ERR_UNKNOWN; /* the design, which is the child's */
    q->table[q->tables++] = arg;
    return 0;
  case KEY_TILT:
    read_tilt(q, arg);
    return 0;
  case KEY_AXIS:
    if (strchr(arg, 'x') == NULL)
      q->stone.axis = arg;
    else
      abbe_command_size(state->name, "--axis", arg, ABBE_GEM_MOST_ANGLES, &q->tilts, &q->azimuths);
    return 0;
  case KEY_PART:
    abbe_command_read_part(state->name, arg, &q->part);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

/* ---- what came of it ---- */

static double degrees(double rad) {
  return rad * 180 / ABBE_PI;
}

static void print(const request *q, const abbe_gem_stone_input *in, const abbe_gem_optimum *o) {
  const abbe_gem_number best = o->value[o->best];
  printf("%s in %s: %s, %zu x %zu angles\n\n", q->stone.in.path, in->in.material->name,
         measures[q->measure].text, o->crowns, o->pavilions);
  printf("%-8s %8s %9s %9s %8s\n", "", "crown", "pavilion", "value", "error");
  printf("%-8s %8.3f %9.3f %7.2f %% %8.2f\n", "design", degrees(o->design_crown_rad),
         degrees(o->design_pavilion_rad), 100 * o->design.value, 100 * o->design.error);
  printf("%-8s %8.3f %9.3f %7.2f %% %8.2f\n", "best", degrees(o->crown_rad[o->best % o->crowns]),
         degrees(o->pavilion_rad[o->best / o->crowns]), 100 * best.value, 100 * best.error);
  const size_t c = o->best % o->crowns, p = o->best / o->crowns;
  double critical, high;
  abbe_cut_stretch_window(in->in.n, &critical, &high);
  for (int i = 0; i < 2; i++)
    if (degrees(i == 0 ? o->design_pavilion_rad : o->pavilion_rad[p]) < critical)
      printf("%s's pavilion is below the critical angle, %.2f degrees: light leaks\n",
             i == 0 ? "The design" : "The best", critical);
  if ((o->crowns > 1 && (c == 0 || c + 1 == o->crowns)) ||
      (o->pavilions > 1 && (p == 0 || p + 1 == o->pavilions)))
    printf("\nThe best lies on the grid's edge: a wider range may hold a better one.\n");
}

static void add_pair(cJSON *to, const char *name, double crown, double pavilion,
                     abbe_gem_number n) {
  cJSON *one = cJSON_CreateObject();
  cJSON_AddNumberToObject(one, "crown_deg", degrees(crown));
  cJSON_AddNumberToObject(one, "pavilion_deg", degrees(pavilion));
  cJSON_AddNumberToObject(one, "value", n.value);
  cJSON_AddNumberToObject(one, "error", n.error);
  if (name != NULL)
    cJSON_AddItemToObject(to, name, one);
  else
    cJSON_AddItemToArray(to, one);
}

static abbe_result print_json(const request *q, const abbe_gem_stone_input *in,
                              const abbe_gem_optimum *o, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "file", q->stone.in.path);
  cJSON_AddStringToObject(root, "material", in->in.material->name);
  cJSON_AddStringToObject(root, "measure", measures[q->measure].name);
  add_pair(root, "design", o->design_crown_rad, o->design_pavilion_rad, o->design);
  add_pair(root, "best", o->crown_rad[o->best % o->crowns], o->pavilion_rad[o->best / o->crowns],
           o->value[o->best]);
  cJSON *list = cJSON_AddArrayToObject(root, "grid");
  for (size_t i = 0; i < o->crowns * o->pavilions; i++)
    add_pair(list, NULL, o->crown_rad[i % o->crowns], o->pavilion_rad[i / o->crowns], o->value[i]);
  return abbe_command_print_json(root, true, error);
}

/* The cut becomes the best one. */
static abbe_result write_best(request *q, const abbe_gem_optimum *o, abbe_error *error) {
  abbe_gem_input *in = &q->stone.in;
  ABBE_TRY(abbe_gem_optimum_apply(o, &in->cut, &in->stone, o->best, error));
  return abbe_gem_output_write(q->out, &in->cut, &in->stone, 1, NULL, &in->report, error);
}

/* ---- the search ---- */

static abbe_gem_optimum_desc describe(const request *q, abbe_progress *progress) {
  return (abbe_gem_optimum_desc){.crown_from_rad = q->crown[0] * ABBE_PI / 180,
                                 .crown_to_rad = q->crown[1] * ABBE_PI / 180,
                                 .pavilion_from_rad = q->pavilion[0] * ABBE_PI / 180,
                                 .pavilion_to_rad = q->pavilion[1] * ABBE_PI / 180,
                                 .crowns = q->crowns,
                                 .pavilions = q->pavilions,
                                 .measure = measures[q->measure].amount,
                                 .least = measures[q->measure].least,
                                 .width_m = q->stone.width_m,
                                 .axes = q->stone.axes,
                                 .view = {.axis_rad = q->azimuth_deg * ABBE_PI / 180,
                                          .tilt_rad = q->tilt_deg * ABBE_PI / 180,
                                          .head_rad = q->head_deg * ABBE_PI / 180,
                                          .side = q->size,
                                          .repeats = 4,
                                          .threads = q->threads},
                                 .part = q->part.part,
                                 .parts = q->part.parts,
                                 .progress = abbe_progress_update,
                                 .user = progress};
}

/* About the design's own, where the user names none. */
static abbe_result find_angles(request *q, abbe_error *error) {
  const abbe_gem_input *in = &q->stone.in;
  double *range[2] = {q->crown, q->pavilion};
  for (int i = 0; i < 2; i++) {
    const abbe_cut_side side = i == 0 ? ABBE_CUT_CROWN : ABBE_CUT_PAVILION;
    const double angle = abbe_cut_stretch_main_deg(&in->cut, &in->stone, side);
    const double about = i == 0 ? 8 : 4;
    if (range[i][1] > 0) continue;
    if (!(angle > 0))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "%s: the design has no slanted facets on its %s, whose angle could "
                            "change",
                            in->path, i == 0 ? "crown" : "pavilion");
    range[i][0] = fmax(angle - about, 1);
    range[i][1] = fmin(angle + about, 89);
  }
  return ABBE_OK;
}

/* Before the search, not after it. */
static abbe_result check_plot(const char *path, abbe_error *error) {
  const char *dot = path != NULL ? strrchr(path, '.') : NULL;
  if (path == NULL ||
      (dot != NULL && (strcasecmp(dot, ".png") == 0 || strcasecmp(dot, ".svg") == 0)))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: a plot wants a name that ends with .png or .svg", path);
}

static abbe_result merge(const request *q, abbe_gem_optimum *o, abbe_error *error) {
  const abbe_gem_stone_input *s = &q->stone;
  const abbe_gem_optimum_desc desc = describe(q, NULL);
  size_t first = 0;
  abbe_result result = abbe_gem_optimum_begin(&s->in.cut, &s->in.stone, s->in.material,
                                              &s->wavelengths, &s->weights, &desc, o, error);
  for (size_t i = 0; i < q->tables && result == ABBE_OK; i++)
    result = abbe_gem_grid_file_read(q->table[i], o, error);
  const size_t missing = result == ABBE_OK ? abbe_gem_optimum_missing(o, &first) : 0;
  if (missing == 0) return result;
  return abbe_error_set(
      error, ABBE_INVALID_ARGUMENT,
      "%zu of %zu pairs are in none of the tables, the first of them pair %zu; is "
      "a part missing?",
      missing, o->crowns * o->pavilions, first);
}

static abbe_result search(const request *q, abbe_gem_optimum *o, abbe_error *error) {
  const abbe_gem_stone_input *s = &q->stone;
  abbe_progress progress;
  abbe_progress_begin(&progress, "searching", s->in.quiet);
  const abbe_gem_optimum_desc desc = describe(q, &progress);
  abbe_result result = abbe_gem_optimum_find(&s->in.cut, &s->in.stone, s->in.material,
                                             &s->wavelengths, &s->weights, &desc, o, error);
  abbe_progress_end(&progress);
  return result;
}

/* All pairs are known. */
static abbe_result write_all(request *q, const abbe_gem_optimum *o, abbe_error *error) {
  const abbe_gem_stone_input *s = &q->stone;
  if (q->pairs != NULL) ABBE_TRY(abbe_gem_grid_file_write(q->pairs, o, error));
  if (q->plot != NULL)
    ABBE_TRY(abbe_gem_optimise_plot(q->plot, &s->in, o, measures[q->measure].text, error));
  if (q->out != NULL) ABBE_TRY(write_best(q, o, error));
  if (!s->in.json && q->part.parts > 0)
    printf("%zu of %zu pairs are in %s\n",
           o->crowns * o->pavilions - abbe_gem_optimum_missing(o, NULL), o->crowns * o->pavilions,
           q->pairs);
  if (!s->in.json && q->part.parts == 0) print(q, s, o);
  if (s->in.json) ABBE_TRY(print_json(q, s, o, error));
  return ABBE_OK;
}

static abbe_result run(request *q, abbe_error *error) {
  abbe_gem_optimum optimum = {0};
  abbe_result result = check_plot(q->plot, error);
  if (result == ABBE_OK)
    result = abbe_command_check_targets((const char *[]){q->out, q->plot, q->pairs}, 3, error);
  if (q->search == SEARCH_FRONT) q->stone.count = 16; /* fire is a colour */
  if (result == ABBE_OK) result = abbe_gem_stone_input_load(&q->stone, error);
  if (result == ABBE_OK && q->tilts > 0) {
    const abbe_gem_optimum_desc desc = describe(q, NULL);
    result = abbe_gem_optimise_axis(&q->stone, measures[q->measure].text, &desc, q->tilts,
                                    q->azimuths, error);
    abbe_gem_stone_input_free(&q->stone);
    return result;
  }
  if (result == ABBE_OK) result = find_angles(q, error);
  if (result == ABBE_OK && q->search != SEARCH_GRID) {
    const abbe_gem_optimum_desc desc = describe(q, NULL);
    const char *text = measures[q->measure].text;
    result = q->search == SEARCH_FRONT
                 ? abbe_gem_optimise_front(&q->stone, text, &desc, q->out, q->plot, error)
                 : abbe_gem_optimise_ascend(&q->stone, text, &desc, q->search == SEARCH_TIERS,
                                            q->out, error);
    abbe_gem_stone_input_free(&q->stone);
    return result;
  }
  if (result == ABBE_OK) result = q->merge ? merge(q, &optimum, error) : search(q, &optimum, error);
  if (result == ABBE_OK) result = write_all(q, &optimum, error);
  abbe_gem_optimum_free(&optimum);
  abbe_gem_stone_input_free(&q->stone);
  return result;
}

int abbe_gem_optimise(int argc, char **argv) {
  static const abbe_parser argp = {
      options, parse, "FILE\nFILE --merge TABLE.csv...",
      "Tries pairs of crown and pavilion angles for a design in a stone, all its meets kept, and "
      "says which is best by a measure.\v"
      "Examples:\n"
      "  abbe gem optimise brilliant.asc --material quartz -o best.asc --plot best.png\n"
      "  abbe gem optimise brilliant.asc --material diamond --measure cos --crown 30:40 "
      "--pavilion 39:43 --grid 21x21\n"
      "  abbe gem optimise brilliant.asc --material quartz --search tiers -o best.asc\n"
      "  abbe gem optimise brilliant.asc --material tanzanite --axis 4x4\n"
      "  abbe gem optimise pear.asc --material ruby --grid 201x201 --part 3/8 --pairs part-3.csv\n"
      "  abbe gem optimise pear.asc --material ruby --grid 201x201 --merge part-*.csv -o "
      "best.asc\n"};
  request q = {.stone = {.in = {.program = argv[0]}, .count = 6},
               .head_deg = ABBE_GEM_HEAD_DEG,
               .crowns = 21,
               .pavilions = 21,
               .size = 32};
  q.table = calloc((size_t)argc, sizeof *q.table);
  abbe_error error = {0};
  abbe_result result = ABBE_OK;
  if (q.table == NULL) result = abbe_error_set(&error, ABBE_NO_MEMORY, "no memory for arguments");
  if (result == ABBE_OK) abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  if (result == ABBE_OK) result = run(&q, &error);
  free(q.table);
  return abbe_command_end(argv[0], result, &error);
}
