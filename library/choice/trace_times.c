#include "library/choice/trace_times.h"

#include "base/clock.h"
#include "gl/accuracy/frame_times.h"
#include "gl/plan/plan.h"
#include "validation/measure/compare.h"
#include "validation/trace/denoise.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { USUAL_FRAMES = 5, FEW_FRAMES = 3 };

typedef struct frame {
  double ms, light_ms, eye_ms;
} frame;

/* The picture of a tracer with guides becomes what abbe_denoise_picture makes of it. */
static abbe_result filter(abbe_image *picture, abbe_error *error) {
  abbe_image filtered = {0};
  const abbe_denoise_desc desc = {0};
  ABBE_TRY(abbe_denoise_picture(picture, &desc, &filtered, error));
  abbe_image_free(picture);
  *picture = filtered;
  return ABBE_OK;
}

static abbe_trace_desc describe(const abbe_trace_times_desc *desc) {
  return (abbe_trace_desc){.no_map = true,
                           .guides = desc->filtered,
                           .width = desc->width,
                           .height = desc->height,
                           .photons = desc->photons * desc->photons,
                           .seed = ABBE_TRACE_TIMES_SEED};
}

static bool go_on(const abbe_trace_times_desc *desc, double done) {
  return desc->progress == NULL || desc->progress(desc->user, done);
}

static abbe_result trace(const abbe_scene *scene, const abbe_trace_times_desc *desc, double done,
                         frame *out, abbe_image *half, abbe_image *picture, abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_trace_statistics statistics;
  const abbe_trace_desc own = describe(desc);
  double copied = 0; /* half of it, which no frame has to do */
  abbe_image_free(half);
  abbe_image_free(picture);
  abbe_result result = abbe_tracer_make(scene, &own, &tracer, error);
  const double start = abbe_clock_seconds();
  for (size_t i = 0; i < desc->passes && result == ABBE_OK; i++) {
    if (!go_on(desc, done)) result = abbe_error_set(error, ABBE_CANCELLED, "stopped");
    if (result == ABBE_OK) result = abbe_tracer_pass(tracer, NULL, error);
    if (result != ABBE_OK || 2 * (i + 1) != desc->passes || desc->filtered) continue;
    copied = abbe_clock_seconds();
    result = abbe_tracer_picture(tracer, half, error);
    copied = abbe_clock_seconds() - copied;
  }
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, picture, error);
  if (result == ABBE_OK && desc->filtered) result = filter(picture, error);
  const double end = abbe_clock_seconds();
  if (result == ABBE_OK) {
    abbe_tracer_statistics(tracer, &statistics);
    *out =
        (frame){1e3 * (end - start), 1e3 * statistics.light_seconds, 1e3 * statistics.eye_seconds};
  }
  abbe_tracer_free(tracer);
  return result;
}

static int compare_frames(const void *a, const void *b) {
  const frame *x = a, *y = b;
  return (x->ms > y->ms) - (x->ms < y->ms);
}

static abbe_result copy_image(const abbe_image *in, abbe_image *out) {
  const size_t count = in->width * in->height * in->channels;
  ABBE_TRY(abbe_image_make(in->width, in->height, in->channels, (const char *const *)in->channel,
                           out, NULL));
  memcpy(out->data, in->data, count * sizeof *out->data);
  memcpy(out->xy, in->xy, sizeof out->xy);
  return ABBE_OK;
}

/* The mean over 9 x 9 pixels of the channels that hold the caustic: of few photons the brightest
 * pixels are those that were hit, so without it the region would leave out where light is dim. */
static void smooth_caustic(const abbe_image *in, abbe_image *out) {
  enum { REACH = 4 };
  const size_t w = in->width, h = in->height, n = in->channels;
  for (size_t c = 0; c < n; c++) {
    if (strncmp(in->channel[c], "caustic.", 8) != 0) continue;
    for (size_t y = 0; y < h; y++) {
      for (size_t x = 0; x < w; x++) {
        const size_t x0 = x > REACH ? x - REACH : 0, x1 = x + REACH < w ? x + REACH : w - 1;
        const size_t y0 = y > REACH ? y - REACH : 0, y1 = y + REACH < h ? y + REACH : h - 1;
        float sum = 0;
        for (size_t j = y0; j <= y1; j++)
          for (size_t i = x0; i <= x1; i++) sum += in->data[(j * w + i) * n + c];
        out->data[(y * w + x) * n + c] = sum / (float)((x1 - x0 + 1) * (y1 - y0 + 1));
      }
    }
  }
}

/* The mean of all passes less that of half of them varies as the mean of all does, colours and
 * neighbours together, which standard errors of channels do not contain. */
static double own_error(const abbe_image *half, const abbe_image *picture) {
  static const char name[] = "the picture";
  abbe_field a = {0}, b = {0}, smooth = {0};
  abbe_image copy = {0};
  abbe_mask mask = {0};
  abbe_comparison c;
  const abbe_compare_options options = {.mask = &mask};
  double own = NAN;
  if (copy_image(picture, &copy) != ABBE_OK) return own;
  smooth_caustic(picture, &copy);
  if (abbe_field_make(picture, name, &a, NULL) == ABBE_OK &&
      abbe_field_make(half, name, &b, NULL) == ABBE_OK &&
      abbe_field_make(&copy, name, &smooth, NULL) == ABBE_OK &&
      abbe_mask_make_caustic(&smooth, name, ABBE_MASK_CAUSTIC_SHARE, &mask, NULL) == ABBE_OK &&
      abbe_compare(&a, &b, &options, &c, NULL) == ABBE_OK) {
    own = c.mask.metric[ABBE_COMPARE_CIEDE2000_MEAN].value;
    abbe_comparison_free(&c);
  }
  abbe_mask_free(&mask);
  abbe_field_free(&a);
  abbe_field_free(&b);
  abbe_field_free(&smooth);
  abbe_image_free(&copy);
  return own;
}

abbe_result abbe_trace_times_measure(const abbe_scene *scene, const abbe_trace_times_desc *desc,
                                     abbe_trace_times *out, abbe_image *picture,
                                     abbe_error *error) {
  frame frames[ABBE_FRAME_TIMES_MAX];
  abbe_image image = {0}, half = {0};
  size_t count = desc->frames > 0 ? desc->frames : USUAL_FRAMES, done = 0;
  double spent = 0;
  *out = (abbe_trace_times){NAN, NAN, NAN, NAN, NAN};
  if (desc->passes < (desc->filtered ? 2 : 1) || desc->photons < 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu passes of %zu x %zu photons are too few to trace%s", desc->passes,
                          desc->photons, desc->photons, desc->filtered ? " and filter" : "");
  if (count > ABBE_FRAME_TIMES_MAX) count = ABBE_FRAME_TIMES_MAX;
  abbe_result result = ABBE_OK;
  while (done < count && result == ABBE_OK) {
    if (desc->enough_ms > 0 && spent > desc->enough_ms && done >= FEW_FRAMES) break;
    result = trace(scene, desc, (double)done / (double)count, &frames[done], &half, &image, error);
    if (result == ABBE_OK) spent += frames[done++].ms;
  }
  if (result == ABBE_OK && half.data != NULL) out->own_de = own_error(&half, &image);
  abbe_image_free(&half);
  if (result != ABBE_OK) {
    abbe_image_free(&image);
    return result;
  }
  qsort(frames, done, sizeof *frames, compare_frames);
  out->frame_ms = frames[done / 2].ms;
  out->fastest_ms = frames[0].ms;
  out->light_ms = frames[done / 2].light_ms;
  out->eye_ms = frames[done / 2].eye_ms;
  if (picture != NULL)
    *picture = image;
  else
    abbe_image_free(&image);
  return ABBE_OK;
}

enum { INDEX_STEPS = 9 };

/* FNV-1a, 64 bits. */
static unsigned long long hash(unsigned long long h, const void *data, size_t size) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < size; i++) h = (h ^ byte[i]) * 1099511628211u;
  return h & 0xffffffffffffffffu;
}

static const unsigned long long hash_start = 14695981039346656037u;

/* What a crystal has besides its ordinary or middle index and its mean loss. */
static unsigned long long hash_crystal(unsigned long long h, const abbe_object *o) {
  h = hash(h, o->axis, sizeof o->axis);
  if (abbe_material_is_biaxial(o->material)) h = hash(h, o->axis_x, sizeof o->axis_x);
  for (int i = 0; i < INDEX_STEPS; i++)
    for (int axis = 0; axis < 3; axis++) {
      const double lambda_nm = 380 + 50.0 * i;
      double numbers[2] = {0, abbe_material_attenuation_along(o->material, axis, lambda_nm)};
      abbe_material_n_along(o->material, axis, lambda_nm, &numbers[0], NULL);
      h = hash(h, numbers, sizeof numbers);
    }
  return h;
}

static unsigned long long hash_coatings(unsigned long long h, const abbe_coatings *c) {
  for (size_t i = 0; c != NULL && i < c->count; i++)
    for (int k = 0; k < INDEX_STEPS; k++) {
      h = abbe_coating_digest(h, &c->coating[i], 380 + 50.0 * k);
      if (c->coating[i].alpha > 0) h = hash(h, &c->coating[i].alpha, sizeof c->coating[i].alpha);
    }
  return c != NULL && c->face != NULL ? hash(h, c->face, c->face_count) : h;
}

static unsigned long long hash_object(unsigned long long h, const abbe_object *o) {
  h = hash(h, o->mesh.position, o->mesh.vertex_count * sizeof *o->mesh.position);
  h = hash(h, o->mesh.face, o->mesh.face_count * sizeof *o->mesh.face);
  h = hash(h, o->reflectance, sizeof o->reflectance);
  h = hash(h, o->texture.data,
           o->texture.width * o->texture.height * o->texture.channels * sizeof *o->texture.data);
  for (int i = 0; i <= 40 && o->spectrum != NULL; i++) {
    const double value = abbe_spectrum_at(o->spectrum, 380 + 10.0 * i);
    h = hash(h, &value, sizeof value);
  }
  for (int i = 0; i < INDEX_STEPS && o->material != NULL; i++) {
    double lambda_nm = 380 + 50.0 * i, n = 0;
    abbe_material_n(o->material, lambda_nm, &n, NULL);
    double numbers[] = {n, abbe_material_attenuation(o->material, lambda_nm)};
    h = hash(h, numbers, sizeof numbers);
  }
  if (o->material != NULL && abbe_material_is_crystal(o->material)) h = hash_crystal(h, o);
  h = hash_coatings(h, o->coatings);
  h = hash_coatings(h, o->roughness);
  if (!o->mirror) return h;
  h = hash(h, &o->mirror_reflectance, sizeof o->mirror_reflectance);
  if (abbe_brushing_is_rough(&o->brushing)) {
    const abbe_brushing *b = &o->brushing;
    const double numbers[] = {b->facets.x, b->facets.y, b->around ? 1 : 0};
    h = hash(h, numbers, sizeof numbers);
    h = hash(h, b->axis, sizeof b->axis);
    h = hash(h, b->centre, sizeof b->centre);
  }
  for (int i = 0; i < INDEX_STEPS && o->conductor != NULL; i++) {
    double nk[2] = {0, 0};
    abbe_material_nk(o->conductor, 380 + 50.0 * i, &nk[0], &nk[1], NULL);
    h = hash(h, nk, sizeof nk);
  }
  return h;
}

unsigned long long abbe_scene_hash(const abbe_scene *s) {
  unsigned long long h = hash_start;
  h = hash(h, s->camera.eye, sizeof s->camera.eye);
  h = hash(h, s->camera.target, sizeof s->camera.target);
  h = hash(h, s->camera.up, sizeof s->camera.up);
  const double loose[] = {s->camera.fov_y_rad, s->ambient, s->background};
  h = hash(h, loose, sizeof loose);
  const double lens[] = {s->camera.aperture, s->camera.focus};
  if (s->camera.aperture > 0) h = hash(h, lens, sizeof lens);
  for (size_t i = 0; i < s->light_count; i++) {
    const abbe_light *l = &s->light[i];
    const double numbers[] = {l->kind,         l->position[0],  l->position[1],
                              l->position[2],  l->direction[0], l->direction[1],
                              l->direction[2], l->radius,       l->cone_rad,
                              l->soft_rad,     l->power,        l->illuminant.kind};
    h = hash(h, numbers, sizeof numbers);
    double line[ABBE_ILLUMINANT_MOST_LINES];
    h = hash(h, line, abbe_illuminant_lines(&l->illuminant, line) * sizeof *line);
    for (int k = 0; k < INDEX_STEPS; k++) {
      double power = abbe_illuminant_power(&l->illuminant, 380 + 50.0 * k);
      h = hash(h, &power, sizeof power);
    }
  }
  if (s->environment != NULL) {
    const abbe_environment *e = s->environment;
    h = hash(h, e->to_map, sizeof e->to_map);
    h = hash(h, e->map.rgb, e->map.width * e->map.height * 3 * sizeof *e->map.rgb);
    for (int k = 0; k < INDEX_STEPS; k++) {
      double power = abbe_illuminant_power(&e->illuminant, 380 + 50.0 * k);
      h = hash(h, &power, sizeof power);
    }
  }
  for (size_t i = 0; i < s->object_count; i++) h = hash_object(h, &s->object[i]);
  return h;
}

abbe_result abbe_matched_physics(const abbe_scene *scene, double min_nm, double max_nm,
                                 abbe_physics *out, abbe_error *error) {
  abbe_plan plan;
  const abbe_render_desc desc = {.min_nm = min_nm, .max_nm = max_nm};
  ABBE_TRY(abbe_plan_make(scene, &desc, &plan, error));
  *out = (abbe_physics){.matched = true,
                        .orders = plan.desc.exits,
                        .energy_share = plan.desc.energy_share,
                        .eye_orders = plan.eye_exits,
                        .eye_share = plan.eye_share};
  abbe_plan_free(&plan);
  return ABBE_OK;
}
