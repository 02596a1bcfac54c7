#include "tests/check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/colour_temperature.h"

static void to_1960(const double xy[2], double uv[2]) {
  abbe_chromaticity_uv_of_xy(xy, uv);
  uv[1] *= 2.0 / 3;
}

/* u, v (1960) of Planckian radiators by the CIE's 1 nm table, as [Colour] has them. */
TEST(planckian_locus) {
  double xy[2], uv[2];
  abbe_colour_temperature_planck_xy(1000, xy);
  to_1960(xy, uv);
  assert_near(uv[0], 0.44796288, 5e-5);
  assert_near(uv[1], 0.35462962, 2e-5);
  abbe_colour_temperature_planck_xy(1010, xy);
  to_1960(xy, uv);
  assert_near(uv[0], 0.44563516, 5e-5);
  assert_near(uv[1], 0.35483063, 2e-5);
  /* the end of the locus [WyszeckiStiles1982] */
  abbe_colour_temperature_planck_xy(1e9, xy);
  to_1960(xy, uv);
  assert_near(uv[0], 0.18006, 3e-5);
  assert_near(uv[1], 0.26352, 3e-5);
}

/* Colour and correlated colour temperature of the CIE's illuminants, as [CIE15] prints them:
 * chromaticities to four or five places, temperatures of the lamps F to 10 or 50 K. */
TEST(the_cies_lights) {
  static const struct {
    const char *name;
    double x, y, kelvin, tolerance;
  } light[] = {{"A", 0.44757, 0.40745, 2856, 1},    {"D50", 0.34567, 0.35850, 5003, 2},
               {"D55", 0.33242, 0.34743, 5503, 2},  {"D65", 0.31272, 0.32903, 6504, 2},
               {"D75", 0.29902, 0.31485, 7504, 3},  {"F1", 0.3131, 0.3371, 6430, 10},
               {"F2", 0.3721, 0.3751, 4230, 8},     {"F3", 0.4091, 0.3941, 3450, 8},
               {"F4", 0.4402, 0.4031, 2940, 8},     {"F5", 0.3138, 0.3452, 6350, 10},
               {"F6", 0.3779, 0.3882, 4150, 8},     {"F7", 0.3129, 0.3292, 6500, 10},
               {"F8", 0.3458, 0.3586, 5000, 8},     {"F9", 0.3741, 0.3727, 4150, 8},
               {"F10", 0.3458, 0.3588, 5000, 8},    {"F11", 0.3805, 0.3769, 4000, 8},
               {"F12", 0.4370, 0.4042, 3000, 8},    {"LED-B1", 0.4560, 0.4078, 2733, 2},
               {"LED-B3", 0.3756, 0.3723, 4103, 3}, {"LED-B5", 0.3118, 0.3236, 6598, 10},
               {"LED-BH1", 0.4474, 0.4066, 2851, 2}};
  for (size_t i = 0; i < sizeof light / sizeof *light; i++) {
    double kelvin, duv;
    assert_true(abbe_colour_temperature_find((double[]){light[i].x, light[i].y}, &kelvin, &duv));
    if (fabs(kelvin - light[i].kelvin) > light[i].tolerance)
      fail_msg("%s: %.2f K, printed %g", light[i].name, kelvin, light[i].kelvin);
  }
}

/* u', v' back to x, y. */
static void xy_of_uv(const double uv[2], double xy[2]) {
  const double sum = 6 * uv[0] - 16 * uv[1] + 12;
  xy[0] = 9 * uv[0] / sum;
  xy[1] = 4 * uv[1] / sum;
}

/* [Ohno2014]'s method, as [Colour] has it carried out. */
TEST(ohnos) {
  const double uv[2] = {0.1978, 0.3122 * 1.5};
  double xy[2], kelvin, duv;
  xy_of_uv(uv, xy);
  assert_true(abbe_colour_temperature_find(xy, &kelvin, &duv));
  assert_near(kelvin, 6507.4738, 1);
  assert_near(duv, 0.00322335, 2e-6);
}

/* Off the locus by a known distance, straight across it. */
TEST(across_the_locus) {
  for (double mired = 20; mired <= 900; mired += 55)
    for (double away = -0.02; away <= 0.021; away += 0.01) {
      double xy[3][2], uv[3][2], at[2], kelvin, duv;
      for (int i = 0; i < 3; i++) {
        abbe_colour_temperature_planck_xy(1e6 / (mired + 0.01 * (i - 1)), xy[i]);
        to_1960(xy[i], uv[i]);
      }
      const double dx = uv[2][0] - uv[0][0], dy = uv[2][1] - uv[0][1], length = hypot(dx, dy);
      at[0] = uv[1][0] - away * dy / length;
      at[1] = (uv[1][1] + away * dx / length) * 1.5;
      xy_of_uv(at, xy[1]);
      assert_true(abbe_colour_temperature_find(xy[1], &kelvin, &duv));
      assert_near(1e6 / kelvin, mired, 2e-3);
      assert_near(duv, away, 1e-8);
    }
}

TEST(without_one) {
  static const double none[][2] = {{0.17, 0.01}, {0.1, 0.8},      {0.73, 0.26},
                                   {NAN, 0.3},   {0.3, INFINITY}, {0.15, 0.06}};
  for (int i = 0; i < 6; i++) {
    double kelvin = 7, duv = 7;
    assert_false(abbe_colour_temperature_find(none[i], &kelvin, &duv));
    assert_true(isnan(kelvin) && isnan(duv));
  }
}

/* [CIE15]: D50, D55, D65, D75 are at 5003, 5503, 6504 and 7504 K of today's c2. Their
 * tables are rounded: all four lie 0.9e-4 to 1.3e-4 below the formula's y. */
TEST(daylight) {
  static const double known[4][3] = {{1.4388 / 1.4380 * 5000, 0.34567, 0.35850},
                                     {1.4388 / 1.4380 * 5500, 0.33242, 0.34743},
                                     {1.4388 / 1.4380 * 6500, 0.31272, 0.32903},
                                     {1.4388 / 1.4380 * 7500, 0.29902, 0.31485}};
  double xy[2] = {7, 7};
  assert_false(abbe_colour_temperature_daylight_xy(3999, xy));
  assert_false(abbe_colour_temperature_daylight_xy(25001, xy));
  assert_false(abbe_colour_temperature_daylight_xy(NAN, xy));
  assert_true(xy[0] == 7);
  for (int i = 0; i < 4; i++) {
    assert_true(abbe_colour_temperature_daylight_xy(known[i][0], xy));
    assert_near(xy[0], known[i][1], 5e-5);
    assert_near(xy[1], known[i][2] + 1.1e-4, 2e-5);
  }
}

TEST(planck) {
  assert_near(abbe_colour_temperature_planck(2856, 560), 100, 1e-12);
  /* A, whose table [CIE15] prints with c2 = 1.435e7 at 2848 K: the same ratio */
  assert_near(abbe_colour_temperature_planck(2848 * 1.4388 / 1.435, 380), 9.79510, 5e-5);
  assert_near(abbe_colour_temperature_planck(2848 * 1.4388 / 1.435, 780), 241.675, 5e-3);
  assert_true(abbe_colour_temperature_planck(0, 500) == 0);
  assert_true(abbe_colour_temperature_planck(5000, 0) == 0);
  assert_true(isfinite(abbe_colour_temperature_planck(1, 300)));
}

TEST(a_white_in_words) {
  static const char *const wrong[] = {"",     "warm",     "0.3127",     "999",        "25001",
                                      "0.3,", "0.3,0.3,", "0.7,0.4",    "-0.3,0.3",   "2856 K",
                                      "nan",  "0.3;0.3",  "0.3127,nan", "1e999,0.329"};
  double xy[2], expected[2];
  assert_true(abbe_colour_temperature_read_white("0.3127,0.3290", xy));
  assert_true(xy[0] == 0.3127 && xy[1] == 0.3290);
  assert_true(abbe_colour_temperature_read_white("6504", xy));
  assert_true(fabs(xy[0] - 0.3127) < 1e-4 && fabs(xy[1] - 0.3290) < 2e-4); /* D65 [CIE15] */
  abbe_colour_temperature_planck_xy(2856, expected);
  assert_true(abbe_colour_temperature_read_white("2856", xy));
  assert_true(xy[0] == expected[0] && xy[1] == expected[1]);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    if (abbe_colour_temperature_read_white(wrong[i], xy)) fail_msg("'%s' is taken", wrong[i]);
}
