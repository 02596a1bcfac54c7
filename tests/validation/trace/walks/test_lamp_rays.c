/* What a lamp's map holds: light in the shadow of mirrors and not in that of other receivers. */
#include "tests/validation/trace_scene.h"

/* Two upright panes in a sun that stands at 45 degrees. The left one hides the floor from 1 to 21
 * cm behind it from the sun, and the right one throws its light from 9 to 29 cm: three fifths of it
 * into that shadow. */
#define PANE(name, x)                                                                              \
  "- {name: " name ", shape: rectangle, width: 0.2, height: 0.4, transform: [{rotate: {axis: [0, " \
  "1, 0], angle: 90}}, {translate: [" x ", 0, 0.11]}], mirror: 0.8}\n"
#define SCENE                                                                                      \
  "camera: {eye: [0.15, -0.5, 0.6], target: [0.15, 0, 0], fov: 6}\n"                               \
  "lights:\n- {name: sun, kind: directional, direction: [1, 0, -1], irradiance: 1}\n"              \
  "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1}\n"

static const double each = 0.8 * 0.2 * 0.4 * 0.70710678; /* W that a pane reflects */

typedef struct lit {
  abbe_trace_statistics statistics;
  abbe_image picture, map;
} lit;

static lit trace(const char *text) {
  lit l;
  OWNED(abbe_scene, scene) = scene_of(text);
  const abbe_trace_desc desc = FIELDS(.width = 4, .height = 4, .map_width = 32, .photons = 60000,
                                      .threads = 1, .space = ABBE_RGB_SPACE_XYZ);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  run_passes(tracer, 2);
  abbe_tracer_statistics(tracer, &l.statistics);
  OK(abbe_tracer_picture(tracer, &l.picture, &error));
  OK(abbe_tracer_map(tracer, &l.map, &error));
  return l;
}

static void lit_free(lit *l) {
  abbe_image_free(&l->picture);
  abbe_image_free(&l->map);
}

TEST(a_mirrors_shadow_is_in_the_map) {
  OWNED(lit, l) = trace(SCENE PANE("left", "0") PANE("right", "0.3"));
  const double seen = channel_sum(&l.picture, "caustic.Y") / 16;
  print_message("%.4f of the light in the map, %.4f in the picture\n",
                channel_sum(&l.map, "Y") / (2 * each), seen / (0.8 * 0.70710678 / 3.14159265));
  assert_near(channel_sum(&l.map, "Y") / (2 * each), 1, 5e-3);
  assert_near(seen / (0.8 * 0.70710678 / 3.14159265), 1, 0.05);
  assert_true(l.statistics.ledger.hidden == 0);
}

/* A board in the place of the left pane: its shadow is not in the map, and the rest is. */
TEST(a_receivers_shadow_is_not) {
  OWNED(lit, l) =
      trace(SCENE PANE("right", "0.3") "- {name: board, shape: box, size: [1e-4, 0.4, 0.2], "
                                       "transform: [{translate: [0, 0, 0.11]}], reflectance: 0}\n");
  const double hidden = 0.6 * each;
  print_message("%.4f of the hidden light, %.4f of the other\n",
                l.statistics.ledger.hidden / hidden, channel_sum(&l.map, "Y") / (0.4 * each));
  assert_near(l.statistics.ledger.hidden / hidden, 1, 0.01);
  assert_near(channel_sum(&l.map, "Y") / (0.4 * each), 1, 0.01);
}
