/* The tracer as a contestant: its picture is the tracer's own to the bit, its frames are timed. */
#include "tests/validation/trace_scene.h"

#include "library/choice/trace_times.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")

TEST(the_picture_is_the_tracers) {
  abbe_trace_times times;
  const abbe_trace_times_desc desc = {
      .passes = 2, .photons = 16, .width = 16, .height = 12, .frames = 3};
  const abbe_trace_desc same = {
      .no_map = true, .width = 16, .height = 12, .photons = 256, .seed = ABBE_TRACE_TIMES_SEED};
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  MADE(abbe_image, picture, abbe_trace_times_measure(&scene, &desc, &times, &picture, &error));
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &same);
  run_passes(tracer, 2);
  MADE(abbe_image, own, abbe_tracer_picture(tracer, &own, &error));
  assert_int_equal(picture.channels, own.channels);
  assert_memory_equal(picture.data, own.data, 16 * 12 * own.channels * sizeof *own.data);
  assert_true(times.fastest_ms > 0);
  assert_true(times.frame_ms >= times.fastest_ms);
  assert_true(times.light_ms + times.eye_ms <= times.frame_ms);
  assert_true(times.own_de > 0);
}

TEST(what_is_refused) {
  int asked = 0;
  abbe_trace_times times;
  abbe_trace_times_desc desc = FIELDS(.passes = 2, .photons = 16, .width = 8, .height = 8,
                                      .progress = stop_at_once, .user = &asked);
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  REFUSED(ABBE_CANCELLED, "", abbe_trace_times_measure(&scene, &desc, &times, NULL, &error));
  assert_int_equal(asked, 1);
  desc.filtered = true;
  desc.passes = 1;
  REFUSED(ABBE_INVALID_ARGUMENT, "too few to trace and filter",
          abbe_trace_times_measure(&scene, &desc, &times, NULL, &error));
}
