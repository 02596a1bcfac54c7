/* Metrics against values worked out by hand, laws, and noise that is known because it is made. */
#include "tests/check.h"

#include "tests/validation/measure/fields.h"
#include "validation/measure/compare.h"
#include "validation/measure/compare_state.h"

TEST(equal_fields) {
  for (int what = 0; what < 2; what++) {
    OWNED(abbe_field, a) = field_of(13, 7, what);
    paint(&a);
    OWNED(abbe_comparison, c) = compare(&a, &a, NULL);
    for (int m = 0; m <= ABBE_COMPARE_UV_MEAN; m++)
      assert_near(abbe_compare_deviation((abbe_compare_metric)m, c.whole.metric[m].value), 0, 0);
    assert_true(isnan(value(&c.whole, ABBE_COMPARE_Z_EXCESS)));
    assert_true(isnan(value(&c.whole, ABBE_COMPARE_BANDS_RELATIVE_RMSE)));
    assert_true(isnan(c.whole.metric[ABBE_COMPARE_RELATIVE_RMSE].noise));
    assert_int_equal(c.whole.pixels, 91);
    assert_int_equal(c.whole.channels, 3);
    assert_false(c.masked);
    assert_near(c.whole.uv_share, 1, 1e-12);
    abbe_comparison_free(&c);
  }
}

/* Two pixels, Y only of note: b = 1, 3; a = 2, 3. Mean of b 4/3 over X, Y, Z of (1, 1, 1), (1, 3,
 * 1). */
TEST(by_hand) {
  OWNED(abbe_field, b) = field_of(2, 1, XYZ), a = field_of(2, 1, XYZ);
  const float reference[6] = {1, 1, 1, 1, 3, 1}, other[6] = {1, 2, 1, 1, 3, 1};
  memcpy(b.colour.value, reference, sizeof reference);
  memcpy(a.colour.value, other, sizeof other);
  OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
  assert_near(c.unit, 2, 1e-12);
  assert_near(value(&c.whole, ABBE_COMPARE_RELATIVE_RMSE), sqrt(1.0 / 6) / (8.0 / 6), 1e-12);
  /* in units of 2: a - b = 0.5, b = 0.5 */
  assert_near(value(&c.whole, ABBE_COMPARE_SQUARED_RELATIVE), 0.25 / (0.51 * 0.51) / 6, 1e-12);
  assert_near(value(&c.whole, ABBE_COMPARE_ENERGY_RATIO), 5.0 / 4, 1e-12);
  assert_string_equal(c.whole.channel[1].name, "Y");
  assert_near(c.whole.channel[1].mean_test, 2.5, 1e-12);
  assert_near(c.whole.channel[1].relative_rmse.value, sqrt(0.5) / 2, 1e-12);
  assert_near(c.whole.channel[0].relative_rmse.value, 0, 0);
  /* u', v' of (1, 1, 1) and (1, 2, 1), weighted 1 of 1 + 3 */
  double d = hypot(4.0 / 19 - 4.0 / 34, 9.0 / 19 - 18.0 / 34);
  assert_near(value(&c.whole, ABBE_COMPARE_UV_MEAN), d / 4, 1e-7);
  assert_near(c.white[1], 3, 1e-6);
  assert_true(c.white_found);
}

TEST(brighter_by_a_factor) {
  OWNED(abbe_field, b) = field_of(16, 16, XYZ), a = field_of(16, 16, XYZ);
  paint(&b);
  double mean = 0, square = 0;
  for (size_t i = 0; i < 768; i++) {
    double v = (double)b.colour.value[i];
    a.colour.value[i] = 2 * b.colour.value[i];
    mean += v / 768;
    square += v * v / 768;
  }
  OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
  assert_near(value(&c.whole, ABBE_COMPARE_RELATIVE_RMSE), sqrt(square) / mean, 1e-9);
  assert_near(value(&c.whole, ABBE_COMPARE_ENERGY_RATIO), 2, 1e-12);
  assert_near(value(&c.whole, ABBE_COMPARE_UV_MEAN), 0, 1e-7);
  assert_true(value(&c.whole, ABBE_COMPARE_CIEDE2000_MEAN) > 5);
  abbe_comparison_free(&c);
  const abbe_compare_options best = {.best_scale = true};
  c = compare(&b, &a, &best);
  assert_near(c.scale, 0.5, 1e-12);
  for (int m = 0; m <= ABBE_COMPARE_UV_MEAN; m++)
    assert_near(abbe_compare_deviation((abbe_compare_metric)m, c.whole.metric[m].value), 0, 1e-9);
}

/* Three pairs of [Sharma2005] as pixels, under a white that is given. */
TEST(published_colour_differences) {
  static const double pairs[3][7] = {{50, 2.5, 0, 50, 0, -2.5, 4.3065},
                                     {50, 2.5, 0, 73, 25, -18, 27.1492},
                                     {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082}};
  abbe_field side[2] = {field_of(3, 1, XYZ), field_of(3, 1, XYZ)};
  for (int p = 0; p < 3; p++)
    for (int k = 0; k < 2; k++) {
      const double *lab = pairs[p] + 3 * k;
      double f[3] = {(lab[0] + 16) / 116 + lab[1] / 500, (lab[0] + 16) / 116,
                     (lab[0] + 16) / 116 - lab[2] / 200};
      for (int c = 0; c < 3; c++) {
        double t = f[c] > 6.0 / 29 ? f[c] * f[c] * f[c] : 3 * 36.0 / 841 * (f[c] - 4.0 / 29);
        side[k].colour.value[3 * p + c] = (float)(5 * d65[c] * t);
      }
    }
  const abbe_compare_options options = {.white = {5 * d65[0], 5 * d65[1], 5 * d65[2]}};
  OWNED(abbe_comparison, c) = compare(&side[0], &side[1], &options);
  assert_false(c.white_found);
  double mean = (4.3065 + 27.1492 + 0.9082) / 3;
  assert_near(value(&c.whole, ABBE_COMPARE_CIEDE2000_MEAN), mean, 2e-4);
  assert_near(value(&c.whole, ABBE_COMPARE_CIEDE2000_MAX), 27.1492, 2e-4);
  assert_near(value(&c.whole, ABBE_COMPARE_CIEDE2000_P95), 27.1492, 2e-4);
  abbe_field_free(&side[0]);
  abbe_field_free(&side[1]);
}

/* SSIM and FLIP are asked for, know only pictures, and look into a mask as anywhere. */
TEST(structure) {
  OWNED(abbe_field, b) = field_of(24, 20, XYZ), a = field_of(24, 20, XYZ);
  const float *plain = b.colour.value;
  for (size_t i = 0; i < 480; i++)
    for (size_t c = 0; c < 3; c++) {
      b.colour.value[3 * i + c] = (float)(d65[c] * (0.3 + 0.1 * sin(0.9 * (double)i)));
      a.colour.value[3 * i + c] = i % 24 < 12 ? plain[3 * i + c] : (float)(0.9 * d65[c]);
    }
  unsigned char in[480];
  for (size_t i = 0; i < 480; i++) in[i] = i % 24 < 2; /* further off than any filter reaches */
  const abbe_mask mask = {.count = 480, .inside = 40, .in = in};
  abbe_compare_options options = {.white = {d65[0], 1, d65[2]}, .mask = &mask};
  OWNED(abbe_comparison, c) = compare(&b, &a, &options);
  assert_true(isnan(value(&c.whole, ABBE_COMPARE_SSIM)));
  abbe_comparison_free(&c);
  options.structure = true;
  c = compare(&b, &a, &options);
  for (int m = ABBE_COMPARE_CIE76_MEAN; m <= ABBE_COMPARE_HDR_FLIP_MEAN; m++) {
    assert_true(abbe_compare_deviation((abbe_compare_metric)m, c.whole.metric[m].value) > 0.01);
    assert_true(isnan(c.whole.metric[m].noise));
  }
  assert_near(value(&c.mask, ABBE_COMPARE_FLIP_MEAN), 0, 1e-6);
  assert_near(value(&c.mask, ABBE_COMPARE_CIE76_MEAN), 0, 0);
  assert_true(isnan(value(&c.mask, ABBE_COMPARE_SSIM))); /* at the edge no window is whole */
  abbe_comparison_free(&c);
  a.kind = b.kind = ABBE_FIELD_RECEIVER_MAP;
  c = compare(&b, &a, &options);
  assert_true(isnan(value(&c.whole, ABBE_COMPARE_FLIP_MEAN)));
}

/* Noise of a picture's own errors has an SSIM and a FLIP, and a test that has just those lies
 * within them. */
TEST(noise_of_structure) {
  OWNED(abbe_field, exact) = field_of(48, 40, XYZ), noisy = field_of(48, 40, XYZ | ERRORS);
  for (size_t i = 0; i < 48 * 40; i++)
    for (size_t c = 0; c < 3; c++)
      exact.colour.value[3 * i + c] = (float)(d65[c] * (0.4 + 0.2 * sin(0.1 * (double)(i % 48))));
  make_noisy(&noisy, &exact, 0.1, 0, 7);
  const abbe_compare_options options = {.white = {d65[0], 1, d65[2]}, .structure = true};
  OWNED(abbe_comparison, c) = compare(&noisy, &exact, &options);
  for (int m = ABBE_COMPARE_SSIM; m <= ABBE_COMPARE_HDR_FLIP_MEAN; m++) {
    const abbe_compare_value *v = &c.whole.metric[m];
    const double told = abbe_compare_deviation((abbe_compare_metric)m, v->noise);
    assert_true(told > 0.01);
    assert_near(abbe_compare_deviation((abbe_compare_metric)m, v->value) / told, 1, 0.15);
  }
}

/* Of 1 to 100, 95 % are at most 95: the percentile is an element, not in between. */
TEST(percentile) {
  OWNED(abbe_field, b) = field_of(10, 10, XYZ), a = field_of(10, 10, XYZ);
  const abbe_compare_options options = {.white = {d65[0], 1, d65[2]}};
  double expected = 0;
  for (size_t i = 0; i < 100; i++) {
    double at = (double)((i * 37) % 100), dark[3], lab[2][3];
    for (size_t c = 0; c < 3; c++) {
      b.colour.value[3 * i + c] = (float)(0.2 * d65[c]);
      a.colour.value[3 * i + c] = (float)((0.2 + 0.001 * at) * d65[c]);
      dark[c] = (double)a.colour.value[3 * i + c];
    }
    const double base[3] = {0.2 * d65[0], 0.2, 0.2 * d65[2]};
    abbe_difference_lab(base, options.white, lab[0]);
    abbe_difference_lab(dark, options.white, lab[1]);
    if (at == 94) expected = abbe_difference_ciede2000(lab[0], lab[1]);
  }
  OWNED(abbe_comparison, c) = compare(&b, &a, &options);
  assert_near(value(&c.whole, ABBE_COMPARE_CIEDE2000_P95), expected, 1e-4);
}

/* What is measured does not depend on the space that the file is kept in. */
TEST(any_space_gives_the_same) {
  abbe_field b = field_of(12, 12, XYZ), a = field_of(12, 12, XYZ);
  abbe_field rgb_b = field_of(12, 12, 0), rgb_a = field_of(12, 12, 0);
  paint(&b);
  paint(&a);
  for (size_t i = 0; i < 432; i++) a.colour.value[i] *= 1 + 0.1f * (float)sin(0.11 * (double)i);
  double from[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, from);
  abbe_field *pairs[2][2] = {{&b, &rgb_b}, {&a, &rgb_a}};
  for (int k = 0; k < 2; k++)
    for (size_t i = 0; i < 144; i++) {
      double xyz[3];
      abbe_field_xyz(pairs[k][0], i, xyz, NULL);
      abbe_rgb_space_apply(from, xyz, xyz);
      for (size_t c = 0; c < 3; c++) pairs[k][1]->colour.value[3 * i + c] = (float)xyz[c];
    }
  OWNED(abbe_comparison, x) = compare(&b, &a, NULL), y = compare(&rgb_b, &rgb_a, NULL);
  for (int m = 0; m <= ABBE_COMPARE_UV_MEAN; m++)
    assert_near(y.whole.metric[m].value, x.whole.metric[m].value,
                1e-5 * (0.01 + x.whole.metric[m].value));
  for (int k = 0; k < 4; k++) abbe_field_free(pairs[k % 2][k / 2]);
}

/* A mask measures what a field of its pixels alone does. */
TEST(a_mask_is_a_field_of_its_pixels) {
  OWNED(abbe_field, b) = field_of(8, 8, XYZ | ERRORS), a = field_of(8, 8, XYZ);
  OWNED(abbe_field, part_b) = field_of(8, 2, XYZ | ERRORS), part_a = field_of(8, 2, XYZ);
  paint(&a);
  make_noisy(&b, &a, 0.1, 1, 9);
  unsigned char in[64] = {0};
  abbe_mask mask = {.count = 64, .inside = 16, .in = in};
  for (size_t i = 0, n = 0; i < 64; i += 4, n++) {
    in[i] = 1;
    memcpy(part_a.colour.value + 3 * n, a.colour.value + 3 * i, 3 * sizeof(float));
    memcpy(part_b.colour.value + 3 * n, b.colour.value + 3 * i, 3 * sizeof(float));
    memcpy(part_b.colour.error + 3 * n, b.colour.error + 3 * i, 3 * sizeof(float));
  }
  const abbe_compare_options options = {.mask = &mask, .white = {d65[0], 1, d65[2]}};
  const abbe_compare_options alone = {.white = {d65[0], 1, d65[2]}};
  OWNED(abbe_comparison, c) = compare(&b, &a, &options), p = compare(&part_b, &part_a, &alone);
  assert_true(c.masked);
  assert_int_equal(c.mask.pixels, 16);
  assert_int_equal(c.whole.pixels, 64);
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++) {
    if (m == ABBE_COMPARE_SQUARED_RELATIVE) continue; /* its unit is the whole field's */
    if (isnan(p.whole.metric[m].value)) continue;
    assert_near(c.mask.metric[m].value, p.whole.metric[m].value, 1e-12);
  }
  assert_near(c.mask.metric[ABBE_COMPARE_RELATIVE_RMSE].limit,
              p.whole.metric[ABBE_COMPARE_RELATIVE_RMSE].limit, 1e-12);
}

TEST(bands) {
  OWNED(abbe_field, b) = field_of(2, 1, BANDS | ERRORS), a = field_of(2, 1, BANDS);
  const float reference[4] = {1, 2, 1, 4}, other[4] = {1, 2, 2, 4}, error[4] = {0.5f, 0, 0.5f, 0};
  memcpy(b.bands.value, reference, sizeof reference);
  memcpy(b.bands.error, error, sizeof error);
  memcpy(a.bands.value, other, sizeof other);
  OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
  assert_near(c.unit, 2, 1e-12);
  assert_int_equal(c.whole.channels, 2);
  assert_string_equal(c.whole.channel[0].name, "450 nm");
  assert_near(c.whole.channel[0].relative_rmse.value, sqrt(0.5), 1e-12);
  assert_near(c.whole.channel[0].relative_rmse.noise, 0.5, 1e-12);
  assert_near(c.whole.channel[1].relative_rmse.value, 0, 0);
  assert_near(value(&c.whole, ABBE_COMPARE_BANDS_RELATIVE_RMSE), sqrt(0.25) / 2, 1e-12);
  assert_near(value(&c.whole, ABBE_COMPARE_BANDS_SQUARED_RELATIVE), 0.25 / (0.51 * 0.51) / 4,
              1e-12);
  assert_near(value(&c.whole, ABBE_COMPARE_BANDS_ENERGY_RATIO), 9.0 / 8, 1e-12);
  assert_true(isnan(value(&c.whole, ABBE_COMPARE_RELATIVE_RMSE)));
  assert_true(isnan(value(&c.whole, ABBE_COMPARE_CIEDE2000_MEAN)));
  assert_int_equal(c.whole.z.count, 2);
  assert_int_equal(c.whole.z.untested, 2);
  assert_near(c.whole.z.max, 2, 1e-6);
}

TEST(pixels_that_are_not_finite) {
  OWNED(abbe_field, b) = field_of(4, 1, XYZ | ERRORS), a = field_of(4, 1, XYZ);
  paint(&a);
  make_noisy(&b, &a, 0, 0, 1);
  a.colour.value[4] = NAN;
  a.colour.value[7] = INFINITY;
  b.colour.error[3 * 3] = NAN;
  abbe_comparison c = compare(&b, &a, NULL);
  assert_int_equal(c.whole.pixels, 1);
  assert_int_equal(c.whole.invalid_test, 2);
  assert_int_equal(c.whole.invalid_reference, 1);
  assert_near(value(&c.whole, ABBE_COMPARE_RELATIVE_RMSE), 0, 0);
  abbe_comparison_free(&c);
  a.colour.value[0] = NAN;
  REFUSED(ABBE_INVALID_ARGUMENT, "no pixel is finite", abbe_compare(&b, &a, NULL, &c, &error));
}

static void refuse(const abbe_field *b, const abbe_field *a, const abbe_compare_options *options,
                   const char *says) {
  abbe_comparison c = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, says, abbe_compare(b, a, options, &c, &error));
  assert_null(c.whole.channel);
}

TEST(what_cannot_be_compared) {
  OWNED(abbe_field, lit) = field_of(4, 4, XYZ), dark = field_of(4, 4, XYZ),
                    small = field_of(4, 2, XYZ), bands = field_of(4, 4, BANDS);
  abbe_field empty = {0};
  paint(&lit);
  unsigned char in[4] = {1};
  abbe_mask mask = {.count = 4, .inside = 1, .in = in};
  const abbe_compare_options best = {.best_scale = true}, masked = {.mask = &mask};
  refuse(&dark, &lit, NULL, "the reference is black");
  refuse(&lit, &dark, &best, "no scale");
  refuse(&lit, &small, NULL, "aligned");
  refuse(&lit, &bands, NULL, "aligned");
  refuse(&empty, &empty, NULL, "aligned");
  refuse(&lit, &lit, &masked, "mask has 4 pixels");
  OWNED(abbe_comparison, c) =
      compare(&lit, &dark, NULL); /* a black picture is a bad one, not an error */
  assert_near(value(&c.whole, ABBE_COMPARE_ENERGY_RATIO), 0, 0);
  assert_near(c.whole.uv_share, 0, 0);
  assert_true(isnan(value(&c.whole, ABBE_COMPARE_UV_MEAN)));
}

TEST(names) {
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++)
    assert_int_equal(abbe_compare_metric_find(abbe_compare_metric_name((abbe_compare_metric)m)), m);
  assert_int_equal(abbe_compare_metric_find("rmse"), ABBE_COMPARE_METRIC_COUNT);
  assert_near(abbe_compare_deviation(ABBE_COMPARE_ENERGY_RATIO, 0.75), 0.25, 1e-15);
  assert_near(abbe_compare_deviation(ABBE_COMPARE_UV_MEAN, 0.75), 0.75, 0);
}

TEST(counts) {
  abbe_ztest t = {0};
  static const double z[] = {0, 1, -2, 2.5, -3.5, 3};
  for (int i = 0; i < 6; i++) abbe_ztest_add(&t, z[i] * 0.25, 0.0625);
  abbe_ztest_add(&t, 0, 0);
  abbe_ztest_add(&t, 1e-30, 0);
  abbe_ztest_add(&t, 1, NAN);
  abbe_ztest_add(&t, NAN, 1);
  abbe_ztest_add(&t, 1, INFINITY);
  assert_int_equal(t.count, 6);
  assert_near(abbe_ztest_share_over2(&t), 3.0 / 6, 1e-15);
  assert_near(abbe_ztest_share_over3(&t), 1.0 / 6, 1e-15);
  assert_near(abbe_ztest_mean_square(&t), (1 + 4 + 6.25 + 12.25 + 9) / 6, 1e-12);
  assert_near(t.max, 3.5, 1e-12);
  assert_int_equal(t.untested, 5);
  assert_int_equal(t.untested_differ, 4);
}

TEST(nothing_tested) {
  abbe_ztest t = {0};
  assert_true(isnan(abbe_ztest_share_over2(&t)) && isnan(abbe_ztest_mean_square(&t)));
  assert_true(isnan(abbe_ztest_critical(0, 0.01, 0)));
  assert_true(isnan(abbe_ztest_critical(5, 0, 0)) && isnan(abbe_ztest_critical(5, 1, 0)));
}

/* As tables of the normal distribution and of Student's t print them. */
TEST(tabulated_quantiles) {
  assert_near(abbe_ztest_expected_share(2, 0), 0.04550026, 1e-8);
  assert_near(abbe_ztest_expected_share(3, 0), 0.00269980, 1e-8);
  assert_near(abbe_ztest_critical(1, 0.05, 0), 1.959964, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.01, 0), 2.575829, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.05, 10), 2.228139, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.01, 5), 4.032143, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.05, 1), 12.70620, 1e-5);
  assert_near(abbe_ztest_expected_mean_square(10), 1.25, 0);
  assert_near(abbe_ztest_expected_mean_square(0), 1, 0);
  assert_true(isinf(abbe_ztest_expected_mean_square(2)));
}

/* Of count elements none exceeds it with the chance 1 - level: by the definition of the chance. */
TEST(sidak) {
  static const size_t counts[] = {2, 100, 196608, 100000000};
  static const double freedoms[] = {0, 15, 63, 1e6};
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 4; k++) {
      double z = abbe_ztest_critical(counts[i], 0.01, freedoms[k]);
      double none = exp((double)counts[i] * log1p(-abbe_ztest_expected_share(z, freedoms[k])));
      assert_near(none, 0.99, 1e-6);
    }
  assert_true(isfinite(abbe_ztest_critical(1000000, 0.01, 1)));
}

/* SSIM by its definition, where it is known in closed form and summed window by window. */

enum { W = 17, H = 14 };

static void map_of(const float *a, const float *b, float *out) {
  OK(abbe_ssim_map(a, b, W, H, out, &error));
}

/* Two even greys have no structure: only the means count. */
TEST(even_greys) {
  float a[W * H], b[W * H], out[W * H];
  for (int i = 0; i < W * H; i++) {
    a[i] = 0.25f;
    b[i] = 0.75f;
  }
  map_of(a, b, out);
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) {
      const bool inside = x >= 5 && x < W - 5 && y >= 5 && y < H - 5;
      assert_int_equal(inside, !isnan(out[y * W + x]));
      if (inside)
        assert_near((double)out[y * W + x], (2 * 0.1875 + 1e-4) / (0.0625 + 0.5625 + 1e-4), 1e-6);
    }
}

/* [Wang2004, eq. 13 to 16], every window summed for itself about its own means. */
TEST(by_definition) {
  float a[W * H], b[W * H], out[W * H];
  for (int i = 0; i < W * H; i++) {
    a[i] = (float)(0.5 + 0.4 * sin(1.7 * i) * cos(0.3 * i));
    b[i] = (float)(0.45 + 0.3 * sin(1.7 * i + 0.4) * cos(0.29 * i));
  }
  map_of(a, b, out);
  double least = 1;
  for (int y = 5; y < H - 5; y++)
    for (int x = 5; x < W - 5; x++) {
      double sum = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
      for (int pass = 0; pass < 2; pass++)
        for (int j = -5; j <= 5; j++)
          for (int i = -5; i <= 5; i++) {
            const double w = exp(-(i * i + j * j) / 4.5);
            const double p = (double)a[(y + j) * W + x + i], q = (double)b[(y + j) * W + x + i];
            if (pass == 0) {
              sum += w;
              ma += w * p;
              mb += w * q;
            } else {
              va += w * (p - ma / sum) * (p - ma / sum);
              vb += w * (q - mb / sum) * (q - mb / sum);
              cov += w * (p - ma / sum) * (q - mb / sum);
            }
          }
      ma /= sum;
      mb /= sum;
      const double expected = (2 * ma * mb + 1e-4) * (2 * cov / sum + 9e-4) /
                              ((ma * ma + mb * mb + 1e-4) * ((va + vb) / sum + 9e-4));
      assert_near((double)out[y * W + x], expected, 1e-6);
      least = fmin(least, expected);
    }
  assert_true(least < 0.9);
  map_of(a, a, out);
  assert_near((double)out[6 * W + 6], 1, 1e-6);
}

/* A picture that no window fits into has no index anywhere; a value that is not finite spoils the
 * windows that it is in alone. */
TEST(edges) {
  float a[W * H] = {0}, out[W * H];
  OK(abbe_ssim_map(a, a, 10, 14, out, &error));
  for (int i = 0; i < 140; i++) assert_true(isnan(out[i]));
  a[5 * W + 0] = NAN;
  map_of(a, a, out);
  assert_true(isnan(out[5 * W + 5]));
  assert_near((double)out[5 * W + 6], 1, 1e-6);
}
