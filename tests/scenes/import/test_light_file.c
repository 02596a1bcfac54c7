/* The lights of a scene file: what kinds have, and what is refused. */
#include "tests/check.h"

#include "base/maths.h"
#include "base/yaml/yaml.h"
#include "scenes/import/scene_file.h"
#include "scenes/import/scene_reading.h"

static abbe_result read(const char *text, abbe_light **light, size_t *count, abbe_error *error) {
  abbe_yaml *yaml = NULL;
  *error = (abbe_error){0};
  assert_int_equal(abbe_yaml_parse(text, strlen(text), "lights.yaml", &yaml, error), ABBE_OK);
  const abbe_result result = abbe_lights_read(yaml, abbe_yaml_root(yaml), "", light, count, error);
  abbe_yaml_free(yaml);
  return result;
}

TEST(each_kind_is_read) {
  abbe_light *light;
  size_t count;
  OK(read("lights:\n- {kind: point, position: [1, 2, 3], intensity: 4}\n- {name: s, kind: spot, "
          "position: [0, 0, 2], target: [0, 0, 0], intensity: 1, cone: 30, soft: 6}\n- {kind: "
          "directional, direction: [0, 3, 4], irradiance: 5}\n- {kind: disk, position: [0, 0, 1], "
          "direction: [0, 0, -1], radius: 0.1, radiance: 6}\n- {kind: rectangle, position: [0, 0, "
          "1], direction: [0, 0, -1], width: 0.4, height: 0.2, radiance: 7, illuminant: A}\n",
          &light, &count, &error));
  assert_int_equal(count, 5);
  for (size_t i = 0; i < count; i++) {
    static const double powers[] = {4, 1, 5, 6, 7};
    assert_int_equal(light[i].kind, i);
    assert_near(light[i].power, powers[i], 0);
  }
  assert_string_equal(light[0].name, "light on line 2");
  assert_string_equal(light[1].name, "s");
  assert_near(light[1].direction[2], -1, 1e-15);
  assert_near(light[1].cone_rad, 3.14159265358979323846 / 6, 1e-15);
  assert_near(light[2].direction[1], 0.6, 1e-15);
  assert_near(abbe_light_area(&light[4]), 0.08, 1e-15);
  abbe_lights_free(light, count);
  OK(read("ambient: 1\n", &light, &count, &error));
  assert_int_equal(count, 0);
  abbe_lights_free(light, count);
  abbe_lights_free(NULL, 0);
}

#define SUN_THROUGH(sheet)                                                                         \
  "lights:\n- {kind: directional, direction: [0, 0, -1], irradiance: 1, polariser: " sheet "}\n"

TEST(polarisers_are_read) {
  static const struct {
    const char *text;
    abbe_polariser_kind kind;
    double degrees;
  } rows[] = {{SUN_THROUGH("{angle: 30}"), ABBE_POLARISER_LINEAR, 30},
              {SUN_THROUGH("{kind: linear}"), ABBE_POLARISER_LINEAR, 0},
              {SUN_THROUGH("{kind: right}"), ABBE_POLARISER_RIGHT, 0},
              {SUN_THROUGH("{kind: left}"), ABBE_POLARISER_LEFT, 0}};
  for (size_t i = 0; i < 4; i++) {
    abbe_light *light;
    size_t count;
    OK(read(rows[i].text, &light, &count, &error));
    assert_int_equal(light->polariser.kind, rows[i].kind);
    assert_near(light->polariser.angle_rad, rows[i].degrees * ABBE_DEGREE, 1e-15);
    abbe_lights_free(light, count);
  }
}

TEST(what_no_light_has_is_refused) {
  static const char *const bad[][2] = {
      {"lights: 3\n", "'lights' wants a list"},
      {"lights:\n- {position: [0, 0, 1], intensity: 1}\n", "kind"},
      {"lights:\n- {kind: point, position: [0, 0, 1]}\n", "intensity"},
      {"lights:\n- {kind: point, position: [0, 0, 1], intensity: 1, cone: 4}\n",
       "lights.yaml:2: a point light has no 'cone'"},
      {"lights:\n- {kind: point, position: [0, 0, 1], intensity: 1, polariser: {angle: 4}}\n",
       "lights.yaml:2: a point light has no 'polariser'; a sheet is flat"},
      {SUN_THROUGH("{kind: round}"), "'kind: round' is not known"},
      {SUN_THROUGH("{angle: 400}"), "'angle: 400' is not in the range from -360 to 360"},
      {SUN_THROUGH("{kind: left, angle: 4}"), "alike at every 'angle'"},
      {SUN_THROUGH("{angel: 4}"), "did you mean 'angle'"},
      {SUN_THROUGH("3"), "polariser"},
      {"lights:\n- {kind: point, position: [0, 0, 1], intensity: 1}\n"
       "- {kind: directional, direction: [0, 0, 0], irradiance: 1}\n",
       "lights.yaml:3: the light's direction is zero"},
      {"lights:\n- {kind: point, position: [0, 0, 1], intensity: 1e-31}\n", "too faint"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    abbe_light *light;
    size_t count;
    abbe_error error;
    assert_int_not_equal(read(bad[i][0], &light, &count, &error), ABBE_OK);
    assert_contains(error.text, bad[i][1]);
    abbe_lights_free(light, count);
  }
}

/* Lights alone are read again: as with all else, and the objects stay where they are. */
TEST(lights_change_alone) {
  static const char *const sets[][2] = {
      {"lights.lamp.position=[0.02, 0.03, 0.25]", "ambient=0.5"},
      {"background=0.25", "lights.lamp={kind: point, position: [0, 0, 0.28], intensity: 3}"},
      {"lights.lamp.illuminant=A", "lights.lamp.intensity=0.5"}};
  const char *path = ABBE_SOURCE_DIR "/scenes/gem.yaml";
  abbe_scene anew;
  abbe_error why = {0};
  MADE(abbe_scene, scene, abbe_scene_load(path, NULL, &scene, &error));
  const abbe_object *objects = scene.object;
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    const abbe_scene_options options = {.set = sets[i], .set_count = 2};
    OK(abbe_scene_load_lights(path, &options, &scene, &error));
    OK(abbe_scene_load(path, &options, &anew, &error));
    assert_ptr_equal(scene.object, objects);
    assert_int_equal(scene.light_count, anew.light_count);
    const abbe_light *a = scene.light, *b = anew.light;
    assert_string_equal(a->name, b->name);
    assert_int_equal(a->kind, b->kind);
    assert_memory_equal(a->position, b->position, sizeof a->position);
    assert_memory_equal(a->direction, b->direction, sizeof a->direction);
    assert_true(a->power == b->power && a->illuminant.kind == b->illuminant.kind);
    assert_true(scene.ambient == anew.ambient && scene.background == anew.background);
    for (size_t k = 0; k < anew.object_count; k++)
      assert_int_equal(scene.object[k].line, anew.object[k].line);
    abbe_scene_free(&anew);
  }
  /* what is refused changes nothing */
  static const char *const bad[] = {"lights.lamp.intensity=-1",
                                    "lights.lamp.position=[0, 0, 0.15]"};
  for (size_t i = 0; i < 2; i++) {
    const abbe_scene_options options = {.set = &bad[i], .set_count = 1};
    assert_int_not_equal(abbe_scene_load_lights(path, &options, &scene, &why), ABBE_OK);
    assert_true(scene.light[0].power == 0.5 && scene.ambient != 0.5);
  }
}
