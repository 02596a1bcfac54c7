#include "colorimetry/gamut.h"

#include "colorimetry/matrix3.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <string.h>

static const double chromaticities[ABBE_GAMUT_COUNT][8] = {
    [ABBE_GAMUT_REC709] = {0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290},
    [ABBE_GAMUT_P3] = {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290},
    [ABBE_GAMUT_REC2020] = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290},
    [ABBE_GAMUT_ACESCG] = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767},
};

const char *abbe_gamut_name(abbe_gamut gamut) {
  static const char *const names[] = {
#define NAME(code, name, text) name,
      ABBE_GAMUTS(NAME)
#undef NAME
  };
  return (unsigned)gamut < ABBE_GAMUT_COUNT ? names[gamut] : "unknown";
}

const char *abbe_gamut_text(abbe_gamut gamut) {
  static const char *const texts[] = {
#define TEXT(code, name, text) text,
      ABBE_GAMUTS(TEXT)
#undef TEXT
  };
  return (unsigned)gamut < ABBE_GAMUT_COUNT ? texts[gamut] : "unknown";
}

void abbe_gamut_chromaticities(abbe_gamut gamut, double xy[8]) {
  memcpy(xy, chromaticities[gamut], sizeof chromaticities[gamut]);
}

void abbe_gamut_to_xyz(abbe_gamut gamut, double matrix[9]) {
  (void)abbe_rgb_space_chromaticities_to_xyz(chromaticities[gamut], matrix, NULL);
}

void abbe_gamut_from_xyz(abbe_gamut gamut, double matrix[9]) {
  double to[9];
  abbe_gamut_to_xyz(gamut, to);
  abbe_matrix3_invert(to, matrix);
}

double abbe_gamut_excess(const double rgb[3]) {
  const double least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
  const double most = fmax(fabs(rgb[0]), fmax(fabs(rgb[1]), fabs(rgb[2])));
  return least < 0 ? -least / most : 0;
}
