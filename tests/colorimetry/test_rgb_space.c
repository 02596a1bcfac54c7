#include "tests/check.h"

#include "colorimetry/rgb_space.h"

/* As published, rounded to the places printed. */
static const double xyz_to_rec709[9] = {3.2409699, -1.5373832, -0.4986108, -0.9692436, 1.8759675,
                                        0.0415551, 0.0556301,  -0.2039770, 1.0569715};
/* With the Bradford transform between the whites [ACEScg]. */
static const double acescg_to_rec709[9] = {1.70505,  -0.62179, -0.08326, -0.13026, 1.14080,
                                           -0.01055, -0.02400, -0.12897, 1.15297};

static void multiply(const double a[9], const double b[9], double out[9]) {
  for (int i = 0; i < 9; i++)
    out[i] =
        a[i / 3 * 3] * b[i % 3] + a[i / 3 * 3 + 1] * b[3 + i % 3] + a[i / 3 * 3 + 2] * b[6 + i % 3];
}

TEST(rec709_is_the_published_matrix) {
  double m[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, m);
  for (int i = 0; i < 9; i++)
    if (fabs(m[i] - xyz_to_rec709[i]) > 6e-8) fail_msg("element %d: %.9f", i, m[i]);
}

TEST(acescg_to_rec709_is_the_published_matrix) {
  double to_xyz[9], to_709[9], m[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, to_xyz);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, to_709);
  multiply(to_709, to_xyz, m);
  for (int i = 0; i < 9; i++)
    if (fabs(m[i] - acescg_to_rec709[i]) > 1e-5)
      fail_msg("element %d: %.9f, published %.5f", i, m[i], acescg_to_rec709[i]);
}

TEST(there_and_back) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    double to[9], from[9], product[9];
    abbe_rgb_space_to_xyz((abbe_rgb_space)s, to);
    abbe_rgb_space_from_xyz((abbe_rgb_space)s, from);
    multiply(to, from, product);
    for (int i = 0; i < 9; i++) assert_true(fabs(product[i] - (i % 4 == 0)) < 1e-14);
  }
}

TEST(nominal_d65_is_white) {
  const double d65[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  static const abbe_rgb_space spaces[] = {ABBE_RGB_SPACE_ACESCG, ABBE_RGB_SPACE_REC709};
  for (int s = 0; s < 2; s++) {
    double m[9], rgb[3];
    abbe_rgb_space_from_xyz(spaces[s], m);
    abbe_rgb_space_apply(m, d65, rgb);
    for (int k = 0; k < 3; k++) assert_true(fabs(rgb[k] - 1) < 1e-14);
  }
}

TEST(primaries_have_their_chromaticities) {
  double m[9], xy[8];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, m);
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, xy);
  for (int p = 0; p < 3; p++) {
    double sum = m[p] + m[3 + p] + m[6 + p];
    assert_true(fabs(m[p] / sum - xy[2 * p]) < 1e-14);
    assert_true(fabs(m[3 + p] / sum - xy[2 * p + 1]) < 1e-14);
  }
}

TEST(apply_in_place) {
  const double swap[9] = {0, 0, 1, 0, 1, 0, 1, 0, 0};
  double v[3] = {1, 2, 3};
  abbe_rgb_space_apply(swap, v, v);
  assert_true(v[0] == 3 && v[1] == 2 && v[2] == 1);
}

TEST(names) {
  assert_string_equal(abbe_rgb_space_name(ABBE_RGB_SPACE_ACESCG), "acescg");
  assert_string_equal(abbe_rgb_space_ocio_name(ABBE_RGB_SPACE_REC709), "Linear Rec.709 (sRGB)");
  assert_string_equal(abbe_rgb_space_name(ABBE_RGB_SPACE_COUNT), "unknown");
}

TEST(spaces_are_known_by_single_precision_chromaticities) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    double xy[8], expected[9], m[9];
    abbe_rgb_space_chromaticities((abbe_rgb_space)s, xy);
    for (int i = 0; i < 8; i++) xy[i] = (double)(float)xy[i];
    assert_int_equal(abbe_rgb_space_of_chromaticities(xy), s);
    abbe_rgb_space_to_xyz((abbe_rgb_space)s, expected);
    OK(abbe_rgb_space_chromaticities_to_xyz(xy, m, &error));
    assert_memory_equal(m, expected, sizeof m);
  }
}

/* Display P3's matrix as SMPTE and Apple publish it, to the places printed; and of any space the
 * white is D65's. */
TEST(other_chromaticities) {
  static const double p3[8] = {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290};
  static const double p3_to_xyz[9] = {0.4865709, 0.2656677, 0.1982173, 0.2289746, 0.6917385,
                                      0.0792869, 0.0,       0.0451134, 1.0439444};
  static const double d50[8] = {0.7347, 0.2653, 0.1596, 0.8404, 0.0366, 0.0001, 0.3457, 0.3585};
  double m[9], white[3] = {1, 1, 1};
  assert_int_equal(abbe_rgb_space_of_chromaticities(p3), ABBE_RGB_SPACE_COUNT);
  OK(abbe_rgb_space_chromaticities_to_xyz(p3, m, &error));
  for (int i = 0; i < 9; i++) assert_true(fabs(m[i] - p3_to_xyz[i]) < 1e-6);
  OK(abbe_rgb_space_chromaticities_to_xyz(d50, m, &error));
  abbe_rgb_space_apply(m, white, white);
  assert_true(fabs(white[0] - 0.3127 / 0.3290) < 1e-12 && fabs(white[1] - 1) < 1e-12);
}

TEST(chromaticities_that_span_nothing) {
  static const double bad[][8] = {{0},
                                  {0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.3, 0.3},
                                  {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3, 0},
                                  {NAN, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3, 0.3},
                                  {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, INFINITY, 0.3}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double m[9];
    REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_rgb_space_chromaticities_to_xyz(bad[i], m, &error));
    assert_true(last_error.text[0] != '\0');
  }
}

/* From illuminant A to D65, as B. Lindbloom prints it for these whites. */
TEST(published_adaptation) {
  static const double printed[9] = {0.8446965, -0.1179225, 0.3948108,  -0.1366303, 1.1041226,
                                    0.1291718, 0.0798489,  -0.1348999, 3.1924009};
  const double a_sum = 1.09850 + 1 + 0.35585, d65_sum = 0.95047 + 1 + 1.08883;
  const double a[2] = {1.09850 / a_sum, 1 / a_sum}, d65[2] = {0.95047 / d65_sum, 1 / d65_sum};
  double m[9];
  abbe_rgb_space_adapt(a, d65, m);
  for (int i = 0; i < 9; i++) assert_true(fabs(m[i] - printed[i]) < 1e-6);
}
