/* The shape behind a volume: found again where it is moved and turned, told apart where it is
 * another. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/object_motion.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/volume_body.h"
#include "tests/random.h"
#include "tests/scenes/scene_text.h"

#define SCENE                                                                                      \
  CAMERA POINT_LIGHT FLOOR                                                                         \
      "- {name: wedge, shape: prism, apex: 50, side: 0.1, length: 0.13, material: crown, "         \
      "transform: "                                                                                \
      "[{translate: [0.2, 0.1, 0.2]}]}\n"                                                          \
      "- {name: ball, shape: sphere, radius: 0.05, levels: 3, material: flat, transform: "         \
      "[{translate: [-0.2, 0.1, 0.2]}]}\n"

TEST(motion_is_found) {
  static const double axis[3] = {1, -2, 0.5}, offset[3] = {0.1, -0.2, 0.3};
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  for (size_t i = 1; i < 3; i++) {
    abbe_volume_body body;
    abbe_volume_place first, then;
    double matrix[16], step[16], centre[3];
    OK(abbe_volume_body_make(&scene.object[i], &body, &error));
    assert_int_equal(body.ball, i == 2);
    OK(abbe_volume_body_find(&body, &scene.object[i], &first, &error));
    abbe_transform_rotate(2.2, axis, matrix);
    abbe_transform_translate(offset, step);
    abbe_transform_multiply(step, matrix, matrix);
    OK(abbe_object_move(&scene.object[i], matrix, &error));
    OK(abbe_volume_body_find(&body, &scene.object[i], &then, &error));
    abbe_transform_point(matrix, first.centre, centre);
    for (int k = 0; k < 3; k++) {
      const double e[3] = {k == 0, k == 1, k == 2};
      double turned[3];
      abbe_transform_direction(matrix, e, turned);
      assert_near(then.centre[k], centre[k], 1e-12);
      for (int r = 0; r < 3 && i == 1; r++) assert_near(then.turn[3 * r + k], turned[r], 1e-9);
      for (int r = 0; r < 3; r++) assert_near(first.turn[3 * r + k], r == k, 1e-12);
    }
  }
}

TEST(the_ball_around_it_holds_it) {
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  for (size_t i = 1; i < 3; i++) {
    abbe_volume_body body;
    abbe_volume_place place;
    double most = 0;
    OK(abbe_volume_body_make(&scene.object[i], &body, &error));
    OK(abbe_volume_body_find(&body, &scene.object[i], &place, &error));
    for (size_t k = 0; k < scene.object[i].mesh.vertex_count; k++) {
      double p[3];
      abbe_vector_subtract(scene.object[i].mesh.position[k], place.centre, p);
      most = fmax(most, abbe_vector_length(p));
    }
    assert_near(body.radius, most, i == 1 ? 1e-12 : 1e-3);
  }
}

TEST(others_are_told_apart) {
  abbe_volume_body wedge, ball;
  abbe_volume_place place;
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  REFUSED(ABBE_INVALID_ARGUMENT, "receiver",
          abbe_volume_body_make(&scene.object[0], &wedge, &error));
  OK(abbe_volume_body_make(&scene.object[1], &wedge, &error));
  OK(abbe_volume_body_make(&scene.object[2], &ball, &error));
  REFUSED(ABBE_UNSUPPORTED, "crown",
          abbe_volume_body_find(&wedge, &scene.object[2], &place, &error));
  REFUSED(ABBE_UNSUPPORTED, "the volume holds the caustics of",
          abbe_volume_body_find(&wedge, &scene.object[0], &place, &error));
  scene.object[1].mesh.position[wedge.anchor[0]][0] += 0.01; /* bent */
  REFUSED(ABBE_UNSUPPORTED, "shape",
          abbe_volume_body_find(&wedge, &scene.object[1], &place, &error));
  scene.object[2].exact.radius *= 1.01;
  REFUSED(ABBE_UNSUPPORTED, "its shape is off by",
          abbe_volume_body_find(&ball, &scene.object[2], &place, &error));
}

/* Symmetries that shapes are known to have, and light brought to one part of all directions. */

#define SUNNY CAMERA SUN FLOOR
#define TURNED                                                                                     \
  ", transform: [{rotate: {axis: [1, 2, 3], angle: 40}}, {translate: [0.1, 0, 0.5]}]}\n"

static void find(const char *object, abbe_body_symmetry *out) {
  abbe_volume_body body;
  abbe_volume_place place;
  OWNED(abbe_scene, scene) = scene_of(printed("%s%s", SUNNY, object));
  OK(abbe_volume_body_make(&scene.object[1], &body, &error));
  OK(abbe_volume_body_find(&body, &scene.object[1], &place, &error));
  OK(abbe_body_symmetry_find(&scene.object[1], place.centre, body.radius, out, &error));
}

TEST(orders_of_known_groups) {
  static const struct {
    const char *object;
    size_t order;
  } known[] = {
      {"- {name: cube, shape: box, size: [0.1, 0.1, 0.1], material: flat" TURNED, 48},
      {"- {name: brick, shape: box, size: [0.1, 0.1, 0.2], material: flat" TURNED, 16},
      {"- {name: brick, shape: box, size: [0.1, 0.15, 0.2], material: flat" TURNED, 8},
      {"- {name: wedge, shape: prism, apex: 60, side: 0.1, length: 0.1, material: flat" TURNED, 12},
      {"- {name: wedge, shape: prism, apex: 50, side: 0.1, length: 0.1, material: flat" TURNED, 4},
      {"- {name: ring, shape: ring, major: 0.08, minor: 0.02, around: 24, across: 12, mirror: "
       "0.9" TURNED,
       96},
      {"- {name: tower, shape: box, size: [0.1, 0.15, 0.2], mirror: 0.9" TURNED, 8},
      {"- {name: ball, shape: sphere, radius: 0.1, material: flat" TURNED, 1},
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    FILLED(abbe_body_symmetry, s, find(known[i].object, &s));
    print_message("%zu: %zu maps\n", i, s.count);
    assert_int_equal(s.count, known[i].order);
  }
}

/* All images of a direction are brought to one place, by orthogonal maps. */
TEST(images_are_brought_together) {
  OWNED(abbe_body_symmetry, s) = {0};
  abbe_body_symmetry copy;
  uint64_t seed = 5;
  find("- {name: cube, shape: box, size: [0.1, 0.1, 0.1], material: flat" TURNED, &s);
  for (int i = 0; i < 50; i++) {
    double d[3], there[3], image[3], again[3];
    for (int k = 0; k < 3; k++) d[k] = random_between(&seed, -1, 1);
    abbe_vector_normalise(d);
    abbe_body_symmetry_bring(&s, d, there);
    for (size_t m = 0; m < s.count; m++) {
      for (int k = 0; k < 3; k++) image[k] = abbe_vector_dot(&s.map[m][3 * k], d);
      abbe_body_symmetry_bring(&s, image, again);
      for (int k = 0; k < 3; k++) assert_near(again[k], there[k], 1e-9);
    }
    assert_int_equal(abbe_body_symmetry_bring(&s, there, again), 0);
  }
  OK(abbe_body_symmetry_make(s.count, (const double(*)[9])s.map, &copy, &error));
  assert_memory_equal(copy.map, s.map, s.count * sizeof *s.map);
  abbe_body_symmetry_free(&copy);
  s.map[3][4] += 0.01;
  assert_int_equal(abbe_body_symmetry_make(s.count, (const double(*)[9])s.map, &copy, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_body_symmetry_make(0, (const double(*)[9])s.map, &copy, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_body_symmetry_make(1, (const double(*)[9]) & s.map[1], &copy, NULL),
                   ABBE_INVALID_ARGUMENT);
}
