#include "validation/sweep/sweep_grid.h"

#include "base/yaml/yaml.h"
#include "gl/plan/plan.h"
#include "library/choice/sweep_setting.h"
#include "library/choice/sweep_trace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const unsigned char abbe_embedded_grids_yaml[];
extern const size_t abbe_embedded_grids_yaml_size;

/* ---- reading ---- */

#define ABBE_NAME_OF(code, name) name,
#define ABBE_PINHOLE_NAME_OF(count) ABBE_SWEEP_PINHOLE #count,
#define ABBE_COUNT_OF(count) count,
const char *const abbe_sweep_profiles[] = {ABBE_PROFILES(ABBE_NAME_OF) ABBE_SWEEP_TRACE,
                                           ABBE_SWEEP_TRACE_FILTER,
                                           ABBE_SWEEP_PINHOLES(ABBE_PINHOLE_NAME_OF)};
static const size_t pinholes[] = {ABBE_SWEEP_PINHOLES(ABBE_COUNT_OF)};
_Static_assert(sizeof abbe_sweep_profiles / sizeof *abbe_sweep_profiles == ABBE_SWEEP_PROFILE_COUNT,
               "each contestant has a name");
static const char *const fill_names[] = {ABBE_FILLS(ABBE_NAME_OF)};
static const char *const model_names[] = {ABBE_MODELS(ABBE_NAME_OF)};
#undef ABBE_NAME_OF

enum { MOST_PASSES = 65536 }; /* for the tracer */

typedef struct reader {
  abbe_yaml *yaml;
  abbe_error *error;
} reader;

/* The index of a word in names, which are so many. */
static abbe_result read_word(const reader *r, abbe_yaml_node node, const char *key,
                             const char *const *names, size_t count, size_t *out) {
  const char *text = abbe_yaml_text(r->yaml, node);
  for (*out = 0; text != NULL && *out < count; ++*out)
    if (strcmp(names[*out], text) == 0) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, node, r->error, "'%.40s' is not known as a value of '%s'",
                        text != NULL ? text : "", key);
}

/* Counts from 1 to `most`, or words of `most` names (NULL: counts); *out stays empty without the
 * key. */
static abbe_result read_values(const reader *r, abbe_yaml_node part, const char *key, size_t most,
                               const char *const *names, abbe_sweep_values *out) {
  abbe_yaml_node list = abbe_yaml_get(r->yaml, part, key);
  if (list.id == 0) return ABBE_OK;
  size_t count = abbe_yaml_count(r->yaml, list);
  if (!abbe_yaml_is_sequence(r->yaml, list) || count < 1 || count > ABBE_SWEEP_MAX_VALUES)
    return abbe_yaml_fail(r->yaml, list, r->error, "'%s' is a list of 1 to %d values", key,
                          ABBE_SWEEP_MAX_VALUES);
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node item = abbe_yaml_item(r->yaml, list, i);
    double value = 0;
    abbe_result result =
        names != NULL ? read_word(r, item, key, names, most, &out->value[i])
                      : abbe_yaml_number(r->yaml, item, key, 1, (double)most, &value, r->error);
    if (result != ABBE_OK) return result;
    if (names == NULL) out->value[i] = (size_t)value;
    if (names == NULL && (double)out->value[i] != value)
      return abbe_yaml_fail(r->yaml, item, r->error, "'%s' counts: a whole number", key);
  }
  out->count = count;
  return ABBE_OK;
}

static abbe_result read_shares(const reader *r, abbe_yaml_node part, abbe_sweep_grid *out) {
  double *list = NULL;
  abbe_result result = abbe_yaml_get_list(r->yaml, part, "share", ABBE_SWEEP_MAX_VALUES, &list,
                                          &out->share_count, r->error);
  for (size_t i = 0; result == ABBE_OK && i < out->share_count; i++) {
    out->share[i] = list[i];
    if (!(list[i] > 0 && list[i] <= 1))
      result = abbe_yaml_fail(r->yaml, part, r->error, "a share may be above 0, to 1");
  }
  free(list);
  return result;
}

static abbe_result read_part(const reader *r, abbe_yaml_node node, abbe_sweep_grid *out) {
  const struct {
    const char *key;
    size_t most;
    const char *const *names;
    abbe_sweep_values *out;
  } axes[] = {{"profiles", ABBE_SWEEP_PROFILE_COUNT, abbe_sweep_profiles, &out->profiles},
              {"wavelengths", ABBE_RENDER_MAX_WAVELENGTHS, NULL, &out->wavelengths},
              {"photons", ABBE_RENDER_MAX_PHOTONS, NULL, &out->photons},
              {"map", ABBE_RENDER_MAX_MAP, NULL, &out->map},
              {"samples", 4, NULL, &out->samples},
              {"upsample", 4, NULL, &out->upsample},
              {"exits", ABBE_RENDER_MAX_EXITS, NULL, &out->exits},
              {"history", ABBE_RENDER_MAX_HISTORY, NULL, &out->history},
              {"passes", MOST_PASSES, NULL, &out->passes},
              {"fill", ABBE_FILL_COUNT, fill_names, &out->fills},
              {"model", ABBE_MODEL_COUNT, model_names, &out->models},
              {"polygons", ABBE_POLYGONS_ALL + 1, abbe_sweep_polygons, &out->polygons},
              {"direction", ABBE_DIRECTION_COUNT, abbe_sweep_directions, &out->directions}};
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < sizeof axes / sizeof *axes && result == ABBE_OK; i++)
    result = read_values(r, node, axes[i].key, axes[i].most, axes[i].names, axes[i].out);
  if (result == ABBE_OK) result = read_shares(r, node, out);
  if (result == ABBE_OK)
    result = abbe_yaml_get_bool(r->yaml, node, "meshes", &out->meshes, r->error);
  return result == ABBE_OK ? abbe_yaml_check_keys(r->yaml, node, "part of a grid", r->error)
                           : result;
}

/* Exits and shares that plans have by themselves, stated, so that no scene's plan takes others. */
static void fix_exits_and_shares(abbe_sweep_grid *g) {
  const size_t exits = g->models.count > 0 ? ABBE_PLAN_LAYER_EXITS : ABBE_PLAN_EXITS;
  if (g->exits.count == 0) g->exits = (abbe_sweep_values){1, {exits}};
  if (g->share_count == 0) g->share[g->share_count++] = ABBE_PLAN_SHARE;
}

static abbe_result read_grid(const reader *r, abbe_yaml_node node, abbe_sweep_named_grid *out) {
  abbe_yaml_node parts;
  char *name = NULL, *what = NULL;
  bool fixed = false;
  abbe_result result = abbe_yaml_get_name(r->yaml, node, "name", &name, r->error);
  if (result == ABBE_OK && (name == NULL || strlen(name) >= sizeof out->name))
    result = abbe_yaml_fail(r->yaml, node, r->error, "a grid has a name of at most %zu letters",
                            sizeof out->name - 1);
  if (result == ABBE_OK) snprintf(out->name, sizeof out->name, "%s", name);
  if (result == ABBE_OK) result = abbe_yaml_get_string(r->yaml, node, "what", &what, r->error);
  if (result == ABBE_OK) result = abbe_yaml_get_bool(r->yaml, node, "fixed", &fixed, r->error);
  if (result == ABBE_OK) result = abbe_yaml_require(r->yaml, node, "parts", &parts, r->error);
  free(name);
  free(what);
  if (result != ABBE_OK) return result;
  size_t count = abbe_yaml_count(r->yaml, parts);
  if (!abbe_yaml_is_sequence(r->yaml, parts) || count < 1 || count > ABBE_SWEEP_MAX_PARTS)
    return abbe_yaml_fail(r->yaml, parts, r->error, "'parts' is a list of 1 to %d",
                          ABBE_SWEEP_MAX_PARTS);
  out->part = calloc(count, sizeof *out->part);
  if (out->part == NULL) return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for grids");
  for (; out->count < count && result == ABBE_OK; out->count++) {
    result = read_part(r, abbe_yaml_item(r->yaml, parts, out->count), &out->part[out->count]);
    if (fixed) fix_exits_and_shares(&out->part[out->count]);
  }
  return result == ABBE_OK ? abbe_yaml_check_keys(r->yaml, node, "grid", r->error) : result;
}

static abbe_result read_all(const reader *r, abbe_sweep_grids *out) {
  abbe_yaml_node root = abbe_yaml_root(r->yaml), list;
  abbe_result result = abbe_yaml_require(r->yaml, root, "grids", &list, r->error);
  if (result != ABBE_OK) return result;
  size_t count = abbe_yaml_count(r->yaml, list);
  if (!abbe_yaml_is_sequence(r->yaml, list) || count < 1 || count > ABBE_SWEEP_MAX_GRIDS)
    return abbe_yaml_fail(r->yaml, list, r->error, "'grids' is a list of 1 to %d",
                          ABBE_SWEEP_MAX_GRIDS);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = read_grid(r, abbe_yaml_item(r->yaml, list, i), &out->grid[out->count++]);
  return result == ABBE_OK ? abbe_yaml_check_keys(r->yaml, root, "file", r->error) : result;
}

abbe_result abbe_sweep_grids_load(const char *path, abbe_sweep_grids *out, abbe_error *error) {
  reader r = {.error = error};
  *out = (abbe_sweep_grids){0};
  abbe_result result = path != NULL ? abbe_yaml_load(path, &r.yaml, error)
                                    : abbe_yaml_parse((const char *)abbe_embedded_grids_yaml,
                                                      abbe_embedded_grids_yaml_size,
                                                      "the shipped grids", &r.yaml, error);
  if (result == ABBE_OK) result = read_all(&r, out);
  abbe_yaml_free(r.yaml);
  if (result != ABBE_OK) abbe_sweep_grids_free(out);
  return result;
}

void abbe_sweep_grids_free(abbe_sweep_grids *grids) {
  if (grids == NULL) return;
  for (size_t i = 0; i < grids->count; i++) free(grids->grid[i].part);
  *grids = (abbe_sweep_grids){0};
}

/* ---- what a scene makes of them ---- */

typedef struct expansion {
  const abbe_scene *scene;
  abbe_sweep_setting *list;
  size_t count, refused;
  abbe_error *why;
  abbe_result traceable; /* result for the scene, once it was checked */
  bool asked;
} expansion;

static size_t length_of(const abbe_sweep_values *values) {
  return values->count > 0 ? values->count : 1;
}

/* The value of a mixed counter's digit; 0, the default, where the axis has none. */
static size_t take(const abbe_sweep_values *values, size_t *counter) {
  size_t length = length_of(values), digit = *counter % length;
  *counter /= length;
  return values->count > 0 ? values->value[digit] : 0;
}

/* ABBE_OK for what is left out, unless memory is short. */
static abbe_result refuse(expansion *e, abbe_result result, const abbe_error *why,
                          abbe_error *error) {
  if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s", why->text);
  if (e->refused++ == 0 && e->why != NULL) *e->why = *why;
  return ABBE_OK;
}

static abbe_result add_setting(expansion *e, const abbe_sweep_setting *setting, abbe_error *error) {
  for (size_t i = 0; i < e->count; i++)
    if (abbe_sweep_setting_same(&e->list[i], setting)) return ABBE_OK;
  if (e->count == ABBE_SWEEP_MAX_ROWS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the grid has more than %d settings; give shorter lists",
                          ABBE_SWEEP_MAX_ROWS);
  e->list[e->count++] = *setting;
  return ABBE_OK;
}

static abbe_result add_render(expansion *e, const abbe_render_desc *desc, abbe_error *error) {
  abbe_plan plan;
  abbe_sweep_setting setting;
  abbe_error why = {0};
  abbe_result result = abbe_plan_make(e->scene, desc, &plan, &why);
  if (result != ABBE_OK) return refuse(e, result, &why, error);
  abbe_sweep_setting_of(&plan.desc, &setting);
  abbe_plan_free(&plan);
  return add_setting(e, &setting, error);
}

static abbe_result add_trace(expansion *e, size_t photons, size_t passes, bool filtered,
                             abbe_error *error) {
  abbe_sweep_setting setting;
  abbe_error why = {0};
  if (!e->asked) e->traceable = abbe_sweep_trace_check(e->scene, &why);
  e->asked = true;
  if (e->traceable != ABBE_OK) return refuse(e, e->traceable, &why, error);
  abbe_sweep_setting_of_trace(photons > 0 ? photons : ABBE_SWEEP_TRACE_PHOTONS,
                              passes > 0 ? passes : ABBE_SWEEP_TRACE_PASSES, filtered, &setting);
  return add_setting(e, &setting, error);
}

static bool has_mesh(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR &&
        scene->object[i].exact.kind == ABBE_EXACT_NONE)
      return true;
  return false;
}

static abbe_result add_grid(expansion *e, const abbe_sweep_grid *g, abbe_error *error) {
  size_t shares = g->share_count > 0 ? g->share_count : 1, total = shares;
  const abbe_sweep_values *const axes[] = {
      &g->profiles, &g->wavelengths, &g->photons,   &g->map,    &g->samples,
      &g->upsample, &g->exits,       &g->fills,     &g->models, &g->passes,
      &g->history,  &g->polygons,    &g->directions};
  for (size_t i = 0; i < sizeof axes / sizeof *axes; i++) total *= length_of(axes[i]);
  abbe_result result = ABBE_OK;
  if (g->meshes && !has_mesh(e->scene)) return ABBE_OK;
  for (size_t i = 0; i < total && result == ABBE_OK; i++) {
    size_t counter = i;
    abbe_render_desc d = {.wavelengths = take(&g->wavelengths, &counter)};
    d.photons = take(&g->photons, &counter);
    d.map_size = take(&g->map, &counter);
    d.supersample = take(&g->samples, &counter);
    d.upsample = take(&g->upsample, &counter);
    d.exits = take(&g->exits, &counter);
    d.fill = (abbe_fill)take(&g->fills, &counter);
    d.model = (abbe_model)take(&g->models, &counter);
    const size_t profile = take(&g->profiles, &counter), passes = take(&g->passes, &counter);
    const size_t history = take(&g->history, &counter);
    d.polygons = (unsigned)take(&g->polygons, &counter);
    d.direction = (abbe_direction)take(&g->directions, &counter);
    d.history = history > 1 ? history : 0; /* which alone all profiles know */
    const bool by_pinholes = profile >= ABBE_SWEEP_PROFILE_PINHOLE;
    d.profile = by_pinholes ? ABBE_PROFILE_DEFAULT : (abbe_profile)profile;
    d.transport = by_pinholes ? ABBE_TRANSPORT_PINHOLE : ABBE_TRANSPORT_AUTO;
    d.pinholes = by_pinholes ? pinholes[profile - ABBE_SWEEP_PROFILE_PINHOLE] : 0;
    if (g->share_count > 0) d.energy_share = g->share[counter % shares];
    result =
        profile < ABBE_PROFILE_COUNT || by_pinholes
            ? add_render(e, &d, error)
            : add_trace(e, d.photons, passes, profile == ABBE_SWEEP_PROFILE_TRACE_FILTER, error);
  }
  return result;
}

abbe_result abbe_sweep_grid_expand(const abbe_scene *scene, const abbe_sweep_grid *grids,
                                   size_t count, abbe_sweep_setting **out, size_t *out_count,
                                   size_t *refused, abbe_error *why, abbe_error *error) {
  abbe_error first = {0};
  expansion e = {.scene = scene, .why = &first};
  *out = NULL;
  *out_count = *refused = 0;
  e.list = calloc(ABBE_SWEEP_MAX_ROWS, sizeof *e.list);
  abbe_result result = ABBE_OK;
  if (e.list == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the grid");
  for (size_t i = 0; i < count && result == ABBE_OK; i++) result = add_grid(&e, &grids[i], error);
  if (result == ABBE_OK && e.count == 0)
    result =
        abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                       "no setting of the grid can be drawn for this scene: %.600s", first.text);
  if (result != ABBE_OK) {
    free(e.list);
    return result;
  }
  if (why != NULL) *why = first;
  *out = e.list;
  *out_count = e.count;
  *refused = e.refused;
  return ABBE_OK;
}
