/* One view of a light, or a cube of them, and who may have which. */
#include "tests/check.h"

#include "base/maths.h"
#include "gl/plan/examine/examine.h"
#include "gl/plan/plan.h"
#include "tests/gl/plan/planned.h"
#include "tests/random.h"
#include "tests/scenes/scene_text.h"

/* Where the default profile has a cube, the thesis's has none; of a spot its view is the cone. */
TEST(the_thesis_profile_looks_through_one_view) {
  static const struct {
    const char *kind;
    bool one_view;
  } rows[] = {{"point", false}, {"spot, direction: [1, 0, 0], cone: 30", true}};
  static const abbe_profile profiles[] = {ABBE_PROFILE_THESIS, ABBE_PROFILE_THESIS_CIE};
  for (size_t i = 0; i < 4; i++) {
    OWNED(abbe_plan, plan);
    abbe_error error = {0};
    OWNED(abbe_scene, scene) = scene_of(printed(
        CAMERA "lights:\n- {name: lamp, kind: %s, position: [0.1, 0, 0.2], intensity: 1}\n" FLOOR
               "%s" BALL("crown"),
        rows[i / 2].kind, BRICK("crown")));
    const abbe_render_desc desc = {.profile = profiles[i % 2]};
    const abbe_result result = abbe_plan_make(&scene, &desc, &plan, &error);
    assert_int_equal(result, rows[i / 2].one_view ? ABBE_OK : ABBE_UNSUPPORTED);
    if (!rows[i / 2].one_view) assert_contains(error.text, "looks through one view");
  }
}

/* Faces of the cube around a light: which direction and which object belongs to which. */

static const double origin[3] = {0.3, -0.2, 0.1};

static bool is_in_window(const abbe_view *view, const double direction[3], double room) {
  const double z = abbe_vector_dot(direction, view->forward);
  const double x = abbe_vector_dot(direction, view->right) / z;
  const double y = abbe_vector_dot(direction, view->up) / z;
  return z > 0 && x >= view->window[0] - room && x <= view->window[1] + room &&
         y >= view->window[2] - room && y <= view->window[3] + room;
}

static void whole_face(int face, abbe_view *view) {
  static const double window[4] = {-1, 1, -1, 1};
  abbe_light_cube_look(origin, face, view);
  memcpy(view->window, window, sizeof window);
}

TEST(every_direction_has_one_face) {
  uint64_t random = 3;
  for (int i = 0; i < 20000; i++) {
    double d[3];
    for (int k = 0; k < 3; k++) /* many ties */
      d[k] = i % 2 != 0 ? random_between(&random, -1, 1) : rint(random_between(&random, -2, 2));
    if (!abbe_vector_normalise(d)) continue;
    const int face = abbe_light_cube_face(d);
    assert_true(face >= 0 && face < ABBE_LIGHT_CUBE_FACES);
    for (int other = 0; other < ABBE_LIGHT_CUBE_FACES; other++) {
      abbe_view view;
      whole_face(other, &view);
      if (other == face) assert_true(is_in_window(&view, d, 1e-12));
      if (other != face) assert_false(is_in_window(&view, d, -1e-12));
    }
  }
  assert_int_equal(abbe_light_cube_face((const double[3]){1, -1, 1}), 0);
  assert_int_equal(abbe_light_cube_face((const double[3]){-1, 1, -1}), 1);
  assert_int_equal(abbe_light_cube_face((const double[3]){0, -1, 1}), 3);
}

/* Rays in random directions that meet the object lie in the windows of the faces that it reaches,
 * and these windows are no wider than the rays. */
static void check_windows(const abbe_object *object, bool sphere) {
  uint64_t random = 7;
  const abbe_light lamp = {.kind = ABBE_LIGHT_POINT, .position = {origin[0], origin[1], origin[2]}};
  const unsigned reached = abbe_light_cube_reached(&lamp, object);
  double found[6][4];
  abbe_view view[6];
  for (int face = 0; face < 6; face++) {
    abbe_light_cube_look(origin, face, &view[face]);
    memcpy(found[face], view[face].window, sizeof found[face]);
    assert_int_equal(abbe_light_cube_fit(&view[face], object), reached >> face & 1);
  }
  for (int i = 0; i < 400000; i++) {
    double d[3], to[3];
    const uint32_t *face = object->mesh.face[(size_t)i % object->mesh.face_count];
    double w[2] = {random_between(&random, 0, 1), random_between(&random, 0, 1)};
    if (w[0] + w[1] > 1) w[0] = 1 - w[0], w[1] = 1 - w[1];
    for (int k = 0; k < 3; k++)
      d[k] = (1 - w[0] - w[1]) * object->mesh.position[face[0]][k] +
             w[0] * object->mesh.position[face[1]][k] + w[1] * object->mesh.position[face[2]][k];
    if (sphere) { /* out to the exact surface */
      abbe_vector_subtract(d, object->exact.centre, to);
      abbe_vector_normalise(to);
      for (int k = 0; k < 3; k++) d[k] = object->exact.centre[k] + object->exact.radius * to[k];
    }
    for (int k = 0; k < 3; k++) d[k] -= origin[k];
    const int of = abbe_light_cube_face(d);
    assert_true(reached >> of & 1);
    assert_true(is_in_window(&view[of], d, 1e-6));
    const double z = abbe_vector_dot(d, view[of].forward);
    const double at[2] = {abbe_vector_dot(d, view[of].right) / z,
                          abbe_vector_dot(d, view[of].up) / z};
    for (int axis = 0; axis < 2; axis++) {
      found[of][2 * axis] = fmin(found[of][2 * axis], at[axis]);
      found[of][2 * axis + 1] = fmax(found[of][2 * axis + 1], at[axis]);
    }
  }
  for (int face = 0; face < 6; face++)
    for (int k = 0; k < 4 && (reached >> face & 1) != 0; k++)
      if (isfinite(found[face][k])) assert_near(view[face].window[k], found[face][k], 0.12);
}

TEST(windows_hold_what_is_there) {
  static const char *const shapes[] = {
      "shape: sphere, radius: 0.15, levels: 3, transform: [{translate: [0.5, 0, 0.1]}]",
      "shape: sphere, radius: 0.2, levels: 3, transform: [{translate: [0.3, -0.2, 0.302]}]",
      "shape: box, size: [0.1, 3, 0.1], transform: [{translate: [0.5, 0, 0.1]}]",
      "shape: box, size: [2, 2, 0.1], transform: [{rotate: {axis: [1, 2, 3], angle: 30}}, "
      "{translate: [0.3, -0.2, -0.2]}]",
      "shape: ring, major: 0.4, minor: 0.05, transform: [{translate: [0.3, -0.2, 0.1]}]"};
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
    OWNED(abbe_scene, scene) =
        scene_of(printed(CAMERA POINT_LIGHT FLOOR "- {name: it, %s, material: flat}\n", shapes[i]));
    check_windows(&scene.object[1], scene.object[1].exact.kind == ABBE_EXACT_SPHERE);
  }
}

/* Of balls all around, as many faces as the angle says: one whose middle is on a face's axis
 * reaches the next face from sin(45 degrees) on. */
TEST(a_ball_reaches_the_faces_that_it_crosses) {
  static const struct {
    double at[3], radius;
    unsigned faces;
  } rows[] = {{{1, 0, 0}, 0.70, 1},       {{1, 0, 0}, 0.71, 1 | 4 | 8 | 16 | 32},
              {{-1, 0, 0}, 0.5, 2},       {{1, 1, 0}, 0.1, 1 | 4},
              {{-1, 0, -1}, 0.1, 2 | 32}, {{1, 1, 1}, 0.1, 1 | 4 | 16},
              {{1, 1.2, 0}, 0.14, 4},     {{1, 1.2, 0}, 0.15, 1 | 4},
              {{1, 1, 1.3}, 0.2, 16},     {{0, 0, -1}, 0.99, 63 & ~16u}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const abbe_light lamp = {.kind = ABBE_LIGHT_POINT,
                             .position = {origin[0], origin[1], origin[2]}};
    abbe_object ball = {.exact = {.kind = ABBE_EXACT_SPHERE, .radius = rows[i].radius}};
    for (int k = 0; k < 3; k++) ball.exact.centre[k] = origin[k] + rows[i].at[k];
    assert_int_equal(abbe_light_cube_reached(&lamp, &ball), rows[i].faces);
    assert_near(abbe_object_distance(&ball, origin),
                abbe_vector_length(rows[i].at) - rows[i].radius, 1e-12);
  }
  /* A narrow cone around +x leaves out the faces beside it. */
  abbe_object around = {.exact = {.kind = ABBE_EXACT_SPHERE, .radius = 0.99}};
  memcpy(around.exact.centre, origin, sizeof origin);
  around.exact.centre[0] += 1;
  abbe_light spot = {.kind = ABBE_LIGHT_SPOT, .direction = {1, 0, 0}, .cone_rad = 0.5};
  memcpy(spot.position, origin, sizeof origin);
  assert_int_equal(abbe_light_cube_reached(&spot, &around), 1);
  spot.cone_rad = 0.7;
  assert_int_equal(abbe_light_cube_reached(&spot, &around), 1 | 4 | 8 | 16 | 32);
}

TEST(the_way_to_a_box_is_the_nearest) {
  static const struct {
    double at[3], way;
  } rows[] = {{{0.2, 0, 0.4}, 0.17}, {{0.25, 0.04, 0.24}, 0.01}, {{0.28, 0.08, 0.23}, 0.05}};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BRICK("flat"));
  for (size_t i = 0; i < 3; i++)
    assert_near(abbe_object_distance(&scene.object[1], rows[i].at), rows[i].way, 1e-12);
}

#define AMID(i, x, y)                                                                              \
  "- {name: amid" i ", kind: point, position: [" x ", " y ", 0.2], intensity: 1}\n"

/* Each lamp stands between the same four balls: four faces, and four maps a lamp. */
TEST(maps_have_an_end) {
  static const char balls[] = FLOOR "- {name: east, shape: sphere, radius: 0.08, levels: 2, "
                                    "transform: [{translate: [0.4, 0, 0.2]}], material: flat}\n"
                                    "- {name: west, shape: sphere, radius: 0.08, levels: 2, "
                                    "transform: [{translate: [-0.4, 0, 0.2]}], material: flat}\n"
                                    "- {name: north, shape: sphere, radius: 0.08, levels: 2, "
                                    "transform: [{translate: [0, 0.4, 0.2]}], material: flat}\n"
                                    "- {name: south, shape: sphere, radius: 0.08, levels: 2, "
                                    "transform: [{translate: [0, -0.4, 0.2]}], material: flat}\n";
  abbe_plan plan;
  OWNED(abbe_scene, scene) =
      scene_of(printed(CAMERA "lights:\n" AMID("1", "0", "0") AMID("2", "0.01", "0")
                           AMID("3", "0", "0.01") AMID("4", "0.01", "0.01") "%s",
                       balls));
  OK(abbe_plan_make(&scene, NULL, &plan, &error));
  assert_int_equal(plan.light_view_count, 16);
  unsigned carried[4] = {0};
  for (size_t i = 0; i < plan.light_view_count; i++) {
    assert_true(plan.light_view[i].light < 4 && plan.reaches[i]);
    if (i < 4) assert_int_equal(plan.light_view[i].light, i);
    assert_int_equal(carried[plan.light_view[i].light] & plan.light_view[i].faces, 0);
    carried[plan.light_view[i].light] |= plan.light_view[i].faces;
  }
  for (int i = 0; i < 4; i++) assert_int_equal(carried[i], ABBE_LIGHT_CUBE_ALL);
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  scene = scene_of(printed(CAMERA "lights:\n" AMID("1", "0", "0") AMID("2", "0.01", "0")
                               AMID("3", "0", "0.01") AMID("4", "0.01", "0.01")
                                   AMID("5", "0.02", "0") "%s",
                           balls));
  REFUSED(ABBE_UNSUPPORTED, "more than 16 maps", abbe_plan_make(&scene, NULL, &plan, &error));
}

/* A seam may not cut what only its layers tell; a mesh's triangles may be cut. */
TEST(layers_need_one_view) {
  OWNED(abbe_plan, plan);
  abbe_render_desc desc = {.model = ABBE_MODEL_LAYERS};
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA
      "lights:\n- {name: lamp, kind: point, position: [0, 0, 0.281], intensity: 1}\n" FLOOR BALL(
          "flat"));
  REFUSED(ABBE_UNSUPPORTED, "no view holds its layers",
          abbe_plan_make(&scene, &desc, &plan, &error));
  desc.model = ABBE_MODEL_BVH;
  OK(abbe_plan_make(&scene, &desc, &plan, &error));
  assert_true(plan.cubes);
}
