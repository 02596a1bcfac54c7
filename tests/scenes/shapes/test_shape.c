#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/shapes/convex.h"
#include "scenes/shapes/shape.h"
#include "tests/scenes/shapes/closed_mesh.h"

static bool is_convex(const abbe_mesh *mesh, size_t most, double (*plane)[4], size_t *count) {
  abbe_convex found;
  OK(abbe_convex_find(mesh, most, plane, NULL, &found, &error));
  *count = found.planes;
  return found.verdict == ABBE_CONVEX_SOLID;
}

TEST(sphere_has_the_faces_and_nearly_the_volume) {
  MADE(abbe_mesh, m, abbe_shape_sphere(0.05, 4, &m, &error));
  assert_int_equal(m.face_count, 5120);
  const abbe_mesh_report r = assert_closed(&m, 0.7);
  assert_true(fabs(r.volume / (4.0 / 3.0 * ABBE_PI * 0.05 * 0.05 * 0.05) - 1) < 0.005);
  for (size_t v = 0; v < m.vertex_count; v++) {
    assert_true(fabs(abbe_vector_length(m.position[v]) - 0.05) < 1e-15);
    assert_true(fabs(abbe_vector_dot(m.position[v], m.normal[v]) - 0.05) < 1e-15);
  }
}

TEST(ring_is_the_thesis_ring) {
  MADE(abbe_mesh, m, abbe_shape_ring(0.04, 0.01, 256, 128, &m, &error));
  assert_int_equal(m.face_count, 65536);
  const abbe_mesh_report r = assert_closed(&m, 0.7);
  assert_true(fabs(r.volume / (2 * ABBE_PI * ABBE_PI * 0.04 * 0.01 * 0.01) - 1) < 0.002);
}

TEST(gem_is_convex_with_nineteen_planes) {
  double plane[32][4];
  size_t count = 0;
  MADE(abbe_mesh, m, abbe_shape_gem(6, 0.05, 0.028, 0.016, 0.043, &m, &error));
  assert_int_equal(m.face_count, 24);
  assert_closed(&m, 0.7);
  assert_true(is_convex(&m, 32, plane, &count));
  assert_int_equal(count, 19);
}

TEST(prism_has_its_apex_angle) {
  double plane[8][4];
  size_t count = 0;
  MADE(abbe_mesh, m, abbe_shape_prism(ABBE_PI / 3, 0.05, 0.1, &m, &error));
  const abbe_mesh_report r = assert_closed(&m, 0.7);
  assert_true(fabs(r.volume - 0.05 * 0.05 * sqrt(3) / 4 * 0.1) < 1e-12);
  assert_true(fabs(r.max[2] - 0.05 * sqrt(3) / 3) < 1e-12);
  assert_true(is_convex(&m, 8, plane, &count));
  assert_int_equal(count, 5);
  double apex = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < i; j++)
      if (plane[i][2] > 0.1 && plane[j][2] > 0.1)
        apex = ABBE_PI - acos(abbe_vector_dot(plane[i], plane[j]));
  assert_true(fabs(apex - ABBE_PI / 3) < 1e-9);
}

TEST(box_and_rectangle_face_outwards) {
  const double size[3] = {1, 2, 3};
  MADE(abbe_mesh, m, abbe_shape_box(size, &m, &error));
  assert_true(fabs(assert_closed(&m, 0.7).volume - 6) < 1e-12);
  assert_non_null(m.uv);
  abbe_mesh_free(&m);
  OK(abbe_shape_rectangle(2, 3, &m, &error));
  double n[3];
  abbe_vector_triangle(m.position[0], m.position[1], m.position[2], n);
  assert_true(n[2] > 0 && m.normal[3][2] == 1 && m.uv[2][0] == 1 && m.uv[2][1] == 1);
}

TEST(lathe_of_a_cylinder_keeps_its_rims_sharp) {
  const double profile[4][2] = {{0, 0}, {0.1, 0}, {0.1, 0.3}, {0, 0.3}};
  MADE(abbe_mesh, m, abbe_shape_lathe(profile, 4, 64, &m, &error));
  assert_int_equal(m.face_count, 2 * 64 * 2);
  const abbe_mesh_report r = assert_closed(&m, 0.7);
  assert_true(fabs(r.volume / (ABBE_PI * 0.01 * 0.3) - 1) < 0.002);
  for (size_t v = 0; v < m.vertex_count; v++)
    assert_true(fabs(m.normal[v][2]) < 1e-12 || fabs(fabs(m.normal[v][2]) - 1) < 1e-12);
}

TEST(lathe_of_an_arc_is_smooth) {
  double profile[33][2];
  for (int i = 0; i < 33; i++) {
    profile[i][0] = i == 0 || i == 32 ? 0 : sin(ABBE_PI * i / 32);
    profile[i][1] = -cos(ABBE_PI * i / 32);
  }
  MADE(abbe_mesh, m, abbe_shape_lathe((const double(*)[2])profile, 33, 48, &m, &error));
  assert_closed(&m, 0.7);
  for (size_t v = 0; v < m.vertex_count; v++)
    assert_true(abbe_vector_dot(m.normal[v], m.position[v]) > 0.9999);
}

/* A pipe's wall, a disk and a bowl: rims where the profile ends off the axis. */
TEST(an_open_lathe_has_rims) {
  const double wall[2][2] = {{0.1, 0}, {0.1, 0.3}}, disk[2][2] = {{0, 0.2}, {0.1, 0.2}};
  const double bowl[3][2] = {{0, 0}, {0.1, 0.02}, {0.15, 0.08}};
  const struct {
    const double (*profile)[2];
    size_t count, faces;
    double area;
  } cases[] = {{wall, 2, 2 * 64, 2 * ABBE_PI * 0.1 * 0.3},
               {disk, 2, 64, ABBE_PI * 0.01},
               {bowl, 3, 3 * 64, ABBE_PI * (0.1 * hypot(0.1, 0.02) + 0.25 * hypot(0.05, 0.06))}};
  for (int i = 0; i < 3; i++) {
    double area = 0;
    MADE(abbe_mesh, m, abbe_shape_lathe(cases[i].profile, cases[i].count, 64, &m, &error));
    assert_int_equal(m.face_count, cases[i].faces);
    for (size_t f = 0; f < m.face_count; f++) {
      double n[3];
      abbe_vector_triangle(m.position[m.face[f][0]], m.position[m.face[f][1]],
                           m.position[m.face[f][2]], n);
      area += abbe_vector_length(n) / 2;
      /* normals are across the faces, on their side */
      assert_true(abbe_vector_dot(n, m.normal[m.face[f][0]]) > 0.9 * abbe_vector_length(n));
    }
    assert_true(fabs(area / cases[i].area - 1) < 0.003);
  }
}

TEST(rounding_a_profile_cuts_corners_and_keeps_ends) {
  const double profile[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  double(*out)[2];
  size_t count;
  OK(abbe_shape_round_profile(profile, 4, 2, &out, &count, &error));
  assert_int_equal(count, 10);
  assert_true(out[0][0] == 0 && out[0][1] == 0 && out[9][0] == 0 && out[9][1] == 1);
  for (size_t i = 1; i + 1 < count; i++) assert_true(out[i][0] > 0 && out[i][0] <= 1);
  free(out);
  assert_int_equal(abbe_shape_round_profile(profile, 4, 12, &out, &count, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_null(out);
}

TEST(impossible_parameters_are_refused) {
  abbe_mesh m;
  const double flat[3] = {1, 0, 1}, cut[3][2] = {{0, 0}, {-1, 0}, {0, 1}};
  const double line[2][2] = {{0, 0}, {0, 1}}, pinched[3][2] = {{1, 0}, {0, 1}, {1, 2}},
               twice[4][2] = {{0, 0}, {1, 0}, {1, 0}, {0, 1}};
  REFUSED(ABBE_INVALID_ARGUMENT, "it must be a finite length above zero",
          abbe_shape_sphere(0, 2, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a sphere with radius nan is not possible",
          abbe_shape_sphere(NAN, 2, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "levels is not possible", abbe_shape_sphere(1, 10, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "the minor radius must be the smaller",
          abbe_shape_ring(1, 1, 8, 8, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "segments is not possible",
          abbe_shape_ring(1, 0.5, 2, 8, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a ring with minor radius inf is not possible",
          abbe_shape_ring(1, INFINITY, 8, 8, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "sides is not possible",
          abbe_shape_gem(2, 1, 0.5, 1, 1, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "must be smaller than its girdle",
          abbe_shape_gem(6, 1, 1.5, 1, 1, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "it must be a finite length above zero",
          abbe_shape_gem(6, 1, 0.5, 1, -1, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a prism with an apex of",
          abbe_shape_prism(ABBE_PI, 1, 1, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "it must be a finite length above zero",
          abbe_shape_prism(1, 1, 0, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "it must be a finite length above zero",
          abbe_shape_box(flat, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "it must be a finite length above zero",
          abbe_shape_rectangle(1, -1, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "and only the ends may lie on the axis",
          abbe_shape_lathe(cut, 3, 8, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "both points of the lathe profile lie on the",
          abbe_shape_lathe(line, 2, 8, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "and only the ends may lie on the axis",
          abbe_shape_lathe(pinched, 3, 8, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "of the lathe profile are the same",
          abbe_shape_lathe(twice, 4, 8, &m, &error));
  assert_null(m.face);
}

TEST(grooves_run_along_or_around) {
  static const struct {
    bool around;
    double axis[3], centre[3], p[3], n[3], along[3];
  } rows[] = {
      {false, {0, 0, 1}, {0, 0, 0}, {3, 0, 5}, {1, 0, 0}, {0, 0, 1}},
      {false, {0, 0, 1}, {0, 0, 0}, {3, 0, 5}, {0.6, 0, 0.8}, {-0.8, 0, 0.6}},
      {true, {0, 0, 1}, {0, 0, 0}, {3, 0, 5}, {1, 0, 0}, {0, 1, 0}},
      {true, {0, 0, 1}, {1, 2, 0}, {1, 7, 5}, {0, 0, 1}, {-1, 0, 0}}, /* the top of a ring */
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_brushing b = {.around = rows[i].around};
    double along[3];
    memcpy(b.axis, rows[i].axis, sizeof b.axis);
    memcpy(b.centre, rows[i].centre, sizeof b.centre);
    abbe_brushing_grain(&b, rows[i].p, rows[i].n, along);
    for (int k = 0; k < 3; k++) assert_near(along[k], rows[i].along[k], 1e-12);
  }
}

/* At a pole, on the axis, without one: any way, but along the surface and of length 1. */
TEST(there_is_always_a_way) {
  static const double n[][3] = {{0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0.6, 0, 0.8}, {1, 1e-12, 0}};
  for (size_t i = 0; i < sizeof n / sizeof *n; i++)
    for (int around = 0; around < 2; around++)
      for (int axis = 0; axis < 2; axis++) {
        abbe_brushing b = {.around = around != 0};
        double along[3];
        for (int k = 0; k < 3; k++) b.axis[k] = axis * n[i][k];
        abbe_brushing_grain(&b, b.axis, n[i], along);
        double square = 0, off = 0;
        for (int k = 0; k < 3; k++) {
          square += along[k] * along[k];
          off += along[k] * n[i][k];
        }
        assert_near(square, 1, 1e-12);
        assert_near(off, 0, 1e-12);
      }
}

TEST(it_moves_with_its_object) {
  static const double x[3] = {0, 0, 3}, turn[3] = {1, 0, 0};
  abbe_brushing b = {.facets = {0.1, 0.3}, .around = true, .axis = {0, 0, 1}, .centre = {0, 0, 1}};
  double m[16], step[16];
  abbe_transform_rotate(3.14159265358979323846 / 2, turn, m);
  abbe_transform_translate(x, step);
  abbe_transform_multiply(step, m, m);
  abbe_brushing_move(&b, m);
  assert_near(b.axis[1], -1, 1e-12);
  assert_near(b.centre[1], -1, 1e-12);
  assert_near(b.centre[2], 3, 1e-12);
  assert_true(abbe_brushing_is_rough(&b) && !abbe_brushing_is_rough(&(abbe_brushing){0}));
}
