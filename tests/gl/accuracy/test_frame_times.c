/* Times of frames: medians, when enough were drawn, and a stop. */
#include "tests/gl/frame.h"

#include "gl/accuracy/frame_times.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")

typedef struct watch {
  size_t asked, most;
} watch;

static bool watch_frames(void *user, double done) {
  watch *w = user;
  assert_true(done >= 0 && done < 1);
  return ++w->asked <= w->most;
}

GROUP(make_context, free_context);

TEST(times) {
  abbe_frame_times times;
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  const abbe_render_desc small = {.width = 16, .height = 16, .photons = 16, .map_size = 32};
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &small);
  watch w = {.most = 4};
  abbe_frame_times_desc desc = {.frames = 4, .progress = watch_frames, .user = &w};
  OK(abbe_frame_times_measure(renderer, &desc, &times, &error));
  assert_int_equal(w.asked, 4);
  assert_true(times.fastest_ms > 0 && times.fastest_ms <= times.median.frame_ms);
  assert_true(times.median.energy.reached > 0);
  /* Three are enough of frames that are slow by that measure. */
  w = (watch){.most = 9};
  desc.frames = 9;
  desc.enough_ms = 1e-9;
  OK(abbe_frame_times_measure(renderer, &desc, &times, &error));
  assert_int_equal(w.asked, 3);
  w = (watch){.most = 2};
  REFUSED(ABBE_CANCELLED, "", abbe_frame_times_measure(renderer, &desc, &times, &error));
  double ms = 0;
  OK(abbe_frame_times_baseline(renderer, 3, &ms, &error));
  assert_true(ms > 0);
}

TEST(unrest) {
  char text[120];
  assert_near(abbe_frame_times_unrest(150, 100), 0.5, 1e-12);
  assert_near(abbe_frame_times_unrest(100, 100), 0, 0);
  assert_true(isnan(abbe_frame_times_unrest(100, NAN)));
  assert_true(isnan(abbe_frame_times_unrest(0, 0)));
  abbe_frame_times_say_unrest(0.5, "note: ", text, sizeof text);
  assert_string_equal(text, "note: the machine is busy: repeats took 50 % longer than the fastest");
  abbe_frame_times_say_unrest(ABBE_FRAME_TIMES_QUIET, "note: ", text, sizeof text);
  assert_string_equal(text, "");
  abbe_frame_times_say_unrest(NAN, "note: ", text, sizeof text);
  assert_string_equal(text, "");
}

/* A camera's frame traces no photon, and the camera ends where it was. */
TEST(camera) {
  abbe_image after;
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  const abbe_render_desc small = {.width = 16, .height = 16, .photons = 16, .map_size = 32};
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &small);
  MADE(abbe_image, before, abbe_renderer_read(renderer, false, &before, &error));
  for (size_t count = 1; count <= 4; count += 3) {
    double ms = 0;
    OK(abbe_frame_times_camera(renderer, &scene, &small, count, &ms, &error));
    assert_true(ms > 0);
    OK(abbe_renderer_read(renderer, false, &after, &error));
    assert_memory_equal(after.data, before.data, 16 * 16 * 3 * sizeof *after.data);
    abbe_image_free(&after);
    assert_true(draw_frame(renderer).kept[ABBE_PASS_PHOTONS]);
  }
}
