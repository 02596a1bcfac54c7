/* Media by themselves: a phase function that is one, coefficients by wavelength, a region. */
#include "tests/check.h"
#include "tests/random.h"

#include "scenes/medium/medium.h"

/* All that is scattered goes somewhere, and turns by the angle of the mean cosine g. */
TEST(the_phase_function_is_normal) {
  static const double g[] = {0, 0.3, -0.6, 0.9, 0.99};
  enum { PARTS = 400000 };
  for (size_t i = 0; i < sizeof g / sizeof *g; i++) {
    double sum = 0, cosines = 0;
    for (int k = 0; k < PARTS; k++) {
      /* steps that shrink towards the peak: cosine = 1 - 2 x^3 or its mirror image */
      const double x = (k + 0.5) / PARTS, turn = g[i] < 0 ? -1 : 1;
      const double cosine = turn * (1 - 2 * x * x * x), weight = 6 * x * x / PARTS;
      const double share = 2 * 3.14159265358979323846 * weight * abbe_medium_phase(g[i], cosine);
      sum += share;
      cosines += share * cosine;
    }
    assert_near(sum, 1, 1e-7);
    assert_near(cosines, g[i], 1e-7);
  }
  assert_near(abbe_medium_phase(0, 0.4), 1 / (4 * 3.14159265358979323846), 1e-15);
}

static abbe_medium *make(void) {
  static const double nm[] = {400, 500, 700}, scattering[] = {4, 2, 2}, anywhere = 555, all = 0.5;
  static abbe_medium m;
  m = (abbe_medium){.g = 0.2};
  OK(abbe_spectrum_make(nm, scattering, 3, ABBE_INTERPOLATION_LINEAR, &m.scattering, &error));
  OK(abbe_spectrum_make(&anywhere, &all, 1, ABBE_INTERPOLATION_LINEAR, &m.absorption, &error));
  return &m;
}

TEST(coefficients_go_by_wavelength) {
  abbe_medium *m = make(), *copy = NULL;
  OK(abbe_medium_copy(m, &copy, &error));
  abbe_spectrum_free(m->scattering);
  abbe_spectrum_free(m->absorption);
  assert_near(abbe_medium_scattering(copy, 450), 3, 1e-12);
  assert_near(abbe_medium_scattering(copy, 380), 4, 0);
  assert_near(abbe_medium_scattering(copy, 600), 2, 0);
  assert_near(abbe_medium_absorption(copy, 600), 0.5, 0);
  assert_near(copy->g, 0.2, 0);
  assert_true(abbe_medium_is_coloured(copy, 380, 780));
  assert_true(abbe_medium_is_coloured(copy, 480, 520));
  assert_false(abbe_medium_is_coloured(copy, 500, 780));
  abbe_medium_free(copy);
  abbe_medium_free(NULL);
  OK(abbe_medium_copy(NULL, &copy, &error));
  assert_null(copy);
  assert_near(abbe_medium_scattering(NULL, 500), 0, 0);
  assert_false(abbe_medium_is_coloured(NULL, 380, 780));
}
