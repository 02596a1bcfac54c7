#include "tests/check.h"

#include "spectral/optics.h"
#include "validation/trace/transport/interface.h"

/* Single precision against the double oracle over all angles and ratios from 1/4 to 4. */
TEST(matches_the_oracle) {
  double worst = 0, worst_cos = 0;
  for (int i = 0; i <= 400; i++)
    for (int j = 0; j <= 400; j++) {
      float cos_i = (float)i / 400, eta = (float)exp2((j - 200) / 100.0), cos_t;
      float share = abbe_interface_reflectance(cos_i, eta, &cos_t);
      double exact = abbe_optics_fresnel((double)cos_i, (double)eta);
      bool total;
      double exact_cos = abbe_optics_cos_refracted((double)cos_i, (double)eta, &total);
      assert_true(share >= 0 && share <= 1);
      /* towards the critical angle the cosine is the root of a small difference: a rounding of
         that, at most eta^2 of one of 1, is one of 1 / cosine in the cosine and the reflectance */
      double scale = exact_cos / fmax(1, (double)(eta * eta));
      worst = fmax(worst, fabs((double)share - exact) * scale);
      worst_cos = fmax(worst_cos, fabs((double)cos_t - exact_cos) * scale);
    }
  assert_true(worst < 1e-6);
  assert_true(worst_cos < 1e-6);
}

TEST(nothing_happens_between_equal_media) {
  float cos_t;
  for (float c = 0; c <= 1; c += 0.125f) {
    assert_true(abbe_interface_reflectance(c, 1, &cos_t) == 0);
    assert_true(cos_t == c);
  }
}

TEST(all_is_reflected_beyond_the_critical_angle) {
  float cos_t;
  assert_true(abbe_interface_reflectance(0.5f, 1.5f, &cos_t) == 1);
  assert_true(cos_t == 0);
  assert_true(abbe_interface_reflectance(0, 1.5f, &cos_t) == 1);
  assert_true(abbe_interface_reflectance(0, 0.5f, &cos_t) == 1);
}

TEST(directions_match_the_oracle) {
  for (int i = 1; i < 40; i++)
    for (int j = 0; j < 2; j++) {
      double angle = i * 0.039, eta = j ? 1.5 : 1 / 1.5;
      float n[3] = {0, 0, 1}, d[3] = {(float)sin(angle), 0, -(float)cos(angle)}, out[3], cos_t;
      double n2[3] = {0, 0, 1}, wi[3] = {-sin(angle), 0, cos(angle)}, exact[3];
      float cos_i = -d[2];
      abbe_interface_reflect(d, n, cos_i, out);
      abbe_optics_reflect(wi, n2, exact);
      for (int k = 0; k < 3; k++) assert_true(fabs((double)out[k] - exact[k]) < 3e-7);
      if (!abbe_optics_refract(wi, n2, eta, exact)) continue;
      abbe_interface_reflectance(cos_i, (float)eta, &cos_t);
      abbe_interface_refract(d, n, (float)eta, cos_i, cos_t, out);
      for (int k = 0; k < 3; k++) assert_true(fabs((double)out[k] - exact[k]) < 1e-6);
    }
}

/* On the right side nothing changes; from the wrong one a direction comes back to just beside the
 * face. */
TEST(light_stays_on_its_side) {
  static const float up[3] = {0, 0, 1};
  for (int i = 0; i <= 16; i++)
    for (int side = -1; side <= 1; side += 2) {
      const double angle = 3.1 * (i - 8) / 16; /* from the face */
      float d[3] = {(float)cos(angle), 0, (float)sin(angle)};
      const float before[3] = {d[0], d[1], d[2]};
      abbe_interface_keep_side(up, (float)side, d);
      const float along = (float)side * d[2];
      assert_true(along > 0);
      assert_near(d[0] * d[0] + d[2] * d[2], 1, 1e-6);
      if ((float)side * before[2] > 0)
        assert_memory_equal(d, before, sizeof d);
      else
        assert_near(along / sqrtf(d[0] * d[0] + 1e-12f), 1e-3f / fabsf(before[0]), 1e-4);
    }
}
