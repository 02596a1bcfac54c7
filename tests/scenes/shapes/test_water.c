/* Water: a flat one is a box, waves go at the speed of their relation, rings of drops too, and no
 * water comes or goes. */
#include "base/maths.h"
#include "scenes/shapes/water.h"

#include "tests/scenes/shapes/closed_mesh.h"

#include "scenes/shapes/convex.h"

static abbe_mesh make(const abbe_water *water) {
  abbe_mesh mesh;
  OK(abbe_water_make(water, &mesh, &error));
  return mesh;
}

TEST(still_water_is_a_box) {
  const abbe_water water = {.size = {0.4, 0.3, 0.2}};
  double plane[8][4];
  abbe_convex found;
  OWNED(abbe_mesh, mesh) = make(&water);
  const abbe_mesh_report report = assert_closed(&mesh, 0.9);
  assert_near(report.volume, 0.4 * 0.3 * 0.2, 1e-15);
  assert_near(report.max[2], 0, 0);
  assert_near(report.min[2], -0.2, 0);
  OK(abbe_convex_find(&mesh, 8, plane, NULL, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
  assert_int_equal(found.planes, 6);
}

/* Long waves over little water, deep water's, and the slowest of all, which tension and gravity
 * make together: (4 g T / rho)^(1/4), 0.23 m/s at 17 mm. */
TEST(waves_have_the_speeds_that_are_known) {
  const double g = 9.80665, tension = 0.0728 / 998.2;
  assert_near(abbe_water_frequency(2 * ABBE_PI / 100, 0.1) * 100 / (2 * ABBE_PI), sqrt(g * 0.1),
              1e-4);
  assert_near(abbe_water_frequency(2 * ABBE_PI / 10, INFINITY) * 10 / (2 * ABBE_PI),
              sqrt(g * 10 / (2 * ABBE_PI)), 1e-4);
  double slowest = INFINITY, at = 0;
  for (double length = 0.01; length < 0.03; length += 1e-5) {
    const double speed =
        abbe_water_frequency(2 * ABBE_PI / length, INFINITY) * length / (2 * ABBE_PI);
    if (speed < slowest) at = length;
    slowest = fmin(slowest, speed);
  }
  assert_near(slowest, pow(4 * g * tension, 0.25), 1e-7);
  assert_near(slowest, 0.231, 1e-3);
  assert_near(at, 0.0171, 1e-4);
}

/* After a time the surface is what it was, moved by its speed along its direction; and normals are
 * those of the heights. */
TEST(a_wave_goes_its_way) {
  const double length = 0.2, turn = 0.7, k = 2 * ABBE_PI / length, time = 0.37, phase = 0.4;
  const abbe_water_wave wave = {0.003, length, turn, phase};
  const abbe_water water = {
      .size = {0.5, 0.5, 0.08}, .cells = {64, 64}, .time = time, .wave_count = 1, .wave = &wave};
  OWNED(abbe_mesh, mesh) = make(&water);
  const double speed = abbe_water_frequency(k, 0.08) / k;
  assert_closed(&mesh, 0.9);
  for (size_t v = 0; v < 65 * 65; v++) {
    const double *p = mesh.position[v], *n = mesh.normal[v];
    const double way = k * (cos(turn) * p[0] + sin(turn) * p[1] - speed * time) + phase;
    assert_near(p[2], 0.003 * cos(way), 1e-15);
    assert_near(-n[0] / n[2], -0.003 * k * cos(turn) * sin(way), 1e-12);
    assert_near(-n[1] / n[2], -0.003 * k * sin(turn) * sin(way), 1e-12);
  }
}

static const double radius = 0.02;
static const abbe_water_drop drop = {{0.03, -0.02}, 1.5, 0.004, radius};

static abbe_mesh after(double age) {
  const abbe_water water = FIELDS(.size = {1, 1, 0.1}, .cells = {320, 320}, .time = drop.time + age,
                                  .drop_count = 1, .drop = &drop);
  return make(&water);
}

/* At first the crater, to the step of its table; at every time all the water that there was. */
TEST(a_drop_takes_no_water) {
  abbe_mesh mesh = after(0);
  double worst = 0;
  for (size_t v = 0; v < 321 * 321; v++) {
    const double *p = mesh.position[v];
    const double r2 = pow(p[0] - drop.at[0], 2) + pow(p[1] - drop.at[1], 2);
    const double crater = -drop.depth * (1 - r2 / (radius * radius)) * exp(-r2 / (radius * radius));
    worst = fmax(worst, fabs(p[2] - crater));
  }
  print_message("the crater is off by %.2g of its depth\n", worst / drop.depth);
  assert_true(worst < 2e-3 * drop.depth);
  abbe_mesh_free(&mesh);
  for (int i = 1; i < 4; i++) {
    mesh = after(0.08 * i); /* before the fastest waves reach a wall */
    const abbe_mesh_report report = assert_closed(&mesh, 0.9);
    assert_near(report.volume, 0.1, 1e-3 * ABBE_PI * radius * radius * drop.depth);
    assert_true(report.max[2] > 0.01 * drop.depth); /* it does go on */
    abbe_mesh_free(&mesh);
  }
}

/* The part of the surface that is a plane wave of that number along x. */
static double part_of(const abbe_mesh *mesh, double k) {
  double sum = 0;
  for (size_t v = 0; v < 321 * 321; v++)
    sum += mesh->position[v][2] * cos(k * (mesh->position[v][0] - drop.at[0]));
  return sum;
}

/* Each part of a ring swings at its own frequency, as long as the walls are not reached. */
TEST(rings_obey_their_relation) {
  OWNED(abbe_mesh, first) = after(0);
  for (int i = 1; i < 5; i++) {
    const double age = 0.07 * i;
    OWNED(abbe_mesh, mesh) = after(age);
    for (int m = 1; m < 6; m++) {
      const double k = 30 * m, damping = exp(-2e-6 * k * k * age);
      const double known = cos(abbe_water_frequency(k, 0.1) * age) * damping;
      const double seen = part_of(&mesh, k) / part_of(&first, k);
      if (fabs(seen - known) > 5e-3) print_error("k %g after %g s: %g, %g\n", k, age, seen, known);
      assert_near(seen, known, 5e-3);
    }
  }
}

/* Any instant is computed by itself, the same each time; rain moves on. */
TEST(rain_falls) {
  abbe_water water = {.size = {0.3, 0.2, 0.05}, .time = 7, .rain = {0.4, 0.002, 0.01, 3}};
  OWNED(abbe_mesh, a) = make(&water), b = make(&water);
  assert_int_equal(a.vertex_count, b.vertex_count);
  assert_memory_equal(a.position, b.position, a.vertex_count * sizeof *a.position);
  assert_closed(&a, 0.9);
  abbe_mesh_free(&b);
  water.time += 0.05;
  b = make(&water);
  double apart = 0;
  for (size_t v = 0; v < a.vertex_count; v++)
    apart = fmax(apart, fabs(a.position[v][2] - b.position[v][2]));
  assert_true(apart > 1e-5 && apart < 0.01);
}

static void refuses(abbe_water water, const char *word) {
  abbe_mesh mesh;
  REFUSED(ABBE_INVALID_ARGUMENT, word, abbe_water_make(&water, &mesh, &error));
  assert_null(mesh.position);
}

TEST(what_is_no_water) {
  const abbe_water_wave high = {0.3, 1, 0, 0}, none = {0.01, 0, 0, 0},
                        short_one = {1e-6, 1e-4, 0, 0};
  const abbe_water_wave nan = {NAN, 1, 0, 0};
  const abbe_water_drop bad = {{0, 0}, 0, 0.001, -1};
  refuses((abbe_water){.size = {1, 0, 1}}, "size");
  refuses((abbe_water){.size = {1, 1, INFINITY}}, "size");
  refuses((abbe_water){.size = {1, 1, 1}, .time = NAN}, "time");
  refuses((abbe_water){.size = {1, 1, 1}, .cells = {5000, 1}}, "2048");
  refuses((abbe_water){.size = {1, 1, 0.2}, .wave_count = 1, .wave = &high}, "bare");
  refuses((abbe_water){.size = {1, 1, 1}, .wave_count = 1, .wave = &none}, "wavelength");
  refuses((abbe_water){.size = {1, 1, 1}, .wave_count = 1, .wave = &nan}, "amplitude");
  refuses((abbe_water){.size = {1, 1, 1}, .wave_count = 1, .wave = &short_one}, "cells");
  refuses((abbe_water){.size = {1, 1, 1}, .drop_count = 1, .drop = &bad}, "radius");
  refuses((abbe_water){.size = {1, 1, 1}, .rain = {-1, 1, 1, 0}}, "rain");
  refuses((abbe_water){.size = {1, 1, 1}, .rain = {0.01, 0.001, 0.01, 0}}, "more than 64 drops");
}
