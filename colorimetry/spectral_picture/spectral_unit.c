#include "colorimetry/spectral_picture/spectral_unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *text;
  int exponent;
} prefixes[] = {{"", 0},   {"Y", 24}, {"Z", 21},  {"E", 18},  {"P", 15},  {"T", 12},  {"G", 9},
                {"M", 6},  {"k", 3},  {"h", 2},   {"da", 1},  {"d", -1},  {"c", -2},  {"m", -3},
                {"u", -6}, {"n", -9}, {"p", -12}, {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24}};

bool abbe_spectral_prefix(const char *text, size_t length, int *exponent) {
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
        abbe_spectral_prefix(c, length - own, &prefix))
      unit = u;
  }
  c += length;
  c += *c == '^';
  const bool negative = *c == '-';
  c += negative;
  if (*c >= '1' && *c <= '9')
    exponent = *c++ - '0';
  else if (negative || c[-1] == '^')
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
