/* Comparisons that know their noise: what a difference is worth beside standard errors. */
#include "tests/validation/measure/fields.h"

TEST(an_exact_field_lies_in_the_noise) {
  OWNED(abbe_field, b) = field_of(48, 48, XYZ | ERRORS), a = field_of(48, 48, XYZ);
  paint(&a);
  int above[ABBE_COMPARE_METRIC_COUNT] = {0}, rounds = 20;
  double ratio[ABBE_COMPARE_METRIC_COUNT] = {0};
  for (int i = 0; i < rounds; i++) {
    make_noisy(&b, &a, 0.1, 0, 77u + (unsigned)i);
    OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
    for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++) {
      const abbe_compare_value *v = &c.whole.metric[m];
      abbe_compare_verdict verdict = abbe_compare_judge((abbe_compare_metric)m, v);
      bool band = m >= ABBE_COMPARE_BANDS_RELATIVE_RMSE && m <= ABBE_COMPARE_BANDS_ENERGY_RATIO;
      bool unasked = m >= ABBE_COMPARE_SSIM && m <= ABBE_COMPARE_HDR_FLIP_MEAN;
      assert_true((verdict == ABBE_COMPARE_UNKNOWN) ==
                  (band || unasked || m == ABBE_COMPARE_CIEDE2000_MAX));
      above[m] += verdict == ABBE_COMPARE_ABOVE;
      ratio[m] += v->value / v->noise / rounds;
    }
    const abbe_compare_value *rmse = &c.whole.metric[ABBE_COMPARE_RELATIVE_RMSE];
    assert_true(rmse->net < 0.4 * rmse->value);
    assert_near(value(&c.whole, ABBE_COMPARE_Z_MEAN_SQUARE), 1, 0.08);
    assert_near(value(&c.whole, ABBE_COMPARE_Z_OVER_2), 0.0455, 0.012);
  }
  static const abbe_compare_metric told[] = {ABBE_COMPARE_RELATIVE_RMSE,
                                             ABBE_COMPARE_SQUARED_RELATIVE,
                                             ABBE_COMPARE_CIEDE2000_MEAN, ABBE_COMPARE_UV_MEAN};
  for (int i = 0; i < 4; i++) assert_near(ratio[told[i]], 1, i < 2 ? 0.02 : 0.05);
  /* Two standard deviations: one in forty may lie above. */
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++) {
    if (above[m] > 4)
      fail_msg("%s: %d of %d above", abbe_compare_metric_name((abbe_compare_metric)m), above[m],
               rounds);
  }
}

/* Errors that only brighten and darken change no hue: the noise that is told of hues is far less
 * than that of independent errors of the same size. */
TEST(errors_that_go_together) {
  OWNED(abbe_field, b) = field_of(48, 48, XYZ | ERRORS), a = field_of(48, 48, XYZ);
  for (size_t i = 0; i < 3 * 48 * 48; i++)
    a.colour.value[i] = (float)(i % 3 == 2 ? 1.5 : 1) * (1 + 0.3f * (float)sin(0.01 * (double)i));
  double noise[2];
  for (int together = 0; together < 2; together++) {
    unsigned seed = 3;
    for (size_t i = 0; i < 48 * 48; i++) {
      double common = normal(&seed);
      for (size_t c = 0; c < 3; c++) {
        double v = (double)a.colour.value[3 * i + c];
        b.colour.value[3 * i + c] = (float)(v * (1 + 0.1 * (together ? common : normal(&seed))));
        b.colour.error[3 * i + c] = (float)(0.1 * v);
      }
    }
    OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
    noise[together] = c.whole.metric[ABBE_COMPARE_UV_MEAN].noise;
    for (int m = ABBE_COMPARE_CIEDE2000_MEAN; m <= ABBE_COMPARE_UV_MEAN; m++)
      if (m != ABBE_COMPARE_CIEDE2000_MAX)
        assert_int_equal(abbe_compare_judge((abbe_compare_metric)m, &c.whole.metric[m]),
                         ABBE_COMPARE_BELOW_REFERENCE);
  }
  assert_true(noise[1] < 0.02 * noise[0]);
}

/* A tenth off everywhere, in noise of a twentieth: told apart, and its size is found again. */
TEST(a_true_difference_is_found) {
  OWNED(abbe_field, b) = field_of(48, 48, XYZ | ERRORS), a = field_of(48, 48, XYZ);
  paint(&a);
  make_noisy(&b, &a, 0.05, 2, 5);
  double mean = 0, square = 0;
  for (size_t i = 0; i < 3 * 48 * 48; i++) {
    double v = 1.1 * (double)a.colour.value[i];
    mean += v;
    square += v * v / 121;
  }
  OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
  const abbe_compare_value *rmse = &c.whole.metric[ABBE_COMPARE_RELATIVE_RMSE];
  assert_int_equal(abbe_compare_judge(ABBE_COMPARE_RELATIVE_RMSE, rmse), ABBE_COMPARE_ABOVE);
  assert_near(rmse->net, sqrt(square * 3 * 48 * 48) / mean, 0.05 * rmse->net);
  assert_true(value(&c.whole, ABBE_COMPARE_Z_EXCESS) > 1);
  assert_near(value(&c.whole, ABBE_COMPARE_Z_MEAN_SQUARE), 5, 0.3);
  assert_int_equal(
      abbe_compare_judge(ABBE_COMPARE_ENERGY_RATIO, &c.whole.metric[ABBE_COMPARE_ENERGY_RATIO]),
      ABBE_COMPARE_ABOVE);
}

TEST(the_noise_of_both) {
  OWNED(abbe_field, exact) = field_of(48, 48, XYZ), b = field_of(48, 48, XYZ | ERRORS),
                    a = field_of(48, 48, XYZ | ERRORS);
  paint(&exact);
  make_noisy(&b, &exact, 0.05, 0, 5);
  make_noisy(&a, &exact, 0.15, 0, 6);
  b.passes = 16;
  a.passes = 100;
  OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
  const abbe_compare_value *rmse = &c.whole.metric[ABBE_COMPARE_RELATIVE_RMSE];
  assert_int_equal(abbe_compare_judge(ABBE_COMPARE_RELATIVE_RMSE, rmse), ABBE_COMPARE_BELOW_BOTH);
  assert_near(rmse->both_noise / rmse->noise, sqrt(1 + 9), 0.1);
  assert_near(c.freedom, 15, 0);
  assert_near(c.whole.metric[ABBE_COMPARE_Z_MEAN_SQUARE].noise, 15.0 / 13, 1e-12);
  assert_near(value(&c.whole, ABBE_COMPARE_Z_MEAN_SQUARE), 1, 0.08);
  assert_true(c.whole.metric[ABBE_COMPARE_CIEDE2000_MEAN].both_noise >
              c.whole.metric[ABBE_COMPARE_CIEDE2000_MEAN].noise);
  OWNED(abbe_comparison, again) = compare(&b, &a, NULL);
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++)
    assert_memory_equal(&again.whole.metric[m], &c.whole.metric[m], sizeof c.whole.metric[m]);
}

/* Errors that are themselves estimated, from 16 passes, as a tracer's are: Student's t holds. */
static void make_passes(abbe_field *reference, const abbe_field *exact, unsigned seed) {
  enum { PASSES = 16 };
  for (size_t i = 0; i < 3 * exact->width * exact->height; i++) {
    double sum = 0, square = 0, v = (double)exact->colour.value[i];
    for (int k = 0; k < PASSES; k++) {
      double sample = v * (1 + 0.3 * normal(&seed));
      sum += sample;
      square += sample * sample;
    }
    double mean = sum / PASSES;
    reference->colour.value[i] = (float)mean;
    reference->colour.error[i] = (float)sqrt((square / PASSES - mean * mean) / (PASSES - 1));
  }
  reference->passes = PASSES;
}

TEST(errors_from_passes) {
  OWNED(abbe_field, b) = field_of(48, 48, XYZ | ERRORS), a = field_of(48, 48, XYZ);
  paint(&a);
  int above = 0;
  for (unsigned i = 0; i < 8; i++) {
    make_passes(&b, &a, 31 + i);
    OWNED(abbe_comparison, c) = compare(&b, &a, NULL);
    const abbe_compare_value *rmse = &c.whole.metric[ABBE_COMPARE_RELATIVE_RMSE];
    assert_near(rmse->value / rmse->noise, 1, 0.08);
    assert_near(value(&c.whole, ABBE_COMPARE_Z_OVER_2), 0.0639, 0.015); /* t, 15 degrees */
    assert_near(value(&c.whole, ABBE_COMPARE_Z_MEAN_SQUARE), 15.0 / 13, 0.1);
    above += value(&c.whole, ABBE_COMPARE_Z_EXCESS) > 1;
  }
  assert_true(above <= 1);
}
