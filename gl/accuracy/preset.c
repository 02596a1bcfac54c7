#include "gl/accuracy/preset.h"

#include "base/number.h"
#include "base/yaml/yaml.h"
#include "gl/accuracy/frame_times.h"
#include "gl/plan/examine/examine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const unsigned char abbe_embedded_presets_yaml[];
extern const size_t abbe_embedded_presets_yaml_size;

#define ABBE_NAME_OF(code, name) name,
static const char *const preset_names[] = {ABBE_PRESETS(ABBE_NAME_OF) NULL};
static const char *const class_names[] = {ABBE_PRESET_CLASSES(ABBE_NAME_OF) NULL};
static const char *const fill_names[] = {ABBE_FILLS(ABBE_NAME_OF) NULL};
static const char *const model_names[] = {ABBE_MODELS(ABBE_NAME_OF) NULL};
#undef ABBE_NAME_OF

const char *abbe_preset_name_text(abbe_preset_name name) {
  return (unsigned)name < ABBE_PRESET_COUNT ? preset_names[name] : "unknown";
}

const char *abbe_preset_class_name(abbe_preset_class which) {
  return (unsigned)which < ABBE_PRESET_CLASS_COUNT ? class_names[which] : "unknown";
}

abbe_preset_class abbe_preset_class_of(const abbe_plan *plan) {
  return plan->layers || plan->bvh ? ABBE_PRESET_CLASS_MESHES
         : plan->convex            ? ABBE_PRESET_CLASS_CONVEX
         : plan->spheres
             ? plan->forward_transmission ? ABBE_PRESET_CLASS_SPHERES : ABBE_PRESET_CLASS_BOWS
             : ABBE_PRESET_CLASS_NONE;
}

/* Reading */

typedef struct reader {
  abbe_yaml *yaml;
  abbe_error *error;
} reader;

static abbe_result get_positive(const reader *r, abbe_yaml_node node, const char *key,
                                double *out) {
  *out = -1;
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, key, 0, 1e9, out, r->error));
  if (*out < 0)
    return abbe_yaml_fail(r->yaml, node, r->error, "a point of a front has no '%s'", key);
  return ABBE_OK;
}

static abbe_result get_counts(const reader *r, abbe_yaml_node node, abbe_render_desc *d) {
  const struct {
    const char *key;
    size_t most, *out;
  } counts[] = {{"wavelengths", ABBE_RENDER_MAX_WAVELENGTHS, &d->wavelengths},
                {"photons", ABBE_RENDER_MAX_PHOTONS, &d->photons},
                {"map", ABBE_RENDER_MAX_MAP, &d->map_size},
                {"samples", 4, &d->supersample},
                {"upsample", 4, &d->upsample},
                {"exits", ABBE_RENDER_MAX_EXITS, &d->exits}};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    abbe_result result = abbe_yaml_get_count(r->yaml, node, counts[i].key, 1, counts[i].most,
                                             counts[i].out, r->error);
    if (result == ABBE_OK && *counts[i].out == 0 && counts[i].out == &d->upsample) d->upsample = 1;
    if (result == ABBE_OK && *counts[i].out == 0)
      result =
          abbe_yaml_fail(r->yaml, node, r->error, "a point of a front has no '%s'", counts[i].key);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

static abbe_result read_point(const reader *r, abbe_yaml_node node, abbe_preset_point *out) {
  int fill = ABBE_FILL_BRIDGE, model = ABBE_MODEL_AUTO;
  ABBE_TRY(get_counts(r, node, &out->desc));
  ABBE_TRY(abbe_yaml_get_choice(r->yaml, node, "fill", fill_names, &fill, r->error));
  ABBE_TRY(abbe_yaml_get_choice(r->yaml, node, "model", model_names, &model, r->error));
  out->desc.fill = (abbe_fill)fill;
  out->desc.model = (abbe_model)model;
  ABBE_TRY(get_positive(r, node, "share", &out->desc.energy_share));
  if (!(out->desc.energy_share > 0 && out->desc.energy_share <= 1))
    ABBE_TRY(abbe_yaml_fail(r->yaml, node, r->error, "the share may be above 0, to 1"));
  ABBE_TRY(get_positive(r, node, "light_ms", &out->light_ms));
  ABBE_TRY(get_positive(r, node, "eye_ms", &out->eye_ms));
  ABBE_TRY(get_positive(r, node, "error", &out->error));
  ABBE_TRY(get_positive(r, node, "least", &out->least));
  return abbe_yaml_check_keys(r->yaml, node, "point", r->error);
}

/* The first point's time is measured again on every machine. */
static void widen(const abbe_preset_front *front, bool timed, abbe_preset_point *p) {
  p->worst = p->error;
  p->error *= front->margin;
  p->light_ms *= timed ? front->time_margin : 1;
  p->eye_ms *= timed ? front->time_margin : 1;
}

static abbe_result read_points(const reader *r, abbe_yaml_node list, abbe_preset_front *out) {
  size_t count = abbe_yaml_count(r->yaml, list);
  if (!abbe_yaml_is_sequence(r->yaml, list) || count < 1 || count > ABBE_PRESET_MAX_POINTS)
    return abbe_yaml_fail(r->yaml, list, r->error, "a front is a list of 1 to %d points",
                          ABBE_PRESET_MAX_POINTS);
  out->point = calloc(count, sizeof *out->point);
  if (out->point == NULL) return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for presets");
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node node = abbe_yaml_item(r->yaml, list, i);
    abbe_preset_point *p = &out->point[i];
    ABBE_TRY(read_point(r, node, p));
    widen(out, i > 0, p);
    bool rises = i == 0 || (p->light_ms + p->eye_ms >= p[-1].light_ms + p[-1].eye_ms &&
                            p->error <= p[-1].error);
    if (!rises)
      return abbe_yaml_fail(r->yaml, node, r->error,
                            "the points of a front stand in the order of rising cost and falling "
                            "error");
  }
  out->count = count;
  return ABBE_OK;
}

/* Without margins a front promises what was measured. */
static abbe_result read_margins(const reader *r, abbe_yaml_node node, abbe_preset_front *out) {
  out->margin = out->time_margin = 1;
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "margin", 1, 1e6, &out->margin, r->error));
  ABBE_TRY(abbe_yaml_get_number(r->yaml, node, "time_margin", 1, 1e6, &out->time_margin, r->error));
  return abbe_yaml_get_count(r->yaml, node, "margin_scenes", 0, 1000, &out->margin_scenes,
                             r->error);
}

static abbe_result copy_text(const reader *r, abbe_yaml_node node, const char *key, char *out,
                             size_t size) {
  ABBE_FREED char *text = NULL;
  ABBE_TRY(abbe_yaml_get_string(r->yaml, node, key, &text, r->error));
  if (text == NULL) return abbe_yaml_fail(r->yaml, node, r->error, "'%s' is not stated", key);
  snprintf(out, size, "%s", text);
  return ABBE_OK;
}

static abbe_result read_front(const reader *r, abbe_yaml_node node, abbe_preset_front *out) {
  abbe_yaml_node list;
  int of = 0;
  abbe_result result = abbe_yaml_require(r->yaml, node, "front", &list, r->error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_choice(r->yaml, node, "class", class_names, &of, r->error);
  out->of = (abbe_preset_class)of;
  if (result == ABBE_OK) result = copy_text(r, node, "scenes", out->scenes, sizeof out->scenes);
  if (result == ABBE_OK) result = read_margins(r, node, out);
  if (result == ABBE_OK) result = read_points(r, list, out);
  for (int i = 0; i < ABBE_PRESET_COUNT; i++) out->named[i] = out->count;
  for (int i = 0; i < ABBE_PRESET_COUNT && result == ABBE_OK; i++)
    result = abbe_yaml_get_count(r->yaml, node, preset_names[i], 0, out->count - 1, &out->named[i],
                                 r->error);
  abbe_yaml_get(r->yaml, node, "pictures"); /* for whole processes and other tools: not read here */
  return result == ABBE_OK ? abbe_yaml_check_keys(r->yaml, node, "class", r->error) : result;
}

static abbe_result read_all(const reader *r, abbe_presets *out) {
  abbe_yaml_node root = abbe_yaml_root(r->yaml), classes;
  ABBE_TRY(copy_text(r, root, "error", out->error, sizeof out->error));
  ABBE_TRY(copy_text(r, root, "what", out->error_text, sizeof out->error_text));
  ABBE_TRY(copy_text(r, root, "run", out->run, sizeof out->run));
  ABBE_TRY(abbe_yaml_require(r->yaml, root, "classes", &classes, r->error));
  size_t count = abbe_yaml_count(r->yaml, classes);
  if (!abbe_yaml_is_sequence(r->yaml, classes) || count > ABBE_PRESET_CLASS_COUNT)
    return abbe_yaml_fail(r->yaml, classes, r->error, "classes is a list of at most %d",
                          ABBE_PRESET_CLASS_COUNT);
  for (size_t i = 0; i < count; i++)
    ABBE_TRY(read_front(r, abbe_yaml_item(r->yaml, classes, i), &out->front[out->count++]));
  return abbe_yaml_check_keys(r->yaml, root, "file", r->error);
}

const char *abbe_presets_shipped(size_t *size) {
  *size = abbe_embedded_presets_yaml_size;
  return (const char *)abbe_embedded_presets_yaml;
}

abbe_result abbe_presets_load(const char *path, abbe_presets *out, abbe_error *error) {
  reader r = {.error = error};
  *out = (abbe_presets){0};
  size_t size;
  const char *shipped = abbe_presets_shipped(&size);
  abbe_result result = path != NULL
                           ? abbe_yaml_load(path, &r.yaml, error)
                           : abbe_yaml_parse(shipped, size, "the shipped presets", &r.yaml, error);
  if (result == ABBE_OK) result = read_all(&r, out);
  abbe_yaml_free(r.yaml);
  if (result != ABBE_OK) abbe_presets_free(out);
  return result;
}

void abbe_presets_free(abbe_presets *presets) {
  if (presets == NULL) return;
  for (size_t i = 0; i < presets->count; i++) free(presets->front[i].point);
  *presets = (abbe_presets){0};
}

/* Choosing */

abbe_result abbe_presets_find(const abbe_presets *presets, const abbe_plan *plan,
                              const abbe_preset_front **out, abbe_error *error) {
  abbe_preset_class of = abbe_preset_class_of(plan);
  for (size_t i = 0; i < presets->count; i++) {
    if (presets->front[i].of != of) continue;
    *out = &presets->front[i];
    return ABBE_OK;
  }
  return abbe_error_set(
      error, ABBE_UNSUPPORTED, "there are no presets for this scene's class (%s): %s",
      abbe_preset_class_name(of),
      of == ABBE_PRESET_CLASS_NONE ? "nothing refracts, so there is nothing to trade"
                                   : "no sweep of such a scene made any");
}

/* Exits that plans have by themselves; of a high index they have more, and are left to it. */
static bool take_exits(size_t *mine, const abbe_render_desc *preset) {
  const size_t planned =
      preset->model == ABBE_MODEL_LAYERS ? ABBE_PLAN_LAYER_EXITS : ABBE_PLAN_EXITS;
  const bool same = *mine == 0 || *mine == preset->exits;
  if (*mine == 0 && preset->exits < planned) *mine = preset->exits;
  return same;
}

/* The share that plans have by themselves likewise: a gem has a lower one. */
static bool take_share(double *mine, double preset) {
  const bool same = *mine == 0 || *mine == preset;
  if (*mine == 0 && preset != ABBE_PLAN_SHARE) *mine = preset;
  return same;
}

static bool take(size_t *mine, size_t preset) {
  if (*mine == 0) *mine = preset;
  return *mine == preset;
}

/* Layers show nothing that stands in a refractor, nor what it scatters, nor mirrors. */
static bool may_have_layers(const abbe_scene *scene) {
  bool may = abbe_scene_mirror(scene) == NULL && !scene->camera.inside;
  for (size_t i = 0; i < scene->object_count && may; i++) {
    const abbe_object *o = &scene->object[i];
    const bool refracts = abbe_object_kind_of(o) == ABBE_OBJECT_REFRACTOR;
    may = !refracts || (o->medium == NULL && !o->cloud && !abbe_reach_is_entered(scene, o));
  }
  return may;
}

bool abbe_preset_apply(const abbe_preset_point *point, const abbe_scene *scene,
                       abbe_render_desc *d) {
  const abbe_render_desc *p = &point->desc;
  const bool fits = p->model != ABBE_MODEL_LAYERS || scene == NULL || may_have_layers(scene);
  bool same = take(&d->wavelengths, p->wavelengths);
  same = take(&d->photons, p->photons) && same;
  same = take(&d->map_size, p->map_size) && same;
  if (d->supersample > 1) d->upsample = 1; /* asked for, and one excludes the other */
  same = take(&d->upsample, p->upsample) && same;
  same = take(&d->supersample, d->upsample > 1 ? 1 : p->supersample) && same;
  same = d->supersample == p->supersample && same;
  if (fits) same = take_exits(&d->exits, p) && same;
  if (d->fill == ABBE_FILL_AUTO) d->fill = p->fill;
  same = take_share(&d->energy_share, p->energy_share) && same;
  if (fits && d->model == ABBE_MODEL_AUTO) d->model = p->model;
  return same && d->fill == p->fill && d->model == p->model && abbe_method_of(d->profile)->presets;
}

abbe_result abbe_preset_calibrate(abbe_context *context, const abbe_scene *scene,
                                  const abbe_preset_front *front, const abbe_render_desc *desc,
                                  abbe_preset_speed *out, abbe_error *error) {
  static const double least_ms = 0.01; /* a part too short to measure a speed by */
  const abbe_preset_point *point = &front->point[0];
  abbe_renderer *renderer = NULL;
  abbe_frame_times times = {0};
  const abbe_frame_times_desc repeats = {.frames = 3};
  abbe_render_desc quick = {.width = desc->width,
                            .height = desc->height,
                            .space = desc->space,
                            .observer = desc->observer};
  abbe_preset_apply(point, scene, &quick);
  abbe_result result = abbe_renderer_make(context, scene, &quick, &renderer, error);
  if (result == ABBE_OK) result = abbe_frame_times_measure(renderer, &repeats, &times, error);
  abbe_renderer_free(renderer);
  if (result != ABBE_OK) return result;
  const double light_ms = abbe_statistics_stage_ms(&times.median, ABBE_STAGE_LIGHT);
  const double eye_ms = abbe_statistics_stage_ms(&times.median, ABBE_STAGE_EYE);
  out->light = light_ms / fmax(point->light_ms, least_ms);
  out->eye = eye_ms / fmax(point->eye_ms, least_ms);
  out->unrest = abbe_frame_times_unrest(times.median.frame_ms, times.fastest_ms);
  return ABBE_OK;
}

double abbe_preset_ms(const abbe_preset_point *point, const abbe_preset_speed *speed) {
  return point->light_ms * speed->light + point->eye_ms * speed->eye;
}

size_t abbe_preset_for_error(const abbe_preset_front *front, double max_error, bool *kept) {
  for (size_t i = 0; i < front->count; i++) {
    *kept = front->point[i].error <= max_error;
    if (*kept) return i;
  }
  return front->count - 1;
}

size_t abbe_preset_for_time(const abbe_preset_front *front, const abbe_preset_speed *speed,
                            double ms, bool *kept) {
  size_t fastest = 0;
  for (size_t i = front->count; i-- > 0;) {
    double own = abbe_preset_ms(&front->point[i], speed);
    *kept = own <= ms;
    if (*kept) return i;
    if (own <= abbe_preset_ms(&front->point[fastest], speed)) fastest = i;
  }
  return fastest;
}

static bool is_asked(const abbe_preset_request *q) {
  return q->name != NULL || q->max_error > 0 || q->budget_ms > 0;
}

static abbe_result find_named(const abbe_preset_request *q, const abbe_preset_front *front,
                              size_t *point, abbe_error *error) {
  size_t i = 0;
  while (i < ABBE_PRESET_COUNT && strcmp(q->name, abbe_preset_name_text((abbe_preset_name)i)) != 0)
    i++;
  *point = i < ABBE_PRESET_COUNT ? front->named[i] : front->count;
  if (*point < front->count) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_NOT_FOUND, "there is no '%s' for scenes of the class %s in %s%s", q->name,
      abbe_preset_class_name(front->of), q->file != NULL ? q->file : "the shipped presets",
      i == ABBE_PRESET_ACCURATE ? ": no sweep of one measured settings finer than the defaults"
                                : "");
}

/* The presets of the file, and the front of them for the scene. */
static abbe_result find_front(const abbe_scene *scene, const abbe_render_desc *desc,
                              abbe_preset_choice *c, abbe_error *error) {
  abbe_plan plan;
  abbe_result result = abbe_presets_load(c->request.file, &c->presets, error);
  if (result == ABBE_OK) result = abbe_plan_make(scene, desc, &plan, error);
  if (result != ABBE_OK) return result;
  result = abbe_presets_find(&c->presets, &plan, &c->front, error);
  abbe_plan_free(&plan);
  return result;
}

abbe_result abbe_preset_choose(const abbe_preset_request *request, abbe_context *context,
                               const abbe_scene *scene, abbe_render_desc *desc,
                               abbe_preset_choice *out, abbe_error *error) {
  const abbe_preset_request *q = request;
  abbe_preset_choice c = {.request = *q, .kept = true, .timed = q->timed || q->budget_ms > 0};
  abbe_preset_speed speed = {0};
  size_t point = 0;
  *out = (abbe_preset_choice){.request = *q};
  if (!is_asked(q)) return ABBE_OK;
  if (!abbe_method_of(desc->profile)->presets)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "presets are of the default profile; a published method has none");
  abbe_result result = find_front(scene, desc, &c, error);
  if (result == ABBE_OK && q->name != NULL) result = find_named(q, c.front, &point, error);
  if (result == ABBE_OK && c.timed)
    result = abbe_preset_calibrate(context, scene, c.front, desc, &speed, error);
  if (result != ABBE_OK) {
    abbe_preset_choice_free(&c);
    return result;
  }
  if (q->budget_ms > 0)
    point = abbe_preset_for_time(c.front, &speed, q->budget_ms, &c.kept);
  else if (q->max_error > 0)
    point = abbe_preset_for_error(c.front, q->max_error, &c.kept);
  c.point = &c.front->point[point];
  c.promised_ms = abbe_preset_ms(c.point, &speed);
  c.unrest = c.timed ? speed.unrest : NAN;
  c.overridden = !abbe_preset_apply(c.point, scene, desc);
  *out = c;
  out->front = &out->presets.front[c.front - c.presets.front];
  return ABBE_OK;
}

void abbe_preset_choice_free(abbe_preset_choice *choice) {
  if (choice == NULL) return;
  abbe_presets_free(&choice->presets);
  *choice = (abbe_preset_choice){0};
}

abbe_result abbe_preset_choice_check(const abbe_preset_choice *choice, double frame_ms,
                                     abbe_error *error) {
  const abbe_preset_request *q = &choice->request;
  if (choice->point == NULL) return ABBE_OK;
  if (q->budget_ms > 0 && frame_ms > q->budget_ms) {
    char busy[120];
    abbe_frame_times_say_unrest(choice->unrest, ", and ", busy, sizeof busy);
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "the frame took %.0f ms and %.0f were promised%s: the budget of %g ms is "
                          "not kept%s; what was asked for is written all the same",
                          frame_ms, choice->promised_ms, busy, q->budget_ms,
                          choice->kept ? "" : ", for no faster settings are known");
  }
  if (q->max_error > 0 && !choice->kept)
    return abbe_error_set(error, ABBE_TOLERANCE,
                          "no settings are known to keep an error of %g; the most accurate ones "
                          "were taken, and what was asked for is written all the same",
                          q->max_error);
  return ABBE_OK;
}

void abbe_preset_describe(const abbe_render_desc *d, char *out, size_t size) {
  const bool plain = abbe_method_of(d->profile)->presets;
  char share[ABBE_NUMBER_TEXT_SIZE], upsample[32] = "";
  if (d->upsample > 1) snprintf(upsample, sizeof upsample, ", upsample %zu", d->upsample);
  snprintf(out, size,
           "%s%s%zu wavelengths, %zu photons, map %zu, %zu samples, fill %s, %zu exits, share %s, "
           "model %s%s",
           plain ? "" : abbe_profile_name(d->profile), plain ? "" : ": ", d->wavelengths,
           d->photons, d->map_size, d->supersample, abbe_fill_name(d->fill), d->exits,
           abbe_number_text(d->energy_share, share), abbe_model_name(d->model), upsample);
}
