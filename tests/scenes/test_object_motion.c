/* An object that is moved is the one that a file puts there. */
#include "tests/check.h"

#include "scenes/geometry/transform.h"
#include "scenes/object_motion.h"
#include "tests/scenes/scene_text.h"

#define START CAMERA POINT_LIGHT FLOOR
#define BRICK_AT(steps)                                                                            \
  "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], material: crown, transform: [" steps "]}"  \
  "\n"
#define BALL_AT(steps)                                                                             \
  "- {name: ball, shape: sphere, radius: 0.05, levels: 3, material: flat, transform: [" steps "]}" \
  "\n"
#define CARD_AT(steps)                                                                             \
  "- {name: card, shape: rectangle, width: 0.1, height: 0.2, reflectance: 0.5, transform: [" steps \
  "]}\n"
#define FIRST "{translate: [0.2, 0.1, 0.2]}"
#define THEN ", {scale: 1.5}, {rotate: {axis: [1, 2, 3], angle: 40}}, {translate: [0.1, -0.2, 0.3]}"

static void matrix_of_then(double out[16]) {
  static const double factor[3] = {1.5, 1.5, 1.5}, axis[3] = {1, 2, 3},
                      offset[3] = {0.1, -0.2, 0.3};
  double step[16];
  abbe_transform_scale(factor, out);
  abbe_transform_rotate(40 * 3.14159265358979323846 / 180, axis, step);
  abbe_transform_multiply(step, out, out);
  abbe_transform_translate(offset, step);
  abbe_transform_multiply(step, out, out);
}

static void assert_all_near(const double *a, const double *b, size_t count) {
  for (size_t i = 0; i < count; i++) assert_near(a[i], b[i], 1e-12);
}

static void assert_same_object(const abbe_object *a, const abbe_object *b) {
  assert_int_equal(a->mesh.vertex_count, b->mesh.vertex_count);
  assert_all_near(a->mesh.position[0], b->mesh.position[0], 3 * a->mesh.vertex_count);
  assert_all_near(a->mesh.normal[0], b->mesh.normal[0], 3 * a->mesh.vertex_count);
  assert_int_equal(a->exact.kind, b->exact.kind);
  assert_int_equal(a->exact.count, b->exact.count);
  assert_all_near(a->exact.centre, b->exact.centre, 3);
  assert_near(a->exact.radius, b->exact.radius, 1e-12);
  if (a->exact.plane != NULL)
    assert_all_near(a->exact.plane[0], b->exact.plane[0], 4 * a->exact.count);
  if (a->exact.parallelogram != NULL)
    assert_all_near(a->exact.parallelogram[0], b->exact.parallelogram[0], 9 * a->exact.count);
  assert_all_near(a->axis, b->axis, 3);
  assert_all_near(a->min, b->min, 3);
  assert_all_near(a->max, b->max, 3);
}

TEST(a_moved_object_is_the_one_put_there) {
  double matrix[16];
  OWNED(abbe_scene, moved) = scene_of(START BRICK_AT(FIRST) BALL_AT(FIRST) CARD_AT(FIRST));
  OWNED(abbe_scene, there) =
      scene_of(START BRICK_AT(FIRST THEN) BALL_AT(FIRST THEN) CARD_AT(FIRST THEN));
  matrix_of_then(matrix);
  assert_int_equal(moved.object[1].exact.kind, ABBE_EXACT_CONVEX);
  assert_int_equal(moved.object[2].exact.kind, ABBE_EXACT_SPHERE);
  assert_int_equal(moved.object[3].exact.kind, ABBE_EXACT_PARALLELOGRAMS);
  for (size_t i = 1; i < moved.object_count; i++) {
    OK(abbe_object_move(&moved.object[i], matrix, &error));
    assert_same_object(&moved.object[i], &there.object[i]);
  }
}

TEST(other_matrices_are_refused) {
  OWNED(abbe_scene, scene) = scene_of(START BRICK_AT(FIRST));
  abbe_object *brick = &scene.object[1];
  const double corner = brick->max[0];
  for (int k = 0; k < 6; k++) {
    double m[16];
    abbe_transform_identity(m);
    if (k == 0) m[0] = 2;   /* stretched */
    if (k == 1) m[4] = 0.1; /* sheared */
    if (k == 2) m[0] = -1;  /* mirrored */
    if (k == 3) m[12] = NAN;
    if (k == 4) m[3] = 0.5; /* projective */
    if (k == 5) m[0] = m[5] = m[10] = 0;
    REFUSED(ABBE_INVALID_ARGUMENT, "an object may be moved, turned and scaled",
            abbe_object_move(brick, m, &error));
    assert_true(brick->max[0] == corner);
  }
}

/* What refracts and what reflects turn about the middle of what refracts; the floor stays. */
TEST(the_piece_turns) {
  static const double up[3] = {0, 0, 2};
#define METAL_AT(steps)                                                                            \
  "- {name: metal, shape: box, size: [0.02, 0.02, 0.02], mirror: 0.9, transform: [" steps "]}\n"
#define TURNED "{rotate: {axis: [0, 0, 1], angle: 90}}, {translate: [0.2, 0.1, 0.2]}"
  OWNED(abbe_scene, turned) =
      scene_of(START BRICK_AT(FIRST) METAL_AT("{translate: [0.3, 0.1, 0.3]}"));
  abbe_scene there =
      scene_of(START BRICK_AT(TURNED) METAL_AT("{translate: [0.1, 0, 0.1]}, " TURNED));
  OK(abbe_piece_turn(&turned, up, 0.5 * 3.14159265358979323846, &error));
  assert_same_object(&turned.object[0], &there.object[0]);
  assert_same_object(&turned.object[1], &there.object[1]);
  for (int k = 0; k < 3; k++)
    assert_near(turned.object[2].min[k], k == 0 ? 0.19 : k == 1 ? 0.19 : 0.29, 1e-12);
  REFUSED(ABBE_INVALID_ARGUMENT, "an axis", abbe_piece_turn(&turned, (double[3]){0}, 1, &error));
  abbe_scene_free(&turned);
  abbe_scene_free(&there);
  turned = scene_of(START);
  REFUSED(ABBE_INVALID_ARGUMENT, "nothing to turn", abbe_piece_turn(&turned, up, 1, &error));
}

/* Stones that are tilted stand where a file with the same rotation puts them. */

#define RAD (3.14159265358979323846 / 180)
#define REFRACTOR_TILT_START CAMERA POINT_LIGHT FLOOR
#define STONE_AT(name, steps)                                                                      \
  "- {name: " name ", shape: box, size: [0.1, 0.08, 0.06], material: crown, transform: [" steps    \
  "]}\n"
#define PANE                                                                                       \
  "- {name: pane, shape: box, size: [0.1, 0.1, 0.01], mirror: 0.5,\n"                              \
  "   transform: [{translate: [0.3, 0, 0.2]}]}\n"
/* About (0.2, 0.1, 0.3), the middle of both, by 25 degrees about the axis of azimuth 30. */
#define REFRACTOR_TILT_TURNED                                                                      \
  ", {translate: [-0.2, -0.1, -0.3]}, {rotate: {axis: [0.8660254037844387, 0.5, 0], angle: 25}}, " \
  "{translate: [0.2, 0.1, 0.3]}"
#define ONE "{translate: [0.1, 0.1, 0.2]}"
#define OTHER "{translate: [0.3, 0.1, 0.4]}"

TEST(all_refractors_turn_about_their_middle) {
  OWNED(abbe_scene, tilted) =
      scene_of(REFRACTOR_TILT_START STONE_AT("a", ONE) PANE STONE_AT("b", OTHER));
  OWNED(abbe_scene, there) = scene_of(REFRACTOR_TILT_START STONE_AT("a", ONE REFRACTOR_TILT_TURNED)
                                          PANE STONE_AT("b", OTHER REFRACTOR_TILT_TURNED));
  OK(abbe_refractors_tilt(&tilted, 25 * RAD, 30 * RAD, &error));
  for (size_t i = 0; i < tilted.object_count; i++) {
    const abbe_object *a = &tilted.object[i], *b = &there.object[i];
    for (size_t v = 0; v < a->mesh.vertex_count; v++)
      for (int k = 0; k < 3; k++)
        assert_near(a->mesh.position[v][k], b->mesh.position[v][k], 1e-12);
    for (int k = 0; k < 3; k++) assert_near(a->max[k], b->max[k], 1e-12);
  }
}

/* As abbe gem report has it: what is left of the axis' arrow rises. */
TEST(a_tilt_lifts_what_is_left_of_its_axis) {
  OWNED(abbe_scene, scene) =
      scene_of(REFRACTOR_TILT_START STONE_AT("a", "{translate: [0, 0, 0.2]}"));
  abbe_object *o = &scene.object[1];
  size_t left = 0;
  for (size_t v = 0; v < o->mesh.vertex_count; v++)
    if (o->mesh.position[v][1] > 0.039) left = v;
  const double before = o->mesh.position[left][2];
  OK(abbe_refractors_tilt(&scene, 10 * RAD, 0, &error));
  assert_true(o->mesh.position[left][2] > before + 0.005);
}

static void refused(const char *text, double tilt, abbe_result why, const char *part) {
  OWNED(abbe_scene, scene) = scene_of(text);
  REFUSED(why, part, abbe_refractors_tilt(&scene, tilt, 0, &error));
}

TEST(what_cannot_be_tilted_is_refused) {
  refused(REFRACTOR_TILT_START PANE, 0.1, ABBE_INVALID_ARGUMENT, "no refractor");
  refused(REFRACTOR_TILT_START STONE_AT("a", ONE), NAN, ABBE_INVALID_ARGUMENT, "finite");
  /* a corner reaches the lamp */
  refused("materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
          "lights:\n- {name: lamp, kind: point, position: [0, 0, 0.3], intensity: 1}\n" FLOOR
          "- {name: a, shape: box, size: [0.1, 0.4, 0.1], material: crown,\n"
          "   transform: [{translate: [0, 0, 0.2]}]}\n",
          0.5 * 3.14159, ABBE_UNSUPPORTED, "lamp");
}
