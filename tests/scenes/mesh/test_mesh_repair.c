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

/* A box and room for more points and faces, none of which is there yet. */
static abbe_mesh box_and_more(size_t points, size_t faces) {
  const test_box one = {{0, 0, 0}, {1, 1, 1}, false};
  abbe_mesh m, box = test_boxes(&one, 1);
  OK(abbe_mesh_make(8 + points, 12 + faces, false, &m, &error));
  memcpy(m.position, box.position, 8 * sizeof *m.position);
  memcpy(m.face, box.face, 12 * sizeof *m.face);
  abbe_mesh_free(&box);
  return m;
}

static void set_point(abbe_mesh *m, size_t v, double x, double y, double z) {
  const double p[3] = {x, y, z};
  memcpy(m->position[v], p, sizeof p);
}

static void set_face(abbe_mesh *m, size_t f, size_t a, size_t b, size_t c) {
  const uint32_t face[3] = {(uint32_t)a, (uint32_t)b, (uint32_t)c};
  memcpy(m->face[f], face, sizeof face);
}

/* Two fins on every one of many bodies. */
TEST(as_many_sheets_as_there_are_go) {
  enum { BODIES = 200 };
  static test_box box[BODIES + (2 * BODIES + 11) / 12]; /* whose last ones are made into fins */
  const size_t boxes = sizeof box / sizeof *box;
  for (size_t i = 0; i < boxes; i++)
    box[i] = (test_box){{3.0 * (double)i, 0, 0}, {3.0 * (double)i + 1, 1, 1}, false};
  abbe_mesh m = test_boxes(box, boxes);
  m.face_count = 12 * BODIES;
  for (size_t i = 0; i < BODIES; i++) {
    set_face(&m, m.face_count++, 8 * i + 4, 8 * i + 5, 8 * i + 12);
    set_face(&m, m.face_count++, 8 * i + 2, 8 * i + 3, 8 * i + 13);
  }
  assert_repairs(&m, "400 sheets that hung on the body");
  assert_int_equal(m.face_count, 12 * BODIES);
  abbe_mesh_free(&m);
}

/* Fins of two triangles, each a little smaller than the one on whose diagonal it hangs: they can
 * only go one after another. */
TEST(sheets_on_sheets_go) {
  enum { FINS = 40 };
  abbe_mesh m = box_and_more(2 * FINS, 2 * FINS);
  size_t p = 4, q = 5;
  for (size_t i = 0; i < FINS; i++) {
    const size_t r = 8 + 2 * i, s = r + 1;
    const double size = pow(0.95, (double)i), turn = 2.4 * (double)i;
    double across[3];
    for (int k = 0; k < 3; k++) across[k] = m.position[q][k] - m.position[p][k];
    set_point(&m, r, m.position[p][0] + size * 0.3, m.position[p][1] + 0.3 * size * cos(turn),
              m.position[p][2] + 0.3 * size * sin(turn));
    set_point(&m, s, m.position[r][0] + 0.9 * across[0], m.position[r][1] + 0.9 * across[1],
              m.position[r][2] + 0.9 * across[2]);
    set_face(&m, 12 + 2 * i, p, q, r);
    set_face(&m, 13 + 2 * i, q, s, r);
    p = q;
    q = r;
  }
  assert_repairs(&m, "sheets that hung on the body");
  assert_int_equal(m.face_count, 12);
  abbe_mesh_free(&m);
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
  abbe_mesh m = strips(500, 20);
  assert_repairs(&m, "500 holes closed");
  abbe_mesh_free(&m);
}

/* The search takes the cube of a rim's points: what is too much is refused before it begins. */
TEST(many_long_rims_are_refused) {
  abbe_mesh m = strips(21, 600);
  const size_t faces = m.face_count;
  REFUSED(ABBE_GEOMETRY, "21 holes that bend, of up to 600 edges",
          abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, true, NULL, NULL, &error));
  assert_contains(last_error.text, "where the mesh was made");
  assert_int_equal(m.face_count, faces);
  abbe_mesh_free(&m);
}
