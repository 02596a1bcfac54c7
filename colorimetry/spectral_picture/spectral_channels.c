#include "colorimetry/spectral_picture/spectral_channels.h"

#include "base/number.h"
#include "colorimetry/observer_integral.h"

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

/* The power of ten of an SI prefix of so many letters ("" is one); false: there is none. */
static bool spectral_prefix(const char *text, size_t length, int *exponent) {
  for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++)
    if (strlen(prefixes[i].text) == length && strncmp(prefixes[i].text, text, length) == 0) {
      *exponent = prefixes[i].exponent;
      return true;
    }
  return false;
}

enum { WATT, METRE, STERADIAN, UNITS };

/* One factor, "m^-2" or "m-2", into the powers of the units and of ten; after a '/' upside down. */
static bool read_factor(const char **text, bool below, int power[UNITS], int *ten) {
  static const char *const names[UNITS] = {"W", "m", "sr"};
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const char *c = *text;
  const size_t length = strspn(c, letters);
  int unit = UNITS, prefix = 0, exponent = 1;
  for (int u = 0; u < UNITS && unit == UNITS; u++) {
    const size_t own = strlen(names[u]);
    if (length >= own && strncmp(c + length - own, names[u], own) == 0 &&
        spectral_prefix(c, length - own, &prefix))
      unit = u;
  }
  c += length;
  const bool raised = *c == '^';
  c += raised;
  const bool negative = *c == '-';
  c += negative;
  if (*c >= '1' && *c <= '9')
    exponent = *c++ - '0';
  else if (negative || raised)
    return false;
  if (negative != below) exponent = -exponent;
  if (unit == UNITS) return false;
  power[unit] += exponent;
  *ten += prefix * exponent;
  *text = c;
  return true;
}

/* Factors of what light has are far below the power of ten that a double ends at. */
static bool read_factors(const char *text, int power[UNITS], int *ten) {
  enum { MOST_TEN = 250 };
  bool below = false;
  while (*text != '\0') {
    if (!read_factor(&text, below, power, ten) || abs(*ten) > MOST_TEN) return false;
    text += strspn(text, " ");
    below = *text == '/';
    if (*text == '.' || *text == '*' || *text == '/') text++;
    text += strspn(text, " ");
  }
  return true;
}

abbe_result abbe_spectral_unit_read(const char *text, const char *name, abbe_spectral_unit *out,
                                    abbe_error *error) {
  int power[UNITS] = {0}, ten = 0;
  *out = (abbe_spectral_unit){.quantity = ABBE_SPECTRAL_RADIANCE, .factor = 1};
  if (text == NULL) return ABBE_OK;
  const bool read = read_factors(text, power, &ten) && power[WATT] == 1;
  const int metres = power[METRE], steradians = power[STERADIAN];
  const bool a_length = metres == -3 || metres == -1;
  if (!read || metres > 0 || metres < -3 || steradians > 0 || steradians < -1)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "%s: its emissiveUnits are '%.60s'; W.m^-2.sr^-1, W.m^-2, W.sr^-1 and W can "
        "be read, with SI prefixes, and with nm^-1",
        name, text);
  const bool area = metres <= -2;
  out->quantity = area && steradians != 0 ? ABBE_SPECTRAL_RADIANCE
                  : area                  ? ABBE_SPECTRAL_IRRADIANCE
                  : steradians != 0       ? ABBE_SPECTRAL_INTENSITY
                                          : ABBE_SPECTRAL_FLUX;
  /* a metre of wavelength has 1e9 nm */
  out->factor = pow(10, ten - (a_length ? 9 : 0));
  return ABBE_OK;
}

const char *abbe_spectral_quantity_text(abbe_spectral_quantity quantity) {
  static const char *const texts[] = {"luminance, cd/m2", "illuminance, lx",
                                      "luminous intensity, cd", "luminous flux, lm"};
  return (unsigned)quantity < sizeof texts / sizeof *texts ? texts[quantity] : "unknown";
}

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
  const char *unit = text + end;
  const bool hertz = length - end >= 2 && strcmp(text + length - 2, "Hz") == 0;
  int exponent = 0;
  if (!hertz && (length == end || text[length - 1] != 'm')) return 0;
  if (!spectral_prefix(unit, length - end - (hertz ? 2 : 1), &exponent)) return 0;
  return hertz ? light_nm_s / (value * pow(10, exponent)) : value * pow(10, exponent + 9);
}

/* Behind the "T." of what reflects, which drafts of the layout call "M00."; NULL: it is none. */
static const char *behind_reflective(const char *name) {
  const size_t length = strncmp(name, "M00.", 4) == 0 ? 4 : strncmp(name, "T.", 2) == 0 ? 2 : 0;
  return length > 0 ? name + length : NULL;
}

abbe_spectral_kind abbe_spectral_channel_parse(const char *name, double *lambda_nm) {
  const bool emissive = strncmp(name, "S0.", 3) == 0;
  const char *place = emissive ? name + 3 : behind_reflective(name);
  const double nm = place != NULL ? parse_place(place) : 0;
  if (!(nm > 0 && isfinite(nm))) return ABBE_SPECTRAL_NONE;
  *lambda_nm = nm;
  return emissive ? ABBE_SPECTRAL_EMISSIVE : ABBE_SPECTRAL_REFLECTIVE;
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

/* "T.400nm.500nm": from and to, nm. */
static bool parse_reradiation(const char *name, double nm[2]) {
  const char *from = behind_reflective(name), *second = from != NULL ? strchr(from, '.') : NULL;
  char first[64];
  if (second == NULL || (size_t)(second - from) >= sizeof first) return false;
  snprintf(first, sizeof first, "%.*s", (int)(second - from), from);
  nm[0] = parse_place(first);
  nm[1] = parse_place(second + 1);
  return nm[0] > 0 && nm[1] > 0 && isfinite(nm[0]) && isfinite(nm[1]);
}

/* The band of that wavelength; count: none is. */
static size_t band_at(const abbe_spectral_channels *c, double nm) {
  size_t i = 0;
  while (i < c->count && fabs(c->lambda_nm[i] - nm) > 1e-6 * nm) i++;
  return i;
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
  out->count = out->terms = count;
  out->lambda_nm = calloc(count, sizeof *out->lambda_nm);
  out->edge_nm = calloc(count + 1, sizeof *out->edge_nm);
  out->channel = calloc(image->channels, sizeof *out->channel);
  out->error = calloc(image->channels, sizeof *out->error);
  out->between = calloc(image->channels, sizeof *out->between);
  if (out->lambda_nm == NULL || out->edge_nm == NULL || out->channel == NULL ||
      out->error == NULL || out->between == NULL) {
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

static abbe_result find_reradiation(const abbe_image *image, const char *layer, const char *name,
                                    abbe_spectral_channels *c, abbe_error *error) {
  for (size_t i = 0; i < image->channels; i++) {
    const char *own = within(image->channel[i], layer);
    double nm[2];
    if (own == NULL || !parse_reradiation(own, nm)) continue;
    const size_t from = band_at(c, nm[0]), to = band_at(c, nm[1]);
    if (from == c->count || to == c->count || from == to) continue;
    for (size_t k = c->count; k < c->terms; k++)
      if (c->between[k - c->count][0] == from && c->between[k - c->count][1] == to)
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%s: the channels '%s' and '%s' are of one pair of wavelengths", name,
                              image->channel[c->channel[k]], image->channel[i]);
    c->between[c->terms - c->count][0] = from;
    c->between[c->terms - c->count][1] = to;
    c->channel[c->terms] = i;
    c->error[c->terms++] = find_error(image, i);
  }
  return ABBE_OK;
}

abbe_result abbe_spectral_channels_find(const abbe_image *image, const char *layer,
                                        const char *name, abbe_spectral_channels *out,
                                        abbe_error *error) {
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
  const bool emissive = kind == ABBE_SPECTRAL_EMISSIVE;
  if (result == ABBE_OK && !emissive) result = find_reradiation(image, layer, name, out, error);
  const char *unit = emissive ? abbe_image_attribute_text(image, "emissiveUnits") : NULL;
  if (result == ABBE_OK) result = abbe_spectral_unit_read(unit, name, &out->unit, error);
  if (result != ABBE_OK) abbe_spectral_channels_free(out);
  return result;
}

/* "w420nm" and the like: letters, then a wavelength in nm of what the eye may see. */
static bool is_named_otherwise(const char *name) {
  const size_t letters = strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_");
  const size_t length = strlen(name);
  if (length - letters < 3 || length - letters > 12) return false;
  if (strcmp(name + length - 2, "nm") != 0) return false;
  const double nm = parse_place(name + letters);
  return nm >= 100 && nm <= 10000;
}

static bool is_reradiation(const char *name) {
  double nm[2];
  return parse_reradiation(name, nm);
}

/* "S0.nannm": what ends as a wavelength does and is none. */
static bool is_no_wavelength(const char *name) {
  double nm;
  const char *place = strncmp(name, "S0.", 3) == 0 ? name + 3 : behind_reflective(name);
  const size_t length = place != NULL ? strlen(place) : 0;
  return length > 2 && strcmp(place + length - 2, "nm") == 0 &&
         abbe_spectral_channel_parse(name, &nm) == ABBE_SPECTRAL_NONE && !is_reradiation(name);
}

static bool is_polarised(const char *name) {
  return name[0] == 'S' && name[1] >= '1' && name[1] <= '3' && name[2] == '.' &&
         parse_place(name + 3) > 0;
}

void abbe_spectral_channels_find_unread(const abbe_image *image, const char *layer,
                                        abbe_spectral_unread *out) {
  static bool (*const is[ABBE_SPECTRAL_UNREAD_COUNT])(const char *name) = {
      is_polarised, is_reradiation, is_named_otherwise, is_no_wavelength};
  *out = (abbe_spectral_unread){0};
  abbe_spectral_channels read = {0};
  (void)abbe_spectral_channels_find(image, layer, "", &read, NULL);
  for (size_t c = 0; c < image->channels; c++) {
    const char *name = within(image->channel[c], layer);
    for (size_t i = read.count; i < read.terms; i++)
      if (read.channel[i] == c) name = NULL;
    for (int k = 0; name != NULL && k < ABBE_SPECTRAL_UNREAD_COUNT; k++) {
      if (!is[k](name)) continue;
      if (out->count[k]++ == 0) out->first[k] = image->channel[c];
      break;
    }
  }
  abbe_spectral_channels_free(&read);
}

void abbe_spectral_channels_free(abbe_spectral_channels *c) {
  if (c == NULL) return;
  free(c->lambda_nm);
  free(c->edge_nm);
  free(c->channel);
  free(c->error);
  free(c->between);
  *c = (abbe_spectral_channels){0};
}

static const abbe_illuminant d65 = {.kind = ABBE_ILLUMINANT_D65};
static const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E}; /* with power 100 */

static const abbe_illuminant *seen_light(const abbe_spectral_channels *c,
                                         const abbe_spectral_view *view) {
  if (view->to != NULL) return view->to;
  return c->kind == ABBE_SPECTRAL_EMISSIVE && view->from != NULL ? view->from : &d65;
}

static void whole(const abbe_spectral_channels *c, abbe_observer observer,
                  const abbe_illuminant *light, double xyz[3]) {
  abbe_observer_integral_by(observer, light, c->edge_nm[0], c->edge_nm[c->count], xyz);
}

void abbe_spectral_colour_white(const abbe_spectral_channels *c, const abbe_spectral_view *view,
                                double xyz[3]) {
  whole(c, view->observer, seen_light(c, view), xyz);
  const double y = xyz[1];
  for (int k = 0; k < 3; k++) xyz[k] /= y;
}

static abbe_result spectral_colour_check(const abbe_spectral_channels *c,
                                         const abbe_spectral_view *view, const char *name,
                                         abbe_error *error) {
  if (c->count < 2)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: it has %s, of which nothing tells how wide it is; a colour needs two "
        "or more",
        name, c->count == 1 ? "one channel of a spectrum" : "no bands");
  if (c->kind == ABBE_SPECTRAL_EMISSIVE && view->to != NULL && view->from == NULL)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: it does not say which light it was made with, so there is no telling "
        "what it would be under another",
        name);
  double white[3];
  whole(c, view->observer, seen_light(c, view), white);
  if (white[1] > 0 && isfinite(white[1])) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: its bands, %g to %g nm, hold no light that the eye sees", name,
                        c->edge_nm[0], c->edge_nm[c->count]);
}

abbe_result abbe_spectral_colour_weights(const abbe_spectral_channels *c,
                                         const abbe_spectral_view *view, const char *name,
                                         double (*weight)[3], abbe_error *error) {
  ABBE_TRY(spectral_colour_check(c, view, name, error));
  const bool reflective = c->kind == ABBE_SPECTRAL_REFLECTIVE;
  const bool absolute = !reflective && view->from == NULL;
  const abbe_illuminant *light = absolute ? &even : seen_light(c, view);
  double white[3];
  whole(c, view->observer, light, white);
  const double power =
      absolute || reflective
          ? 1
          : abbe_observer_integral_power(view->from, c->edge_nm[0], c->edge_nm[c->count]);
  for (size_t i = 0; i < c->count; i++) {
    const double from = c->edge_nm[i], to = c->edge_nm[i + 1];
    abbe_observer_integral_by(view->observer, light, from, to, weight[i]);
    double factor = 1 / white[1];
    if (absolute) factor = ABBE_SPECTRAL_COLOUR_KM / 100;
    if (!absolute && !reflective) {
      /* the band of a light of one watt has this, a nm */
      const double mean = abbe_observer_integral_power(view->from, from, to) / (to - from) / power;
      factor = mean > 0 ? factor / mean : 0;
    }
    if (!reflective) factor *= c->unit.factor;
    for (int k = 0; k < 3; k++) weight[i][k] *= factor;
  }
  for (size_t i = c->count; i < c->terms; i++) {
    const size_t *at = c->between[i - c->count];
    const double *from = c->edge_nm + at[0], *to = c->edge_nm + at[1];
    const double mean = abbe_observer_integral_power(light, from[0], from[1]) / (from[1] - from[0]);
    abbe_observer_integral_by(view->observer, &even, to[0], to[1], weight[i]);
    for (int k = 0; k < 3; k++) weight[i][k] *= mean / 100 / white[1];
  }
  return ABBE_OK;
}
