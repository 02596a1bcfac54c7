#include "tests/check.h"

#include "colorimetry/reflectance/colour_checker.h"
#include "colorimetry/reflectance/reflected_light.h"

static abbe_spectrum *make(const char *name) {
  abbe_spectrum *spectrum = NULL;
  abbe_error error = {0};
  if (abbe_colour_checker_make(name, &spectrum, &error) != ABBE_OK) fail_msg("%s", error.text);
  return spectrum;
}

/* x, y, Y under C as the chart's makers printed them [McCamy1976]; the chart that was measured is
 * another one, so a patch may be off by what charts differ: a tenth of the distance between any two
 * chromatic patches. */
static void colours_are_near_the_printed_ones(void **state) {
  (void)state;
  static const double printed[ABBE_COLOUR_CHECKER_COUNT][3] = {
      {0.4002, 0.3504, 0.1005}, {0.3773, 0.3446, 0.3582}, {0.2470, 0.2514, 0.1933},
      {0.3372, 0.4220, 0.1329}, {0.2651, 0.2400, 0.2427}, {0.2608, 0.3430, 0.4306},
      {0.5060, 0.4070, 0.3005}, {0.2110, 0.1750, 0.1200}, {0.4533, 0.3058, 0.1977},
      {0.2845, 0.2020, 0.0656}, {0.3800, 0.4887, 0.4429}, {0.4729, 0.4375, 0.4306},
      {0.1866, 0.1285, 0.0611}, {0.3046, 0.4782, 0.2339}, {0.5385, 0.3129, 0.1200},
      {0.4480, 0.4703, 0.5910}, {0.3635, 0.2325, 0.1977}, {0.1958, 0.2519, 0.1977},
      {0.3101, 0.3163, 0.9001}, {0.3101, 0.3163, 0.5910}, {0.3101, 0.3163, 0.3620},
      {0.3101, 0.3163, 0.1977}, {0.3101, 0.3163, 0.0900}, {0.3101, 0.3163, 0.0313}};
  abbe_illuminant c = {0};
  abbe_reflected_light *light = NULL;
  assert_int_equal(abbe_illuminant_make("C", &c, NULL), ABBE_OK);
  assert_int_equal(abbe_reflected_light_make(&c, 360, 830, &light, NULL), ABBE_OK);
  for (size_t i = 0; i < ABBE_COLOUR_CHECKER_COUNT; i++) {
    abbe_spectrum *spectrum = make(abbe_colour_checker_name(i));
    double xyz[3][3];
    abbe_reflected_light_xyz(light, spectrum, xyz);
    const double sum = xyz[0][0] + xyz[0][1] + xyz[0][2];
    const double off[3] = {xyz[0][0] / sum - printed[i][0], xyz[0][1] / sum - printed[i][1],
                           xyz[0][1] - printed[i][2]};
    if (fabs(off[0]) > 0.0085 || fabs(off[1]) > 0.0055 || fabs(off[2]) > 0.0135)
      fail_msg("%s: off by %.4f, %.4f, %.4f", abbe_colour_checker_name(i), off[0], off[1], off[2]);
    abbe_spectrum_free(spectrum);
  }
  abbe_reflected_light_free(light);
  abbe_illuminant_free(&c);
}

static void names_are_found_and_refused(void **state) {
  (void)state;
  abbe_spectrum *spectrum = make("BLUE Sky");
  assert_near(abbe_spectrum_at(spectrum, 380), 0.125, 0.03);
  abbe_spectrum_free(spectrum);
  abbe_error error = {0};
  assert_int_equal(abbe_colour_checker_make("blue skies", &spectrum, &error), ABBE_NOT_FOUND);
  assert_null(spectrum);
  assert_non_null(strstr(error.text, "did you mean 'blue sky'"));
  assert_null(abbe_colour_checker_name(ABBE_COLOUR_CHECKER_COUNT));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(colours_are_near_the_printed_ones),
                                     cmocka_unit_test(names_are_found_and_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
