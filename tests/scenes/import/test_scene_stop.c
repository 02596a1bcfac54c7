/* Scenes that nobody wants any more while they are read. */
#include "tests/check.h"
#include "tests/patience.h"

#include "scenes/import/scene_file.h"

/* Whoever stops it is not asked again, whenever that is, and there is no scene. */
TEST(reading_ends_when_it_is_told_to) {
  static const struct {
    const char *name;
    size_t least; /* questions: of a large mesh, of surroundings and a cut stone */
  } scenes[] = {{"bunny", 60}, {"stone", 60}};
  for (size_t i = 0; i < 2; i++) {
    OWNED(abbe_scene, scene) = {0};
    abbe_result result = ABBE_CANCELLED;
    patience p = {0};
    const char *path = printed("%s/scenes/%s.yaml", ABBE_SOURCE_DIR, scenes[i].name);
    for (size_t most = 0; result == ABBE_CANCELLED; most = 4 * most + 3) {
      abbe_watch watch = {patience_lasts, &p, false};
      p = (patience){.most = most};
      abbe_watch_set(&watch);
      result = abbe_scene_load(path, NULL, &scene, NULL);
      abbe_watch_set(NULL);
      if (result != ABBE_CANCELLED) break;
      assert_int_equal(p.asked, most + 1);
      assert_true(scene.object == NULL && scene.environment == NULL);
    }
    assert_int_equal(result, ABBE_OK);
    if (p.asked < scenes[i].least) fail_msg("%s: asked %zu times", scenes[i].name, p.asked);
  }
}
