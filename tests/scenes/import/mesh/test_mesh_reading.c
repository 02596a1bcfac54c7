/* Prisms over concave polygons, as OBJ and as PLY: closed, of known volume and area, and nothing to
 * be said about them. */
#include "tests/scenes/import/mesh/meshes.h"
#include "tests/scenes/import/mesh/polygons.h"

#include "base/number.h"

/* Lists grow to what is added at once, and to what the largest mesh has. */
TEST(lists_have_an_end) {
  static const double many[1000] = {1, 2};
  const size_t most = 3 * (size_t)ABBE_MESH_MAX_FACES;
  abbe_mesh_list list = {0};
  assert_true(abbe_mesh_list_add(&list, 1000, sizeof *many, many));
  assert_true(list.capacity >= 1000);
  assert_memory_equal(list.item, many, sizeof many);
  assert_false(abbe_mesh_list_add(&list, most - 999, sizeof *many, many));
  assert_int_equal(list.count, 1000);
  free(list.item);
  abbe_mesh mesh;
  REFUSED(ABBE_UNSUPPORTED, "stone: meshes are read from .obj, .ply",
          abbe_mesh_load("stone", ABBE_NORMALS_FLAT, &mesh, NULL, &error));
}

typedef struct text {
  char data[1 << 16];
  size_t size;
} text;

static void add(text *t, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int length =
      abbe_number_format_list(t->data + t->size, sizeof t->data - t->size, format, arguments);
  va_end(arguments);
  assert_true(length >= 0 && (size_t)length < sizeof t->data - t->size);
  t->size += (size_t)length;
}

static void add_polygon(text *t, bool obj, const size_t *corner, size_t count) {
  if (obj) add(t, "f");
  if (!obj) add(t, "%zu", count);
  for (size_t i = 0; i < count; i++) add(t, " %zu", corner[i] + obj);
  add(t, "\n");
}

/* Of height 1, turned by a frame and rounded to so many digits. */
static void write_prism(const test_polygon *p, const double frame[9], int digits, bool obj,
                        text *t) {
  size_t corner[TEST_POLYGON_MOST];
  t->size = 0;
  if (!obj)
    add(t,
        "ply\nformat ascii 1.0\nelement vertex %zu\nproperty float x\nproperty float y\n"
        "property float z\nelement face %zu\nproperty list uint int vertex_indices\nend_header\n",
        2 * p->count, 2 + p->count);
  for (int z = 0; z < 2; z++)
    for (size_t i = 0; i < p->count; i++) {
      if (obj) add(t, "v");
      for (int k = 0; k < 3; k++)
        add(t, " %.*g", digits,
            frame[3 * k] * p->at[i][0] + frame[3 * k + 1] * p->at[i][1] + frame[3 * k + 2] * z);
      add(t, "\n");
    }
  for (size_t i = 0; i < p->count; i++) corner[i] = p->count - 1 - i;
  add_polygon(t, obj, corner, p->count);
  for (size_t i = 0; i < p->count; i++) corner[i] = p->count + i;
  add_polygon(t, obj, corner, p->count);
  for (size_t i = 0; i < p->count; i++) {
    const size_t next = (i + 1) % p->count, side[4] = {i, next, p->count + next, p->count + i};
    add_polygon(t, obj, side, 4);
  }
}

static double length_around(const test_polygon *p) {
  double sum = 0;
  for (size_t i = 0; i < p->count; i++) {
    const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
    sum += hypot(b[0] - a[0], b[1] - a[1]);
  }
  return sum;
}

static void check(const test_polygon *p, const double frame[9], int digits, double tolerance) {
  static text t;
  for (int obj = 0; obj < 2; obj++) {
    abbe_mesh_report r;
    char *what = NULL;
    write_prism(p, frame, digits, obj, &t);
    MADE(abbe_mesh, m,
         test_read(obj ? abbe_obj_read : abbe_ply_read, "t", NULL, t.data, t.size, &m));
    assert_int_equal(m.face_count, 4 * p->count - 4);
    OK(abbe_mesh_check(&m, &r, &error));
    assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces, 0);
    assert_near(r.volume, p->area, tolerance * p->area);
    const double area = 2 * p->area + length_around(p);
    assert_near(r.area, area, tolerance * area);
    OK(abbe_mesh_fix(&m, ABBE_NORMALS_FLAT, NULL, &what, &error));
    if (what != NULL) fail_msg("%s", what);
  }
}

static const double upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
/* Turned by a third of a right angle about two axes. */
static const double tilted[9] = {
    0.86602540378443865, -0.25, 0.43301270189221932, 0.5, 0.43301270189221932, -0.75, 0,
    0.86602540378443865, 0.5};

TEST(known_prisms_are_right) {
  const test_polygon l = {.at = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 6, 3};
  test_polygon p[6];
  p[0] = l;
  test_comb(5, &p[1]);
  test_spiral(9, &p[2]);
  test_star(5, 3, 0.4, &p[3]);
  test_star(7, 0, 0.4, &p[4]);
  test_rectilinear(&(uint64_t){3}, true, &p[5]);
  for (int i = 0; i < 6; i++) {
    check(&p[i], upright, 17, 1e-12);
    check(&p[i], tilted, 9, 1e-6);
  }
}

TEST(rectilinear_prisms_are_right) {
  uint64_t random = 41;
  for (int i = 0; i < (SANITIZED ? 20 : 104); i++) {
    test_polygon p;
    test_rectilinear(&random, i % 2 == 0, &p);
    check(&p, i % 3 == 0 ? tilted : upright, i % 3 == 0 ? 9 : 17, 1e-6);
  }
}

/* Faces with holes, as bridges lead to them: the area alone, for bridges are in no other face. */
TEST(faces_have_holes) {
  for (int holes = 1; holes <= 4; holes++) {
    static text t;
    size_t corner[TEST_POLYGON_MOST];
    test_polygon p;
    abbe_mesh_report r;
    test_holes(holes, &p);
    t.size = 0;
    for (size_t i = 0; i < p.count; i++) {
      add(&t, "v %g %g 2\n", p.at[i][0], p.at[i][1]);
      corner[i] = i;
    }
    add_polygon(&t, true, corner, p.count);
    MADE(abbe_mesh, m, test_read(abbe_obj_read, "t", NULL, t.data, t.size, &m));
    OK(abbe_mesh_check(&m, &r, &error));
    assert_near(r.area, 100 - holes, 1e-9);
    assert_int_equal(r.degenerate_faces + r.crowded_edges + r.flipped_edges, 0);
  }
}
