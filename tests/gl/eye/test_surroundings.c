/* What is around a scene: seen straight, through glass, and as light on receivers. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "scenes/view/view.h"

/* The floor is far out of the way. */
#define SKY_ONLY                                                                                   \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.2], fov: 40}\n"                                    \
  "objects:\n- {name: floor, shape: rectangle, width: 0.02, height: 0.02, reflectance: 0.5, "      \
  "transform: "                                                                                    \
  "[{translate: [0, 20, -10]}]}\n"

static abbe_statistics draw(const char *text, abbe_image *out) {
  abbe_render_desc desc = small_frame;
  desc.space = ABBE_RGB_SPACE_REC709;
  return draw_text(text, &desc, out);
}

static double at(const abbe_image *p, size_t x, size_t y, size_t channel) {
  return (double)p->data[(y * p->width + x) * p->channels + channel];
}

GROUP(make_context, free_context);

/* Radiance of a colour that is white is that of the illuminant; RGB is Rec.709's. */
TEST(the_sky_is_seen_as_it_is) {
  FILLED(abbe_image, picture, draw(SKY_ONLY "environment: {uniform: [0.2, 0.5, 1.5]}\n", &picture));
  for (size_t y = 0; y < 64; y += 7)
    for (size_t x = 0; x < 64; x += 7) {
      assert_near(at(&picture, x, y, 0), 0.2, 2e-3);
      assert_near(at(&picture, x, y, 1), 0.5, 2e-3);
      assert_near(at(&picture, x, y, 2), 1.5, 3e-3);
    }
}

/* Directions: a lamp at a known place stands where the camera's geometry puts it. */
TEST(a_lamp_stands_where_it_is) {
  OWNED(abbe_image, picture);
  /* straight ahead of a level eye that looks along +y */
  draw("materials: glass.yaml\ncamera: {eye: [0, 0, 0.5], target: [0, 1, 0.5], fov: 40}\n"
       "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5, "
       "transform: [{translate: [0, 20, -4]}]}\n"
       "environment: {uniform: 0.1, softboxes: [{elevation: 10, azimuth: 80, radius: 3, radiance: "
       "50}]}\n",
       &picture);
  size_t x_max = 0, y_max = 0;
  double sum = 0, x_sum = 0, y_sum = 0;
  for (size_t y = 0; y < 64; y++)
    for (size_t x = 0; x < 64; x++) {
      const double g = at(&picture, x, y, 1) - 0.1;
      sum += g > 1 ? g : 0;
      x_sum += g > 1 ? g * ((double)x + 0.5) : 0;
      y_sum += g > 1 ? g * ((double)y + 0.5) : 0;
      if (at(&picture, x, y, 1) > at(&picture, x_max, y_max, 1)) {
        x_max = x;
        y_max = y;
      }
    }
  const double r = ABBE_PI / 180, half = tan(20 * r);
  const double d[3] = {cos(10 * r) * cos(80 * r), cos(10 * r) * sin(80 * r), sin(10 * r)};
  assert_near(x_sum / sum, 32 * (1 + d[0] / d[1] / half), 0.3);
  assert_near(y_sum / sum, 32 * (1 - d[2] / d[1] / half), 0.3);
  assert_near(at(&picture, x_max, y_max, 1), 50, 1);
}

/* In uniform light no clear glass is seen: what it mirrors and what comes through add up. */
TEST(clear_glass_is_not_seen_in_uniform_light) {
  static const char *const glass[] = {
      BALL("crown"),
      "- {name: stone, shape: brilliant, diameter: 0.3, transform: [{translate: [0, 0, 0.2]}], "
      "material: crown}\n",
      "- {name: ring, shape: ring, major: 0.15, minor: 0.05, around: 32, across: 16, transform: "
      "[{translate: [0, 0, 0.2]}], material: crown}\n"};
  for (int i = 0; i < 3; i++) {
    FILLED(abbe_image, picture,
           draw(printed(SKY_ONLY "%senvironment: {uniform: 2}\n", glass[i]), &picture));
    /* at the rims of a mesh a pixel in a hundred misses what its own triangles cover */
    size_t off = 0;
    double sum = 0;
    for (size_t y = 0; y < 64; y++)
      for (size_t x = 0; x < 64; x++) {
        off += fabs(at(&picture, x, y, 1) / 2 - 1) > 5e-3;
        sum += at(&picture, x, y, 1) / 2 / (64 * 64);
      }
    assert_near(sum, 1, 1e-3);
    assert_true(off <= (i < 2 ? 0 : 64 * 64 / 100));
  }
}

/* Lights that stand for a dome give an open floor its irradiance, 2 pi / 3 of `cos`. */
TEST(an_open_floor_has_its_irradiance) {
  FILLED(abbe_image, picture, draw(CAMERA FLOOR "environment: {dome: cos}\n", &picture));
  for (size_t x = 8; x < 56; x += 8) assert_near(at(&picture, x, 40, 1) / (0.5 * 2.0 / 3), 1, 1e-2);
}

/* Receivers that send on all that they get, in light that is alike all around: nothing is seen of
 * clear glass or of a whole mirror before them. */
TEST(nothing_is_seen_in_a_furnace) {
  static const char *const body[] = {BALL("crown"),
                                     "- {name: stone, shape: brilliant, diameter: 0.3, transform: "
                                     "[{translate: [0, 0, 0.2]}], material: crown}\n",
                                     "- {name: ball, shape: sphere, radius: 0.1, transform: "
                                     "[{translate: [0, 0, 0.2]}], mirror: 1}\n"};
  for (int i = 0; i < 3; i += all_cases() ? 1 : 2) { /* a stone alone is held to it above */
    FILLED(abbe_image, picture,
           draw(printed(
                    CAMERA
                    "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: "
                    "1}\n%senvironment: {uniform: 2}\n",
                    body[i]),
                &picture));
    for (size_t y = 0; y < 64; y++)
      for (size_t x = 0; x < 64; x++) assert_near(at(&picture, x, y, 1), 2, 1e-2);
  }
}

#define TURNED(angle, eye, what)                                                                   \
  "materials: glass.yaml\ncamera: {eye: " eye ", target: [0, 0, 0.05], fov: 40}\n" FLOOR           \
  "- {name: stone, shape: brilliant, diameter: 0.3, transform: [{rotate: {axis: [0, 0, 1], "       \
  "angle: " angle "}}, {translate: [0, 0, 0.2]}], material: crown}\n"                              \
  "environment: {" what "uniform: 0.2, softboxes: [{elevation: 50, azimuth: 20, radius: 6, "       \
  "radiance: [9, 7, 4]}, {elevation: 20, azimuth: 160, width: 60, height: 30, radiance: 1}]}\n"

static double difference(const abbe_image *a, const abbe_image *b, double factor) {
  double sum = 0, all = 0;
  for (size_t i = 0; i < 64 * 64 * a->channels; i++) {
    sum += fabs(factor * (double)a->data[i] - (double)b->data[i]);
    all += fabs((double)b->data[i]);
  }
  return sum / all;
}

/* Turned with all that stands in it, it changes nothing but roundings, which edges of facets and
 * texels show; not turned, it does. */
TEST(turning_all_changes_nothing) {
  OWNED(abbe_image, here) = {0}, there = {0}, half = {0};
  draw(TURNED("0", "[0, -1, 0.5]", ""), &here);
  draw(TURNED("90", "[1, 0, 0.5]", "rotate: 90, "), &there);
  draw(TURNED("90", "[1, 0, 0.5]", ""), &half);
  print_message("turned: %.5f; the environment left: %.3f\n", difference(&here, &there, 1),
                difference(&here, &half, 1));
  assert_true(difference(&here, &there, 1) < 5e-3);
  assert_true(difference(&here, &half, 1) > 0.05);
}

TEST(light_is_linear) {
  FILLED(abbe_image, once, draw(TURNED("0", "[0, -1, 0.5]", ""), &once));
  FILLED(abbe_image, thrice, draw(TURNED("0", "[0, -1, 0.5]", "scale: 3, "), &thrice));
  assert_true(difference(&once, &thrice, 3) < 1e-4);
}

/* In uniform light clear glass is as bright as what it hides: a transparent picture of it is that
 * light times what it covers. */
TEST(a_transparent_picture_is_premultiplied) {
  abbe_render_desc desc = small_frame;
  desc.space = ABBE_RGB_SPACE_REC709;
  desc.supersample = 2;
  OWNED(abbe_scene, scene) =
      scene_of("materials: glass.yaml\ncamera: {frame: [stone], fov: 30}\nobjects:\n"
               "- {name: stone, shape: brilliant, diameter: 0.3, material: crown}\n"
               "environment: {uniform: 2}\nbackground: 0.5\n");
  scene.transparent = true;
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, picture) = picture_of(renderer);
  MADE(abbe_image, alpha, abbe_coverage_make(&scene, 64, 64, 2, &alpha, &error));
  size_t off = 0, partly = 0;
  for (size_t i = 0; i < 64 * 64; i++) {
    const double a = (double)alpha.data[i], seen = (double)picture.data[3 * i + 1];
    off += fabs(seen - 2.5 * a) > 0.02;
    partly += a > 0 && a < 1;
    if (!(a > 0)) assert_near(seen, 0, 0);
  }
  assert_true(partly > 50); /* rims */
  assert_true(off < 20);
}

TEST(the_ledger_closes) {
  OWNED(abbe_image, picture);
  const abbe_statistics s =
      draw(CAMERA FLOOR BALL("crown") "environment: {dome: cos, softboxes: [{elevation: 60, "
                                      "radius: 8, radiance: 9}]}\n",
           &picture);
  assert_true(s.energy.reached > 0 && s.energy.deposited > 0);
  assert_true(abbe_ledger_imbalance(&s.energy) < 1e-4);
}
