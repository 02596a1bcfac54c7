#include "tests/check.h"

#include "colorimetry/difference.h"
#include "colorimetry/observer.h"
#include "colorimetry/upsampling.h"
#include "colorimetry/weights.h"

static const double red[3] = {1, 0, 0}, green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
static const double white[3] = {1, 1, 1}, orange[3] = {3, 0.5, 0.125};
static const double *const colours[] = {red, green, blue, white, orange};

static abbe_upsampling make(const abbe_illuminant *light, double min_nm, double max_nm) {
  abbe_upsampling u;
  OK(abbe_upsampling_make(light, min_nm, max_nm, &u, &error));
  return u;
}

TEST(functions_are_a_partition_of_one) {
  double before[3], basis[3];
  abbe_upsampling_basis(299.9, before);
  for (double nm = 300; nm <= 900; nm += 0.1) {
    abbe_upsampling_basis(nm, basis);
    assert_near(basis[0] + basis[1] + basis[2], 1, 1e-15);
    for (int j = 0; j < 3; j++) {
      assert_true(basis[j] >= 0 && basis[j] <= 1);
      assert_near(basis[j], before[j], 0.003); /* no steps */
      before[j] = basis[j];
    }
  }
  abbe_upsampling_basis(640, basis);
  assert_near(basis[0], 1, 1e-6);
  abbe_upsampling_basis(530, basis);
  assert_near(basis[1], 1, 1e-6);
  abbe_upsampling_basis(450, basis);
  assert_true(basis[2] > 0.9);
}

/* By a sum over narrow bands that knows nothing of how the matrix was made. */
TEST(spectra_have_the_colour) {
  static const double ranges[][2] = {{380, 780}, {400, 700}, {360, 830}, {437.5, 611.3}};
  for (int kind = 0; kind < ABBE_ILLUMINANT_TABULATED; kind++)
    for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++) {
      const abbe_illuminant light = {.kind = (abbe_illuminant_kind)kind};
      const abbe_upsampling u = make(&light, ranges[r][0], ranges[r][1]);
      for (size_t c = 0; c < sizeof colours / sizeof *colours; c++) {
        double sum[3] = {0}, expected[3];
        const int steps = 20000;
        const double step = (ranges[r][1] - ranges[r][0]) / steps;
        for (int i = 0; i < steps; i++) {
          const double nm = ranges[r][0] + (i + 0.5) * step;
          double xyz[3];
          abbe_observer_xyz(nm, xyz);
          for (int k = 0; k < 3; k++)
            sum[k] += xyz[k] * abbe_illuminant_power(&light, nm) *
                      abbe_upsampling_at(&u, colours[c], nm) * step / u.white_y;
        }
        abbe_rgb_space_apply(u.to_xyz, colours[c], expected);
        for (int k = 0; k < 3; k++) assert_near(sum[k], expected[k], 1e-6);
      }
    }
}

TEST(white_is_the_illuminant) {
  for (int kind = 0; kind < ABBE_ILLUMINANT_TABULATED; kind++) {
    const abbe_illuminant light = {.kind = (abbe_illuminant_kind)kind};
    const abbe_upsampling u = make(&light, 380, 780);
    abbe_weights_range range;
    double xyz[3];
    abbe_weights_range_make(&light, 380, 780, &range);
    abbe_weights_range_xyz(&range, 380, 780, xyz);
    for (int k = 0; k < 3; k++) assert_near(u.white[k], xyz[k], 1e-15);
    abbe_rgb_space_apply(u.to_xyz, white, xyz);
    for (int k = 0; k < 3; k++) assert_near(u.white[k], xyz[k], 1e-12);
    for (double nm = 370; nm < 800; nm += 3.3)
      assert_near(abbe_upsampling_at(&u, white, nm), 1, 1e-12);
  }
}

TEST(under_d65_it_is_rec709) {
  const abbe_illuminant light = {0};
  const abbe_upsampling u = make(&light, 380, 780);
  double rec709[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, rec709);
  for (int i = 0; i < 9; i++) {
    assert_near(u.to_xyz[i], rec709[i], 6e-4);
    assert_near(u.to_coefficients[i], i % 4 == 0, 2e-6);
  }
  assert_true(u.least > -2e-6 && u.least <= 0);
}

/* Any tiling of the range adds up to the same, in each space; white gives the weights. */
TEST(matrices_add_up) {
  static const size_t counts[] = {1, 2, 7, 21, 400, 4096};
  for (int kind = 0; kind < ABBE_ILLUMINANT_TABULATED; kind++)
    for (int space = 0; space < ABBE_RGB_SPACE_COUNT; space++)
      for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        const abbe_illuminant light = {.kind = (abbe_illuminant_kind)kind};
        const abbe_upsampling u = make(&light, 380, 780);
        MADE(abbe_wavelengths, samples,
             abbe_wavelengths_make(counts[n], 380, 780, &samples, &error));
        MADE(abbe_weights, weights,
             abbe_weights_make(&samples, &light, (abbe_rgb_space)space, &weights, &error));
        double(*matrix)[9] = calloc(counts[n], sizeof *matrix), sum[9] = {0}, from_xyz[9];
        assert_non_null(matrix);
        for (size_t i = 0; i < counts[n]; i++) {
          abbe_upsampling_band(&u, (abbe_rgb_space)space, samples.edge_nm[i],
                               samples.edge_nm[i + 1], matrix[i]);
          double rgb[3];
          abbe_rgb_space_apply(matrix[i], white, rgb);
          for (int k = 0; k < 3; k++) assert_near(rgb[k], weights.weight[i][k], 1e-13);
          for (int k = 0; k < 9; k++) sum[k] += matrix[i][k];
        }
        abbe_rgb_space_from_xyz((abbe_rgb_space)space, from_xyz);
        for (int c = 0; c < 5; c++) {
          double expected[3], is[3];
          abbe_rgb_space_apply(u.to_xyz, colours[c], expected);
          abbe_rgb_space_apply(from_xyz, expected, expected);
          abbe_rgb_space_apply(sum, colours[c], is);
          for (int k = 0; k < 3; k++) assert_near(is[k], expected[k], 1e-12);
        }
        free(matrix);
      }
}

/* As docs/colour.md says. */
TEST(least_values_are_known) {
  static const double least[] = {0, -0.0433, -0.1355, -0.0455};
  for (int kind = 0; kind < ABBE_ILLUMINANT_TABULATED; kind++) {
    const abbe_illuminant light = {.kind = (abbe_illuminant_kind)kind};
    const abbe_upsampling u = make(&light, 380, 780);
    assert_near(u.least, least[kind], 5e-4);
  }
}

TEST(too_few_colours) {
  const double nm[] = {588, 589, 590}, power[] = {0, 1, 0};
  OWNED(abbe_illuminant, sodium) = {.kind = ABBE_ILLUMINANT_TABULATED};
  const abbe_illuminant daylight = {0};
  OK(abbe_spectrum_make(nm, power, 3, ABBE_INTERPOLATION_LINEAR, &sodium.spectrum, &error));
  abbe_upsampling u;
  REFUSED(ABBE_INVALID_ARGUMENT, "too few colours",
          abbe_upsampling_make(&sodium, 380, 780, &u, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "900", abbe_upsampling_make(&daylight, 900, 1000, &u, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_upsampling_make(&daylight, 500, 500, &u, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_upsampling_make(&daylight, NAN, 500, &u, &error));
}

/* --- how far off metamers are --- */

static double bell(double nm, double middle, double width) {
  return exp(-0.5 * (nm - middle) * (nm - middle) / (width * width));
}

/* Lights by their spectra, relative to D65: incandescent, blue sky, cloudless horizon, a white LED
 * of a blue line and a phosphor, three narrow lines, a deep red filter. */
static double light_at(int which, double nm) {
  const abbe_illuminant a = {.kind = ABBE_ILLUMINANT_A}, d65 = {0};
  const double day = abbe_illuminant_power(&d65, nm);
  switch (which) {
  case 0:
    return abbe_illuminant_power(&a, nm) / day;
  case 1:
    return pow(560 / nm, 4);
  case 2:
    return 1 + 0.3 * (nm - 560) / 220;
  case 3:
    return 100 * (bell(nm, 450, 9) + 0.6 * bell(nm, 560, 50)) / day;
  case 4:
    return 100 * (bell(nm, 450, 8) + bell(nm, 540, 8) + bell(nm, 610, 8)) / day;
  default:
    return nm > 600 ? fmin((nm - 600) / 30, 1) : 0;
  }
}

/* Lab of the light, or of what is lifted from it, behind a filter or moved over the spectrum. */
static void seen(int which, double scale, const abbe_upsampling *u, const double *rgb, int how,
                 double lab[3]) {
  const abbe_illuminant d65 = {0}, a = {.kind = ABBE_ILLUMINANT_A};
  double xyz[3] = {0}, around[3] = {0};
  for (double nm = 380.5; nm < 780; nm++) {
    double observer[3];
    const double from = how == 2 ? fmin(nm + 20, 780) : nm;
    const double value = rgb ? abbe_upsampling_at(u, rgb, from) : scale * light_at(which, from);
    const double filter =
        how == 1 ? abbe_illuminant_power(&a, nm) / abbe_illuminant_power(&d65, nm) : 1;
    abbe_observer_xyz(nm, observer);
    for (int k = 0; k < 3; k++) {
      around[k] += observer[k] * abbe_illuminant_power(&d65, nm) * filter;
      xyz[k] += observer[k] * abbe_illuminant_power(&d65, from) * filter * value;
    }
  }
  for (int k = 0; k < 3; k++) xyz[k] /= around[1];
  const double bright = around[1];
  for (int k = 0; k < 3; k++) around[k] /= bright;
  abbe_difference_lab(xyz, around, lab);
}

TEST(metamers_are_off_by_this_much) {
  /* seen straight, through a filter that makes A of D65, and moved by 20 nm: CIEDE2000 */
  static const double most[6][3] = {{0.01, 1.2, 1.4}, {0.01, 0.7, 1},  {0.01, 0.4, 0.3},
                                    {0.01, 9, 16},    {0.01, 6.1, 28}, {0.01, 9, 22}};
  const abbe_illuminant d65 = {0};
  const abbe_upsampling u = make(&d65, 380, 780);
  double from_xyz[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  for (int which = 0; which < 6; which++) {
    double xyz[3] = {0}, rgb[3], own[3];
    for (double nm = 380.5; nm < 780; nm++) {
      double observer[3];
      abbe_observer_xyz(nm, observer);
      for (int k = 0; k < 3; k++)
        xyz[k] += observer[k] * abbe_illuminant_power(&d65, nm) * light_at(which, nm) / u.white_y;
    }
    /* as bright as half of white */
    const double scale = 0.5 / xyz[1];
    for (int k = 0; k < 3; k++) xyz[k] *= scale;
    abbe_rgb_space_apply(from_xyz, xyz, rgb);
    abbe_rgb_space_apply(from_xyz, u.white, own);
    for (int k = 0; k < 3; k++) rgb[k] /= own[k];
    for (int how = 0; how < 3; how++) {
      double is[3], lifted[3];
      seen(which, scale, &u, NULL, how, is);
      seen(which, scale, &u, rgb, how, lifted);
      const double off = abbe_difference_ciede2000(is, lifted);
      assert_true(off <= most[which][how]);
    }
  }
}

/* Of three knots' trapezoids, and of whole ranges by many points. */
TEST(means_are_integrals) {
  static const double range[][2] = {{380, 780}, {492.5, 517.3}, {551, 553}, {300, 400}, {770, 900}};
  for (size_t i = 0; i < sizeof range / sizeof *range; i++) {
    enum { POINTS = 20000 };
    double mean[3], sum[3] = {0};
    for (int p = 0; p < POINTS; p++) {
      double basis[3];
      abbe_upsampling_basis(range[i][0] + (range[i][1] - range[i][0]) * (p + 0.5) / POINTS, basis);
      for (int k = 0; k < 3; k++) sum[k] += basis[k] / POINTS;
    }
    abbe_upsampling_basis_mean(range[i][0], range[i][1], mean);
    for (int k = 0; k < 3; k++) assert_near(mean[k], sum[k], 1e-7);
    assert_near(mean[0] + mean[1] + mean[2], 1, 1e-12);
  }
  double mean[3], basis[3];
  abbe_upsampling_basis_mean(500, 500, mean);
  abbe_upsampling_basis(500, basis);
  for (int k = 0; k < 3; k++) assert_true(mean[k] == basis[k]);
}
