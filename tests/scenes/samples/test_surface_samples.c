/* Samples of surfaces: which are kept, how dense they are, and how fast the irradiance that
 * a mirror of uniform radiance gives converges to its closed forms. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/samples/surface_samples.h"
#include "scenes/shapes/shape.h"
#include "tests/random.h"

static void take(const abbe_mesh *mesh, size_t count, uint64_t seed, bool ours,
                 abbe_surface_samples *out) {
  const abbe_surface_sampling sampling = {count, seed, ours, ours};
  OK(abbe_surface_samples_make(&mesh, 1, &sampling, out, &error));
}

/* A rectangle of a width and a height about a middle, spanned by two unit directions. */
static void make_rectangle(const double middle[3], const double u[3], const double v[3],
                           double width, double height, abbe_mesh *out) {
  static const double corner[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  OK(abbe_mesh_make(4, 2, false, out, &error));
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 3; k++)
      out->position[i][k] = middle[k] + corner[i][0] * width * u[k] + corner[i][1] * height * v[k];
    abbe_vector_cross(u, v, out->normal[i]);
  }
  const uint32_t face[2][3] = {{0, 1, 2}, {0, 2, 3}};
  memcpy(out->face, face, sizeof face);
}

static double distance(const abbe_surface_point *a, const abbe_surface_point *b) {
  double d[3];
  abbe_vector_subtract(a->position, b->position, d);
  return abbe_vector_length(d);
}

/* Kept ones are a radius apart, and every candidate is within it of a kept one. */
TEST(neighbours_are_apart_and_cover) {
  MADE(abbe_mesh, ring, abbe_shape_ring(0.03, 0.008, 64, 32, &ring, &error));
  for (int sided = 0; sided < 2; sided++) {
    FILLED(abbe_surface_samples, s, take(&ring, 300, 7, sided != 0, &s));
    assert_true(s.count <= 300 && s.count > 285);
    for (size_t i = 0; i < s.count; i++)
      for (size_t k = i + 1; k < s.count; k++)
        assert_true(distance(&s.sample[i], &s.sample[k]) >= s.reach ||
                    (sided && abbe_vector_dot(s.sample[i].normal, s.sample[k].normal) <= 0));
    for (size_t i = 0; i < s.candidate_count; i++) {
      double least = INFINITY;
      for (size_t k = 0; k < s.count; k++)
        if (!sided || abbe_vector_dot(s.candidate[i].normal, s.sample[k].normal) > 0)
          least = fmin(least, distance(&s.candidate[i], &s.sample[k]));
      assert_true(least < s.reach);
    }
  }
}

/* All lie on the surface; shares are the whole area. */
TEST(area_and_places) {
  MADE(abbe_mesh, ball, abbe_shape_sphere(0.02, 5, &ball, &error));
  for (int ours = 0; ours < 2; ours++) {
    FILLED(abbe_surface_samples, s, take(&ball, 200, 3, ours != 0, &s));
    double sum = 0;
    for (size_t i = 0; i < s.count; i++) {
      sum += s.share[i];
      assert_near(abbe_vector_length(s.sample[i].position), 0.02, 2e-5);
      assert_near(abbe_vector_length(s.sample[i].normal), 1, 1e-12);
    }
    print_message("%zu of 200\n", s.count);
    assert_true(s.count <= 200 && s.count >= 190);
    assert_near(s.area, 4 * ABBE_PI * 4e-4, 3e-6);
    assert_near(sum, s.area, 1e-12);
    assert_near(s.spacing, sqrt(s.area / (double)s.count), 1e-15);
  }
}

/* Samples a square metre on a plane across (0, 0, 1) over those on one across a tilted normal, both
 * in one set, a metre apart. */
static double density_ratio(const double n[3]) {
  const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, near[3] = {0.013, 0.007, 0.0031},
               far[3] = {3, 3, 3};
  double u[3], v[3], flat = 0, tilted = 0;
  abbe_mesh mesh[2] = {{0}, {0}};
  make_rectangle(near, x, y, 1, 1, &mesh[0]);
  abbe_vector_cross(fabs(n[2]) < 0.9 ? (double[3]){0, 0, 1} : x, n, u);
  abbe_vector_normalise(u);
  abbe_vector_cross(n, u, v);
  make_rectangle(far, u, v, 1, 1, &mesh[1]);
  const abbe_mesh *both[2] = {&mesh[0], &mesh[1]};
  for (uint64_t seed = 0; seed < 4; seed++) {
    const abbe_surface_sampling sampling = {.count = 400, .seed = seed};
    MADE(abbe_surface_samples, s, abbe_surface_samples_make(both, 2, &sampling, &s, &error));
    for (size_t i = 0; i < s.count; i++) *(s.sample[i].mesh == 0 ? &flat : &tilted) += 1;
  }
  abbe_mesh_free(&mesh[0]);
  abbe_mesh_free(&mesh[1]);
  return tilted / flat;
}

/* Neighbours see no direction. */
TEST(density_by_normal) {
  const double corner[3] = {sqrt(1 / 3.0), sqrt(1 / 3.0), sqrt(1 / 3.0)};
  const double even = density_ratio(corner);
  print_message("%.3f\n", even);
  assert_near(even, 1, 0.05);
}

/* Irradiance at `at`, facing `n`, by a mirror that shows radiance 1 everywhere: that of a lamp of
 * its shape. */
static double estimate(const abbe_surface_samples *s, const double at[3], const double n[3],
                       bool by_share) {
  double sum = 0;
  for (size_t i = 0; i < s->count; i++) {
    double d[3];
    abbe_vector_subtract(s->sample[i].position, at, d);
    const double d2 = abbe_vector_dot(d, d), there = -abbe_vector_dot(d, s->sample[i].normal),
                 here = abbe_vector_dot(d, n);
    const double area = by_share ? s->share[i] : s->area / (double)s->count;
    if (there > 0 && here > 0) sum += area * there * here / (d2 * d2);
  }
  return sum;
}

/* Lambert's: half the sum over edges of the angle that each fills, times its plane's normal. */
static double polygon(const double (*corner)[3], size_t count, const double at[3],
                      const double n[3]) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    double a[3], b[3], across[3];
    abbe_vector_subtract(corner[i], at, a);
    abbe_vector_subtract(corner[(i + 1) % count], at, b);
    abbe_vector_normalise(a);
    abbe_vector_normalise(b);
    abbe_vector_cross(a, b, across);
    const double angle = atan2(abbe_vector_length(across), abbe_vector_dot(a, b));
    abbe_vector_normalise(across);
    sum += 0.5 * angle * abbe_vector_dot(across, n);
  }
  return fabs(sum);
}

/* Slope of the error's root mean square over many seeds, by the number of samples. */
static double slope(const abbe_mesh *mesh, bool ours, const double at[3], const double n[3],
                    double right, double *last) {
  enum { SIZES = 3, SEEDS = SANITIZED ? 1 : 32 };
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int k = 0; k < SIZES; k++) {
    double square = 0, count = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
      FILLED(abbe_surface_samples, s, take(mesh, (size_t)16 << 2 * k, seed, ours, &s));
      square += pow(estimate(&s, at, n, ours) / right - 1, 2) / SEEDS;
      count += (double)s.count / SEEDS;
    }
    const double x = log(count), y = 0.5 * log(square);
    print_message("  %.0f: %.4g\n", count, sqrt(square));
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    *last = sqrt(square);
  }
  return (SIZES * sxy - sx * sy) / (SIZES * sxx - sx * sx);
}

TEST(convergence_to_a_polygon) {
  const double middle[3] = {0.05, 0.02, 0.4}, u[3] = {0, 0.8, 0.6}, v[3] = {1, 0, 0}, at[3] = {0},
               n[3] = {0, 0, 1};
  FILLED(abbe_mesh, mirror, make_rectangle(middle, u, v, 0.4, 0.3, &mirror));
  double facing[3];
  abbe_vector_cross(u, v, facing);
  assert_true(abbe_vector_dot(facing, middle) < 0);
  const double right = polygon((const double(*)[3])mirror.position, 4, at, n);
  double by[2], last[2];
  for (int ours = 0; ours < 2; ours++) {
    by[ours] = slope(&mirror, ours != 0, at, n, right, &last[ours]);
    print_message("%sslope %.2f\n", ours ? "by share: " : "", by[ours]);
  }
  if (SANITIZED) return; /* too few seeds tell no slope */
  /* By what is nearest to each, evenly, they are far better: a rim has its share and no more. */
  assert_true(by[1] < -0.6);
  assert_true(last[1] < 0.4 * last[0]);
}

/* A disk of radius R, h above: pi R^2 / (R^2 + h^2). */
TEST(a_coaxial_disk) {
  enum { AROUND = 512 };
  const double radius = 0.2, h = 0.25, at[3] = {0}, n[3] = {0, 0, 1};
  MADE(abbe_mesh, disk, abbe_mesh_make(AROUND + 1, AROUND, false, &disk, &error));
  for (uint32_t i = 0; i <= AROUND; i++) {
    const double angle = 2 * ABBE_PI * i / AROUND, r = i < AROUND ? radius : 0;
    const double place[3] = {r * cos(angle), r * sin(angle), h}, down[3] = {0, 0, -1};
    memcpy(disk.position[i], place, sizeof place);
    memcpy(disk.normal[i], down, sizeof down);
    const uint32_t face[3] = {AROUND, (i + 1) % AROUND, i};
    if (i < AROUND) memcpy(disk.face[i], face, sizeof face);
  }
  const double right = ABBE_PI * radius * radius / (radius * radius + h * h);
  double sum = 0;
  for (uint64_t seed = 0; seed < 4; seed++) {
    FILLED(abbe_surface_samples, s, take(&disk, 1024, seed, true, &s));
    sum += estimate(&s, at, n, true) / 4;
  }
  print_message("%.4f of %.4f\n", sum, right);
  assert_near(sum, right, 0.01 * right);
}

/* What moves takes its samples along, so that light through them does not flicker. */
TEST(samples_move_along) {
  static const double by[3] = {0.0078125, -0.03125, 0.00390625};
  MADE(abbe_mesh, ring, abbe_shape_ring(0.03, 0.008, 64, 32, &ring, &error));
  FILLED(abbe_surface_samples, before, take(&ring, 200, 5, true, &before));
  for (size_t i = 0; i < ring.vertex_count; i++)
    for (int c = 0; c < 3; c++) ring.position[i][c] += by[c];
  FILLED(abbe_surface_samples, after, take(&ring, 200, 5, true, &after));
  assert_int_equal(after.count, before.count);
  for (size_t i = 0; i < before.count; i++) {
    double off[3];
    abbe_vector_subtract(after.sample[i].position, before.sample[i].position, off);
    abbe_vector_subtract(off, by, off);
    assert_true(abbe_vector_length(off) < 1e-12);
  }
}

TEST(wrong_requests) {
  abbe_mesh nothing = {0};
  const abbe_mesh *mesh = &nothing;
  abbe_surface_samples s;
  abbe_surface_sampling sampling = {.count = 10};
  REFUSED(ABBE_GEOMETRY, "an area of 0 m2",
          abbe_surface_samples_make(&mesh, 1, &sampling, &s, &error));
  sampling.count = ABBE_SURFACE_MAX_SAMPLES + 1;
  REFUSED(ABBE_INVALID_ARGUMENT, "1 to 4096",
          abbe_surface_samples_make(&mesh, 1, &sampling, &s, &error));
  abbe_surface_samples_free(NULL);
}

/* How normals turn: by 1/R on a sphere, in all directions; by 1/R around a cylinder and not along
 * it; not at all on a plane. */

static abbe_surface_curvature *fit(const abbe_mesh *mesh, abbe_surface_samples *s) {
  const abbe_surface_sampling sampling = {.count = 400, .seed = 1, .sided = true};
  OK(abbe_surface_samples_make(&mesh, 1, &sampling, s, &error));
  abbe_surface_curvature *out = calloc(s->count, sizeof *out);
  OK(abbe_surface_curvature_fit(s, out, &error));
  for (size_t i = 0; i < s->count; i++) {
    double across[3];
    assert_true(fabs(out[i].curvature[0]) >= fabs(out[i].curvature[1]));
    assert_near(abbe_vector_dot(out[i].along[0], out[i].along[1]), 0, 1e-12);
    abbe_vector_cross(out[i].along[0], out[i].along[1], across);
    assert_true(abbe_vector_dot(across, s->sample[i].normal) > 0.9);
  }
  return out;
}

TEST(sphere) {
  const double radius = 0.02;
  OWNED(abbe_surface_samples, s) = {0};
  MADE(abbe_mesh, ball, abbe_shape_sphere(radius, 5, &ball, &error));
  FREED abbe_surface_curvature *c = fit(&ball, &s);
  for (size_t i = 0; i < s.count; i++)
    for (int k = 0; k < 2; k++) assert_near(c[i].curvature[k] * radius, 1, 0.03);
}

/* Seen from inside the normals of its mesh spread the other way; both walls are there. */
TEST(cylinder) {
  const double inner = 0.04, outer = 0.0435, height = 0.1;
  const double profile[4][2] = {{inner, 0}, {inner, height}, {outer, height}, {outer, 0}};
  OWNED(abbe_surface_samples, s) = {0};
  MADE(abbe_mesh, ring, abbe_shape_lathe(profile, 4, 256, &ring, &error));
  FREED abbe_surface_curvature *c = fit(&ring, &s);
  size_t walls[2] = {0, 0};
  for (size_t i = 0; i < s.count; i++) {
    const double *p = s.sample[i].position, r = hypot(p[0], p[1]);
    const double out = s.sample[i].normal[0] * p[0] + s.sample[i].normal[1] * p[1];
    const bool inside = r < 0.5 * (inner + outer);
    /* away from the corners, whose normals break */
    if (fabs(s.sample[i].normal[2]) > 0.1 || p[2] < s.spacing || p[2] > height - s.spacing)
      continue;
    walls[inside]++;
    assert_near(c[i].curvature[0] * (inside ? inner : outer), out > 0 ? 1 : -1, 0.05);
    assert_near(c[i].curvature[1] * inner, 0, 0.05);
    assert_near(fabs(c[i].along[1][2]), 1, 0.01);
  }
  assert_true(walls[0] > 50 && walls[1] > 50);
}

TEST(plane) {
  OWNED(abbe_surface_samples, s) = {0};
  MADE(abbe_mesh, plane, abbe_shape_rectangle(0.3, 0.2, &plane, &error));
  FREED abbe_surface_curvature *c = fit(&plane, &s);
  for (size_t i = 0; i < s.count; i++)
    for (int k = 0; k < 2; k++) assert_near(c[i].curvature[k], 0, 1e-9);
}
