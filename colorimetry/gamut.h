/* gamut.h: the colours that a display or a space of RGB can hold.
 *
 * A gamut is three primaries and a white. Colours that need less than nothing of a primary are
 * outside, however much light there is; how bright a display gets is another matter. XYZ is
 * relative to D65, as everywhere here. Internal to colorimetry/.
 */
#ifndef ABBE_COLORIMETRY_GAMUT_H
#define ABBE_COLORIMETRY_GAMUT_H

/* X(code, name on the command line, text) */
#define ABBE_GAMUTS(X)                                                                             \
  X(REC709, "rec709", "Rec.709 (sRGB)") /* [BT709] */                                              \
  X(P3, "p3", "Display P3")             /* [SMPTE-EG432] */                                        \
  X(REC2020, "rec2020", "Rec.2020")     /* [BT2020] */                                             \
  X(ACESCG, "acescg", "ACEScg")         /* [ACEScg] */

typedef enum abbe_gamut {
#define ABBE_GAMUT_ENUM(code, name, text) ABBE_GAMUT_##code,
  ABBE_GAMUTS(ABBE_GAMUT_ENUM)
#undef ABBE_GAMUT_ENUM
      ABBE_GAMUT_COUNT
} abbe_gamut;

const char *abbe_gamut_name(abbe_gamut gamut);
const char *abbe_gamut_text(abbe_gamut gamut);

/* x, y of red, green, blue, white. */
void abbe_gamut_chromaticities(abbe_gamut gamut, double xy[8]);
/* Row-major, between linear RGB of the gamut and XYZ relative to D65. */
void abbe_gamut_to_xyz(abbe_gamut gamut, double matrix[9]);
void abbe_gamut_from_xyz(abbe_gamut gamut, double matrix[9]);

/* How far RGB is outside: -min / max(|r|, |g|, |b|), 0 for what is inside, up to 1; and 1 where no
 * component is above 0 but one is below. */
double abbe_gamut_excess(const double rgb[3]);

#endif
