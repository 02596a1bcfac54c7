#include "colorimetry/gamut.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double chromaticities[ABBE_GAMUT_COUNT][8] = {
    [ABBE_GAMUT_REC709] = {0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290},
    [ABBE_GAMUT_P3] = {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290},
    [ABBE_GAMUT_REC2020] = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290},
    [ABBE_GAMUT_ACESCG] = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767},
};

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

/* [ACESGamut]: of the distances from grey of red, green and blue, and the curve's power. */
static const double thresholds[3] = {0.815, 0.803, 0.880};
static const double power = 1.2;

const char *abbe_gamut_map_name(abbe_gamut_map_kind kind) {
  static const char *const names[] = {
#define GAMUT_MAP_NAME(code, name, text) name,
      ABBE_GAMUT_MAPS(GAMUT_MAP_NAME)
#undef GAMUT_MAP_NAME
  };
  return (unsigned)kind < ABBE_GAMUT_MAP_COUNT ? names[kind] : "unknown";
}

static double greatest(const double rgb[3]) {
  return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

/* The furthest that spectral colours are from grey, a component at a time. */
static void find_limits(abbe_gamut_map *map) {
  double first, last;
  abbe_chromaticity_locus_ends(ABBE_OBSERVER_CIE_1931, &first, &last);
  for (double nm = first; nm <= last; nm++) {
    double xy[2], v[3];
    abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, nm, xy);
    if (!abbe_chromaticity_xyz(xy, v)) continue;
    abbe_rgb_space_apply(map->from_xyz, v, v);
    const double most = greatest(v);
    for (int c = 0; c < 3 && most > 0; c++)
      map->limit[c] = fmax(map->limit[c], (most - v[c]) / most);
  }
}

/* The curve goes through (threshold, threshold) with a slope of 1 and through (limit, 1). */
static void find_scales(abbe_gamut_map *map) {
  for (int c = 0; c < 3; c++) {
    const double room = map->limit[c] - thresholds[c];
    const double ratio = (1 - thresholds[c]) / room;
    map->scale[c] = room / pow(pow(ratio, -power) - 1, 1 / power);
  }
}

abbe_result abbe_gamut_map_make(abbe_gamut_map_kind kind, const double xy[8], abbe_gamut_map *out,
                                abbe_error *error) {
  *out = (abbe_gamut_map){.kind = kind, .limit = {1 + 1e-6, 1 + 1e-6, 1 + 1e-6}};
  ABBE_TRY(abbe_rgb_space_chromaticities_to_xyz(xy, out->to_xyz, error));
  abbe_matrix3_invert(out->to_xyz, out->from_xyz);
  find_limits(out);
  find_scales(out);
  return ABBE_OK;
}

static void clip(double rgb[3]) {
  for (int c = 0; c < 3; c++) rgb[c] = fmax(rgb[c], 0);
}

static void compress(const abbe_gamut_map *map, double rgb[3]) {
  const double most = greatest(rgb);
  for (int c = 0; c < 3 && most > 0; c++) {
    const double distance = (most - rgb[c]) / most, over = distance - thresholds[c];
    if (over <= 0) continue;
    const double bent = over / pow(1 + pow(over / map->scale[c], power), 1 / power);
    rgb[c] = most * (1 - thresholds[c] - bent);
  }
  clip(rgb); /* imaginary colours; all below 0 is black */
}

static void take_colour(const abbe_gamut_map *map, const double lab[3], double share,
                        double rgb[3]) {
  const double less[3] = {lab[0], share * lab[1], share * lab[2]};
  double xyz[3];
  abbe_oklab_to_xyz(less, xyz);
  abbe_rgb_space_apply(map->from_xyz, xyz, rgb);
}

static bool inside(const double rgb[3], double slack) {
  return rgb[0] >= -slack && rgb[1] >= -slack && rgb[2] >= -slack;
}

/* The most of the colour's chroma that the gamut has. */
static void towards_white(const abbe_gamut_map *map, const double xyz[3], double rgb[3]) {
  double lab[3], low = 0, high = 1;
  if (inside(rgb, 0)) return;
  abbe_oklab_of_xyz(xyz, lab);
  for (int i = 0; i < 40; i++) {
    const double middle = (low + high) / 2;
    take_colour(map, lab, middle, rgb);
    if (inside(rgb, 0))
      low = middle;
    else
      high = middle;
  }
  take_colour(map, lab, low, rgb);
  clip(rgb);
}

void abbe_gamut_map_apply(const abbe_gamut_map *map, double xyz[3]) {
  double rgb[3];
  if (map->kind == ABBE_GAMUT_MAP_NONE || !isfinite(xyz[0] + xyz[1] + xyz[2])) return;
  abbe_rgb_space_apply(map->from_xyz, xyz, rgb);
  if (map->kind == ABBE_GAMUT_MAP_CLIP) clip(rgb);
  if (map->kind == ABBE_GAMUT_MAP_COMPRESS) compress(map, rgb);
  if (map->kind == ABBE_GAMUT_MAP_WHITE) towards_white(map, xyz, rgb);
  abbe_rgb_space_apply(map->to_xyz, rgb, xyz);
}

/* [Ottosson2020]: XYZ to cones, their cube roots to L, a, b. */
static const double cones[9] = {0.8189330101, 0.3618667424, -0.1288597137,
                                0.0329845436, 0.9293118715, 0.0361456387,
                                0.0482003018, 0.2643662691, 0.6338517070};
static const double opponents[9] = {0.2104542553, 0.7936177850,  -0.0040720468,
                                    1.9779984951, -2.4285922050, 0.4505937099,
                                    0.0259040371, 0.7827717662,  -0.8086757660};

void abbe_oklab_of_xyz(const double xyz[3], double lab[3]) {
  double v[3];
  abbe_rgb_space_apply(cones, xyz, v);
  for (int c = 0; c < 3; c++) v[c] = cbrt(v[c]);
  abbe_rgb_space_apply(opponents, v, lab);
}

void abbe_oklab_to_xyz(const double lab[3], double xyz[3]) {
  double inverse[9], v[3];
  abbe_matrix3_invert(opponents, inverse);
  abbe_rgb_space_apply(inverse, lab, v);
  for (int c = 0; c < 3; c++) v[c] = v[c] * v[c] * v[c];
  abbe_matrix3_invert(cones, inverse);
  abbe_rgb_space_apply(inverse, v, xyz);
}
