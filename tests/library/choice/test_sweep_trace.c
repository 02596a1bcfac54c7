/* The tracer as a contestant: its picture is the tracer's own to the bit, its frames are timed. */
#include "tests/validation/trace_scene.h"

#include "library/choice/sweep_setting.h"
#include "library/choice/sweep_trace.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")

static abbe_sweep_row row_of(size_t photons, size_t passes) {
  abbe_sweep_row row;
  abbe_sweep_setting_of_trace(photons, passes, false, &row.setting);
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) row.number[i] = NAN;
  return row;
}

TEST(the_picture_is_the_tracers) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, picture) = {0};
  OWNED(abbe_image, own) = {0};
  abbe_sweep_row row = row_of(16, 2);
  const abbe_sweep_trace_desc desc = {.width = 16, .height = 12, .frames = 3};
  const abbe_trace_desc same = {
      .no_map = true, .width = 16, .height = 12, .photons = 256, .seed = ABBE_SWEEP_TRACE_SEED};
  load_text(SCENE, &scene);
  OK(abbe_sweep_trace_check(&scene, &error));
  OK(abbe_sweep_trace_measure(&scene, &desc, &row, &picture, &error));
  abbe_tracer *tracer = make_tracer(&scene, &same);
  run_passes(tracer, 2);
  OK(abbe_tracer_picture(tracer, &own, &error));
  assert_int_equal(picture.channels, own.channels);
  assert_memory_equal(picture.data, own.data, 16 * 12 * own.channels * sizeof *own.data);
  assert_true(row.number[ABBE_SWEEP_FASTEST_MS] > 0);
  assert_true(row.number[ABBE_SWEEP_FRAME_MS] >= row.number[ABBE_SWEEP_FASTEST_MS]);
  assert_true(row.number[ABBE_SWEEP_LIGHT_MS] + row.number[ABBE_SWEEP_EYE_MS] <=
              row.number[ABBE_SWEEP_FRAME_MS]);
  assert_true(isnan(row.number[ABBE_SWEEP_MAP_RMSE]));
  abbe_tracer_free(tracer);
}

TEST(what_is_refused) {
  OWNED(abbe_scene, scene) = {0};
  int asked = 0;
  abbe_sweep_row row = row_of(16, 2);
  abbe_sweep_trace_desc desc = {.width = 8, .height = 8, .progress = stop_at_once, .user = &asked};
  load_text(SCENE, &scene);
  REFUSED(ABBE_CANCELLED, "", abbe_sweep_trace_measure(&scene, &desc, &row, NULL, &error));
  assert_int_equal(asked, 1);
  snprintf(row.setting.profile, sizeof row.setting.profile, "thesis");
  REFUSED(ABBE_INVALID_ARGUMENT, "'thesis'",
          abbe_sweep_trace_measure(&scene, &desc, &row, NULL, &error));
  const size_t lights = scene.light_count;
  scene.light_count = 0;
  REFUSED(ABBE_INVALID_ARGUMENT, "no light", abbe_sweep_trace_check(&scene, &error));
  scene.light_count = lights;
}
