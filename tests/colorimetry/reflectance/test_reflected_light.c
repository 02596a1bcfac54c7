#include "tests/check.h"

#include "colorimetry/observer.h"
#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"

HOLDS(abbe_reflected_light);

static abbe_reflected_light *make(const char *name, double min_nm, double max_nm,
                                  abbe_illuminant *illuminant) {
  abbe_reflected_light *light = NULL;
  OK(abbe_illuminant_make(name, illuminant, &error));
  OK(abbe_reflected_light_make(illuminant, min_nm, max_nm, &light, &error));
  return light;
}

/* A sum over tenths of a nanometre, written down here alone. */
static void integrate(const abbe_illuminant *illuminant, const abbe_spectrum *measured,
                      double xyz[3]) {
  double white = 0;
  for (int k = 0; k < 3; k++) xyz[k] = 0;
  for (double nm = 380.05; nm < 780; nm += 0.1) {
    double observer[3];
    const double power = abbe_illuminant_power(illuminant, nm);
    abbe_observer_xyz(nm, observer);
    white += power * observer[1];
    for (int k = 0; k < 3; k++) xyz[k] += power * observer[k] * abbe_spectrum_at(measured, nm);
  }
  for (int k = 0; k < 3; k++) xyz[k] /= white;
}

TEST(measured_patches_are_integrals) {
  static const char *const lights[] = {"D65", "A", "F11", "LED-RGB1"};
  for (size_t l = 0; l < 4; l++) {
    OWNED(abbe_illuminant, illuminant);
    HELD(abbe_reflected_light, light) = make(lights[l], 380, 780, &illuminant);
    for (size_t p = 0; p < ABBE_COLOUR_CHECKER_COUNT; p++) {
      abbe_spectrum *patch = NULL;
      double wanted[3], xyz[3][3], matrix[3][9], white[3], seen[3];
      OK(abbe_colour_checker_make(abbe_colour_checker_name(p), &patch, &error));
      integrate(&illuminant, patch, wanted);
      abbe_reflected_light_xyz(light, patch, xyz);
      abbe_reflected_light_matrices(light, patch, matrix);
      abbe_reflected_light_white(light, white);
      abbe_rgb_space_apply(matrix[0], white, seen);
      for (int k = 0; k < 3; k++) {
        assert_near(xyz[0][k], wanted[k], 3e-5);
        assert_near(seen[k], xyz[0][k], 1e-9);
        assert_near(xyz[1][k], 0, 0);
      }
      abbe_spectrum_free(patch);
    }
  }
}

/* Under D65 a Rec.709 colour reflects that colour, as near as the table's white is to the nominal
 * one; greys are grey under any light. */
TEST(rec709_under_d65_is_itself) {
  OWNED(abbe_illuminant, illuminant);
  HELD(abbe_reflected_light, light) = make("D65", 380, 780, &illuminant);
  double xyz[3][3], to_xyz[9], white[3];
  abbe_reflected_light_xyz(light, NULL, xyz);
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) assert_near(xyz[j][k], to_xyz[3 * k + j], 5.5e-4);
  abbe_reflected_light_free(light);
  light = make("F11", 380, 780, &illuminant);
  abbe_reflected_light_xyz(light, NULL, xyz);
  abbe_reflected_light_white(light, white);
  for (int k = 0; k < 3; k++) assert_near(xyz[0][k] + xyz[1][k] + xyz[2][k], white[k], 1e-12);
}

/* The matrices of red, green and blue add up to no change at all. */
TEST(white_changes_no_light) {
  abbe_illuminant illuminant;
  HELD(abbe_reflected_light, light) = make("A", 400, 700, &illuminant);
  double matrix[3][9];
  abbe_reflected_light_matrices(light, NULL, matrix);
  for (int i = 0; i < 9; i++)
    assert_near(matrix[0][i] + matrix[1][i] + matrix[2][i], i % 4 == 0, 1e-9);
}

TEST(narrow_lights_and_bad_ranges) {
  abbe_illuminant illuminant;
  abbe_reflected_light *light = make("D65", 640, 640.5, &illuminant);
  double matrix[3][9];
  abbe_reflected_light_matrices(light, NULL, matrix);
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 9; i++) assert_true(isfinite(matrix[j][i]));
  assert_true(matrix[0][4] > 0.5 && matrix[2][4] < 0.1);
  abbe_reflected_light_free(light);
  light = make("D65", 900, 1000, &illuminant);
  abbe_reflected_light_matrices(light, NULL, matrix);
  for (int i = 0; i < 9; i++) assert_near(matrix[0][i], 0, 0);
  abbe_reflected_light_free(light);
  static const double bad[][2] = {{500, 500}, {700, 400}, {0, 700}, {NAN, 700}, {400, INFINITY}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_int_equal(abbe_reflected_light_make(&illuminant, bad[i][0], bad[i][1], &light, NULL),
                     ABBE_INVALID_ARGUMENT);
    assert_null(light);
  }
}
