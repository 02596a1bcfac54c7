/* Scenes far from the origin, moved to where floats resolve them. */
#include "tests/check.h"

#include "gl/scene/local_scene.h"
#include "tests/scenes/scene_text.h"

static void make(const abbe_scene *scene, abbe_local_scene *local) {
  OK(abbe_local_scene_make(scene, local, &error));
}

TEST(a_scene_around_the_origin_stays) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  FILLED(abbe_local_scene, local, make(&scene, &local));
  assert_false(local.moved);
  assert_ptr_equal(local.scene, &scene);
  assert_true(local.origin[0] == 0 && local.origin[1] == 0 && local.origin[2] == 0);
}

/* 1e5 m from there: to a double's last digit that is what it was at the origin. */
static const double last_digit = 1e5 * 0x1p-50;

static void check_point(const double moved[3], const double origin[3], const double world[3]) {
  for (int k = 0; k < 3; k++) assert_near(moved[k] + origin[k], world[k], last_digit);
}

TEST(everything_moves_together) {
  OWNED(abbe_scene, scene) = scene_of(
      "materials: glass.yaml\n"
      "camera: {eye: [100000, 99999, 0.5], target: [100000, 100000, 0.05]}\n"
      "lights:\n- {name: lamp, kind: point, position: [100000, 100000, 0.6], intensity: 1}\n"
      "objects:\n"
      "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5,\n"
      "   transform: [{translate: [100000, 100000, 0]}]}\n"
      "- {name: ball, shape: sphere, radius: 0.08, material: crown,\n"
      "   transform: [{translate: [100000, 100000, 0.2]}]}\n"
      "- {name: brick, shape: box, size: [0.1, 0.1, 0.1], material: crown,\n"
      "   transform: [{translate: [100000.3, 100000, 0.2]}]}\n");
  FILLED(abbe_local_scene, local, make(&scene, &local));
  assert_true(local.moved);
  assert_near(local.origin[0], 1e5 + 0.135, 1e-9);
  const abbe_scene *moved = local.scene;
  check_point(moved->camera.eye, local.origin, scene.camera.eye);
  check_point(moved->camera.target, local.origin, scene.camera.target);
  check_point(moved->light[0].position, local.origin, scene.light[0].position);
  check_point(moved->object[1].exact.centre, local.origin, scene.object[1].exact.centre);
  check_point(moved->object[0].exact.parallelogram[0], local.origin,
              scene.object[0].exact.parallelogram[0]);
  for (size_t i = 0; i < 3; i++) {
    const abbe_mesh *mesh = &moved->object[i].mesh;
    check_point(moved->object[i].min, local.origin, scene.object[i].min);
    check_point(moved->object[i].max, local.origin, scene.object[i].max);
    for (size_t v = 0; v < mesh->vertex_count; v++)
      check_point(mesh->position[v], local.origin, scene.object[i].mesh.position[v]);
  }
  /* A plane's offset is that of its own corners. */
  const abbe_object *brick = &moved->object[2];
  for (size_t i = 0; i < brick->exact.count; i++) {
    double most = -INFINITY;
    for (size_t v = 0; v < brick->mesh.vertex_count; v++) {
      double along = 0;
      for (int k = 0; k < 3; k++) along += brick->exact.plane[i][k] * brick->mesh.position[v][k];
      most = fmax(most, along);
    }
    assert_near(brick->exact.plane[i][3], most, 1e-9);
  }
  abbe_view view = {.origin = {1e5, 2e5, 3e5}}, back = view;
  abbe_local_scene_from_world(&local, &back);
  assert_near(back.origin[0], 1e5 - local.origin[0], last_digit);
  abbe_local_scene_to_world(&local, &back);
  check_point(back.origin, (const double[3]){0, 0, 0}, view.origin);
  abbe_local_scene_free(&local);
}

TEST(lights_repeat_where_the_scene_is) {
  static const char *const texts[] = {
      CAMERA POINT_LIGHT FLOOR BALL("crown"),
      CAMERA POINT_LIGHT FLOOR "- {name: ball, shape: sphere, radius: 0.08, levels: 2, transform: "
                               "[{translate: [1000, 0, 0.2]}], material: crown}\n"};
  for (int i = 0; i < 2; i++) {
    abbe_error error = {0};
    OWNED(abbe_scene, scene) = scene_of(texts[i]);
    FILLED(abbe_local_scene, local, make(&scene, &local));
    assert_true(local.moved == (i == 1));
    double at[3];
    memcpy(at, local.scene->light[0].position, sizeof at);
    assert_int_equal(abbe_local_scene_repeat_lights(&local, (const size_t[3]){0, 0, 0}, 3, &error),
                     ABBE_OK);
    assert_int_equal(local.scene->light_count, 4);
    assert_int_equal(scene.light_count, 1);
    for (size_t k = 0; k < 4; k++) {
      assert_memory_equal(local.scene->light[k].position, at, sizeof at);
      assert_string_equal(local.scene->light[k].name, "lamp");
    }
    assert_int_equal(local.scene->object_count, scene.object_count);
  }
}

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

/* From all of the pupil what is in focus is at one place of the picture; what is twice as far moves
 * there by half of the pupil, seen from the focus. */
TEST(a_place_on_the_lens_keeps_what_is_in_focus) {
  static const double place[][2] = {{1, 0}, {0, -1}, {-0.6, 0.8}};
  abbe_scene scene = {.camera = {.target = {0, 1, 0},
                                 .up = {0, 0, 1},
                                 .fov_y_rad = acos(0),
                                 .aperture = 0.1,
                                 .focus = 2}};
  abbe_camera_view camera;
  for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
    const abbe_render_desc desc = {.width = 50,
                                   .height = 50,
                                   .supersample = 1,
                                   .upsample = 1,
                                   .lens_place = {place[i][0], place[i][1]}};
    double uvz[3];
    abbe_camera_view_fit(&scene, &desc, &camera);
    assert_true(abbe_view_project(&camera.view, (const double[3]){0.3, 2, -0.4}, uvz));
    assert_near(uvz[0], 0.5 + 0.15 / 2, 1e-12);
    assert_near(uvz[1], 0.5 - 0.2 / 2, 1e-12);
    assert_true(abbe_view_project(&camera.view, (const double[3]){0, 4, 0}, uvz));
    assert_near(uvz[0], 0.5 + 0.05 * place[i][0] * (0.5 - 0.25) / 2, 1e-12);
    assert_near(uvz[1], 0.5 + 0.05 * place[i][1] * (0.5 - 0.25) / 2, 1e-12);
  }
}
