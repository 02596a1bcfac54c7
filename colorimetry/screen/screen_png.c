#include "colorimetry/screen/screen_png.h"

#include "base/number.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/screen/screen_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The names that pictures go by, in order of preference; a lone Y is a grey. */
static const char *const triples[][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}, {"Y", "Y", "Y"}};
enum { TRIPLE_RGB, TRIPLE_XYZ, TRIPLE_GREY, TRIPLE_COUNT };

static bool find_triple(const abbe_image *image, const char *layer, int triple, size_t at[3]) {
  for (int k = 0; k < 3; k++) {
    char name[300];
    snprintf(name, sizeof name, "%s%s%s", layer ? layer : "", layer ? "." : "", triples[triple][k]);
    at[k] = abbe_image_find_channel(image, name);
    if (at[k] == (size_t)-1) return false;
  }
  return true;
}

static const char *name_of(const abbe_screen_png_desc *d) {
  return d->name != NULL ? d->name : "the picture";
}

static abbe_result no_triple(const abbe_screen_png_desc *d, const abbe_image *image,
                             abbe_error *error) {
  char known[700] = "";
  for (size_t i = 0; i < image->channels; i++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", image->channel[i]);
  }
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "%s: it has no channels R, G, B (nor X, Y, Z, nor Y)%s%s%s; it has: %s",
                        name_of(d), d->layer ? " in the layer '" : "", d->layer ? d->layer : "",
                        d->layer ? "'" : "", known);
}

/* The three channels to show, as an image of their own. */
static abbe_result pick_channels(const abbe_screen_png_desc *d, const abbe_image *image,
                                 abbe_image *picked, int *triple, abbe_error *error) {
  size_t at[3];
  for (*triple = 0; *triple < TRIPLE_COUNT; ++*triple)
    if (find_triple(image, d->layer, *triple, at)) break;
  if (*triple == TRIPLE_COUNT) return no_triple(d, image, error);
  ABBE_TRY(abbe_image_make(image->width, image->height, 3, triples[TRIPLE_RGB], picked, error));
  for (size_t i = 0; i < image->width * image->height; i++)
    for (int k = 0; k < 3; k++)
      picked->data[3 * i + (size_t)k] = image->data[i * image->channels + at[k]];
  return ABBE_OK;
}

/* Channel A of the picture, or none. */
static const float *alpha_of(const abbe_screen_png_desc *d, const abbe_image *image) {
  const size_t at = d->alpha ? abbe_image_find_channel(image, "A") : (size_t)-1;
  return at != (size_t)-1 ? image->data + at : NULL;
}

static void divide(const float *alpha, size_t stride, abbe_image *picked) {
  for (size_t i = 0; i < picked->width * picked->height; i++)
    for (int k = 0; k < 3 && alpha[i * stride] > 0; k++)
      picked->data[3 * i + k] /= alpha[i * stride];
}

/* A fourth channel, of alpha. */
static abbe_result add_alpha(const float *alpha, size_t stride, abbe_image *picked,
                             abbe_error *error) {
  static const char *const name[] = {"A"};
  ABBE_OWNED(abbe_image, own) = {0};
  ABBE_TRY(abbe_image_make(picked->width, picked->height, 1, name, &own, error));
  for (size_t i = 0; i < own.width * own.height; i++) own.data[i] = alpha[i * stride];
  return abbe_image_append(picked, &own, error);
}

/* In the picture's own space where the configuration may have it; of other primaries the pixels
 * become XYZ. Light is held where floats take it. */
static void enter_space(const abbe_picture_space *from, abbe_image *picked, const char **space) {
  const double most = 1e15;
  const bool known = from->space != ABBE_RGB_SPACE_COUNT;
  *space = abbe_rgb_space_ocio_name(known ? from->space : ABBE_RGB_SPACE_XYZ);
  for (size_t i = 0; !known && i < picked->width * picked->height; i++) {
    float *pixel = picked->data + 3 * i;
    double v[3];
    for (int k = 0; k < 3; k++) v[k] = fmin(fmax((double)pixel[k], -most), most);
    abbe_rgb_space_apply(from->to_xyz, v, v);
    for (int k = 0; k < 3; k++) pixel[k] = isnan(pixel[k]) ? NAN : (float)v[k];
  }
}

/* The space that the command line names, else what every reader of the picture takes it for. */
static abbe_result find_source(const abbe_screen_png_desc *d, const abbe_image *image, int triple,
                               abbe_image *picked, const char **space, abbe_error *error) {
  abbe_picture_space found;
  *space = d->display.source_space;
  if (*space != NULL) return ABBE_OK;
  ABBE_TRY(abbe_picture_space_find(image, triple == TRIPLE_XYZ, name_of(d), &found, error));
  enter_space(&found, picked, space);
  if (d->notes != NULL) d->notes->space_assumed = found.assumed && triple == TRIPLE_RGB;
  return ABBE_OK;
}

static int by_size(const void *a, const void *b) {
  const float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

/* By the greatest finite channels of pixels all over the picture, of those that are covered. */
static double find_stops(const float *alpha, size_t stride, const abbe_image *picked) {
  enum { MOST = 4096 };
  static const double bright = 0.8, share = 0.9;
  float most[MOST];
  const size_t pixels = picked->width * picked->height, step = pixels / MOST + 1;
  size_t count = 0;
  for (size_t i = 0; i < pixels; i += step) {
    const float *p = picked->data + 3 * i;
    if (alpha != NULL && !(alpha[i * stride] > 0)) continue;
    most[count] = fmaxf(p[0], fmaxf(p[1], p[2]));
    if (isfinite(most[count])) count++;
  }
  if (count == 0) return 0;
  qsort(most, count, sizeof *most, by_size);
  const double value = (double)most[(size_t)(share * (double)(count - 1))];
  return value > 0 ? log2(bright / value) : 0;
}

static double clamp_stops(double stops) {
  return fmax(-ABBE_DISPLAY_MAX_EXPOSURE, fmin(stops, ABBE_DISPLAY_MAX_EXPOSURE));
}

/* Whether the attribute says stops; a file may have whatever text. */
static bool read_stops(const char *text, double *stops) {
  const char *end = NULL;
  return text != NULL && abbe_number_read(text, &end, stops) && *end == '\0' && isfinite(*stops);
}

static bool is_auto(const char *text) {
  return text != NULL && strcmp(text, "auto") == 0;
}

double abbe_screen_png_exposure(const abbe_image *image) {
  const char *text = abbe_image_attribute_text(image, ABBE_SCREEN_EXPOSURE);
  const abbe_screen_png_desc desc = {0};
  abbe_image picked = {0};
  double stops = 0;
  int triple;
  if (is_auto(text) && pick_channels(&desc, image, &picked, &triple, NULL) == ABBE_OK)
    stops = find_stops(NULL, 0, &picked);
  else if (!read_stops(text, &stops))
    stops = 0;
  abbe_image_free(&picked);
  return clamp_stops(stops);
}

/* A pixel is white where 8 bits have all three channels at their end. */
static double share_of_white(const abbe_image *shown) {
  const float end = 254.5f / 255;
  const size_t pixels = shown->width * shown->height;
  size_t count = 0;
  for (size_t i = 0; i < pixels; i++) {
    const float *p = shown->data + 3 * i;
    count += p[0] >= end && p[1] >= end && p[2] >= end;
  }
  return (double)count / (double)pixels;
}

abbe_result abbe_screen_png_write(const char *path, const abbe_image *image,
                                  const abbe_screen_png_desc *d, abbe_error *error) {
  abbe_image picked = {0};
  abbe_display *transform = NULL;
  abbe_display_desc desc = d->display;
  int triple = 0;
  abbe_result result = pick_channels(d, image, &picked, &triple, error);
  if (result == ABBE_OK && d->notes != NULL) {
    *d->notes = (abbe_screen_png_notes){0};
    abbe_image_count_odd(&picked, (const size_t[]){0, 1, 2}, 3, &d->notes->odd);
  }
  const float *alpha = alpha_of(d, image);
  if (result == ABBE_OK && alpha != NULL) divide(alpha, image->channels, &picked);
  if (result == ABBE_OK && d->glare_deg > 0) result = abbe_glare_add(&picked, d->glare_deg, error);
  const double stops = result == ABBE_OK ? find_stops(alpha, image->channels, &picked) : 0;
  const char *own =
      d->exposed || d->stated ? NULL : abbe_image_attribute_text(image, ABBE_SCREEN_EXPOSURE);
  const bool chosen = d->exposed || is_auto(own);
  double wanted = 0;
  if (chosen || read_stops(own, &wanted)) desc.exposure = clamp_stops(chosen ? stops : wanted);
  if (result == ABBE_OK && d->notes != NULL) d->notes->chosen = chosen;
  if (result == ABBE_OK && d->notes != NULL) d->notes->stops = stops;
  if (result == ABBE_OK && d->notes != NULL) d->notes->exposure = desc.exposure;
  if (result == ABBE_OK) result = find_source(d, image, triple, &picked, &desc.source_space, error);
  if (result == ABBE_OK) result = abbe_display_make(&desc, &transform, error);
  if (result == ABBE_OK) result = abbe_display_apply(transform, &picked, error);
  if (result == ABBE_OK && d->notes != NULL) d->notes->white = share_of_white(&picked);
  if (result == ABBE_OK && alpha != NULL)
    result = add_alpha(alpha, image->channels, &picked, error);
  const char *made = abbe_image_attribute_text(image, ABBE_PNG_TEXT);
  if (result == ABBE_OK && made != NULL)
    result = abbe_image_set_attribute(&picked, ABBE_PNG_TEXT, made, error);
  if (result == ABBE_OK) result = abbe_screen_file_write(path, &picked, d->bits, error);
  abbe_display_free(transform);
  abbe_image_free(&picked);
  return result;
}
