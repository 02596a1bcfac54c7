/* gamut.h: the colours that a display or a space of RGB can hold.
 *
 * A gamut is three primaries and a white. Colours that need less than nothing of a primary are
 * outside, however much light there is; how bright a display gets is another matter. XYZ is
 * relative to D65, as everywhere here.
 */
#ifndef ABBE_COLORIMETRY_GAMUT_H
#define ABBE_COLORIMETRY_GAMUT_H

#include "base/error.h"

typedef enum abbe_gamut {
  ABBE_GAMUT_REC709,
  ABBE_GAMUT_P3,
  ABBE_GAMUT_REC2020,
  ABBE_GAMUT_ACESCG,
  ABBE_GAMUT_COUNT
} abbe_gamut;

/* x, y of red, green, blue, white. */
void abbe_gamut_chromaticities(abbe_gamut gamut, double xy[8]);
/* Row-major, between linear RGB of the gamut and XYZ relative to D65. */
void abbe_gamut_to_xyz(abbe_gamut gamut, double matrix[9]);
void abbe_gamut_from_xyz(abbe_gamut gamut, double matrix[9]);

/* Colours outside of a display's gamut, brought inside by one of three mappings.
 *
 * Only what needs less than nothing of a primary is changed (compression also changes what is near
 * that): brightness above a display's white is its view's matter. None depends on exposure. XYZ is
 * relative to D65. */

#ifdef __cplusplus
extern "C" {
#endif

/* X(code, name, text) */
#define ABBE_GAMUT_MAPS(X)                                                                         \
  X(NONE, "none", "left as it is")                                                                 \
  X(CLIP, "clip", "components below 0 made 0")                                                     \
  X(WHITE, "white", "towards white at constant Oklab lightness and hue")      /* [Ottosson2020] */ \
  X(COMPRESS, "compress", "distances from grey compressed, as ACES 1.3 does") /* [ACESGamut] */

typedef enum abbe_gamut_map_kind {
#define ABBE_GAMUT_MAP_ENUM(code, name, text) ABBE_GAMUT_MAP_##code,
  ABBE_GAMUT_MAPS(ABBE_GAMUT_MAP_ENUM)
#undef ABBE_GAMUT_MAP_ENUM
      ABBE_GAMUT_MAP_COUNT
} abbe_gamut_map_kind;

const char *abbe_gamut_map_name(abbe_gamut_map_kind kind);

typedef struct abbe_gamut_map {
  abbe_gamut_map_kind kind;
  double from_xyz[9], to_xyz[9]; /* between XYZ and the gamut's linear RGB */
  double limit[3], scale[3];     /* of the compression: for red, green, blue */
} abbe_gamut_map;

/* Into the gamut of these chromaticities (red, green, blue, white). The compression's limits are
 * the distances of the spectral colours of the 1931 observer, so that these end on the gamut's
 * edge; its thresholds and its power are the published ones. ABBE_INVALID_ARGUMENT where xy spans
 * no space. */
abbe_result abbe_gamut_map_make(abbe_gamut_map_kind kind, const double xy[8], abbe_gamut_map *out,
                                abbe_error *error);
/* xyz is replaced. What is not finite stays as it is. */
void abbe_gamut_map_apply(const abbe_gamut_map *map, double xyz[3]);

#ifdef __cplusplus
}
#endif

/* A space in which equal hues look of one hue, also of colours that are very saturated.
 *
 * Oklab [Ottosson2020] of XYZ relative to D65. Light k times as bright has L, a and b of k^(1/3)
 * times the size: hue and saturation do not depend on exposure. */

/* L (1: white), a, b of xyz, and back. */
void abbe_oklab_of_xyz(const double xyz[3], double lab[3]);
void abbe_oklab_to_xyz(const double lab[3], double xyz[3]);

#endif
