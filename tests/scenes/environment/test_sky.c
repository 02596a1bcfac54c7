#include "tests/check.h"

#include "base/maths.h"
#include "scenes/environment/environment_source.h"

static abbe_sky sky_of(int type, double elevation) {
  return (abbe_sky){type, {cos(elevation), 0, sin(elevation)}};
}

TEST(every_sky_is_1_at_its_zenith) {
  for (int type = 1; type <= ABBE_SKY_TYPES; type++)
    for (double e = 0.1; e < 1.6; e += 0.3) {
      const abbe_sky sky = sky_of(type, e);
      assert_near(abbe_sky_relative(&sky, (const double[3]){0, 0, 1}), 1, 1e-12);
      assert_true(abbe_sky_relative(&sky, (const double[3]){1, 0, 0}) == 0);
      assert_true(abbe_sky_relative(&sky, (const double[3]){0, 0.6, -0.8}) == 0);
      for (double a = 0; a < 6.3; a += 0.3)
        for (double z = 0.001; z < 1; z += 0.1) {
          const double s = sqrt(1 - z * z);
          assert_true(abbe_sky_relative(&sky, (const double[3]){s * cos(a), s * sin(a), z}) > 0);
        }
    }
}

TEST(known_irradiances) {
  const abbe_sky overcast = {.type = ABBE_SKY_OVERCAST}, uniform = {.type = 5};
  assert_near(abbe_sky_horizontal(&overcast), 7 * ABBE_PI / 9, 1e-5);
  assert_near(abbe_sky_horizontal(&uniform), ABBE_PI, 1e-12);
}

/* By hand from the formula: the clear sky, sun at 30 degrees, 45 degrees up, opposite to the sun
 * (105 degrees from it) and towards it (15). */
TEST(the_clear_sky) {
  const abbe_sky sky = sky_of(ABBE_SKY_CLEAR, ABBE_PI / 6);
  const double z = cos(ABBE_PI / 4);
  const double scale = (1 - exp(-0.32 / z)) / (1 - exp(-0.32)) /
                       (1 + 10 * (exp(-ABBE_PI) - exp(-1.5 * ABBE_PI)) + 0.45 * 0.25);
  const double away = 1 + 10 * (exp(-3 * 105 * ABBE_PI / 180) - exp(-1.5 * ABBE_PI)) +
                      0.45 * pow(cos(105 * ABBE_PI / 180), 2);
  const double towards = 1 + 10 * (exp(-3 * 15 * ABBE_PI / 180) - exp(-1.5 * ABBE_PI)) +
                         0.45 * pow(cos(15 * ABBE_PI / 180), 2);
  assert_near(abbe_sky_relative(&sky, (const double[3]){-z, 0, z}), scale * away, 1e-12);
  assert_near(abbe_sky_relative(&sky, (const double[3]){z, 0, z}), scale * towards, 1e-12);
}

TEST(which_need_the_sun) {
  assert_true(abbe_sky_needs_sun(ABBE_SKY_CLEAR) && abbe_sky_needs_sun(2));
  assert_true(!abbe_sky_needs_sun(1) && !abbe_sky_needs_sun(5) && !abbe_sky_needs_sun(16));
  assert_true(!abbe_sky_needs_sun(0) && !abbe_sky_needs_sun(17));
}
