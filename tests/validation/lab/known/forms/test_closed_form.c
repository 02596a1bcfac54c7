/* The closed forms against numbers that others printed, and against each other's limits. */
#include "tests/check.h"

#include "base/maths.h"
#include "spectral/formats/material_import.h"
#include "spectral/optics.h"
#include "validation/lab/known/forms/closed_form.h"

static double degrees(double radians) {
  return radians * 180 / ABBE_PI;
}
static double radians(double degree) {
  return degree * ABBE_PI / 180;
}

TEST(glass_reflects_as_the_books_say) {
  assert_near(abbe_closed_form_fresnel(0, 1.5), 0.04, 1e-15);
  assert_near(abbe_closed_form_fresnel(radians(60), 1.5), 0.08919, 5e-6);
  assert_near(abbe_closed_form_fresnel(radians(80), 1.5), 0.38770, 1e-5);
  assert_near(abbe_closed_form_fresnel(ABBE_PI / 2, 1.5), 1, 1e-12);
  assert_near(abbe_closed_form_fresnel(radians(41.82), 1 / 1.5), 1, 0);
  assert_true(abbe_closed_form_fresnel(radians(41.80), 1 / 1.5) < 1);
  assert_near(abbe_closed_form_fresnel(1e-5, 1.5), 0.04, 1e-9);
  assert_near(abbe_closed_form_fresnel(0.99e-6, 1.5), abbe_closed_form_fresnel(1.01e-6, 1.5), 1e-9);
}

/* Two derivations, two files. */
TEST(fresnel_agrees_with_the_optics) {
  for (double n = 0.4; n < 4; n *= 1.17)
    for (double i = 1; i < 90; i += 1.3)
      assert_near(abbe_closed_form_fresnel(radians(i), n),
                  abbe_optics_fresnel(cos(radians(i)), 1 / n), 1e-11);
}

/* Complex amplitudes here, real formulas there. */
TEST(metals_agree_with_the_optics) {
  for (double n = 0.05; n < 4; n *= 1.6)
    for (double k = 0.01; k < 9; k *= 2)
      for (double i = 0; i < 89; i += 7)
        assert_near(abbe_closed_form_conductor(radians(i), n, k),
                    abbe_optics_fresnel_conductor(cos(radians(i)), n, k), 1e-11);
  assert_near(abbe_closed_form_conductor(0, 0.2, 3), (0.64 + 9) / (1.44 + 9), 1e-14);
  assert_near(abbe_closed_form_conductor(radians(60), 1.5, 0),
              abbe_closed_form_fresnel(radians(60), 1.5), 1e-14);
}

/* The corner formula for a parallel rectangle, and what a cube's faces show of one another. */
TEST(polygons_have_their_form_factors) {
  static const double p[3] = {0, 0, 0}, up[3] = {0, 0, 1}, aside[3] = {1, 0, 0};
  const double a = 0.7, b = 1.3; /* in heights */
  const double corner[4][3] = {{0, 0, 1}, {a, 0, 1}, {a, b, 1}, {0, b, 1}};
  const double known = (a / sqrt(1 + a * a) * atan(b / sqrt(1 + a * a)) +
                        b / sqrt(1 + b * b) * atan(a / sqrt(1 + b * b))) /
                       (2 * ABBE_PI);
  assert_near(abbe_closed_form_polygon(corner, 4, p, up), known, 1e-14);
  const double upright = (atan(b) - atan(b / sqrt(1 + a * a)) / sqrt(1 + a * a)) / (2 * ABBE_PI);
  assert_near(abbe_closed_form_polygon(corner, 4, p, aside), upright, 1e-14);
  const double square[4][3] = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  assert_near(abbe_closed_form_polygon(square, 4, p, up), 0.5541264239795719, 1e-13);
}

TEST(disks_have_their_form_factors) {
  enum { SIDES = 4096 };
  static double corner[SIDES][3];
  static const double p[3] = {0, 0, 0}, up[3] = {0, 0, 1};
  for (int i = 0; i < SIDES; i++) {
    corner[i][0] = 0.6 * cos(2 * ABBE_PI * i / SIDES);
    corner[i][1] = 0.6 * sin(2 * ABBE_PI * i / SIDES);
    corner[i][2] = 0.8;
  }
  assert_near(abbe_closed_form_coaxial_disks(0, 0.6, 0.8), 0.36, 1e-15);
  assert_near(abbe_closed_form_polygon((const double(*)[3])corner, SIDES, p, up), 0.36, 1e-6);
  assert_near(abbe_closed_form_coaxial_disks(1e-4, 0.6, 0.8), 0.36, 1e-7);
  assert_near(abbe_closed_form_coaxial_disks(1, 1, 1), (3 - sqrt(5)) / 2, 1e-15);
  /* what goes one way goes the other */
  assert_near(abbe_closed_form_coaxial_disks(1, 0.3, 0.5),
              0.09 * abbe_closed_form_coaxial_disks(0.3, 1, 0.5), 1e-14);
}

TEST(a_penumbra_grows_to_its_light) {
  enum { STEPS = 200000 };
  assert_near(abbe_closed_form_penumbra(0), 0.5, 1e-15);
  assert_near(abbe_closed_form_penumbra(-1), 0, 1e-15);
  assert_near(abbe_closed_form_penumbra(7), 1, 0);
  assert_near(abbe_closed_form_penumbra(0.3) + abbe_closed_form_penumbra(-0.3), 1, 1e-15);
  double area = 0; /* of the disk at x > -0.4 */
  for (int i = 0; i < STEPS; i++) {
    const double x = -0.4 + 1.4 * (i + 0.5) / STEPS;
    area += 2 * sqrt(1 - x * x) * 1.4 / STEPS;
  }
  assert_near(abbe_closed_form_penumbra(0.4), area / ABBE_PI, 1e-7);
}

/* A window pane: 7.7 % back and 92.3 % through, 2 n / (n^2 + 1) of it. */
TEST(a_pane_of_glass) {
  double reflected = 0, passed = 0;
  abbe_closed_form_slab(0.04, 1, &reflected, &passed);
  assert_near(passed, 2 * 1.5 / (1.5 * 1.5 + 1), 1e-15);
  assert_near(reflected + passed, 1, 1e-15);
  abbe_closed_form_slab(0.3, 0.6, &reflected, &passed);
  double sum_r = 0.3, sum_t = 0, inside = 0.7; /* bounce by bounce */
  for (int k = 0; k < 60; k++) {
    inside *= 0.6;
    (k % 2 ? (sum_r += 0.7 * inside) : (sum_t += 0.7 * inside));
    inside *= 0.3;
  }
  assert_near(reflected, sum_r, 1e-14);
  assert_near(passed, sum_t, 1e-14);
  abbe_closed_form_slab(1, 1, &reflected, &passed);
  assert_near(reflected, 1, 0);
  assert_near(passed, 0, 0);
}

/* A small angle moves the ray by t i (n - 1) / n; a grazing one by the whole thickness. */
TEST(a_slab_moves_a_ray) {
  assert_near(abbe_closed_form_slab_shift(0.01, 1e-4, 1.5) / (0.01 * 1e-4 / 3), 1, 1e-7);
  assert_near(abbe_closed_form_slab_shift(0.01, ABBE_PI / 2, 1.5), 0.01, 1e-15);
  assert_near(abbe_closed_form_slab_shift(0.01, radians(45), 1.5), 0.0032914, 5e-8);
  assert_near(abbe_closed_form_slab_shift(0.01, radians(45), 1), 0, 1e-17);
}

/* Ball lenses as sold: N-BK7 of 10 mm has its focus 7.34 mm from its centre at 588 nm; n = 2 has
 * it on its own back. */
TEST(a_ball_focuses) {
  assert_near(abbe_closed_form_ball_focus(5, 1.5168), 7.3375, 1e-3);
  assert_near(abbe_closed_form_ball_focus(1, 2), 1, 0);
  assert_near(abbe_closed_form_ball_crossing(1, 1.5, 1e-5), 1.5, 1e-9);
  double h = 0.1, t = asin(h / 1.5), turn = 2 * (asin(h) - t);
  /* the line through (h, at its exit) and the axis, by coordinates */
  double exit_at = asin(h) - 2 * t; /* below the axis's far end, as an angle at the centre */
  double x = cos(exit_at), y = -sin(exit_at);
  assert_near(abbe_closed_form_ball_crossing(1, 1.5, h), x + y / tan(turn), 1e-12);
}

/* A core of the shell's own glass is no core; a ball of air with a core is that core; a thin film
 * of glass around water hardly turns a ray. A bubble at least reflects what grazes it. */
TEST(shells_turn_a_ray) {
  double plain = 2 * (asin(0.4) - asin(0.4 / 1.5));
  assert_near(abbe_closed_form_shell_turn(1, 1.5, 0.7, 1.5, 0.4), plain, 1e-15);
  assert_near(abbe_closed_form_shell_turn(1, 1.5, 0.2, 1.0, 0.4), plain, 1e-15);
  assert_near(abbe_closed_form_shell_turn(5, 1, 1, 1.5, 0.4), plain, 1e-15);
  double drop = 2 * (asin(0.4) - asin(0.4 / 1.333));
  assert_near(abbe_closed_form_shell_turn(1 + 1e-9, 1.5, 1, 1.333, 0.4), drop, 1e-8);
  /* paraxial: powers of the shell's and the core's surfaces add, 2 (n - 1) / n and so on */
  double h = 1e-6, power = 2 * (1 - 1 / 1.5) + 2 * (1 / 1.5 - 1) / 0.5;
  assert_near(abbe_closed_form_shell_turn(1, 1.5, 0.5, 1, h) / h, power, 1e-9);
  double graze = 2 * (asin(0.5) - asin(0.5 / 1.5)) - (ABBE_PI - 2 * asin(0.5 / (0.5 * 1.5)));
  assert_near(abbe_closed_form_shell_turn(1, 1.5, 0.5, 1, 0.5), graze, 1e-15);
}

/* Descartes 1637 for n = 4/3: 137.97 and 230.97 degrees, at incidences of 59.39 and 71.83. */
TEST(the_rainbows_of_descartes) {
  double deviation = 0, incidence = 0;
  assert_true(abbe_closed_form_rainbow(4.0 / 3, 1, &deviation, &incidence));
  assert_near(degrees(deviation), 137.97, 5e-3);
  assert_near(degrees(incidence), 59.39, 5e-3);
  assert_true(abbe_closed_form_rainbow(4.0 / 3, 2, &deviation, &incidence));
  assert_near(degrees(deviation), 230.97, 0.03);
  assert_near(degrees(incidence), 71.83, 5e-3);
  /* the primary bow's red edge stands at 42.4, its violet at 40.6 degrees from the antisolar point
   */
  const abbe_material *water = NULL;
  double n = 0;
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  OK(abbe_material_table_find(&table, "water", &water, &error));
  OK(abbe_material_n(water, 700, &n, &error));
  assert_true(abbe_closed_form_rainbow(n, 1, &deviation, &incidence));
  assert_near(180 - degrees(deviation), 42.4, 0.1);
  OK(abbe_material_n(water, 400, &n, &error));
  assert_true(abbe_closed_form_rainbow(n, 1, &deviation, &incidence));
  assert_near(180 - degrees(deviation), 40.6, 0.1);
  assert_false(abbe_closed_form_rainbow(2, 1, &deviation, &incidence));
  assert_false(abbe_closed_form_rainbow(1, 1, &deviation, &incidence));
  assert_false(abbe_closed_form_rainbow(NAN, 1, &deviation, &incidence));
  assert_false(abbe_closed_form_rainbow(1.3, 0, &deviation, &incidence));
}

TEST(a_prism_deviates_least_symmetrically) {
  double least = 0;
  assert_true(abbe_closed_form_prism_least(radians(60), 1.5, &least));
  assert_near(degrees(least), 37.1808, 5e-5);
  assert_false(abbe_closed_form_prism_least(radians(60), 2.417, &least)); /* diamond */
  abbe_prism_ray ray = {0};
  double i = (least + radians(60)) / 2;
  assert_true(abbe_closed_form_prism_ray(radians(60), 1.5, i, 0.02, &ray));
  assert_near(ray.deviation, least, 1e-15);
  assert_near(ray.from[1], ray.exit[1], 1e-17);
  assert_near(ray.came[1], -ray.direction[1], 1e-15);
  for (double off = -0.1; off < 0.11; off += 0.02) {
    assert_true(abbe_closed_form_prism_ray(radians(60), 1.5, i + off, 0.02, &ray));
    assert_true(ray.deviation >= least - 1e-15);
    /* the crossing inside obeys Snell at both faces */
    double d[2] = {ray.exit[0] - ray.from[0], ray.exit[1] - ray.from[1]}, l = hypot(d[0], d[1]);
    double h = radians(30), u1[2] = {-sin(h), -cos(h)}, u2[2] = {sin(h), -cos(h)};
    assert_near(1.5 * (d[0] * u1[0] + d[1] * u1[1]) / l, ray.came[0] * u1[0] + ray.came[1] * u1[1],
                1e-14);
    assert_near(1.5 * (d[0] * u2[0] + d[1] * u2[1]) / l,
                ray.direction[0] * u2[0] + ray.direction[1] * u2[1], 1e-14);
    double turn = atan2(ray.came[1], ray.came[0]) - atan2(ray.direction[1], ray.direction[0]);
    assert_near(turn, ray.deviation, 1e-14);
  }
  assert_false(abbe_closed_form_prism_ray(radians(60), 2.417, i, 0.02, &ray));
  assert_false(abbe_closed_form_prism_ray(radians(60), 1.5, 0.1, 0.02, &ray)); /* total */
  assert_false(abbe_closed_form_prism_ray(radians(60), 1.5, i, 0, &ray));
}

/* A ring's caustics: cusps where the books have them, how light grows at a fold, no light lost. */

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

/* Light under a sinusoidal surface against what is known of it in closed form. */

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
