/* What abbe_mesh_fix does, and what it refuses. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/shapes/shape.h"
#include "tests/scenes/solids.h"

static void assert_fixes(abbe_mesh *m, const char *word) {
  FREED char *what = NULL;
  OK(abbe_mesh_fix(m, ABBE_NORMALS_SMOOTH, NULL, &what, &error));
  if (word) {
    assert_non_null(what);
    if (!strstr(what, word)) fail_msg("'%s' lacks '%s'", what, word);
  } else {
    assert_null(what);
  }
  const abbe_mesh_report r = test_mesh_faults(m);
  assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces, 0);
  assert_true(r.volume > 0);
}

TEST(a_sound_mesh_is_left_alone) {
  OWNED(abbe_mesh, m) = test_sphere(2);
  const double(*before)[3] = (const double(*)[3])m.position;
  assert_fixes(&m, NULL);
  assert_ptr_equal(before, m.position);
}

/* Faces with corners of their own, each rounded in another way by up to `off` of the size. */
static abbe_mesh torn_sphere(double off) {
  OWNED(abbe_mesh, whole) = test_sphere(2);
  abbe_mesh m;
  uint32_t random = 1;
  OK(abbe_mesh_make(3 * whole.face_count, whole.face_count, false, &m, &error));
  for (size_t f = 0; f < whole.face_count; f++)
    for (size_t k = 0; k < 3; k++) {
      const size_t v = 3 * f + k;
      m.face[f][k] = (uint32_t)v;
      for (int i = 0; i < 3; i++) {
        random = random * 1664525u + 1013904223u;
        m.position[v][i] = whole.position[whole.face[f][k]][i] +
                           off * sqrt(12) / sqrt(3) * ((double)random / 4294967296.0 - 0.5);
        m.normal[v][i] = whole.normal[whole.face[f][k]][i];
      }
    }
  return m;
}

TEST(corners_that_lie_a_little_apart_are_joined) {
  static const double off[] = {1e-9, 1e-7, 1e-6, 1e-5};
  for (size_t i = 0; i < sizeof off / sizeof *off; i++) {
    OWNED(abbe_mesh, m) = torn_sphere(off[i]);
    assert_int_equal(test_mesh_faults(&m).open_edges > 0, off[i] > 1e-8);
    assert_fixes(&m, off[i] > 1e-8 ? "corners joined that lay up to" : NULL);
    assert_near(test_mesh_faults(&m).volume, 4.0 / 3 * 3.14159265, 0.2);
  }
  /* farther apart than that they are another mesh's business */
  OWNED(abbe_mesh, m) = torn_sphere(1e-2);
  REFUSED(ABBE_GEOMETRY, "so it has no inside to refract in",
          abbe_mesh_fix(&m, ABBE_NORMALS_SMOOTH, NULL, NULL, &error));
}

TEST(an_inverted_mesh_is_turned) {
  OWNED(abbe_mesh, m) = test_sphere(2);
  for (size_t f = 0; f < m.face_count; f++) test_turn_face(&m, f);
  assert_true(test_mesh_faults(&m).volume < 0);
  assert_fixes(&m, "inside-out part turned");
  assert_true(abbe_vector_dot(m.normal[0], m.position[0]) > 0.99);
}

TEST(single_flipped_faces_are_turned) {
  OWNED(abbe_mesh, m) = test_sphere(2);
  test_turn_face(&m, 0);
  test_turn_face(&m, 77);
  assert_fixes(&m, "2 faces turned");
}

TEST(small_and_flat_holes_are_closed) {
  OWNED(abbe_mesh, m) = test_sphere(3);
  m.face_count--;
  assert_fixes(&m, "1 hole closed");
  assert_int_equal(m.face_count, 1280);
  abbe_mesh_free(&m);
  const double size[3] = {1, 1, 1};
  OK(abbe_shape_box(size, &m, &error));
  m.face_count -= 2;
  assert_fixes(&m, "1 hole closed");
  assert_true(fabs(test_mesh_faults(&m).volume - 1) < 1e-12);
}

TEST(a_large_bent_hole_is_refused_and_counted) {
  OWNED(abbe_mesh, m) = test_sphere(3);
  m.face_count -= 200;
  char *what = NULL;
  const abbe_mesh_report r = test_mesh_faults(&m);
  REFUSED(ABBE_GEOMETRY, "the mesh is not a closed, consistently",
          abbe_mesh_fix(&m, ABBE_NORMALS_SMOOTH, NULL, &what, &error));
  assert_null(what);
  assert_contains(last_error.text,
                  printed("%zu open edges make %zu hole%s, the widest of %zu edges, %.3g across",
                          r.open_edges, r.holes, r.holes == 1 ? "" : "s", r.hole_edges,
                          r.hole_size));
  assert_contains(last_error.text,
                  printed("around (%.4g, %.4g, %.4g)", r.hole[0], r.hole[1], r.hole[2]));
  assert_contains(last_error.text, "fill its holes in a modeller");
  assert_int_equal(m.face_count, 1080);
}

/* The rim of a bowl, and a body with two unlike holes. */
TEST(holes_are_measured_and_placed) {
  const test_box box = {{0, 0, 0}, {3, 2, 1}, false};
  OWNED(abbe_mesh, m) = test_boxes(&box, 1);
  memmove(m.face, m.face + 2, 8 * sizeof *m.face); /* neither x = 0 nor z = 1 */
  m.face_count = 8;
  abbe_mesh_report r = test_mesh_faults(&m);
  assert_int_equal(r.holes, 1); /* they meet in an edge, so that they are one */
  assert_int_equal(r.hole_edges, 6);
  assert_near(r.hole_size, 3, 1e-12);
  assert_near(r.hole[0], 1.5, 1e-12);
  abbe_mesh_free(&m);
  m = test_boxes(&box, 1);
  m.face_count = 10;
  memmove(m.face, m.face + 2, 8 * sizeof *m.face); /* x = 0 alone is gone, and z = 1 */
  m.face_count = 8;
  r = test_mesh_faults(&m);
  assert_int_equal(r.open_edges, 6);
}

TEST(faces_that_are_there_twice_are_one) {
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{0, 0, 0}, {1, 1, 1}, false}};
  OWNED(abbe_mesh, m) = test_boxes(box, 2);
  assert_fixes(&m, "12 faces that were there twice dropped");
  assert_int_equal(m.face_count, 12);
  assert_near(test_mesh_faults(&m).volume, 1, 1e-12);
}

/* A fin on a box: whether it is to go or to be a body is for whoever made it. */
TEST(sheets_are_refused) {
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{5, 5, 5}, {6, 6, 6}, false}};
  OWNED(abbe_mesh, m) = test_boxes(box, 2);
  m.face[12][0] = 4, m.face[12][1] = 5, m.face[12][2] = 15;
  m.face_count = 13;
  REFUSED(ABBE_GEOMETRY, "1 edge with more than two faces, one of 3 from (1, 0, 0) to (1, 0, 1)",
          abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, NULL, NULL, &error));
  assert_contains(last_error.text, "sheets that hang on a body");
  assert_int_equal(m.face_count, 13);
}

/* Depth is told among what does not cross: a body that reaches into another is no bubble of it. */
TEST(bodies_that_cross_stay_bodies) {
  const test_box box[2] = {{{-1, -1, -1}, {1, 1, 1}, false},
                           {{-0.1, -0.3, -0.3}, {1.9, 0.9, 0.7}, false}};
  OWNED(abbe_mesh, m) = test_boxes(box, 2);
  abbe_mesh *part = NULL;
  size_t solids = 0, count = 0;
  char *what = NULL;
  OK(abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, &solids, &what, &error));
  assert_null(what);
  assert_int_equal(solids, 2);
  OK(abbe_mesh_split(&m, &part, &count, &error));
  assert_int_equal(count, 2);
  assert_near(test_mesh_faults(&part[0]).volume, 8, 1e-12);
  assert_near(test_mesh_faults(&part[1]).volume, 2 * 1.2, 1e-12);
  for (size_t i = 0; i < 2; i++) abbe_mesh_free(&part[i]);
  free(part);
  abbe_mesh_free(&m);
  m = test_boxes(box, 1);
  OK(abbe_mesh_split(&m, &part, &count, &error));
  assert_int_equal(count, 1);
  assert_null(part);
}

TEST(more_solids_than_are_followed_are_refused) {
  enum { COUNT = 34 };
  test_box box[COUNT];
  for (int i = 0; i < COUNT; i++) { /* each crosses all others: rods through one middle */
    const double a = 0.01 * (i + 1);
    box[i] = (test_box){{-1 - a, -a, -0.5 - a}, {1 + a, a, 0.5 + a}, false};
    if (i % 2) box[i] = (test_box){{-a, -1 - a, -0.6 + 0.5 * a}, {a, 1 + a, 0.6 - 0.5 * a}, false};
  }
  OWNED(abbe_mesh, m) = test_boxes(box, COUNT);
  abbe_mesh *part = NULL;
  size_t count = 0;
  abbe_error error = {0};
  const abbe_result result = abbe_mesh_split(&m, &part, &count, &error);
  if (result == ABBE_OK) {
    assert_true(count <= ABBE_MESH_MAX_SOLIDS);
    for (size_t i = 0; i < count; i++) abbe_mesh_free(&part[i]);
    free(part);
  } else {
    assert_int_equal(result, ABBE_UNSUPPORTED);
    assert_contains(error.text, "at most 32");
  }
}

TEST(a_surface_that_crosses_itself_is_said) {
  FREED char *what = NULL;
  MADE(abbe_mesh, m, abbe_shape_ring(1, 0.3, 48, 24, &m, &error));
  for (size_t v = 0; v < m.vertex_count; v++)
    if (m.position[v][0] > 0.8) m.position[v][0] -= 2.1;
  OK(abbe_mesh_fix(&m, ABBE_NORMALS_SMOOTH, NULL, &what, &error));
  assert_contains(what, "the surface crosses itself, in ");
  assert_contains(what, ": light may go wrong there");
}

/* A cylinder: around it smooth, at its rims not. */
TEST(normals_by_angles_keep_creases) {
  const double profile[4][2] = {{0, 0}, {1, 0}, {1, 2}, {0, 2}};
  MADE(abbe_mesh, m, abbe_shape_lathe(profile, 4, 24, &m, &error));
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_AUTO, &error));
  assert_int_equal(m.vertex_count, 24 * 4 + 2);
  for (size_t v = 0; v < m.vertex_count; v++) {
    const double *p = m.position[v], *n = m.normal[v];
    if (n[2] > 0.5)
      assert_near(n[2], 1, 1e-12);
    else if (n[2] < -0.5)
      assert_near(n[2], -1, 1e-12);
    else
      assert_near(n[0] * p[0] + n[1] * p[1], 1, 1e-9);
  }
}

TEST(degenerate_faces_are_fixed) {
  /* a box whose top has a vertex in the middle of one edge: one face without area beside it */
  const double at[9][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  {0, 0, 1},
                           {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0, 1}};
  const uint32_t face[16][3] = {{0, 2, 1}, {0, 3, 2}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6},
                                {3, 0, 4}, {3, 4, 7}, {0, 1, 5}, {0, 5, 4}, {4, 5, 8}, {4, 8, 7},
                                {8, 5, 6}, {8, 6, 7}, {0, 0, 1}, {6, 7, 7}};
  MADE(abbe_mesh, m, abbe_mesh_make(9, 16, false, &m, &error));
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  assert_int_equal(test_mesh_faults(&m).degenerate_faces, 3);
  assert_int_equal(test_mesh_faults(&m).open_edges, 0);
  assert_fixes(&m, "1 face without area split away");
  assert_true(fabs(test_mesh_faults(&m).volume - 1) < 1e-12);
}

/* Two shells in one mesh: b is moved into a. */
static abbe_mesh joined(abbe_mesh *a, abbe_mesh *b) {
  abbe_mesh m;
  OK(abbe_mesh_make(a->vertex_count + b->vertex_count, a->face_count + b->face_count, false, &m,
                    &error));
  memcpy(m.position, a->position, a->vertex_count * sizeof *a->position);
  memcpy(m.position + a->vertex_count, b->position, b->vertex_count * sizeof *b->position);
  memcpy(m.face, a->face, a->face_count * sizeof *a->face);
  for (size_t f = 0; f < b->face_count; f++)
    for (int k = 0; k < 3; k++)
      m.face[a->face_count + f][k] = (uint32_t)a->vertex_count + b->face[f][k];
  abbe_mesh_free(a);
  abbe_mesh_free(b);
  return m;
}

TEST(a_bubble_faces_into_itself) {
  abbe_mesh outer = test_sphere(2), inner;
  OK(abbe_shape_sphere(0.5, 2, &inner, &error));
  const double whole = test_mesh_faults(&outer).volume, hole = test_mesh_faults(&inner).volume;
  OWNED(abbe_mesh, m) = joined(&outer, &inner);
  assert_int_equal(test_mesh_faults(&m).shells, 2);
  assert_fixes(&m, "1 inside-out part");
  assert_true(fabs(test_mesh_faults(&m).volume - (whole - hole)) < 1e-12);
  assert_fixes(&m, NULL);
  const double in_glass[3] = {0.7, 0.1, 0.1}, in_bubble[3] = {0.1, 0.2, 0.1}, out[3] = {2, 0, 0};
  assert_true(abbe_mesh_contains(&m, in_glass));
  assert_false(abbe_mesh_contains(&m, in_bubble));
  assert_false(abbe_mesh_contains(&m, out));
}

/* The lid of a box is missing: fixed, all that was there has the file's normals, the lid has its
 * own. */
TEST(fixing_keeps_given_normals) {
  const test_box box = {{0, 0, 0}, {1, 1, 1}, false};
  OWNED(abbe_mesh, m) = test_boxes(&box, 1),
                   whole = test_boxes(&box, 1); /* smooth, as if a file said so */
  FREED char *what = NULL;
  m.given_normals = true;
  m.face_count = 10;
  for (size_t f = 0; f < 10; f++) test_turn_face(&m, f); /* and inside out */
  OK(abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, NULL, &what, &error));
  assert_contains(what, "hole closed");
  assert_true(m.given_normals);
  for (size_t f = 0; f < 10; f++)
    for (int k = 0; k < 3; k++) {
      const double *p = m.position[m.face[f][k]], *n = m.normal[m.face[f][k]];
      for (size_t v = 0; v < whole.vertex_count; v++)
        if (memcmp(whole.position[v], p, sizeof whole.position[v]) == 0)
          for (int i = 0; i < 3; i++) assert_near(n[i], whole.normal[v][i], 1e-12);
    }
  for (size_t f = 10; f < m.face_count; f++)
    for (int k = 0; k < 3; k++) assert_near(m.normal[m.face[f][k]][2], 1, 1e-9);
}
