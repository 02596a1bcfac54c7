/* Caustics mapping in units and as printed: what arrives, what a flat mirror sends, one interface,
 * and that every estimator brings light to where the exact one does. */
#include "tests/gl/frame.h"

#define PANE(material)                                                                             \
  "- {name: pane, shape: box, size: [0.3, 0.3, 0.001], transform: [{translate: [0.05, 0.03, "      \
  "0.3]}], material: " material "}\n"

static const abbe_render_desc small = {.profile = ABBE_PROFILE_SHAH2007_CIE,
                                       .width = 64,
                                       .height = 64,
                                       .photons = 217, /* so that splats lie anywhere in a texel */
                                       .map_size = 512,
                                       .space = ABBE_RGB_SPACE_XYZ};

static double map_energy(const abbe_scene *scene, const abbe_render_desc *desc, abbe_image *map) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, desc);
  *map = map_of(renderer, 0);
  return image_sum(map, 1);
}

GROUP(make_context, free_context);

/* A pane turns no light: the map holds the lamp's power through it, less two reflections. */
TEST(what_arrives_is_what_was_sent) {
  OWNED(abbe_image, map) = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  const double sum = map_energy(&scene, &small, &map);
  /* as of the thesis's passes, whose test says how much it is */
  const double h = 0.2995, a = 0.15, angle = 4 * asin(a * a / (a * a + h * h));
  assert_near(sum, angle * 0.9216, 0.03 * angle);
}

/* A low pass keeps the light, and spreads it by its variance along either axis. */
TEST(a_low_pass_spreads_light) {
  double sum[2], variance[2] = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  for (int k = 0; k < 2; k++) {
    abbe_render_desc desc = small;
    OWNED(abbe_image, map) = {0};
    double mean = 0, square = 0;
    desc.map_size = 256;
    desc.low_pass = k == 0 ? 0 : 5;
    sum[k] = map_energy(&scene, &desc, &map);
    for (size_t i = 0; i < map.width * map.height; i++) {
      const double x = (double)(i % map.width),
                   light = (double)map.data[i * map.channels + 1] / sum[k];
      mean += light * x;
      square += light * x * x;
    }
    variance[k] = square - mean * mean;
  }
  print_message("%.6f of the light, %.3f texels^2 more\n", sum[1] / sum[0],
                variance[1] - variance[0]);
  assert_near(sum[1] / sum[0], 1, 1e-3);
  assert_near(variance[1] - variance[0], 25, 1); /* less the tails that are cut */
}

/* Each estimator's map has the exact one's light, and nearly its place: moments of the caustic. */
TEST(estimators_land_alike) {
  double exact[3] = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  static const abbe_estimator kinds[] = {ABBE_ESTIMATOR_EXACT,    ABBE_ESTIMATOR_RATIO,
                                         ABBE_ESTIMATOR_SHAH,     ABBE_ESTIMATOR_AXIS,
                                         ABBE_ESTIMATOR_ILLINOIS, ABBE_ESTIMATOR_IMPOSTOR};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    abbe_render_desc desc = small;
    double moment[3] = {0};
    desc.estimator = kinds[k];
    desc.iterations = 5;
    FILLED(abbe_image, map, map_energy(&scene, &desc, &map));
    for (size_t i = 0; i < map.width * map.height; i++) {
      const double y = (double)map.data[i * map.channels + 1];
      moment[0] += y;
      moment[1] += y * (double)(i % map.width);
      moment[2] += y * (double)(i / map.width);
    }
    for (int c = 1; c < 3; c++) moment[c] /= moment[0];
    if (k == 0) memcpy(exact, moment, sizeof exact);
    assert_near(moment[0] / exact[0], 1, 0.01);
    for (int c = 1; c < 3; c++) assert_near(moment[c], exact[c], 1);
  }
}

#define MIRROR                                                                                     \
  "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.8, transform: [{rotate: " \
  "{axis: "                                                                                        \
  "[0, 1, 0], angle: 60}}, {translate: [0.1, 0, 0.15]}]}\n"

/* A flat mirror sends all of its share of the lamp's light to the floor, as the default profile has
 * it. */
TEST(a_flat_mirror_has_the_lamps_light) {
  OWNED(abbe_image, own) = {0};
  OWNED(abbe_image, map) = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR MIRROR);
  abbe_render_desc desc = small;
  desc.photons =
      1024; /* the mirror is small in what the light sees, and its cells are whole ones */
  const double sum = map_energy(&scene, &desc, &map);
  desc.profile = ABBE_PROFILE_DEFAULT;
  const double right = map_energy(&scene, &desc, &own);
  assert_true(right > 0);
  assert_near(sum / right, 1, 0.04);
}

/* The sun, one interface and two: both pass; through two, a second share is reflected. */
TEST(one_interface_and_the_sun) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR PANE("flat"));
  double sum[2];
  for (size_t k = 0; k < 2; k++) {
    abbe_render_desc desc = small;
    OWNED(abbe_image, map) = {0};
    desc.interfaces = k + 1;
    sum[k] = map_energy(&scene, &desc, &map);
  }
  assert_true(sum[0] > 0);
  assert_near(sum[1] / sum[0], 0.96, 0.005);
}

/* A ball of air in the sun, all of whose light lands: two thirds of what its vertices are in full,
 * for (N . L) counts projection twice. */
TEST(projection_is_counted_twice) {
  OWNED(abbe_image, map) = {0};
  abbe_render_desc desc = small;
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR BALL("air"));
  desc.profile = ABBE_PROFILE_SHAH2007;
  desc.space = ABBE_RGB_SPACE_REC709;
  desc.photons = 1024;
  desc.map_size = 2048; /* splats of six texels, whose sum does not go by where they lie */
  const double sum = map_energy(&scene, &desc, &map), white = 2048.0 * 2048 / 16;
  assert_near(sum / white, 2.0 / 3, 0.02);
}

/* As printed: (N . L) / V, so that brightness does not go by the object's size, and three colours.
 */
TEST(as_printed) {
  OWNED(abbe_scene, scene) = {0};
  double sum[2];
  abbe_image map = {0};
  abbe_render_desc desc = small;
  desc.profile = ABBE_PROFILE_SHAH2007;
  desc.space = ABBE_RGB_SPACE_REC709;
  for (int k = 0; k < 2; k++) {
    scene = scene_of(k == 0 ? CAMERA POINT_LIGHT FLOOR PANE("flat")
                            : CAMERA POINT_LIGHT FLOOR
                         "- {name: pane, shape: box, size: [0.15, 0.15, 0.001], transform: "
                         "[{translate: [0.05, 0.03, 0.3]}], material: flat}\n");
    sum[k] = map_energy(&scene, &desc, &map);
    abbe_image_free(&map);
    abbe_scene_free(&scene);
  }
  /* a pane of a quarter of the area has half to all of the light, by its mean cosine */
  assert_near(sum[1] / sum[0], 1.0, 0.1);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  assert_int_equal(draw_frame(renderer).wavelengths, 3);
  OWNED(abbe_image, picture) = picture_of(renderer);
  assert_finite(&picture);
  assert_string_equal(picture.channel[0], "R");
}
