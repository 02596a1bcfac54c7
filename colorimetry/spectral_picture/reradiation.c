#include "colorimetry/spectral_picture/reradiation.h"

#include "base/number.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64 };

/* ---- to a picture ---- */

static int compare(const void *a, const void *b) {
  const double *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

static size_t add_points(const abbe_spectrum *s, double below_nm, double *nm) {
  size_t count = 0;
  for (size_t i = 0; s != NULL && i < abbe_spectrum_count(s); i++)
    if (abbe_spectrum_lambda_nm(s)[i] < below_nm) nm[count++] = abbe_spectrum_lambda_nm(s)[i];
  return count;
}

/* All wavelengths at which its matrix has points, ascending, each once; NULL: no memory. */
static double *points_of(const abbe_material *m, size_t *count) {
  const abbe_fluorescence *f = &m->fluorescence;
  const double first = abbe_spectrum_lambda_nm(f->emission)[0];
  const abbe_spectrum *excites = f->excitation != NULL ? f->excitation : m->attenuation;
  const size_t most = f->rows + abbe_spectrum_count(f->emission) +
                      (excites != NULL ? abbe_spectrum_count(excites) : 0);
  double *nm = calloc(most + 1, sizeof *nm);
  size_t all = 0;
  *count = 0;
  if (nm == NULL) return NULL;
  for (; all < f->rows; all++) nm[all] = f->row[all].nm;
  if (f->rows == 0) all += add_points(excites, first, nm);
  all += add_points(f->emission, INFINITY, nm + all);
  qsort(nm, all, sizeof *nm, compare);
  for (size_t i = 0; i < all; i++)
    if (*count == 0 || nm[i] > nm[*count - 1] + 1e-6) nm[(*count)++] = nm[i];
  return nm;
}

/* W a nm that come back at one of the points by W absorbed at another, for a band of that width. */
static double share(const abbe_material *m, const double *nm, size_t count, size_t from,
                    size_t to) {
  const double low = from > 0 ? nm[from - 1] : 2 * nm[0] - nm[1];
  const double high = from + 1 < count ? nm[from + 1] : 2 * nm[from] - nm[from - 1];
  return abbe_material_excites(m, nm[from]) * abbe_material_reradiates(m, nm[from], nm[to]) *
         nm[from] / nm[to] * 0.5 * (high - low);
}

static abbe_result fill(const abbe_material *m, const double *nm, size_t count, abbe_image *out,
                        abbe_error *error) {
  char(*text)[2 * NAME] = calloc(ABBE_IMAGE_MAX_CHANNELS, sizeof *text);
  const char *name[ABBE_IMAGE_MAX_CHANNELS];
  float value[ABBE_IMAGE_MAX_CHANNELS] = {0};
  size_t channels = 0;
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a matrix");
  for (size_t i = 0; i < count; i++)
    for (size_t k = i; k < count && channels <= ABBE_IMAGE_MAX_CHANNELS; k++) {
      char from[NAME], to[NAME] = "S0";
      const double of = k > i ? share(m, nm, count, i, k) : 0;
      if (k > i && !(of > 0)) continue;
      if (channels++ == ABBE_IMAGE_MAX_CHANNELS) break;
      abbe_image_band_name(nm[i], from, sizeof from);
      if (k > i) abbe_image_band_name(nm[k], to, sizeof to);
      snprintf(text[channels - 1], sizeof *text, "T%s%s", from + 2, to + 2);
      name[channels - 1] = text[channels - 1];
      value[channels - 1] = (float)of;
    }
  abbe_result result = channels <= ABBE_IMAGE_MAX_CHANNELS
                           ? abbe_image_make(1, 1, channels, name, out, error)
                           : abbe_error_set(error, ABBE_UNSUPPORTED,
                                            "%s: its matrix has more than %d places, which a "
                                            "picture's channels may be; take fewer points",
                                            m->name, ABBE_IMAGE_MAX_CHANNELS);
  free(text);
  if (result == ABBE_OK) memcpy(out->data, value, channels * sizeof *value);
  return result;
}

abbe_result abbe_reradiation_picture(const abbe_material *material, abbe_image *out,
                                     abbe_error *error) {
  size_t count = 0;
  *out = (abbe_image){0};
  if (!abbe_material_is_fluorescent(material))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s does not glow: it has no re-radiation for a spectral picture",
                          material->name);
  double *nm = points_of(material, &count);
  abbe_result result = nm != NULL ? fill(material, nm, count, out, error)
                                  : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a matrix");
  free(nm);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(out, "spectralLayoutVersion", "1.0", error);
  if (result == ABBE_OK)
    result = abbe_image_set_attribute(out, "abbe:reradiation", "of what is absorbed", error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

/* ---- from a picture ---- */

/* Mean over the pixels. */
static double mean_of(const abbe_image *image, size_t channel) {
  const size_t pixels = image->width * image->height;
  double sum = 0;
  for (size_t i = 0; i < pixels; i++) sum += (double)image->data[i * image->channels + channel];
  return sum / (double)pixels;
}

/* [from][to] photons by nm by photon absorbed. */
static abbe_result read_matrix(const abbe_image *image, const abbe_spectral_channels *c,
                               const char *name, double *matrix, abbe_error *error) {
  for (size_t i = c->count; i < c->terms; i++) {
    const size_t from = c->between[i - c->count][0], to = c->between[i - c->count][1];
    const double value = mean_of(image, c->channel[i]);
    if (!(value >= 0 && value < 1e15))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: its channel '%s' has %g; 0 or more "
                            "comes back",
                            name, image->channel[c->channel[i]], value);
    if (value > 0 && to < from)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: its channel '%s' is of light at a shorter wavelength than the one "
                            "that excites; such light does not come back",
                            name, image->channel[c->channel[i]]);
    if (value > 0)
      matrix[from * c->count + to] =
          value / (c->edge_nm[from + 1] - c->edge_nm[from]) * c->lambda_nm[to] / c->lambda_nm[from];
  }
  return ABBE_OK;
}

static void print_rows(const abbe_spectral_channels *c, const double *matrix, size_t first,
                       size_t last, FILE *to) {
  char text[2][ABBE_NUMBER_TEXT_SIZE];
  fputs("{matrix: [", to);
  for (size_t i = first; i <= last && i + 1 < c->count; i++) {
    const double *row = matrix + i * c->count;
    fprintf(to, "%s{nm: %s, emission: [", i > first ? ", " : "",
            abbe_number_text(c->lambda_nm[i], text[0]));
    for (size_t k = i + 1; k < c->count; k++)
      fprintf(to, "%s[%s, %s]", k > i + 1 ? ", " : "", abbe_number_text(c->lambda_nm[k], text[0]),
              abbe_number_text((double)(float)row[k], text[1]));
    fputs("]}", to);
  }
  fputs("]}", to);
}

static abbe_result print(const abbe_image *image, const abbe_spectral_channels *c, const char *name,
                         char **out, abbe_error *error) {
  double *matrix = calloc(c->count * c->count + 1, sizeof *matrix);
  size_t first = c->count, last = 0, size;
  abbe_result result = matrix != NULL
                           ? read_matrix(image, c, name, matrix, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a matrix");
  for (size_t i = 0; result == ABBE_OK && i < c->count * c->count; i++) {
    if (!(matrix[i] > 0)) continue;
    first = first < c->count ? first : i / c->count;
    last = i / c->count;
  }
  if (result == ABBE_OK && first == c->count)
    result = abbe_error_set(error, ABBE_NOT_FOUND,
                            "%s: nothing is re-radiated between its bands; channels such as "
                            "T.400,000000nm.550,000000nm say it, beside bands of both wavelengths",
                            name);
  if (first == last) { /* the bands beside it have none */
    first -= first > 0;
    last += last + 2 < c->count;
  }
  FILE *to = result == ABBE_OK ? open_memstream(out, &size) : NULL;
  if (to != NULL) print_rows(c, matrix, first, last, to);
  if (result == ABBE_OK && (to == NULL || fclose(to) != 0))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a matrix");
  free(matrix);
  return result;
}

abbe_result abbe_reradiation_text(const abbe_image *image, const char *name, char **out,
                                  abbe_error *error) {
  abbe_spectral_channels c = {0};
  *out = NULL;
  abbe_result result = abbe_spectral_channels_find(image, NULL, name, &c, error);
  if (result == ABBE_OK) result = print(image, &c, name, out, error);
  abbe_spectral_channels_free(&c);
  return result;
}
