/* gamut_map.h: colours outside of a display's gamut, brought inside by one of three mappings.
 *
 * Only what needs less than nothing of a primary is changed (compression also changes what is near
 * that): brightness above a display's white is its view's matter. None depends on exposure. XYZ is
 * relative to D65. Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_GAMUT_GAMUT_MAP_H
#define ABBE_COLORIMETRY_GAMUT_GAMUT_MAP_H

#include "base/error.h"

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
#endif
