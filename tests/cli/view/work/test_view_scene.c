/* A scene is read anew as far as its document has changed. */
#include "tests/check.h"

#include "cli/view/work/view_scene.h"

static abbe_view_document gem(void) {
  char path[] = ABBE_SOURCE_DIR "/scenes/gem.yaml";
  const abbe_view_document named = {.path = path};
  abbe_view_document out;
  OK(abbe_view_document_copy(&named, &out, &error));
  return out;
}

static void set(abbe_view_document *d, const char *key, const char *value) {
  OK(abbe_view_document_set(d, key, value, &error));
}

/* Takes the document, and tells whether the scene was outlined. */
static bool take(abbe_view_scene *s, const abbe_view_document *d, bool reload) {
  abbe_view_scene_news news = {0};
  abbe_scene *before = s->now;
  OK(abbe_view_scene_take(s, d, reload, 0, &news, &error));
  const bool outlined = news.outlined;
  if (outlined) {
    assert_true(news.file_count > 0);
    assert_memory_equal(news.outline.camera.eye, s->own.eye, sizeof s->own.eye);
    assert_memory_equal(news.outline.light[0].position, s->now->light[0].position,
                        sizeof s->now->light[0].position);
    assert_true(news.outline.object_count > 0);
  }
  abbe_view_scene_news_free(&news);
  if (before != s->now) abbe_view_scene_drop(before);
  return outlined;
}

TEST(no_more_than_has_changed) {
  OWNED(abbe_view_scene, s) = {0};
  OWNED(abbe_view_document, d) = gem();
  assert_true(take(&s, &d, false));
  const abbe_scene *first = s.now;
  const abbe_object *objects = s.now->object;
  assert_false(take(&s, &d, false));
  set(&d, "camera.eye", "[0, -0.5, 0.3]");
  assert_false(take(&s, &d, false));
  assert_near(s.now->camera.eye[1], -0.5, 0);
  d.photons = 48;
  assert_false(take(&s, &d, false));
  assert_int_equal(s.document.photons, 48);
  assert_false(s.relit);
  set(&d, "lights.lamp.position", "[0.01, 0.02, 0.26]");
  assert_true(take(&s, &d, false));
  assert_true(s.relit);
  assert_near(s.now->light[0].position[1], 0.02, 0);
  assert_near(s.now->camera.eye[1], -0.5, 0); /* where it was led to */
  assert_ptr_equal(s.now, first);
  assert_ptr_equal(s.now->object, objects);
  set(&d, "objects.gem.material", "diamond");
  assert_true(take(&s, &d, false));
  assert_ptr_not_equal(s.now->object, objects);
  objects = s.now->object;
  assert_true(take(&s, &d, true));
  assert_ptr_not_equal(s.now->object, objects);
}

TEST(what_is_refused_leaves_the_scene) {
  static const char *const bad[][2] = {{"lights.lamp.intensity", "-1"},
                                       {"lights.lamp.position", "[0, 0, 0.15]"},
                                       {"objects.gem.material", "cheese"}};
  OWNED(abbe_view_document, d) = gem();
  FILLED(abbe_view_scene, s, take(&s, &d, false));
  const abbe_object *objects = s.now->object;
  const double power = s.now->light[0].power;
  for (size_t i = 0; i < 3; i++) {
    abbe_view_scene_news news = {0};
    abbe_error why = {0};
    MADE(abbe_view_document, wrong, abbe_view_document_copy(&d, &wrong, &error));
    set(&wrong, bad[i][0], bad[i][1]);
    assert_int_not_equal(abbe_view_scene_take(&s, &wrong, false, 0, &news, &why), ABBE_OK);
    assert_true(why.text[0] != '\0' && !news.outlined);
    assert_ptr_equal(s.now->object, objects);
    assert_near(s.now->light[0].power, power, 0);
    assert_false(take(&s, &d, false));
  }
}
