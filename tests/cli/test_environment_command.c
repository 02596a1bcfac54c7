/* `abbe environment` as people and programs meet it: a scene, its picture, refusals. */
#include "tests/cli/run_json.h"

#include "base/file.h"

#define VIEW                                                                                       \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0]}\n"                                               \
  "objects:\n- {shape: rectangle, width: 1, height: 1, reflectance: 0.5}\n"

static void write_text(const char *name, const char *text) {
  OK(abbe_file_write(run_path(name), text, strlen(text), &error));
}

static double number(const cJSON *object, const char *key, int index) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  return cJSON_GetNumberValue(index < 0 ? item : cJSON_GetArrayItem(item, index));
}

/* A lamp at +x that is turned to +y, on a grey of 0.5. */
static void check(const char *line) {
  HELD(cJSON, json) = run_json(line, 0);
  assert_near(number(json, "irradiance_down", 0), 3.14159265 / 2, 2e-4);
  assert_near(number(json, "brightest", 1), 100.5, 0.1);
  assert_near(number(json, "brightest_azimuth", -1), 90, 1);
  assert_near(number(json, "brightest_elevation", -1), 20, 1);
  /* 2 pi (1 - cos 3 degrees) of 100, of all */
  const double lamp = 0.00861 * 100, all = lamp + 2 * 3.14159265;
  assert_near(number(json, "share_of_brightest_1_percent", -1), (lamp + 0.02 * 3.14159265) / all,
              1e-3);
}

GROUP(run_setup, run_teardown);

TEST(a_scene_and_its_picture) {
  write_text("s.yaml", VIEW "environment:\n  size: 256\n  uniform: 0.5\n  rotate: 90\n  softboxes: "
                            "[{elevation: 20, radius: 3, radiance: 100}]\n");
  check("\"$abbe\" environment s.yaml --json -o out.exr --png out.png");
  check("\"$abbe\" environment out.exr --json");
  run_says("\"$abbe\" environment s.yaml && rm out.exr out.png s.yaml",
           "256 x 128 texels, illuminant D65");
  assert_contains(run_output, "brightest 1 %");
}

/* The shipped pictures give the irradiances that scenes/environments/make-environments asks for: of
 * the skies by what is written there, of the studio by the scene whose it is. */
TEST(what_ships) {
  HELD(cJSON, json) = run_json(
      "\"$abbe\" environment " ABBE_SOURCE_DIR "/scenes/environments/overcast-sky.exr --json", 0);
  assert_near(number(json, "irradiance_up", 1), 3, 1e-3);
  assert_near(number(json, "irradiance_down", 1), 0.25 * 3.14159265, 1e-3);
  rerun_json(&json,
             "\"$abbe\" environment " ABBE_SOURCE_DIR "/scenes/environments/clear-sky.exr --json",
             0);
  const double sine = 0.61566148;
  assert_near(number(json, "irradiance_up", 0), 0.4 + 3.1 * sine, 2e-3);
  assert_near(number(json, "irradiance_up", 2), 0.8 + 2.6 * sine, 2e-3);
  assert_near(number(json, "brightest_elevation", -1), 38, 1.5);
  rerun_json(&json, "\"$abbe\" environment " ABBE_SOURCE_DIR "/scenes/diamond-studio.yaml --json",
             0);
  const double up = number(json, "irradiance_up", 0);
  rerun_json(&json,
             "\"$abbe\" environment " ABBE_SOURCE_DIR "/scenes/environments/studio.exr --json", 0);
  assert_near(number(json, "irradiance_up", 0), up, 2e-3 * up);
}

TEST(what_is_refused) {
  write_text("s.yaml", VIEW "lights: [{kind: point, position: [0, 0, 1], intensity: 1}]\n");
  run_fails("\"$abbe\" environment s.yaml", 1, "has no 'environment'");
  run_fails("\"$abbe\" environment missing.hdr", 1, "missing.hdr");
  assert_int_equal(run_line("\"$abbe\" environment"), 2);
  assert_int_equal(
      run_line("\"$abbe\" environment s.yaml -o x.svg; code=$?; rm s.yaml; exit $code"), 2);
  assert_int_equal(run_left(), 0);
}
