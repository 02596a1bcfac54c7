/* Gamuts against published matrices, and what is outside of them. */
#include "tests/check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/gamut.h"
#include "colorimetry/rgb_space.h"

/* Luminances of the primaries as [BT2020] and [SMPTE-EG432] print them. */
TEST(published_luminances) {
  double m[9];
  abbe_gamut_to_xyz(ABBE_GAMUT_REC2020, m);
  assert_near(m[3], 0.2627, 5e-5);
  assert_near(m[4], 0.6780, 5e-5);
  assert_near(m[5], 0.0593, 5e-5);
  abbe_gamut_to_xyz(ABBE_GAMUT_P3, m);
  assert_near(m[3], 0.2290, 5e-5);
  assert_near(m[4], 0.6917, 5e-5);
  assert_near(m[5], 0.0793, 5e-5);
}

TEST(there_and_back) {
  const double xyz[3] = {0.3, 0.2, 0.7};
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++) {
    double from[9], to[9], v[3];
    abbe_gamut_from_xyz((abbe_gamut)g, from);
    abbe_gamut_to_xyz((abbe_gamut)g, to);
    abbe_rgb_space_apply(from, xyz, v);
    abbe_rgb_space_apply(to, v, v);
    for (int c = 0; c < 3; c++) assert_near(v[c], xyz[c], 1e-12);
  }
}

/* Gamut maps: what is inside stays, the spectrum comes inside, and each keeps what it says it
 * keeps. */

static abbe_gamut_map map_of(abbe_gamut_map_kind kind, abbe_gamut gamut) {
  double xy[8];
  abbe_gamut_map map;
  abbe_gamut_chromaticities(gamut, xy);
  OK(abbe_gamut_map_make(kind, xy, &map, &error));
  return map;
}

static void map_rgb(const abbe_gamut_map *map, double rgb[3]) {
  abbe_rgb_space_apply(map->to_xyz, rgb, rgb);
  abbe_gamut_map_apply(map, rgb);
  abbe_rgb_space_apply(map->from_xyz, rgb, rgb);
}

TEST(what_is_inside) {
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++)
    for (int k = 0; k < ABBE_GAMUT_MAP_COUNT; k++) {
      const abbe_gamut_map map = map_of((abbe_gamut_map_kind)k, (abbe_gamut)g);
      double soft[3] = {3, 1.2, 0.8}, pure[3] = {1, 0.5, 0}, grey[3] = {0.2, 0.2, 0.2};
      map_rgb(&map, soft);
      assert_near(soft[0], 3, 1e-12);
      assert_near(soft[1], 1.2, 1e-12);
      assert_near(soft[2], 0.8, 1e-12);
      map_rgb(&map, grey);
      assert_near(grey[2], 0.2, 1e-12);
      map_rgb(&map, pure);
      /* compression makes room for what is outside */
      assert_near(pure[2], 0, k == ABBE_GAMUT_MAP_COMPRESS ? 0.08 : 1e-9);
      assert_near(pure[0], 1, 1e-9);
    }
}

TEST(the_spectrum) {
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++)
    for (int k = ABBE_GAMUT_MAP_CLIP; k < ABBE_GAMUT_MAP_COUNT; k++) {
      const abbe_gamut_map map = map_of((abbe_gamut_map_kind)k, (abbe_gamut)g);
      for (double nm = 400; nm <= 700; nm++) {
        double xy[2], xyz[3], rgb[3], before[3], after[3];
        abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, nm, xy);
        assert_true(abbe_chromaticity_xyz(xy, xyz));
        abbe_oklab_of_xyz(xyz, before);
        abbe_gamut_map_apply(&map, xyz);
        abbe_rgb_space_apply(map.from_xyz, xyz, rgb);
        for (int c = 0; c < 3; c++) assert_true(rgb[c] > -1e-9 * fmax(1, rgb[0] + rgb[1] + rgb[2]));
        if (k != ABBE_GAMUT_MAP_WHITE) continue;
        abbe_oklab_of_xyz(xyz, after);
        assert_near(after[0], before[0], 1e-4 * before[0]);
        const double turn = atan2(before[1] * after[2] - before[2] * after[1],
                                  before[1] * after[1] + before[2] * after[2]);
        if (hypot(after[1], after[2]) > 0.01 * after[0]) assert_near(turn, 0, 1e-3);
      }
    }
}

/* The published curve, with distance 1.2, threshold 0.815 and limit 1.147 in hand, and its ends:
 * the limit becomes 1. */
TEST(compression) {
  const abbe_gamut_map map = map_of(ABBE_GAMUT_MAP_COMPRESS, ABBE_GAMUT_REC709);
  for (int c = 0; c < 3; c++) {
    double rgb[3] = {1, 1, 1};
    rgb[c] = 1 - map.limit[c];
    map_rgb(&map, rgb);
    assert_near(rgb[c], 0, 1e-9);
    assert_near(rgb[(c + 1) % 3], 1, 1e-9);
  }
  const double room = map.limit[0] - 0.815, over = 1 - 0.815;
  const double s = room / pow(pow(over / room, -1.2) - 1, 1 / 1.2);
  double rgb[3] = {0, 1, 1};
  map_rgb(&map, rgb);
  assert_near(rgb[0], 1 - 0.815 - over / pow(1 + pow(over / s, 1.2), 1 / 1.2), 1e-9);
  assert_true(map.limit[0] > 1.5 && map.limit[1] > 1 && map.limit[1] < 1.3); /* green is far out */
}

TEST(exposure) {
  for (int k = ABBE_GAMUT_MAP_CLIP; k < ABBE_GAMUT_MAP_COUNT; k++) {
    const abbe_gamut_map map = map_of((abbe_gamut_map_kind)k, ABBE_GAMUT_P3);
    double one[3] = {0.4, 0.2, -0.05}, bright[3] = {400, 200, -50};
    abbe_gamut_map_apply(&map, one);
    abbe_gamut_map_apply(&map, bright);
    for (int c = 0; c < 3; c++) assert_near(bright[c], 1000 * one[c], 1e-6);
  }
}

TEST(awkward) {
  for (int k = 0; k < ABBE_GAMUT_MAP_COUNT; k++) {
    const abbe_gamut_map map = map_of((abbe_gamut_map_kind)k, ABBE_GAMUT_REC709);
    double nan[3] = {NAN, 1, 1}, dark[3] = {0, 0, 0}, below[3] = {-1, -2, -3};
    abbe_gamut_map_apply(&map, nan);
    assert_true(isnan(nan[0]) && nan[1] == 1);
    abbe_gamut_map_apply(&map, dark);
    for (int c = 0; c < 3; c++) assert_near(dark[c], 0, 0);
    abbe_gamut_map_apply(&map, below);
    for (int c = 0; c < 3; c++) assert_true(isfinite(below[c]));
  }
  const double flat[8] = {0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3};
  abbe_gamut_map map;
  assert_int_equal(abbe_gamut_map_make(ABBE_GAMUT_MAP_CLIP, flat, &map, NULL),
                   ABBE_INVALID_ARGUMENT);
}

/* Oklab against the table of its author. */

TEST(published_table) {
  static const double rows[4][6] = {{0.950, 1, 1.089, 1, 0, 0},
                                    {1, 0, 0, 0.450, 1.236, -0.019},
                                    {0, 1, 0, 0.922, -0.671, 0.263},
                                    {0, 0, 1, 0.153, -1.415, -0.449}};
  for (int i = 0; i < 4; i++) {
    double lab[3], xyz[3];
    abbe_oklab_of_xyz(rows[i], lab);
    for (int c = 0; c < 3; c++) assert_near(lab[c], rows[i][3 + c], 6e-4);
    abbe_oklab_to_xyz(lab, xyz);
    for (int c = 0; c < 3; c++) assert_near(xyz[c], rows[i][c], 1e-12);
  }
}

/* Eight times the light is twice L, a and b. */
TEST(oklab_exposure) {
  const double xyz[3] = {0.3, 0.2, -0.01}, eight[3] = {2.4, 1.6, -0.08};
  double lab[2][3];
  abbe_oklab_of_xyz(xyz, lab[0]);
  abbe_oklab_of_xyz(eight, lab[1]);
  for (int c = 0; c < 3; c++) assert_near(lab[1][c], 2 * lab[0][c], 1e-12);
}
