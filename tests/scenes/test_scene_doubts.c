#include "tests/scenes/scene_text.h"

#include "scenes/import/scene_file.h"

#define EYE CAMERA
#define STONE(more) "- {name: stone, shape: brilliant, diameter: 0.05, " more ", material: dense}\n"

static size_t doubts_of(const char *text, abbe_scene_doubts *out) {
  OWNED(abbe_scene, scene) = scene_of(text);
  abbe_scene_doubt(&scene, out);
  return out->count;
}

TEST(what_is_hardly_meant_is_said) {
  static const char *const doubtful[][2] = {
      {EYE POINT_LIGHT FLOOR BALL("flat") BALL("flat"),
       "two objects are called 'ball' (lines 7 and 8)"},
      {EYE POINT_LIGHT "- {name: lamp, kind: point, position: [0, 0, 1], intensity: 1}\n" FLOOR,
       "two lights are called 'lamp'"},
      {"materials: glass.yaml\ncamera: {eye: [0, -30, 5], target: [0, 0, 0]}\n" POINT_LIGHT FLOOR
           STONE("stand: [0, 0, 0]"),
       "the camera's eye is 30.4 m away from 'stone', which is 1.6 pixels large"},
      {EYE POINT_LIGHT FLOOR STONE("centre: [0, 0, 0]"), "mm deep in 'floor': 'stand: [x, y, z]'"},
      {EYE
       "lights:\n- {name: low, kind: point, position: [0, 0, -0.5], intensity: 1}\n" FLOOR STONE(
           "stand: [0, 0, 0]"),
       "the light 'low' reaches nothing that refracts or reflects: 'floor' stands between"},
      {EYE
       "lights:\n- {name: low, kind: directional, direction: [0.3, 0, 1], irradiance: 1}\n" FLOOR
           STONE("stand: [0, 0, 0]"),
       "the light 'low' reaches nothing that refracts or reflects: 'floor' stands between"}};
  for (size_t i = 0; i < sizeof doubtful / sizeof *doubtful; i++) {
    abbe_scene_doubts doubts;
    if (doubts_of(doubtful[i][0], &doubts) != 1)
      fail_msg("%zu doubts for %s", doubts.count, doubtful[i][1]);
    assert_contains(doubts.text[0], doubtful[i][1]);
  }
}

TEST(what_is_meant_is_not_doubted) {
  static const char *const sound[] = {
      EYE POINT_LIGHT FLOOR STONE("stand: [0, 0, 0]") BALL("flat"),
      /* a liquid reaches into its basin's bottom, and beyond its walls */
      EYE POINT_LIGHT FLOOR
      "- {name: water, shape: box, size: [3, 3, 0.2], centre: [0, 0, 0.09], material: flat}\n",
      /* one of two stones has light */
      EYE "lights:\n- {name: low, kind: point, position: [0, 0, -0.5], intensity: 1}\n" FLOOR STONE(
          "stand: [0, 0, 0]") "- {name: under, shape: sphere, radius: 0.1, centre: [0, 0, -0.2], "
                              "material: flat}\n",
      EYE SUN FLOOR STONE("stand: [0, 0, 0]")};
  for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) {
    abbe_scene_doubts doubts;
    if (doubts_of(sound[i], &doubts) != 0) fail_msg("%zu: %s", i, doubts.text[0]);
  }
}

TEST(no_shipped_scene_is_doubted) {
  static const char *const names[] = {
      "sphere",       "ring",       "gem",         "bunny",          "glass",      "prism",
      "rainbow",      "diamond",    "stone",       "diamond-studio", "calcite",    "metals",
      "octahedra",    "metal-ring", "metal-ball",  "spoon",          "water/pool", "water/seabed",
      "water/shafts", "mist/prism", "glass-studio"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    abbe_scene_doubts doubts;
    abbe_scene scene = shipped_scene(names[i]);
    abbe_scene_doubt(&scene, &doubts);
    abbe_scene_free(&scene);
    if (doubts.count > 0) fail_msg("%s: %s", names[i], doubts.text[0]);
  }
}
