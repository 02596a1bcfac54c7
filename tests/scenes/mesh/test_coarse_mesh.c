/* Coarser meshes against what they must keep: the surface without holes, its sides apart. */
#include "scenes/mesh/mesh.h"

#include "base/maths.h"
#include "scenes/shapes/shape.h"
#include "scenes/shapes/water.h"
#include "tests/check.h"
#include "tests/random.h"

typedef struct coarse {
  abbe_mesh whole, few; /* few: the same vertices */
} coarse;

static void make_few(coarse *c) {
  c->few = c->whole;
  OK(abbe_coarse_mesh_make(&c->whole, &c->few.face, &c->few.face_count, &error));
}

static void coarse_free(coarse *c) {
  free(c->few.face);
  abbe_mesh_free(&c->whole);
}

/* How many of the triangles a ray from the origin meets, and how far off the farthest is. */
static size_t met_by(const abbe_mesh *mesh, bool inner, const double d[3], double *distance) {
  size_t count = 0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *face = mesh->face[f];
    double across[3], n[3];
    bool inside = true;
    if (inner != (face[0] >= mesh->vertex_count / 2)) continue;
    for (int k = 0; k < 3 && inside; k++) {
      abbe_vector_cross(mesh->position[face[k]], mesh->position[face[(k + 1) % 3]], across);
      inside = abbe_vector_dot(across, d) * (inner ? -1 : 1) >= -1e-12;
    }
    if (!inside) continue;
    count++;
    abbe_vector_triangle(mesh->position[face[0]], mesh->position[face[1]], mesh->position[face[2]],
                         n);
    *distance = abbe_vector_dot(n, mesh->position[face[0]]) / abbe_vector_dot(n, d);
  }
  return count;
}

/* Rays from the middle of a sphere or shell meet each of its sides, where it was. */
static void assert_all_around(const abbe_mesh *mesh, bool inner, double radius) {
  enum { RAYS = 400 };
  uint64_t random = 1;
  for (int i = 0; i < RAYS; i++) {
    double d[3], distance = 0;
    for (int k = 0; k < 3; k++) d[k] = random_between(&random, -1, 1);
    abbe_vector_normalise(d);
    assert_true(met_by(mesh, inner, d, &distance) > 0);
    assert_near(distance / radius, 1, 2.5e-3); /* edges of 2.5 cells are so far within */
  }
}

/* No triangle lies folded over: its normal is that of its corners. */
static void assert_upright(const abbe_mesh *mesh) {
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *face = mesh->face[f];
    double n[3];
    abbe_vector_triangle(mesh->position[face[0]], mesh->position[face[1]], mesh->position[face[2]],
                         n);
    assert_true(abbe_vector_dot(n, mesh->normal[face[0]]) > 0);
  }
}

/* A shell whose wall is a tenth of a cell: its sides stay apart, and each is whole. */
TEST(sides_of_a_thin_wall_stay_apart) {
  OWNED(coarse, c) = {0};
  static const double thin = 0.998;
  abbe_mesh both;
  MADE(abbe_mesh, w, abbe_shape_sphere(0.5, 6, &w, &error)); /* 81,920 faces */
  OK(abbe_mesh_make(2 * w.vertex_count, 2 * w.face_count, false, &both, &error));
  for (size_t v = 0; v < both.vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      const size_t from = v % w.vertex_count;
      const bool inner = v >= w.vertex_count;
      both.position[v][k] = w.position[from][k] * (inner ? thin : 1);
      both.normal[v][k] = w.normal[from][k] * (inner ? -1 : 1);
    }
  for (size_t f = 0; f < both.face_count; f++)
    for (size_t k = 0; k < 3; k++) {
      const bool inner = f >= w.face_count;
      const size_t own = inner ? 2 - k : k, first = inner ? w.vertex_count : 0;
      both.face[f][k] = (uint32_t)(w.face[f % w.face_count][own] + first);
    }
  c.whole = both;
  make_few(&c);
  assert_int_in_range(c.few.face_count, ABBE_COARSE_MESH_FACES / 2, 3 * ABBE_COARSE_MESH_FACES / 2);
  for (size_t f = 0; f < c.few.face_count; f++) /* no face leads from one side to the other */
    for (int k = 1; k < 3; k++)
      assert_int_equal(c.few.face[f][k] < both.vertex_count / 2,
                       c.few.face[f][0] < both.vertex_count / 2);
  assert_upright(&c.few);
  assert_all_around(&c.few, false, 0.5);
  assert_all_around(&c.few, true, 0.5 * thin);
}

/* How far off the mesh is on a way from p; INFINITY: it is not met. */
static double distance_along(const abbe_mesh *mesh, const double p[3], const double d[3]) {
  double least = INFINITY;
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *face = mesh->face[f];
    double corner[3][3], n[3], across[3];
    int side[2] = {0, 0};
    for (int k = 0; k < 3; k++) abbe_vector_subtract(mesh->position[face[k]], p, corner[k]);
    for (int k = 0; k < 3; k++) {
      abbe_vector_cross(corner[k], corner[(k + 1) % 3], across);
      side[abbe_vector_dot(across, d) < 0]++;
    }
    abbe_vector_triangle(corner[0], corner[1], corner[2], n);
    const double t = abbe_vector_dot(n, corner[0]) / abbe_vector_dot(n, d);
    if ((side[0] == 3 || side[1] == 3) && t > 0) least = fmin(least, t);
  }
  return least;
}

/* Water, whose rim has vertices of the top and of the walls: ways out of its middle, and such that
 * pass close by the rim, meet it where they did. */
TEST(seams_stay_closed) {
  enum { RAYS = 300 };
  const abbe_water_wave wave = {0.01, 0.5, 0.3, 0};
  const abbe_water water = {
      .size = {2, 1.5, 0.6}, .cells = {240, 200}, .wave_count = 1, .wave = &wave};
  const double middle[3] = {0, 0, -0.3};
  uint64_t random = 3;
  MADE(coarse, c, abbe_water_make(&water, &c.whole, &error));
  make_few(&c);
  assert_non_null(c.few.face);
  assert_int_in_range(c.few.face_count, ABBE_COARSE_MESH_FACES / 2, 3 * ABBE_COARSE_MESH_FACES / 2);
  assert_upright(&c.few);
  for (int i = 0; i < RAYS; i++) {
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = random_between(&random, -1, 1);
    if (i % 2 == 0) { /* to the rim of the top's shorter sides */
      d[0] = i % 4 == 0 ? 1 : -1;
      d[1] *= 0.75;
      d[2] = 0.3 + 0.01 * cos(2 * 3.14159265 / 0.5 * (d[0] * cos(0.3) + d[1] * sin(0.3))) +
             random_between(&random, -1e-3, 1e-3);
    }
    abbe_vector_normalise(d);
    const double few = distance_along(&c.few, middle, d), all = distance_along(&c.whole, middle, d);
    assert_near(few / all, 1, 0.02);
  }
}

/* Few faces, faces of their own vertices, and no face at all: left as they are. */
TEST(what_is_no_smooth_large_mesh_is_left) {
  MADE(coarse, c, abbe_shape_ring(0.08, 0.02, 64, 32, &c.whole, &error));
  make_few(&c);
  assert_null(c.few.face);
  coarse_free(&c);
  OK(abbe_shape_sphere(0.5, 6, &c.whole, &error));
  OK(abbe_mesh_compute_normals(&c.whole, ABBE_NORMALS_FLAT, &error));
  make_few(&c);
  assert_null(c.few.face);
  coarse_free(&c);
  OK(abbe_shape_sphere(0.5, 6, &c.whole, &error));
  for (size_t v = 0; v < c.whole.vertex_count; v++) memset(c.whole.position[v], 0, 24);
  make_few(&c);
  assert_null(c.few.face);
}
