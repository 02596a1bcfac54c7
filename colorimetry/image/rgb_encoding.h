/* rgb_encoding.h: what the numbers of display-encoded pictures mean, by formula or by ICC profile.
 *
 * An encoding is the chromaticities of red, green, blue and white (as in abbe_image's xy) and one
 * curve for all three: light is c v where v < d, else (a v + b)^g, with curve = {g, a, b, c, d},
 * the parametric curve of [ICC2022]. All 0: not known. Profiles are made and applied by
 * Little CMS. It displays nothing and reads no files.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_RGB_ENCODING_H
#define ABBE_COLORIMETRY_IMAGE_RGB_ENCODING_H

#include "colorimetry/image/image.h"

#include <math.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Rec.709's primaries, D65 and the curve of [IEC61966]; P3's primaries with the same. */
void abbe_rgb_encoding_srgb(double xy[8], double curve[5]);
void abbe_rgb_encoding_display_p3(double xy[8], double curve[5]);
/* Whether it is sRGB, to the five decimals of PNG's own numbers. */
bool abbe_rgb_encoding_is_srgb(const double xy[8], const double curve[5]);
/* Whether it is known at all. */
bool abbe_rgb_encoding_is_known(const double xy[8], const double curve[5]);

/* Linear light of an encoded value, by the curve. */
double abbe_rgb_encoding_light(const double curve[5], double value);

/* The encoding of a display, from what it makes of rgb: of each probe the XYZ relative to its
 * white's Y = 1. False, and zeros, where it is none of this form: channels that do not add up, a
 * curve that is neither sRGB's nor a power, light in another unit. */
#define ABBE_RGB_ENCODING_PROBES 40
void abbe_rgb_encoding_probes(float rgb[ABBE_RGB_ENCODING_PROBES][3]);
bool abbe_rgb_encoding_of_probes(const float xyz[ABBE_RGB_ENCODING_PROBES][3], double xy[8],
                                 double curve[5]);

/* The same of an HDR display: PQ or HLG [BT2100], whatever light its greatest number is; *transfer
 * is the code of [H273], 16 or 18. False, and zeros, for neither. */
bool abbe_rgb_encoding_of_hdr_probes(const float xyz[ABBE_RGB_ENCODING_PROBES][3], double xy[8],
                                     int *transfer);
/* The code of [H273] for primaries, 1, 9 or 12; 0 where it has none for them. */
int abbe_rgb_encoding_primaries_code(const double xy[8]);
/* What codes of [H273] say: primaries 1, 9 or 12, and a transfer that is an SDR display's, 1, 4, 5,
 * 6, 8, 13, 14 or 15, or PQ or HLG, which leave curve as it is. False for others. */
bool abbe_rgb_encoding_of_codes(int primaries, int transfer, double xy[8], double curve[5]);
/* PQ or HLG numbers of a colour become light [BT2100] relative to the white of graphics,
 * 203 cd/m2 [BT2408]: HLG on a display of 1000 cd/m2. luminance: shares of R, G and B in Y. */
void abbe_rgb_encoding_hdr_light(int transfer, const double luminance[3], double rgb[3]);

/* An ICC profile of a known encoding, malloc'd, the same bytes each time. ABBE_COLOUR where Little
 * CMS makes none. */
abbe_result abbe_rgb_encoding_profile(const double xy[8], const double curve[5], void **icc,
                                      size_t *size, abbe_error *error);

/* Turn R, G, B as encoded by the image's own xy and curve, or by a profile for RGB or grey (of
 * which R = G = B is the value), into sRGB, relative to white; what sRGB cannot hold is clipped.
 * name is what errors call the picture. ABBE_INVALID_ARGUMENT for chromaticities of no space,
 * ABBE_COLOUR for a profile that cannot be used. */
abbe_result abbe_rgb_encoding_to_srgb(abbe_image *image, const char *name, abbe_error *error);
abbe_result abbe_rgb_encoding_profile_to_srgb(abbe_image *image, const void *icc, size_t size,
                                              const char *name, abbe_error *error);

/* Light from 0 to 1 by the curve of sRGB [IEC61966], with the rounded constants of its text. */
static inline double abbe_srgb_encoded(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

#ifdef __cplusplus
}
#endif
#endif
