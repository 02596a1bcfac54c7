#include "validation/trace/denoise_part.h"

#include "validation/trace/nl_means.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Found by trials against long traces of the shipped scenes. */
enum {
  WINDOW = 5, /* window for brightness */
  COLOUR_WINDOW = 7,
  PATCH = 2,
  VARIANCE_REACH = 4,   /* over which the photons' variance goes as their brightness */
  VARIANCE_FREEDOM = 8, /* what the variance of the pixels around counts, in passes */
  ENERGY_REACH = 8,
  ERROR_REACH = 4
};
static const float brightness_noise = 0.7f, colour_noise = 0.5f, most_scale = 4;

enum { PLANES = 21 };

static float *plane(const abbe_denoise_part *p, size_t index) {
  return p->room + index * p->work->pixels;
}

static void mean(const abbe_denoise_work *w, const float *from, size_t reach, float *room,
                 float *out) {
  abbe_plane_mean(from, w->width, w->height, reach, w->threads, room, out);
}

/* ---- the planes ---- */

abbe_result abbe_denoise_take(const abbe_image *picture, const char *prefix, const char *name,
                              float *out, abbe_error *error) {
  char full[64];
  snprintf(full, sizeof full, "%s%s", prefix, name);
  const size_t at = abbe_image_find_channel(picture, full);
  if (at == (size_t)-1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the picture has no layer '%s', without which it cannot be filtered: "
                          "trace it for a filter, two passes or more",
                          full);
  for (size_t i = 0; i < picture->width * picture->height; i++) {
    const float x = picture->data[i * picture->channels + at];
    out[i] = isfinite(x) ? x : 0;
  }
  return ABBE_OK;
}

/* Noise has the least colour beside the part's own mean colour. */
static void find_white(abbe_denoise_part *p, float *const rgb[3]) {
  const abbe_denoise_work *w = p->work;
  double sum[3] = {0}, all = 0, bright = 0;
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < w->pixels; i++) sum[k] += (double)rgb[k][i];
    all = fmax(all, sum[k]);
  }
  for (int k = 0; k < 3; k++) {
    p->white[k] = (all > 0 ? fmax(sum[k], 0.1 * all) : 1) / (double)w->pixels;
    bright += w->luminance[k] * p->white[k];
  }
  for (int k = 0; k < 3; k++) p->share[k] = w->luminance[k] * p->white[k] / bright;
}

static void turn(abbe_denoise_part *p, float *const rgb[3], float *const error[3],
                 float *const covariance[3]) {
  static const int first[3] = {0, 0, 1}, second[3] = {1, 2, 2};
  const double *s = p->share;
  const double m[3][3] = {{s[0], s[1], s[2]}, {1 - s[0], -s[1], -s[2]}, {-s[0], -s[1], 1 - s[2]}};
  for (int j = 0; j < 3; j++) {
    double of[3];
    for (int k = 0; k < 3; k++) of[k] = m[j][k] / p->white[k];
    for (size_t i = 0; i < p->work->pixels; i++) {
      double value = 0, variance = 0;
      for (int k = 0; k < 3; k++) {
        value += of[k] * (double)rgb[k][i];
        variance += pow(of[k] * (double)error[k][i], 2) +
                    2 * of[first[k]] * of[second[k]] * (double)covariance[k][i];
      }
      p->value[j][i] = (float)value;
      p->variance[j][i] = (float)fmax(variance, 0);
    }
  }
}

abbe_result abbe_denoise_part_make(const abbe_denoise_work *work, const abbe_image *picture,
                                   const char *name, const char *const colour[3],
                                   abbe_denoise_part *out, abbe_error *error) {
  *out = (abbe_denoise_part){.work = work, .photons = name[0] == 'p'};
  out->room = malloc(PLANES * work->pixels * sizeof *out->room);
  if (out->room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to filter %zu x %zu pixels",
                          work->width, work->height);
  for (size_t k = 0; k < 3; k++) {
    out->value[k] = plane(out, k);
    out->variance[k] = plane(out, 3 + k);
    out->out[k] = plane(out, 6 + k);
    out->error[k] = plane(out, 9 + k);
  }
  char prefix[3][40], pair[3][8];
  snprintf(prefix[0], sizeof prefix[0], "%s.", name);
  snprintf(prefix[1], sizeof prefix[1], "stderr.%s.", name);
  snprintf(prefix[2], sizeof prefix[2], "covariance.%s.", name);
  snprintf(pair[0], sizeof pair[0], "%s%s", colour[0], colour[1]);
  snprintf(pair[1], sizeof pair[1], "%s%s", colour[0], colour[2]);
  snprintf(pair[2], sizeof pair[2], "%s%s", colour[1], colour[2]);
  float *rgb[3], *deviation[3], *covariance[3];
  abbe_result result = ABBE_OK;
  for (size_t k = 0; k < 3 && result == ABBE_OK; k++) {
    rgb[k] = plane(out, 12 + k);
    deviation[k] = plane(out, 15 + k);
    covariance[k] = plane(out, 18 + k);
    result = abbe_denoise_take(picture, prefix[0], colour[k], rgb[k], error);
    if (result == ABBE_OK)
      result = abbe_denoise_take(picture, prefix[1], colour[k], deviation[k], error);
    if (result == ABBE_OK)
      result = abbe_denoise_take(picture, prefix[2], pair[k], covariance[k], error);
  }
  if (result != ABBE_OK) {
    abbe_denoise_part_free(out);
    return result;
  }
  find_white(out, rgb);
  turn(out, rgb, deviation, covariance);
  return ABBE_OK;
}

void abbe_denoise_part_free(abbe_denoise_part *part) {
  free(part->room);
  *part = (abbe_denoise_part){0};
}

/* ---- variances that a few passes estimate badly ---- */

/* Around a pixel the photons' variance is in proportion to their brightness; the camera's is as it
 * is around. */
static void steady_variances(abbe_denoise_part *p) {
  const abbe_denoise_work *w = p->work;
  float *room = plane(p, 12), *light = plane(p, 13), *near = plane(p, 14), *wide = plane(p, 15),
        *around = plane(p, 16);
  const float weight = (float)VARIANCE_FREEDOM, own = (float)(w->passes - 1);
  for (size_t i = 0; i < w->pixels; i++) light[i] = fmaxf(p->value[0][i], 0);
  mean(w, light, 1, room, near);
  mean(w, light, VARIANCE_REACH, room, wide);
  for (int k = 0; k < 3; k++) {
    float *variance = p->variance[k];
    mean(w, variance, p->photons ? VARIANCE_REACH : 1, room, around);
    for (size_t i = 0; i < w->pixels; i++) {
      float expected = around[i];
      if (p->photons) expected = wide[i] > 0 ? around[i] / wide[i] * near[i] : 0;
      /* Rounding may leave less than nothing of a mean where there is no noise. */
      expected = fmaxf(expected, 0);
      variance[i] = (weight * expected + own * variance[i]) / (weight + own);
    }
  }
}

/* ---- after the means ---- */

/* Colour was averaged as a part of the brightness around: it takes the pixel's own. */
static void follow_brightness(abbe_denoise_part *p, const float *around, const float *variance) {
  for (size_t i = 0; i < p->work->pixels; i++) {
    const float noise = sqrtf(variance[i]), own = fmaxf(p->out[0][i], 0) + noise;
    const float other = fmaxf(around[i], 0) + noise;
    if (!(other > 0)) continue;
    const float scale = fminf(own / other, most_scale);
    for (int k = 1; k < 3; k++) {
      p->out[k][i] *= scale;
      p->error[k][i] *= scale * scale;
    }
  }
}

/* Faint pixels are the more certain ones, so means favour them. What is lost on the whole around a
 * pixel is given back in proportion to the light that is there. */
static void give_back(abbe_denoise_part *p) {
  const abbe_denoise_work *w = p->work;
  float *room = plane(p, 12), *once = plane(p, 13), *light = plane(p, 14), *lost = plane(p, 15),
        *first = plane(p, 16);
  for (size_t i = 0; i < w->pixels; i++) first[i] = fmaxf(p->out[0][i], 0);
  mean(w, first, ENERGY_REACH, room, once);
  mean(w, once, ENERGY_REACH, room, light);
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < w->pixels; i++) lost[i] = p->value[k][i] - p->out[k][i];
    mean(w, lost, ENERGY_REACH, room, once);
    mean(w, once, ENERGY_REACH, room, lost);
    for (size_t i = 0; i < w->pixels; i++)
      if (light[i] > 0) p->out[k][i] += first[i] / light[i] * lost[i];
  }
}

/* Stein's unbiased estimate [Stein1981], in units of the variance, taken over the pixels around;
 * nothing is surer than the noise that is left. */
static void estimate_errors(abbe_denoise_part *p, float *const own[3]) {
  const abbe_denoise_work *w = p->work;
  float *room = plane(p, 12), *ratio = plane(p, 13), *around = plane(p, 14);
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < w->pixels; i++) {
      const float off = p->out[k][i] - p->value[k][i], v = p->variance[k][i];
      ratio[i] = v > 0 ? fminf(off * off / v + 2 * own[k][i] - 1, 100) : 0;
    }
    mean(w, ratio, ERROR_REACH, room, around);
    for (size_t i = 0; i < w->pixels; i++)
      p->error[k][i] = fmaxf(p->error[k][i], around[i] * p->variance[k][i]);
  }
}

abbe_result abbe_denoise_part_filter(abbe_denoise_part *p, abbe_error *error) {
  const abbe_denoise_work *w = p->work;
  float *own = plane(p, 17), *colour_own = plane(p, 18), *around = plane(p, 19),
        *around_variance = plane(p, 20);
  steady_variances(p);
  abbe_nl_means job = {.width = w->width,
                       .height = w->height,
                       .window = WINDOW,
                       .patch = PATCH,
                       .noise = brightness_noise,
                       .compared = 1,
                       .features = ABBE_DENOISE_FEATURES,
                       .filtered = 1};
  memcpy(job.feature, w->feature, sizeof w->feature);
  job.compare[0] = job.filter[0] = (abbe_noisy_plane){p->value[0], p->variance[0]};
  job.out[0] = p->out[0];
  job.out_variance[0] = p->error[0];
  job.own = own;
  ABBE_TRY(abbe_nl_means_run(&job, w->threads, error));
  job.window = COLOUR_WINDOW;
  job.noise = colour_noise;
  job.compared = 2;
  job.filtered = 3;
  job.filter[2] = job.filter[0];
  for (int k = 0; k < 2; k++) {
    job.compare[k] = job.filter[k] = (abbe_noisy_plane){p->value[k + 1], p->variance[k + 1]};
    job.out[k] = p->out[k + 1];
    job.out_variance[k] = p->error[k + 1];
  }
  job.out[2] = around;
  job.out_variance[2] = around_variance;
  job.own = colour_own;
  ABBE_TRY(abbe_nl_means_run(&job, w->threads, error));
  follow_brightness(p, around, around_variance);
  give_back(p);
  float *const owns[3] = {own, colour_own, colour_own};
  estimate_errors(p, owns);
  return ABBE_OK;
}

static void to_rgb(const abbe_denoise_part *p, float *const plane[3], size_t i, double rgb[3]) {
  const double *s = p->share;
  const double l = (double)plane[0][i], r = (double)plane[1][i], b = (double)plane[2][i];
  rgb[0] = p->white[0] * (l + r);
  rgb[1] = p->white[1] * (l - (s[0] * r + s[2] * b) / s[1]);
  rgb[2] = p->white[2] * (l + b);
}

void abbe_denoise_part_raw(const abbe_denoise_part *p, size_t i, double rgb[3]) {
  to_rgb(p, p->value, i, rgb);
}

void abbe_denoise_part_colour(const abbe_denoise_part *p, size_t i, double rgb[3],
                              double square[3]) {
  const double of_r = p->share[0] / p->share[1], of_b = p->share[2] / p->share[1];
  const double e = (double)p->error[0][i], e_r = (double)p->error[1][i],
               e_b = (double)p->error[2][i];
  to_rgb(p, p->out, i, rgb);
  square[0] = pow(p->white[0], 2) * (e + e_r);
  square[1] = pow(p->white[1], 2) * (e + of_r * of_r * e_r + of_b * of_b * e_b);
  square[2] = pow(p->white[2], 2) * (e + e_b);
}
