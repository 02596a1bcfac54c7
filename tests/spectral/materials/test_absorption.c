#include "tests/check.h"

#include "spectral/materials/absorption.h"

/* F2 at 400 nm: an internal transmittance of 0.985 at 25 mm in the catalogue, and k = 1.9245e-8 by
 * the rule k = -ln(T) lambda / (4 pi d). */
TEST(transmittance_and_k_agree) {
  double a = abbe_absorption_from_transmittance(0.985, 0.025);
  assert_near(a, 0.604546, 5e-7);
  assert_near(abbe_absorption_k(a, 400), 1.92433e-8, 5e-13);
  assert_near(abbe_absorption_from_k(1.92432e-8, 400), a, 1e-5);
  assert_near(abbe_absorption_transmittance(a, 0.025), 0.985, 1e-15);
}

TEST(each_way_is_undone_by_its_inverse) {
  for (double t = 1e-6; t <= 1; t *= 1.7) {
    double a = abbe_absorption_from_transmittance(t, 0.01);
    assert_true(a >= 0);
    assert_near(abbe_absorption_transmittance(a, 0.01), t, 1e-12 * t);
    assert_near(abbe_absorption_from_k(abbe_absorption_k(a, 550), 550), a, 1e-12 * a);
  }
  assert_near(abbe_absorption_from_transmittance(1, 0.01), 0, 0);
  assert_false(signbit(abbe_absorption_from_transmittance(1, 0.01)));
  assert_near(abbe_absorption_from_transmittance(1.001, 0.01), 0, 0);
  /* too dark to measure is as dark as the least that is told apart */
  assert_near(abbe_absorption_from_transmittance(0, 0.01), -log(1e-6) / 0.01, 1e-9);
}

TEST(tables_become_spectra_over_their_range) {
  abbe_point list[] = {{400, 0.5, 0}, {500, 1, 0}, {600, 0, 0}};
  const abbe_points points = {.count = 3, .point = list};
  abbe_spectrum *a = NULL;
  OK(abbe_absorption_spectrum_of_transmittance(&points, 0.01, &a, &error));
  assert_near(abbe_spectrum_at(a, 400), log(2) / 0.01, 1e-12);
  assert_near(abbe_spectrum_at(a, 450), log(2) / 0.02, 1e-12);
  assert_near(abbe_spectrum_at(a, 300), log(2) / 0.01, 1e-12);
  assert_int_equal(abbe_spectrum_count(a), 3);
  abbe_spectrum_free(a);
  OK(abbe_absorption_spectrum_of_k(&points, &a, &error));
  assert_near(abbe_spectrum_at(a, 500), 4 * acos(-1) / 500e-9, 1e-6);
  abbe_spectrum_free(a);
}

TEST(a_colour_comes_back_at_its_distance) {
  const double ruby[3] = {0.8, 0.05, 0.1};
  double back[3];
  abbe_spectrum *a = NULL;
  OK(abbe_absorption_spectrum_of_colour(ruby, 0.004, &a, &error));
  abbe_absorption_colour(a, 0.004, back);
  for (int i = 0; i < 3; i++) assert_near(back[i], ruby[i], 1e-15);
  abbe_absorption_colour(a, 0.008, back); /* twice the way, the square */
  for (int i = 0; i < 3; i++) assert_near(back[i], ruby[i] * ruby[i], 1e-15);
  abbe_spectrum_free(a);
}

TEST(wrong_values_are_named) {
  abbe_point high = {450, 99.5, 0}, negative = {450, -1, 0};
  const abbe_points percent = {.count = 1, .point = &high}, none = {0};
  const abbe_points below = {.count = 1, .point = &negative};
  const double colour[3] = {0.5, 0, 0.5};
  abbe_spectrum *a = NULL;
  REFUSED(ABBE_INVALID_ARGUMENT, "at 450 nm is 99.5; it is a share from 0 to 1",
          abbe_absorption_spectrum_of_transmittance(&percent, 0.01, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "thickness",
          abbe_absorption_spectrum_of_transmittance(&none, 0, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "k at 450 nm is -1",
          abbe_absorption_spectrum_of_k(&below, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_absorption_spectrum_of_k(&none, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_absorption_spectrum_of_colour(colour, 0.1, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_absorption_spectrum_of_colour(colour, -1, &a, &error));
  assert_null(a);
}
