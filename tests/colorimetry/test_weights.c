#include "tests/check.h"

#include "colorimetry/difference.h"
#include "colorimetry/observer.h"
#include "colorimetry/weights.h"

static abbe_weights make(size_t count, double min, double max, abbe_illuminant_kind kind,
                         abbe_rgb_space space) {
  OWNED(abbe_wavelengths, samples) = {0};
  abbe_weights weights = {0};
  abbe_error error = {0};
  const abbe_illuminant light = {.kind = kind};
  if (abbe_wavelengths_make(count, min, max, &samples, &error) != ABBE_OK ||
      abbe_weights_make(&samples, &light, space, &weights, &error) != ABBE_OK)
    fail_msg("%s", error.text);
  return weights;
}

/* Chromaticities of the CIE's illuminants, 5 nm [CIE15]. */
TEST(whites) {
  static const struct {
    abbe_illuminant_kind kind;
    double x, y;
  } whites[] = {{ABBE_ILLUMINANT_D65, 0.31272, 0.32903},
                {ABBE_ILLUMINANT_A, 0.44758, 0.40745},
                {ABBE_ILLUMINANT_D50, 0.34567, 0.35850},
                {ABBE_ILLUMINANT_E, 1.0 / 3, 1.0 / 3}};
  for (int i = 0; i < 4; i++) {
    OWNED(abbe_weights, w) = make(1, 360, 830, whites[i].kind, ABBE_RGB_SPACE_XYZ);
    double total = w.sum[0] + w.sum[1] + w.sum[2];
    double x = w.sum[0] / total, y = w.sum[1] / total;
    if (fabs(x - whites[i].x) > 5e-5 || fabs(y - whites[i].y) > 5e-5)
      fail_msg("white %d: %.6f %.6f", i, x, y);
  }
}

TEST(any_count_adds_up_to_the_same_white) {
  static const size_t counts[] = {1, 2, 3, 7, 21, 81, 100, 401, 999, ABBE_WAVELENGTHS_MAX_COUNT};
  for (int kind = 0; kind < ABBE_ILLUMINANT_TABULATED; kind++) {
    OWNED(abbe_weights, one) = make(1, 380, 780, (abbe_illuminant_kind)kind, ABBE_RGB_SPACE_XYZ);
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
      OWNED(abbe_weights, w) =
          make(counts[i], 380, 780, (abbe_illuminant_kind)kind, ABBE_RGB_SPACE_XYZ);
      assert_int_equal(w.count, counts[i]);
      assert_true(fabs(w.sum[1] - 1) <= 4.5e-16);
      for (int k = 0; k < 3; k++) {
        /* the Planckian A alone is no polynomial between knots */
        if (fabs(w.sum[k] - one.sum[k]) > 1e-14 * one.sum[k])
          fail_msg("%d, %zu samples: %.17g, not %.17g", kind, counts[i], w.sum[k], one.sum[k]);
      }
      for (size_t j = 0; j < w.count; j++)
        for (int k = 0; k < 3; k++) assert_true(w.weight[j][k] >= 0);
    }
  }
}

static double trapezoid_y(double from, double to) {
  const abbe_illuminant light = {0};
  const int steps = 400000;
  double sum = 0, h = (to - from) / steps;
  for (int i = 0; i <= steps; i++) {
    double xyz[3], nm = from + h * i;
    abbe_observer_xyz(nm, xyz);
    sum += (i == 0 || i == steps ? 0.5 : 1) * xyz[1] * abbe_illuminant_power(&light, nm);
  }
  return sum * h;
}

TEST(a_band_is_an_integral) {
  const abbe_illuminant light = {0};
  double xyz[3];
  abbe_weights_band_xyz(&light, 380, 780, 501.3, 533.9, xyz);
  assert_true(fabs(xyz[1] - trapezoid_y(501.3, 533.9) / trapezoid_y(380, 780)) < 1e-10);
}

TEST(odd_tilings_add_up) {
  const abbe_illuminant light = {.kind = ABBE_ILLUMINANT_A};
  double edges[] = {380, 380.0001, 384.999999, 385, 417.3, 560, 777, 780}, whole[3], sum[3] = {0};
  for (int i = 0; i < 7; i++) {
    double xyz[3];
    abbe_weights_band_xyz(&light, 380, 780, edges[i], edges[i + 1], xyz);
    for (int k = 0; k < 3; k++) sum[k] += xyz[k];
  }
  abbe_weights_band_xyz(&light, 380, 780, 0, 1e6, whole);
  for (int k = 0; k < 3; k++) assert_true(fabs(sum[k] - whole[k]) < 1e-14);
  assert_true(fabs(whole[1] - 1) < 1e-15);
  abbe_weights_band_xyz(&light, 900, 1000, 900, 1000, whole);
  assert_true(whole[1] == 0);
}

/* A range is made once for many bands, each the same as by itself. */
TEST(a_range_serves_many_bands) {
  for (int kind = 0; kind < ABBE_ILLUMINANT_TABULATED; kind++) {
    const abbe_illuminant light = {.kind = (abbe_illuminant_kind)kind};
    OWNED(abbe_weights, samples) = make(7, 380, 780, light.kind, ABBE_RGB_SPACE_XYZ);
    abbe_weights_range range;
    double sum[3] = {0}, alone[3], xyz[3];
    MADE(abbe_wavelengths, w, abbe_wavelengths_make(7, 380, 780, &w, &error));
    abbe_weights_range_make(&light, 380, 780, &range);
    assert_ptr_equal(range.illuminant, &light);
    assert_true(range.min_nm == 380 && range.max_nm == 780 && range.white_y > 0);
    for (size_t i = 0; i < w.count; i++) {
      abbe_weights_range_xyz(&range, w.edge_nm[i], w.edge_nm[i + 1], xyz);
      abbe_weights_band_xyz(&light, 380, 780, w.edge_nm[i], w.edge_nm[i + 1], alone);
      for (int k = 0; k < 3; k++) {
        assert_true(xyz[k] == alone[k] && xyz[k] >= 0);
        assert_true(fabs(xyz[k] - samples.weight[i][k]) < 1e-15);
        sum[k] += xyz[k];
      }
    }
    assert_true(fabs(sum[1] - 1) < 1e-14);
  }
}

/* In nm times the illuminant's own unit, which is what the observer's table adds up to under an
 * equal power of 1. */
TEST(a_range_has_a_unit) {
  const double nm[] = {300, 900}, one[] = {1, 1}, thousand[] = {1000, 1000};
  abbe_weights_range range, brighter;
  OWNED(abbe_illuminant, light) = {.kind = ABBE_ILLUMINANT_TABULATED};
  OWNED(abbe_illuminant, bright) = light;
  OK(abbe_spectrum_make(nm, one, 2, ABBE_INTERPOLATION_LINEAR, &light.spectrum, &error));
  OK(abbe_spectrum_make(nm, thousand, 2, ABBE_INTERPOLATION_LINEAR, &bright.spectrum, &error));
  abbe_weights_range_make(&light, 380, 780, &range);
  abbe_weights_range_make(&bright, 380, 780, &brighter);
  assert_true(fabs(range.white_y - 106.857) < 0.01); /* sum of ybar at 1 nm [CIE15] */
  assert_true(fabs(brighter.white_y / range.white_y - 1000) < 1e-9);
  double a[3], b[3];
  abbe_weights_range_xyz(&range, 500, 600, a);
  abbe_weights_range_xyz(&brighter, 500, 600, b);
  for (int k = 0; k < 3; k++) assert_true(fabs(a[k] - b[k]) < 1e-14);
}

/* What lies outside is left out; what holds nothing is black. */
TEST(the_ends_of_a_range) {
  const abbe_illuminant light = {0};
  abbe_weights_range range, wide, none;
  double inside[3], over[3];
  abbe_weights_range_make(&light, 450, 650, &range);
  abbe_weights_range_xyz(&range, 640, 650, inside);
  abbe_weights_range_xyz(&range, 640, 1000, over);
  for (int k = 0; k < 3; k++) assert_true(inside[k] > 0 && inside[k] == over[k]);
  static const double black[][2] = {{500, 500}, {600, 500}, {300, 450}, {650, 700}};
  for (size_t i = 0; i < sizeof black / sizeof *black; i++) {
    abbe_weights_range_xyz(&range, black[i][0], black[i][1], over);
    for (int k = 0; k < 3; k++) assert_true(over[k] == 0);
  }
  abbe_weights_range_make(&light, 360, 830, &range);
  abbe_weights_range_make(&light, 0, 1e4, &wide);
  assert_true(wide.white_y == range.white_y);
  static const double empty[][2] = {{500, 500}, {600, 500}, {900, 1000}};
  for (size_t i = 0; i < sizeof empty / sizeof *empty; i++) {
    abbe_weights_range_make(&light, empty[i][0], empty[i][1], &none);
    assert_true(none.white_y == 0);
    abbe_weights_range_xyz(&none, 400, 1000, over);
    for (int k = 0; k < 3; k++) assert_true(over[k] == 0);
  }
}

TEST(the_share_of_power) {
  const abbe_illuminant equal = {.kind = ABBE_ILLUMINANT_E};
  assert_true(fabs(abbe_weights_band_power(&equal, 400, 800, 500, 600) - 0.25) < 1e-14);
  assert_true(fabs(abbe_weights_band_power(&equal, 850, 950, 850, 900) - 0.5) < 1e-14);
  assert_true(fabs(abbe_weights_band_power(&equal, 400, 800, 0, 1e4) - 1) < 1e-14);
  assert_true(abbe_weights_band_power(&equal, 400, 800, 900, 1000) == 0);
  assert_true(abbe_weights_band_power(&equal, 500, 500, 400, 600) == 0);
}

/* Seven nodes taken pointwise tint the white; the bands do not. */
TEST(pointwise_nodes_tint_the_white) {
  OWNED(abbe_weights, exact) = make(1, 380, 780, ABBE_ILLUMINANT_D65, ABBE_RGB_SPACE_XYZ);
  OWNED(abbe_weights, bands) = make(7, 380, 780, ABBE_ILLUMINANT_D65, ABBE_RGB_SPACE_XYZ);
  const abbe_illuminant light = {0};
  double nodes[3] = {0};
  for (int i = 0; i < 7; i++) {
    double xyz[3], nm = 380 + 400.0 * i / 6;
    abbe_observer_xyz(nm, xyz);
    for (int k = 0; k < 3; k++) nodes[k] += xyz[k] * abbe_illuminant_power(&light, nm);
  }
  for (int k = 2; k >= 0; k--) nodes[k] /= nodes[1];
  double white[3], tinted[3], banded[3];
  abbe_difference_lab(exact.sum, exact.sum, white);
  abbe_difference_lab(nodes, exact.sum, tinted);
  abbe_difference_lab(bands.sum, exact.sum, banded);
  double tint = abbe_difference_ciede2000(tinted, white);
  if (!(tint > 10)) fail_msg("seven pointwise nodes: %g", tint);
  assert_true(abbe_difference_ciede2000(banded, white) < 1e-10);
}

/* The table's white (0.31272, 0.32903) is not the (0.3127, 0.3290) that the RGB spaces are defined
 * by, so D65 is white there to 5e-4 of a component: 0.03 of a CIEDE2000 unit. */
TEST(d65_is_white_in_rgb) {
  static const abbe_rgb_space spaces[] = {ABBE_RGB_SPACE_REC709, ABBE_RGB_SPACE_ACESCG};
  for (int s = 0; s < 2; s++) {
    OWNED(abbe_weights, w) = make(7, 380, 780, ABBE_ILLUMINANT_D65, spaces[s]);
    for (int k = 0; k < 3; k++)
      if (fabs(w.sum[k] - 1) > 6e-4) fail_msg("space %d: component %d is %.6f", s, k, w.sum[k]);
  }
}

TEST(rgb_keeps_negatives_and_is_the_matrix_times_xyz) {
  OWNED(abbe_weights, xyz) = make(21, 380, 780, ABBE_ILLUMINANT_D65, ABBE_RGB_SPACE_XYZ);
  OWNED(abbe_weights, rgb) = make(21, 380, 780, ABBE_ILLUMINANT_D65, ABBE_RGB_SPACE_REC709);
  double matrix[9], least = 0;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  for (int i = 0; i < 21; i++) {
    double expected[3];
    abbe_rgb_space_apply(matrix, xyz.weight[i], expected);
    for (int k = 0; k < 3; k++) {
      assert_true(fabs(rgb.weight[i][k] - expected[k]) < 1e-16);
      least = fmin(least, rgb.weight[i][k]);
    }
  }
  assert_true(least < -0.01);
}

TEST(a_table_with_knots_of_its_own) {
  /* a box from 501 to 502 nm with a ramp: knots off the observer's grid, zero outside */
  const double nm[] = {501, 501.3, 502}, power[] = {0, 3, 1};
  OWNED(abbe_illuminant, light) = {.kind = ABBE_ILLUMINANT_TABULATED};
  OK(abbe_spectrum_make(nm, power, 3, ABBE_INTERPOLATION_LINEAR, &light.spectrum, &error));
  double low[3], high[3];
  abbe_weights_band_xyz(&light, 380, 780, 380, 501.3, low);
  abbe_weights_band_xyz(&light, 380, 780, 501.3, 780, high);
  assert_true(fabs(low[1] + high[1] - 1) < 1e-15);
  /* areas 0.45 and 1.4, the observer rising by a few per cent a nanometre */
  assert_true(fabs(low[1] - 0.45 / 1.85) < 5e-3);
}

TEST(no_light_in_range) {
  OWNED(abbe_weights, weights) = {0};
  const abbe_illuminant light = {0};
  MADE(abbe_wavelengths, samples, abbe_wavelengths_make(3, 900, 1000, &samples, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "900",
          abbe_weights_make(&samples, &light, ABBE_RGB_SPACE_XYZ, &weights, &error));
  assert_null(weights.weight);
}

TEST(thesis) {
  double rgb[3] = {0};
  for (int i = 0; i < ABBE_WEIGHTS_THESIS_COUNT; i++) {
    assert_true(abbe_weights_thesis_lambda_nm[i] == 380 + 50 * i);
    for (int k = 0; k < 3; k++) rgb[k] += abbe_weights_thesis_rgb[i][k];
  }
  for (int k = 0; k < 3; k++) assert_true(fabs(rgb[k] - 3.5) < 1e-12);
}

/* Whites of the observer of 1964 [CIE15], and equal energy, a third each of any. */
TEST(other_observers) {
  static const struct {
    abbe_observer observer;
    abbe_illuminant_kind kind;
    double xy[2], tolerance;
  } of[] = {{ABBE_OBSERVER_CIE_1964, ABBE_ILLUMINANT_D65, {0.31382, 0.33100}, 6e-5},
            {ABBE_OBSERVER_CIE_1964, ABBE_ILLUMINANT_A, {0.45117, 0.40594}, 6e-5},
            {ABBE_OBSERVER_CIE_1964, ABBE_ILLUMINANT_E, {1.0 / 3, 1.0 / 3}, 2e-4},
            {ABBE_OBSERVER_CIE_2015_2, ABBE_ILLUMINANT_E, {1.0 / 3, 1.0 / 3}, 2e-4},
            {ABBE_OBSERVER_CIE_2015_10, ABBE_ILLUMINANT_E, {1.0 / 3, 1.0 / 3}, 2e-4}};
  MADE(abbe_wavelengths, samples, abbe_wavelengths_make(9, 380, 780, &samples, &error));
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    const abbe_illuminant light = {.kind = of[i].kind};
    MADE(abbe_weights, weights,
         abbe_weights_make_by(of[i].observer, &samples, &light, ABBE_RGB_SPACE_XYZ, &weights,
                              &error));
    const double all = weights.sum[0] + weights.sum[1] + weights.sum[2];
    assert_true(fabs(weights.sum[1] - 1) < 1e-12);
    for (int k = 0; k < 2; k++)
      assert_true(fabs(weights.sum[k] / all - of[i].xy[k]) < of[i].tolerance);
  }
}

/* Any tiling of a range adds up to its white, whose Y is 1, for every observer; and a range without
 * one named is that of 1931. */
TEST(a_range_of_other_observers) {
  const abbe_illuminant light = {.kind = ABBE_ILLUMINANT_A};
  for (int o = 0; o < ABBE_OBSERVER_COUNT; o++) {
    abbe_weights_range range;
    double sum[3] = {0}, white[3], xyz[3], at = 400;
    abbe_weights_range_make_by((abbe_observer)o, &light, 400, 700, &range);
    for (int i = 0; i < 37; i++, at += 300.0 / 37) {
      abbe_weights_range_xyz(&range, at, at + 300.0 / 37, xyz);
      for (int k = 0; k < 3; k++) sum[k] += xyz[k];
    }
    abbe_weights_white((abbe_observer)o, &light, 400, 700, white);
    assert_true(fabs(white[1] - 1) < 1e-12);
    for (int k = 0; k < 3; k++) assert_true(fabs(sum[k] - white[k]) < 1e-11);
    abbe_weights_band_xyz(&light, 400, 700, 400, 700, xyz);
    if (o == ABBE_OBSERVER_CIE_1931)
      assert_memory_equal(white, xyz, sizeof xyz);
    else
      assert_true(fabs(white[2] - xyz[2]) > 1e-3);
  }
}
