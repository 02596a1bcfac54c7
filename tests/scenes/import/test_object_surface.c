#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/import/scene_reading.h"
#include "scenes/shapes/shape.h"
#include "tests/scenes/scene_text.h"
#include "tests/scenes/solids.h"

enum { ROOM = 4 };

static const abbe_material glass = {.name = (char *)"glass"};

static abbe_object_surface request(void) {
  abbe_object_surface s = {.normals = ABBE_NORMALS_AUTO, .file = true};
  abbe_transform_identity(s.matrix);
  return s;
}

static abbe_scene scene_with(abbe_mesh mesh, const abbe_material *material) {
  abbe_scene scene = {.object = calloc(ROOM, sizeof(abbe_object))};
  assert_non_null(scene.object);
  scene.object[0].mesh = mesh;
  scene.object[0].material = material;
  scene.object[0].name = strdup("thing");
  scene.object[0].line = 7;
  return scene;
}

static abbe_scene place(abbe_mesh mesh, const abbe_object_surface *s, bool refracts) {
  abbe_scene scene = scene_with(mesh, refracts ? &glass : NULL);
  OK(abbe_object_place(s, scene.object, ROOM, &scene.object_count, &error));
  return scene;
}

static abbe_mesh sphere(double radius, size_t levels) {
  abbe_mesh m;
  OK(abbe_shape_sphere(radius, levels, &m, &error));
  return m;
}

TEST(a_size_and_a_place_are_taken_from_the_bounds) {
  const test_box box = {{10, 20, 30}, {14, 22, 31}, false};
  const double turn[3] = {0, 0, 1}, half_pi = 1.57079632679489662;
  abbe_object_surface s = request();
  s.fit = 0.02;
  OWNED(abbe_scene, scene) = place(test_boxes(&box, 1), &s, true);
  assert_near(scene.object[0].max[0] - scene.object[0].min[0], 0.02, 1e-15);
  assert_near(scene.object[0].max[1] - scene.object[0].min[1], 0.01, 1e-15);
  assert_near(scene.object[0].min[0], 0.05, 1e-15); /* about the origin, as scale is */
  abbe_scene_free(&scene);
  abbe_transform_rotate(half_pi, turn, s.matrix);
  s.centred = true;
  s.centre[2] = 0.5;
  scene = place(test_boxes(&box, 1), &s, true);
  const abbe_object *o = &scene.object[0];
  assert_near(o->max[1] - o->min[1], 0.02, 1e-15);
  for (int k = 0; k < 3; k++) assert_near(0.5 * (o->min[k] + o->max[k]), s.centre[k], 1e-15);
  assert_int_equal(o->exact.kind, ABBE_EXACT_CONVEX);
}

TEST(a_width_is_the_smaller_side_and_a_foot_the_lowest) {
  const test_box box = {{10, 20, 30}, {14, 22, 31}, false};
  abbe_object_surface s = request();
  s.width = 0.006;
  s.centred = s.stands = true;
  s.centre[0] = 0.1;
  s.centre[2] = 0.5;
  OWNED(abbe_scene, scene) = place(test_boxes(&box, 1), &s, true);
  const abbe_object *o = &scene.object[0];
  const double min[] = {0.094, -0.003, 0.5}, max[] = {0.106, 0.003, 0.503};
  for (int k = 0; k < 3; k++) {
    assert_near(o->min[k], min[k], 1e-15);
    assert_near(o->max[k], max[k], 1e-15);
  }
  assert_near(o->fitted, 0.003, 1e-18);
}

/* The size that is asked for is the solid's, without the faces that are dropped. */
TEST(what_is_dropped_has_no_size) {
  const test_box box = {{0, 0, 0}, {4, 2, 1}, false};
  OWNED(abbe_mesh, whole) = test_boxes(&box, 1);
  abbe_mesh m;
  const size_t n = whole.vertex_count, f = whole.face_count;
  OK(abbe_mesh_make(n + 1, f + 1, false, &m, &error));
  memcpy(m.position, whole.position, n * sizeof *m.position);
  memcpy(m.normal, whole.normal, n * sizeof *m.normal);
  memcpy(m.face, whole.face, f * sizeof *m.face);
  m.position[n][0] = 40;
  for (uint32_t k = 0; k < 3; k++) m.face[f][k] = k == 0 ? whole.face[0][0] : (uint32_t)n;
  abbe_object_surface s = request();
  s.fit = 0.02;
  s.centred = true;
  OWNED(abbe_scene, scene) = place(m, &s, true);
  assert_contains(scene.object[0].fixes, "repeated");
  assert_near(scene.object[0].max[0] - scene.object[0].min[0], 0.02, 1e-15);
  assert_near(scene.object[0].max[0], 0.01, 1e-15);
}

/* Its vertices do not reach as far as the ball does. */
TEST(a_ball_is_fitted_as_a_ball) {
  abbe_object_surface s = request();
  s.radius = 3;
  s.fit = 0.1;
  s.centred = true;
  OWNED(abbe_scene, scene) = place(sphere(3, 1), &s, true);
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_SPHERE);
  assert_near(scene.object[0].exact.radius, 0.05, 1e-15);
  assert_near(scene.object[0].exact.centre[1], 0, 1e-15);
}

TEST(what_has_no_size_cannot_be_fitted) {
  abbe_mesh m;
  OK(abbe_mesh_make(3, 1, false, &m, &error));
  m.face[0][1] = 1, m.face[0][2] = 2;
  abbe_object_surface s = request();
  s.fit = 1;
  OWNED(abbe_scene, scene) = scene_with(m, NULL);
  REFUSED(ABBE_GEOMETRY, "no size",
          abbe_object_place(&s, scene.object, ROOM, &scene.object_count, &error));
}

/* A body with a hollow, and a second body that crosses it, turned and made smaller with it. */
TEST(shells_that_cross_become_objects) {
  const test_box box[3] = {{{0, 0, 0}, {9, 9, 9}, false},
                           {{2, 2, 2}, {7, 7, 7}, true},
                           {{8, 3, 3.5}, {12, 6, 6}, false}};
  abbe_object_surface s = request();
  s.fit = 0.12;
  s.centred = true;
  OWNED(abbe_scene, scene) = place(test_boxes(box, 3), &s, true);
  assert_int_equal(scene.object_count, 2);
  assert_string_equal(scene.object[0].name, "thing");
  assert_string_equal(scene.object[1].name, "thing (part 2 of 2)");
  assert_contains(scene.object[0].fixes, "followed as 2 solids that overlap");
  assert_null(scene.object[1].fixes);
  assert_int_equal(scene.object[0].mesh.face_count, 24);
  assert_int_equal(scene.object[1].mesh.face_count, 12);
  assert_true(scene.object[1].material == &glass && scene.object[1].line == 7);
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_NONE);
  assert_int_equal(scene.object[1].exact.kind, ABBE_EXACT_CONVEX);
  assert_near(scene.object[0].min[0], -0.06, 1e-12);
  assert_near(scene.object[1].max[0], 0.06, 1e-12);
  assert_near(scene.object[1].min[0], 0.02, 1e-12);
  const double in_hollow[3] = {-0.02, 0.0, 0.0}, in_glass[3] = {-0.055, 0, 0};
  assert_false(abbe_mesh_contains(&scene.object[0].mesh, in_hollow));
  assert_true(abbe_mesh_contains(&scene.object[0].mesh, in_glass));
}

/* Flush below and back to back: the second reaches into the first and past it below, a little. */
TEST(solids_that_lie_on_one_another_overlap) {
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 0.2, 0}, {2, 0.8, 0.5}, false}};
  abbe_object_surface s = request();
  OWNED(abbe_scene, scene) = place(test_boxes(box, 2), &s, true);
  assert_int_equal(scene.object_count, 2);
  const double *a = scene.object[0].min, *b = scene.object[1].min;
  assert_true(b[0] < scene.object[0].max[0] - 1e-5 && b[0] > scene.object[0].max[0] - 1e-4);
  assert_true(b[2] < a[2] - 1e-5 && b[2] > a[2] - 1e-4);
  assert_int_equal(scene.object[1].exact.count, 6);
}

TEST(more_parts_than_there_is_room_for_are_refused) {
  const test_box box[2] = {{{0, 0, 0}, {2, 2, 2}, false}, {{1, 0.5, 0.7}, {4, 1.5, 1.5}, false}};
  const abbe_object_surface s = request();
  OWNED(abbe_scene, scene) = scene_with(test_boxes(box, 2), &glass);
  REFUSED(ABBE_UNSUPPORTED, "room for 1 object",
          abbe_object_place(&s, scene.object, 1, &scene.object_count, &error));
  assert_int_equal(scene.object_count, 1);
}

static bool is_flat(const abbe_mesh *m) {
  for (size_t f = 0; f < m->face_count; f++)
    for (int k = 1; k < 3; k++)
      if (abbe_vector_dot(m->normal[m->face[f][0]], m->normal[m->face[f][k]]) < 1 - 1e-9)
        return false;
  return true;
}

/* Without a word of its own, and without normals in its file. */
static abbe_scene chosen(abbe_mesh m, bool given) {
  abbe_object_surface s = request();
  OK(abbe_mesh_compute_normals(&m, given ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_AUTO, &error));
  m.given_normals = given;
  return place(m, &s, true);
}

TEST(a_stone_is_cut_and_a_ball_is_round) {
  abbe_mesh m;
  /* a stone: its facets meet at less than a crease, but at its girdle */
  OK(abbe_shape_gem(16, 1, 0.6, 0.25, 0.5, &m, &error));
  OWNED(abbe_scene, scene) = chosen(m, false);
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_CONVEX);
  assert_true(is_flat(&scene.object[0].mesh));
  abbe_scene_free(&scene);
  /* a coarse ball: all its edges are less than a crease */
  scene = chosen(sphere(1, 1), false);
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_NONE);
  assert_int_equal(scene.object[0].exact.convex.verdict, ABBE_CONVEX_ROUNDED);
  assert_false(is_flat(&scene.object[0].mesh));
  abbe_scene_free(&scene);
  /* whose file says that its cube is rounded is believed */
  const double size[3] = {1, 1, 1};
  OK(abbe_shape_box(size, &m, &error));
  scene = chosen(m, true);
  assert_int_equal(scene.object[0].exact.convex.verdict, ABBE_CONVEX_ROUNDED);
}

enum { CUTS = 4 };

/* A cube of side 1 whose faces are cut into CUTS x CUTS squares, all corners off by `off` at most.
 */
static abbe_mesh rough_cube(double off) {
  abbe_mesh m;
  OK(abbe_mesh_make(6 * (CUTS + 1) * (CUTS + 1), 12 * CUTS * CUTS, false, &m, &error));
  size_t v = 0, f = 0;
  for (int side = 0; side < 6; side++)
    for (int j = 0; j <= CUTS; j++)
      for (int i = 0; i <= CUTS; i++, v++) {
        const int axis = side / 2, up = side % 2;
        int at[3];
        at[axis] = up ? CUTS : 0;
        at[(axis + 1) % 3] = up ? i : j;
        at[(axis + 2) % 3] = up ? j : i;
        const unsigned key = (unsigned)(at[0] + 8 * at[1] + 64 * at[2]);
        for (int k = 0; k < 3; k++)
          m.position[v][k] = (double)at[k] / CUTS +
                             off * ((double)((key * 2654435761u >> (8 * k)) % 256) / 127.5 - 1);
        if (i == CUTS || j == CUTS) continue;
        const uint32_t a = (uint32_t)v, row = CUTS + 1;
        const uint32_t faces[2][3] = {{a, a + 1, a + row + 1}, {a, a + row + 1, a + row}};
        memcpy(m.face[f], faces, sizeof faces);
        f += 2;
      }
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  return m;
}

/* What is known by its planes has triangles in them: light that leaves a plane meets none. */
TEST(triangles_of_a_rough_solid_lie_in_its_planes) {
  static const double off[] = {0, 1e-6, 8e-6};
  for (size_t i = 0; i < sizeof off / sizeof *off; i++) {
    abbe_object_surface s = request();
    OWNED(abbe_scene, scene) = place(rough_cube(off[i]), &s, true);
    const abbe_object *o = &scene.object[0];
    char why[160];
    abbe_convex_reason(&o->exact.convex, why, sizeof why);
    if (o->exact.kind != ABBE_EXACT_CONVEX) fail_msg("%g: %s", off[i], why);
    assert_int_equal(o->exact.count, 6);
    for (size_t f = 0; f < o->mesh.face_count; f++) {
      double nearest = 1;
      for (size_t p = 0; p < 6; p++) {
        double farthest = 0;
        for (int k = 0; k < 3; k++)
          farthest =
              fmax(farthest,
                   fabs(abbe_vector_dot(o->exact.plane[p], o->mesh.position[o->mesh.face[f][k]]) -
                        o->exact.plane[p][3]));
        nearest = fmin(nearest, farthest);
      }
      assert_near(nearest, 0, 1e-12);
    }
    assert_true(off[i] == 0 || o->exact.convex.tolerance > 2e-6);
  }
}

#define PLATE(reflectance)                                                                         \
  CAMERA POINT_LIGHT                                                                               \
      "objects:\n- {name: plate, shape: rectangle, width: 2, height: 2, reflectance: " reflectance \
      "}\n"

static const char *write_table(const char *text) {
  static char path[64];
  snprintf(path, sizeof path, "/tmp/abbe-test-spectrum-%ld.csv", (long)getpid());
  OK(abbe_file_write(path, text, strlen(text), &error));
  return path;
}

static void load_plate(const char *format, const char *path, abbe_scene *scene) {
  char text[1024], plate[256];
  snprintf(plate, sizeof plate, format, path);
  snprintf(text, sizeof text, PLATE("%s"), plate);
  *scene = scene_of(text);
}

TEST(a_file_gives_a_spectrum) {
  const char *path = write_table("nm;leaf;stone\n400;0,1;0,5\n500;0,3;0,5\n700;0,2;0,5\n");
  FILLED(abbe_scene, scene, load_plate("{spectrum: %s, column: leaf}", path, &scene));
  const abbe_object *o = &scene.object[0];
  assert_int_equal(abbe_object_kind_of(o), ABBE_OBJECT_RECEIVER);
  assert_near(abbe_spectrum_at(o->spectrum, 450), 0.2, 1e-12);
  assert_string_equal(o->spectrum_path, path);
  bool listed = false;
  for (size_t i = 0; i < abbe_scene_file_count(&scene); i++)
    listed = listed || (abbe_scene_file(&scene, i) && !strcmp(abbe_scene_file(&scene, i), path));
  assert_true(listed);
  abbe_scene_free(&scene);
  load_plate("{spectrum: %s, column: stone}", path, &scene);
  for (int k = 0; k < 3; k++) assert_near(scene.object[0].reflectance[k], 0.5, 5e-4);
  unlink(path);
}

TEST(a_patch_gives_a_spectrum) {
  OWNED(abbe_scene, scene) = scene_of(PLATE("{patch: red}"));
  const abbe_object *o = &scene.object[0];
  assert_null(o->spectrum_path);
  assert_true(abbe_spectrum_at(o->spectrum, 650) > 10 * abbe_spectrum_at(o->spectrum, 500));
  assert_true(o->reflectance[0] > 4 * o->reflectance[1]);
}

static void refuses(const char *format, const char *table, abbe_result result, const char *says) {
  char path[96], text[1024], plate[256];
  snprintf(path, sizeof path, "%s.yaml", write_table(table));
  snprintf(plate, sizeof plate, format, write_table(table));
  snprintf(text, sizeof text, PLATE("%s"), plate);
  const char *whole = strstr(text, "camera:");
  OK(abbe_file_write(path, whole, strlen(whole), &error));
  abbe_scene scene;
  abbe_error why = {0};
  const abbe_result got = abbe_scene_load(path, NULL, &scene, &why);
  if (got != result || strstr(why.text, says) == NULL) fail_msg("%s: %d %s", format, got, why.text);
  unlink(path);
  unlink(write_table(""));
}

TEST(what_is_no_reflectance_is_refused) {
  const char *good = "nm,a\n400,0.5\n700,0.5\n";
  refuses("{patch: blue sky, column: a}", good, ABBE_SCHEMA, "either {spectrum: FILE}");
  refuses("{}", good, ABBE_SCHEMA, "either {spectrum: FILE}");
  refuses("{patch: reed}", good, ABBE_NOT_FOUND, "did you mean 'red'");
  refuses("{spectrum: %s}", "nm,a\n400,50\n700,60\n", ABBE_SCHEMA, "divide by 100");
  refuses("{spectrum: %s, column: b}", good, ABBE_SCHEMA, "the column 'b'");
  refuses("{spectrum: /no/such.csv}", good, ABBE_IO, "/no/such.csv");
  refuses("{patch: red, colour: blue}", good, ABBE_SCHEMA, "colour");
  refuses("{patch: red}, texture: wood.png", good, ABBE_SCHEMA, "a texture multiplies");
}
