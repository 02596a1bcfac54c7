/* Points in place of lights that have a size: their light and their places. */
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "scenes/lights/environment_lights.h"

#define DISK                                                                                       \
  "lights:\n- {name: panel, kind: disk, position: [0, 0, 0.5], direction: [0, 0, -1], radius: "    \
  "0.2, radiance: 3}\n"

TEST(one_point_is_the_middle) {
  abbe_scene lit;
  OWNED(abbe_scene, scene) = scene_of(CAMERA DISK FLOOR);
  assert_true(abbe_area_lights_any(&scene));
  OK(abbe_area_lights_add(&scene, 1, ABBE_SCENE_MAX_LIGHTS, &lit, &error));
  assert_false(abbe_area_lights_any(&lit));
  assert_int_equal(lit.light_count, 1);
  assert_near(lit.light[0].power, 3 * ABBE_PI * 0.04, 1e-12);
  assert_memory_equal(lit.light[0].position, scene.light[0].position, sizeof(double[3]));
  free(lit.light);
}

/* Irradiance below its middle is pi L R^2 / (R^2 + h^2); on the floor beside it the points' means
 * come nearer to it the more there are. */
TEST(points_shine_as_the_disk) {
  static const double within[] = {0.2, 0.05, 0.02};
  for (int i = 0; i < 3; i++) {
    const size_t points = (size_t)1 << 2 * i;
    abbe_scene lit;
    double sum = 0;
    OWNED(abbe_scene, scene) = scene_of(CAMERA DISK FLOOR);
    OK(abbe_area_lights_add(&scene, points, ABBE_SCENE_MAX_LIGHTS, &lit, &error));
    assert_int_equal(lit.light_count, points);
    for (size_t k = 0; k < points; k++) {
      double away[3];
      for (int axis = 0; axis < 3; axis++) away[axis] = -lit.light[k].position[axis];
      const double distance = abbe_vector_length(away);
      abbe_vector_normalise(away);
      sum += lit.light[k].power * abbe_light_profile(&lit.light[k], away) * -away[2] /
             (distance * distance);
      assert_near(lit.light[k].position[2], 0.5, 1e-12);
      assert_true(hypot(lit.light[k].position[0], lit.light[k].position[1]) < 0.2);
    }
    assert_near(sum / (ABBE_PI * 3 * 0.04 / (0.04 + 0.25)), 1, within[i]);
    free(lit.light);
  }
}

/* A rectangle of 0.4 x 0.1: of 8 points six stand in a row and a half; those that make even rows
 * do, in the middles of equal parts. */
TEST(a_rectangle_is_a_grid) {
  abbe_scene lit;
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA "lights:\n- {name: panel, kind: rectangle, position: [0, 0, 0.5], direction: "
                      "[0, 0, -1], width: 0.4, height: 0.1, radiance: 3}\n" FLOOR);
  assert_near(abbe_light_area(&scene.light[0]), 0.04, 1e-12);
  OK(abbe_area_lights_add(&scene, 8, ABBE_SCENE_MAX_LIGHTS, &lit, &error));
  assert_int_equal(lit.light_count, 6); /* sqrt(8 x 4) is 6 columns */
  double sum = 0;
  for (size_t i = 0; i < lit.light_count; i++) {
    sum += lit.light[i].power;
    assert_near(fabs(lit.light[i].position[0]), 0.4 / 12 * (double)(i < 3 ? 5 - 2 * i : 2 * i - 5),
                1e-12);
    assert_near(lit.light[i].position[1], 0, 1e-12);
    assert_int_equal(lit.light[i].points, 6);
  }
  assert_near(sum, 3 * 0.04, 1e-12);
  free(lit.light);
  OK(abbe_area_lights_add(&scene, 16, ABBE_SCENE_MAX_LIGHTS, &lit, &error));
  assert_int_equal(lit.light_count, 16); /* 8 columns, 2 rows */
  assert_near(fabs(lit.light[0].position[1]), 0.025, 1e-12);
  free(lit.light);
}

TEST(others_stay_and_room_is_kept) {
  abbe_scene lit;
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA DISK "- {name: second, kind: disk, position: [1, 0, 0.5], direction: [0, 0, -1], "
                  "radius: 0.2, radiance: 3}\n"
                  "- {name: lamp, kind: point, position: [0, 1, 0.5], intensity: 1}\n" FLOOR);
  OK(abbe_area_lights_add(&scene, 16, 12, &lit, &error));
  assert_int_equal(lit.light_count, 11);
  assert_int_equal(lit.light[0].points, 5);
  assert_string_equal(lit.light[10].name, "lamp");
  assert_near(lit.light[10].power, 1, 0);
  free(lit.light);
  OK(abbe_area_lights_add(&scene, 16, 1, &lit, &error));
  assert_int_equal(lit.light_count, 3);
  free(lit.light);
}
