#include "validation/trace/denoise.h"

#include "colorimetry/rgb_space.h"
#include "validation/trace/nl_means.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64, PARTS = 2, PHOTONS = 0, EYE = 1 };

/* Differences of what shows that count: of a reflectance, of a unit vector's component, and of the
 * depth as a part of its mean. */
static const float albedo_step = 0.2f, normal_step = 0.3f, depth_step = 0.2f;

typedef struct filter {
  const abbe_image *picture;
  const char *const *colour; /* [3] */
  abbe_denoise_work work;
  abbe_denoise_part part[PARTS];
  float *room, *caustic[3]; /* the picture's */
} filter;

/* ---- what is there ---- */

static abbe_result find_colours(filter *f, abbe_error *error) {
  static const char *const rgb[3] = {"R", "G", "B"}, *const xyz[3] = {"X", "Y", "Z"};
  const abbe_image *p = f->picture;
  f->colour = abbe_image_find_channel(p, "R") != (size_t)-1 ? rgb : xyz;
  double matrix[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  if (f->colour == xyz) {
    abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_XYZ, matrix);
  } else if (p->xy[1] != 0) {
    const abbe_result result = abbe_rgb_space_chromaticities_to_xyz(p->xy, matrix, error);
    if (result != ABBE_OK) return result;
  }
  memcpy(f->work.luminance, matrix + 3, sizeof f->work.luminance);
  const char *passes = abbe_image_attribute_text(p, "abbe:passes");
  const unsigned long count = passes != NULL ? strtoul(passes, NULL, 10) : 2;
  f->work.passes = count > 2 ? count : 2;
  return ABBE_OK;
}

/* A feature in units of the difference that counts, its variance less uncertain. */
static void make_feature(filter *f, size_t k, float *value, float *variance, float *room,
                         float *other) {
  const abbe_denoise_work *w = &f->work;
  double sum = 0;
  for (size_t i = 0; i < w->pixels; i++) sum += fabs((double)value[i]);
  const float mean = (float)(sum / (double)w->pixels);
  const float step = k < 3 ? albedo_step : k < 6 ? normal_step : depth_step * mean;
  const float scale = step > 0 ? 1 / step : 0;
  for (size_t i = 0; i < w->pixels; i++) {
    value[i] *= scale;
    other[i] = variance[i] * variance[i] * scale * scale;
  }
  abbe_plane_mean(other, w->width, w->height, 1, w->threads, room, variance);
  f->work.feature[k] = (abbe_noisy_plane){value, variance};
}

static abbe_result make_features(filter *f, abbe_error *error) {
  const size_t pixels = f->work.pixels;
  f->room = malloc((2 * ABBE_DENOISE_FEATURES + 5) * pixels * sizeof *f->room);
  if (f->room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to filter %zu x %zu pixels",
                          f->work.width, f->work.height);
  static const char *const axis[3] = {"X", "Y", "Z"};
  float *spare = f->room + 2 * ABBE_DENOISE_FEATURES * pixels;
  for (size_t k = 0; k < ABBE_DENOISE_FEATURES; k++) {
    float *value = f->room + 2 * k * pixels, *variance = value + pixels;
    char name[NAME], deviation[NAME + 8];
    snprintf(name, sizeof name, "%s%s",
             k < 3   ? "albedo."
             : k < 6 ? "normal."
                     : "depth.",
             k < 3   ? f->colour[k]
             : k < 6 ? axis[k - 3]
                     : "Z");
    snprintf(deviation, sizeof deviation, "stderr.%s", name);
    abbe_result result = abbe_denoise_take(f->picture, "", name, value, error);
    if (result == ABBE_OK) result = abbe_denoise_take(f->picture, "", deviation, variance, error);
    if (result != ABBE_OK) return result;
    make_feature(f, k, value, variance, spare, spare + pixels);
  }
  for (size_t k = 0; k < 3; k++) {
    f->caustic[k] = spare + (2 + k) * pixels;
    const abbe_result result =
        abbe_denoise_take(f->picture, "caustic.", f->colour[k], f->caustic[k], error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

/* ---- the picture ---- */

static abbe_result make_image(const filter *f, abbe_image *out, abbe_error *error) {
  static const char *const kept[] = {"albedo.", "normal.", "depth.", "S0.", "stderr.S0."};
  static const char *const made[] = {"",     "stderr.",     "caustic.",
                                     "raw.", "stderr.raw.", "raw.caustic."};
  enum { MADE = sizeof made / sizeof *made, KEPT = sizeof kept / sizeof *kept };
  const abbe_image *p = f->picture;
  char(*room)[NAME] = malloc((3 * MADE + p->channels) * sizeof *room);
  const char **names = malloc((3 * MADE + p->channels) * sizeof *names);
  size_t count = 0;
  abbe_result result = ABBE_OK;
  if (room == NULL || names == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for channels");
  for (size_t i = 0; i < MADE && result == ABBE_OK; i++)
    for (size_t k = 0; k < 3; k++) {
      snprintf(room[count], NAME, "%s%s", made[i], f->colour[k]);
      names[count] = room[count];
      count++;
    }
  for (size_t c = 0; c < p->channels && result == ABBE_OK; c++)
    for (size_t i = 0; i < KEPT; i++)
      if (strncmp(p->channel[c], kept[i], strlen(kept[i])) == 0) names[count++] = p->channel[c];
  if (result == ABBE_OK) result = abbe_image_make(p->width, p->height, count, names, out, error);
  free(room);
  free(names);
  if (result != ABBE_OK) return result;
  memcpy(out->xy, p->xy, sizeof out->xy);
  out->display_window = p->display_window;
  out->data_window = p->data_window;
  for (size_t c = 3 * MADE; c < count; c++) {
    const size_t from = abbe_image_find_channel(p, out->channel[c]);
    for (size_t i = 0; i < f->work.pixels; i++)
      out->data[i * count + c] = p->data[i * p->channels + from];
  }
  for (size_t i = 0; i < p->attribute_count && result == ABBE_OK; i++)
    result = abbe_image_set_attribute(out, p->attribute[i].name, p->attribute[i].text, error);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(out, "abbe:filter", "non-local means", error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

/* The camera's part of the caustic changes as the light of its pixel does, by its share of it. */
static double caustic_share(const double eye[3], const double caustic[3]) {
  const double all = eye[0] + eye[1] + eye[2], of = caustic[0] + caustic[1] + caustic[2];
  return of > 0 && all > 0 ? fmin(of / all, 1) : 0;
}

static void fill_pixel(const filter *f, size_t i, const size_t at[3], const size_t error_at[3],
                       const abbe_image *out) {
  const abbe_image *p = f->picture;
  const float *from = p->data + i * p->channels;
  float *to = out->data + i * out->channels;
  double light[PARTS][3], square[PARTS][3], raw_photons[3], eye[3], eye_caustic[3];
  for (size_t part = 0; part < PARTS; part++)
    abbe_denoise_part_colour(&f->part[part], i, light[part], square[part]);
  abbe_denoise_part_raw(&f->part[PHOTONS], i, raw_photons);
  abbe_denoise_part_raw(&f->part[EYE], i, eye);
  for (size_t k = 0; k < 3; k++) eye_caustic[k] = (double)f->caustic[k][i] - raw_photons[k];
  const double share = caustic_share(eye, eye_caustic);
  for (size_t k = 0; k < 3; k++) {
    to[k] = (float)(light[PHOTONS][k] + light[EYE][k]);
    to[3 + k] = (float)sqrt(square[PHOTONS][k] + square[EYE][k]);
    to[6 + k] = (float)(light[PHOTONS][k] + eye_caustic[k] + share * (light[EYE][k] - eye[k]));
    to[9 + k] = from[at[k]];
    to[12 + k] = from[error_at[k]];
    to[15 + k] = f->caustic[k][i];
  }
}

static abbe_result fill_image(const filter *f, const abbe_image *out, abbe_error *error) {
  size_t at[3], error_at[3];
  for (size_t k = 0; k < 3; k++) {
    char name[NAME];
    snprintf(name, sizeof name, "stderr.%s", f->colour[k]);
    at[k] = abbe_image_find_channel(f->picture, f->colour[k]);
    error_at[k] = abbe_image_find_channel(f->picture, name);
    if (at[k] == (size_t)-1 || error_at[k] == (size_t)-1)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture has no layer '%s'",
                            at[k] == (size_t)-1 ? f->colour[k] : name);
  }
  for (size_t i = 0; i < f->work.pixels; i++) fill_pixel(f, i, at, error_at, out);
  return ABBE_OK;
}

abbe_result abbe_denoise_picture(const abbe_image *picture, const abbe_denoise_desc *desc,
                                 abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  if (picture->data == NULL || picture->width == 0 || picture->height == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no picture to filter");
  if (desc->threads > ABBE_DENOISE_MAX_THREADS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "threads %zu is too much: at most %d",
                          desc->threads, ABBE_DENOISE_MAX_THREADS);
  filter f = {.picture = picture};
  f.work.width = picture->width;
  f.work.height = picture->height;
  f.work.pixels = picture->width * picture->height;
  f.work.threads = desc->threads > 0 ? desc->threads : (size_t)omp_get_num_procs();
  static const char *const parts[PARTS] = {"photons", "eye"};
  abbe_result result = find_colours(&f, error);
  if (result == ABBE_OK) result = make_features(&f, error);
  for (size_t i = 0; i < PARTS && result == ABBE_OK; i++) {
    result = abbe_denoise_part_make(&f.work, picture, parts[i], f.colour, &f.part[i], error);
    if (result == ABBE_OK) result = abbe_denoise_part_filter(&f.part[i], error);
  }
  if (result == ABBE_OK) result = make_image(&f, out, error);
  if (result == ABBE_OK) {
    result = fill_image(&f, out, error);
    if (result != ABBE_OK) abbe_image_free(out);
  }
  for (size_t i = 0; i < PARTS; i++) abbe_denoise_part_free(&f.part[i]);
  free(f.room);
  return result;
}

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
