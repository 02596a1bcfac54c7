#include "tests/check.h"

#include "colorimetry/difference.h"
#include "colorimetry/gamut.h"
#include "colorimetry/rgb_space.h"

/* [Sharma2005, table 1]: Lab 1, Lab 2, difference, printed to four places. */
static const double pairs[34][7] = {
    {50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425},
    {50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615},
    {50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412},
    {50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669},
    {50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461},
    {50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065},
    {50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492},
    {50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977},
    {50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030},
    {50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082}};

TEST(published_pairs) {
  for (int i = 0; i < 34; i++) {
    double d = abbe_difference_ciede2000(pairs[i], pairs[i] + 3);
    double back = abbe_difference_ciede2000(pairs[i] + 3, pairs[i]);
    if (fabs(d - pairs[i][6]) > 5.1e-5 || fabs(d - back) > 1e-12)
      fail_msg("pair %d: %.6f and back %.6f, published %.4f", i + 1, d, back, pairs[i][6]);
  }
}

/* CIE76 and CIE94 of one standard against three samples: figures that Lindbloom's calculator and
 * the tests of the library colour-science print alike. */
TEST(older_formulas) {
  static const double standard[3] = {100, 21.57210357, 272.22819350};
  static const double samples[3][5] = {
      {100, 426.67945353, 72.39590835, 451.713301974, 83.7792255009},
      {100, 74.05216981, 276.45318193, 52.6498611564, 10.0539319546},
      {100, 8.32281957, -73.58297716, 346.064891718, 57.5354537067}};
  for (int i = 0; i < 3; i++) {
    const double *lab = samples[i];
    assert_true(fabs(abbe_difference_cie76(standard, lab) - lab[3]) < 1e-6);
    assert_true(fabs(abbe_difference_cie94(standard, lab) - lab[4]) < 1e-6);
  }
  const double grey[3] = {50, 0, 0}, light[3] = {57, 0, 0};
  assert_true(abbe_difference_cie94(grey, light) == 7 && abbe_difference_cie76(grey, light) == 7);
}

/* [BT2408, table 1]: reference white is 58 % PQ, grey of 26 cd/m2 38 %; ends by definition. The
 * signal of 100 cd/m2 is 0.508 [BT2100]. */
TEST(pq) {
  assert_true(fabs(abbe_difference_pq(203) - 0.58) < 0.005);
  assert_true(fabs(abbe_difference_pq(26) - 0.38) < 0.005);
  assert_true(fabs(abbe_difference_pq(100) - 0.5081) < 5e-5);
  assert_true(fabs(abbe_difference_pq(10000) - 1) < 1e-12);
  assert_true(abbe_difference_pq(-1) < 1e-6 && abbe_difference_pq(2e4) == abbe_difference_pq(1e4));
  for (double light = 0.001; light < 1e4; light *= 3)
    assert_true(fabs(abbe_difference_pq_light(abbe_difference_pq(light)) / light - 1) < 1e-9);
}

/* Linear Rec.2020 in cd/m2 and its I, Ct, Cp, and a distance, as the tests of colour-science print
 * them; a neutral has neither Ct nor Cp. */
TEST(ictcp) {
  static const double rgb[3] = {0.45620519, 0.03081071, 0.04091952};
  static const double expected[3] = {0.07351364, 0.00475253, 0.09351596};
  static const double a[3] = {0.4885468072, -0.04739350675, 0.07475401302},
                      b[3] = {0.4899203231, -0.04567508203, 0.07361341775};
  double to[9], xyz[3], ictcp[3];
  abbe_gamut_to_xyz(ABBE_GAMUT_REC2020, to);
  abbe_rgb_space_apply(to, rgb, xyz);
  abbe_difference_ictcp(xyz, ictcp);
  for (int c = 0; c < 3; c++) assert_true(fabs(ictcp[c] - expected[c]) < 1e-7);
  assert_true(fabs(abbe_difference_itp(a, b) - 1.42657228) < 1e-7);
  const double white[3] = {203 * 0.3127 / 0.3290, 203, 203 * 0.3583 / 0.3290};
  abbe_difference_ictcp(white, ictcp);
  assert_true(fabs(ictcp[0] - abbe_difference_pq(203)) < 1e-9);
  assert_true(fabs(ictcp[1]) < 1e-9 && fabs(ictcp[2]) < 1e-9);
}

TEST(equal_colours) {
  const double black[3] = {0, 0, 0}, red[3] = {50, 80, 60};
  assert_true(abbe_difference_ciede2000(black, black) == 0);
  assert_true(abbe_difference_ciede2000(red, red) == 0);
}

TEST(lab) {
  const double white[3] = {0.9505, 1, 1.089};
  double lab[3];
  abbe_difference_lab(white, white, lab);
  assert_true(fabs(lab[0] - 100) < 1e-12 && lab[1] == 0 && lab[2] == 0);
  const double grey[3] = {0.9505 * 0.18, 0.18, 1.089 * 0.18};
  abbe_difference_lab(grey, white, lab);
  assert_true(fabs(lab[0] - (116 * cbrt(0.18) - 16)) < 1e-12 && fabs(lab[1]) < 1e-12);
  const double dark[3] = {0, 0.001, 0};
  abbe_difference_lab(dark, white, lab);
  assert_true(fabs(lab[0] - 0.9033) < 1e-4);
  const double negative[3] = {-0.1, 0.2, 1};
  abbe_difference_lab(negative, white, lab);
  assert_true(isfinite(lab[0]) && isfinite(lab[1]) && isfinite(lab[2]));
}

/* D65 and A as [CIE15] prints them. */
TEST(uv) {
  const double d65[3] = {95.047, 100, 108.883}, a[3] = {1.0985, 1, 0.35585};
  const double dark[][3] = {{0, 0, 0}, {1, 0, 1}, {-20, 1, 0}, {NAN, 1, 1}};
  double uv[2] = {7, 7};
  for (int i = 0; i < 4; i++) assert_false(abbe_difference_uv(dark[i], uv));
  assert_true(uv[0] == 7 && uv[1] == 7);
  assert_true(abbe_difference_uv(d65, uv));
  assert_true(fabs(uv[0] - 0.1978) < 5e-5 && fabs(uv[1] - 0.4683) < 5e-5);
  assert_true(abbe_difference_uv(a, uv));
  assert_true(fabs(uv[0] - 0.2560) < 5e-5 && fabs(uv[1] - 0.5243) < 5e-5);
}
