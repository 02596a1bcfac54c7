/* References: the same whether traced in one go or stopped and taken up; nothing is left behind. */
#include "tests/scenes/scene_text.h"

#include "validation/trace/tracer/reference.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")

static const abbe_trace_desc small = {
    .width = 16, .height = 16, .map_width = 16, .map_height = 16, .photons = 4096, .threads = 1};

static bool stop_midway(void *user, double done) {
  int *calls = user;
  (void)done;
  return ++*calls <= 3;
}

static void assert_same(const abbe_image *a, const abbe_image *b) {
  assert_int_equal(a->width * a->height * a->channels, b->width * b->height * b->channels);
  assert_memory_equal(a->data, b->data, a->width * a->height * a->channels * sizeof *a->data);
}

TEST(stopped_and_taken_up_is_the_same) {
  char folder[] = "/tmp/abbe-test-reference-XXXXXX", path[64];
  abbe_image whole[2], parts[2];
  int calls = 0;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/checkpoint", folder);
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  abbe_reference_desc desc = {.trace = small, .passes = 6};
  OK(abbe_reference_trace(&scene, &desc, &whole[0], &whole[1], &error));
  desc.checkpoint = path;
  desc.progress = stop_midway;
  desc.user = &calls;
  REFUSED(ABBE_CANCELLED, "stopped after 3 of 6 passes",
          abbe_reference_trace(&scene, &desc, &parts[0], &parts[1], &error));
  assert_null(parts[0].data);
  assert_int_equal(access(path, F_OK), 0);
  desc.progress = NULL;
  OK(abbe_reference_trace(&scene, &desc, &parts[0], &parts[1], &error));
  for (int i = 0; i < 2; i++) {
    assert_same(&whole[i], &parts[i]);
    abbe_image_free(&whole[i]);
    abbe_image_free(&parts[i]);
  }
  /* It stays until the caller has put away what was given; besides it nothing is left. */
  assert_int_equal(unlink(path), 0);
  assert_int_equal(rmdir(folder), 0);
}

TEST(a_checkpoint_of_another_request_is_refused) {
  char folder[] = "/tmp/abbe-test-reference-XXXXXX", path[64];
  abbe_image picture, map;
  int calls = 0;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/checkpoint", folder);
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  abbe_reference_desc desc = {
      .trace = small, .passes = 6, .checkpoint = path, .progress = stop_midway, .user = &calls};
  REFUSED(ABBE_CANCELLED, "", abbe_reference_trace(&scene, &desc, &picture, &map, &error));
  desc.trace.seed = 5;
  REFUSED(ABBE_INVALID_ARGUMENT, path, abbe_reference_trace(&scene, &desc, &picture, &map, &error));
  assert_null(map.data);
  unlink(path);
  rmdir(folder);
}

TEST(a_part_that_is_left_out) {
  abbe_image picture;
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  abbe_reference_desc desc = {.trace = small, .passes = 2};
  desc.trace.no_picture = true;
  MADE(abbe_image, map, abbe_reference_trace(&scene, &desc, &picture, &map, &error));
  assert_null(picture.data);
  assert_int_equal(map.width, 16);
}
