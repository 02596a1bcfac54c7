#include "tests/check.h"
#include "tests/scenes/environment/irradiance.h"
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "colorimetry/image/exr.h"
#include "scenes/import/scene_reading.h"

static const double up[3] = {0, 0, 1}, down[3] = {0, 0, -1};

static abbe_result parse(const char *text, abbe_environment *out, abbe_error *error) {
  abbe_yaml *yaml = NULL;
  *out = (abbe_environment){0};
  *error = (abbe_error){0};
  abbe_result result = abbe_yaml_parse(text, strlen(text), "text", &yaml, error);
  if (result == ABBE_OK)
    result = abbe_environment_read(yaml, abbe_yaml_root(yaml), "/tmp/", out, error);
  abbe_yaml_free(yaml);
  return result;
}

static void surroundings(const char *text, abbe_environment *out) {
  abbe_error error;
  if (parse(text, out, &error) != ABBE_OK) fail_msg("%s: %s", text, error.text);
}

static void check_irradiance(const char *text, const double normal[3], double expected) {
  double rgb[3];
  FILLED(abbe_environment, e, surroundings(text, &e));
  irradiance_of(&e, normal, rgb);
  assert_near(rgb[0], expected, 1e-4 * (expected + 0.2));
}

TEST(known_irradiances) {
  check_irradiance("{uniform: 2}", up, 2 * ABBE_PI);
  check_irradiance("{uniform: 2, scale: 3, size: 64}", down, 6 * ABBE_PI);
  check_irradiance("{dome: iso}", up, ABBE_PI);
  check_irradiance("{dome: cos}", up, 2 * ABBE_PI / 3);
  check_irradiance("{dome: [[0, 1], [90, 1]]}", down, 0);
  check_irradiance("{sky: {type: overcast, zenith: 9}}", up, 7 * ABBE_PI);
  check_irradiance("{sky: {type: overcast, irradiance: 3}}", up, 3);
  check_irradiance("{sky: {type: clear, irradiance: 3, elevation: 30}}", up, 3);
  check_irradiance("{sky: {type: 7, irradiance: 3}, sun: {elevation: 30, irradiance: 4}}", up, 5);
  check_irradiance("{sun: {towards: [0, 0, 2], irradiance: 4}}", up, 4);
  check_irradiance(
      "{sun: {elevation: 90, irradiance: 4}, rotate: 77, tilt: {axis: [1, 0, 0], angle: 60}}", up,
      2);
  check_irradiance("{softboxes: [{elevation: 90, radius: 30, radiance: 4}]}", up, ABBE_PI);
  check_irradiance("{uniform: 1, dome: iso, softboxes: [{elevation: 90, radius: 30, radiance: 4}, "
                   "{elevation: -90, radius: 30, radiance: 8}]}",
                   up, 3 * ABBE_PI);
}

static void radiance_at(const abbe_environment *e, double x, double y, double z, double rgb[3]) {
  const double length = sqrt(x * x + y * y + z * z);
  abbe_environment_radiance(e, (const double[3]){x / length, y / length, z / length}, rgb);
}

TEST(places_and_turns) {
  OWNED(abbe_environment, e);
  double rgb[3];
  surroundings(
      "{softboxes: [{elevation: 20, azimuth: 90, width: 40, height: 4, radiance: [1, 2, 3]}]}", &e);
  radiance_at(&e, tan(18 * ABBE_PI / 180), cos(20 * ABBE_PI / 180), sin(20 * ABBE_PI / 180), rgb);
  assert_near(rgb[2], 3, 1e-3);
  radiance_at(&e, tan(22 * ABBE_PI / 180), cos(20 * ABBE_PI / 180), sin(20 * ABBE_PI / 180), rgb);
  assert_near(rgb[2], 0, 1e-12);
  abbe_environment_free(&e);
  /* +y becomes -x by a quarter turn; rolled by a quarter, the width stands upright */
  surroundings("{softboxes: [{towards: [0, 1, 0], width: 40, height: 4, roll: 90, radiance: 1}], "
               "rotate: 90}",
               &e);
  radiance_at(&e, -1, 0, tan(18 * ABBE_PI / 180), rgb);
  assert_near(rgb[0], 1, 1e-3);
  radiance_at(&e, -1, tan(4 * ABBE_PI / 180), 0, rgb);
  assert_near(rgb[0], 0, 1e-12);
  abbe_environment_free(&e);
  /* ... and about x by a quarter it goes from +y to +z */
  surroundings("{spots: [{azimuth: 90, elevation: 0, sigma: 2, radiance: 5}], tilt: {axis: [1, 0, "
               "0], angle: 90}}",
               &e);
  radiance_at(&e, 0, 0, 1, rgb);
  assert_near(rgb[0], 5, 0.1);
  abbe_environment_free(&e);
  surroundings("{spots: [{elevation: 40, solid_angle: 0.01, radiance: 5}]}", &e);
  assert_near(e.mean[0] * 4 * ABBE_PI, 0.05, 1e-7);
}

TEST(aset) {
  static const double elevations[] = {-10, 20, 60, 80};
  FILLED(abbe_environment, e, surroundings("{dome: aset}", &e));
  for (int i = 0; i < 4; i++) {
    double rgb[3];
    radiance_at(&e, cos(elevations[i] * ABBE_PI / 180), 0, sin(elevations[i] * ABBE_PI / 180), rgb);
    const double expected[3] = {i == 2, i == 1, i == 3};
    for (int k = 0; k < 3; k++) assert_near(rgb[k], expected[k], 1e-6);
  }
}

TEST(pictures) {
  static const char *const names[] = {"R", "G", "B"};
  double rgb[3];
  const char *name = printed("abbe-test-surroundings-%d.exr", (int)getpid());
  const char *path = printed("/tmp/%s", name);
  MADE(abbe_image, image, abbe_image_make(8, 4, 3, names, &image, &error));
  for (size_t i = 0; i < 96; i++) image.data[i] = 0.5f;
  OK(abbe_exr_write(path, &image, &error));
  FILLED(
      abbe_environment, e,
      surroundings(
          printed("{file: %s, illuminant: A, scale: 4, sun: {elevation: 90, irradiance: 1}}", name),
          &e));
  assert_string_equal(e.path, path);
  assert_int_equal(e.illuminant.kind, ABBE_ILLUMINANT_A);
  assert_int_equal(e.map.width, 8);
  radiance_at(&e, 0, 1, -3, rgb);
  assert_near(rgb[1], 2, 1e-6);
  abbe_environment_free(&e);
  REFUSED(ABBE_SCHEMA, "text:1: ", parse(printed("file: %s\nlayout: cube\n", name), &e, &error));
  unlink(path);
}

TEST(what_is_refused) {
  static const struct {
    const char *text, *part;
  } cases[] = {
      {"[1]", "must be a mapping"},
      {"{}", "has no light"},
      {"{rotate: 3}", "has no light"},
      {"{uniform: 0}", "black everywhere"},
      {"{uniform: -1}", "'uniform: -1'"},
      {"{uniform: .nan}", "finite"},
      {"{uniform: [1, 2]}", "[red, green, blue]"},
      {"{uniform: 1, skye: 2}", "did you mean 'sky'"},
      {"{uniform: 1, size: 65}", "even"},
      {"{uniform: 1, size: 32}", "size"},
      {"{uniform: 1, size: 1e9}", "size"},
      {"{uniform: 1, scale: 0}", "scale"},
      {"{uniform: 1, layout: cube}", "without a 'file'"},
      {"{uniform: 1, tilt: 3}", "axis"},
      {"{uniform: 1, tilt: {axis: [0, 0, 0], angle: 3}}", "zero"},
      {"{uniform: 1e9, scale: 1e9}", "radiance is 0 to"},
      {"{file: x.exr, size: 64}", "has its own"},
      {"{file: no_such_file.exr}", "text:1: "},
      {"{illuminant: nothing, uniform: 1}", "illuminant"},
      {"{sky: clear}", "mapping"},
      {"{sky: {type: clear, zenith: 1}}", "where that is"},
      {"{sky: {type: clear, zenith: 1, elevation: -3}}", "below the horizon"},
      {"{sky: {type: clear, elevation: 3}}", "neither"},
      {"{sky: {type: overcast, zenith: 1, irradiance: 1}}", "both"},
      {"{sky: {type: 17, zenith: 1}}", "17"},
      {"{sky: {type: 1.5, zenith: 1}}", "whole"},
      {"{sky: {type: foggy, zenith: 1}}", "clear, overcast"},
      {"{sky: {zenith: 1}}", "type"},
      {"{sun: {irradiance: 1}}", "elevation"},
      {"{sun: {elevation: 3}}", "irradiance"},
      {"{sun: {elevation: 3, towards: [1, 0, 0], irradiance: 1}}", "either"},
      {"{sun: {towards: [0, 0, 0], irradiance: 1}}", "zero"},
      {"{sun: {elevation: 3, irradiance: 1, size: 2}}", "size"},
      {"{softboxes: {elevation: 3}}", "list"},
      {"{softboxes: [3]}", "mapping"},
      {"{softboxes: [{elevation: 3, radiance: 1}]}", "neither"},
      {"{softboxes: [{elevation: 3, radiance: 1, radius: 2, width: 3}]}", "both"},
      {"{softboxes: [{elevation: 3, radiance: 1, width: 3}]}", "height"},
      {"{softboxes: [{elevation: 3, radiance: 1, radius: 0}]}", "radius"},
      {"{softboxes: [{elevation: 3, radius: 1}]}", "radiance"},
      {"{spots: [{elevation: 3, radiance: 1}]}", "neither"},
      {"{spots: [{elevation: 3, radiance: 1, sigma: 1, solid_angle: 1}]}", "both"},
      {"{dome: round}", "iso, cos, aset"},
      {"{dome: [[0, 1]]}", "at least two"},
      {"{dome: [[0, 1], [0]]}", "at least two"},
      {"{dome: [[10, 1], [0, 1]]}", "rising"},
      {"{dome: [[0, 1], [91, 1]]}", "91"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    OWNED(abbe_environment, e);
    abbe_error error;
    if (parse(cases[i].text, &e, &error) == ABBE_OK) fail_msg("%s is read", cases[i].text);
    assert_contains(error.text, cases[i].part);
    assert_contains(error.text, "text:1: ");
  }
}

/* Sodium light has one colour. */
TEST(an_illuminant_has_colours) {
  OWNED(abbe_environment, e);
  const char *path = printed("/tmp/abbe-test-line-%d.txt", (int)getpid());
  const char *text = printed("{uniform: 1,\n illuminant: %s}", path);
  static const char line[] = "588 0\n589 1\n590 0\n", lines[] = "400 1\n500 3\n600 2\n700 1\n";
  OK(abbe_file_write(path, line, strlen(line), &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "text:2: ", parse(text, &e, &error));
  assert_contains(last_error.text, "too few colours");
  abbe_environment_free(&e);
  OK(abbe_file_write(path, lines, strlen(lines), &error));
  surroundings(text, &e);
  assert_string_equal(e.illuminant_path, path);
  unlink(path);
}

#define VIEW                                                                                       \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"                                            \
  "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"

TEST(scenes_have_surroundings) {
  abbe_scene scene = scene_of(VIEW "environment: {uniform: 1, size: 64}\n");
  assert_int_equal(scene.light_count, 0);
  assert_non_null(scene.environment);
  assert_ptr_equal(abbe_scene_illuminant(&scene), &scene.environment->illuminant);
  assert_near(scene.environment->mean[0], 1, 1e-6);
  for (size_t i = 1; i < abbe_scene_file_count(&scene); i++)
    assert_null(abbe_scene_file(&scene, i));
  scene.environment->path = strdup("a.exr");
  size_t found = 0;
  for (size_t i = 1; i < abbe_scene_file_count(&scene); i++)
    if (abbe_scene_file(&scene, i)) found += strcmp(abbe_scene_file(&scene, i), "a.exr") == 0;
  assert_int_equal(found, 1);
  abbe_scene_free(&scene);
  scene = scene_of(VIEW POINT_LIGHT);
  assert_null(scene.environment);
  assert_ptr_equal(abbe_scene_illuminant(&scene), &scene.light[0].illuminant);
  abbe_scene_free(&scene);
  REFUSED(ABBE_SCHEMA, "'environment'",
          abbe_scene_parse(VIEW, strlen(VIEW), "s.yaml", NULL, &scene, &error));
}

/* Each surroundings of the page, in a scene. */
TEST(what_is_documented_loads) {
  static const double grounds[] = {2, 3.4, 3};
  static const double tolerance[] = {1.2, 1e-2, 1e-3};
  FREED char *text = NULL;
  size_t size, found = 0;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/docs/scene-files.md", 1 << 20, &text, &size, &error));
  for (char *at = text; (at = strstr(at, "```yaml\nenvironment:")) != NULL; found++) {
    at += strlen("```yaml\n");
    const int length = (int)(strstr(at, "```") - at);
    const char *scene_text = printed("%s%.*s", VIEW, length, at);
    double rgb[3];
    OWNED(abbe_scene, scene) = scene_of(scene_text);
    irradiance_of(scene.environment, up, rgb);
    assert_int_in_range(found, 0, 2);
    assert_near(rgb[1], grounds[found], tolerance[found]);
  }
  assert_int_equal(found, 3);
}
