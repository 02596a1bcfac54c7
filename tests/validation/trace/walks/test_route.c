#include "tests/check.h"

#include "base/maths.h"
#include "spectral/optics.h"
#include "tests/scenes/scene_text.h"
#include "tests/validation/trace_scene.h"
#include "validation/trace/walks/route.h"

#define SLAB                                                                                       \
  "- {name: slab, shape: box, size: [0.4, 0.4, 0.1], transform: [{translate: [0, 0, 0.3]}], "      \
  "material: flat}\n"
#define WATER_IN_GLASS                                                                             \
  "- {name: outer, shape: sphere, radius: 0.1, transform: [{translate: [0, 0, 0.3]}], "            \
  "material: flat}\n"                                                                              \
  "- {name: inner, shape: sphere, radius: 0.05, transform: [{translate: [0, 0, 0.3]}], "           \
  "material: crown}\n"

static size_t follow(const char *text, const double from[3], const double d[3], const char *choices,
                     abbe_route_vertex vertex[16]) {
  OWNED(abbe_scene, scene) = scene_of(text);
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  size_t count;
  OK(abbe_route_follow(&g, from, d, 550, choices, vertex, 16, &count, &error));
  return count;
}

/* A slab moves a ray sideways by d sin(i) (1 - cos(i) / (n cos(t))) and does not turn it. */
TEST(a_slab_shifts_and_does_not_turn) {
  double angle = 0.6, d[3] = {sin(angle), 0, -cos(angle)}, from[3] = {-0.2, 0, 0.6};
  abbe_route_vertex v[16];
  assert_int_equal(follow(CAMERA POINT_LIGHT FLOOR SLAB, from, d, "", v), 3);
  assert_int_equal(v[0].event, ABBE_ROUTE_TRANSMITTED);
  assert_int_equal(v[2].event, ABBE_ROUTE_LANDED);
  assert_true(fabs(v[0].reflectance - abbe_optics_fresnel(cos(angle), 1 / 1.5)) < 1e-6);
  assert_true(v[1].inside_n == 1.5);
  for (int k = 0; k < 3; k++) assert_true(fabs(v[1].direction[k] - d[k]) < 1e-6);
  double straight = from[0] + from[2] * tan(angle);
  double cos_t = abbe_optics_cos_refracted(cos(angle), 1 / 1.5, NULL);
  double shift = 0.1 * sin(angle) * (1 - cos(angle) / (1.5 * cos_t));
  assert_true(fabs(straight - v[2].position[0] - shift / cos(angle)) < 2e-6);
}

TEST(choices_are_kept) {
  double d[3] = {0.1, 0, -1}, from[3] = {0, 0, 0.6};
  abbe_vector_normalise(d);
  abbe_route_vertex v[16];
  assert_int_equal(follow(CAMERA POINT_LIGHT FLOOR SLAB, from, d, "r", v), 2);
  assert_int_equal(v[0].event, ABBE_ROUTE_REFLECTED);
  assert_int_equal(v[1].event, ABBE_ROUTE_ESCAPED);
  assert_int_equal(follow(CAMERA POINT_LIGHT FLOOR SLAB, from, d, "trr", v), 5);
  assert_int_equal(v[4].event, ABBE_ROUTE_LANDED);
  size_t count;
  assert_int_equal(abbe_route_follow(&(abbe_geometry){0}, from, d, 550, "tx", v, 16, &count, NULL),
                   ABBE_INVALID_ARGUMENT);
}

/* Along the axis of concentric balls: air, 1.5, crown, 1.5, air; the indices are those of the
 * later object where both are. */
TEST(the_later_refractor_is_there) {
  abbe_route_vertex v[16];
  double crown = 1.5 + 0.006 / (0.55 * 0.55), expected[5] = {1, 1.5, crown, 1.5, 1};
  assert_int_equal(follow(CAMERA POINT_LIGHT FLOOR WATER_IN_GLASS, (double[3]){0, 0, 0.6},
                          (double[3]){0, 0, -1}, "", v),
                   5);
  for (int i = 0; i < 4; i++) assert_true(fabs(v[i].inside_n - expected[i]) < 1e-12);
  double shares[4] = {0.04, pow((crown - 1.5) / (crown + 1.5), 2), 0, 0.04};
  shares[2] = shares[1];
  for (int i = 0; i < 4; i++) assert_true(fabs(v[i].reflectance - shares[i]) < 1e-6);
  assert_true(fabs(v[2].distance - 0.1) < 1e-6);
}

/* What a lamp's map holds: light in the shadow of mirrors and not in that of other receivers. */

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

/* The pair of prisms in the docs: N-BK7 in vacuum at -40 degrees has Schott's index, and the lines
 * F and C leave alike, 10 degrees down. [SchottTIE19] */
TEST(two_prisms_of_crown_and_flint_deviate_without_colour) {
  const double from[3] = {-0.06, 0, 0.132}, d[3] = {1, 0, 0};
  const double nm[3] = {486.13, 656.27, 587.5618};
  double down[3];
  MADE(abbe_scene, scene,
       abbe_scene_load(ABBE_SOURCE_DIR "/docs/examples/achromat.yaml", NULL, &scene, &error));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  for (int i = 0; i < 3; i++) {
    abbe_route_vertex v[16];
    size_t count;
    OK(abbe_route_follow(&g, from, d, nm[i], "", v, 16, &count, &error));
    assert_int_equal(count, 5);
    assert_int_equal(v[4].event, ABBE_ROUTE_LANDED);
    down[i] = -asin(v[4].direction[2]) / ABBE_DEGREE;
    if (i == 2) assert_near(v[1].inside_n, 1.5171546, 5e-7);
  }
  assert_near(down[2], 10, 0.02);
  assert_near(down[0], down[1], 0.002);
}
