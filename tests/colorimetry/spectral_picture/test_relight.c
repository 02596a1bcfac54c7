#include "tests/check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/spectral_picture/relight.h"
#include "colorimetry/weights.h"

enum { BANDS = 80 };

/* Bands of 5 nm over 380 to 780 nm, of the kind that the prefix says, two pixels. */
static void make(const char *prefix, abbe_image *image) {
  char name[BANDS][40];
  const char *names[BANDS];
  for (int i = 0; i < BANDS; i++) {
    snprintf(name[i], sizeof name[i], "%s%d,5nm", prefix, 382 + 5 * i);
    names[i] = name[i];
  }
  OK(abbe_image_make(2, 1, BANDS, names, image, &error));
}

static double middle(int band) {
  return 382.5 + 5 * band;
}

/* x and y of an equal-energy spectrum: a third each for every observer, whose functions have equal
 * integrals by definition [CIE15] [CIE170-2], to the rounding of the tables; and over 380 to 780
 * nm.
 */
TEST(equal_energy_of_each_observer) {
  abbe_image xyz;
  FILLED(abbe_image, image, make("S0.", &image));
  for (size_t i = 0; i < 2 * BANDS; i++) image.data[i] = 0.5f;
  for (int observer = 0; observer < ABBE_OBSERVER_COUNT; observer++) {
    abbe_relight_desc desc = {
        .view.observer = (abbe_observer)observer, .space = ABBE_RGB_SPACE_XYZ, .relative = true};
    double xy[2];
    OK(abbe_relight_make(&image, "it", &desc, &xyz, &error));
    const double at[3] = {(double)xyz.data[0], (double)xyz.data[1], (double)xyz.data[2]};
    assert_near(at[1], 0.5, 1e-6);
    assert_true(abbe_chromaticity_xy(at, xy));
    assert_near(xy[0], 1.0 / 3, 2e-4);
    assert_near(xy[1], 1.0 / 3, 2e-4);
    assert_string_equal(abbe_image_attribute_text(&xyz, "abbe:observer"),
                        abbe_observer_text((abbe_observer)observer));
    abbe_image_free(&xyz);
  }
}

/* A reflectance that falls from 0.9 to 0.1: under A as its direct integral in steps of 0.1 nm. */
static double falling(double nm) {
  return 0.9 - 0.8 * (nm - 380) / 400;
}

static void integrate(const abbe_illuminant *light, abbe_observer observer, double out[3]) {
  double white = 0;
  memset(out, 0, 3 * sizeof *out);
  for (double nm = 380.05; nm < 780; nm += 0.1) {
    double xyz[3];
    abbe_observer_xyz_of(observer, nm, xyz);
    const double power = abbe_illuminant_power(light, nm);
    white += power * xyz[1];
    for (int k = 0; k < 3; k++) out[k] += power * falling(nm) * xyz[k];
  }
  for (int k = 0; k < 3; k++) out[k] /= white;
}

TEST(a_reflectance_under_another_light) {
  const abbe_illuminant a = {.kind = ABBE_ILLUMINANT_A}, d65 = {0};
  const abbe_illuminant *const lights[2] = {&a, &d65};
  OWNED(abbe_image, reflected) = {0}, emitted = {0};
  abbe_image out;
  make("T.", &reflected);
  make("S0.", &emitted);
  for (int b = 0; b < BANDS; b++) {
    reflected.data[b] = (float)falling(middle(b));
    emitted.data[b] =
        (float)(falling(middle(b)) *
                abbe_weights_band_power(&d65, 380, 780, middle(b) - 2.5, middle(b) + 2.5) / 5);
  }
  for (int observer = 0; observer < 2; observer++)
    for (int light = 0; light < 2; light++) {
      double expected[3];
      integrate(lights[light], (abbe_observer)observer, expected);
      abbe_relight_desc desc = {.view = {.observer = (abbe_observer)observer, .to = lights[light]},
                                .space = ABBE_RGB_SPACE_XYZ};
      OK(abbe_relight_make(&reflected, "it", &desc, &out, &error));
      for (int k = 0; k < 3; k++) assert_near((double)out.data[k], expected[k], 2e-4);
      abbe_image_free(&out);
      /* The same of the light that comes back, made with D65. */
      desc.view.from = &d65;
      OK(abbe_relight_make(&emitted, "it", &desc, &out, &error));
      for (int k = 0; k < 3; k++) assert_near((double)out.data[k], expected[k], 2e-4);
      abbe_image_free(&out);
    }
}

/* 683 lm/W and the integral of ybar: an even radiance of 1 mW/(m2 sr nm), and its thousandth of a
 * watt, are the same luminance; an irradiance is in lux. */
TEST(units) {
  static const struct {
    const char *unit, *says;
    float value;
  } cases[] = {{"W.m^-2.sr^-1.nm^-1", "luminance, cd/m2", 1e-3f},
               {"mW.m^-2.sr^-1.nm^-1", "luminance, cd/m2", 1},
               {"W.m^-2", "illuminance, lx", 1e-3f}};
  const abbe_relight_desc desc = {.space = ABBE_RGB_SPACE_XYZ};
  for (int i = 0; i < 3; i++) {
    FILLED(abbe_image, image, make("S0.", &image));
    for (size_t b = 0; b < 2 * BANDS; b++) image.data[b] = cases[i].value;
    abbe_image_set_attribute(&image, "emissiveUnits", cases[i].unit, NULL);
    MADE(abbe_image, xyz, abbe_relight_make(&image, "it", &desc, &xyz, &error));
    assert_near((double)xyz.data[1], 0.683 * 106.856, 0.03); /* the CIE's sum over 360 to 830 nm */
    assert_string_equal(abbe_image_attribute_text(&xyz, "abbe:unit"), cases[i].says);
  }
}

/* Of a file, of which the colours alone are held, as of the same picture in memory: with samples
 * that are no numbers, with infinite ones, and with bands kept. */
TEST(from_a_file) {
  static const char path[] = "relight_file.exr";
  FILLED(abbe_image, image, make("S0.", &image));
  for (size_t i = 0; i < 2 * BANDS; i++) image.data[i] = 0.01f * (float)(i * 37 % 101) - 0.1f;
  for (int i = 0; i < 4; i++) {
    abbe_image_odd odd, odd_file;
    abbe_relight_desc desc = {.space = ABBE_RGB_SPACE_ACESCG, .odd = &odd, .bands = i == 3};
    if (i > 0) image.data[i == 1 ? 7 : BANDS + 3] = i == 1 ? NAN : INFINITY;
    OK(abbe_exr_write(path, &image, &error));
    MADE(abbe_image, expected, abbe_relight_make(&image, "it", &desc, &expected, &error));
    OK(abbe_exr_open(path, &desc.file, &error));
    MADE(abbe_image, header, abbe_exr_read_header(desc.file, &header, &error));
    assert_null(header.data);
    desc.odd = &odd_file;
    MADE(abbe_image, out, abbe_relight_make(&header, "it", &desc, &out, &error));
    for (size_t k = 0; k < 2 * out.channels; k++)
      if (isnan(expected.data[k]))
        assert_true(isnan(out.data[k]));
      else if (isfinite(expected.data[k]))
        assert_near((double)out.data[k], (double)expected.data[k],
                    1e-7 * fabs((double)expected.data[k]));
    assert_true(odd.nan == odd_file.nan && odd.infinite == odd_file.infinite);
    assert_true(odd.nan == (size_t)(i > 0) && odd.infinite == (size_t)(i > 1));
    abbe_exr_close(desc.file);
  }
  remove(path);
}

/* An infinite band is as bright as the brightest half, or as the brightest band that there is, and
 * does not take the others away; what is not a number stays so. */
TEST(infinite_bands) {
  abbe_image_odd odd;
  const abbe_relight_desc desc = {.space = ABBE_RGB_SPACE_ACESCG, .odd = &odd};
  double bright[3];
  FILLED(abbe_image, image, make("S0.", &image));
  image.data[40] = 65504;
  MADE(abbe_image, xyz, abbe_relight_make(&image, "it", &desc, &xyz, &error));
  for (int k = 0; k < 3; k++) bright[k] = (double)xyz.data[k];
  abbe_image_free(&xyz);
  image.data[40] = INFINITY;
  image.data[BANDS] = NAN;
  OK(abbe_relight_make(&image, "it", &desc, &xyz, &error));
  for (int k = 0; k < 3; k++) {
    assert_near((double)xyz.data[k], bright[k], 1e-6 * fabs(bright[k]));
    assert_true(isnan(xyz.data[3 + k]));
  }
  assert_true(odd.infinite == 1 && odd.nan == 1);
}

/* Bands that are kept are those that a lamp of the other illuminant makes; and looked at again, as
 * made with that one, they have the same colour. */
TEST(bands_are_kept) {
  const abbe_illuminant a = {.kind = ABBE_ILLUMINANT_A}, d65 = {0};
  FILLED(abbe_image, lamp, make("S0.", &lamp));
  for (int b = 0; b < BANDS; b++)
    lamp.data[b] =
        (float)(abbe_weights_band_power(&d65, 380, 780, middle(b) - 2.5, middle(b) + 2.5) / 5);
  lamp.display_window = lamp.data_window = (abbe_image_window){3, 4, 4, 4};
  const abbe_relight_desc desc = {
      .view = {.from = &d65, .to = &a}, .space = ABBE_RGB_SPACE_XYZ, .bands = true};
  MADE(abbe_image, out, abbe_relight_make(&lamp, "it", &desc, &out, &error));
  assert_int_equal(out.channels, 3 + BANDS);
  assert_string_equal(out.channel[3], "S0.382,500000nm");
  assert_string_equal(abbe_image_attribute_text(&out, "spectralLayoutVersion"), "1.0");
  assert_true(out.display_window.x0 == 3 && out.display_window.y1 == 4);
  for (int b = 0; b < BANDS; b++) {
    const double expected =
        abbe_weights_band_power(&a, 380, 780, middle(b) - 2.5, middle(b) + 2.5) / 5;
    assert_near((double)out.data[3 + b], expected, 1e-6 * expected);
  }
  const abbe_relight_desc as_it_is = {.view.from = &a, .space = ABBE_RGB_SPACE_XYZ};
  MADE(abbe_image, again, abbe_relight_make(&out, "it", &as_it_is, &again, &error));
  for (int k = 0; k < 3; k++) assert_near((double)again.data[k], (double)out.data[k], 1e-6);
}

TEST(re_radiation_is_seen_and_kept) {
  static const char *const names[] = {"T.400nm", "T.500nm", "T.600nm", "T.400nm.600nm"};
  const abbe_illuminant a = {.kind = ABBE_ILLUMINANT_A}, d65 = {0};
  double y[2];
  MADE(abbe_image, image, abbe_image_make(1, 1, 4, names, &image, &error));
  image.data[3] = 0.5f;
  for (int i = 0; i < 2; i++) {
    const abbe_relight_desc desc = {
        .view.to = i == 0 ? &d65 : &a, .space = ABBE_RGB_SPACE_XYZ, .bands = true};
    MADE(abbe_image, out, abbe_relight_make(&image, "it", &desc, &out, &error));
    assert_int_equal(out.channels, 3 + 4);
    assert_string_equal(out.channel[6], "T.400,000000nm.600,000000nm");
    assert_true(out.data[6] == 0.5f);
    y[i] = (double)out.data[1];
  }
  /* A has little light around 400 nm */
  assert_true(y[0] > 3 * y[1] && y[1] > 0);
}

TEST(what_is_refused_and_what_is_needed) {
  static const char *const rgb[] = {"R", "G", "B", "left.S0.500nm", "left.S0.600nm"};
  const abbe_relight_desc none = {0}, left = {.layer = "left"};
  OWNED(abbe_image, out);
  MADE(abbe_image, image, abbe_image_make(1, 1, 5, rgb, &image, &error));
  REFUSED(ABBE_NOT_FOUND, "it.exr: it has no bands",
          abbe_relight_make(&image, "it.exr", &none, &out, &error));
  assert_false(abbe_relight_is_needed(&image, NULL));
  assert_true(abbe_relight_is_needed(&image, "left"));
  assert_false(abbe_relight_is_needed(&image, "right"));
  OK(abbe_relight_make(&image, "it.exr", &left, &out, &error));
  assert_string_equal(abbe_image_attribute_text(&out, "abbe:unit"), "luminance, cd/m2");
}
