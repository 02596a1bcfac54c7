#include "tests/check.h"

#include "scenes/scene.h"
#include "scenes/shapes/shape.h"

TEST(profile_of_a_spot_falls_smoothly) {
  const abbe_light spot = {
      .kind = ABBE_LIGHT_SPOT, .direction = {0, 0, -1}, .cone_rad = 0.6, .soft_rad = 0.2};
  double last = 1.0;
  for (int i = 0; i <= 100; i++) {
    const double angle = 0.01 * i, d[3] = {sin(angle), 0, -cos(angle)};
    const double value = abbe_light_profile(&spot, d);
    assert_true(value <= last && value >= 0.0);
    if (angle < 0.399) assert_true(value == 1.0);
    if (angle > 0.601) assert_true(value == 0.0);
    last = value;
  }
  const double middle = acos(0.5 * (cos(0.4) + cos(0.6)));
  const double d[3] = {sin(middle), 0, -cos(middle)};
  assert_true(fabs(abbe_light_profile(&spot, d) - 0.5) < 1e-12);
}

TEST(profile_of_a_hard_spot_is_a_step) {
  const abbe_light spot = {.kind = ABBE_LIGHT_SPOT, .direction = {1, 0, 0}, .cone_rad = 0.5};
  const double in[3] = {cos(0.49), sin(0.49), 0}, out[3] = {cos(0.51), sin(0.51), 0};
  assert_true(abbe_light_profile(&spot, in) == 1.0);
  assert_true(abbe_light_profile(&spot, out) == 0.0);
}

TEST(other_lights_have_no_profile) {
  const double back[3] = {0, 0, 1};
  const abbe_light point = {.kind = ABBE_LIGHT_POINT};
  const abbe_light sun = {.kind = ABBE_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}};
  assert_true(abbe_light_profile(&point, back) == 1.0);
  assert_true(abbe_light_profile(&sun, back) == 1.0);
}

TEST(a_disk_shines_by_the_cosine) {
  const abbe_light disk = {.kind = ABBE_LIGHT_DISK, .direction = {0, 0.6, -0.8}, .radius = 2};
  const double along[3] = {0, 0.6, -0.8}, aside[3] = {1, 0, 0}, slant[3] = {0.8, 0.36, -0.48},
               behind[3] = {0, -0.6, 0.8};
  assert_true(fabs(abbe_light_profile(&disk, along) - 1.0) < 1e-12);
  assert_true(abbe_light_profile(&disk, aside) == 0.0);
  assert_true(fabs(abbe_light_profile(&disk, slant) - 0.6) < 1e-12);
  assert_true(abbe_light_profile(&disk, behind) == 0.0);
}

TEST(bounds_choose_what_is_asked) {
  const abbe_material glass = {0};
  abbe_object objects[2] = {{.material = &glass, .min = {-1, 0, 0}, .max = {1, 1, 1}},
                            {.min = {0, -5, 0}, .max = {0, 5, 9}}};
  const abbe_scene scene = {.object_count = 2, .object = objects};
  double min[3], max[3];
  assert_true(abbe_scene_bounds(&scene, true, false, min, max));
  assert_true(min[0] == -1 && max[2] == 1);
  assert_true(abbe_scene_bounds(&scene, false, true, min, max));
  assert_true(min[1] == -5 && max[0] == 0);
  assert_true(abbe_scene_bounds(&scene, true, true, min, max));
  assert_true(min[0] == -1 && max[2] == 9);
  assert_false(abbe_scene_bounds(&scene, false, false, min, max));
}

/* A mirror is neither of the other two; its bounds go with refractors'. */
TEST(mirrors_are_a_kind_of_their_own) {
  const abbe_material glass = {0}, metal = {0};
  abbe_object objects[3] = {{.material = &glass, .min = {-1, 0, 0}, .max = {1, 1, 1}},
                            {.min = {0, -5, 0}, .max = {0, 5, 9}},
                            {.mirror = true, .conductor = &metal, .max = {20, 20, 20}}};
  const abbe_scene scene = {.object_count = 3, .object = objects};
  double min[3], max[3];
  static const char *const names[] = {"refractor", "receiver", "mirror"};
  for (int i = 0; i < 3; i++)
    assert_string_equal(abbe_object_kind_name(abbe_object_kind_of(&objects[i])), names[i]);
  assert_ptr_equal(abbe_scene_mirror(&scene), &objects[2]);
  assert_true(abbe_scene_bounds(&scene, true, false, min, max));
  assert_true(max[0] == 20);
  assert_true(abbe_scene_bounds(&scene, false, true, min, max));
  assert_true(max[0] == 0);
  assert_true(abbe_scene_bounds(&scene, true, true, min, max));
  assert_true(max[0] == 20);
  assert_false(abbe_scene_bounds(&scene, false, false, min, max));
}

/* A triangle that covers the whole view though all its corners are outside. */
TEST(a_receiver_larger_than_the_view_is_in_view) {
  abbe_light light = {.kind = ABBE_LIGHT_POINT, .position = {0, 0, 50}};
  abbe_object floor = {0};
  OK(abbe_shape_rectangle(1000, 1000, &floor.mesh, &error));
  abbe_scene scene = {.light_count = 1, .light = &light, .object_count = 1, .object = &floor};
  scene.camera = (abbe_camera){.eye = {0, 0, 1},
                               .target = {0, 0, 0},
                               .up = {0, 1, 0},
                               .fov_y_rad = 0.1,
                               .width = 64,
                               .height = 64};
  OK(abbe_scene_check(&scene, &error));
  scene.camera.target[2] = 2;
  REFUSED(ABBE_UNSUPPORTED, "view", abbe_scene_check(&scene, &error));
  scene.light_count = 0;
  REFUSED(ABBE_SCHEMA, "give it at least one under", abbe_scene_check(&scene, &error));
  abbe_mesh_free(&floor.mesh);
}

TEST(freeing_nothing_is_safe) {
  OWNED(abbe_scene, scene) = {0};
  abbe_scene_free(NULL);
}

/* Nearer than single precision tells, 2^-20 of half the diagonal of a ball and a box of half side
 * 1, a lamp is on them; twice as far it is not. */
TEST(a_lamp_is_on_glass_or_off_it) {
  static const double side[3] = {2, 2, 2};
  const double gap = ABBE_SCENE_LEAST_GAP * sqrt(3);
  const abbe_material glass = {0};
  abbe_object object[2] = {{.name = "floor", .min = {-9, -9, -9}, .max = {9, 9, -9}},
                           {.name = "solid", .min = {-1, -1, -1}, .max = {1, 1, 1}}};
  OK(abbe_shape_rectangle(18, 18, &object[0].mesh, &error));
  OK(abbe_shape_box(side, &object[1].mesh, &error));
  object[1].material = &glass;
  object[1].exact.radius = 1;
  for (int ball = 0; ball < 2; ball++)
    for (int k = 0; k < 8; k++) {
      static const double away[4] = {0, 0.5, 0.99, 2};
      abbe_light lamp = {.name = "lamp", .kind = ABBE_LIGHT_POINT};
      abbe_camera camera = {.eye = {0, 0, 20}, .up = {0, 1, 0}, .fov_y_rad = 1, .width = 64};
      double *at = k < 4 ? lamp.position : camera.eye, *other = k < 4 ? camera.eye : lamp.position;
      camera.height = camera.width;
      at[0] = at[1] = ball ? 0 : 0.3;
      at[2] = 1 + gap * away[k % 4];
      other[2] = 20;
      camera.target[0] = camera.eye[0];
      camera.target[1] = camera.eye[1] + 0.1;
      object[1].exact.kind = ball ? ABBE_EXACT_SPHERE : ABBE_EXACT_NONE;
      const abbe_scene scene = {
          .camera = camera, .light_count = 1, .light = &lamp, .object_count = 2, .object = object};
      abbe_error why = {0};
      const abbe_result result = abbe_scene_check(&scene, &why);
      if (result != (k % 4 < 3 ? ABBE_UNSUPPORTED : ABBE_OK))
        fail_msg("%g gaps off the %s: '%s'", away[k % 4], ball ? "ball" : "box", why.text);
      if (result == ABBE_OK) continue;
      assert_non_null(strstr(why.text, "surface of the refractor 'solid'"));
      assert_non_null(strstr(why.text, k < 4 ? "the light 'lamp'" : "the camera's eye"));
    }
  abbe_mesh_free(&object[0].mesh);
  abbe_mesh_free(&object[1].mesh);
}

/* Disks beside, above, across, around and inside a ball and a box of half side 1; the rim's
 * distance is known. */
TEST(no_part_of_a_disk_is_in_glass) {
  static const struct {
    double position[3], direction[3], radius;
    bool ball, box; /* meets it */
  } disks[] = {
      {{3, 0, 0}, {0, 0, 1}, 1.99, false, false},  {{3, 0, 0}, {0, 0, 1}, 2.01, true, true},
      {{0, 0, 1.01}, {0, 0, 1}, 50, false, false}, {{0, 0, 0.99}, {0, 0, 1}, 50, true, true},
      {{3, 0, 0}, {1, 0, 0}, 50, false, false},    {{3, 0, 0.9}, {0, 0, -1}, 2.1, false, true},
      {{3, 0, 0.9}, {0, 0, -1}, 2.6, true, true},  {{1.01, 0, 0}, {1, 0, 0}, 9, false, false},
      {{2, 2, 0}, {0, 0, 1}, 1.4, false, false},   {{2, 2, 0}, {0, 0, 1}, 1.42, false, true},
      {{2, 2, 0}, {0, 0, 1}, 1.83, true, true},    {{0.5, 0.2, 0.1}, {0, 1, 0}, 0.01, true, true},
      {{0, 0, 1}, {0, 0, 1}, 0.5, true, true},     {{1.2, 0, 1}, {0, 0, 1}, 0.5, false, true},
      {{9, 0.1, 0.1}, {0, 0, 1}, 1e5, true, true}, {{9, 0.1, 1.5}, {0, 0, 1}, 1e5, false, false},
  };
  abbe_object object[2] = {{.name = "floor", .min = {-9, -9, -9}, .max = {9, 9, -9}},
                           {.name = "solid", .min = {-1, -1, -1}, .max = {1, 1, 1}}};
  static const double side[3] = {2, 2, 2};
  const abbe_material glass = {0};
  OK(abbe_shape_rectangle(18, 18, &object[0].mesh, &error));
  OK(abbe_shape_box(side, &object[1].mesh, &error));
  object[1].material = &glass;
  object[1].exact.radius = 1;
  for (size_t i = 0; i < sizeof disks / sizeof *disks; i++) {
    abbe_light light = {.name = "lamp", .kind = ABBE_LIGHT_DISK, .radius = disks[i].radius};
    memcpy(light.position, disks[i].position, sizeof light.position);
    memcpy(light.direction, disks[i].direction, sizeof light.direction);
    const abbe_scene scene =
        FIELDS(.camera =
                   {.eye = {0, 0, 20}, .up = {0, 1, 0}, .fov_y_rad = 1, .width = 64, .height = 64},
               .light_count = 1, .light = &light, .object_count = 2, .object = object);
    for (int ball = 0; ball < 2; ball++) {
      abbe_error why = {0};
      object[1].exact.kind = ball ? ABBE_EXACT_SPHERE : ABBE_EXACT_NONE;
      const abbe_result wanted = (ball ? disks[i].ball : disks[i].box) ? ABBE_UNSUPPORTED : ABBE_OK;
      if (abbe_scene_check(&scene, &why) != wanted)
        fail_msg("disk %zu and the %s: '%s'", i, ball ? "ball" : "box", why.text);
    }
  }
  abbe_mesh_free(&object[0].mesh);
  abbe_mesh_free(&object[1].mesh);
}

/* Of a box of 2 x 4 x 6 m; below a limit the same, at or beyond it no less. */
TEST(distances_end_where_they_are_not_asked) {
  static const struct {
    double at[3], away;
  } rows[] = {{{0, 0, 0}, 1}, {{0.75, 1, 1}, 0.25}, {{4, 0, 0}, 3}, {{4, 6, 2}, 5}};
  const double size[3] = {2, 4, 6};
  abbe_object box = {0};
  OK(abbe_shape_box(size, &box.mesh, &error));
  abbe_object_bound(&box);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const double *p = rows[i].at, away = rows[i].away;
    assert_near(abbe_object_distance(&box, p), away, 1e-12);
    assert_near(abbe_object_distance_within(&box, p, 1.01 * away), away, 1e-12);
    assert_true(abbe_object_distance_within(&box, p, 0.5 * away) >= 0.5 * away);
  }
  abbe_mesh_free(&box.mesh);
}

TEST(lights_are_found_by_name_or_number) {
  abbe_light light[4] = {{.name = "lamp"}, {.name = "1"}, {.name = "sun"}, {.name = "sun"}};
  const abbe_scene scene = {.path = "s.yaml", .light_count = 4, .light = light};
  size_t index = 9;
  OK(abbe_scene_find_light(&scene, "lamp", &index, &error));
  assert_int_equal(index, 0);
  OK(abbe_scene_find_light(&scene, "1", &index, &error));
  assert_int_equal(index, 1); /* a name goes before a number */
  OK(abbe_scene_find_light(&scene, "4", &index, &error));
  assert_int_equal(index, 3);
  static const char *const none[] = {"",   "0",  "5",    "-1",   "1x",
                                     "+1", " 1", "moon", "LAMP", "99999999999999999999999"};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, "no light is called",
            abbe_scene_find_light(&scene, none[i], &index, &error));
    assert_non_null(strstr(last_error.text, "1 'lamp', 2 '1', 3 'sun', 4 'sun'"));
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "more than one light is called 'sun'",
          abbe_scene_find_light(&scene, "sun", &index, &error));
}

/* Two crystals a metre apart along x, each within a ball of 0.17 m. */
TEST(crystals_stand_in_line_or_not) {
  abbe_material crystal = {.extraordinary = {.count = 1}}, glass = {0};
  abbe_object object[2] = {
      {.min = {-0.1, -0.1, -0.1}, .max = {0.1, 0.1, 0.1}, .material = &crystal},
      {.min = {0.9, -0.1, -0.1}, .max = {1.1, 0.1, 0.1}, .material = &crystal}};
  abbe_light light = {.kind = ABBE_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}};
  abbe_scene scene = {.object = object,
                      .object_count = 2,
                      .light = &light,
                      .light_count = 1,
                      .camera.eye = {0.5, -3, 0}};
  assert_null(abbe_scene_crystal_in_line(&scene));
  scene.camera.eye[0] = 3;
  scene.camera.eye[1] = -0.3;
  assert_ptr_equal(abbe_scene_crystal_in_line(&scene), &object[1]);
  object[0].material = &glass;
  assert_null(abbe_scene_crystal_in_line(&scene));
  object[0].material = &crystal;
  scene.camera.eye[1] = -3;
  assert_null(abbe_scene_crystal_in_line(&scene));
  light.direction[0] = sqrt(0.96);
  light.direction[2] = -0.2;
  assert_non_null(abbe_scene_crystal_in_line(&scene));
}
