/* A pixel's spectrum alone, against what a lamp gives a floor there. */
#include "tests/check.h"
#include "tests/scenes/scene_text.h"

#include "base/maths.h"
#include "cli/view/picture/view_feed.h"
#include "cli/view/picture/view_show.h"
#include "cli/view/state/view_camera.h"

/* A lamp near to the floor, so that each pixel has its own light. */
static const char text[] =
    "materials: glass.yaml\n"
    "camera: {eye: [0.4, -1.5, 1.2], target: [0, 0.1, 0], fov: 40}\n"
    "lights: [{name: lamp, kind: point, position: [0.2, 0.1, 0.3], intensity: 2, illuminant: E}]\n"
    "objects:\n"
    "- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 0.5}\n"
    "- {name: brick, shape: box, size: [0.1, 0.1, 0.1], material: crown,\n"
    "   transform: [{translate: [-1.5, 1.5, 0.1]}]}\n";

TEST(a_pixel_has_the_light_of_its_place) {
  enum { WIDTH = 160, HEIGHT = 120 };
  static const size_t pixels[][2] = {{12, 100}, {131, 30}};
  const volatile int stop = 1;
  static abbe_view_spot spot;
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++) {
    const double xy[2] = {(double)pixels[i][0] + 0.5, (double)pixels[i][1] + 0.5};
    double p[3], to[3], total = 0;
    abbe_view_camera_point(&scene.camera, WIDTH, HEIGHT, xy, 1, p);
    const double *eye = scene.camera.eye, down = eye[2] / (eye[2] - p[2]);
    for (int k = 0; k < 3; k++)
      to[k] = scene.light[0].position[k] - (eye[k] + down * (p[k] - eye[k]));
    const double square = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
    const double known = 0.5 / ABBE_PI * 2 * to[2] / sqrt(square) / square;
    OK(abbe_view_spot_trace(&scene, WIDTH, HEIGHT, pixels[i], 0, NULL, &spot, &error));
    assert_int_equal(spot.bands, ABBE_VIEW_SPOT_BANDS);
    assert_true(spot.passes == 4);
    for (size_t k = 0; k < spot.bands; k++) {
      total += spot.radiance[k] * 400 / ABBE_VIEW_SPOT_BANDS;
      assert_near(spot.nm[k], 380 + 400 * (0.5 + (double)k) / ABBE_VIEW_SPOT_BANDS, 1e-6);
    }
    print_message("%.4f of the known light\n", total / known);
    assert_near(total / known, 1, 0.01);
  }
  REFUSED(ABBE_CANCELLED, "",
          abbe_view_spot_trace(&scene, WIDTH, HEIGHT, pixels[0], 0, &stop, &spot, &error));
  assert_int_equal(spot.bands, 0);
}

/* The sun through a plate onto a floor, seen through the same plate: the plate lets
 * (1 - R) / (1 + R) pass each time, for each polarisation. */
static const char plate[] =
    "materials: glass.yaml\n"
    "camera: {eye: [0, -2, 3], target: [0, 0, 0.3], fov: 40}\n"
    "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 2, illuminant: "
    "E}]\n"
    "objects:\n"
    "- {name: floor, shape: rectangle, width: 8, height: 8, reflectance: 0.5}\n"
    "- {name: plate, shape: box, size: [2, 2, 0.1], material: crown,\n"
    "   transform: [{translate: [0, 0, 0.3]}]}\n";

static double passes(double n, double angle) {
  const double c = cos(angle), in = sqrt(1 - sin(angle) * sin(angle) / (n * n));
  const double s = (c - n * in) / (c + n * in), p = (n * c - in) / (n * c + in);
  return 0.5 * ((1 - s * s) / (1 + s * s) + (1 - p * p) / (1 + p * p));
}

TEST(a_caustic_behind_glass_has_all_bands) {
  enum { WIDTH = 512, HEIGHT = 512 };
  static const size_t pixel[2] = {256, 256};
  static abbe_view_spot spot;
  double total = 0;
  OWNED(abbe_scene, scene) = scene_of(plate);
  const double angle = atan2(2, 2.7),
               known = 0.5 / ABBE_PI * 2 * passes(1.52, 0) * passes(1.52, angle);
  OK(abbe_view_spot_trace(&scene, WIDTH, HEIGHT, pixel, 0, NULL, &spot, &error));
  for (size_t k = 0; k < spot.bands; k++) {
    total += spot.radiance[k] * 400 / ABBE_VIEW_SPOT_BANDS;
    assert_true(spot.radiance[k] > 0 && spot.stderr_of[k] > 0);
  }
  print_message("%.4f of the known light\n", total / known);
  assert_near(total / known, 1, 0.1); /* about 1000 photons: 3 % */
}

TEST(the_spectrum_of_more_passes_is_told) {
  static abbe_view_probe probe, own = {.bands = 3};
  static abbe_view_spot none, spot = {.passes = 4, .bands = 2, .radiance = {5, 6}};
  abbe_view_probe_take_spot(&probe, 0, &none);
  assert_int_equal(probe.bands, 0);
  abbe_view_probe_take_spot(&probe, 0, &spot);
  assert_true(probe.bands == 2 && probe.radiance[1] == 6);
  probe = own;
  abbe_view_probe_take_spot(&probe, 4, &spot);
  assert_int_equal(probe.bands, 3);
  abbe_view_probe_take_spot(&probe, 3, &spot);
  assert_int_equal(probe.bands, 2);
}
