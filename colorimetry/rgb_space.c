#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { PRIMARIES = 6, XY_COUNT = 8 };

/* xy of red, green, blue, white: [BT709], [ACEScg]; XYZ as colour-space primaries. */
static const double chromaticities[ABBE_RGB_SPACE_COUNT][XY_COUNT] = {
    [ABBE_RGB_SPACE_ACESCG] = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767},
    [ABBE_RGB_SPACE_REC709] = {0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290},
    [ABBE_RGB_SPACE_XYZ] = {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3},
};

static const double white_d65[2] = {0.3127, 0.3290};

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* Cone responses of the Bradford transform [Lam1985], as ICC profiles print them. */
static const double bradford[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                   0.0367, 0.0389, -0.0685, 1.0296};

const char *abbe_rgb_space_name(abbe_rgb_space space) {
  static const char *const names[] = {
#define NAME(code, name, ocio) name,
      ABBE_RGB_SPACES(NAME)
#undef NAME
  };
  return (unsigned)space < ABBE_RGB_SPACE_COUNT ? names[space] : "unknown";
}

const char *abbe_rgb_space_ocio_name(abbe_rgb_space space) {
  static const char *const names[] = {
#define OCIO_NAME(code, name, ocio) ocio,
      ABBE_RGB_SPACES(OCIO_NAME)
#undef OCIO_NAME
  };
  return (unsigned)space < ABBE_RGB_SPACE_COUNT ? names[space] : "unknown";
}

void abbe_rgb_space_chromaticities(abbe_rgb_space space, double xy[8]) {
  memcpy(xy, chromaticities[space], sizeof chromaticities[space]);
}

void abbe_rgb_space_apply(const double matrix[9], const double in[3], double out[3]) {
  const double v[3] = {in[0], in[1], in[2]};
  for (int row = 0; row < 3; row++)
    out[row] = matrix[3 * row] * v[0] + matrix[3 * row + 1] * v[1] + matrix[3 * row + 2] * v[2];
}

static void xyz_of_xy(const double xy[2], double xyz[3]) {
  xyz[0] = xy[0] / xy[1];
  xyz[1] = 1;
  xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
}

/* RGB to XYZ relative to the space's own white: the primaries scaled to add up to it. */
static void primaries_to_xyz(const double xy[8], double matrix[9]) {
  double columns[9], inverse[9], white[3], scale[3];
  for (int i = 0; i < 3; i++) {
    columns[i] = xy[2 * i];
    columns[3 + i] = xy[2 * i + 1];
    columns[6 + i] = 1 - xy[2 * i] - xy[2 * i + 1];
  }
  xyz_of_xy(xy + PRIMARIES, white);
  abbe_matrix3_invert(columns, inverse);
  abbe_rgb_space_apply(inverse, white, scale);
  for (int i = 0; i < 9; i++) matrix[i] = columns[i] * scale[i % 3];
}

void abbe_rgb_space_adapt(const double from_xy[2], const double to_xy[2], double matrix[9]) {
  double from[3], to[3], inverse[9], scaled[9];
  xyz_of_xy(from_xy, from);
  xyz_of_xy(to_xy, to);
  abbe_rgb_space_apply(bradford, from, from);
  abbe_rgb_space_apply(bradford, to, to);
  for (int i = 0; i < 9; i++) scaled[i] = bradford[i] * to[i / 3] / from[i / 3];
  abbe_matrix3_invert(bradford, inverse);
  abbe_matrix3_multiply(inverse, scaled, matrix);
}

/* To XYZ relative to D65, of any primaries. */
static void rgb_to_xyz(const double xy[8], double matrix[9]) {
  double own[9];
  primaries_to_xyz(xy, own);
  if (memcmp(xy + PRIMARIES, white_d65, sizeof white_d65) == 0) {
    memcpy(matrix, own, sizeof own);
    return;
  }
  double adaptation[9];
  abbe_rgb_space_adapt(xy + PRIMARIES, white_d65, adaptation);
  abbe_matrix3_multiply(adaptation, own, matrix);
}

void abbe_rgb_space_to_xyz(abbe_rgb_space space, double matrix[9]) {
  if (space == ABBE_RGB_SPACE_XYZ)
    memcpy(matrix, identity, sizeof identity);
  else
    rgb_to_xyz(chromaticities[space], matrix);
}

abbe_rgb_space abbe_rgb_space_of_chromaticities(const double xy[8]) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    bool same = true;
    for (int i = 0; i < XY_COUNT; i++) same = same && fabs(xy[i] - chromaticities[s][i]) <= 1e-5;
    if (same) return (abbe_rgb_space)s;
  }
  return ABBE_RGB_SPACE_COUNT;
}

/* Twice the area of the triangle of the primaries. */
static double gamut(const double xy[8]) {
  return (xy[2] - xy[0]) * (xy[5] - xy[1]) - (xy[4] - xy[0]) * (xy[3] - xy[1]);
}

abbe_result abbe_rgb_space_chromaticities_to_xyz(const double xy[8], double matrix[9],
                                                 abbe_error *error) {
  abbe_rgb_space known = abbe_rgb_space_of_chromaticities(xy);
  if (known != ABBE_RGB_SPACE_COUNT) {
    abbe_rgb_space_to_xyz(known, matrix);
    return ABBE_OK;
  }
  bool spans = fabs(gamut(xy)) > 1e-6 && fabs(xy[PRIMARIES + 1]) > 1e-6;
  if (spans) rgb_to_xyz(xy, matrix);
  for (int i = 0; spans && i < 9; i++) spans = isfinite(matrix[i]);
  if (spans) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the chromaticities R (%g, %g), G (%g, %g), B (%g, %g), white (%g, %g) "
                        "span no colour space",
                        xy[0], xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
}

void abbe_rgb_space_from_xyz(abbe_rgb_space space, double matrix[9]) {
  double to[9];
  abbe_rgb_space_to_xyz(space, to);
  if (space == ABBE_RGB_SPACE_XYZ)
    memcpy(matrix, identity, sizeof identity);
  else
    abbe_matrix3_invert(to, matrix);
}
