#include "colorimetry/spectral_picture/relight.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/observer_integral.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { NAME = 40 };

/* What each of an emissive picture's channels is multiplied by for another illuminant, of lights of
 * the same watts over the bands' range: factor[channels->terms], 0 where `from` is dark. 1
 * throughout without view->to and for reflectances. */
static void find_factors(const abbe_spectral_channels *c, const abbe_spectral_view *view,
                         double *factor) {
  for (size_t i = 0; i < c->terms; i++) factor[i] = 1;
  if (c->kind != ABBE_SPECTRAL_EMISSIVE || view->from == NULL || view->to == NULL) return;
  const double low = c->edge_nm[0], high = c->edge_nm[c->count];
  const double all_from = abbe_observer_integral_power(view->from, low, high),
               all_to = abbe_observer_integral_power(view->to, low, high);
  for (size_t i = 0; i < c->count; i++) {
    const double from =
        abbe_observer_integral_power(view->from, c->edge_nm[i], c->edge_nm[i + 1]) / all_from;
    const double to =
        abbe_observer_integral_power(view->to, c->edge_nm[i], c->edge_nm[i + 1]) / all_to;
    factor[i] = from > 0 ? to / from : 0;
  }
}

static bool has(const abbe_image *image, const char *layer, const char *channel) {
  char name[300];
  snprintf(name, sizeof name, "%s%s%s", layer != NULL ? layer : "", layer != NULL ? "." : "",
           channel);
  return abbe_image_find_channel(image, name) != (size_t)-1;
}

bool abbe_relight_is_needed(const abbe_image *image, const char *layer) {
  abbe_spectral_channels c;
  if (image == NULL || has(image, layer, "Y")) return false;
  if (has(image, layer, "R") && has(image, layer, "G") && has(image, layer, "B")) return false;
  if (abbe_spectral_channels_find(image, layer, "", &c, NULL) != ABBE_OK) return true;
  const bool needed = c.count > 0;
  abbe_spectral_channels_free(&c);
  return needed;
}

/* Integral of ybar over the bands, nm: what light of 1 W/(m2 sr nm) has, over 683 lm/W. */
static double even_y(const abbe_spectral_channels *c, abbe_observer observer) {
  static const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E};
  double xyz[3];
  abbe_observer_integral_by(observer, &even, c->edge_nm[0], c->edge_nm[c->count], xyz);
  return xyz[1] / 100;
}

static const char *unit_of(const abbe_spectral_channels *c, const abbe_relight_desc *d) {
  if (c->kind == ABBE_SPECTRAL_REFLECTIVE) return "of a perfect white under the illuminant";
  if (d->view.from != NULL) return "radiance, W/(m2 sr)";
  return d->relative ? "of an even 1 W/(m2 sr nm)" : abbe_spectral_quantity_text(c->unit.quantity);
}

static abbe_result make_image(const abbe_image *image, const abbe_spectral_channels *c,
                              const abbe_relight_desc *d, abbe_image *out, abbe_error *error) {
  static const char *const rgb[3] = {"R", "G", "B"}, *const xyz[3] = {"X", "Y", "Z"};
  const size_t bands = d->bands ? c->terms : 0;
  const bool emissive = c->kind == ABBE_SPECTRAL_EMISSIVE;
  char(*text)[2 * NAME] = calloc(bands + 1, sizeof *text);
  const char **name = calloc(bands + 3, sizeof *name);
  abbe_result result = ABBE_OK;
  if (text == NULL || name == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu bands", bands);
  for (size_t k = 0; k < 3 && result == ABBE_OK; k++)
    name[k] = d->space == ABBE_RGB_SPACE_XYZ ? xyz[k] : rgb[k];
  for (size_t i = 0; i < bands && result == ABBE_OK; i++) {
    const bool one = i < c->count;
    char from[NAME], to[NAME] = "S0";
    abbe_image_band_name(c->lambda_nm[one ? i : c->between[i - c->count][0]], from, sizeof from);
    if (!one) abbe_image_band_name(c->lambda_nm[c->between[i - c->count][1]], to, sizeof to);
    snprintf(text[i], sizeof *text, "%s%s%s", emissive ? "S0" : "T", from + 2, to + 2);
    name[3 + i] = text[i];
  }
  if (result == ABBE_OK)
    result = abbe_image_make(image->width, image->height, 3 + bands, name, out, error);
  free(text);
  free(name);
  return result;
}

/* What an infinite band counts as, for infinities of several signs make no colour. */
static double brightest(const abbe_image *image, const abbe_spectral_channels *c) {
  double most = 65504; /* the greatest half */
  for (size_t p = 0; p < image->width * image->height; p++)
    for (size_t i = 0; i < c->terms; i++) {
      const double value = fabs((double)image->data[p * image->channels + c->channel[i]]);
      if (isfinite(value)) most = fmax(most, value);
    }
  return most;
}

/* weight: of the channels' share of R, G and B. */
static void fill(const abbe_image *image, const abbe_spectral_channels *c,
                 const double (*weight)[3], const double *factor, bool infinite, abbe_image *out) {
  const double most = infinite ? brightest(image, c) : 0;
#pragma omp parallel for
  for (size_t p = 0; p < image->width * image->height; p++) {
    const float *from = image->data + p * image->channels;
    float *to = out->data + p * out->channels;
    double sum[3] = {0};
    for (size_t i = 0; i < c->terms; i++) {
      double value = (double)from[c->channel[i]];
      if (isinf(value)) value = copysign(most, value);
      for (int k = 0; k < 3; k++) sum[k] += weight[i][k] * value;
    }
    for (int k = 0; k < 3; k++) to[k] = (float)sum[k];
    for (size_t i = 0; i + 3 < out->channels; i++)
      to[3 + i] = (float)(factor[i] * (double)from[c->channel[i]]);
  }
}

/* A file's channels are held only where asked for, but infinities need to be known before. */
static abbe_result fill_from(const abbe_image *image, const abbe_spectral_channels *c,
                             const abbe_relight_desc *d, const double (*weight)[3],
                             const double *factor, abbe_image *out, abbe_error *error) {
  abbe_image whole = {0};
  abbe_image_odd odd = {0};
  if (d->file != NULL)
    ABBE_TRY(abbe_exr_read_sums(d->file, c->terms, c->channel, weight, factor, out, &odd, error));
  if (d->file == NULL || odd.infinite > 0) {
    if (d->file != NULL) ABBE_TRY(abbe_exr_read_first(d->file, SIZE_MAX, &whole, error));
    const abbe_image *from = d->file != NULL ? &whole : image;
    abbe_image_count_odd(from, c->channel, c->terms, &odd);
    fill(from, c, weight, factor, odd.infinite > 0, out);
    abbe_image_free(&whole);
  }
  if (d->odd != NULL) *d->odd = odd;
  return ABBE_OK;
}

static abbe_result describe(const abbe_image *image, const abbe_spectral_channels *c,
                            const abbe_relight_desc *d, abbe_image *out, abbe_error *error) {
  static const char *const kept[] = {"abbe:scene", "emissiveUnits"};
  const abbe_illuminant *light = d->view.to != NULL ? d->view.to : d->view.from;
  abbe_rgb_space_chromaticities(d->space, out->xy);
  out->display_window = image->display_window;
  out->data_window = image->data_window;
  ABBE_TRY(abbe_image_set_attribute(out, "abbe:space", abbe_rgb_space_name(d->space), error));
  ABBE_TRY(
      abbe_image_set_attribute(out, "abbe:observer", abbe_observer_text(d->view.observer), error));
  if (light != NULL)
    ABBE_TRY(abbe_image_set_attribute(out, "abbe:illuminant", abbe_illuminant_name(light), error));
  ABBE_TRY(abbe_image_set_attribute(out, "abbe:unit", unit_of(c, d), error));
  if (d->bands) ABBE_TRY(abbe_image_set_attribute(out, "spectralLayoutVersion", "1.0", error));
  for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
    const char *text = abbe_image_attribute_text(image, kept[i]);
    if (text != NULL) ABBE_TRY(abbe_image_set_attribute(out, kept[i], text, error));
  }
  return ABBE_OK;
}

static abbe_result relight(const abbe_image *image, const char *name,
                           const abbe_spectral_channels *c, const abbe_relight_desc *d,
                           double (*weight)[3], double *factor, abbe_image *out,
                           abbe_error *error) {
  double matrix[9];
  abbe_result result = abbe_spectral_colour_weights(c, &d->view, name, weight, error);
  if (result == ABBE_OK) result = make_image(image, c, d, out, error);
  if (result != ABBE_OK) return result;
  find_factors(c, &d->view, factor);
  abbe_rgb_space_from_xyz(d->space, matrix);
  const bool unknown = c->kind == ABBE_SPECTRAL_EMISSIVE && d->view.from == NULL;
  if (unknown && d->relative) {
    const double unit = ABBE_SPECTRAL_COLOUR_KM * even_y(c, d->view.observer);
    for (int k = 0; k < 9; k++) matrix[k] /= unit;
  }
  for (size_t i = 0; i < c->terms; i++) abbe_rgb_space_apply(matrix, weight[i], weight[i]);
  result = fill_from(image, c, d, (const double(*)[3])weight, factor, out, error);
  if (result == ABBE_OK) result = describe(image, c, d, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

abbe_result abbe_relight_make(const abbe_image *image, const char *name,
                              const abbe_relight_desc *desc, abbe_image *out, abbe_error *error) {
  *out = (abbe_image){0};
  abbe_spectral_channels c = {0};
  abbe_result result = abbe_spectral_channels_find(image, desc->layer, name, &c, error);
  if (result == ABBE_OK && c.count == 0)
    result = abbe_error_set(error, ABBE_NOT_FOUND,
                            "%s: it has no bands%s%s%s such as S0.550,000000nm; abbe render "
                            "--bands N and abbe trace --bands N make pictures that have",
                            name, desc->layer != NULL ? " in the layer '" : "",
                            desc->layer != NULL ? desc->layer : "", desc->layer != NULL ? "'" : "");
  if (result == ABBE_OK) {
    double(*weight)[3] = calloc(c.terms, sizeof *weight), *factor = calloc(c.terms, sizeof *factor);
    result = weight != NULL && factor != NULL
                 ? relight(image, name, &c, desc, weight, factor, out, error)
                 : abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its bands", name);
    free(weight);
    free(factor);
  }
  abbe_spectral_channels_free(&c);
  return result;
}
