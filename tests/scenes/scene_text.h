/* scene_text.h: scenes for tests: from a few lines of text with a table of made-up glasses beside
 * them, or shipped ones by name. What is loaded is plain data that a test may change.
 */
#ifndef ABBE_TESTS_SCENES_SCENE_TEXT_H
#define ABBE_TESTS_SCENES_SCENE_TEXT_H

#include "tests/check.h"

#include "base/file.h"
#include "scenes/import/scene_file.h"

#include <unistd.h>

/* Clear and constant, dispersive, also of a high index, air's, dispersive and absorbing below
 * 500 nm, constant and absorbing, and two known over a part of the range only. */
#define GLASSES                                                                                    \
  "materials:\n"                                                                                   \
  "- {name: flat, model: constant, coefficients: [1.5], source: made up}\n"                        \
  "- {name: crown, model: cauchy, coefficients: [1.5, 0.006], range_nm: [300, 2500],\n"            \
  "   source: made up}\n"                                                                          \
  "- {name: dense, model: cauchy, coefficients: [2.4, 0.006], range_nm: [300, 2500],\n"            \
  "   source: made up}\n"                                                                          \
  "- {name: air, model: constant, coefficients: [1], source: made up}\n"                           \
  "- {name: murk, model: cauchy, coefficients: [1.5, 0.006], range_nm: [300, 2500], source: "      \
  "made up,\n   absorption: {attenuation_per_m: [[400, 20], [500, 0], [700, 0]]}}\n"               \
  "- {name: smoke, model: constant, coefficients: [1.5], source: made up,\n"                       \
  "   absorption: {attenuation_per_m: [[400, 20], [700, 5]]}}\n"                                   \
  "- {name: grey, model: constant, coefficients: [1.5], source: made up,\n"                        \
  "   absorption: {attenuation_per_m: [[400, 10], [700, 10]]}}\n"                                  \
  "- {name: narrow, model: cauchy, coefficients: [1.5, 0.006], range_nm: [400, 700],\n"            \
  "   source: made up}\n"                                                                          \
  "- {name: loose, model: cauchy, coefficients: [1.5, 0.006], range_nm: [400, 700],\n"             \
  "   extrapolate: true, source: made up}\n"

#define CAMERA "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
#define POINT_LIGHT                                                                                \
  "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"
#define SUN "lights:\n- {name: sun, kind: directional, direction: [0.1, 0.2, -1], irradiance: 1}\n"
#define FLOOR "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
#define BALL(material)                                                                             \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0, 0, 0.2]}], " \
  "material: " material "}\n"
#define BRICK(material)                                                                            \
  "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], transform: [{translate: [0.2, 0, "         \
  "0.2]}], material: " material "}\n"
#define RING(material)                                                                             \
  "- {name: ring, shape: ring, major: 0.08, minor: 0.02, around: 64, across: 32, transform: "      \
  "[{translate: [0, 0, 0.2]}], material: " material "}\n"
/* A receiver that is no rectangle. */
#define HILL                                                                                       \
  "- {name: hill, shape: sphere, radius: 0.05, levels: 3, transform: [{translate: "                \
  "[0.5, 0.5, 0]}], reflectance: 0.5}\n"

static inline abbe_scene shipped_scene(const char *name) {
  abbe_scene scene = {0};
  OK(abbe_scene_load(printed(ABBE_SOURCE_DIR "/scenes/%s.yaml", name), NULL, &scene, &error));
  return scene;
}

static inline abbe_scene scene_of(const char *text) {
  char folder[] = "/tmp/abbe-test-scene-XXXXXX";
  assert_non_null(mkdtemp(folder));
  const char *table = printed("%s/glass.yaml", folder);
  const char *path = printed("%s/scene.yaml", folder);
  OK(abbe_file_write(table, GLASSES, strlen(GLASSES), &error));
  OK(abbe_file_write(path, text, strlen(text), &error));
  abbe_scene scene = {0};
  abbe_error why = {0};
  abbe_result result = abbe_scene_load(path, NULL, &scene, &why);
  unlink(table);
  unlink(path);
  rmdir(folder);
  if (result != ABBE_OK) print_error("%s\n", why.text);
  assert_int_equal(result, ABBE_OK);
  return scene;
}

#endif
