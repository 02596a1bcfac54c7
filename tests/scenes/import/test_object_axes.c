/* How crystals lie in their objects: what is read, made square and refused. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/import/scene_file.h"

#define HEAD                                                                                       \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"                                            \
  "lights: [{name: l, kind: point, position: [0, 0, 2], intensity: 1}]\nobjects:\n"                \
  "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 1}\n"                       \
  "- {name: a, shape: box, size: [0.1, 0.1, 0.1], transform: [{rotate: {axis: [0, 0, 1], angle: "  \
  "90}}, {translate: [0, 0, 0.2]}], "

static abbe_result parse(const char *rest, abbe_scene *scene, abbe_error *error) {
  const char *text = printed(HEAD "%s}\n", rest);
  return abbe_scene_parse(text, strlen(text), "scene", NULL, scene, error);
}

static void check_axes(const char *rest, const double x[3], const double z[3]) {
  MADE(abbe_scene, scene, parse(rest, &scene, &error));
  const abbe_object *o = &scene.object[1];
  for (int k = 0; k < 3; k++) {
    assert_near(o->axis_x[k], x[k], 1e-12);
    assert_near(o->axis[k], z[k], 1e-12);
  }
}

TEST(axes_turn_with_the_object) {
  const double r = sqrt(0.5);
  check_axes("material: topaz", (double[3]){0, 1, 0}, (double[3]){0, 0, 1});
  check_axes("material: topaz, axes: {x: [0, 0, 3], z: [2, 0, 0]}", (double[3]){0, 0, 1},
             (double[3]){0, 1, 0});
  check_axes("material: topaz, axes: {z: [1, 0, 1]}", (double[3]){0, r, -r}, (double[3]){0, r, r});
  check_axes("material: calcite, axes: {z: [0, 1, 0]}", (double[3]){0, 1, 0},
             (double[3]){-1, 0, 0});
}

TEST(x_is_made_square_to_z) {
  MADE(abbe_scene, scene,
       parse("material: topaz, axes: {x: [1, 0, 0.1], z: [0, 0, 1]}", &scene, &error));
  assert_near(abbe_vector_dot(scene.object[1].axis_x, scene.object[1].axis), 0, 1e-15);
  assert_near(scene.object[1].axes_turned, atan(0.1), 1e-12);
}

TEST(axes_that_cannot_be_are_refused) {
  const struct {
    const char *rest, *part;
  } rows[] = {
      {"material: n-bk7, axes: {x: [1, 0, 0], z: [0, 0, 1]}",
       "'axes' is for the axes of a crystal; the material 'n-bk7' has one index"},
      {"material: topaz, axis: [0, 0, 1]", "has three indices: give 'axes'"},
      {"material: topaz, axis: [0, 0, 1], axes: {z: [0, 0, 1]}", "leave one out"},
      {"material: topaz, axes: {x: [1, 0, 1], z: [2, 0, 2]}", "x and z are parallel"},
      {"material: topaz, axes: {x: [0, 0, 0], z: [0, 0, 1]}", "'x' is zero"},
      {"material: topaz, axes: {x: [1, 0], z: [0, 0, 1]}", "'x'"},
      {"material: topaz, axes: {x: [1, 0, 0], z: [0, 0, 1], y: [0, 1, 0]}", "has no key 'y'"},
      {"material: topaz, axes: [0, 0, 1]", "'axes' wants the principal axes x and z"},
      {"reflectance: 1, axes: {z: [0, 0, 1]}", "this object has no 'material'"},
      {"material: topaz, medium: {scattering: 1}", "is a crystal"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_scene scene;
    REFUSED(ABBE_SCHEMA, rows[i].part, parse(rows[i].rest, &scene, &error));
  }
}
