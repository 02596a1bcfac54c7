/* rgb_space.h: the linear colour spaces that pictures are kept in, and their transforms from XYZ.
 *
 * XYZ here is relative to D65: an object lit by D65 has the chromaticity of D65, and the RGB
 * spaces' whites are D65 (Rec.709) and the ACES white (ACEScg, reached from D65 by the Bradford
 * transform, as OpenColorIO's own built-in transforms do). Negative components are kept.
 *
 * The matrices come from the published chromaticities, whose D65 is (0.3127, 0.3290). The white of
 * illuminant D65's table is (0.31272, 0.32903), so it is (1, 1, 1) to 5e-4 only, a CIEDE2000 of
 * 0.03; it is left so, because files then mean what their chromaticities state. */
#ifndef ABBE_COLORIMETRY_RGB_SPACE_H
#define ABBE_COLORIMETRY_RGB_SPACE_H

#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* X(code, name on the command line, name in the OCIO config) */
#define ABBE_RGB_SPACES(X)                                                                         \
  X(ACESCG, "acescg", "ACEScg")                                                                    \
  X(REC709, "rec709", "Linear Rec.709 (sRGB)")                                                     \
  X(XYZ, "xyz", "CIE XYZ-D65")

typedef enum abbe_rgb_space {
#define ABBE_RGB_SPACE_ENUM(code, name, ocio) ABBE_RGB_SPACE_##code,
  ABBE_RGB_SPACES(ABBE_RGB_SPACE_ENUM)
#undef ABBE_RGB_SPACE_ENUM
      ABBE_RGB_SPACE_COUNT
} abbe_rgb_space;

const char *abbe_rgb_space_name(abbe_rgb_space space);
const char *abbe_rgb_space_ocio_name(abbe_rgb_space space);

/* Row-major 3x3 matrix from XYZ (D65) to the space; identity for XYZ. */
void abbe_rgb_space_from_xyz(abbe_rgb_space space, double matrix[9]);
void abbe_rgb_space_to_xyz(abbe_rgb_space space, double matrix[9]);
/* xy of red, green, blue, white, as OpenEXR's chromaticities attribute wants them (for XYZ: the
 * primaries (1,0), (0,1), (0,0) and white E as the convention is). */
void abbe_rgb_space_chromaticities(abbe_rgb_space space, double xy[8]);
/* The space of these chromaticities (to 1e-5, as files keep them in single precision), or
 * ABBE_RGB_SPACE_COUNT where they are of none of these. */
abbe_rgb_space abbe_rgb_space_of_chromaticities(const double xy[8]);
/* Row-major 3x3 matrix to XYZ (D65) from the linear RGB of any chromaticities; a white other than
 * D65 is adapted by Bradford. ABBE_INVALID_ARGUMENT where they span no space: primaries on a line,
 * a y of 0, something not finite. */
abbe_result abbe_rgb_space_chromaticities_to_xyz(const double xy[8], double matrix[9],
                                                 abbe_error *error);
/* Row-major 3x3 matrix from XYZ relative to one white to XYZ relative to another, by the Bradford
 * transform [Lam1985]. Whites are x, y; their y is above 0. */
void abbe_rgb_space_adapt(const double from_xy[2], const double to_xy[2], double matrix[9]);
/* out = matrix * in; in and out may be the same. */
void abbe_rgb_space_apply(const double matrix[9], const double in[3], double out[3]);

#ifdef __cplusplus
}
#endif

/* Products and inverses of row-major 3x3 matrices. */

/* out = a * b; out is neither. */
static inline void abbe_matrix3_multiply(const double a[9], const double b[9], double out[9]) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += a[3 * row + k] * b[3 * k + column];
      out[3 * row + column] = sum;
    }
}

/* By cofactors; of a singular matrix nothing finite. out is not m. */
static inline void abbe_matrix3_invert(const double m[9], double out[9]) {
  const double c[9] = {
      m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
      m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
      m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
  const double determinant = m[0] * c[0] + m[1] * c[3] + m[2] * c[6];
  for (int i = 0; i < 9; i++) out[i] = c[i] / determinant;
}

#endif
