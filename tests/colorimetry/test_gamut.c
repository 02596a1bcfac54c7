/* Gamuts against published matrices, and what is outside of them. */
#include "tests/check.h"

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
  assert_string_equal(abbe_gamut_name(ABBE_GAMUT_COUNT), "unknown");
}

TEST(excess) {
  const double in[3] = {2, 0, 1}, out[3] = {2, -0.5, 1}, dark[3] = {0, 0, 0},
               under[3] = {-3, -1, 0};
  assert_near(abbe_gamut_excess(in), 0, 0);
  assert_near(abbe_gamut_excess(out), 0.25, 1e-15);
  assert_near(abbe_gamut_excess(dark), 0, 0);
  assert_near(abbe_gamut_excess(under), 1, 0);
}
