#include "colorimetry/spectral_picture/pixel_probe.h"

#include "colorimetry/chromaticity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const size_t absent = (size_t)-1;

static abbe_result check_window(const abbe_image *image, const char *name, abbe_image_window w,
                                abbe_error *error) {
  const abbe_image_window d = image->display_window;
  if (w.x0 <= w.x1 && w.y0 <= w.y1 && w.x0 >= d.x0 && w.x1 <= d.x1 && w.y0 >= d.y0 && w.y1 <= d.y1)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: (%d, %d) to (%d, %d) is not inside the picture, which is (%d, %d) to "
                        "(%d, %d)",
                        name, (int)w.x0, (int)w.y0, (int)w.x1, (int)w.y1, (int)d.x0, (int)d.y0,
                        (int)d.x1, (int)d.y1);
}

static double mean_of(const abbe_image *image, abbe_image_window w, size_t channel, bool squares) {
  double sum = 0, count = 0;
  for (int64_t y = w.y0; y <= w.y1; y++)
    for (int64_t x = w.x0; x <= w.x1; x++) {
      const size_t row = (size_t)(y - image->display_window.y0),
                   column = (size_t)(x - image->display_window.x0);
      const double v =
          (double)image->data[(row * image->width + column) * image->channels + channel];
      sum += squares ? v * v : v;
      count++;
    }
  return squares ? sqrt(sum) / count : sum / count;
}

static size_t find(const abbe_image *image, const char *before, const char *layer,
                   const char *name) {
  char full[300];
  const int n = snprintf(full, sizeof full, "%s%s%s%s", before, layer != NULL ? layer : "",
                         layer != NULL ? "." : "", name);
  return n > 0 && (size_t)n < sizeof full ? abbe_image_find_channel(image, full) : absent;
}

static bool find_triple(const abbe_image *image, const char *layer, bool *is_xyz, size_t at[3]) {
  static const char *const names[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
  for (int i = 0; i < 2; i++) {
    *is_xyz = i == 1;
    for (int k = 0; k < 3; k++) at[k] = find(image, "", layer, names[i][k]);
    if (at[0] != absent && at[1] != absent && at[2] != absent) return true;
  }
  return false;
}

static abbe_result take_channels(const abbe_image *image, const char *name, abbe_pixel_probe *p,
                                 abbe_error *error) {
  p->channels = image->channels;
  p->mean = calloc(image->channels, sizeof *p->mean);
  p->error = calloc(image->channels, sizeof *p->error);
  if (p->mean == NULL || p->error == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for %zu channels", name,
                          image->channels);
  for (size_t c = 0; c < image->channels; c++) {
    const size_t of_error = find(image, "stderr.", NULL, image->channel[c]);
    p->mean[c] = mean_of(image, p->window, c, false);
    p->error[c] = of_error != absent ? mean_of(image, p->window, of_error, true) : NAN;
  }
  return ABBE_OK;
}

static abbe_result take_colour(const abbe_image *image, const char *layer, const char *name,
                               abbe_pixel_probe *p, abbe_error *error) {
  size_t at[3];
  bool is_xyz;
  p->has_colour = find_triple(image, layer, &is_xyz, at);
  if (!p->has_colour) return ABBE_OK;
  ABBE_TRY(abbe_picture_space_find(image, is_xyz, name, &p->space, error));
  const double rgb[3] = {p->mean[at[0]], p->mean[at[1]], p->mean[at[2]]};
  abbe_rgb_space_apply(p->space.to_xyz, rgb, p->xyz);
  return ABBE_OK;
}

static abbe_result take_spectrum(const char *name, const abbe_spectral_view *view,
                                 abbe_pixel_probe *p, abbe_error *error) {
  const abbe_spectral_channels *s = &p->spectrum;
  double(*weight)[3] = calloc(s->terms, sizeof *weight), white[3];
  if (weight == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its bands", name);
  abbe_result result = abbe_spectral_colour_weights(s, view, name, weight, error);
  for (size_t i = 0; i < s->terms && result == ABBE_OK; i++)
    for (int k = 0; k < 3; k++) {
      p->spectral_xyz[k] += weight[i][k] * p->mean[s->channel[i]];
      p->spectral_error[k] += weight[i][k] * p->error[s->channel[i]];
    }
  free(weight);
  if (result != ABBE_OK) return result;
  p->has_spectral_xyz = true;
  p->is_relative = s->kind == ABBE_SPECTRAL_REFLECTIVE || view->from != NULL;
  abbe_spectral_colour_white(s, view, white);
  abbe_chromaticity_xy(white, p->white_xy);
  return ABBE_OK;
}

static abbe_result fill(const abbe_image *image, const char *layer, const char *name,
                        const abbe_spectral_view *view, abbe_pixel_probe *p, abbe_error *error) {
  ABBE_TRY(check_window(image, name, p->window, error));
  ABBE_TRY(take_channels(image, name, p, error));
  ABBE_TRY(take_colour(image, layer, name, p, error));
  ABBE_TRY(abbe_spectral_channels_find(image, layer, name, &p->spectrum, error));
  if (p->spectrum.count >= 2) ABBE_TRY(take_spectrum(name, view, p, error));
  if (!p->has_colour && p->spectrum.count == 0)
    ABBE_TRY(abbe_error_set(error, ABBE_NOT_FOUND,
                            "%s: it has neither R, G, B nor X, Y, Z nor bands%s%s%s; its first "
                            "channel is '%s'",
                            name, layer != NULL ? " in the layer '" : "",
                            layer != NULL ? layer : "", layer != NULL ? "'" : "",
                            image->channel[0]));
  return ABBE_OK;
}

abbe_result abbe_pixel_probe_make(const abbe_image *image, const char *layer, const char *name,
                                  abbe_image_window window, const abbe_spectral_view *view,
                                  abbe_pixel_probe *out, abbe_error *error) {
  *out = (abbe_pixel_probe){0};
  if (image->data == NULL || image->channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: the picture is empty", name);
  abbe_pixel_probe p = {.window = window,
                        .pixels = (size_t)((int64_t)window.x1 - window.x0 + 1) *
                                  (size_t)((int64_t)window.y1 - window.y0 + 1),
                        .white_xy = {0.3127, 0.3290}};
  abbe_result result = fill(image, layer, name, view, &p, error);
  if (result == ABBE_OK)
    *out = p;
  else
    abbe_pixel_probe_free(&p);
  return result;
}

void abbe_pixel_probe_free(abbe_pixel_probe *p) {
  if (p == NULL) return;
  free(p->mean);
  free(p->error);
  abbe_spectral_channels_free(&p->spectrum);
  *p = (abbe_pixel_probe){0};
}
