#include "colorimetry/spectral_picture/spectral_channels.h"

#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *text;
  int exponent;
} prefixes[] = {{"", 0},   {"Y", 24}, {"Z", 21},  {"E", 18},  {"P", 15},  {"T", 12},  {"G", 9},
                {"M", 6},  {"k", 3},  {"h", 2},   {"da", 1},  {"d", -1},  {"c", -2},  {"m", -3},
                {"u", -6}, {"n", -9}, {"p", -12}, {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24}};

/* "550,000000nm" or "5,45E14Hz" as nm; not above 0 where it is none. */
static double parse_place(const char *text) {
  const double light_nm_s = 299792458e9;
  char number[64];
  const size_t digits = strspn(text, "0123456789,"), length = strlen(text);
  size_t end = digits;
  if (digits == 0 || digits == strspn(text, ",")) return 0;
  if (text[end] == 'E' || text[end] == 'e') {
    size_t sign = text[end + 1] == '-' || text[end + 1] == '+';
    size_t power = strspn(text + end + 1 + sign, "0123456789");
    if (power > 0) end += 1 + sign + power;
  }
  if (end >= sizeof number || length - end > 4) return 0;
  memcpy(number, text, end);
  number[end] = '\0';
  char *comma = strchr(number, ',');
  if (comma != NULL) *comma = '.';
  const char *rest;
  double value = 0;
  if (!abbe_number_read(number, &rest, &value) || *rest != '\0') return 0;
  for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
    const size_t n = strlen(prefixes[i].text);
    if (strncmp(text + end, prefixes[i].text, n) != 0) continue;
    const char *unit = text + end + n;
    if (strcmp(unit, "m") == 0) return value * pow(10, prefixes[i].exponent + 9);
    if (strcmp(unit, "Hz") == 0) return light_nm_s / (value * pow(10, prefixes[i].exponent));
  }
  return 0;
}

abbe_spectral_kind abbe_spectral_channel_parse(const char *name, double *lambda_nm) {
  abbe_spectral_kind kind = ABBE_SPECTRAL_NONE;
  if (strncmp(name, "S0.", 3) == 0) kind = ABBE_SPECTRAL_EMISSIVE;
  if (strncmp(name, "T.", 2) == 0) kind = ABBE_SPECTRAL_REFLECTIVE;
  if (kind == ABBE_SPECTRAL_NONE) return kind;
  const double nm = parse_place(name + (kind == ABBE_SPECTRAL_EMISSIVE ? 3 : 2));
  if (!(nm > 0 && isfinite(nm))) return ABBE_SPECTRAL_NONE;
  *lambda_nm = nm;
  return kind;
}

typedef struct sample {
  double lambda_nm;
  size_t channel;
} sample;

static int ascending(const void *a, const void *b) {
  const double x = ((const sample *)a)->lambda_nm, y = ((const sample *)b)->lambda_nm;
  return (x > y) - (x < y);
}

/* The name without its layer, or NULL where it is not in that layer. */
static const char *within(const char *name, const char *layer) {
  if (layer == NULL) return name;
  const size_t n = strlen(layer);
  return strncmp(name, layer, n) == 0 && name[n] == '.' ? name + n + 1 : NULL;
}

static size_t collect(const abbe_image *image, const char *layer, abbe_spectral_kind kind,
                      sample *list) {
  size_t count = 0;
  for (size_t c = 0; c < image->channels; c++) {
    const char *name = within(image->channel[c], layer);
    if (name == NULL || abbe_spectral_channel_parse(name, &list[count].lambda_nm) != kind) continue;
    list[count++].channel = c;
  }
  qsort(list, count, sizeof *list, ascending);
  return count;
}

static abbe_result check(const abbe_image *image, const sample *list, size_t count,
                         const char *name, abbe_error *error) {
  for (size_t i = 1; i < count; i++)
    if (list[i].lambda_nm == list[i - 1].lambda_nm)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: the channels '%s' and '%s' are of one wavelength", name,
                            image->channel[list[i - 1].channel], image->channel[list[i].channel]);
  return ABBE_OK;
}

static size_t find_error(const abbe_image *image, size_t channel) {
  char name[300];
  const int n = snprintf(name, sizeof name, "stderr.%s", image->channel[channel]);
  return n > 0 && (size_t)n < sizeof name ? abbe_image_find_channel(image, name) : (size_t)-1;
}

static abbe_result fill(const abbe_image *image, const sample *list, size_t count, const char *name,
                        abbe_spectral_channels *out, abbe_error *error) {
  out->count = count;
  out->lambda_nm = calloc(count, sizeof *out->lambda_nm);
  out->edge_nm = calloc(count + 1, sizeof *out->edge_nm);
  out->channel = calloc(count, sizeof *out->channel);
  out->error = calloc(count, sizeof *out->error);
  if (out->lambda_nm == NULL || out->edge_nm == NULL || out->channel == NULL ||
      out->error == NULL) {
    abbe_spectral_channels_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its bands", name);
  }
  for (size_t i = 0; i < count; i++) {
    out->lambda_nm[i] = list[i].lambda_nm;
    out->channel[i] = list[i].channel;
    out->error[i] = find_error(image, list[i].channel);
    if (i > 0) out->edge_nm[i] = (list[i - 1].lambda_nm + list[i].lambda_nm) / 2;
  }
  if (count == 1) {
    out->edge_nm[0] = out->edge_nm[1] = out->lambda_nm[0];
    return ABBE_OK;
  }
  out->edge_nm[0] = fmax(0, 2 * out->lambda_nm[0] - out->edge_nm[1]);
  out->edge_nm[count] = 2 * out->lambda_nm[count - 1] - out->edge_nm[count - 1];
  return ABBE_OK;
}

abbe_result abbe_spectral_channels_find(const abbe_image *image, const char *layer,
                                        const char *name, abbe_spectral_channels *out,
                                        abbe_error *error) {
  ABBE_REQUIRE(image && name && out, error);
  *out = (abbe_spectral_channels){0};
  sample list[ABBE_IMAGE_MAX_CHANNELS + 1];
  abbe_spectral_kind kind = ABBE_SPECTRAL_EMISSIVE;
  size_t count = collect(image, layer, kind, list);
  if (count == 0) {
    kind = ABBE_SPECTRAL_REFLECTIVE;
    count = collect(image, layer, kind, list);
  }
  if (count == 0) return ABBE_OK;
  abbe_result result = check(image, list, count, name, error);
  if (result == ABBE_OK) result = fill(image, list, count, name, out, error);
  if (result == ABBE_OK) out->kind = kind;
  return result;
}

void abbe_spectral_channels_free(abbe_spectral_channels *c) {
  if (c == NULL) return;
  free(c->lambda_nm);
  free(c->edge_nm);
  free(c->channel);
  free(c->error);
  *c = (abbe_spectral_channels){0};
}
