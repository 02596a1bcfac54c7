/* Haze in the renderer's pictures, against closed forms: a slab of mist in the sun, what is left of
 * what is behind it, a lamp in mist, and a shaft of sunlight under still water. */
#include "tests/gl/haze/haze_picture.h"

#include "base/maths.h"
#include "scenes/medium/medium.h"

#define VIEW(more)                                                                                 \
  more "camera: {eye: [2.383508, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 1}\n"               \
       "medium: {scattering: 0.8, absorption: 0.3, g: 0.4, box: [[-40, -40, -0.5], [40, 40, "      \
       "0.5]]}\n"                                                                                  \
       "objects: [{name: spot, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0,\n"   \
       "           transform: [{translate: [-7.150524, 0, -6]}]}]\n"

GROUP(make_context, free_context);

/* The sun 30 degrees off upright, the eye at 50 degrees: as validation's known answers have it. */
TEST(a_slab_in_the_sun) {
  const double sun = 30 * ABBE_PI / 180, view = 50 * ABBE_PI / 180, m0 = cos(sun), m = cos(view);
  const double turned = sin(sun) * sin(view) - m0 * m;
  const double exact = 0.8 / 1.1 * abbe_medium_phase(0.4, turned) * m0 / (m0 + m) *
                       (1 - exp(-1.1 * (1 / m0 + 1 / m)));
  const double drawn = green_of(VIEW("lights: [{name: sun, kind: directional, direction: [0.5, 0, "
                                     "-0.8660254], irradiance: 1}]\n"),
                                64);
  assert_near(drawn / exact, 1, 4e-3);
  const double left = green_of(VIEW("background: 1\nlights: [{name: sun, kind: directional, "
                                    "direction: [0.5, 0, -0.8660254], irradiance: 1.0e-9}]\n"),
                               64);
  assert_near(left / exp(-1.1 / m), 1, 3e-3);
}

/* Past it at 0.2 m, from 1 m before to 1 m behind. */
TEST(a_lamp_in_mist) {
  static const char *const lamps[] = {
      "kind: point, position: [0, 0.2, 0], intensity: 1",
      "kind: spot, position: [0, 0.2, 0], direction: [0, -1, 0], cone: 40, intensity: 1"};
  for (int i = 0; i < 2; i++) {
    double exact = 0;
    enum { PARTS = 20000 };
    for (int k = 0; k < PARTS; k++) {
      const double t = 2 * (k + 0.5) / PARTS, along = 1 - t, distance = hypot(0.2, along);
      if (i == 1 && 0.2 / distance < cos(40 * ABBE_PI / 180)) continue;
      exact += 2.0 / PARTS * 0.4 * abbe_medium_phase(0.7, along / distance) *
               exp(-0.5 * (t + distance)) / (distance * distance);
    }
    assert_near(
        green_of(
            printed(
                "camera: {eye: [-1.5, 0, 0], target: [0, 0, 0], fov: 0.5}\n"
                "lights: [{name: lamp, %s}]\n"
                "medium: {scattering: 0.4, absorption: 0.1, g: 0.7, box: [[-1, -1, -1], [1, 1, "
                "1]]}\n"
                "objects: [{name: far off, shape: rectangle, width: 9, height: 9, reflectance: 0,\n"
                "           transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [5, 0, "
                "0]}]}]\n",
                lamps[i]),
            64) /
            exact,
        1, 4e-3);
  }
}

/* Beams of photons, seen by an eye in the water: the way down is as long as the place is deep. */
TEST(a_shaft_under_still_water) {
  static const char text[] =
      "materials: glass.yaml\n"
      "camera: {eye: [-0.3, 0, -0.2], target: [1, 0, -0.2], fov: 30, inside: true}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0.5, -0.8660254], irradiance: 1}]\n"
      "objects:\n"
      "- {name: water, shape: water, size: [0.8, 0.8, 0.41], cells: 8, material: flat,\n"
      "   medium: {scattering: 0.8, g: 0.5}}\n"
      "- {name: bottom, shape: rectangle, width: 4, height: 4, reflectance: 0,\n"
      "   transform: [{translate: [0, 0, -0.4]}]}\n"
      "- {name: side, shape: rectangle, width: 2, height: 0.56, reflectance: 0,\n"
      "   transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0, -0.41, -0.22]}]}\n"
      "- {name: wall, shape: rectangle, width: 0.38, height: 1, reflectance: 0,\n"
      "   transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [0.3, 0, -0.2]}]}\n";
  const double sun = ABBE_PI / 6, inside = asin(0.5 / 1.5), half = tan(15 * ABBE_PI / 180);
  const double rs = (cos(sun) - 1.5 * cos(inside)) / (cos(sun) + 1.5 * cos(inside));
  const double rp = (1.5 * cos(sun) - cos(inside)) / (1.5 * cos(sun) + cos(inside));
  const double e = (1 - 0.5 * (rs * rs + rp * rp)) * cos(sun) / cos(inside);
  double exact = 0;
  enum { SIDE = 100 };
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double a = half * ((2 * (i % SIDE) + 1) / (double)SIDE - 1);
    const double b = half * ((2 * (i / SIDE) + 1) / (double)SIDE - 1);
    const double l = sqrt(1 + a * a + b * b), turned = -(sin(inside) * a - cos(inside) * b) / l;
    const double slope = 0.8 * (1 - b / l / cos(inside));
    exact += e * 0.8 * abbe_medium_phase(0.5, turned) * exp(-0.8 * 0.2 / cos(inside)) *
             -expm1(-slope * 0.6 * l) / slope / (SIDE * SIDE);
  }
  const double drawn = green_of(text, 256);
  print_message("a shaft: %.4f of the known light\n", drawn / exact);
  assert_near(drawn / exact, 1, 0.015);
}

/* Few wavelengths make as even a fan as many: none leaves a stripe. */
TEST(a_fan_without_stripes) {
  enum { W = 80, H = 60, FEW = 7, MANY = 31 };
  static const double middle[3] = {0.105, 0.15, 0.03};
  abbe_image picture[2];
  OWNED(abbe_scene, scene) = shipped_scene("mist/prism");
  memcpy(scene.camera.target, middle, sizeof middle);
  scene.camera.fov_y_rad = 16 * ABBE_PI / 180;
  for (int i = 0; i < 2; i++) {
    const abbe_render_desc desc =
        FIELDS(.width = W, .height = H, .photons = 96, .map_size = 128,
               .wavelengths = i == 0 ? FEW : MANY, .supersample = 1, .space = ABBE_RGB_SPACE_XYZ);
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    picture[i] = picture_of(renderer);
  }
  double square = 0, apart = 0;
  for (size_t i = 0; i < W * H * picture[0].channels; i++) {
    const double a = (double)picture[0].data[i], b = (double)picture[1].data[i];
    if (i % picture[0].channels > 2) continue;
    square += b * b;
    apart += (a - b) * (a - b);
  }
  for (int i = 0; i < 2; i++) abbe_image_free(&picture[i]);
  print_message("relative RMSE of 7 wavelengths to 31: %.4f\n", sqrt(apart / square));
  assert_true(sqrt(apart / square) < 0.1);
}
