#include "validation/sweep/sweep_measure.h"

#include "gl/accuracy/frame_times.h"
#include "library/choice/sweep_setting.h"
#include "library/choice/sweep_trace.h"
#include "scenes/view/map_resample.h"
#include "validation/compare/compare.h"

#include <math.h>
#include <string.h>

enum { PARTS = 4, CAMERA_FRAMES = 3 };

static const double enough_ms = 3000;

/* Times */

/* What is bridged while it is deposited is in the ledger, which sums the map itself. */
static void note_balance(const abbe_ledger *e, abbe_sweep_row *out) {
  double parts =
      e->reflected + e->absorbed + e->trapped + e->missed + e->deposited - e->interpolated;
  if (!(e->deposited > 0)) return;
  out->number[ABBE_SWEEP_FILL_INVENTED] = fmax(parts - e->reached, 0) / e->deposited;
  out->number[ABBE_SWEEP_FILL_LOST] = fmax(e->reached - parts, 0) / e->deposited;
}

/* Slow frames are not drawn as often, for they vary less. */
static abbe_result time_frames(const abbe_sweep *s, abbe_renderer *renderer,
                               abbe_render_progress progress, void *user, abbe_sweep_row *out,
                               abbe_error *error) {
  abbe_frame_times times;
  const abbe_frame_times_desc desc = {
      .frames = s->frames, .enough_ms = enough_ms, .progress = progress, .user = user};
  abbe_result result = abbe_frame_times_measure(renderer, &desc, &times, error);
  if (result != ABBE_OK) return result;
  note_balance(&times.median.energy, out);
  out->number[ABBE_SWEEP_FRAME_MS] = times.median.frame_ms;
  out->number[ABBE_SWEEP_FASTEST_MS] = times.fastest_ms;
  out->number[ABBE_SWEEP_LIGHT_MS] = abbe_statistics_stage_ms(&times.median, ABBE_STAGE_LIGHT);
  out->number[ABBE_SWEEP_EYE_MS] = abbe_statistics_stage_ms(&times.median, ABBE_STAGE_EYE);
  out->number[ABBE_SWEEP_PHOTONS_HIT] = (double)times.median.photons;
  out->number[ABBE_SWEEP_HIT_SHARE] = times.median.refractor_share;
  if (times.median.polygon_layers > 0) out->number[ABBE_SWEEP_LAYERS] = times.median.polygon_layers;
  if (abbe_method_of(abbe_renderer_plan(renderer)->desc.profile)->own_passes) return ABBE_OK;
  return abbe_frame_times_baseline(renderer, 3, &out->number[ABBE_SWEEP_BASELINE_MS], error);
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

/* The errors of a new renderer's first frames, where each takes those before. */
static abbe_result compare_history(const abbe_sweep *s, abbe_renderer *renderer, bool scaled,
                                   abbe_sweep_row *out, abbe_error *error) {
  static const abbe_sweep_number after[9] = {[1] = ABBE_SWEEP_AFTER_1,
                                             [2] = ABBE_SWEEP_AFTER_2,
                                             [4] = ABBE_SWEEP_AFTER_4,
                                             [8] = ABBE_SWEEP_AFTER_8};
  abbe_result result = ABBE_OK;
  if (s->picture == NULL || !abbe_sweep_setting_has_history(&out->setting)) return ABBE_OK;
  for (size_t frame = 1; frame <= 8 && result == ABBE_OK; frame++) {
    abbe_image drawn = {0};
    abbe_comparison c;
    abbe_renderer_redraw(renderer);
    result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
    if (result != ABBE_OK || after[frame] == 0) continue;
    result = abbe_renderer_read(renderer, false, &drawn, error);
    if (result == ABBE_OK) result = compare(s->picture, &drawn, scaled, &c, error);
    abbe_image_free(&drawn);
    if (result != ABBE_OK) continue;
    if (c.masked) out->number[after[frame]] = c.mask.metric[ABBE_COMPARE_CIEDE2000_MEAN].value;
    abbe_comparison_free(&c);
  }
  return result;
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
  bool thesis = abbe_method_of(plan->desc.profile)->own_passes;
  const bool whole = thesis || plan->desc.history > 1; /* bands are of one frame */
  if (!plan->caustics || s->light >= plan->light_view_count) return ABBE_OK;
  if (thesis && plan->desc.faces > 1) return ABBE_OK; /* a cube has no one layout */
  if (s->map == NULL && abbe_method_of(plan->desc.profile)->fill != ABBE_FILL_SMEAR) return ABBE_OK;
  abbe_result result =
      whole ? abbe_renderer_read_map(renderer, s->light, true, &map, error)
            : abbe_renderer_read_map_bands(renderer, s->light, ABBE_SWEEP_BANDS, &map, error);
  if (result == ABBE_OK && thesis) {
    result = abbe_renderer_read_map(renderer, s->light, false, &before, error);
    if (result == ABBE_OK) note_fill(&before, &map, out);
  }
  if (result == ABBE_OK && s->map != NULL)
    result = compare_map(s, &map, abbe_method_of(plan->desc.profile)->printed, thesis, out, error);
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
  if (s->map == NULL || abbe_method_of(out->profile)->own_passes) return ABBE_OK;
  out->map_layout = layout;
  out->map_layout_light = s->light;
  return abbe_map_layout_read(s->map, "the reference", layout, error);
}

static void clear_row(const abbe_sweep_setting *setting, abbe_sweep_row *out) {
  *out = (abbe_sweep_row){.setting = *setting};
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) out->number[i] = NAN;
}

static abbe_result measure_trace(const abbe_sweep *s, abbe_render_progress progress, void *user,
                                 abbe_sweep_row *out, abbe_image *picture, abbe_error *error) {
  const abbe_sweep_trace_desc desc = {.width = s->picture != NULL ? s->picture->width : 0,
                                      .height = s->picture != NULL ? s->picture->height : 0,
                                      .frames = s->frames,
                                      .enough_ms = enough_ms,
                                      .progress = progress,
                                      .user = user};
  abbe_result result = abbe_sweep_trace_measure(s->scene, &desc, out, picture, error);
  if (result == ABBE_OK && s->picture != NULL)
    result = compare_picture(s, picture, false, out, error);
  return result;
}

static abbe_result measure_frames(const abbe_sweep *s, const abbe_sweep_setting *setting,
                                  abbe_render_progress progress, void *user, abbe_sweep_row *out,
                                  abbe_image *drawn, abbe_error *error) {
  abbe_map_layout layout;
  abbe_render_desc desc;
  abbe_renderer *renderer = NULL;
  abbe_result result = make_desc(s, setting, &layout, &desc, error);
  bool scaled = abbe_method_of(desc.profile)->printed;
  if (result == ABBE_OK) result = abbe_renderer_make(s->context, s->scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = compare_history(s, renderer, scaled, out, error);
  if (result == ABBE_OK) result = time_frames(s, renderer, progress, user, out, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, drawn, error);
  if (result == ABBE_OK && s->picture != NULL)
    result = compare_picture(s, drawn, scaled, out, error);
  if (result == ABBE_OK)
    result = compare_matched(s->matched_picture, drawn, scaled, ABBE_COMPARE_CIEDE2000_MEAN,
                             ABBE_SWEEP_MATCHED_DE, out, error);
  if (result == ABBE_OK) result = measure_map(s, renderer, out, error);
  if (result == ABBE_OK)
    result = abbe_frame_times_camera(renderer, s->scene, &desc, CAMERA_FRAMES,
                                     &out->number[ABBE_SWEEP_CAMERA_MS], error);
  abbe_renderer_free(renderer);
  return result;
}

abbe_result abbe_sweep_measure(const abbe_sweep *s, const abbe_sweep_setting *setting,
                               abbe_render_progress progress, void *user, abbe_sweep_row *out,
                               abbe_image *picture, abbe_error *error) {
  abbe_image own = {0}, *drawn = picture != NULL ? picture : &own;
  *drawn = (abbe_image){0};
  clear_row(setting, out);
  abbe_result result = abbe_sweep_setting_is_traced(setting)
                           ? measure_trace(s, progress, user, out, drawn, error)
                           : measure_frames(s, setting, progress, user, out, drawn, error);
  abbe_image_free(&own);
  if (result != ABBE_OK && picture != NULL) abbe_image_free(picture);
  return result;
}

abbe_result abbe_sweep_compare_picture(const abbe_sweep *s, const abbe_image *picture, bool scaled,
                                       abbe_sweep_row *out, abbe_error *error) {
  const abbe_sweep_setting none = {.photons = 0};
  clear_row(&none, out);
  return compare_picture(s, picture, scaled, out, error);
}

abbe_result abbe_sweep_time(const abbe_sweep *s, const abbe_sweep_setting *setting, size_t width,
                            size_t height, abbe_sweep_row *out, abbe_error *error) {
  abbe_render_desc desc;
  abbe_renderer *renderer = NULL;
  clear_row(setting, out);
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
