#include "tests/scenes/scene_text.h"

#include "validation/trace/transport/bands.h"

#define TWO_LIGHTS                                                                                 \
  "lights:\n"                                                                                      \
  "- {name: day, kind: point, position: [0, 0, 1], intensity: 1}\n"                                \
  "- {name: even, kind: point, position: [0, 1, 1], intensity: 7, illuminant: E}\n"

static abbe_scene scene;

static abbe_spectral_sampling sampling_over(double min_nm, double max_nm, size_t bands) {
  abbe_spectral_sampling s;
  const abbe_spectral_sampling_desc desc = {
      .min_nm = min_nm, .max_nm = max_nm, .uniform = 0.5, .bands = bands};
  OK(abbe_spectral_sampling_make(&scene, &desc, &s, &error));
  return s;
}

static void setup(void) {
  scene = scene_of(CAMERA TWO_LIGHTS FLOOR);
}

static void teardown(void) {
  abbe_scene_free(&scene);
}

GROUP(setup, teardown);

/* "S0.550,000000nm": a stokes component, a wavelength with a comma, its unit [Fichet2021]. */
TEST(names_are_as_the_layout_has_them) {
  OWNED(abbe_spectral_sampling, s) = sampling_over(380, 780, 40);
  char name[64];
  MADE(abbe_bands, b, abbe_bands_make(&s, 40, &b, &error));
  abbe_bands_name(&b, 0, name, sizeof name);
  assert_string_equal(name, "S0.385,000000nm");
  abbe_bands_name(&b, 17, name, sizeof name);
  assert_string_equal(name, "S0.555,000000nm");
  abbe_bands_free(&b);
  abbe_spectral_sampling_free(&s);
  s = sampling_over(380, 780, 3);
  OK(abbe_bands_make(&s, 3, &b, &error));
  abbe_bands_name(&b, 0, name, sizeof name);
  assert_string_equal(name, "S0.446,666667nm");
}

/* The most bands over a range of one nanometre still have names of their own. */
TEST(narrow_bands_have_names_of_their_own) {
  OWNED(abbe_spectral_sampling, s) = sampling_over(589, 590, ABBE_BANDS_MAX);
  MADE(abbe_bands, b, abbe_bands_make(&s, ABBE_BANDS_MAX, &b, &error));
  char last[64] = "", name[64];
  for (size_t i = 0; i < b.count; i++) {
    abbe_bands_name(&b, i, name, sizeof name);
    assert_string_not_equal(name, last);
    memcpy(last, name, sizeof last);
  }
}

TEST(bands_tile_the_range_and_hold_the_light) {
  static const double ranges[][2] = {{380, 780}, {589, 590}, {300, 900}};
  static const size_t counts[] = {1, 2, 7, 40, 256};
  for (size_t r = 0; r < 3; r++) {
    for (size_t c = 0; c < 5; c++) {
      OWNED(abbe_spectral_sampling, s) = sampling_over(ranges[r][0], ranges[r][1], counts[c]);
      MADE(abbe_bands, b, abbe_bands_make(&s, counts[c], &b, &error));
      assert_int_equal(b.count, counts[c]);
      assert_near(b.width_nm * (double)b.count, ranges[r][1] - ranges[r][0], 1e-9);
      assert_near(b.middle_nm[0] - 0.5 * b.width_nm, ranges[r][0], 1e-9);
      for (size_t k = 0; k < s.steps; k++) {
        assert_true(b.of_step[k] < b.count);
        const double middle = b.middle_nm[b.of_step[k]], half = 0.5 * b.width_nm;
        assert_true(s.lambda_nm[k] >= middle - half - 1e-9);
        assert_true(s.lambda_nm[k + 1] > s.lambda_nm[k]);
        assert_true(s.lambda_nm[k + 1] <= middle + half + 1e-9);
      }
      for (size_t l = 0; l < 2; l++) {
        double watts = 0;
        for (size_t i = 0; i < b.count; i++) watts += (double)b.power[l * b.count + i] * b.width_nm;
        assert_near(watts, 1, 1e-6);
      }
    }
  }
}

/* The light's own power between two wavelengths, by a fine quadrature. */
static double power_of(size_t light, double from, double to) {
  enum { PARTS = 4000 };
  double sum = 0;
  for (int i = 0; i < PARTS; i++)
    sum += abbe_illuminant_power(&scene.light[light].illuminant,
                                 from + (to - from) * (i + 0.5) / PARTS);
  return sum * (to - from) / PARTS;
}

/* Illuminant E has the same power in every band, 1 W over 400 nm; D65 what its table says. */
TEST(bands_hold_their_lights_power) {
  static const size_t counts[] = {1, 7, 20, 80, 160, 256};
  for (size_t c = 0; c < 6; c++) {
    OWNED(abbe_spectral_sampling, s) = sampling_over(380, 780, counts[c]);
    MADE(abbe_bands, b, abbe_bands_make(&s, counts[c], &b, &error));
    for (size_t i = 0; i < b.count; i++) {
      const double from = b.middle_nm[i] - 0.5 * b.width_nm, to = from + b.width_nm;
      const double day = power_of(0, from, to) / power_of(0, 380, 780) / b.width_nm;
      assert_near((double)b.power[i] / day, 1, 1e-5);
      assert_near((double)b.power[b.count + i] * 400, 1, 1e-6);
    }
  }
}

TEST(none_and_too_many) {
  OWNED(abbe_spectral_sampling, s) = sampling_over(380, 780, 0);
  abbe_bands b;
  OK(abbe_bands_make(&s, 0, &b, &error));
  assert_int_equal(b.count, 0);
  abbe_bands_free(&b);
  REFUSED(ABBE_INVALID_ARGUMENT, "257", abbe_bands_make(&s, 257, &b, &error));
  assert_contains(last_error.text, "256");
  assert_int_equal(abbe_bands_make(&s, SIZE_MAX, &b, NULL), ABBE_INVALID_ARGUMENT);
  abbe_bands_free(&b);
  abbe_bands_free(NULL);
}
