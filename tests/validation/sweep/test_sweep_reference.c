/* Where a sweep's references are kept, and references that are given. */
#include "tests/scenes/scene_text.h"

#include "colorimetry/image/exr.h"
#include "validation/sweep/sweep_reference.h"

#include <unistd.h>

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")

TEST(names) {
  abbe_sweep_reference r = {0};
  char path[2000];
  OK(abbe_sweep_reference_name("a.b/gem.csv", false, &r, &error));
  assert_string_equal(r.picture_path, "a.b/gem-reference.exr");
  assert_string_equal(r.map_path, "a.b/gem-reference-map.exr");
  OK(abbe_sweep_reference_name("a.b/gem", true, &r, &error));
  assert_string_equal(r.checkpoint_path, "a.b/gem-matched.checkpoint");
  memset(path, 'x', sizeof path);
  path[sizeof path - 1] = '\0';
  REFUSED(ABBE_INVALID_ARGUMENT, "is too long", abbe_sweep_reference_name(path, false, &r, &error));
}

TEST(given_files) {
  static const char *const names[] = {"R", "G", "B"};
  OWNED(abbe_scene, scene) = {0};
  abbe_sweep_reference r;
  OWNED(abbe_image, image) = {0};
  abbe_error why = {0};
  size_t light = 7;
  char path[64];
  load_text(SCENE, &scene);
  snprintf(path, sizeof path, "/tmp/abbe_test_sweep_reference_%ld.exr", (long)getpid());
  OK(abbe_image_make(2, 2, 3, names, &image, &error));
  OK(abbe_exr_write(path, &image, &error));
  OK(abbe_sweep_reference_load(&scene, path, NULL, &r, &light, &error));
  assert_int_equal(light, 0);
  assert_int_equal(r.picture.width, 2);
  assert_null(r.map.data);
  assert_string_equal(r.map_path, "");
  abbe_sweep_reference_free(&r);
  /* A picture is no map: it has no layout. */
  assert_int_not_equal(abbe_sweep_reference_load(&scene, NULL, path, &r, &light, &why), ABBE_OK);
  assert_contains(why.text, path);
  abbe_sweep_reference_free(&r);
  unlink(path);
  REFUSED(ABBE_IO, "", abbe_sweep_reference_load(&scene, path, NULL, &r, &light, &error));
}
