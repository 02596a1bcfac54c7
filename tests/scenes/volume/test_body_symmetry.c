/* Symmetries that shapes are known to have, and light brought to one part of all directions. */
#include "tests/random.h"
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/volume_body.h"

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
