/* Spheres of triangles: areas, neighbours, and which of them a direction meets. */
#include "tests/check.h"
#include "tests/random.h"

#include "base/maths.h"
#include "scenes/volume/sphere_mesh.h"

static void make(int kind, abbe_sphere_mesh *out) {
  abbe_error error = {0};
  const abbe_result result = kind < 4
                                 ? abbe_sphere_mesh_geodesic((size_t)kind, out, &error)
                                 : abbe_sphere_mesh_octahedral((size_t)(kind - 3) * 6, out, &error);
  assert_string_equal(error.text, "");
  assert_int_equal(result, ABBE_OK);
}

static void random_direction(uint64_t *seed, double d[3]) {
  do
    for (int k = 0; k < 3; k++) d[k] = random_between(seed, -1, 1);
  while (!(abbe_vector_length(d) > 0.1) || abbe_vector_length(d) > 1);
}

TEST(faces_cover_the_sphere_once) {
  for (int kind = 0; kind < 7; kind++) {
    FILLED(abbe_sphere_mesh, m, make(kind, &m));
    assert_int_equal(m.face_count, kind < 4 ? 20 << 2 * kind : 2 * 36 * (kind - 3) * (kind - 3));
    double sum = 0;
    for (size_t f = 0; f < m.face_count; f++) sum += abbe_sphere_mesh_area(&m, f);
    assert_near(sum, 4 * ABBE_PI, 1e-11);
  }
}

/* Beyond each edge lies the face that has it, the other way round. */
TEST(neighbours_share_an_edge) {
  for (int kind = 0; kind < 7; kind++) {
    FILLED(abbe_sphere_mesh, m, make(kind, &m));
    for (size_t f = 0; f < m.face_count; f++)
      for (int k = 0; k < 3; k++) {
        const size_t next = m.next[f][k];
        int found = 0;
        for (int j = 0; j < 3; j++)
          found += m.face[next][j] == m.face[f][(k + 1) % 3] &&
                   m.face[next][(j + 1) % 3] == m.face[f][k] && m.next[next][j] == f;
        assert_int_equal(found, 1);
      }
  }
}

TEST(a_direction_lies_inside_the_face_that_is_found) {
  uint64_t seed = 1;
  for (int kind = 0; kind < 7; kind++) {
    FILLED(abbe_sphere_mesh, m, make(kind, &m));
    size_t beside = 0;
    for (int i = 0; i < 5000; i++) {
      double d[3], sum[3] = {0}, weight[3], across[3];
      random_direction(&seed, d);
      const size_t face = abbe_sphere_mesh_find(&m, d), near = abbe_sphere_mesh_look_up(&m, d);
      for (int k = 0; k < 3; k++) assert_true(abbe_vector_dot(m.edge[face][k], d) >= -1e-12);
      beside += face != near;
      abbe_sphere_mesh_weights(&m, face, d, weight);
      assert_near(weight[0] + weight[1] + weight[2], 1, 1e-12);
      for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) sum[k] += weight[c] * m.corner[m.face[face][c]][k];
      abbe_vector_cross(sum, d, across);
      assert_near(abbe_vector_length(across), 0, 1e-12);
    }
    /* the table's texels are a quarter of a face wide: it errs beside edges alone */
    assert_true(beside < 2000);
  }
}

TEST(the_table_is_exact_in_the_middle_of_its_texels) {
  FILLED(abbe_sphere_mesh, m, make(3, &m));
  for (size_t i = 0; i < m.table_side * m.table_side; i++) {
    const double side = (double)m.table_side;
    double uv[2] = {((double)(i % m.table_side) + 0.5) / side * 2 - 1,
                    ((double)(i / m.table_side) + 0.5) / side * 2 - 1},
           d[3], back[2];
    abbe_octahedral_direction(uv, d);
    abbe_octahedral_place(d, back);
    assert_near(back[0], uv[0], 1e-12);
    assert_near(back[1], uv[1], 1e-12);
    for (int k = 0; k < 3; k++) assert_true(abbe_vector_dot(m.edge[m.table[i]][k], d) >= -1e-12);
  }
}

/* Two triangles are the texel that the map has there. */
TEST(octahedral_faces_are_texels) {
  uint64_t seed = 7;
  const size_t side = 12;
  MADE(abbe_sphere_mesh, m, abbe_sphere_mesh_octahedral(side, &m, &error));
  for (int i = 0; i < 5000; i++) {
    double d[3], uv[2];
    random_direction(&seed, d);
    abbe_octahedral_place(d, uv);
    const double x = (uv[0] + 1) / 2 * (double)side, y = (uv[1] + 1) / 2 * (double)side;
    if (fmin(fabs(x - round(x)), fabs(y - round(y))) < 1e-9) continue;
    assert_int_equal(abbe_sphere_mesh_find(&m, d) / 2, (size_t)y * side + (size_t)x);
  }
}

TEST(limits_are_told) {
  abbe_sphere_mesh m;
  REFUSED(ABBE_INVALID_ARGUMENT, "0 to 6", abbe_sphere_mesh_geodesic(7, &m, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "even", abbe_sphere_mesh_octahedral(7, &m, &error));
}
