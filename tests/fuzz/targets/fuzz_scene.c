/* Scene files, with what they include: tables, meshes and textures beside tests/fuzz/parts. */
#include "tests/fuzz/fuzz.h"

#include "gl/plan/plan.h"
#include "scenes/import/scene_file.h"

#include <ctype.h>
#include <string.h>

const char *const fuzz_words[] = {"camera: ",
                                  "lights:\n",
                                  "objects:\n",
                                  "  - name: x\n",
                                  "materials: table.yaml\n",
                                  "materials: thesis\n",
                                  "mesh: tetra.obj",
                                  "mesh: open.ply",
                                  "texture: dot.png",
                                  "repeat: [2, 2]",
                                  "shape: sphere",
                                  "shape: lathe",
                                  "shape: rectangle",
                                  "profile: [[0, 0], [1, 0], [0, 1]]",
                                  "transform: [{translate: [0, 0, 1]}]",
                                  "transform: [{scale: [1, -1, 1]}]",
                                  "{rotate: {axis: [0, 0, 1], angle: 30}}",
                                  "material: n-bk7",
                                  "reflectance: [0.5, 0.5, 0.5]",
                                  "illuminant: D65",
                                  "illuminant: lines.txt",
                                  "illuminant: E",
                                  "kind: spot",
                                  "kind: disk",
                                  "kind: directional",
                                  "cone: 20",
                                  "soft: 5",
                                  "radius: 0.1",
                                  "intensity: 10",
                                  "subdivide: 1",
                                  "smooth: false",
                                  "environment: {size: 64, uniform: 1}\n",
                                  "file: dot.png",
                                  "dome: aset",
                                  "sky: {type: overcast, zenith: 1}",
                                  "sun: {elevation: 30, irradiance: 1}",
                                  "towards: [0, 0, 1]",
                                  "&a ",
                                  "*a",
                                  NULL};

/* Spheres of millions of faces are in order, and take their time: a number of two digits after one
 * of these keys is left to other tests. */
static int asks_for_many(const char *text, size_t size) {
  static const char *const keys[] = {"levels", "subdivide", "round", "around", "across", "sides"};
  for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
    const size_t length = strlen(keys[k]);
    for (size_t at = 0; at + length <= size; at++) {
      if (memcmp(text + at, keys[k], length) != 0) continue;
      size_t i = at + length;
      while (i < size && strchr(": \"'\n\t\r{[?+", text[i]) != NULL) i++;
      size_t digits = 0;
      while (i + digits < size &&
             (isalnum((unsigned char)text[i + digits]) || strchr("._-+", text[i + digits]) != NULL))
        digits++;
      if (digits > 2 || (digits > 0 && k < 3 && (digits > 1 || text[i] > '4'))) return 1;
    }
  }
  return 0;
}

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_scene scene;
  abbe_error error = {0};
  if (asks_for_many((const char *)data, size)) return 0;
  if (FUZZED(abbe_scene_parse((const char *)data, size, ABBE_SOURCE_DIR "/tests/fuzz/parts/f.yaml",
                              NULL, &scene, &error),
             &error) != ABBE_OK) {
    const abbe_scene zero = {0};
    FUZZ_PROMISE(error.text[0] != '\0' && memcmp(&scene, &zero, sizeof zero) == 0);
    return 0;
  }
  abbe_plan plan = {0};
  error = (abbe_error){0};
  if (FUZZED(abbe_plan_make(&scene, NULL, &plan, &error), &error) != ABBE_OK)
    FUZZ_PROMISE(error.text[0] != '\0' && plan.refractor_object == NULL && plan.model == NULL);
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  return 0;
}
