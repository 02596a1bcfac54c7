#include "tests/check.h"

#include "colorimetry/difference.h"
#include "colorimetry/pleochroism.h"

/* Grey along x and y, grey and denser along z: the field passes e^-1 and e^-2 of all light. */
TEST(grey_axes_pass_what_beer_says) {
  double nm = 500, a[2] = {100, 200};
  abbe_material m = {.dispersion = {.count = 1, .c = {1.6}},
                     .extraordinary = {.count = 1, .c = {1.5}}};
  OK(abbe_spectrum_make(&nm, &a[0], 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  OK(abbe_spectrum_make(&nm, &a[1], 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation_yz[1], &error));
  abbe_pleochroism p;
  abbe_pleochroism_make(&m, 0.01, &p);
  assert_near(p.field[0][1], exp(-1), 1e-12);
  assert_near(p.field[1][1], exp(-1), 1e-12);
  assert_near(p.field[2][1], exp(-2), 1e-12);
  /* two exponentials, and not one of the mean */
  assert_near(p.face[0][1], (exp(-1) + exp(-2)) / 2, 1e-12);
  assert_near(p.face[2][1], exp(-1), 1e-12);
  assert_near(p.field_lab[0][0], 116 * cbrt(exp(-1)) - 16, 1e-10);
  assert_near(hypot(p.field_lab[2][1], p.field_lab[2][2]), 0, 1e-10);
  assert_near(p.largest, 116 * (cbrt(exp(-1)) - cbrt(exp(-2))), 1e-10);
  assert_int_equal(p.axis[1], 2);
  abbe_spectrum_free(m.attenuation);
  abbe_spectrum_free(m.attenuation_yz[1]);
}

TEST(what_absorbs_alike_has_one_colour) {
  double nm[2] = {400, 700}, a[2] = {0, 100};
  abbe_material m = {.dispersion = {.count = 1, .c = {1.6}}};
  OK(abbe_spectrum_make(nm, a, 2, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  abbe_pleochroism p;
  abbe_pleochroism_make(&m, 0.01, &p);
  assert_near(p.largest, 0, 0);
  assert_true(p.field_lab[0][2] < -5); /* blue */
  abbe_spectrum_free(m.attenuation);
}
