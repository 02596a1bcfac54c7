/* How normals turn: by 1/R on a sphere, in all directions; by 1/R around a cylinder and not along
 * it; not at all on a plane. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/samples/surface_samples.h"
#include "scenes/shapes/shape.h"

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
