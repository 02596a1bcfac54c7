/* Hashes of scenes and references. */
#include "tests/scenes/scene_text.h"

#include "validation/sweep/sweep_hash.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")
#define SPOT                                                                                       \
  "lights:\n- {name: lamp, kind: spot, position: [0.05, 0.03, 0.6], direction: [0, 0, -1], "       \
  "intensity: 1, cone: 40}\n"

TEST(hashes_tell_scenes_and_references_apart) {
  static const char *const texts[] = {SCENE, CAMERA POINT_LIGHT FLOOR BALL("flat"),
                                      CAMERA SPOT FLOOR BALL("crown"), CAMERA POINT_LIGHT FLOOR};
  unsigned long long seen[4];
  for (size_t i = 0; i < 4; i++) {
    OWNED(abbe_scene, scene) = {0};
    load_text(texts[i], &scene);
    seen[i] = abbe_sweep_hash_scene(&scene);
    assert_true(seen[i] == abbe_sweep_hash_scene(&scene));
    for (size_t k = 0; k < i; k++) assert_true(seen[i] != seen[k]);
  }
  static const char *const names[] = {"Y"};
  OWNED(abbe_image, a) = {0};
  OWNED(abbe_image, b) = {0};
  OK(abbe_image_make(4, 4, 1, names, &a, &error));
  OK(abbe_image_make(4, 4, 1, names, &b, &error));
  assert_true(abbe_sweep_hash_images(&a, &b) == abbe_sweep_hash_images(&b, &a));
  b.data[3] = 1;
  assert_true(abbe_sweep_hash_images(&a, &b) != abbe_sweep_hash_images(&b, &a));
  assert_true(abbe_sweep_hash_images(&a, NULL) != abbe_sweep_hash_images(&b, NULL));
}
