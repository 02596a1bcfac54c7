#include "validation/lab/known/known_answers.h"

#include "base/number.h"
#include "base/text.h"
#include "scenes/import/scene_file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name, *what;
  abbe_result (*make)(abbe_known_run *run, abbe_error *error);
} groups[] = {
#define ABBE_KNOWN_ROW(name, what) {#name, what, abbe_known_##name},
    ABBE_KNOWN_GROUPS(ABBE_KNOWN_ROW)
#undef ABBE_KNOWN_ROW
};

/* The work of a group, roughly, in the last one's: only the bar of progress goes by it. */
static double cost_of(const char *name) {
  static const struct {
    const char *name;
    double cost;
  } costs[] = {{"pane", 1},        {"polarised", 1}, {"absorption", 1}, {"furnace", 1},
               {"environment", 1}, {"mirror", 2},    {"medium", 1},     {"lamp", 1},
               {"sphere", 4},      {"white", 2},     {"picture", 1},    {"convergence", 1}};
  for (size_t i = 0; i < sizeof costs / sizeof *costs; i++)
    if (strcmp(name, costs[i].name) == 0) return costs[i].cost;
  return 0.01;
}

enum { GROUPS = sizeof groups / sizeof *groups };

const char *abbe_known_answers_group(size_t index) {
  return index < GROUPS ? groups[index].name : NULL;
}

const char *abbe_known_answers_describe(size_t index) {
  return index < GROUPS ? groups[index].what : NULL;
}

static abbe_result check_group(const char *only, abbe_error *error) {
  const char *names[GROUPS];
  for (size_t i = 0; i < GROUPS; i++) {
    names[i] = groups[i].name;
    if (only == NULL || strcmp(only, names[i]) == 0) return ABBE_OK;
  }
  const char *near = abbe_nearest_word(only, names, GROUPS);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "there is no group '%.60s' of known answers%s%s%s; the first is '%s'", only,
                        near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                        near != NULL ? "'?" : "", names[0]);
}

abbe_result abbe_known_answers_make(const abbe_known_options *options, abbe_known_answers *out,
                                    abbe_error *error) {
  const abbe_known_options defaults = {0};
  if (options == NULL) options = &defaults;
  *out = (abbe_known_answers){0};
  abbe_result result = check_group(options->only, error);
  double whole = 0, before = 0;
  for (size_t i = 0; i < GROUPS; i++) whole += cost_of(groups[i].name);
  for (size_t i = 0; i < GROUPS && result == ABBE_OK; i++) {
    bool all = options->only == NULL;
    if (!all && strcmp(options->only, groups[i].name) != 0) continue;
    abbe_known_run run = {.options = options, .out = out, .group = groups[i].name, .to = 1};
    if (all) run.from = before / whole;
    before += cost_of(groups[i].name);
    if (all) run.to = before / whole;
    result = abbe_known_progress(&run, 0, error);
    if (result == ABBE_OK) result = groups[i].make(&run, error);
  }
  if (result != ABBE_OK) abbe_known_answers_free(out);
  return result;
}

void abbe_known_answers_free(abbe_known_answers *answers) {
  if (answers == NULL) return;
  free(answers->row);
  *answers = (abbe_known_answers){0};
}

size_t abbe_known_answers_failed(const abbe_known_answers *answers) {
  size_t failed = 0;
  for (size_t i = 0; i < answers->count; i++) failed += answers->row[i].passed ? 0 : 1;
  return failed;
}

abbe_result abbe_known_add(abbe_known_run *run, abbe_known_answer row, abbe_error *error) {
  abbe_known_answers *out = run->out;
  if (out->count == out->room) {
    size_t room = out->room > 0 ? 2 * out->room : 64;
    abbe_known_answer *bigger = realloc(out->row, room * sizeof *bigger);
    if (bigger == NULL)
      return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu known answers",
                            room);
    out->row = bigger;
    out->room = room;
  }
  row.group = run->group;
  row.error = row.traced - row.exact;
  row.passed = fabs(row.error) <= row.tolerance && /* false for NaN */
               (row.useful <= 0 || row.tolerance <= row.useful);
  out->row[out->count++] = row;
  return ABBE_OK;
}

abbe_result abbe_known_progress(const abbe_known_run *run, double done, abbe_error *error) {
  const abbe_known_options *o = run->options;
  double whole = run->from + (run->to - run->from) * fmin(fmax(done, 0), 1);
  if (o->progress == NULL || o->progress(o->user, whole)) return ABBE_OK;
  return abbe_error_set(error, ABBE_CANCELLED, "the known answers were stopped before their end");
}

enum { TEXT_SIZE = 4096 };

static const char stage_head[] =
    "camera: {eye: [0, -1e4, -1e4], target: [0, 0, -1e5]}\n"
    "lights: [{name: lamp, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
    "objects:\n";
static const char stage_floor[] =
    "- {name: far below, shape: rectangle, width: 1e5, height: 1e5, reflectance: 0.5,\n"
    "   transform: [{translate: [0, 0, -1e5]}]}\n";

static abbe_result parse(const char *head, const char *middle, va_list arguments, const char *tail,
                         abbe_scene *out, abbe_error *error) {
  char filled[TEXT_SIZE], text[TEXT_SIZE + sizeof stage_head + sizeof stage_floor];
  *out = (abbe_scene){0};
  int length = abbe_number_format_list(filled, sizeof filled, middle, arguments);
  if (length < 0 || length >= TEXT_SIZE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a known answer's scene is too long");
  snprintf(text, sizeof text, "%s%s%s", head, filled, tail);
  return abbe_scene_parse(text, strlen(text), "known answer", NULL, out, error);
}

abbe_result abbe_known_scene(abbe_scene *out, abbe_error *error, const char *text, ...) {
  va_list arguments;
  va_start(arguments, text);
  abbe_result result = parse("", text, arguments, "", out, error);
  va_end(arguments);
  return result;
}

abbe_result abbe_known_stage_make(abbe_known_stage *stage, abbe_error *error, const char *objects,
                                  ...) {
  *stage = (abbe_known_stage){0};
  va_list arguments;
  va_start(arguments, objects);
  abbe_result result = parse(stage_head, objects, arguments, stage_floor, &stage->scene, error);
  va_end(arguments);
  if (result == ABBE_OK) result = abbe_geometry_make(&stage->scene, &stage->geometry, error);
  if (result != ABBE_OK) abbe_known_stage_free(stage);
  return result;
}

void abbe_known_stage_free(abbe_known_stage *stage) {
  if (stage == NULL) return;
  abbe_geometry_free(&stage->geometry);
  abbe_scene_free(&stage->scene);
}

abbe_result abbe_known_stage_n(const abbe_known_stage *stage, double lambda_nm, double *n,
                               abbe_error *error) {
  return abbe_material_n(stage->scene.object[0].material, lambda_nm, n, error);
}

abbe_result abbe_known_follow(abbe_known_stage *stage, const double from[3],
                              const double direction[3], double lambda_nm, const char *choices,
                              abbe_error *error) {
  double d[3] = {direction[0], direction[1], direction[2]};
  stage->count = 0;
  if (!abbe_vector_normalise(d))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a ray without a direction");
  return abbe_route_follow(&stage->geometry, from, d, lambda_nm, choices, stage->vertex,
                           ABBE_KNOWN_ROOM, &stage->count, error);
}

double abbe_known_angle(const double a[3], const double b[3]) {
  double across[3];
  abbe_vector_cross(a, b, across);
  return atan2(abbe_vector_length(across), abbe_vector_dot(a, b));
}

/* Golden section: its ratio keeps one of the two inner points at each step. */
double abbe_known_least(abbe_known_function f, void *user, double low, double high) {
  const double ratio = (sqrt(5) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = f(a, user), at_b = f(b, user);
  for (int step = 0; step < 60; step++) {
    if (isnan(at_a) || isnan(at_b)) return NAN;
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - ratio * (high - low);
      at_a = f(a, user);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + ratio * (high - low);
      at_b = f(b, user);
    }
  }
  return fmin(at_a, at_b);
}
