#include "library/choice/picture_choice.h"

#include "base/clock.h"
#include "base/number.h"
#include "base/yaml/yaml.h"
#include "gl/accuracy/frame_times.h"
#include "gl/plan/plan.h"
#include "library/choice/trace_times.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PASSES = 65536, REPEATS = 3 };
static const double repeats_share = 0.1; /* share of a budget, for the yardstick's repeats */
static const double unseen = 0.02;       /* more accuracy than that is not seen */

#define ABBE_NAME_OF(code, name) name,
static const char *const class_names[] = {ABBE_PRESET_CLASSES(ABBE_NAME_OF) NULL};
static const char *const fill_names[] = {ABBE_FILLS(ABBE_NAME_OF) NULL};
static const char *const model_names[] = {ABBE_MODELS(ABBE_NAME_OF) NULL};
static const char *const preset_names[] = {ABBE_PRESETS(ABBE_NAME_OF) NULL};
static const char *const tool_names[] = {ABBE_PICTURE_TOOLS(ABBE_NAME_OF) NULL};

const char *abbe_picture_tool_name(abbe_picture_tool tool) {
  return (unsigned)tool < ABBE_PICTURE_TOOL_COUNT ? tool_names[tool] : "unknown";
}

/* ---- reading ---- */

typedef struct reader {
  abbe_yaml *yaml;
  abbe_error *error;
} reader;

static abbe_result get_above_0(const reader *r, abbe_yaml_node node, const char *key, double *out) {
  *out = -1;
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, key, 0, 1e9, out, r->error));
  if (!(*out > 0)) return abbe_yaml_fail(r->yaml, node, r->error, "'%s' is a number above 0", key);
  return ABBE_OK;
}

static abbe_result get_count(const reader *r, abbe_yaml_node node, const char *key, size_t most,
                             size_t *out) {
  *out = 0;
  ABBE_TRY(abbe_yaml_get_count(r->yaml, node, key, 1, most, out, r->error));
  if (*out == 0) return abbe_yaml_fail(r->yaml, node, r->error, "a point has no '%s'", key);
  return ABBE_OK;
}

static abbe_result read_render(const reader *r, abbe_yaml_node node, abbe_picture_point *d) {
  int fill = ABBE_FILL_BRIDGE, model = ABBE_MODEL_AUTO;
  const struct {
    const char *key;
    size_t most, *out;
  } counts[] = {{"wavelengths", ABBE_RENDER_MAX_WAVELENGTHS, &d->wavelengths},
                {"map", ABBE_RENDER_MAX_MAP, &d->map_size},
                {"samples", 4, &d->supersample},
                {"upsample", 4, &d->upsample},
                {"exits", ABBE_RENDER_MAX_EXITS, &d->exits}};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    ABBE_TRY(get_count(r, node, counts[i].key, counts[i].most, counts[i].out));
  ABBE_TRY(get_above_0(r, node, "share", &d->energy_share));
  if (d->energy_share > 1)
    ABBE_TRY(abbe_yaml_fail(r->yaml, node, r->error, "the share may be above 0, to 1"));
  ABBE_TRY(abbe_yaml_get_choice(r->yaml, node, "fill", fill_names, &fill, r->error));
  ABBE_TRY(abbe_yaml_get_choice(r->yaml, node, "model", model_names, &model, r->error));
  d->fill = (abbe_fill)fill;
  d->model = (abbe_model)model;
  return ABBE_OK;
}

static abbe_result read_point(const reader *r, abbe_yaml_node node, abbe_picture_tool tool,
                              abbe_picture_point *out) {
  *out = (abbe_picture_point){.tool = tool};
  ABBE_TRY(get_count(r, node, "photons", ABBE_RENDER_MAX_PHOTONS, &out->photons));
  if (out->tool == ABBE_PICTURE_RENDER) {
    ABBE_TRY(read_render(r, node, out));
  } else {
    ABBE_TRY(get_count(r, node, "passes", MOST_PASSES, &out->passes));
  }
  ABBE_TRY(get_above_0(r, node, "ms", &out->ms));
  ABBE_TRY(get_above_0(r, node, "error", &out->worst));
  ABBE_TRY(get_above_0(r, node, "least", &out->least));
  return abbe_yaml_check_keys(r->yaml, node, "point", r->error);
}

static abbe_result read_points(const reader *r, abbe_yaml_node list, abbe_picture_tool tool,
                               abbe_picture_front *out) {
  size_t count = abbe_yaml_count(r->yaml, list);
  const size_t most = ABBE_PICTURE_MAX_POINTS / ABBE_PICTURE_TOOL_COUNT;
  if (!abbe_yaml_is_sequence(r->yaml, list) || count < 1 || count > most)
    return abbe_yaml_fail(r->yaml, list, r->error, "a front is a list of 1 to %zu points", most);
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node node = abbe_yaml_item(r->yaml, list, i);
    abbe_picture_point *p = &out->point[out->count];
    ABBE_TRY(read_point(r, node, tool, p));
    if (i > 0 && !(p->ms >= p[-1].ms && p->worst <= p[-1].worst))
      return abbe_yaml_fail(r->yaml, node, r->error,
                            "the points of a front stand in the order of rising time and falling "
                            "error");
    p->error = p->worst * out->margin[tool];
    out->count++;
  }
  for (size_t i = 0; i < count; i++) out->point[out->count - 1 - i].ms *= out->time_margin[tool];
  return ABBE_OK;
}

static abbe_result read_tool(const reader *r, abbe_yaml_node pictures, abbe_picture_tool tool,
                             abbe_picture_front *out) {
  abbe_yaml_node node = abbe_yaml_get(r->yaml, pictures, tool_names[tool]), list;
  out->margin[tool] = out->time_margin[tool] = 1;
  if (node.id == 0) return ABBE_OK;
  ABBE_TRY(abbe_yaml_require(r->yaml, node, "front", &list, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "margin", 1, 1e6, &out->margin[tool], r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "time_margin", 1, 1e6, &out->time_margin[tool],
                                r->error));
  ABBE_TRY(read_points(r, list, tool, out));
  return abbe_yaml_check_keys(r->yaml, node, "tool", r->error);
}

static abbe_result read_front(const reader *r, abbe_yaml_node node, abbe_picture_front *out) {
  ABBE_TRY(get_above_0(r, node, "base_ms", &out->base_ms));
  ABBE_TRY(get_above_0(r, node, "base_error", &out->base_error));
  ABBE_TRY(
      abbe_yaml_get_count(r->yaml, node, "margin_scenes", 0, 1000, &out->margin_scenes, r->error));
  for (int i = 0; i < ABBE_PICTURE_TOOL_COUNT; i++)
    ABBE_TRY(read_tool(r, node, (abbe_picture_tool)i, out));
  if (out->count == 0) ABBE_TRY(abbe_yaml_fail(r->yaml, node, r->error, "'pictures' has no tool"));
  return abbe_yaml_check_keys(r->yaml, node, "pictures", r->error);
}

/* The class in the file, or an absent node. */
static abbe_result find_class(const reader *r, abbe_preset_class of, abbe_yaml_node *out) {
  abbe_yaml_node list;
  abbe_result result =
      abbe_yaml_require(r->yaml, abbe_yaml_root(r->yaml), "classes", &list, r->error);
  *out = (abbe_yaml_node){0};
  for (size_t i = 0; result == ABBE_OK && i < abbe_yaml_count(r->yaml, list); i++) {
    abbe_yaml_node node = abbe_yaml_item(r->yaml, list, i);
    int own = 0;
    result = abbe_yaml_get_choice(r->yaml, node, "class", class_names, &own, r->error);
    if (result != ABBE_OK || own != (int)of) continue;
    *out = node;
    break;
  }
  return result;
}

static abbe_result read_class(const reader *r, const char *path, abbe_preset_class of,
                              abbe_picture_front *out) {
  abbe_yaml_node node, pictures = {0};
  char *scenes = NULL;
  ABBE_TRY(find_class(r, of, &node));
  if (node.id != 0) pictures = abbe_yaml_get(r->yaml, node, "pictures");
  if (pictures.id == 0)
    return abbe_error_set(r->error, ABBE_UNSUPPORTED,
                          "%s has no whole processes of scenes of the class %s: sweep with "
                          "--processes",
                          path != NULL ? path : "the shipped presets", abbe_preset_class_name(of));
  out->of = of;
  abbe_result result = abbe_yaml_get_string(r->yaml, node, "scenes", &scenes, r->error);
  if (result == ABBE_OK && scenes != NULL) snprintf(out->scenes, sizeof out->scenes, "%s", scenes);
  free(scenes);
  return result == ABBE_OK ? read_front(r, pictures, out) : result;
}

abbe_result abbe_picture_front_load(const char *path, abbe_preset_class of, abbe_picture_front *out,
                                    abbe_error *error) {
  reader r = {.error = error};
  size_t size;
  *out = (abbe_picture_front){0};
  const char *shipped = abbe_presets_shipped(&size);
  abbe_result result = path != NULL
                           ? abbe_yaml_load(path, &r.yaml, error)
                           : abbe_yaml_parse(shipped, size, "the shipped presets", &r.yaml, error);
  if (result == ABBE_OK) result = read_class(&r, path, of, out);
  abbe_yaml_free(r.yaml);
  return result;
}

/* ---- choosing ---- */

static bool may(const abbe_picture_request *q, abbe_picture_tool tool) {
  bool any = false;
  for (int i = 0; i < ABBE_PICTURE_TOOL_COUNT; i++) any |= q->tool[i];
  return !any || q->tool[tool];
}

/* What this scene and machine are to the run's. */
typedef struct yardstick {
  double time, error;
} yardstick;

static abbe_result measure(abbe_picture_choice *c, const abbe_scene *scene, yardstick *out,
                           abbe_error *error) {
  abbe_trace_times times;
  const double start = abbe_clock_seconds();
  abbe_trace_times_desc desc = {.passes = ABBE_PICTURE_YARDSTICK_PASSES,
                                .photons = ABBE_PICTURE_YARDSTICK_PHOTONS,
                                .width = c->request.width,
                                .height = c->request.height,
                                .frames = 1};
  abbe_result result = abbe_trace_times_measure(scene, &desc, &times, NULL, error);
  const double own = times.own_de;
  c->once_ms = 1e3 * (abbe_clock_seconds() - start);
  desc.frames = REPEATS;
  if (result == ABBE_OK && (REPEATS + 1) * c->once_ms <= repeats_share * c->request.budget_ms) {
    result = abbe_trace_times_measure(scene, &desc, &times, NULL, error);
    c->unrest = abbe_frame_times_unrest(times.frame_ms, times.fastest_ms);
  }
  out->time = times.frame_ms / c->front.base_ms;
  out->error = own > 0 ? own / c->front.base_error : NAN; /* no caustic: nothing is promised */
  c->spent_ms = 1e3 * (abbe_clock_seconds() - start);
  return result;
}

static double error_of(const abbe_picture_point *p, const yardstick *y) {
  return p->tool == ABBE_PICTURE_RENDER ? p->error : p->error * y->error;
}

/* The points of this scene that may be taken and no other beats, in the order of time. */
typedef struct candidates {
  size_t count, point[ABBE_PICTURE_MAX_POINTS];
  double ms[ABBE_PICTURE_MAX_POINTS], error[ABBE_PICTURE_MAX_POINTS];
} candidates;

static void find_candidates(const abbe_picture_choice *c, const yardstick *y, candidates *out) {
  double ms[ABBE_PICTURE_MAX_POINTS], error[ABBE_PICTURE_MAX_POINTS];
  for (size_t i = 0; i < c->front.count; i++) {
    const abbe_picture_point *p = &c->front.point[i];
    ms[i] = may(&c->request, p->tool) ? p->ms * y->time + c->spent_ms : NAN;
    error[i] = error_of(p, y);
  }
  out->count = abbe_pareto_front_order(ms, error, c->front.count, out->point);
  for (size_t i = 0; i < out->count; i++) {
    out->ms[i] = ms[out->point[i]];
    out->error[i] = error[out->point[i]];
  }
}

static size_t pick(const abbe_picture_request *q, const candidates *all, bool *kept) {
  const size_t last = all->count - 1;
  size_t at = 0;
  *kept = true;
  if (q->name != NULL) {
    const size_t accurate = abbe_pareto_front_accurate(all->error, all->count, unseen);
    if (strcmp(q->name, preset_names[ABBE_PRESET_ACCURATE]) == 0) return accurate;
    if (strcmp(q->name, preset_names[ABBE_PRESET_BALANCED]) == 0)
      return abbe_pareto_front_knee(all->ms, all->error, accurate + 1);
    return 0;
  }
  if (q->max_error > 0) {
    while (at < last && all->error[at] > q->max_error) at++;
    *kept = all->error[at] <= q->max_error;
    return at;
  }
  while (at < last && all->ms[at + 1] <= q->budget_ms) at++;
  *kept = all->ms[at] <= q->budget_ms;
  return at;
}

/* Whether something of the tracer is among what may be taken. */
static bool needs_yardstick(const abbe_picture_choice *c) {
  for (size_t i = 0; i < c->front.count; i++)
    if (may(&c->request, c->front.point[i].tool) && c->front.point[i].tool != ABBE_PICTURE_RENDER)
      return true;
  return c->timed;
}

static abbe_result choose(abbe_picture_choice *c, const abbe_scene *scene, abbe_error *error) {
  yardstick y = {1, 1};
  candidates all;
  c->timed = c->request.timed || c->request.budget_ms > 0;
  ABBE_TRY(needs_yardstick(c) ? measure(c, scene, &y, error) : ABBE_OK);
  c->timed = c->timed || c->spent_ms > 0;
  find_candidates(c, &y, &all);
  if (all.count == 0)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the fronts of whole pictures of the class %s have no point of a tool "
                          "that can make this one",
                          abbe_preset_class_name(c->front.of));
  const size_t at = pick(&c->request, &all, &c->kept);
  c->point = &c->front.point[all.point[at]];
  c->promised_ms = all.ms[at];
  c->promised_error = all.error[at];
  return ABBE_OK;
}

abbe_result abbe_picture_choose(const abbe_picture_request *request, const abbe_scene *scene,
                                abbe_picture_choice *out, abbe_error *error) {
  abbe_plan plan;
  *out = (abbe_picture_choice){.request = *request, .unrest = NAN};
  if (request->name == NULL && !(request->max_error > 0) && !(request->budget_ms > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "neither a name, an error nor a time is asked for");
  ABBE_TRY(abbe_plan_make(scene, NULL, &plan, error));
  abbe_result result =
      abbe_picture_front_load(request->file, abbe_preset_class_of(&plan), &out->front, error);
  abbe_plan_free(&plan);
  return result == ABBE_OK ? choose(out, scene, error) : result;
}

bool abbe_picture_choice_tells(const abbe_picture_choice *c) {
  return c->passes > 0 && isfinite(c->met.bound);
}

double abbe_picture_choice_pass_s(const abbe_picture_choice *c, size_t photons) {
  const double its = ABBE_PICTURE_YARDSTICK_PHOTONS * ABBE_PICTURE_YARDSTICK_PHOTONS;
  return c->once_ms > 0 ? 1e-3 * c->once_ms * fmax(1, (double)photons / its) : NAN;
}

/* Why passes show nothing. */
static const char *find_reason(const abbe_picture_choice *c) {
  if (c->passes > 0 && c->others && c->timed_out)
    return "so few passes as the budget left time for are too noisy to tell";
  if (c->passes > 0 && c->others)
    return "nothing is lit through refractors, or passes are too noisy to tell";
  if (c->timed_out) return "the budget left no time for it";
  if (c->request.max_error > 0) return "its passes tell nothing";
  return "no passes were traced for that";
}

void abbe_picture_choice_say_error(const abbe_picture_choice *c, char *out, size_t size) {
  if (abbe_picture_choice_tells(c))
    abbe_number_format(
        out, size, "about %.3g (at most %.3g), told by %zu passes, %s; expected were %.3g",
        c->met.estimate, c->met.bound, c->passes,
        c->others ? "against which the picture is held" : "half against half", c->promised_error);
  else
    abbe_number_format(out, size, "%.3g, expected (not checked: %s)", c->promised_error,
                       find_reason(c));
}

/* Where a budget's time went, as far as it is known. */
static void explain(const abbe_picture_choice *c, double ms, char *out, size_t size) {
  size_t used = 0;
  *out = '\0';
  if (c->spent_ms > 0)
    used += (size_t)snprintf(out, size, ", %ld of them on choosing", lround(c->spent_ms));
  if (c->prepared_ms > 0 && used < size)
    used += (size_t)snprintf(
        out + used, size - used, ", %ld on preparing%s", lround(c->prepared_ms),
        c->compiled ? " with shaders to compile, which the next run will find" : "");
  if (used < size && c->unrest > ABBE_FRAME_TIMES_QUIET)
    abbe_frame_times_say_unrest(c->unrest, ", and ", out + used, size - used);
  else if (used < size && c->promised_ms <= c->request.budget_ms && ms > 1.5 * c->promised_ms &&
           !c->compiled)
    snprintf(out + used, size - used,
             ", and over 1.5 times what was promised: the machine may be busy");
}

abbe_result abbe_picture_choice_check(const abbe_picture_choice *c, double ms, abbe_error *error) {
  const abbe_picture_request *q = &c->request;
  if (c->point == NULL) return ABBE_OK;
  if (q->budget_ms > 0 && ms > q->budget_ms) {
    char why[300];
    explain(c, ms, why, sizeof why);
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "the picture took %.0f ms from start to end%s; %.0f were promised: the "
                          "budget of %g ms is not kept%s; what was asked for is written all the "
                          "same",
                          ms, why, c->promised_ms, q->budget_ms,
                          c->kept ? "" : ", for nothing faster is known");
  }
  if (q->max_error > 0 && abbe_picture_choice_tells(c)) {
    if (c->met.bound <= q->max_error) return ABBE_OK;
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "an error of %g is not known to be kept: %zu passes tell one of %.3g, "
                          "and at most %.3g; what was asked for is written all the same",
                          q->max_error, c->passes, c->met.estimate, c->met.bound);
  }
  if (q->max_error > 0 && c->passes > 0)
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "an error of %g is not known to be kept: %zu passes tell none; what was "
                          "asked for is written all the same",
                          q->max_error, c->passes);
  if (q->max_error > 0 && !c->kept)
    return abbe_error_set(
        error, ABBE_TOLERANCE,
        "nothing is known to keep an error of %g; the nearest was taken, of which "
        "%.3g is promised, and what was asked for is written all the same",
        q->max_error, c->promised_error);
  return ABBE_OK;
}

abbe_render_desc abbe_picture_point_desc(const abbe_picture_point *p) {
  return (abbe_render_desc){.wavelengths = p->wavelengths,
                            .photons = p->photons,
                            .map_size = p->map_size,
                            .supersample = p->supersample,
                            .upsample = p->upsample,
                            .exits = p->exits,
                            .energy_share = p->energy_share,
                            .fill = p->fill,
                            .model = p->model};
}

void abbe_picture_describe(const abbe_picture_point *point, char *out, size_t size) {
  char text[200];
  const abbe_render_desc desc = abbe_picture_point_desc(point);
  abbe_preset_describe(&desc, text, sizeof text);
  if (point->tool == ABBE_PICTURE_RENDER)
    snprintf(out, size, "the renderer: %s", text);
  else
    snprintf(out, size, "the tracer: %zu passes of %zu photons%s", point->passes,
             point->photons * point->photons,
             point->tool == ABBE_PICTURE_TRACE_FILTER ? ", filtered" : "");
}

static bool counts(double cost, double error) {
  return isfinite(cost) && cost > 0 && isfinite(error);
}

/* Whether j beats i, or is equal and came first. */
static bool beats(const double *cost, const double *error, size_t j, size_t i) {
  if (!counts(cost[j], error[j]) || cost[j] > cost[i] || error[j] > error[i]) return false;
  return cost[j] < cost[i] || error[j] < error[i] || j < i;
}

size_t abbe_pareto_front_order(const double *cost, const double *error, size_t count,
                               size_t *order) {
  size_t found = 0;
  for (size_t i = 0; i < count; i++) {
    bool on_front = counts(cost[i], error[i]);
    for (size_t j = 0; j < count && on_front; j++) on_front = j == i || !beats(cost, error, j, i);
    if (!on_front) continue;
    size_t at = found++;
    for (; at > 0 && cost[order[at - 1]] > cost[i]; at--) order[at] = order[at - 1];
    order[at] = i;
  }
  return found;
}

static double height(double error) {
  return log(fmax(error, 1e-12));
}

size_t abbe_pareto_front_knee(const double *cost, const double *error, size_t count) {
  if (count < 3) return count / 2;
  double x0 = log(cost[0]), x1 = log(cost[count - 1]);
  double y0 = height(error[0]), y1 = height(error[count - 1]);
  size_t best = count / 2;
  double most = 1e-9;
  for (size_t i = 1; i + 1 < count; i++) {
    double line = y0 + (y1 - y0) * (log(cost[i]) - x0) / (x1 - x0);
    double below = line - height(error[i]);
    if (below > most) best = i;
    most = fmax(most, below);
  }
  return best;
}

size_t abbe_pareto_front_accurate(const double *error, size_t count, double slack) {
  double least = INFINITY;
  for (size_t i = 0; i < count; i++) least = fmin(least, error[i]);
  for (size_t i = 0; i < count; i++)
    if (error[i] <= least * (1 + slack)) return i;
  return 0;
}
