/* A ring's caustics: cusps where the books have them, how light grows at a fold, no light lost. */
#include "tests/check.h"

#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"

static double sun_on_axis(double x, size_t *branches) {
  const abbe_catacaustic c = {.radius = 1, .height = 1, .elevation = ABBE_PI / 4};
  return abbe_catacaustic_irradiance(&c, (const double[2]){x, 0}, 1, branches);
}

/* The nephroid's cusp stands at half the radius: one ray before it, three behind. There light is
 * as 1 / distance, and twice as much inside. */
TEST(the_suns_cusp) {
  size_t outside, inside;
  const double sine = sin(ABBE_PI / 4), before = sun_on_axis(0.499, &outside);
  const double behind = sun_on_axis(0.501, &inside);
  assert_int_equal(outside, 1);
  assert_int_equal(inside, 3);
  assert_near(before, sine / (2 * 0.001), 1e-3 * before); /* 1 / |1 - 2 q / R| */
  assert_near(behind / before, 2, 0.01);
  assert_near(sun_on_axis(0.2, &outside), sine / fabs(1 - 2 * 0.8), 1e-6);
  /* the wall's own height: a ray of 45 degrees cannot come from above it */
  assert_near(sun_on_axis(-0.1, &outside), 0, 0);
}

/* Off the axis the fold is the nephroid (R / 4) (3 cos - cos 3, 3 sin - sin 3): two rays fewer
 * beyond it, and light as 1 / root of the distance. */
TEST(the_suns_fold) {
  const abbe_catacaustic c = {.radius = 1, .height = 1, .elevation = ABBE_PI / 4};
  const double t = 0.5;
  const double fold[2] = {0.25 * (3 * cos(t) - cos(3 * t)), 0.25 * (3 * sin(t) - sin(3 * t))};
  double out[2] = {cos(t) - cos(3 * t), sin(t) - sin(3 * t)}; /* across the tangent */
  const double length = hypot(out[0], out[1]);
  double light[3];
  size_t count[3];
  static const double steps[] = {1e-4, 4e-4, -1e-4};
  for (int k = 0; k < 3; k++) {
    const double p[2] = {fold[0] + steps[k] * out[0] / length,
                         fold[1] + steps[k] * out[1] / length};
    light[k] = abbe_catacaustic_irradiance(&c, p, 1, &count[k]);
  }
  const int in = count[0] > count[2] ? 0 : 2;
  assert_int_equal(count[0] > count[2] ? count[0] - count[2] : count[2] - count[0], 2);
  if (in == 0) assert_near(light[0] / light[1], 2, 0.1);
  const double p[2] = {fold[0] - 4e-4 * out[0] / length, fold[1] - 4e-4 * out[1] / length};
  if (in == 2) assert_near(light[2] / abbe_catacaustic_irradiance(&c, p, 1, NULL), 2, 0.1);
}

/* Of a lamp s off the middle the cusp lies s R / (R + 2 s) beyond it: a third of the radius, the
 * cardioid's, as the lamp comes to the wall. */
TEST(a_lamps_cusp) {
  static const double at[] = {0.97, 0.6};
  for (int i = 0; i < 2; i++) {
    const abbe_catacaustic c = {.radius = 1, .height = 9, .lamp = {at[i], 0, 4}};
    const double cusp = -at[i] / (1 + 2 * at[i]);
    size_t far_side, near_side;
    const double right =
        abbe_catacaustic_irradiance(&c, (const double[2]){cusp + 1e-5, 0}, 1, &near_side);
    const double left =
        abbe_catacaustic_irradiance(&c, (const double[2]){cusp - 1e-5, 0}, 1, &far_side);
    const double near_fold =
        abbe_catacaustic_irradiance(&c, (const double[2]){cusp - 1e-6, 0}, 1, NULL);
    assert_int_equal(far_side > near_side ? far_side - near_side : near_side - far_side, 2);
    assert_near(fmax(left, right) / fmin(left, right), 2, 0.06);
    assert_near(near_fold / left, 10, 0.3);
  }
}

/* All that the sun sends into the ring comes to the floor, by some number of reflections. */
TEST(no_light_is_lost) {
  enum { SIDE = SANITIZED ? 24 : 60 };
  const abbe_catacaustic c = {.radius = 1, .height = 1.5, .elevation = ABBE_PI / 4};
  double sum = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double p[2] = {(2 * (i % SIDE) + 1.0) / SIDE - 1, (2 * (i / SIDE) + 1.0) / SIDE - 1};
    if (hypot(p[0], p[1]) >= 1) continue;
    /* straight, past the near wall */
    const double back = p[0] + sqrt(1 - p[1] * p[1]);
    if (back > 1.5) sum += sin(ABBE_PI / 4);
    for (size_t b = 1; b < 12; b++) sum += abbe_catacaustic_irradiance(&c, p, b, NULL);
  }
  sum *= 4.0 / (SIDE * SIDE);
  assert_near(sum / (ABBE_PI * sin(ABBE_PI / 4)), 1, 0.03);
}

TEST(means_are_means) {
  const abbe_catacaustic c = {.radius = 1, .height = 1, .elevation = ABBE_PI / 4};
  size_t branches, one;
  const double p[2] = {0.2, 0};
  const double light = abbe_catacaustic_irradiance(&c, p, 1, &one);
  assert_near(abbe_catacaustic_mean(&c, p, 1e-4, 2, 0.5, 1, &branches), 0.5 * light, 1e-3 * light);
  assert_int_equal(branches, one);
}
