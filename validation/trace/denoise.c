#include "validation/trace/denoise.h"

#include "colorimetry/rgb_space.h"
#include "validation/trace/denoise_part.h"
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
