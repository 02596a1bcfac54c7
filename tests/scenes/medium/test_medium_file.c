/* Media in scene files: what they say is read, what is wrong is told with its line. */
#include "tests/scenes/scene_text.h"

#include "scenes/medium/medium.h"

TEST(mist_and_murky_glass_are_read) {
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA POINT_LIGHT
      "medium: {scattering: [[400, 4], [500, 2]], absorption: 0.5, g: -0.3,\n"
      "         box: [[-1, -2, -3], [1, 2, 3]]}\n" FLOOR
      "- {name: ball, shape: sphere, radius: 0.08, material: flat, medium: {scattering: 7}}\n"
      "- {name: clear, shape: sphere, radius: 0.01, material: flat}\n");
  assert_true(abbe_scene_is_hazy(&scene));
  const abbe_medium *m = scene.medium;
  assert_near(abbe_medium_scattering(m, 450), 3, 1e-12);
  assert_near(abbe_medium_absorption(m, 700), 0.5, 0);
  assert_near(m->g, -0.3, 0);
  for (int k = 0; k < 3; k++) {
    assert_near(m->min[k], -1 - k, 0);
    assert_near(m->max[k], 1 + k, 0);
  }
  assert_null(scene.object[0].medium);
  assert_near(abbe_medium_scattering(scene.object[1].medium, 600), 7, 0);
  assert_null(scene.object[1].medium->absorption);
  assert_null(scene.object[2].medium);
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  assert_false(abbe_scene_is_hazy(&scene));
}

static void refuses(const char *air, const char *object, const char *says) {
  abbe_scene scene;
  abbe_error error = {0};
  const char *text =
      printed("camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT "%s" FLOOR "%s",
              air, object);
  if (abbe_scene_parse(text, strlen(text), "text", NULL, &scene, &error) == ABBE_OK)
    fail_msg("%s%s was read", air, object);
  if (strstr(error.text, says) == NULL) fail_msg("%s%s: %s", air, object, error.text);
}

TEST(bad_mist_is_refused) {
  static const char *const bad[][2] = {
      {"medium: 0.3\n", "text:4: 'medium' wants a mapping"},
      {"medium: {scattering: 0.3}\n", "text:4: the air's 'medium' needs a 'box'"},
      {"medium: {box: [[0, 0, 0], [1, 1, 1]]}\n", "does nothing"},
      {"medium: {scattering: -1, box: [[0, 0, 0], [1, 1, 1]]}\n", "'scattering: -1'"},
      {"medium: {scattering: .nan, box: [[0, 0, 0], [1, 1, 1]]}\n", "scattering"},
      {"medium: {scattering: 2e6, box: [[0, 0, 0], [1, 1, 1]]}\n", "'scattering: 2e6'"},
      {"medium: {scattering: 1, g: 1, box: [[0, 0, 0], [1, 1, 1]]}\n", "'g: 1'"},
      {"medium: {scattering: [], box: [[0, 0, 0], [1, 1, 1]]}\n", "'scattering' has 0 points"},
      {"medium: {scattering: [[400]], box: [[0, 0, 0], [1, 1, 1]]}\n", "[nm, per metre]"},
      {"medium: {scattering: [[500, 1], [400, 1]], box: [[0, 0, 0], [1, 1, 1]]}\n",
       "400 nm after 500 nm"},
      {"medium: {scattering: [[500, -1]], box: [[0, 0, 0], [1, 1, 1]]}\n", "-1"},
      {"medium: {scattering: 1, box: [[0, 0, 0], [1, 0, 1]]}\n", "from 0 to 0 along y"},
      {"medium: {scattering: 1, box: [[0, 0], [1, 0, 1]]}\n", "a corner of 'box'"},
      {"medium: {scattering: 1, box: 3}\n", "two corners"},
      {"medium: {scattering: 1, box: [[0, 0, 0], [1, .inf, 1]]}\n", "box"},
      {"medium: {scatering: 1, box: [[0, 0, 0], [1, 1, 1]]}\n", "scattering"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) refuses(bad[i][0], "", bad[i][1]);
}

TEST(bad_insides_are_refused) {
  static const char *const bad[][2] = {
      {"- {name: a, shape: sphere, radius: 0.08, reflectance: 1, medium: {scattering: 7}}\n",
       "no 'material'"},
      {"- {name: a, shape: sphere, radius: 0.08, mirror: 1, medium: {scattering: 7}}\n",
       "no 'material'"},
      {"- {name: a, shape: sphere, radius: 0.08, material: calcite, medium: {scattering: 7, g: "
       "-1}}\n",
       "'g: -1'"},
      {"- {name: a, shape: sphere, radius: 0.08, material: calcite, clouds: [{centre: [0, 0, "
       "0.04], "
       "radius: 0.05, medium: {scattering: 7}}]}\n",
       "the cloud reaches out of 'a'"},
      {"- {name: a, shape: sphere, radius: 0.08, material: calcite, clouds: [{radius: 0.05, size: "
       "[1, 1, 1]}]}\n",
       "a 'radius' or a 'size'"},
      {"- {name: a, shape: sphere, radius: 0.08, material: calcite, clouds: [{radius: 0, medium: "
       "{scattering: 7}}]}\n",
       "the 'radius' of a cloud is above 0"},
      {"- {name: a, shape: sphere, radius: 0.08, material: calcite, clouds: [{size: [0.01, 0, "
       "0.01], "
       "medium: {scattering: 7}}]}\n",
       "the 'size' of a cloud is above 0"},
      {"- {name: a, shape: sphere, radius: 0.08, reflectance: 1, clouds: [{radius: 0.05}]}\n",
       "no 'material'"},
      {"- {name: a, shape: sphere, radius: 0.08, material: n-bk7, medium: {scattering: 7, "
       "absorption: 1}}\n",
       "its material's"},
      {"- {name: a, shape: sphere, radius: 0.08, material: n-bk7, medium: {scattering: 7, box: "
       "[[0, 0, 0], [1, 1, 1]]}}\n",
       "leave out its 'box'"},
      {"- {name: a, shape: sphere, radius: 0.08, material: n-bk7, medium: {g: 0.5}}\n",
       "does nothing"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) refuses("", bad[i][0], bad[i][1]);
}
