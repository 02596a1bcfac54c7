#include "tests/check.h"
#include "tests/scenes/scene_text.h"

#include "gl/scene/camera_view.h"

static void fit(const abbe_render_desc *desc, double fov_y_rad, abbe_camera_view *out) {
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  scene.camera.fov_y_rad = fov_y_rad;
  abbe_camera_view_fit(&scene, desc, out);
}

/* A quarter turn up: tangents of 1 up and of the picture's shape across. */
TEST(the_window_is_the_field_of_view) {
  const abbe_render_desc desc = {.width = 200, .height = 100, .supersample = 2, .upsample = 1};
  abbe_camera_view camera;
  fit(&desc, acos(0), &camera);
  assert_int_equal(camera.samples[0], 400);
  assert_int_equal(camera.samples[1], 200);
  const double window[4] = {-2, 2, -1, 1};
  for (int k = 0; k < 4; k++) assert_near(camera.view.window[k], window[k], 1e-12);
  assert_true(camera.view.near > 0 && camera.view.near < camera.view.far);
}

/* 34 samples of three pixels cover 100, and two more on the right; rows likewise at the top. */
TEST(the_last_sample_may_stand_out) {
  const abbe_render_desc desc = {.width = 100, .height = 100, .supersample = 1, .upsample = 3};
  abbe_camera_view camera;
  fit(&desc, acos(0), &camera);
  for (int axis = 0; axis < 2; axis++) {
    assert_int_equal(camera.samples[axis], 34);
    assert_near(camera.view.window[2 * axis], -1, 1e-12);
    assert_near(camera.view.window[2 * axis + 1], -1 + 2 * 1.02, 1e-12);
  }
}

/* Targets of pictures that follow each other in other sizes are all of one kind to a driver. */
TEST(targets_of_coarse_pictures_are_no_power_of_two) {
  static const size_t heights[] = {1, 2, 64, 100, 255};
  abbe_render_desc desc = {.width = 512, .supersample = 1};
  for (size_t i = 0; i < sizeof heights / sizeof *heights; i++)
    for (desc.upsample = 1; desc.upsample <= 4; desc.upsample++)
      for (int coarse = ABBE_COARSE_NONE; coarse <= ABBE_COARSE_EYE; coarse++) {
        abbe_camera_view camera;
        desc.height = heights[i];
        desc.coarse = (abbe_coarse)coarse;
        fit(&desc, acos(0), &camera);
        for (int axis = 0; axis < 2; axis++) {
          const size_t samples = camera.samples[axis], room = camera.room[axis];
          assert_int_equal(camera.receiver_room[axis], room);
          assert_int_in_range(room, samples, samples + (coarse ? samples < 2 ? 2 : 1 : 0));
          assert_true(coarse == ABBE_COARSE_NONE || (room & (room - 1)) != 0);
        }
      }
}

/* By a part of a sample, of which two make a pixel; nothing else moves. */
TEST(a_shift_moves_the_window) {
  const abbe_render_desc desc = {
      .width = 50, .height = 50, .supersample = 2, .upsample = 1, .sample_shift = {0.5, -0.25}};
  abbe_camera_view camera;
  fit(&desc, acos(0), &camera);
  const double sample = 2.0 / 100;
  assert_near(camera.view.window[0], -1 + 0.5 * sample, 1e-12);
  assert_near(camera.view.window[1], 1 + 0.5 * sample, 1e-12);
  assert_near(camera.view.window[2], -1 - 0.25 * sample, 1e-12);
  assert_near(camera.view.window[3], 1 - 0.25 * sample, 1e-12);
}
