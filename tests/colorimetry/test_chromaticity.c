#include "tests/check.h"

#include "colorimetry/chromaticity.h"

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
