#include "tests/check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/colour_temperature.h"

static const double d65[2] = {0.3127, 0.3290};

TEST(diagrams) {
  /* D65 and A as [CIE15] prints them. */
  static const struct {
    double xyz[3], xy[2], uv[2];
  } white[2] = {{{95.047, 100, 108.883}, {0.3127, 0.3290}, {0.1978, 0.4683}},
                {{109.85, 100, 35.585}, {0.4476, 0.4074}, {0.2560, 0.5243}}};
  for (int i = 0; i < 2; i++) {
    double xy[2], uv[2], xyz[3];
    assert_true(abbe_chromaticity_xy(white[i].xyz, xy));
    abbe_chromaticity_uv_of_xy(xy, uv);
    assert_true(abbe_chromaticity_xyz(xy, xyz));
    for (int k = 0; k < 2; k++) {
      assert_near(xy[k], white[i].xy[k], 5e-5);
      assert_near(uv[k], white[i].uv[k], 5e-5);
    }
    for (int k = 0; k < 3; k++) assert_near(xyz[k], white[i].xyz[k] / 100, 1e-14);
  }
}

TEST(dark_has_none) {
  static const double dark[][3] = {{0, 0, 0},  {1, 0, 1},   {1, -1, 5},
                                   {-9, 1, 0}, {NAN, 1, 1}, {INFINITY, 1, 1}};
  double xy[2] = {7, 7}, xyz[3] = {7, 7, 7};
  for (int i = 0; i < 6; i++) assert_false(abbe_chromaticity_xy(dark[i], xy));
  assert_true(xy[0] == 7 && xy[1] == 7);
  assert_false(abbe_chromaticity_xyz((double[]){0.3, 0}, xyz));
  assert_false(abbe_chromaticity_xyz((double[]){0.3, NAN}, xyz));
  assert_true(xyz[0] == 7);
}

/* The locus of 1931 as [CIE15, table T.6] prints it. */
TEST(locus) {
  static const double at[][3] = {{400, 0.17334, 0.00480}, {450, 0.15664, 0.01771},
                                 {480, 0.09129, 0.13270}, {500, 0.00817, 0.53842},
                                 {520, 0.07430, 0.83380}, {555, 0.33736, 0.65885},
                                 {600, 0.62704, 0.37249}, {700, 0.73469, 0.26531}};
  double xy[2], end[2];
  for (int i = 0; i < 8; i++) {
    abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, at[i][0], xy);
    assert_near(xy[0], at[i][1], 1.01e-5);
    assert_near(xy[1], at[i][2], 1.01e-5);
  }
  abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, 1e9, end);
  assert_true(end[0] == xy[0] && end[1] == xy[1]);
}

/* The primaries of Rec.2020 are light of 630, 532 and 467 nm, to three decimals [BT2020]. */
TEST(rec2020_is_spectral) {
  static const double primary[3][3] = {
      {630, 0.708, 0.292}, {532, 0.170, 0.797}, {467, 0.131, 0.046}};
  for (int i = 0; i < 3; i++) {
    abbe_dominant d;
    assert_true(abbe_chromaticity_dominant(primary[i] + 1, d65, ABBE_OBSERVER_CIE_1931, &d));
    assert_near(d.lambda_nm, primary[i][0], 0.35);
    assert_near(d.purity, 1, 1.5e-3);
  }
}

/* Two colours under D65 as [Colour] has them: wavelengths to a whole nm, purity by the CIE's 1 nm
 * table from 360 to 830 nm. */
TEST(known_colours) {
  abbe_dominant d;
  assert_true(abbe_chromaticity_dominant((double[]){0.54369557, 0.32107944}, d65,
                                         ABBE_OBSERVER_CIE_1931, &d));
  assert_near(d.lambda_nm, 616, 0.6);
  assert_near(d.complementary_nm, 492, 0.6);
  assert_near(d.purity, 0.622885671878446, 2e-5);
  assert_true(abbe_chromaticity_dominant((double[]){0.37605506, 0.24452225}, d65,
                                         ABBE_OBSERVER_CIE_1931, &d));
  assert_true(isnan(d.lambda_nm));
  assert_near(d.complementary_nm, 509, 0.6);
  /* their purple line goes from 360 to 830 nm */
  assert_near(d.purity, 0.438347859215887, 4e-4);
}

/* Mixtures of white and one wavelength, of every observer: the wavelength and the share of the
 * way. */
TEST(mixtures) {
  for (int o = 0; o < ABBE_OBSERVER_COUNT; o++)
    for (double nm = 410; nm <= 690; nm += 7)
      for (double share = 0.1; share < 1.5; share += 0.3) {
        double locus[2], xy[2];
        abbe_dominant d;
        abbe_chromaticity_locus((abbe_observer)o, nm, locus);
        for (int k = 0; k < 2; k++) xy[k] = d65[k] + share * (locus[k] - d65[k]);
        assert_true(abbe_chromaticity_dominant(xy, d65, (abbe_observer)o, &d));
        double at[2];
        abbe_chromaticity_locus((abbe_observer)o, d.lambda_nm, at);
        assert_near(hypot(at[0] - locus[0], at[1] - locus[1]), 0, 2e-4);
        if (nm > 420 && nm < 660) assert_near(d.lambda_nm, nm, 0.02);
        assert_near(d.purity, share, 1e-3);
      }
}

TEST(without_a_direction) {
  abbe_dominant d;
  assert_false(abbe_chromaticity_dominant(d65, d65, ABBE_OBSERVER_CIE_1931, &d));
  assert_true(isnan(d.lambda_nm) && isnan(d.complementary_nm) && d.purity == 0);
  const double odd[][2] = {{NAN, 0.3}, {0.3, INFINITY}};
  for (int i = 0; i < 2; i++) {
    assert_false(abbe_chromaticity_dominant(odd[i], d65, ABBE_OBSERVER_CIE_1931, &d));
    assert_true(isnan(d.purity));
  }
  /* a white outside the locus */
  assert_false(abbe_chromaticity_dominant(d65, (double[]){0.9, 0.9}, ABBE_OBSERVER_CIE_1931, &d));
  assert_false(abbe_chromaticity_dominant((double[]){0.2, 0.2}, d65, ABBE_OBSERVER_COUNT, &d));
}

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
