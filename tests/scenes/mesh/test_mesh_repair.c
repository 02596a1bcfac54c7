/* What 'repair: true' does to meshes of thousands of faults. */
#include "tests/scenes/solids.h"

static bool is_closed(const abbe_mesh *m) {
  abbe_mesh_report r;
  OK(abbe_mesh_check(m, &r, &error));
  return r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces == 0;
}

static void assert_repairs(abbe_mesh *m, const char *word) {
  FREED char *what = NULL;
  OK(abbe_mesh_fix(m, ABBE_NORMALS_AUTO, true, NULL, &what, &error));
  assert_contains(what, word);
  assert_true(is_closed(m));
}

static void set_point(abbe_mesh *m, size_t v, double x, double y, double z) {
  const double p[3] = {x, y, z};
  memcpy(m->position[v], p, sizeof p);
}

static void set_face(abbe_mesh *m, size_t f, size_t a, size_t b, size_t c) {
  const uint32_t face[3] = {(uint32_t)a, (uint32_t)b, (uint32_t)c};
  memcpy(m->face[f], face, sizeof face);
}

/* Strips that bend three quarters round, each with a rim of so many points. */
static abbe_mesh strips(size_t count, size_t points) {
  const size_t pairs = points / 2, faces = 2 * (pairs - 1);
  abbe_mesh m;
  OK(abbe_mesh_make(count * points, count * faces, false, &m, &error));
  for (size_t s = 0; s < count; s++) {
    const size_t v = s * points, f = s * faces;
    for (size_t i = 0; i < pairs; i++) {
      const double turn = 1.5 * 3.14159265 * (double)i / (double)(pairs - 1);
      const double x = 3 * (double)s + cos(turn), lift = 0.2 * sin(3 * turn);
      set_point(&m, v + 2 * i, x, sin(turn), lift);
      set_point(&m, v + 2 * i + 1, x, sin(turn), 1 + lift);
      if (i + 1 == pairs) break;
      set_face(&m, f + 2 * i, v + 2 * i, v + 2 * i + 2, v + 2 * i + 3);
      set_face(&m, f + 2 * i + 1, v + 2 * i, v + 2 * i + 3, v + 2 * i + 1);
    }
  }
  return m;
}

TEST(many_short_rims_are_closed) {
  OWNED(abbe_mesh, m) = strips(500, 20);
  assert_repairs(&m, "500 holes closed");
}

/* The search takes the cube of a rim's points: what is too much is refused before it begins. */
TEST(many_long_rims_are_refused) {
  OWNED(abbe_mesh, m) = strips(21, 600);
  const size_t faces = m.face_count;
  REFUSED(ABBE_GEOMETRY, "21 holes that bend, of up to 600 edges",
          abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, true, NULL, NULL, &error));
  assert_contains(last_error.text, "where the mesh was made");
  assert_int_equal(m.face_count, faces);
}
