/* Time in a scene file: keyframes, water at its instant, and what is wrong with either. */
#include "tests/check.h"

#include "scenes/export/scene_export.h"
#include "scenes/import/scene_file.h"
#include "scenes/shapes/water.h"
#include "tests/scenes/scene_text.h"

#define FRONT "camera: {eye: [0, -1, 1], target: [0, 0, 0]}\n"
#define GROUND                                                                                     \
  "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5}\n"
#define LAMP(value)                                                                                \
  "lights: [{name: lamp, kind: point, position: [0, 0, 2], intensity: " value "}]\n"

static abbe_scene load_at(const char *text, const char *time) {
  const char *const set[] = {time};
  const abbe_scene_options options = {.set = set, .set_count = time != NULL};
  abbe_scene scene;
  OK(abbe_scene_parse(text, strlen(text), "t.yaml", &options, &scene, &error));
  return scene;
}

TEST(numbers_go_between_keyframes) {
  static const struct {
    const char *time;
    double is;
  } rows[] = {{NULL, 1},     {"time=-5", 1}, {"time=0", 1}, {"time=1", 2},  {"time=1.5", 3},
              {"time=2", 4}, {"time=3", 3},  {"time=4", 2}, {"time=99", 2}, {"time=2.25", 3.75}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_scene, scene) =
        load_at(FRONT LAMP("{keyframes: [[0, 1], [1, 2], [2, 4], [4, 2]]}") GROUND, rows[i].time);
    assert_near(scene.light[0].power, rows[i].is, 1e-12);
  }
}

/* The scene's own time, places and angles, a list in block style, and a time that repeats. */
TEST(all_kinds_of_values_move) {
  static const char text[] =
      "time: 2.5\ncamera:\n  eye: {keyframes: [[2, [0, -1, 1]], [3, [0, -2, 3]]]}\n"
      "  target: [0, 0, 0]\n"
      "  fov:\n    repeat: 2\n    keyframes:\n      - [0, 30]\n      - [1, 50]\n" LAMP("1") GROUND
      "- name: ball\n  shape: sphere\n  radius: 0.1\n  material: water\n  transform:\n"
      "    - translate: {keyframes: [[0, [1, 0, 1]], [5, [0, 1, 1]]]}\n"
      "    - rotate: {axis: [0, 0, 1], angle: {keyframes: [[0, 0], [5, 180]]}}\n";
  OWNED(abbe_scene, scene) = load_at(text, NULL);
  assert_near(scene.time, 2.5, 0);
  assert_near(scene.camera.eye[1], -1.5, 1e-12);
  assert_near(scene.camera.eye[2], 2, 1e-12);
  assert_near(scene.camera.fov_y_rad, 40 * 3.14159265358979323846 / 180, 1e-12);
  assert_near(scene.object[1].exact.centre[0], -0.5, 1e-12);
  assert_near(scene.object[1].exact.centre[1], 0.5, 1e-12);
  assert_near(scene.object[1].exact.centre[2], 1, 1e-12);
}

/* At the scene's time the surface is that of the shape at that time. */
TEST(water_is_at_its_time) {
  static const char text[] = FRONT LAMP("1") GROUND
      "- {name: pool, shape: water, size: [1, 0.5, 0.1], material: water, cells: [40, 20],\n"
      "   waves: [{amplitude: 0.005, wavelength: 0.3, direction: 30, phase: 20}],\n"
      "   drops: [{at: [0.1, 0], time: 0.1, depth: 0.002, radius: 0.06}]}\n";
  const abbe_water_wave wave = {0.005, 0.3, 30 * 3.14159265358979323846 / 180,
                                20 * 3.14159265358979323846 / 180};
  const abbe_water_drop drop = {{0.1, 0}, 0.1, 0.002, 0.06};
  const abbe_water water = FIELDS(.size = {1, 0.5, 0.1}, .cells = {40, 20}, .time = 0.75,
                                  .wave_count = 1, .wave = &wave, .drop_count = 1, .drop = &drop);
  MADE(abbe_mesh, known, abbe_water_make(&water, &known, &error));
  OWNED(abbe_scene, scene) = load_at(text, "time=0.75");
  const abbe_mesh *seen = &scene.object[1].mesh;
  assert_null(scene.object[1].fixes);
  assert_int_equal(seen->vertex_count, known.vertex_count);
  for (size_t v = 0; v < known.vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      assert_near(seen->position[v][k], known.position[v][k], 1e-12);
      assert_near(seen->normal[v][k], known.normal[v][k], 1e-9);
    }
  abbe_scene_free(&scene);
  scene = load_at(FRONT LAMP("1") GROUND
                  "- {name: pool, shape: water, size: [1, 0.5, 0.1], material: water}\n",
                  NULL);
  assert_int_equal(scene.object[1].exact.kind, ABBE_EXACT_CONVEX);
}

static void refuses(const char *text, const char *part, const char *line) {
  abbe_scene scene;
  abbe_error error = {0};
  assert_int_not_equal(abbe_scene_parse(text, strlen(text), "t.yaml", NULL, &scene, &error),
                       ABBE_OK);
  assert_contains(error.text, part);
  assert_contains(error.text, line);
}

#define POOL(keys) FRONT LAMP("1") GROUND "- {shape: water, material: water, " keys "}\n"

TEST(what_is_refused) {
  refuses(FRONT LAMP("{keyframes: 3}") GROUND, "'keyframes' wants a list", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: []}") GROUND, "'keyframes' wants a list", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, 1], [0, 2]]}") GROUND, "rising order", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, 1], [1, [2, 3]]]}") GROUND, "as many numbers", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, 1, 2]]}") GROUND, "a time and a value", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, .nan]]}") GROUND, "keyframes", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, -1]]}") GROUND, "intensity", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, 1]], repeat: 0}") GROUND, "'repeat'", "t.yaml:2");
  refuses(FRONT LAMP("{keyframes: [[0, 1]], repaet: 1}") GROUND, "repaet", "t.yaml:2");
  refuses("time: soon\n" FRONT LAMP("1") GROUND, "time", "t.yaml:1");
  refuses(POOL("size: [1, 1]"), "size", "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], waves: {amplitude: 1}"), "'waves' wants a list", "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], waves: [{amplitude: 0.01}]"), "wavelength", "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], waves: [{amplitude: 0.2, wavelength: 1}]"), "bare", "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], waves: [{amplitud: 0.2, wavelength: 1}]"), "amplitude",
          "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], drops: [{depth: 0.01, radius: 0.1}]"), "'at'", "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], rain: {every: 0, depth: 0.01, radius: 0.1}"), "every",
          "t.yaml:5");
  refuses(POOL("size: [1, 1, 0.1], cells: 2.5"), "whole", "t.yaml:5");
}

#define WARM(material)                                                                             \
  "temperature: 40\npressure: 0\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT  \
      FLOOR                                                                                        \
      BALL(material)
#define LINE_D_NM 587.5618

/* Of N-BK7 as [SchottTIE19]'s model has it: what renderer, tracer and exports ask for. */
TEST(glass_is_as_warm_as_the_scene) {
  OWNED(abbe_scene, scene) = scene_of(WARM("n-bk7") BRICK("air"));
  double n = 0;
  OK(abbe_material_n(scene.object[1].material, LINE_D_NM, &n, &error));
  assert_near(n, 1.5172435, 5e-8);
  OK(abbe_material_n(scene.object[2].material, LINE_D_NM, &n, &error));
  assert_near(n, 1, 0);
  abbe_export_index index;
  OK(abbe_export_index_make(scene.object[1].material, ABBE_EXPORT_FORM_ABBE, &index, &error));
  assert_near(index.value[0], 1.5172435, 5e-8);
}

TEST(metals_are_said_to_stay_as_they_were_measured) {
  abbe_scene_doubts doubts;
  OWNED(abbe_scene, scene) =
      scene_of(WARM("n-bk7") "- {name: coin, shape: box, size: [0.1, 0.1, 0.01], transform: "
                             "[{translate: [0.4, 0, 0.2]}], mirror: gold}\n");
  abbe_scene_doubt(&scene, &doubts);
  assert_int_equal(doubts.count, 1);
  assert_contains(doubts.text[0], "'coin' has n and k of gold as they were measured, not at 40 C");
}

TEST(what_has_no_index_there_is_refused) {
  const struct {
    const char *text, *words;
  } refused[] = {
      {WARM("diamond"),
       "x.yaml:1: 'temperature': diamond has no index at 40 C: its record gives no dn/dT"},
      {"temperature: 293\n", "x.yaml:1: 'temperature: 293' is not in the range from -250 to 200"},
      {"pressure: 101325\n", "x.yaml:1: 'pressure: 101325' is not in the range from 0 to 100"}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    abbe_scene scene;
    REFUSED(
        ABBE_SCHEMA, refused[i].words,
        abbe_scene_parse(refused[i].text, strlen(refused[i].text), "x.yaml", NULL, &scene, &error));
  }
}
