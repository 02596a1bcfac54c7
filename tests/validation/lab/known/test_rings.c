/* Rings of texels: what is put into a map round by round is found again ring by ring. */
#include "tests/check.h"

#include "base/maths.h"
#include "validation/lab/known/known_light.h"

enum { SIDE = 96, RINGS = 5, RADII = (RINGS + 1) * (ABBE_RINGS_STEPS + 1) };

/* A light 0.5 m above the origin, or a beam; both look down, a little off the centre of the map. */
static abbe_map_layout look_down(bool beam, bool warped) {
  const double origin[3] = {0, 0, 0.5}, down[3] = {0, 0, -1}, up[3] = {0.2, 1, 0};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(origin, down, up, beam, &view);
  double half = beam ? 0.1 : 0.1 / 0.7;
  for (int k = 0; k < 4; k++) view.window[k] = (k % 2 ? 1.07 : -1) * half;
  view.near = 0.01;
  view.far = 2;
  abbe_map_layout_make(&view, &layout);
  for (int k = 0; warped && k <= ABBE_MAP_LAYOUT_STEPS; k++) {
    double x = (double)k / ABBE_MAP_LAYOUT_STEPS;
    layout.knot[0][k] = x + 0.1 * sin(2 * ABBE_PI * x) / ABBE_PI;
    layout.knot[1][k] = x - 0.15 * sin(2 * ABBE_PI * x) / ABBE_PI;
  }
  OK(abbe_map_layout_check(&layout, &error));
  return layout;
}

/* A profile with a pole at a fold of 0.05 m and a smooth part: F = 1 - sqrt(1 - (r / f)^2) + 20
 * r^2. */
static double profile(double r) {
  double x = fmin(r / 0.05, 1);
  return 1 - sqrt(1 - x * x) + 20 * r * r;
}

/* The map of the profile, circle by circle. */
static void fill(const abbe_map_layout *layout, double z, float *map) {
  enum { CIRCLES = 4000, AROUND = 1500 };
  static double sum[SIDE * SIDE];
  memset(sum, 0, sizeof sum);
  for (int c = 0; c < CIRCLES; c++) {
    double from = 0.08 * c / CIRCLES, to = 0.08 * (c + 1) / CIRCLES, r = (from + to) / 2;
    double flux = (profile(to) - profile(from)) / AROUND;
    for (int k = 0; k < AROUND; k++) {
      double around = 2 * ABBE_PI * (k + 0.618 * c) / AROUND;
      const double at[3] = {r * cos(around), r * sin(around), z};
      size_t column, row;
      if (abbe_map_layout_texel(layout, SIDE, SIDE, at, &column, &row))
        sum[row * SIDE + column] += flux;
    }
  }
  for (int i = 0; i < SIDE * SIDE; i++) map[i] = (float)sum[i];
}

static void compare(bool beam, bool warped) {
  static const double edge[RINGS + 1] = {0, 0.011, 0.03, 0.0497, 0.0521, 0.07};
  static float map[SIDE * SIDE];
  const double centre[3] = {0, 0, -0.2};
  abbe_map_layout layout = look_down(beam, warped);
  MADE(abbe_rings, rings,
       abbe_rings_make(&layout, SIDE, SIDE, centre, edge, RINGS, &rings, &error));
  double radius[RADII], enclosed[RADII], expected[RINGS], sum[RINGS];
  abbe_rings_radii(&rings, radius);
  for (int i = 0; i < RADII; i++) enclosed[i] = profile(radius[i]);
  abbe_rings_expect(&rings, enclosed, 1, expected);
  fill(&layout, centre[2], map);
  abbe_rings_sum(&rings, map, 1, false, sum);
  for (int i = 0; i < RINGS; i++) assert_near(sum[i], expected[i], 1e-3 * profile(0.08));
  /* the ragged edges matter: the circles' own flux is further off somewhere */
  double worst = 0;
  for (int i = 0; i < RINGS; i++)
    worst = fmax(worst, fabs(profile(edge[i + 1]) - profile(edge[i]) - sum[i]));
  assert_true(worst > 3e-3 * profile(0.08));
}

TEST(a_profile_is_found_again) {
  compare(true, false);
  compare(false, false);
  compare(false, true);
}

TEST(squares_and_strides) {
  const double edge[2] = {0, 1}, centre[3] = {0, 0, 0};
  abbe_map_layout layout = look_down(true, false);
  float map[3 * 4] = {1, 9, 2, 9, 3, 9, 4, 9};
  double sum = 0;
  MADE(abbe_rings, rings, abbe_rings_make(&layout, 2, 2, centre, edge, 1, &rings, &error));
  abbe_rings_sum(&rings, map, 2, false, &sum);
  assert_near(sum, 10, 0);
  abbe_rings_sum(&rings, map, 2, true, &sum);
  assert_near(sum, 30, 0);
}

TEST(wrong_rings_are_refused) {
  const double falling[3] = {0, 2, 1}, centre[3] = {0, 0, 0};
  abbe_map_layout layout = look_down(true, false);
  OWNED(abbe_rings, rings) = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "ring edge 2 is 1",
          abbe_rings_make(&layout, 8, 8, centre, falling, 2, &rings, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_rings_make(&layout, 8, 8, centre, falling, 65, &rings, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_rings_make(&layout, 0, 8, centre, falling, 1, &rings, &error));
  abbe_rings_free(NULL);
}
