/* Estimators of where rays land: the rates and orders of convergence that they must have, on
 * surfaces whose lookup is a formula; what they do where nothing is seen. */
#include "tests/check.h"

#include "tests/scenes/view/estimator_run.h"

#include <float.h>

/* A plane n . x = c, or a sphere seen from within; a light. */
typedef struct world {
  abbe_view view;
  bool round;
  double n[3], c;
  double centre[3], radius;
  size_t asked;
  size_t blind_from; /* lookups from this one on see nothing; 0: all see */
} world;

static double to_surface(const world *w, const double o[3], const double d[3]) {
  double from[3];
  if (!w->round) return (w->c - abbe_vector_dot(w->n, o)) / abbe_vector_dot(w->n, d);
  abbe_vector_subtract(o, w->centre, from);
  const double b = abbe_vector_dot(from, d);
  return -b + sqrt(b * b - abbe_vector_dot(from, from) + w->radius * w->radius);
}

static void light_along(const world *w, const double at[3], double o[3], double d[3]) {
  for (int k = 0; k < 3; k++) {
    o[k] = w->view.orthographic ? at[k] : w->view.origin[k];
    d[k] = w->view.orthographic ? w->view.forward[k] : at[k] - o[k];
  }
  abbe_vector_normalise(d);
}

static bool look(void *user, const double at[3], double seen[3]) {
  world *w = user;
  double o[3], d[3];
  w->asked++;
  if (w->blind_from > 0 && w->asked >= w->blind_from) return false;
  light_along(w, at, o, d);
  const double t = to_surface(w, o, d);
  for (int k = 0; k < 3; k++) seen[k] = o[k] + t * d[k];
  return isfinite(t) && (t > 0 || w->view.orthographic);
}

static void normal_at(const world *w, const double p[3], double n[3]) {
  for (int k = 0; k < 3; k++) n[k] = w->round ? w->centre[k] - p[k] : w->n[k];
  abbe_vector_normalise(n);
}

typedef struct ray {
  double o[3], d[3], t; /* t: where it meets the surface */
} ray;

static ray make_ray(const world *w, double ox, double oy, double oz, double dx, double dy,
                    double dz) {
  ray r = {{ox, oy, oz}, {dx, dy, dz}, 0};
  abbe_vector_normalise(r.d);
  r.t = to_surface(w, r.o, r.d);
  return r;
}

static abbe_estimate run(world *w, const ray *r, abbe_estimator kind, size_t iterations) {
  const abbe_estimator_desc desc = FIELDS(.kind = kind, .iterations = iterations,
                                          .step = kind == ABBE_ESTIMATOR_NEWTON ? 1e-7 : 0,
                                          .range = kind == ABBE_ESTIMATOR_MARCH ? 2.0 : 0,
                                          .view = &w->view, .lookup = look, .user = w);
  return abbe_estimator_run(&desc, r->o, r->d);
}

static double error_after(world *w, const ray *r, abbe_estimator kind, size_t iterations) {
  return fabs(run(w, r, kind, iterations).distance - r->t);
}

static world make_world(bool parallel, bool round) {
  static const double lamp[3] = {0.2, -0.1, 0.7}, down[3] = {-0.1, 0.15, -1}, up[3] = {0, 1, 0};
  world w = {.round = round, .n = {0.2, -0.1, 1}, .c = -0.5, .centre = {0, 0, 0.1}, .radius = 1.1};
  abbe_view_look(lamp, down, up, parallel, &w.view);
  w.view.near = 0.01;
  w.view.far = 3;
  abbe_vector_normalise(w.n);
  return w;
}

static const double directions[][3] = {
    {0.3, 0.1, -1}, {-0.4, 0.2, -1}, {0.1, -0.6, -0.8}, {0.7, 0.1, -0.9}, {-0.2, -0.3, -0.5}};
enum { DIRECTIONS = sizeof directions / sizeof *directions };

static ray ray_of(const world *w, int i) {
  return make_ray(w, 0.05, 0.02, 0.25, directions[i][0], directions[i][1], directions[i][2]);
}

/* The errors of successive iterations fall (or grow) by the rate of the law, on planes and spheres,
 * for point and directional lights. */
TEST(the_fixed_points_have_their_rates) {
  int measured = 0;
  for (int k = 0; k < 8 * DIRECTIONS; k++) {
    world w = make_world(k & 1, k & 2);
    const bool axis = k & 4;
    const ray r = ray_of(&w, k / 8);
    const abbe_estimator kind = axis ? ABBE_ESTIMATOR_AXIS : ABBE_ESTIMATOR_SHAH;
    double hit[3], from[3], s[3], n[3];
    for (int c = 0; c < 3; c++) hit[c] = r.o[c] + r.t * r.d[c];
    light_along(&w, hit, from, s);
    normal_at(&w, hit, n);
    const double law = abbe_estimator_rate(axis, r.d, s, n, w.view.forward);
    for (size_t i = 1; i < 60; i++) {
      const double e = run(&w, &r, kind, i).distance - r.t;
      const double next = run(&w, &r, kind, i + 1).distance - r.t;
      if (fabs(law) < 1e-3 || fabs(law) > 0.95 || fabs(e) > 1e-5 || fabs(next) < 1e-11) continue;
      assert_near(next / e, law, 1e-3);
      measured++;
      break;
    }
  }
  assert_true(measured >= 30);
}

/* Beyond 1 in size it leaves the place, however near it begins. */
TEST(a_rate_above_one_diverges) {
  world w = make_world(true, false);
  for (int k = 0; k < 3; k++) w.n[k] = k == 0;
  w.c = 0.3; /* a wall, nearly along the light */
  const ray r = make_ray(&w, 0.0, 0.0, 0.0, -1.0, 0.0, -0.5);
  double s[3] = {w.view.forward[0], w.view.forward[1], w.view.forward[2]};
  const double law = abbe_estimator_rate(false, r.d, s, w.n, w.view.forward);
  assert_true(fabs(law) > 1);
  const double first = error_after(&w, &r, ABBE_ESTIMATOR_SHAH, 2);
  assert_true(error_after(&w, &r, ABBE_ESTIMATOR_SHAH, 12) > first);
}

/* Of the thesis's steps: at once where the plane lies across the light's axis. */
TEST(axis_is_exact_on_planes_across) {
  for (int k = 0; k < 2 * DIRECTIONS; k++) {
    world w = make_world(k & 1, false);
    for (int c = 0; c < 3; c++) w.n[c] = w.view.forward[c];
    w.c = 0.9;
    const ray r = ray_of(&w, k / 2);
    assert_true(error_after(&w, &r, ABBE_ESTIMATOR_AXIS, 1) < 1e-14);
    assert_true(error_after(&w, &r, ABBE_ESTIMATOR_SHAH, 1) > 1e-6);
  }
}

/* The signed ratio is linear along the ray on any plane. */
TEST(ratio_is_exact_on_planes) {
  for (int k = 0; k < 2 * DIRECTIONS; k++) {
    world w = make_world(k & 1, false);
    const ray r = ray_of(&w, k / 2);
    const abbe_estimate e = run(&w, &r, ABBE_ESTIMATOR_RATIO, 1);
    assert_true(e.found);
    assert_near(e.distance, r.t, 1e-13);
    for (int c = 0; c < 3; c++) assert_near(e.at[c], r.o[c] + r.t * r.d[c], 1e-13);
    /* the signed distance is not, from a point */
    if (!w.view.orthographic) assert_true(error_after(&w, &r, ABBE_ESTIMATOR_SECANT, 1) > 1e-9);
  }
}

/* log(e_(k+1) / e_k) / log(e_k / e_(k-1)), over the last three errors that rounding leaves; 0:
 * there are not so many, or the place is not found. */
static double order_of(world *w, const ray *r, abbe_estimator kind, size_t least) {
  double e[4] = {0};
  size_t used = 0, all = 0;
  if (!run(w, r, kind, 20).found) return 0;
  for (size_t i = 1; i <= 40; i++) {
    const double next = error_after(w, r, kind, i);
    if (next < 3e-14) break;
    all++;
    if (used == 3) memmove(e, e + 1, 2 * sizeof *e);
    e[used < 3 ? used++ : 2] = next;
  }
  if (all < least) return 0;
  return log(e[2] / e[1]) / log(e[1] / e[0]);
}

/* Orders on a sphere: newton 2, secant 1.618, false position and the fixed points 1. */
TEST(orders_of_convergence) {
  const struct {
    abbe_estimator kind;
    double order, within;
    size_t least; /* errors, from which on it is measured */
  } laws[] = {{ABBE_ESTIMATOR_NEWTON, 2, 0.15, 3},
              {ABBE_ESTIMATOR_SECANT, 1.618, 0.15, 3},
              {ABBE_ESTIMATOR_FALSE_POSITION, 1, 0.05, 5},
              {ABBE_ESTIMATOR_SHAH, 1, 0.05, 5}};
  for (size_t k = 0; k < sizeof laws / sizeof *laws; k++) {
    double sum = 0;
    int count = 0;
    for (int i = 0; i < 2 * DIRECTIONS; i++) {
      world w = make_world(i & 1, true);
      const ray r = ray_of(&w, i / 2);
      const double order = order_of(&w, &r, laws[k].kind, laws[k].least);
      sum += order;
      count += order > 0;
    }
    assert_true(count >= 3);
    print_message("%s: order %.3f\n", abbe_estimator_name(laws[k].kind), sum / count);
    assert_near(sum / count, laws[k].order, laws[k].within);
  }
}

/* Illinois's error goes with its third power every three lookups; Pegasus it is not. */
TEST(illinois_cubes_in_three) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 2 * DIRECTIONS; i++) {
    world w = make_world(i & 1, true);
    const ray r = ray_of(&w, i / 2);
    for (size_t k = 1; k < 8; k++) {
      const double e = error_after(&w, &r, ABBE_ESTIMATOR_ILLINOIS, k);
      const double later = error_after(&w, &r, ABBE_ESTIMATOR_ILLINOIS, k + 3);
      if (e > 1e-2 || later < 1e-14) continue;
      sum += log(later) / log(e);
      count++;
    }
  }
  assert_true(count >= 5);
  print_message("illinois: order %.3f a lookup\n", cbrt(sum / count));
  assert_near(cbrt(sum / count), 1.442, 0.12);
}

TEST(bisection_halves_and_march_steps) {
  for (int i = 0; i < 4 * DIRECTIONS; i++) {
    world w = make_world(i & 1, i & 2);
    const ray r = ray_of(&w, i / 4);
    /* the bracket is no longer than its end, which is less than twice too far */
    for (size_t k = 1; k < 30; k++)
      assert_true(error_after(&w, &r, ABBE_ESTIMATOR_BISECTION, k) <= 4 * ldexp(1, -(int)k));
    for (size_t k = 8; k <= 64; k *= 2)
      assert_true(error_after(&w, &r, ABBE_ESTIMATOR_MARCH, k) <= 1.0 / (double)k + 1e-12);
  }
}

/* As printed, the difference reaches over the kink of the distance, and steps bounce. */
TEST(newton_as_printed_stays_off) {
  double worst = 0;
  for (int i = 0; i < DIRECTIONS; i++) {
    world w = make_world(false, true);
    const ray r = ray_of(&w, i);
    const abbe_estimator_desc desc =
        FIELDS(.kind = ABBE_ESTIMATOR_NEWTON, .iterations = 5, .printed = true, .view = &w.view,
               .lookup = look, .user = &w);
    worst = fmax(worst, fabs(abbe_estimator_run(&desc, r.o, r.d).distance - r.t));
    assert_true(error_after(&w, &r, ABBE_ESTIMATOR_NEWTON, 5) < 1e-9);
  }
  assert_true(worst > 1e-3);
}

/* All come to the same place, with the lookups that they are said to take; the three that keep no
 * bracket may get lost on their way. */
TEST(all_land_where_the_ray_does) {
  const size_t lookups[ABBE_ESTIMATOR_COUNT] = {
      /* one at the origin, as they begin, and one to end */
      [ABBE_ESTIMATOR_SHAH] = 2 + 1,
      [ABBE_ESTIMATOR_AXIS] = 2 + 1,
      [ABBE_ESTIMATOR_NEWTON] = 2};
  int lost = 0;
  for (int kind = ABBE_ESTIMATOR_SHAH; kind < ABBE_ESTIMATOR_EXACT; kind++)
    for (int i = 0; i < 4 * DIRECTIONS; i++) {
      world w = make_world(i & 1, i & 2);
      const ray r = ray_of(&w, i / 4);
      const abbe_estimate e = run(&w, &r, (abbe_estimator)kind, 40);
      const double allowed = kind == ABBE_ESTIMATOR_MARCH ? 0.026 : 1e-6;
      if (kind <= ABBE_ESTIMATOR_NEWTON && !e.found) {
        lost++;
        continue;
      }
      assert_true(e.found);
      assert_near(e.distance, r.t, allowed);
      for (int c = 0; c < 3; c++) assert_near(e.at[c], r.o[c] + r.t * r.d[c], 2 * allowed);
      if (lookups[kind] > 0)
        assert_int_equal(run(&w, &r, (abbe_estimator)kind, 1).lookups, lookups[kind]);
    }
  assert_true(lost <= 4); /* of 60 */
}

/* As printed: one iteration is two lookups, at 1 m and at the distance found there. */
TEST(shah_as_printed) {
  world w = make_world(false, false);
  const ray r = ray_of(&w, 0);
  const abbe_estimator_desc desc =
      FIELDS(.kind = ABBE_ESTIMATOR_SHAH, .iterations = 1, .printed = true, .view = &w.view,
             .lookup = look, .user = &w);
  const abbe_estimate e = abbe_estimator_run(&desc, r.o, r.d);
  double at[3], seen[3], between[3], last[3];
  for (int c = 0; c < 3; c++) at[c] = r.o[c] + 1.0 * r.d[c];
  assert_true(look(&w, at, seen));
  abbe_vector_subtract(seen, r.o, between);
  const double d = abbe_vector_length(between);
  for (int c = 0; c < 3; c++) at[c] = r.o[c] + d * r.d[c];
  assert_true(look(&w, at, last));
  assert_int_equal(e.lookups, 2);
  assert_near(e.distance, d, 1e-15);
  for (int c = 0; c < 3; c++) assert_near(e.at[c], last[c], 1e-15);
}

/* Where nothing is seen, at once or after a while, nothing is found and nothing is broken. */
TEST(blind_lookups) {
  for (int kind = ABBE_ESTIMATOR_SHAH; kind < ABBE_ESTIMATOR_EXACT; kind++)
    for (size_t from = 1; from < 6; from++) {
      world w = make_world(false, true);
      const ray r = ray_of(&w, 1);
      w.blind_from = from;
      const abbe_estimate e = run(&w, &r, (abbe_estimator)kind, 16);
      if (from == 1) assert_false(e.found);
      assert_true(e.lookups <= 64);
      if (e.found) assert_true(isfinite(e.distance));
    }
}

/* Rays that go away from all receivers are not said to land in front of the light. */
TEST(rays_that_meet_nothing) {
  for (int i = 0; i < 2; i++) {
    world w = make_world(i & 1, false);
    const ray r = make_ray(&w, 0.05, 0.02, 0.25, 0.1, 0.2, 1);
    for (int kind = ABBE_ESTIMATOR_FALSE_POSITION; kind <= ABBE_ESTIMATOR_MARCH; kind++)
      assert_false(run(&w, &r, (abbe_estimator)kind, 8).found);
    assert_false(run(&w, &r, ABBE_ESTIMATOR_RATIO, 8).found);
  }
}

/* What stands on a receiver sends its light from there: a hair in front of it or behind. */
TEST(rays_from_the_surface) {
  for (int i = 0; i < 4 * DIRECTIONS; i++) {
    world w = make_world(i & 1, false);
    ray r = ray_of(&w, i / 4);
    const double t = r.t + (i & 2 ? 1e-12 : -1e-12);
    for (int c = 0; c < 3; c++) r.o[c] += t * r.d[c];
    for (int kind = ABBE_ESTIMATOR_SHAH; kind < ABBE_ESTIMATOR_EXACT; kind++) {
      const abbe_estimate e = run(&w, &r, (abbe_estimator)kind, 8);
      if (kind == ABBE_ESTIMATOR_MARCH) continue; /* its steps are of the range */
      assert_true(e.found);
      assert_near(e.distance, 0, 1e-5);
    }
  }
}

TEST(names) {
  assert_string_equal(abbe_estimator_name(ABBE_ESTIMATOR_FALSE_POSITION), "false-position");
  assert_string_equal(abbe_estimator_name(ABBE_ESTIMATOR_COUNT), "unknown");
}
