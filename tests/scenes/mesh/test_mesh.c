#include "tests/scenes/solids.h"

#include "scenes/geometry/transform.h"
#include "scenes/geometry/vector.h"
#include "scenes/shapes/shape.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static abbe_mesh sphere(size_t levels) {
  abbe_mesh m;
  assert_int_equal(abbe_shape_sphere(1, levels, &m, NULL), ABBE_OK);
  return m;
}

static abbe_mesh_report check(const abbe_mesh *m) {
  abbe_mesh_report r;
  assert_int_equal(abbe_mesh_check(m, &r, NULL), ABBE_OK);
  return r;
}

static void turn(abbe_mesh *m, size_t f) {
  const uint32_t second = m->face[f][1];
  m->face[f][1] = m->face[f][2];
  m->face[f][2] = second;
}

static void assert_fixes(abbe_mesh *m, const char *word) {
  char *what = NULL;
  abbe_error error = {0};
  if (abbe_mesh_fix(m, ABBE_NORMALS_SMOOTH, false, NULL, &what, &error) != ABBE_OK)
    fail_msg("%s", error.text);
  if (word) {
    assert_non_null(what);
    if (!strstr(what, word)) fail_msg("'%s' lacks '%s'", what, word);
  } else {
    assert_null(what);
  }
  free(what);
  const abbe_mesh_report r = check(m);
  assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces, 0);
  assert_true(r.volume > 0);
}

static void make_checks_sizes(void **state) {
  (void)state;
  abbe_mesh m;
  assert_int_equal(abbe_mesh_make(0, 1, false, &m, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_make(SIZE_MAX, 1, false, &m, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_make(3, ABBE_MESH_MAX_FACES + 1u, false, &m, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_null(m.position);
  abbe_mesh_free(&m);
  abbe_mesh_free(NULL);
}

static void check_counts_what_is_wrong(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  m.face_count--;
  assert_int_equal(check(&m).open_edges, 3);
  m.face_count++;
  turn(&m, 10);
  assert_int_equal(check(&m).flipped_edges, 3);
  turn(&m, 10);
  memcpy(m.face[3], m.face[4], sizeof m.face[3]);
  const abbe_mesh_report r = check(&m);
  assert_true(r.open_edges == 3 || r.open_edges == 2);
  assert_true(r.crowded_edges >= 2);
  abbe_mesh_free(&m);
}

static void a_sound_mesh_is_left_alone(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  const double(*before)[3] = (const double(*)[3])m.position;
  assert_fixes(&m, NULL);
  assert_ptr_equal(before, m.position);
  abbe_mesh_free(&m);
}

static void an_inverted_mesh_is_turned(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  for (size_t f = 0; f < m.face_count; f++) turn(&m, f);
  assert_true(check(&m).volume < 0);
  assert_fixes(&m, "inside-out part turned");
  assert_true(abbe_vector_dot(m.normal[0], m.position[0]) > 0.99);
  abbe_mesh_free(&m);
}

static void single_flipped_faces_are_turned(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  turn(&m, 0);
  turn(&m, 77);
  assert_fixes(&m, "2 faces turned");
  abbe_mesh_free(&m);
}

static void small_and_flat_holes_are_closed(void **state) {
  (void)state;
  abbe_mesh m = sphere(3);
  m.face_count--;
  assert_fixes(&m, "1 hole closed");
  assert_int_equal(m.face_count, 1280);
  abbe_mesh_free(&m);
  const double size[3] = {1, 1, 1};
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  m.face_count -= 2;
  assert_fixes(&m, "1 hole closed");
  assert_true(fabs(check(&m).volume - 1) < 1e-12);
  abbe_mesh_free(&m);
}

static void a_large_bent_hole_is_refused_and_counted(void **state) {
  (void)state;
  abbe_mesh m = sphere(3);
  m.face_count -= 200;
  abbe_error error;
  char *what = NULL;
  const abbe_mesh_report r = check(&m);
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_SMOOTH, false, NULL, &what, &error),
                   ABBE_GEOMETRY);
  assert_null(what);
  char where[160];
  snprintf(where, sizeof where,
           "%zu open edges make %zu hole%s, the widest of %zu edges, %.3g across", r.open_edges,
           r.holes, r.holes == 1 ? "" : "s", r.hole_edges, r.hole_size);
  assert_contains(error.text, where);
  snprintf(where, sizeof where, "around (%.4g, %.4g, %.4g)", r.hole[0], r.hole[1], r.hole[2]);
  assert_contains(error.text, where);
  assert_contains(error.text, "'repair: true' closes holes");
  assert_int_equal(m.face_count, 1080);
  abbe_mesh_free(&m);
}

/* The rim of a bowl, and a body with two unlike holes. */
static void holes_are_measured_and_placed(void **state) {
  (void)state;
  const test_box box = {{0, 0, 0}, {3, 2, 1}, false};
  abbe_mesh m = test_boxes(&box, 1);
  memmove(m.face, m.face + 2, 8 * sizeof *m.face); /* neither x = 0 nor z = 1 */
  m.face_count = 8;
  abbe_mesh_report r = check(&m);
  assert_int_equal(r.holes, 1); /* they meet in an edge, so that they are one */
  assert_int_equal(r.hole_edges, 6);
  assert_near(r.hole_size, 3, 1e-12);
  assert_near(r.hole[0], 1.5, 1e-12);
  abbe_mesh_free(&m);
  m = test_boxes(&box, 1);
  m.face_count = 10;
  memmove(m.face, m.face + 2, 8 * sizeof *m.face); /* x = 0 alone is gone, and z = 1 */
  m.face_count = 8;
  r = check(&m);
  assert_int_equal(r.open_edges, 6);
  abbe_mesh_free(&m);
}

/* Without being asked a bowl is no solid; repaired it is one with a lid, as small as can be. */
static void repair_closes_what_bends(void **state) {
  (void)state;
  abbe_mesh m = sphere(3);
  size_t kept = 0;
  for (size_t f = 0; f < m.face_count; f++) {
    const uint32_t *c = m.face[f];
    /* below a plane that leans, and an edge that is not round */
    double most = -1;
    for (int k = 0; k < 3; k++)
      most = fmax(most, m.position[c[k]][2] + 0.6 * m.position[c[k]][0] * m.position[c[k]][1]);
    if (most < 0.3) memmove(m.face[kept++], c, sizeof *m.face);
  }
  m.face_count = kept;
  abbe_error error = {0};
  char *what = NULL;
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, false, NULL, NULL, &error), ABBE_GEOMETRY);
  if (abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, true, NULL, &what, &error) != ABBE_OK)
    fail_msg("%s", error.text);
  assert_contains(what, "1 hole closed, 1.98 across in the mesh's own unit");
  free(what);
  const abbe_mesh_report r = check(&m);
  assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces, 0);
  assert_int_equal(r.shells, 1);
  /* of half a ball, a little more */
  assert_true(r.volume > 2.0 && r.volume < 3.2);
  assert_true(r.area > 2 * 3.14159 && r.area < 3.6 * 3.14159);
  abbe_mesh_free(&m);
}

static void faces_that_are_there_twice_are_one(void **state) {
  (void)state;
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{0, 0, 0}, {1, 1, 1}, false}};
  abbe_mesh m = test_boxes(box, 2);
  assert_fixes(&m, "12 faces that were there twice dropped");
  assert_int_equal(m.face_count, 12);
  assert_near(check(&m).volume, 1, 1e-12);
  abbe_mesh_free(&m);
}

static char *repaired(abbe_mesh *m) {
  abbe_error error = {0};
  char *what = NULL;
  if (abbe_mesh_fix(m, ABBE_NORMALS_AUTO, true, NULL, &what, &error) != ABBE_OK)
    fail_msg("%s", error.text);
  return what;
}

/* Both sides of every face are there; and two bodies share a wall. */
static void repair_drops_walls_of_faces_back_to_back(void **state) {
  (void)state;
  const test_box both[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{0, 0, 0}, {1, 1, 1}, true}};
  abbe_mesh m = test_boxes(both, 2);
  char *what = repaired(&m);
  assert_contains(what, "12 pairs of faces back to back");
  assert_int_equal(m.face_count, 12);
  assert_near(check(&m).volume, 1, 1e-12);
  free(what);
  abbe_mesh_free(&m);
  const test_box beside[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 0, 0}, {2, 1, 1}, false}};
  m = test_boxes(beside, 2);
  what = repaired(&m);
  assert_contains(what, "2 pairs of faces back to back");
  assert_int_equal(m.face_count, 20);
  assert_int_equal(check(&m).shells, 1);
  assert_near(check(&m).volume, 2, 1e-12);
  free(what);
  abbe_mesh_free(&m);
}

/* A fin on a box, and a wall of single faces across a longer one. */
static void repair_drops_sheets(void **state) {
  (void)state;
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{5, 5, 5}, {6, 6, 6}, false}};
  abbe_mesh m = test_boxes(box, 2);
  m.face[12][0] = 4, m.face[12][1] = 5, m.face[12][2] = 15;
  m.face_count = 13;
  abbe_error error = {0};
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, false, NULL, NULL, &error), ABBE_GEOMETRY);
  assert_contains(error.text,
                  "1 edge with more than two faces, one of 3 from (1, 0, 0) to (1, 0, 1)");
  assert_contains(error.text, "'repair: true'");
  char *what = repaired(&m);
  assert_contains(what, "1 sheet that hung on the body");
  assert_int_equal(m.face_count, 12);
  assert_near(check(&m).max[0], 1, 0); /* the sheet's corner is gone as well */
  free(what);
  abbe_mesh_free(&m);
  m = test_boxes(box, 2);
  m.face[12][0] = 4, m.face[12][1] = 5, m.face[12][2] = 15;
  m.face_count = 13;
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_SMOOTH, true, NULL, NULL, NULL), ABBE_OK);
  assert_int_equal(m.vertex_count, 8);
  abbe_mesh_free(&m);
  const test_box beside[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 0, 0}, {2, 1, 1}, false}};
  m = test_boxes(beside, 2);
  memmove(m.face[12], m.face[14], 10 * sizeof *m.face); /* the second one's half of the wall */
  m.face_count = 22;
  what = repaired(&m);
  assert_contains(what, "1 sheet");
  assert_int_equal(m.face_count, 20);
  assert_near(check(&m).volume, 2, 1e-12);
  free(what);
  abbe_mesh_free(&m);
}

/* A point on another's edge, as booleans of modellers leave it: a slit without a width. */
static void repair_closes_slits(void **state) {
  (void)state;
  const test_box box = {{0, 0, 0}, {1, 1, 1}, false};
  abbe_mesh corner = test_boxes(&box, 1), m;
  assert_int_equal(abbe_mesh_make(9, 13, false, &m, NULL), ABBE_OK);
  memcpy(m.position, corner.position, 8 * sizeof *m.position);
  memcpy(m.face, corner.face, 12 * sizeof *m.face);
  abbe_mesh_free(&corner);
  m.position[8][0] = 0.4, m.position[8][2] = 1; /* on the edge from 1 to 5 */
  /* the top's face at that edge is cut there, the front's is not */
  const uint32_t left[3] = {1, 8, 3}, right[3] = {8, 5, 7};
  size_t at = 0;
  for (size_t f = 0; f < 12; f++)
    if (m.face[f][0] == 1 && m.face[f][1] == 5 && m.face[f][2] == 7) at = f;
  assert_true(at > 0);
  memcpy(m.face[at], right, sizeof right);
  const uint32_t middle[3] = {1, 8, 7};
  memcpy(m.face[12], middle, sizeof middle);
  (void)left;
  assert_int_equal(check(&m).open_edges, 3);
  char *what = repaired(&m);
  const abbe_mesh_report r = check(&m);
  assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces, 0);
  assert_near(r.volume, 1, 1e-12);
  free(what);
  abbe_mesh_free(&m);
}

/* Depth is told among what does not cross: a body that reaches into another is no bubble of it. */
static void bodies_that_cross_stay_bodies(void **state) {
  (void)state;
  const test_box box[2] = {{{-1, -1, -1}, {1, 1, 1}, false},
                           {{-0.1, -0.3, -0.3}, {1.9, 0.9, 0.7}, false}};
  abbe_mesh m = test_boxes(box, 2), *part = NULL;
  size_t solids = 0, count = 0;
  char *what = NULL;
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, false, &solids, &what, NULL), ABBE_OK);
  assert_null(what);
  assert_int_equal(solids, 2);
  assert_int_equal(abbe_mesh_split(&m, &part, &count, NULL), ABBE_OK);
  assert_int_equal(count, 2);
  assert_near(check(&part[0]).volume, 8, 1e-12);
  assert_near(check(&part[1]).volume, 2 * 1.2, 1e-12);
  for (size_t i = 0; i < 2; i++) abbe_mesh_free(&part[i]);
  free(part);
  abbe_mesh_free(&m);
  m = test_boxes(box, 1);
  assert_int_equal(abbe_mesh_split(&m, &part, &count, NULL), ABBE_OK);
  assert_int_equal(count, 1);
  assert_null(part);
  abbe_mesh_free(&m);
}

static void more_solids_than_are_followed_are_refused(void **state) {
  (void)state;
  enum { COUNT = 34 };
  test_box box[COUNT];
  for (int i = 0; i < COUNT; i++) { /* each crosses all others: rods through one middle */
    const double a = 0.01 * (i + 1);
    box[i] = (test_box){{-1 - a, -a, -0.5 - a}, {1 + a, a, 0.5 + a}, false};
    if (i % 2) box[i] = (test_box){{-a, -1 - a, -0.6 + 0.5 * a}, {a, 1 + a, 0.6 - 0.5 * a}, false};
  }
  abbe_mesh m = test_boxes(box, COUNT), *part = NULL;
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
  abbe_mesh_free(&m);
}

static void a_surface_that_crosses_itself_is_said(void **state) {
  (void)state;
  abbe_mesh m;
  char *what = NULL;
  assert_int_equal(abbe_shape_ring(1, 0.3, 48, 24, &m, NULL), ABBE_OK);
  for (size_t v = 0; v < m.vertex_count; v++)
    if (m.position[v][0] > 0.8) m.position[v][0] -= 2.1;
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_SMOOTH, false, NULL, &what, NULL), ABBE_OK);
  assert_contains(what, "the surface crosses itself, in ");
  assert_contains(what, ": light may go wrong there");
  free(what);
  abbe_mesh_free(&m);
}

/* A cylinder: around it smooth, at its rims not. */
static void normals_by_angles_keep_creases(void **state) {
  (void)state;
  const double profile[4][2] = {{0, 0}, {1, 0}, {1, 2}, {0, 2}};
  abbe_mesh m;
  assert_int_equal(abbe_shape_lathe(profile, 4, 24, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_compute_normals(&m, ABBE_NORMALS_AUTO, NULL), ABBE_OK);
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
  abbe_mesh_free(&m);
}

static void degenerate_faces_are_fixed(void **state) {
  (void)state;
  abbe_mesh m;
  /* a box whose top has a vertex in the middle of one edge: one face without area beside it */
  const double at[9][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  {0, 0, 1},
                           {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0, 1}};
  const uint32_t face[16][3] = {{0, 2, 1}, {0, 3, 2}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6},
                                {3, 0, 4}, {3, 4, 7}, {0, 1, 5}, {0, 5, 4}, {4, 5, 8}, {4, 8, 7},
                                {8, 5, 6}, {8, 6, 7}, {0, 0, 1}, {6, 7, 7}};
  assert_int_equal(abbe_mesh_make(9, 16, false, &m, NULL), ABBE_OK);
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  assert_int_equal(check(&m).degenerate_faces, 3);
  assert_int_equal(check(&m).open_edges, 0);
  assert_fixes(&m, "1 face without area split away");
  assert_true(fabs(check(&m).volume - 1) < 1e-12);
  abbe_mesh_free(&m);
}

/* Two shells in one mesh: b is moved into a. */
static abbe_mesh joined(abbe_mesh *a, abbe_mesh *b) {
  abbe_mesh m;
  assert_int_equal(abbe_mesh_make(a->vertex_count + b->vertex_count, a->face_count + b->face_count,
                                  false, &m, NULL),
                   ABBE_OK);
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

static void a_bubble_faces_into_itself(void **state) {
  (void)state;
  abbe_mesh outer = sphere(2), inner;
  assert_int_equal(abbe_shape_sphere(0.5, 2, &inner, NULL), ABBE_OK);
  const double whole = check(&outer).volume, hole = check(&inner).volume;
  abbe_mesh m = joined(&outer, &inner);
  assert_int_equal(check(&m).shells, 2);
  assert_fixes(&m, "1 inside-out part");
  assert_true(fabs(check(&m).volume - (whole - hole)) < 1e-12);
  assert_fixes(&m, NULL);
  const double in_glass[3] = {0.7, 0.1, 0.1}, in_bubble[3] = {0.1, 0.2, 0.1}, out[3] = {2, 0, 0};
  assert_true(abbe_mesh_contains(&m, in_glass));
  assert_false(abbe_mesh_contains(&m, in_bubble));
  assert_false(abbe_mesh_contains(&m, out));
  abbe_mesh_free(&m);
}

static void subdivision_keeps_a_mesh_closed_and_smooth(void **state) {
  (void)state;
  abbe_mesh m;
  const double size[3] = {1, 1, 1};
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_subdivide(&m, 3, NULL), ABBE_OK);
  assert_int_equal(m.face_count, 12 * 64);
  assert_int_equal(check(&m).open_edges, 0);
  assert_true(check(&m).volume > 0.2 && check(&m).volume < 0.9);
  abbe_error error;
  assert_int_equal(abbe_mesh_subdivide(&m, 60, &error), ABBE_INVALID_ARGUMENT);
  abbe_mesh_free(&m);
  assert_int_equal(abbe_shape_rectangle(1, 1, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_subdivide(&m, 2, NULL), ABBE_OK);
  assert_int_equal(m.face_count, 32);
  for (size_t v = 0; v < m.vertex_count; v++) assert_true(m.normal[v][2] == 1);
  abbe_mesh_free(&m);
}

/* Every vertex that is left lies on the sphere, so what is off are the faces' middles. */
static void simplifying_keeps_within_the_distance(void **state) {
  (void)state;
  abbe_mesh m = sphere(6), few;
  size_t last = m.face_count;
  for (double within = 1e-3; within < 0.05; within *= 10) {
    uint32_t(*face)[3] = NULL;
    size_t count = 0;
    double farthest = 0;
    assert_int_equal(abbe_mesh_simplify(&m, within, &face, &count, NULL), ABBE_OK);
    assert_true(count > 20 && 3 * count < 2 * last);
    last = count;
    for (size_t f = 0; f < count; f++) {
      double middle[3] = {0};
      for (int k = 0; k < 9; k++) {
        assert_true(face[f][k / 3] < m.vertex_count);
        middle[k % 3] += m.position[face[f][k / 3]][k % 3] / 3;
      }
      farthest = fmax(farthest, 1 - abbe_vector_length(middle));
    }
    assert_true(farthest > 0.1 * within && farthest < 4 * within);
    assert_int_equal(abbe_mesh_make(m.vertex_count, count, false, &few, NULL), ABBE_OK);
    memcpy(few.position, m.position, m.vertex_count * sizeof *m.position);
    memcpy(few.face, face, count * sizeof *face);
    const abbe_mesh_report r = check(&few);
    assert_int_equal(r.open_edges + r.flipped_edges + r.degenerate_faces, 0);
    assert_true(1000 * r.crowded_edges < count);
    assert_true(r.volume > 0 && fabs(r.volume - 4.18879) < 4 * 12.6 * within + 0.01);
    abbe_mesh_free(&few);
    free(face);
  }
  abbe_mesh_free(&m);
}

static void simplifying_a_faceted_mesh_holds_its_edges(void **state) {
  (void)state;
  const double size[3] = {1, 2, 3};
  abbe_mesh m;
  uint32_t(*face)[3] = NULL;
  size_t count = 0;
  abbe_error error;
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_simplify(&m, 0.01, &face, &count, NULL), ABBE_OK);
  assert_int_equal(count, m.face_count);
  free(face);
  assert_int_equal(abbe_mesh_simplify(&m, 0, &face, &count, NULL), ABBE_OK);
  assert_int_equal(count, m.face_count);
  assert_memory_equal(face, m.face, count * sizeof *face);
  free(face);
  assert_int_equal(abbe_mesh_simplify(&m, -1, &face, &count, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_simplify(&m, NAN, &face, &count, &error), ABBE_INVALID_ARGUMENT);
  assert_null(face);
  abbe_mesh_free(&m);
}

static void subdividing_an_octahedron_weights_the_limit_right(void **state) {
  (void)state;
  /* Loop on a regular octahedron by hand: a corner (valence 4, beta 3/32) goes from 1 to 5/8 */
  const double at[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const uint32_t face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                               {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  abbe_mesh m;
  assert_int_equal(abbe_mesh_make(6, 8, false, &m, NULL), ABBE_OK);
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  assert_int_equal(abbe_mesh_subdivide(&m, 1, NULL), ABBE_OK);
  assert_int_equal(m.vertex_count, 18);
  size_t corners = 0, middles = 0;
  for (size_t v = 0; v < 18; v++) {
    const double r = abbe_vector_length(m.position[v]);
    corners += fabs(r - 0.625) < 1e-12;
    middles += fabs(r - 0.375 * sqrt(2)) < 1e-12;
  }
  assert_int_equal(corners, 6);
  assert_int_equal(middles, 12);
  abbe_mesh_free(&m);
}

static void transforms_mirror_and_keep_outwards(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  const double factor[3] = {-1, 2, 1}, offset[3] = {5, 0, 0}, flat[3] = {1, 0, 1};
  double scale[16], move[16];
  abbe_transform_scale(factor, scale);
  abbe_transform_translate(offset, move);
  abbe_transform_multiply(move, scale, scale);
  assert_int_equal(abbe_mesh_transform(&m, scale, NULL), ABBE_OK);
  assert_true(check(&m).volume > 0);
  assert_true(fabs(check(&m).max[0] - 6) < 0.02);
  for (size_t f = 0; f < m.face_count; f++) {
    double n[3];
    abbe_vector_triangle(m.position[m.face[f][0]], m.position[m.face[f][1]],
                         m.position[m.face[f][2]], n);
    assert_true(abbe_vector_dot(n, m.normal[m.face[f][0]]) > 0);
  }
  abbe_transform_scale(flat, scale);
  assert_int_equal(abbe_mesh_transform(&m, scale, NULL), ABBE_INVALID_ARGUMENT);
  abbe_mesh_free(&m);
}

static void write_text(const char *path, const char *text) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
  assert_int_equal(fclose(f), 0);
}

static const char tetrahedron_obj[] = "v 0 0 0\nv 1e-5 0 0\nv 0 1e-5 0\nv 0 0 1e-5\n"
                                      "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
static const char tetrahedron_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
static const char tetrahedron_stl[] =
    "solid t\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "endsolid t\n";
/* positions, then indices 0 2 1, 0 1 3, 1 2 3, 2 0 3 as 16-bit numbers */
static const char tetrahedron_gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2]}],\"meshes\":[{\"primitives\":[{\"attributes\":"
    "{\"POSITION\":0},\"indices\":1}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,"
    "\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,"
    "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"buffers\":[{"
    "\"byteLength\":72,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
    "AAACAAEAAAABAAMAAQACAAMAAgAAAAMA\"}]}";

static void loads_tetrahedra(void **state) {
  (void)state;
  static const struct {
    const char *path, *text;
    double volume;
  } files[] = {{"t_mesh.obj", tetrahedron_obj, 1e-15 / 6},
               {"t_mesh.ply", tetrahedron_ply, 1.0 / 6},
               {"t_mesh.stl", tetrahedron_stl, 1.0 / 6},
               {"t_mesh.gltf", tetrahedron_gltf, 8.0 / 6}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    abbe_error error = {0};
    write_text(files[i].path, files[i].text);
    for (int smooth = 0; smooth < 2; smooth++) {
      if (abbe_mesh_load(files[i].path, smooth ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_FLAT, &m, NULL,
                         &error) != ABBE_OK)
        fail_msg("%s", error.text);
      assert_int_equal(m.face_count, 4);
      assert_int_equal(m.vertex_count, smooth ? 4 : 12);
      assert_int_equal(check(&m).open_edges, 0);
      assert_true(fabs(check(&m).volume / files[i].volume - 1) < 1e-6);
      abbe_mesh_free(&m);
    }
    unlink(files[i].path);
  }
}

static void bad_files_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *path, *text;
  } files[] = {
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"},
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"bad_mesh.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n0 0 0\n1 0 0\n"},
      {"bad_mesh.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"bad_mesh.obj", ""},
      {"bad_mesh.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                       "end_header\n0\n"},
      {"bad_mesh.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                       "property float y\nproperty float z\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\nabc"},
      {"bad_mesh.stl", "solid nothing\n"},
      {"bad_mesh.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[7]}]}"},
      {"bad_mesh.gltf", "{not json"},
      {"bad_mesh.glb", "glTF\2"},
      {"bad_mesh.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
       "\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
       "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2000000000,\"type\":"
       "\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":12}],\"buffers\":[{"
       "\"byteLength\":12,\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA\"}]}"},
      {"bad_mesh.fbx", "no"},
      {"bad_mesh", "no"},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    abbe_error error = {0};
    write_text(files[i].path, files[i].text);
    if (abbe_mesh_load(files[i].path, ABBE_NORMALS_AUTO, &m, NULL, &error) == ABBE_OK)
      fail_msg("file %zu (%s) was read", i, files[i].path);
    assert_contains(error.text, files[i].path);
    /* points and lines alone */
    if (i >= 1 && i <= 3) assert_contains(error.text, "no faces were read from it");
    assert_null(m.face);
    unlink(files[i].path);
  }
  abbe_mesh m;
  abbe_error error;
  assert_int_equal(abbe_mesh_load("no_such_file.obj", ABBE_NORMALS_AUTO, &m, NULL, &error),
                   ABBE_IO);
}

static abbe_mesh load(const char *path, const char *text, abbe_mesh_normals normals) {
  abbe_mesh m;
  abbe_error error = {0};
  write_text(path, text);
  if (abbe_mesh_load(path, normals, &m, NULL, &error) != ABBE_OK) fail_msg("%s", error.text);
  unlink(path);
  return m;
}

/* Normals of no good length, one against its face, one that grazes it and one that is none. */
static const char normals_obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                  "vn 0 0 -2\nvn 0.6 0 -0.8\nvn 0.6 0 0.8\nvn 1 0 0\nvn 0 0 0\n"
                                  "f 1//1 3//2 2//3\nf 1//4 2//5 4//1\nf 1//1 4//1 3//1\n"
                                  "f 2//1 3//1 4//1\n";

/* Scanners leave points that no face names: they are no part of its bounds. */
static void points_without_faces_are_left_out(void **state) {
  (void)state;
  abbe_mesh m = load("t_far.ply",
                     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                     "property float y\nproperty float z\nelement face 1\n"
                     "property list uchar int vertex_indices\nend_header\n"
                     "0 0 0\n9 9 9\n1 0 0\n0 1 0\n3 0 2 3\n",
                     ABBE_NORMALS_SMOOTH);
  assert_int_equal(m.vertex_count, 3);
  assert_near(check(&m).max[2], 0, 0);
  abbe_mesh_free(&m);
}

static void a_file_s_normals_are_its_default(void **state) {
  (void)state;
  abbe_mesh m = load("t_normals.obj", normals_obj, ABBE_NORMALS_AUTO);
  assert_true(m.given_normals);
  const double *a = m.normal[m.face[0][0]], *b = m.normal[m.face[0][1]],
               *c = m.normal[m.face[0][2]];
  assert_near(a[2], -1, 1e-6);
  assert_near(b[0], 0.6, 1e-6);
  assert_near(c[2], -0.8, 1e-6); /* turned to its face's side */
  assert_near(c[0], -0.6, 1e-6);
  assert_near(m.normal[m.face[1][0]][1], -1, 1e-6); /* the face's own */
  assert_near(m.normal[m.face[1][1]][1], -1, 1e-6);
  abbe_mesh_free(&m);
  m = load("t_normals.obj", normals_obj, ABBE_NORMALS_FLAT);
  assert_false(m.given_normals);
  assert_near(m.normal[m.face[0][1]][2], -1, 1e-12);
  abbe_mesh_free(&m);
  /* an STL's are those of its faces, right or wrong */
  m = load("t_normals.stl", tetrahedron_stl, ABBE_NORMALS_AUTO);
  assert_false(m.given_normals);
  abbe_mesh_free(&m);
}

/* The lid of a box is missing: fixed, all that was there has the file's normals, the lid has its
 * own. */
static void fixing_keeps_given_normals(void **state) {
  (void)state;
  const test_box box = {{0, 0, 0}, {1, 1, 1}, false};
  abbe_mesh m = test_boxes(&box, 1), whole = test_boxes(&box, 1); /* smooth, as if a file said so */
  char *what = NULL;
  m.given_normals = true;
  m.face_count = 10;
  for (size_t f = 0; f < 10; f++) turn(&m, f); /* and inside out */
  assert_int_equal(abbe_mesh_fix(&m, ABBE_NORMALS_AUTO, false, NULL, &what, NULL), ABBE_OK);
  assert_contains(what, "hole closed");
  free(what);
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
  abbe_mesh_free(&whole);
  abbe_mesh_free(&m);
}

static void smooth_normals_are_shared_across_split_vertices(void **state) {
  (void)state;
  const double size[3] = {1, 1, 1};
  abbe_mesh m;
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_compute_normals(&m, ABBE_NORMALS_SMOOTH, NULL), ABBE_OK);
  assert_int_equal(m.vertex_count, 24);
  for (size_t v = 0; v < 24; v++)
    assert_true(abbe_vector_dot(m.normal[v], m.position[v]) > 0.8 * sqrt(0.75));
  abbe_mesh_free(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(make_checks_sizes),
      cmocka_unit_test(check_counts_what_is_wrong),
      cmocka_unit_test(a_sound_mesh_is_left_alone),
      cmocka_unit_test(an_inverted_mesh_is_turned),
      cmocka_unit_test(single_flipped_faces_are_turned),
      cmocka_unit_test(small_and_flat_holes_are_closed),
      cmocka_unit_test(a_large_bent_hole_is_refused_and_counted),
      cmocka_unit_test(degenerate_faces_are_fixed),
      cmocka_unit_test(a_bubble_faces_into_itself),
      cmocka_unit_test(subdivision_keeps_a_mesh_closed_and_smooth),
      cmocka_unit_test(subdividing_an_octahedron_weights_the_limit_right),
      cmocka_unit_test(transforms_mirror_and_keep_outwards),
      cmocka_unit_test(simplifying_keeps_within_the_distance),
      cmocka_unit_test(simplifying_a_faceted_mesh_holds_its_edges),
      cmocka_unit_test(loads_tetrahedra),
      cmocka_unit_test(bad_files_are_refused),
      cmocka_unit_test(holes_are_measured_and_placed),
      cmocka_unit_test(repair_closes_what_bends),
      cmocka_unit_test(faces_that_are_there_twice_are_one),
      cmocka_unit_test(repair_drops_walls_of_faces_back_to_back),
      cmocka_unit_test(repair_drops_sheets),
      cmocka_unit_test(repair_closes_slits),
      cmocka_unit_test(bodies_that_cross_stay_bodies),
      cmocka_unit_test(more_solids_than_are_followed_are_refused),
      cmocka_unit_test(a_surface_that_crosses_itself_is_said),
      cmocka_unit_test(normals_by_angles_keep_creases),
      cmocka_unit_test(points_without_faces_are_left_out),
      cmocka_unit_test(a_file_s_normals_are_its_default),
      cmocka_unit_test(fixing_keeps_given_normals),
      cmocka_unit_test(smooth_normals_are_shared_across_split_vertices),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
