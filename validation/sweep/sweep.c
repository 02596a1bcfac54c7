#include "validation/sweep/sweep.h"

#include "gl/renderer.h"
#include "scenes/view/map_resample.h"
#include "validation/compare/compare.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_FRAMES = 5, ENOUGH_FRAMES = 3, MAX_FRAMES = 1000, PARTS = 4, INDEX_STEPS = 9 };

static const double enough_ms = 3000;

/* Settings */

void abbe_sweep_setting_of(const abbe_render_desc *d, abbe_sweep_setting *out) {
  bool thesis = abbe_profile_is_thesis(d->profile);
  *out = (abbe_sweep_setting){.wavelengths = d->wavelengths,
                              .photons = d->photons,
                              .map = d->map_size,
                              /* without effect there: one setting whatever was asked */
                              .samples = thesis ? 1 : d->supersample,
                              .upsample = d->upsample,
                              .share = thesis ? 0.01 : d->energy_share,
                              .exits = d->exits};
  snprintf(out->profile, sizeof out->profile, "%s", abbe_profile_name(d->profile));
  snprintf(out->fill, sizeof out->fill, "%s", abbe_fill_name(d->fill));
  snprintf(out->model, sizeof out->model, "%s", abbe_model_name(d->model));
}

abbe_result abbe_sweep_setting_desc(const abbe_sweep_setting *setting, abbe_render_desc *out,
                                    abbe_error *error) {
  ABBE_REQUIRE(setting && out, error);
  int profile = 0, fill = 0, model = 0;
  while (profile < ABBE_PROFILE_COUNT &&
         strcmp(abbe_profile_name((abbe_profile)profile), setting->profile) != 0)
    profile++;
  while (fill < ABBE_FILL_COUNT && strcmp(abbe_fill_name((abbe_fill)fill), setting->fill) != 0)
    fill++;
  while (model < ABBE_MODEL_COUNT &&
         strcmp(abbe_model_name((abbe_model)model), setting->model) != 0)
    model++;
  *out = (abbe_render_desc){0};
  if (profile == ABBE_PROFILE_COUNT || fill == ABBE_FILL_COUNT || model == ABBE_MODEL_COUNT)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the renderer has no profile '%s' with a fill '%s' and a model '%s'",
                          setting->profile, setting->fill, setting->model);
  *out = (abbe_render_desc){.profile = (abbe_profile)profile,
                            .wavelengths = setting->wavelengths,
                            .photons = setting->photons,
                            .map_size = setting->map,
                            .supersample = setting->samples,
                            .upsample = setting->upsample,
                            .fill = (abbe_fill)fill,
                            .model = (abbe_model)model,
                            .energy_share = setting->share,
                            .exits = setting->exits};
  return ABBE_OK;
}

typedef struct expansion {
  const abbe_scene *scene;
  abbe_sweep_setting *list;
  size_t count, refused;
  abbe_error *why;
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

static abbe_result add_setting(expansion *e, const abbe_render_desc *desc, abbe_error *error) {
  abbe_plan plan;
  abbe_sweep_setting setting;
  abbe_error why = {0};
  abbe_result result = abbe_plan_make(e->scene, desc, &plan, &why);
  if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s", why.text);
  if (result != ABBE_OK) {
    if (e->refused++ == 0 && e->why != NULL) *e->why = why;
    return ABBE_OK;
  }
  abbe_sweep_setting_of(&plan.desc, &setting);
  abbe_plan_free(&plan);
  for (size_t i = 0; i < e->count; i++)
    if (abbe_sweep_setting_same(&e->list[i], &setting)) return ABBE_OK;
  if (e->count == ABBE_SWEEP_MAX_ROWS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the grid has more than %d settings; give shorter lists",
                          ABBE_SWEEP_MAX_ROWS);
  e->list[e->count++] = setting;
  return ABBE_OK;
}

static bool has_mesh(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].material != NULL && scene->object[i].exact.kind == ABBE_EXACT_NONE)
      return true;
  return false;
}

static abbe_result add_grid(expansion *e, const abbe_sweep_grid *g, abbe_error *error) {
  size_t shares = g->share_count > 0 ? g->share_count : 1, total = shares;
  const abbe_sweep_values *const axes[] = {&g->profiles, &g->wavelengths, &g->photons,
                                           &g->map,      &g->samples,     &g->upsample,
                                           &g->exits,    &g->fills,       &g->models};
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
    d.profile = (abbe_profile)take(&g->profiles, &counter);
    if (g->share_count > 0) d.energy_share = g->share[counter % shares];
    result = add_setting(e, &d, error);
  }
  return result;
}

abbe_result abbe_sweep_grid_expand(const abbe_scene *scene, const abbe_sweep_grid *grids,
                                   size_t count, abbe_sweep_setting **out, size_t *out_count,
                                   size_t *refused, abbe_error *why, abbe_error *error) {
  ABBE_REQUIRE(scene && grids && out && out_count && refused, error);
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

/* Times */

static int by_time(const void *a, const void *b) {
  double x = ((const abbe_statistics *)a)->frame_ms, y = ((const abbe_statistics *)b)->frame_ms;
  return (x > y) - (x < y);
}

static void note_times(const abbe_statistics *sorted, size_t count, abbe_sweep_row *out) {
  const abbe_statistics *median = &sorted[count / 2];
  out->number[ABBE_SWEEP_FRAME_MS] = median->frame_ms;
  out->number[ABBE_SWEEP_FASTEST_MS] = sorted[0].frame_ms;
  out->number[ABBE_SWEEP_LIGHT_MS] = abbe_statistics_stage_ms(median, ABBE_STAGE_LIGHT);
  out->number[ABBE_SWEEP_EYE_MS] = abbe_statistics_stage_ms(median, ABBE_STAGE_EYE);
}

/* What is bridged while it is deposited is in the ledger, which sums the map itself. */
static void note_balance(const abbe_ledger *e, abbe_sweep_row *out) {
  double parts =
      e->reflected + e->absorbed + e->trapped + e->missed + e->deposited - e->interpolated;
  if (!(e->deposited > 0)) return;
  out->number[ABBE_SWEEP_FILL_INVENTED] = fmax(parts - e->reached, 0) / e->deposited;
  out->number[ABBE_SWEEP_FILL_LOST] = fmax(e->reached - parts, 0) / e->deposited;
}

/* A warming frame, then the median of the others; slow ones are not drawn as often, for they vary
 * less. The floor is the median of three. */
static abbe_result time_frames(const abbe_sweep *s, abbe_renderer *renderer,
                               abbe_render_progress progress, void *user, abbe_sweep_row *out,
                               abbe_error *error) {
  size_t count = s->frames > 0 ? s->frames : DEFAULT_FRAMES;
  if (count > MAX_FRAMES) count = MAX_FRAMES;
  double spent_ms = 0;
  abbe_statistics *all = calloc(count, sizeof *all);
  if (all == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the times");
  abbe_result result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    if (progress != NULL && !progress(user, (double)i / (double)count))
      result = abbe_error_set(error, ABBE_CANCELLED, "stopped");
    if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, &all[i], error);
    spent_ms += all[i].frame_ms;
    if (result == ABBE_OK && i + 1 >= ENOUGH_FRAMES && spent_ms > enough_ms) count = i + 1;
  }
  if (result == ABBE_OK) {
    note_balance(&all[0].energy, out);
    qsort(all, count, sizeof *all, by_time);
    note_times(all, count, out);
  }
  free(all);
  double floor_ms[3] = {NAN, NAN, NAN};
  bool thesis = abbe_profile_is_thesis(abbe_renderer_plan(renderer)->desc.profile);
  for (int i = 0; i < 3 && !thesis && result == ABBE_OK; i++)
    result = abbe_renderer_floor(renderer, &floor_ms[i], error);
  if (result == ABBE_OK && !thesis)
    out->number[ABBE_SWEEP_FLOOR_MS] =
        fmax(fmin(floor_ms[0], floor_ms[1]), fmin(fmax(floor_ms[0], floor_ms[1]), floor_ms[2]));
  return result;
}

/* Errors */

static void note(abbe_sweep_row *out, abbe_sweep_number number, const abbe_compare_value *value) {
  out->number[number] = value->value;
  out->number[number + 1] = value->noise;
}

/* With the factor of least squares; where none above 0 brings the two nearer, that is 0: black. */
static abbe_result compare_scaled(const abbe_field *reference, abbe_field *test,
                                  abbe_compare_options options, abbe_comparison *out,
                                  abbe_error *error) {
  options.best_scale = true;
  abbe_result result = abbe_compare(reference, test, &options, out, error);
  if (result != ABBE_INVALID_ARGUMENT) return result;
  size_t count = test->width * test->height * test->colour.channels;
  for (size_t i = 0; i < count; i++) test->colour.value[i] = 0;
  options.best_scale = false;
  result = abbe_compare(reference, test, &options, out, error);
  out->scale = 0;
  return result;
}

/* Compares what was drawn with the reference, over all of it and over the reference's caustic. A
 * caustic that is dark has no region. */
static abbe_result compare(const abbe_image *reference, const abbe_image *test, bool scaled,
                           abbe_comparison *out, abbe_error *error) {
  abbe_field fields[2] = {{0}, {0}};
  abbe_mask mask = {0};
  abbe_compare_options options = {0};
  abbe_result result = abbe_field_make(reference, "the reference", &fields[0], error);
  if (result == ABBE_OK) result = abbe_field_make(test, "the picture", &fields[1], error);
  if (result == ABBE_OK)
    result = abbe_field_align(&fields[0], "the reference", &fields[1], "the picture", error);
  if (result == ABBE_OK && abbe_mask_make_caustic(&fields[0], "the reference",
                                                  ABBE_MASK_CAUSTIC_SHARE, &mask, NULL) == ABBE_OK)
    options.mask = &mask;
  if (result == ABBE_OK)
    result = scaled ? compare_scaled(&fields[0], &fields[1], options, out, error)
                    : abbe_compare(&fields[0], &fields[1], &options, out, error);
  abbe_mask_free(&mask);
  abbe_field_free(&fields[0]);
  abbe_field_free(&fields[1]);
  return result;
}

static abbe_result compare_picture(const abbe_sweep *s, const abbe_image *picture, bool scaled,
                                   abbe_sweep_row *out, abbe_error *error) {
  abbe_comparison c;
  abbe_result result = compare(s->picture, picture, scaled, &c, error);
  if (result != ABBE_OK) return result;
  out->number[ABBE_SWEEP_SCALE] = c.scale;
  note(out, ABBE_SWEEP_PICTURE_DE, &c.whole.metric[ABBE_COMPARE_CIEDE2000_MEAN]);
  note(out, ABBE_SWEEP_PICTURE_DE95, &c.whole.metric[ABBE_COMPARE_CIEDE2000_P95]);
  note(out, ABBE_SWEEP_PICTURE_RMSE, &c.whole.metric[ABBE_COMPARE_RELATIVE_RMSE]);
  if (c.masked) {
    note(out, ABBE_SWEEP_CAUSTIC_DE, &c.mask.metric[ABBE_COMPARE_CIEDE2000_MEAN]);
    note(out, ABBE_SWEEP_CAUSTIC_DE95, &c.mask.metric[ABBE_COMPARE_CIEDE2000_P95]);
    note(out, ABBE_SWEEP_CAUSTIC_RMSE, &c.mask.metric[ABBE_COMPARE_RELATIVE_RMSE]);
  }
  abbe_comparison_free(&c);
  return ABBE_OK;
}

/* A map in the reference's layout whose texels make whole ones of it stays as it is. */
static abbe_result fit_map(const abbe_sweep *s, abbe_image *map, bool own_layout,
                           abbe_error *error) {
  size_t width = s->map->width, height = s->map->height;
  if (!own_layout && map->width % width == 0 && map->height % height == 0) return ABBE_OK;
  abbe_map_layout layout;
  abbe_image moved;
  size_t parts = PARTS * (1 + (width - 1) / map->width);
  if (parts > ABBE_MAP_RESAMPLE_MAX_PARTS) parts = ABBE_MAP_RESAMPLE_MAX_PARTS;
  abbe_result result = abbe_map_layout_read(s->map, "the reference", &layout, error);
  if (result == ABBE_OK)
    result = abbe_map_resample(map, "the map", &layout, width, height, parts, &moved, error);
  if (result != ABBE_OK) return result;
  abbe_image_free(map);
  *map = moved;
  return ABBE_OK;
}

/* The same against what the model keeps of the light. */
static abbe_result compare_matched(const abbe_image *reference, const abbe_image *test, bool scaled,
                                   abbe_compare_metric metric, abbe_sweep_number number,
                                   abbe_sweep_row *out, abbe_error *error) {
  abbe_comparison c;
  if (reference == NULL) return ABBE_OK;
  abbe_result result = compare(reference, test, scaled, &c, error);
  if (result != ABBE_OK) return result;
  note(out, number, &(c.masked ? &c.mask : &c.whole)->metric[metric]);
  abbe_comparison_free(&c);
  return ABBE_OK;
}

static abbe_result compare_map(const abbe_sweep *s, abbe_image *map, bool scaled, bool own_layout,
                               abbe_sweep_row *out, abbe_error *error) {
  abbe_comparison c;
  abbe_result result = fit_map(s, map, own_layout, error);
  if (result == ABBE_OK)
    result = compare_matched(s->matched_map, map, scaled, ABBE_COMPARE_RELATIVE_RMSE,
                             ABBE_SWEEP_MATCHED_MAP, out, error);
  if (result == ABBE_OK) result = compare(s->map, map, scaled, &c, error);
  if (result != ABBE_OK) return result;
  const abbe_compare_region *region = c.masked ? &c.mask : &c.whole;
  out->number[ABBE_SWEEP_MAP_SCALE] = c.scale;
  note(out, ABBE_SWEEP_MAP_RMSE, &region->metric[ABBE_COMPARE_RELATIVE_RMSE]);
  note(out, ABBE_SWEEP_MAP_BANDS, &region->metric[ABBE_COMPARE_BANDS_RELATIVE_RMSE]);
  note(out, ABBE_SWEEP_MAP_UV, &region->metric[ABBE_COMPARE_UV_MEAN]);
  note(out, ABBE_SWEEP_MAP_ENERGY, &c.whole.metric[ABBE_COMPARE_ENERGY_RATIO]);
  abbe_comparison_free(&c);
  return ABBE_OK;
}

/* The fill */

/* What a pass that fills the map adds to it here and takes off there, by its brightest-weighted
 * channel: Y, or green. */
static void note_fill(const abbe_image *before, const abbe_image *after, abbe_sweep_row *out) {
  double sum = 0, more = 0, less = 0;
  for (size_t i = 0; i < before->width * before->height; i++) {
    double a = (double)before->data[3 * i + 1], b = (double)after->data[3 * i + 1];
    sum += a;
    more += fmax(b - a, 0);
    less += fmax(a - b, 0);
  }
  if (!(sum > 0)) return;
  out->number[ABBE_SWEEP_FILL_INVENTED] = more / sum;
  out->number[ABBE_SWEEP_FILL_LOST] = less / sum;
}

static abbe_result measure_map(const abbe_sweep *s, abbe_renderer *renderer, abbe_sweep_row *out,
                               abbe_error *error) {
  abbe_image map = {0}, before = {0};
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  if (!plan->caustics || s->light >= plan->light_view_count) return ABBE_OK;
  abbe_result result =
      thesis ? abbe_renderer_read_map(renderer, s->light, true, &map, error)
             : abbe_renderer_read_map_bands(renderer, s->light, ABBE_SWEEP_BANDS, &map, error);
  if (result == ABBE_OK && thesis) {
    result = abbe_renderer_read_map(renderer, s->light, false, &before, error);
    if (result == ABBE_OK) note_fill(&before, &map, out);
  }
  if (result == ABBE_OK && s->map != NULL)
    result = compare_map(s, &map, plan->desc.profile == ABBE_PROFILE_THESIS, thesis, out, error);
  abbe_image_free(&map);
  abbe_image_free(&before);
  return result;
}

/* One setting */

static abbe_result make_desc(const abbe_sweep *s, const abbe_sweep_setting *setting,
                             abbe_map_layout *layout, abbe_render_desc *out, abbe_error *error) {
  abbe_result result = abbe_sweep_setting_desc(setting, out, error);
  if (result != ABBE_OK) return result;
  out->width = s->picture != NULL ? s->picture->width : 0;
  out->height = s->picture != NULL ? s->picture->height : 0;
  if (s->map == NULL || abbe_profile_is_thesis(out->profile)) return ABBE_OK;
  out->map_layout = layout;
  out->map_layout_light = s->light;
  return abbe_map_layout_read(s->map, "the reference", layout, error);
}

abbe_result abbe_sweep_measure(const abbe_sweep *s, const abbe_sweep_setting *setting,
                               abbe_render_progress progress, void *user, abbe_sweep_row *out,
                               abbe_image *picture, abbe_error *error) {
  ABBE_REQUIRE(s && setting && out, error);
  abbe_map_layout layout;
  abbe_render_desc desc;
  abbe_renderer *renderer = NULL;
  abbe_image own = {0}, *drawn = picture != NULL ? picture : &own;
  *drawn = (abbe_image){0};
  *out = (abbe_sweep_row){.setting = *setting};
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) out->number[i] = NAN;
  abbe_result result = make_desc(s, setting, &layout, &desc, error);
  bool scaled = desc.profile == ABBE_PROFILE_THESIS;
  if (result == ABBE_OK) result = abbe_renderer_make(s->context, s->scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = time_frames(s, renderer, progress, user, out, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, drawn, error);
  if (result == ABBE_OK && s->picture != NULL)
    result = compare_picture(s, drawn, scaled, out, error);
  if (result == ABBE_OK)
    result = compare_matched(s->matched_picture, drawn, scaled, ABBE_COMPARE_CIEDE2000_MEAN,
                             ABBE_SWEEP_MATCHED_DE, out, error);
  if (result == ABBE_OK) result = measure_map(s, renderer, out, error);
  abbe_renderer_free(renderer);
  abbe_image_free(&own);
  if (result != ABBE_OK && picture != NULL) abbe_image_free(picture);
  return result;
}

abbe_result abbe_sweep_time(const abbe_sweep *s, const abbe_sweep_setting *setting, size_t width,
                            size_t height, abbe_sweep_row *out, abbe_error *error) {
  ABBE_REQUIRE(s && setting && out, error);
  abbe_render_desc desc;
  abbe_renderer *renderer = NULL;
  *out = (abbe_sweep_row){.setting = *setting};
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) out->number[i] = NAN;
  abbe_result result = abbe_sweep_setting_desc(setting, &desc, error);
  desc.width = width;
  desc.height = height;
  if (result == ABBE_OK) result = abbe_renderer_make(s->context, s->scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = time_frames(s, renderer, NULL, NULL, out, error);
  abbe_renderer_free(renderer);
  return result;
}

abbe_result abbe_sweep_model_measure(const abbe_sweep *s, abbe_sweep_model *out,
                                     abbe_error *error) {
  ABBE_REQUIRE(s && out, error);
  abbe_comparison picture, map;
  *out = (abbe_sweep_model){NAN, NAN, NAN, NAN, NAN};
  abbe_result result = compare(s->picture, s->matched_picture, false, &picture, error);
  if (result != ABBE_OK) return result;
  const abbe_compare_region *region = picture.masked ? &picture.mask : &picture.whole;
  const abbe_compare_value *de = &region->metric[ABBE_COMPARE_CIEDE2000_MEAN];
  out->de = de->value;
  out->de_noise = isfinite(de->both_noise) ? de->both_noise : de->noise;
  abbe_comparison_free(&picture);
  result = compare(s->map, s->matched_map, false, &map, error);
  if (result != ABBE_OK) return result;
  region = map.masked ? &map.mask : &map.whole;
  const abbe_compare_value *rmse = &region->metric[ABBE_COMPARE_RELATIVE_RMSE];
  out->map = rmse->value;
  out->map_noise = isfinite(rmse->both_noise) ? rmse->both_noise : rmse->noise;
  out->energy = map.whole.metric[ABBE_COMPARE_ENERGY_RATIO].value;
  abbe_comparison_free(&map);
  return ABBE_OK;
}

abbe_result abbe_sweep_fit_layout(abbe_context *context, const abbe_scene *scene, size_t light,
                                  abbe_map_layout *out, abbe_error *error) {
  ABBE_REQUIRE(context && scene && out, error);
  abbe_renderer *renderer = NULL;
  abbe_render_desc desc = {.width = 16, .height = 16};
  abbe_result result = abbe_renderer_make(context, scene, &desc, &renderer, error);
  if (result != ABBE_OK) return result;
  if (!abbe_renderer_plan(renderer)->caustics || light >= scene->light_count)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s has no refractor that a light reaches: there is no map to compare",
                            scene->path);
  else if (abbe_renderer_plan(renderer)->light_view[light].face >= 0)
    result =
        abbe_error_set(error, ABBE_UNSUPPORTED,
                       "the light '%s' of %s has a cube of maps and no single layout to compare "
                       "them by; trace a reference map and render with --map-like",
                       scene->light[light].name, scene->path);
  else
    abbe_renderer_map_layout(renderer, light, out);
  abbe_renderer_free(renderer);
  return result;
}

/* Hashes: FNV-1a, 64 bits */

static unsigned long long hash(unsigned long long h, const void *data, size_t size) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < size; i++) h = (h ^ byte[i]) * 1099511628211u;
  return h & 0xffffffffffffffffu;
}

static const unsigned long long hash_start = 14695981039346656037u;

static unsigned long long hash_object(unsigned long long h, const abbe_object *o) {
  h = hash(h, o->mesh.position, o->mesh.vertex_count * sizeof *o->mesh.position);
  h = hash(h, o->mesh.face, o->mesh.face_count * sizeof *o->mesh.face);
  h = hash(h, o->reflectance, sizeof o->reflectance);
  h = hash(h, o->texture.data,
           o->texture.width * o->texture.height * o->texture.channels * sizeof *o->texture.data);
  for (int i = 0; i < INDEX_STEPS && o->material != NULL; i++) {
    double lambda_nm = 380 + 50.0 * i, n = 0;
    abbe_material_n(o->material, lambda_nm, &n, NULL);
    double numbers[] = {n, abbe_material_attenuation(o->material, lambda_nm)};
    h = hash(h, numbers, sizeof numbers);
  }
  return h;
}

unsigned long long abbe_sweep_hash_scene(const abbe_scene *s) {
  unsigned long long h = hash_start;
  h = hash(h, s->camera.eye, sizeof s->camera.eye);
  h = hash(h, s->camera.target, sizeof s->camera.target);
  h = hash(h, s->camera.up, sizeof s->camera.up);
  const double loose[] = {s->camera.fov_y_rad, s->ambient, s->background};
  h = hash(h, loose, sizeof loose);
  for (size_t i = 0; i < s->light_count; i++) {
    const abbe_light *l = &s->light[i];
    const double numbers[] = {l->kind,         l->position[0],  l->position[1],
                              l->position[2],  l->direction[0], l->direction[1],
                              l->direction[2], l->radius,       l->cone_rad,
                              l->soft_rad,     l->power,        l->illuminant.kind};
    h = hash(h, numbers, sizeof numbers);
    for (int k = 0; k < INDEX_STEPS; k++) {
      double power = abbe_illuminant_power(&l->illuminant, 380 + 50.0 * k);
      h = hash(h, &power, sizeof power);
    }
  }
  for (size_t i = 0; i < s->object_count; i++) h = hash_object(h, &s->object[i]);
  return h;
}

unsigned long long abbe_sweep_hash_images(const abbe_image *picture, const abbe_image *map) {
  const abbe_image *const images[] = {picture, map};
  unsigned long long h = hash_start;
  for (int i = 0; i < 2; i++) {
    if (images[i] == NULL) continue;
    const size_t sizes[] = {images[i]->width, images[i]->height, images[i]->channels};
    h = hash(h, sizes, sizeof sizes);
    h = hash(h, images[i]->data, sizes[0] * sizes[1] * sizes[2] * sizeof *images[i]->data);
  }
  return h;
}
