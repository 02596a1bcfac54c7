/* Light under a sinusoidal surface against what is known of it in closed form. */
#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"

#include "tests/check.h"

static const abbe_wave_caustic low = {
    .amplitude = 0.0002, .wavelength = 0.1, .depth = 1, .index = 4.0 / 3};

TEST(rays_meet_under_the_crest) {
  abbe_wave_caustic w = low;
  w.depth = abbe_wave_caustic_focus(&w);
  const double k = 2 * ABBE_PI / w.wavelength;
  assert_near(w.depth, 4 / (w.amplitude * k * k), 1e-12);
  for (int i = 1; i < 5; i++)
    assert_near(abbe_wave_caustic_landing(&w, 1e-4 * i, NULL), 0, 1e-3 * 1e-4 * i);
}

/* Where the slope is small: E / T = 1 / |1 - (D / f) cos kx| at the place that x comes to. */
TEST(a_low_wave_is_paraxial) {
  abbe_wave_caustic w = low;
  const double through = 1 - pow(1.0 / 7, 2), k = 2 * ABBE_PI / w.wavelength;
  w.depth = 0.4 * abbe_wave_caustic_focus(&w);
  for (int i = 0; i < 8; i++) {
    const double x = w.wavelength * (i + 0.5) / 16, at = abbe_wave_caustic_landing(&w, x, NULL);
    const double known = through / fabs(1 - 0.4 * cos(k * x)), half = 1e-3 * w.wavelength;
    const double mean = abbe_wave_caustic_mean(&w, at - half, at + half, 1000000);
    assert_near(mean / known, 1, 2e-3);
  }
}

TEST(what_falls_is_what_lands) {
  abbe_wave_caustic w = {.amplitude = 0.002, .wavelength = 0.1, .index = 1.333};
  for (int i = 1; i < 6; i++) {
    double through = 0;
    w.depth = 0.3 * i;
    for (int r = 0; r < 1000; r++) {
      double passed;
      abbe_wave_caustic_landing(&w, w.wavelength * r / 1000, &passed);
      through += passed / 1000;
    }
    assert_near(abbe_wave_caustic_mean(&w, -0.03, -0.03 + w.wavelength, 1000000), through, 1e-4);
  }
}

TEST(branches_come_at_the_focus) {
  abbe_wave_caustic w = low;
  const double focus = abbe_wave_caustic_focus(&w);
  w.depth = 0.8 * focus;
  for (int i = 0; i < 20; i++)
    assert_int_equal(abbe_wave_caustic_branches(&w, w.wavelength * (i + 0.5) / 20, 20000), 1);
  w.depth = 1.5 * focus;
  assert_int_equal(abbe_wave_caustic_branches(&w, 1e-5, 20000), 3);
  assert_int_equal(abbe_wave_caustic_branches(&w, 0.5 * w.wavelength + 1e-5, 20000), 1);
}

/* Beer's law straight down, and more along a slanting path. */
TEST(water_takes_its_part) {
  abbe_wave_caustic w = low;
  double clear, dim;
  abbe_wave_caustic_landing(&w, 0, &clear);
  w.attenuation_per_m = 0.7;
  abbe_wave_caustic_landing(&w, 0, &dim);
  assert_near(dim / clear, exp(-0.7 * (w.depth + w.amplitude)), 1e-12);
  w.amplitude = 0.005;
  const double x = 0.25 * w.wavelength, at = abbe_wave_caustic_landing(&w, x, &dim);
  w.attenuation_per_m = 0;
  abbe_wave_caustic_landing(&w, x, &clear);
  assert_near(-log(dim / clear), 0.7 * hypot(w.depth, at - x), 1e-12);
}
