/* The renderer's caustics under a wave against Snell's and Fresnel's laws, before the focus of its
 * crests and behind it, as waves move, and under still water from aslant. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"

/* Bins are wider than the seam between two levels of the map. */
enum { SIDE = 256, BINS = 4 };

static void load_water(double depth, double phase_deg, abbe_scene *out) {
  *out = scene_of(
      printed("materials: default\ncamera: {eye: [0, -9, 4], target: [0, 0, 0]}\n"
              "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
              "objects:\n"
              "- {name: water, shape: water, size: [0.4, 0.4, %.9g], cells: [512, 32], material: "
              "water, waves: [{amplitude: 0.002, wavelength: 0.1, phase: %.9g}]}\n"
              "- {name: bottom, shape: rectangle, width: 1, height: 1, reflectance: 1, transform: "
              "[{translate: [0, 0, %.9g]}]}\n",
              depth + 0.01, phase_deg, -depth));
}

/* Two waves across, seen from above. */
static abbe_map_layout two_waves(void) {
  const double origin[3] = {0, 0, 1}, down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  abbe_map_layout layout;
  abbe_view view;
  abbe_view_look(origin, down, up, true, &view);
  for (int k = 0; k < 4; k++) view.window[k] = k % 2 ? 0.1 : -0.1;
  view.near = 0.5;
  view.far = 3;
  abbe_map_layout_make(&view, &layout);
  return layout;
}

/* Irradiance by the distance from the crest, whose phase that is, bin by bin: over the middle wave,
 * for texels at the map's edge also have what cells across it bring. */
static void sum_bins(const abbe_image *map, double phase, double mean[BINS]) {
  size_t count[BINS] = {0};
  memset(mean, 0, BINS * sizeof *mean);
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    const size_t x = i % SIDE, y = i / SIDE;
    if (x < SIDE / 4 || x >= 3 * SIDE / 4 || y < SIDE / 4 || y >= 3 * SIDE / 4) continue;
    const double waves = 2 * ((double)(i % SIDE) + 0.5) / SIDE + phase;
    const int bin = (int)fmin(BINS - 1, floor(2 * fabs(waves - round(waves)) * BINS));
    mean[bin] += (double)map->data[map->channels * i + 1] / pow(0.2 / SIDE, 2);
    count[bin]++;
  }
  for (int b = 0; b < BINS; b++) mean[b] /= (double)count[b];
}

static void check_wave(double depth, double phase_deg, double tolerance) {
  const abbe_map_layout layout = two_waves();
  abbe_render_desc desc =
      FIELDS(.width = 16, .height = 16, .photons = 512, .map_size = SIDE, .min_nm = 587,
             .max_nm = 588, .wavelengths = 1, .map_layout = &layout);
  abbe_wave_caustic w = {.amplitude = 0.002, .wavelength = 0.1, .depth = depth};
  double mean[BINS], worst = 0;
  FILLED(abbe_scene, scene, load_water(depth, phase_deg, &scene));
  OK(abbe_material_n(scene.object[0].material, 587.5, &w.index, &error));
  w.attenuation_per_m = abbe_material_attenuation(scene.object[0].material, 587.5);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  const abbe_statistics statistics = draw_frame(renderer);
  assert_true(abbe_ledger_imbalance(&statistics.energy) < 1e-4);
  OWNED(abbe_image, map) = map_of(renderer, 0);
  sum_bins(&map, phase_deg / 360, mean);
  for (int b = 0; b < BINS; b++) {
    const double step = 0.05 / BINS;
    const double known = abbe_wave_caustic_mean(&w, b * step, (b + 1) * step, 400000);
    worst = fmax(worst, fabs(mean[b] / known - 1));
    if (fabs(mean[b] / known - 1) > tolerance)
      print_error("%g m deep, bin %d: %g, not %g\n", depth, b, mean[b], known);
  }
  print_message("%g m under a wave: off by %.4f at the most\n", depth, worst);
  assert_true(worst < tolerance);
}

GROUP(make_context, free_context);

/* The crests' focus lies half a metre down. */
TEST(light_under_a_wave) {
  check_wave(0.25, 0, 0.01);
  check_wave(0.25, 130, 0.01);
  check_wave(0.8, 0, 0.03);
}

/* Fresnel's law on the way in and out, and of radiance one part in n^2 leaves the water. */
TEST(light_under_still_water) {
  double n = 0;
  OWNED(abbe_scene, scene) =
      scene_of("materials: default\n"
               "camera: {eye: [0.05, 0, 2], target: [0.05, 0, 0], up: [0, 1, 0], fov: 2}\n"
               "lights: [{name: sun, kind: directional, direction: [0.8660254, 0, -0.5], "
               "irradiance: 1}]\nobjects:\n"
               "- {name: water, shape: water, size: [1, 1, 0.11], material: water}\n"
               "- {name: bottom, shape: rectangle, width: 2, height: 2, reflectance: 1, transform: "
               "[{translate: [0, 0, -0.1]}]}\n");
  OK(abbe_material_n(scene.object[0].material, 587.5, &n, &error));
  const abbe_render_desc desc =
      FIELDS(.width = 16, .height = 16, .photons = 256, .map_size = 256, .min_nm = 587,
             .max_nm = 588, .wavelengths = 1, .space = ABBE_RGB_SPACE_XYZ);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, picture) = picture_of(renderer);
  const double through = 1 - abbe_closed_form_fresnel(ABBE_PI / 3, n);
  const double up = 1 - abbe_closed_form_fresnel(0, n), inside = asin(sin(ABBE_PI / 3) / n);
  const double per_m = abbe_material_attenuation(scene.object[0].material, 587.5);
  const double path = exp(-per_m * 0.1 * (1 + 1 / cos(inside)));
  const double known = 0.5 * through * up * path / (n * n) / ABBE_PI;
  const double seen = image_sum(&picture, 1) / (16 * 16);
  print_message("still water: %.4f of the known light\n", seen / known);
  assert_near(seen / known, 1, 0.02);
}

/* From under water: a ceiling of radiance 1 straight above is seen through Fresnel's share, n^2
 * times as bright; aslant, beyond the critical angle, the white bottom in the mirror of the
 * surface; and from inside what is inside, as it is. */
static double seen_from_below(const char *target, double bottom) {
  OWNED(abbe_scene, scene) = scene_of(printed(
      "materials: default\nambient: 3.14159265358979\n"
      "camera: {eye: [0, 0, -0.2], target: %s, up: [0, 1, 0], fov: 2, inside: true}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1.0e-9}]\n"
      "objects:\n- {name: water, shape: water, size: [9, 9, 0.41], material: water}\n"
      "- {name: bottom, shape: rectangle, width: 8, height: 8, reflectance: %.9g, transform: "
      "[{translate: [0, 0, -0.4]}]}\n"
      "- {name: ceiling, shape: rectangle, width: 9, height: 9, reflectance: 1, transform: "
      "[{translate: [0, 0, 1]}]}\n",
      target, bottom));
  const abbe_render_desc desc =
      FIELDS(.width = 16, .height = 16, .photons = 16, .map_size = 64, .min_nm = 587, .max_nm = 588,
             .wavelengths = 1, .space = ABBE_RGB_SPACE_XYZ);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, picture) = picture_of(renderer);
  return image_sum(&picture, 1) / (16 * 16);
}

TEST(the_eye_under_water) {
  const double n = 1.333, up = 1 - abbe_closed_form_fresnel(0, n);
  assert_near(seen_from_below("[0, 0, 1]", 0) / (n * n * up), 1, 2e-3);
  assert_near(seen_from_below("[1.2, 0, 0.4]", 0.5), 0.5, 1e-3);
  assert_near(seen_from_below("[0, 0, -1]", 0.25), 0.25, 1e-3);
}
