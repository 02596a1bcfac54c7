#include "cli/view/inspect/inspect.h"

#include "colorimetry/chromaticity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Whether a pixel lacks part of what the mix needs. */
static bool is_odd(const abbe_inspect_mix *mix, const float *pixel) {
  size_t i = 0;
  while (i < mix->count && isfinite(pixel[mix->channel[i]])) i++;
  return i < mix->count;
}

/* About the first value, which error[] holds meanwhile, so that nothing cancels. */
static void add_pixel(const float *v, size_t *count, abbe_inspect_probe *p) {
  for (size_t c = 0; c < p->channels; c++) {
    if (!isfinite(v[c])) continue;
    if (count[c]++ == 0) p->error[c] = (double)v[c];
    const double d = (double)v[c] - p->error[c];
    p->mean[c] += d;
    p->deviation[c] += d * d;
  }
}

/* The error that the file states of one pixel. */
static double stated_error(const abbe_image *image, const float *pixel, size_t channel) {
  char name[300];
  snprintf(name, sizeof name, "stderr.%.280s", image->channel[channel]);
  const size_t at = abbe_image_find_channel(image, name);
  return at != (size_t)-1 ? (double)pixel[at] : NAN;
}

/* count: zeroed, of so many channels */
static void take_channels(const abbe_inspect_picture *picture, const abbe_inspect_source *from,
                          size_t *count, abbe_inspect_probe *p) {
  const size_t *w = p->window;
  for (size_t y = w[1]; y <= w[3]; y += p->side)
    for (size_t x = w[0]; x <= w[2]; x += p->side) {
      const float *v = abbe_inspect_source_pixel(from, x, y);
      p->pixels++;
      p->odd += is_odd(&picture->mix, v);
      add_pixel(v, count, p);
    }
  for (size_t c = 0; c < p->channels; c++) {
    const double n = (double)count[c], first = p->error[c];
    const double mean = n > 0 ? p->mean[c] / n : NAN;
    const double squares = n > 1 ? (p->deviation[c] - n * mean * mean) / (n - 1) : NAN;
    p->deviation[c] = n > 1 ? sqrt(fmax(0, squares)) : NAN;
    p->error[c] = p->pixels == 1
                      ? stated_error(from->image, abbe_inspect_source_pixel(from, w[0], w[1]), c)
                      : p->deviation[c] / sqrt(n);
    p->mean[c] = first + mean;
  }
}

/* What is shown if that is a colour, else of the bands, else of R, G, B. */
static const abbe_inspect_entry *colour_of(const abbe_inspect *s, const abbe_inspect_picture *p) {
  const abbe_inspect_entry *best = NULL, *shown = &s->picture[s->at].entry[s->look.entry];
  const abbe_inspect_kind first =
      abbe_inspect_is_colour(shown->kind) ? shown->kind : ABBE_INSPECT_SPECTRUM;
  if (p == &s->picture[s->at] && shown->kind == first) return shown;
  for (size_t i = 0; i < p->count; i++) {
    if (p->entry[i].kind == first) return &p->entry[i];
    if (best == NULL && p->entry[i].kind == ABBE_INSPECT_COLOUR) best = &p->entry[i];
  }
  return best;
}

/* The mean of the pixels that have all of it, ACEScg; false: there is none. */
static bool mean_of(const abbe_inspect_picture *p, const abbe_inspect_source *from,
                    const abbe_inspect_mix *mix, const abbe_inspect_probe *probe, double out[3]) {
  const size_t *w = probe->window;
  double count = 0, v[3];
  for (size_t y = w[1]; y <= w[3]; y += probe->side)
    for (size_t x = w[0]; x <= w[2]; x += probe->side) {
      const float *pixel = abbe_inspect_source_pixel(from, x, y);
      if (is_odd(mix, pixel)) continue;
      abbe_inspect_mix_at(mix, p, pixel, v);
      for (int k = 0; k < 3; k++) out[k] += v[k];
      count++;
    }
  for (int k = 0; k < 3 && count > 0; k++) out[k] /= count;
  return count > 0;
}

static void take_cloud(const abbe_inspect_picture *p, const abbe_inspect_source *from,
                       const abbe_inspect_mix *mix, const double matrix[9],
                       abbe_inspect_probe *out) {
  const size_t *w = out->window;
  size_t step = out->side;
  while (((w[2] - w[0]) / step + 1) * ((w[3] - w[1]) / step + 1) > ABBE_INSPECT_CLOUD) step++;
  for (size_t y = w[1]; y <= w[3]; y += step)
    for (size_t x = w[0]; x <= w[2]; x += step) {
      double xyz[3];
      const float *pixel = abbe_inspect_source_pixel(from, x, y);
      if (is_odd(mix, pixel)) continue;
      abbe_inspect_mix_at(mix, p, pixel, xyz);
      abbe_rgb_space_apply(matrix, xyz, xyz);
      if (abbe_chromaticity_xy(xyz, out->cloud[out->cloud_count])) out->cloud_count++;
    }
}

static abbe_result take_colour(const abbe_inspect *s, const abbe_inspect_picture *p,
                               const abbe_inspect_source *from, abbe_inspect_probe *out,
                               abbe_error *error) {
  static const double d65[2] = {0.3127, 0.3290};
  const abbe_inspect_entry *entry = colour_of(s, p);
  abbe_inspect_mix mix;
  double matrix[9];
  abbe_dominant dominant = {NAN, NAN, NAN};
  if (entry == NULL) return ABBE_OK;
  ABBE_TRY(abbe_inspect_mix_make(p, entry, &s->look, &mix, error));
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  const bool some = mean_of(p, from, &mix, out, out->xyz);
  abbe_rgb_space_apply(matrix, out->xyz, out->xyz);
  out->unit = mix.unit;
  out->coloured = some && abbe_chromaticity_xy(out->xyz, out->xy);
  if (out->coloured) {
    abbe_chromaticity_uv_of_xy(out->xy, out->uv);
    abbe_chromaticity_dominant(out->xy, d65, s->look.view.observer, &dominant);
  }
  out->dominant_nm = isfinite(dominant.lambda_nm) ? dominant.lambda_nm : -dominant.complementary_nm;
  out->purity = dominant.purity;
  take_cloud(p, from, &mix, matrix, out);
  abbe_inspect_mix_free(&mix);
  return ABBE_OK;
}

abbe_result abbe_inspect_probe_make(const abbe_inspect *s, size_t at, const size_t window[4],
                                    abbe_inspect_probe *out, abbe_error *error) {
  const abbe_inspect_picture *p = &s->picture[at];
  const size_t numbers = s->most_numbers > 0 ? s->most_numbers : ABBE_INSPECT_MOST_NUMBERS;
  size_t level = 0;
  abbe_inspect_source from = {0};
  *out = (abbe_inspect_probe){.channels = p->image.channels};
  for (int k = 0; k < 4; k++) {
    const size_t most = (k % 2 == 0 ? p->width : p->height) - 1;
    out->window[k] = window[k] < most ? window[k] : most;
  }
  const size_t *w = out->window;
  while (level < p->coarse &&
         ((w[2] - w[0]) >> level) * ((w[3] - w[1]) >> level) > numbers / out->channels)
    level++;
  out->side = (size_t)1 << level;
  out->mean = calloc(out->channels, sizeof *out->mean);
  out->deviation = calloc(out->channels, sizeof *out->deviation);
  out->error = calloc(out->channels, sizeof *out->error);
  size_t *count = calloc(out->channels, sizeof *count);
  abbe_result result = ABBE_OK;
  if (out->mean == NULL || out->deviation == NULL || out->error == NULL || count == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its channels", p->path);
  if (result == ABBE_OK) result = abbe_inspect_source_take(p, level, w, &from, error);
  if (result == ABBE_OK) take_channels(p, &from, count, out);
  free(count);
  if (result == ABBE_OK) result = take_colour(s, p, &from, out, error);
  abbe_image_free(&from.own);
  if (result != ABBE_OK) abbe_inspect_probe_free(out);
  return result;
}

void abbe_inspect_probe_free(abbe_inspect_probe *p) {
  free(p->mean);
  free(p->deviation);
  free(p->error);
  *p = (abbe_inspect_probe){0};
}
