/* Keys of a scene's numbers, as they are set and derived by. Input: a key, and behind a line's end
 * a value that it is set to. */
#include "tests/fuzz/memory_file.h"

#include "base/number.h"
#include "scenes/import/scene_file.h"

#include <math.h>

const char *const fuzz_words[] = {"objects.0.width",
                                  "objects.ball.radius",
                                  "objects.ball.transform.0.translate.2",
                                  "objects.2.crown",
                                  "lights.0.position.1",
                                  "lights.lamp.intensity",
                                  "camera.eye.0",
                                  "camera",
                                  ".",
                                  "-1",
                                  "\n0.5",
                                  "\n[1, 2, 3]",
                                  "\n{a: b}",
                                  "\nnull",
                                  NULL};

static const char scene[] =
    "materials: " ABBE_SOURCE_DIR "/tests/fuzz/parts/table.yaml\n"
    "unit: cm\n"
    "camera: {eye: [0, -100, 50], target: [0, 0, 5], size: [3, 2]}\n"
    "lights:\n- {name: lamp, kind: point, position: [5, 3, 60], intensity: 1}\n"
    "objects:\n- {name: floor, shape: rectangle, width: 200, height: 200, reflectance: 0.5}\n"
    "- {name: ball, shape: sphere, radius: 5, levels: 1, material: crown,\n"
    "   transform: [{translate: [20, 0, 20]}, {scale: 0.5}]}\n"
    "- {name: brick, shape: box, size: [10, 8, 6], transform: [{translate: [0, 0, 20]}],\n"
    "   material: crown}\n";

/* Meshes of millions of faces are in order, and take their time. */
static bool asks_for_many(const char *key) {
  return strstr(key, "levels") != NULL || strstr(key, "subdivide") != NULL ||
         strstr(key, "round") != NULL;
}

/* The number in its place again is the scene as it is. */
static void set_back(const char *path, const char *key, double value) {
  char set[400];
  double again = NAN;
  const char *const list[] = {set};
  const abbe_scene_options options = {.set = list, .set_count = 1};
  abbe_number_format(set, sizeof set, "%.250s=%.17g", key, value);
  FUZZ_PROMISE(abbe_scene_number(path, &options, key, &again, NULL) == ABBE_OK);
  FUZZ_PROMISE(fabs(again - value) <= 1e-15 * fabs(value));
}

int fuzz_input(const uint8_t *data, size_t size) {
  char text[256];
  double value = NAN;
  abbe_error error = {0};
  const char *path = memory_file((const uint8_t *)scene, sizeof scene - 1);
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  char *line = strchr(text, '\n');
  if (line != NULL) *line = '\0';
  if (FUZZED(abbe_scene_number(path, NULL, text, &value, &error), &error) == ABBE_OK) {
    fuzz_same(&value, sizeof value);
    FUZZ_PROMISE(isfinite(value));
    set_back(path, text, value);
  } else {
    FUZZ_PROMISE(error.text[0] != '\0');
  }
  if (line == NULL || asks_for_many(text)) return 0;
  *line = '=';
  abbe_scene made;
  const char *const list[] = {text};
  const abbe_scene_options options = {.set = list, .set_count = 1};
  error = (abbe_error){0};
  if (FUZZED(abbe_scene_load(path, &options, &made, &error), &error) != ABBE_OK)
    FUZZ_PROMISE(error.text[0] != '\0');
  abbe_scene_free(&made);
  return 0;
}
