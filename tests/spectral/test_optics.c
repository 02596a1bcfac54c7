#include "tests/check.h"

#include "base/maths.h"
#include "spectral/optics.h"

#include <complex.h>

static double radians(double degree) {
  return degree * ABBE_PI / 180;
}

/* ---- published numbers ---- */

TEST(glass_reflects_four_percent_head_on) {
  assert_near(abbe_optics_fresnel(1, 1 / 1.5), 0.04, 1e-15);
  assert_near(abbe_optics_fresnel(1, 1.5), 0.04, 1e-15);
  assert_near(abbe_optics_fresnel(1, 1 / 2.417), 0.17197, 2e-6); /* diamond: 17 % */
  assert_near(abbe_optics_fresnel(1, 1 / 1.333), 0.02037, 1e-5); /* water: 2 % */
}

/* Fresnel's own form: r_s = sin(i - t) / sin(i + t), r_p = tan(i - t) / tan(i + t). */
TEST(fresnel_agrees_with_the_sine_and_tangent_laws) {
  for (double n = 1.05; n < 4; n *= 1.2)
    for (double i = 1; i < 90; i += 1) {
      double a = radians(i), b = asin(sin(a) / n);
      double s = sin(a - b) / sin(a + b), p = tan(a - b) / tan(a + b);
      assert_near(abbe_optics_fresnel(cos(a), 1 / n), (s * s + p * p) / 2, 1e-12);
    }
  assert_near(abbe_optics_fresnel(cos(radians(60)), 1 / 1.5), 0.08919, 5e-6);
  assert_near(abbe_optics_fresnel(cos(radians(80)), 1 / 1.5), 0.38770, 1e-5);
}

/* At Brewster's angle, tan i = n, only the s part is reflected: ((n^2 - 1) / (n^2 + 1))^2 / 2. */
TEST(brewsters_angle_leaves_one_polarisation) {
  const double n[] = {1.0001, 1.333, 1.5, 2.417, 10};
  for (int i = 0; i < 5; i++) {
    double s = (n[i] * n[i] - 1) / (n[i] * n[i] + 1);
    assert_near(abbe_optics_fresnel(cos(atan(n[i])), 1 / n[i]) / (s * s / 2), 1, 1e-11);
  }
}

TEST(beer_and_lambert) {
  assert_near(abbe_optics_transmittance(2, 0.5), exp(-1), 1e-16);
  assert_near(abbe_optics_transmittance(log(2) / 0.01, 0.02), 0.25, 1e-15);
  assert_near(abbe_optics_transmittance(0, 5), 1, 0);
  assert_near(abbe_optics_transmittance(5, 0), 1, 0);
  assert_near(abbe_optics_transmittance(0, INFINITY), 1, 0);
  assert_near(abbe_optics_transmittance(INFINITY, 0), 1, 0);
  assert_near(abbe_optics_transmittance(INFINITY, 1e-300), 0, 0);
  assert_near(abbe_optics_transmittance(1e300, 1e300), 0, 0);
}

/* ---- laws ---- */

TEST(snell_holds_and_reverses) {
  for (double eta = 0.2; eta < 5; eta *= 1.07)
    for (double i = 0; i < 90; i += 0.37) {
      bool total = true;
      double c = cos(radians(i)), t = abbe_optics_cos_refracted(c, eta, &total);
      if (eta * sin(radians(i)) >= 1 + 1e-12) {
        assert_true(total);
        assert_near(t, 0, 0);
        assert_near(abbe_optics_fresnel(c, eta), 1, 0);
      } else if (eta * sin(radians(i)) < 1 - 1e-12) {
        assert_false(total);
        assert_near(sqrt((1 - t) * (1 + t)), eta * sin(radians(i)), 1e-8);
        /* the way back loses digits as the square root does where its slope is steep */
        assert_near(abbe_optics_cos_refracted(t, 1 / eta, NULL), c, 1e-14 / fmax(c, 1e-3));
        double there = abbe_optics_fresnel(c, eta), back = abbe_optics_fresnel(t, 1 / eta);
        assert_near(there, back, 1e-10);
      }
    }
}

/* The transmitted part, from the amplitude transmittances, makes up the whole: T by its own
 * formula, not as 1 - R. */
TEST(energy_is_conserved) {
  for (double eta = 0.25; eta < 4; eta *= 1.13)
    for (double c = 0.01; c <= 1; c += 0.01) {
      bool total = false;
      double t = abbe_optics_cos_refracted(c, eta, &total);
      if (total) continue;
      double t_s = 2 * eta * c / (eta * c + t), t_p = 2 * eta * c / (eta * t + c);
      double through = (t_s * t_s + t_p * t_p) / 2 * t / (eta * c);
      assert_near(abbe_optics_fresnel(c, eta) + through, 1, 1e-12);
    }
}

TEST(directions_lie_in_one_plane_and_are_unit) {
  const double n[3] = {0.6, 0, 0.8};
  for (double eta = 0.3; eta < 3; eta *= 1.1)
    for (double a = 0; a < 2 * ABBE_PI; a += 0.3)
      for (double i = 0.5; i < 90; i += 3) {
        double s = sin(radians(i)), c = cos(radians(i));
        double u = s * cos(a), v = s * sin(a);
        double wi[3] = {0.8 * u + 0.6 * c, v, -0.6 * u + 0.8 * c}, wt[3], wo[3];
        abbe_optics_reflect(wi, n, wo);
        assert_near(wo[0] * n[0] + wo[2] * n[2], c, 1e-14);
        assert_near(wo[1], -v, 1e-14);
        bool through = abbe_optics_refract(wi, n, eta, wt);
        assert_int_equal(through, eta * s < 1);
        if (!through) continue;
        assert_near(wt[0] * wt[0] + wt[1] * wt[1] + wt[2] * wt[2], 1, 1e-14);
        assert_near(wt[1], -eta * v, 1e-14); /* tangential part: Snell */
        assert_near(0.8 * wt[0] - 0.6 * wt[2], -eta * u, 1e-13);
        assert_true(n[0] * wt[0] + n[2] * wt[2] <= 0); /* on the other side */
      }
}

/* ---- awkward inputs ---- */

TEST(equal_indices_change_nothing) {
  const double n[3] = {0, 0, 1}, cosines[] = {0, 1e-300, 1e-8, 0.5, 1};
  for (int i = 0; i < 5; i++) {
    double c = cosines[i], wi[3] = {sqrt((1 - c) * (1 + c)), 0, c}, wt[3];
    bool total = true;
    assert_near(abbe_optics_fresnel(c, 1), 0, 0);
    assert_near(abbe_optics_cos_refracted(c, 1, &total), c, 0);
    assert_false(total);
    assert_true(abbe_optics_refract(wi, n, 1, wt));
    for (int k = 0; k < 3; k++) assert_near(wt[k], -wi[k], 1e-15);
  }
}

/* To first order in e = n - 1, r_s = e/2 (1 + tan^2 i) and r_p = e/2 (1 - tan^2 i). */
TEST(nearly_equal_indices_keep_their_digits) {
  const double e = 0x1p-42; /* 2.3e-13 */
  for (double i = 0; i < 80; i += 7) {
    double c = cos(radians(i)), tan2 = pow(tan(radians(i)), 2);
    double expected = e * e / 4 * (1 + tan2 * tan2);
    assert_near(abbe_optics_fresnel(c, 1 + e) / expected, 1, 1e-9);
    assert_near(abbe_optics_fresnel(c, 1 / (1 + e)) / expected, 1, 1e-9);
    /* cos_t - c = -e tan^2 c to first order */
    double t = abbe_optics_cos_refracted(c, 1 + e, NULL);
    assert_near(t, c - e * tan2 * c, 2e-16);
  }
}

TEST(grazing_light) {
  bool total = true;
  const double n[3] = {0, 0, 1}, wi[3] = {1, 0, 0};
  double wt[3] = {7, 7, 7};
  assert_near(abbe_optics_fresnel(0, 1 / 1.5), 1, 0);
  assert_near(abbe_optics_fresnel(0, 1.5), 1, 0);
  assert_near(abbe_optics_cos_refracted(0, 1 / 1.5, &total), sqrt(1 - 1 / 2.25), 1e-15);
  assert_false(total);
  assert_near(abbe_optics_cos_refracted(0, 1.5, &total), 0, 0);
  assert_true(total);
  assert_true(abbe_optics_refract(wi, n, 1 / 1.5, wt));
  assert_near(wt[0], -1 / 1.5, 1e-15);
  assert_near(wt[2], -sqrt(1 - 1 / 2.25), 1e-15);
  double kept[3] = {7, 7, 7};
  assert_false(abbe_optics_refract(wi, n, 1.5, kept));
  assert_near(kept[0], 7, 0);
  /* close to grazing 1 - R is linear in the cosine, with slope 2 (1 + m^2) / sqrt(m^2 - 1) */
  double m = 1.5, slope = 2 * (1 / sqrt(m * m - 1) + m * m / sqrt(m * m - 1));
  assert_near((1 - abbe_optics_fresnel(1e-6, 1 / m)) / 1e-6, slope, 1e-3);
}

TEST(the_critical_angle) {
  const double eta = 1.5, sine = 1 / eta, c = sqrt((1 - sine) * (1 + sine));
  bool total = false;
  assert_near(abbe_optics_cos_refracted(c * (1 - 1e-12), eta, &total), 0, 0);
  assert_true(total);
  double t = abbe_optics_cos_refracted(c * (1 + 1e-8), eta, &total);
  assert_false(total);
  assert_near(t, eta * c * sqrt(2e-8), 1e-9); /* the square root opens at once */
  assert_near(abbe_optics_fresnel(c * (1 - 1e-15), eta), 1, 1e-6);
  assert_near(abbe_optics_fresnel(c * (1 + 1e-15), eta), 1, 1e-6);
}

TEST(cosines_outside_and_extreme_ratios) {
  const double etas[] = {1e-200, 1e-9, 0.3, 1 - 1e-12, 1, 1 + 1e-12, 3, 1e9, 1e200};
  const double cosines[] = {-1e-12, -0.0, 0, 5e-324, 1e-160, 1e-9, 0.5, 1 - 1e-16, 1, 1 + 1e-12};
  for (size_t e = 0; e < sizeof etas / sizeof etas[0]; e++)
    for (size_t k = 0; k < sizeof cosines / sizeof cosines[0]; k++) {
      double t = abbe_optics_cos_refracted(cosines[k], etas[e], NULL);
      double r = abbe_optics_fresnel(cosines[k], etas[e]);
      assert_true(t >= 0 && t <= 1);
      assert_true(r >= 0 && r <= 1);
    }
  assert_near(abbe_optics_cos_refracted(1 + 1e-12, 1.5, NULL), 1, 0);
  assert_near(abbe_optics_fresnel(1 + 1e-12, 1.5), 0.04, 1e-15);
  assert_near(abbe_optics_fresnel(-1e-12, 1.5), 1, 0);
  assert_true(isnan(abbe_optics_cos_refracted(NAN, 1.5, NULL)));
}

/* ---- conductors ---- */

/* The amplitudes as they are printed, in complex arithmetic [BornWolf1999, 1.5.2 and 14.2]. */
static double by_amplitudes(double angle, double n, double k) {
  double complex index = CMPLX(n, k), sine = sin(angle) / index;
  double complex refracted = csqrt(1 - sine * sine);
  double complex s = (cos(angle) - index * refracted) / (cos(angle) + index * refracted);
  double complex p = (index * cos(angle) - refracted) / (index * cos(angle) + refracted);
  return (cabs(s) * cabs(s) + cabs(p) * cabs(p)) / 2;
}

static const double metals[][2] = {
    {0.05, 3.858}, {0.29, 2.863}, {1.0728, 6.7839}, {3.22, 3.30},
    {1.96, 3.80},  {0.70, 2.704}, {0.05, 1.864},    {1.5, 1e-3},
};
enum { METALS = sizeof metals / sizeof metals[0] };

/* ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2): silver 98.7, gold 88.2 and aluminium 91.5 % in yellow
 * light, of the indices of Johnson and Christy and of Rakic. */
TEST(metals_reflect_head_on) {
  for (int i = 0; i < METALS; i++) {
    double n = metals[i][0], k = metals[i][1];
    double r = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    assert_near(abbe_optics_fresnel_conductor(1, n, k), r, 1e-15);
  }
  assert_near(abbe_optics_fresnel_conductor(1, 0.05, 3.858), 0.9875, 5e-5);
  assert_near(abbe_optics_fresnel_conductor(1, 0.29, 2.863), 0.8824, 5e-5);
  assert_near(abbe_optics_fresnel_conductor(1, 1.0728, 6.7839), 0.9147, 5e-5);
}

TEST(metals_reflect_aslant) {
  for (int i = 0; i < METALS; i++)
    for (double at = 1; at < 90; at++)
      assert_near(abbe_optics_fresnel_conductor(cos(radians(at)), metals[i][0], metals[i][1]),
                  by_amplitudes(radians(at), metals[i][0], metals[i][1]), 1e-13);
  /* gold at 582 nm and 60 degrees: r_s^2 0.9418 and r_p^2 0.8121 */
  assert_near(abbe_optics_fresnel_conductor(cos(radians(60)), 0.29, 2.863), 0.8770, 5e-5);
}

TEST(metals_reflect_all_grazing_light) {
  for (int i = 0; i < METALS; i++) {
    double n = metals[i][0], k = metals[i][1];
    assert_near(abbe_optics_fresnel_conductor(0, n, k), 1, 0);
    assert_near(abbe_optics_fresnel_conductor(1e-9, n, k), 1, 1e-7);
    assert_near(abbe_optics_fresnel_conductor(-1e-12, n, k), 1, 0);
  }
}

TEST(a_conductor_without_k_is_a_dielectric) {
  const double n[] = {1e-3, 0.5, 1 - 1e-6, 1, 1 + 1e-6, 1.5, 2.417, 1e3};
  for (int i = 0; i < 8; i++)
    for (double at = 0; at <= 90; at += 1.5) {
      double c = cos(radians(at)), expected = abbe_optics_fresnel(c, 1 / n[i]);
      double scale = expected < 1e-9 && expected > 0 ? expected : 1;
      assert_near(abbe_optics_fresnel_conductor(c, n[i], 0) / scale, expected / scale, 1e-8);
    }
  assert_near(abbe_optics_fresnel_conductor(0.5, 1, 0), 0, 0);
  assert_near(abbe_optics_fresnel_conductor(0, 1, 0), 0, 0);
}

/* A perfect conductor reflects all; on the way there, 1 - R is 4 n / k^2 head on. */
TEST(a_growing_k_reflects_more) {
  for (double at = 0; at < 85; at += 5) {
    double before = 0;
    for (double k = 1; k < 1e9; k *= 10) {
      double r = abbe_optics_fresnel_conductor(cos(radians(at)), 0.2, k);
      assert_true(r >= before && r <= 1);
      before = r;
    }
    assert_near(before, 1, 1e-8);
  }
  assert_near((1 - abbe_optics_fresnel_conductor(1, 1, 1e4)) / 4e-8, 1, 1e-7);
  assert_near(abbe_optics_fresnel_conductor(1e-3, 1e3, 1e3), by_amplitudes(acos(1e-3), 1e3, 1e3),
              1e-12);
}

TEST(extreme_conductors) {
  const double values[] = {0, 5e-324, 1e-160, 1e-9, 1 - 1e-16, 1, 1 + 1e-12, 40, 1e9, 1e70};
  const double cosines[] = {-1e-12, -0.0, 0, 5e-324, 1e-160, 1e-9, 0.5, 1 - 1e-16, 1, 1 + 1e-12};
  for (int n = 0; n < 10; n++)
    for (int k = 0; k < 10; k++)
      for (int c = 0; c < 10; c++) {
        double r = abbe_optics_fresnel_conductor(cosines[c], values[n], values[k]);
        assert_true(r >= 0 && r <= 1);
      }
  assert_near(abbe_optics_fresnel_conductor(0.5, 0, 3), 1, 1e-15); /* no loss without n */
  assert_near(abbe_optics_fresnel_conductor(0.5, 0, 0), 1, 0);
  assert_true(isnan(abbe_optics_fresnel_conductor(NAN, 0.2, 3)));
}
