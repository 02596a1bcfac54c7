#include "tests/scenes/solids.h"

#include "scenes/mesh/shells.h"
#include "scenes/shapes/shape.h"

static abbe_result find(const abbe_mesh *m, abbe_shells *out, abbe_error *error) {
  OWNED(abbe_topology, t) = {0};
  assert_int_equal(abbe_topology_make(m, &t, NULL), ABBE_OK);
  return abbe_shells_find(m, &t, out, error);
}

static abbe_shells shells_of(const test_box *box, size_t count) {
  abbe_shells s;
  OWNED(abbe_mesh, m) = test_boxes(box, count);
  OK(find(&m, &s, &error));
  return s;
}

TEST(one_shell_is_one_solid) {
  const test_box box = {{0, 0, 0}, {1, 2, 3}, false};
  OWNED(abbe_shells, s) = shells_of(&box, 1);
  assert_int_equal(s.count, 1);
  assert_int_equal(s.solid_count, 1);
  assert_int_equal(s.crossing_count + s.self_count + s.shell[0].depth, 0);
  assert_near(s.shell[0].volume, 6, 1e-12);
  abbe_shells_free(&s);
}

/* A box, a hollow in it, a body in the hollow, and one beside them all. */
TEST(shells_nest) {
  const test_box box[4] = {{{0, 0, 0}, {9, 9, 9}, false},
                           {{1, 1, 1}, {8, 8, 8}, true},
                           {{2, 2, 2}, {3, 3, 3}, false},
                           {{20, 0, 0}, {21, 1, 1}, false}};
  OWNED(abbe_shells, s) = shells_of(box, 4);
  assert_int_equal(s.count, 4);
  assert_int_equal(s.crossing_count, 0);
  assert_int_equal(s.solid_count, 1);
  for (uint32_t i = 0; i < 4; i++) assert_int_equal(s.shell[i].depth, i == 3 ? 0 : i);
  assert_near(s.shell[1].volume, -343, 1e-9);
  assert_int_equal(s.around[s.shell[1].first], 0);
}

/* Whichever way round the shells are: that is what depths are asked for. */
TEST(nesting_does_not_hang_on_orientation) {
  for (int turned = 0; turned < 4; turned++) {
    const test_box box[2] = {{{0, 0, 0}, {9, 9, 9}, turned & 1},
                             {{1, 1, 1}, {8, 8, 8}, turned & 2}};
    OWNED(abbe_shells, s) = shells_of(box, 2);
    assert_int_equal(s.shell[0].depth, 0);
    assert_int_equal(s.shell[1].depth, 1);
  }
}

TEST(what_crosses_is_told_apart_and_where) {
  const test_box box[3] = {{{0, 0, 0}, {2, 2, 2}, false},
                           {{1, 0.5, 0.7}, {4, 1.5, 1.5}, false},
                           {{3, 0.1, 0.2}, {6, 1.9, 1.8}, false}};
  OWNED(abbe_shells, s) = shells_of(box, 3);
  assert_int_equal(s.crossing_count, 2);
  assert_int_equal(s.flush_count, 0);
  assert_int_equal(s.crossing[0][0], 0);
  assert_int_equal(s.crossing[0][1], 1);
  assert_int_equal(s.crossing[1][1], 2);
  /* a chain needs two solids: the ends are one */
  assert_int_equal(s.solid_count, 2);
  assert_int_equal(s.shell[0].solid, s.shell[2].solid);
  assert_true(s.shell[0].solid != s.shell[1].solid);
  assert_near(s.place[0], fabs(s.place[0] - 2) < fabs(s.place[0] - 3) ? 2 : 3, 1e-9);
}

/* The hollow belongs to the body around it; another body that reaches into it has none. */
TEST(a_hollow_stays_with_its_body) {
  const test_box box[3] = {{{0, 0, 0}, {9, 9, 9}, false},
                           {{2, 2, 2}, {7, 7, 7}, true},
                           {{5, 3, 3.5}, {12, 6, 6}, false}};
  OWNED(abbe_shells, s) = shells_of(box, 3);
  assert_int_equal(s.crossing_count, 2);
  assert_int_equal(s.solid_count, 2);
  assert_int_equal(s.shell[0].solid, s.shell[1].solid);
  assert_true(s.shell[2].solid != s.shell[0].solid);
}

TEST(hollows_that_cross_are_refused_with_the_place) {
  const test_box box[3] = {{{0, 0, 0}, {9, 9, 9}, false},
                           {{1, 1, 1}, {5, 5, 5}, true},
                           {{4, 2, 2.5}, {8, 4, 4.5}, true}};
  OWNED(abbe_mesh, m) = test_boxes(box, 3);
  abbe_shells s;
  REFUSED(ABBE_GEOMETRY, "hollows of the mesh cross", find(&m, &s, &error));
  assert_contains(last_error.text, "at (5, ");
  assert_null(s.shell);
}

TEST(faces_on_one_another_are_no_crossing_but_told) {
  /* back to back, cut into other triangles; and flush below */
  const test_box stacked[2] = {{{0, 0, 0}, {2, 2, 1}, false},
                               {{0.5, 0.6, 1}, {1.4, 1.5, 2}, false}};
  OWNED(abbe_shells, s) = shells_of(stacked, 2);
  assert_true(s.flush_count > 0);
  assert_int_equal(s.solid_count, 2);
  abbe_shells_free(&s);
  /* beside one another in one plane, a gap between them */
  const test_box apart[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1.1, 0, 0}, {2, 1, 1}, false}};
  s = shells_of(apart, 2);
  assert_int_equal(s.flush_count + s.crossing_count, 0);
  assert_int_equal(s.solid_count, 1);
  abbe_shells_free(&s);
  /* along an edge only */
  const test_box edge[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 1, 0}, {2, 2, 1}, false}};
  s = shells_of(edge, 2);
  assert_int_equal(s.count, 2);
  assert_int_equal(s.flush_count + s.crossing_count, 0);
  assert_int_equal(s.solid_count, 1);
}

TEST(a_surface_that_crosses_itself_is_told) {
  MADE(abbe_mesh, m, abbe_shape_ring(1, 0.3, 48, 24, &m, &error));
  MADE(abbe_shells, s, find(&m, &s, &error));
  assert_int_equal(s.self_count, 0);
  abbe_shells_free(&s);
  /* the tube is pulled through the other side of the ring */
  for (size_t v = 0; v < m.vertex_count; v++)
    if (m.position[v][0] > 0.8) m.position[v][0] -= 2.1;
  OK(find(&m, &s, &error));
  assert_true(s.self_count > 0);
  assert_true(s.self_place[0] < -0.5);
}

/* A grid of balls, of which each ninth crosses the next: as many rays and pairs as a tree saves. */
TEST(many_shells_are_told_apart) {
  enum { COUNT = 300 };
  FREED test_box *box = calloc(COUNT, sizeof *box);
  assert_non_null(box);
  for (int i = 0; i < COUNT; i++) {
    const double at[3] = {3.0 * (i % 10), 3.0 * (i / 10 % 10), 3.0 * (i / 100)};
    for (int k = 0; k < 3; k++) {
      box[i].min[k] = at[k];
      box[i].max[k] = at[k] + 1 + 0.01 * k;
    }
    if (i % 100 == 9) box[i].min[0] -= 2.5, box[i].min[1] += 0.1, box[i].min[2] += 0.1;
  }
  OWNED(abbe_shells, s) = shells_of(box, COUNT);
  assert_int_equal(s.count, COUNT);
  assert_int_equal(s.crossing_count, 3);
  assert_int_equal(s.solid_count, 2);
  for (size_t i = 0; i < COUNT; i++) assert_int_equal(s.shell[i].depth, 0);
}

/* Boxes each in the next larger one. */
static abbe_mesh nested_boxes(size_t count) {
  FREED test_box *box = calloc(count, sizeof *box);
  assert_non_null(box);
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) {
      box[i].max[k] = 1 + 0.01 * (double)i;
      box[i].min[k] = -box[i].max[k];
    }
  return test_boxes(box, count);
}

/* Every ray meets all of them: looking for one after another from the start would take minutes. */
TEST(deep_nests_take_the_square_of_their_depth) {
  enum { COUNT = 200 };
  OWNED(abbe_mesh, m) = nested_boxes(COUNT);
  MADE(abbe_shells, s, find(&m, &s, &error));
  for (uint32_t i = 0; i < COUNT; i++) assert_int_equal(s.shell[i].depth, COUNT - 1 - i);
}

/* Bars along x, all through bars along y: each pair is found, and those alike are one solid. */
TEST(all_through_all_is_two_solids) {
  enum { COUNT = 60 };
  test_box box[2 * COUNT];
  for (int i = 0; i < 2 * COUNT; i++) {
    const int along = i < COUNT ? 0 : 1;
    box[i] = (test_box){{-1, -1, 0.01 * along}, {3 * COUNT, 3 * COUNT, 1 + 0.01 * along}, false};
    box[i].min[1 - along] = 3.0 * (i % COUNT) + 0.1;
    box[i].max[1 - along] = 3.0 * (i % COUNT) + 1;
  }
  OWNED(abbe_shells, s) = shells_of(box, 2 * COUNT);
  assert_int_equal(s.crossing_count, COUNT * COUNT);
  assert_int_equal(s.solid_count, 2);
  for (size_t i = 0; i < 2 * COUNT; i++)
    assert_int_equal(s.shell[i].solid == s.shell[0].solid, i < COUNT);
}

/* The work that it refuses to exceed takes the sanitizers ten seconds, and shows them no more than
 * the nest above and the refusal of hollows do: it is left to the release build. */
#ifndef __SANITIZE_ADDRESS__
TEST(what_would_take_too_long_is_refused) {
  OWNED(abbe_mesh, m) = nested_boxes(1200);
  abbe_shells s;
  REFUSED(ABBE_UNSUPPORTED, "the 1200 parts of the mesh, of 14400 faces, lie in and through",
          find(&m, &s, &error));
  assert_null(s.shell);
}
#endif
