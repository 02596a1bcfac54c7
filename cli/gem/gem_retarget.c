#include "base/maths.h"
#include "cli/gem/gem.h"
#include "cli/gem/gem_input.h"

#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "scenes/cuts/cut_stretch.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct side {
  bool is_there;
  double from_deg, to_deg, factor;
} side;

typedef struct request {
  abbe_gem_input in;
  const char *output;
  double index, from, crown_deg, pavilion_deg; /* 0: not given */
  side crown, pavilion;
} request;

static const abbe_option options[] = {
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES, "the design: .asc, .gem or .gcs, or a solid", 0,
     ABBE_TAKE_TEXT(request, output)},
    {"index", 0, "N", 0, "to be cut for, where no material is named", 0,
     ABBE_TAKE_NUMBER(request, index, 1.01, 5)},
    {"from-index", 0, "N", 0, "that the design was made for, where it does not say", 0,
     ABBE_TAKE_NUMBER(request, from, 1.01, 5)},
    {"pavilion", 0, "DEG", 0,
     "angle of the pavilion's main facets; without it, as far from the middle of the window of "
     "total reflection as it was",
     0, ABBE_TAKE_NUMBER(request, pavilion_deg, 1, 85)},
    {"crown", 0, "DEG", 0,
     "angle of the crown's main facets; without it, by the pavilion's tangent ratio", 0,
     ABBE_TAKE_NUMBER(request, crown_deg, 1, 85)},
    ABBE_OPTIONS(request, &abbe_gem_input_argp, in, NULL, 0),
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  (void)text;
  const request *q = state->input;
  if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
  if (q->in.material_name == NULL && q->index == 0 && q->crown_deg == 0 && q->pavilion_deg == 0)
    argp_error(state, "for which stone? Give --material NAME, --index N, or angles by --pavilion "
                      "and --crown");
  if (q->in.material_name != NULL && q->index > 0)
    argp_error(state, "--material and --index: one of them");
  return 0;
}

static double main_angle(const abbe_gem_input *in, abbe_cut_side which, bool *is_there) {
  const double deg = abbe_cut_stretch_main_deg(&in->cut, &in->stone, which);
  *is_there = deg > 0;
  return deg;
}

static abbe_result choose_angles(request *q, abbe_error *error) {
  const double from = q->from > 0 ? q->from : q->in.cut.refractive_index;
  q->pavilion.from_deg = main_angle(&q->in, ABBE_CUT_PAVILION, &q->pavilion.is_there);
  q->crown.from_deg = main_angle(&q->in, ABBE_CUT_CROWN, &q->crown.is_there);
  q->pavilion.factor = q->crown.factor = 1;
  if (!q->pavilion.is_there && q->pavilion_deg > 0)
    return abbe_error_set(error, ABBE_NOT_FOUND, "the pavilion has no slanted facet");
  if (!q->crown.is_there && q->crown_deg > 0)
    return abbe_error_set(error, ABBE_NOT_FOUND, "the crown has no slanted facet");
  q->pavilion.to_deg = q->pavilion_deg > 0 ? q->pavilion_deg : q->pavilion.from_deg;
  if (q->pavilion_deg == 0 && q->index > 0 && q->pavilion.is_there) {
    if (!(from > 1))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s does not say for which index it was made: give --from-index, or "
                            "the new angle by --pavilion",
                            q->in.path);
    q->pavilion.to_deg = abbe_cut_stretch_angle(q->pavilion.from_deg, from, q->index);
  }
  if (q->pavilion.is_there)
    q->pavilion.factor = abbe_cut_stretch_factor(q->pavilion.from_deg, q->pavilion.to_deg);
  q->crown.factor = q->pavilion.factor;
  if (q->crown_deg > 0) q->crown.factor = abbe_cut_stretch_factor(q->crown.from_deg, q->crown_deg);
  if (q->crown_deg == 0 && q->index == 0)
    q->crown.factor = 1; /* the pavilion alone was requested */
  const double turn = 180 / ABBE_PI;
  q->crown.to_deg = atan(q->crown.factor * tan(q->crown.from_deg / turn)) * turn;
  return ABBE_OK;
}

/* In the first empty footnote, where there is one. */
static void leave_note(request *q) {
  char text[200];
  abbe_number_format(text, sizeof text,
                     "Retargeted: index %.3f, tangent ratios %.4f crown, %.4f pavilion", q->index,
                     q->crown.factor, q->pavilion.factor);
  for (int i = 0; i < ABBE_CUT_LINES; i++) {
    if (q->in.cut.footnote[i] != NULL) continue;
    q->in.cut.footnote[i] = strdup(text);
    return;
  }
}

static void print_side(const char *name, const side *s) {
  if (!s->is_there) return;
  printf("  %-10s %.2f -> %.2f degrees, tangents times %.4f\n", name, s->from_deg, s->to_deg,
         s->factor);
}

/* By the same width. */
static double weight_kept(const abbe_cut_measures *before, const abbe_cut_measures *after) {
  return after->volume / before->volume * pow(before->width / after->width, 3);
}
static double height_kept(const abbe_cut_measures *before, const abbe_cut_measures *after) {
  return after->height / before->height * before->width / after->width;
}

static void print_text(const request *q, const abbe_cut_measures *before,
                       const abbe_cut_polyhedron *stone) {
  double low, high;
  const abbe_cut_measures *m = &q->in.measures;
  printf("%s, main angles\n", abbe_gem_input_title(&q->in));
  print_side("crown", &q->crown);
  print_side("pavilion", &q->pavilion);
  if (q->index > 0) {
    abbe_cut_stretch_window(q->index, &low, &high);
    printf("  index %.4f reflects what comes straight down twice from %.2f to %.2f degrees\n",
           q->index, low, high);
  }
  printf("  corners %zu, edges %zu, faces %zu: as many as before\n", stone->vertex_count,
         stone->edge_count, stone->face_count);
  printf("  C/W %.3f -> %.3f   P/W %.3f -> %.3f   Vol/W^3 %.3f -> %.3f\n",
         before->side[ABBE_CUT_CROWN] / before->width, m->side[ABBE_CUT_CROWN] / m->width,
         before->side[ABBE_CUT_PAVILION] / before->width, m->side[ABBE_CUT_PAVILION] / m->width,
         before->volume / pow(before->width, 3), m->volume / pow(m->width, 3));
  const double kept = weight_kept(before, m);
  printf("  at the same width %.1f %% %s weight, and %.1f %% %s height\n", 100 * fabs(kept - 1),
         kept < 1 ? "less" : "more", 100 * fabs(height_kept(before, m) - 1),
         height_kept(before, m) < 1 ? "less" : "more");
}

static void add_side(cJSON *root, const char *name, const side *s) {
  if (!s->is_there) return;
  cJSON *item = cJSON_AddObjectToObject(root, name);
  cJSON_AddNumberToObject(item, "from_deg", s->from_deg);
  cJSON_AddNumberToObject(item, "to_deg", s->to_deg);
  cJSON_AddNumberToObject(item, "tangent_ratio", s->factor);
}

static abbe_result print_json(const request *q, const abbe_cut_measures *before,
                              abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  abbe_gem_input_describe(&q->in, root);
  cJSON_AddNumberToObject(root, "index", q->index);
  add_side(root, "crown", &q->crown);
  add_side(root, "pavilion", &q->pavilion);
  cJSON_AddNumberToObject(root, "weight_kept", weight_kept(before, &q->in.measures));
  cJSON_AddNumberToObject(root, "height_kept", height_kept(before, &q->in.measures));
  if (q->output != NULL) cJSON_AddStringToObject(root, "output", q->output);
  return abbe_command_print_json(root, true, error);
}

/* The cut becomes the new one; its stone too. A meet that was lost is a failure. */
static abbe_result retarget(request *q, abbe_error *error) {
  abbe_cut_polyhedron stone;
  abbe_gem_input *in = &q->in;
  abbe_result result = choose_angles(q, error);
  if (result == ABBE_OK)
    result =
        abbe_cut_stretch_apply(&in->cut, &in->stone, q->crown.factor, q->pavilion.factor, error);
  if (result == ABBE_OK) result = abbe_cut_polyhedron_make(&in->cut, in->weld, &stone, error);
  if (result != ABBE_OK) return result;
  if (stone.vertex_count != in->stone.vertex_count || stone.face_count != in->stone.face_count)
    result = abbe_error_set(error, ABBE_GEOMETRY,
                            "at these angles %zu corners and %zu faces become %zu and %zu; try "
                            "--weld 1e-4",
                            in->stone.vertex_count, in->stone.face_count, stone.vertex_count,
                            stone.face_count);
  abbe_cut_polyhedron_free(&in->stone);
  in->stone = stone;
  if (q->index > 0) in->cut.refractive_index = q->index;
  return result;
}

int abbe_gem_retarget(int argc, char **argv) {
  static const abbe_parser argp = {
      options, parse, "FILE",
      "Changes a design's angles for another stone, and keeps its meets.\v"
      "All tangents of a side are multiplied by one ratio, so that what met still meets and the "
      "outline stays.\n\n"
      "Examples:\n"
      "  abbe gem retarget scenes/designs/brilliant-quartz.asc --material sapphire -o "
      "sapphire.asc\n"
      "  abbe gem retarget scenes/designs/brilliant-quartz.asc --index 1.62 --crown 38\n"
      "  abbe gem retarget stone.gem --pavilion 41 --crown 36 -o stone-41.gem"};
  request q = {.in.program = argv[0]};
  abbe_error error = {0};
  abbe_cut_measures before = {0};
  abbe_arguments_parse(&argp, ABBE_ARGUMENT_READS, argc, argv, &q);
  abbe_result result = abbe_command_check_targets(&q.output, 1, &error);
  if (result == ABBE_OK) result = abbe_gem_input_load(&q.in, &error);
  before = q.in.measures;
  if (q.in.material != NULL) q.index = q.in.n;
  if (result == ABBE_OK) result = retarget(&q, &error);
  if (result == ABBE_OK) {
    abbe_cut_measures_make(&q.in.cut, &q.in.stone, &q.in.measures);
    leave_note(&q);
    if (q.output != NULL)
      result = abbe_gem_output_write(q.output, &q.in.cut, &q.in.stone, abbe_gem_input_scale(&q.in),
                                     q.in.material, NULL, &error);
  }
  if (result == ABBE_OK && q.in.json) result = print_json(&q, &before, &error);
  if (result == ABBE_OK && !q.in.json) print_text(&q, &before, &q.in.stone);
  abbe_gem_input_free(&q.in);
  return abbe_command_end(argv[0], result, &error);
}
