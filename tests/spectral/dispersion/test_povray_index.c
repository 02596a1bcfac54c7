#include "tests/check.h"

#include "spectral/dispersion/povray_index.h"

enum { COUNT = 36 };
static double lambda_nm[COUNT], n[COUNT];

static void set_up_law(double ior, double dispersion) {
  for (int i = 0; i < COUNT; i++) {
    lambda_nm[i] = 380 + 10 * i;
    n[i] = ior * pow(dispersion, (555 - lambda_nm[i]) / 350);
  }
}

/* As the manual states it: ior in the middle, the ratio of the ends. */
TEST(the_law_is_that_of_the_manual) {
  const abbe_povray_index index = {1.6, 1.04};
  assert_near(abbe_povray_index_at(&index, 555), 1.6, 1e-15);
  assert_near(abbe_povray_index_at(&index, 380) / abbe_povray_index_at(&index, 730), 1.04, 1e-15);
  assert_near(abbe_povray_index_at(&index, 380), 1.6 * sqrt(1.04), 1e-15);
}

TEST(what_follows_the_law_is_found_whatever_the_weights) {
  const double ratios[] = {0.97, 1.01, 1.2};
  for (int k = 0; k < 3; k++) {
    double weight[COUNT];
    set_up_law(1.7, ratios[k]);
    for (int i = 0; i < COUNT; i++) weight[i] = 1e6 * (i % 3);
    abbe_povray_index alike = abbe_povray_index_fit(lambda_nm, n, NULL, COUNT);
    abbe_povray_index weighted = abbe_povray_index_fit(lambda_nm, n, weight, COUNT);
    assert_near(alike.ior, 1.7, 1e-12);
    assert_near(alike.dispersion, ratios[k], 1e-12);
    assert_near(weighted.ior, 1.7, 1e-12);
    assert_near(weighted.dispersion, ratios[k], 1e-12);
  }
}

/* Of two lines that disagree the fit goes with the one that weighs. */
TEST(weights_decide) {
  double weight[COUNT];
  set_up_law(1.5, 1.02);
  for (int i = 0; i < COUNT; i++) weight[i] = i % 2 == 0;
  for (int i = 1; i < COUNT; i += 2) n[i] += 0.01;
  abbe_povray_index index = abbe_povray_index_fit(lambda_nm, n, weight, COUNT);
  assert_near(index.ior, 1.5, 1e-12);
  index = abbe_povray_index_fit(lambda_nm, n, NULL, COUNT);
  assert_near(index.ior, 1.505, 1e-4);
}

TEST(a_constant_index_has_no_dispersion) {
  set_up_law(1.33, 1);
  abbe_povray_index index = abbe_povray_index_fit(lambda_nm, n, NULL, COUNT);
  assert_near(index.dispersion, 1, 0);
  assert_near(index.ior, 1.33, 1e-14);
  index = abbe_povray_index_fit(lambda_nm, n, NULL, 1);
  assert_near(index.dispersion, 1, 0);
  assert_near(index.ior, 1.33, 1e-14);
}
