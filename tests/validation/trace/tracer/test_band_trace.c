/* Bands of the tracer: exact however many there are, within their own standard errors. */
#include "tests/validation/trace_scene.h"

#define EVEN_SUN                                                                                   \
  "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 3.14159265, "      \
  "illuminant: E}\n"

static double band_at(const abbe_image *image, const char *prefix, double middle, size_t pixel) {
  char name[64];
  abbe_image_band_name(middle, name, sizeof name);
  const size_t at = abbe_image_find_channel(image, printed("%s%s", prefix, name));
  assert_true(at < image->channels);
  return (double)image->data[pixel * image->channels + at];
}

/* A grey floor in even light: half of 1 W/(m2 sr), over 400 nm. */
TEST(a_lit_floor_is_even) {
  static const size_t counts[] = {1, 20, 80, 160, 256};
  OWNED(abbe_scene, scene) = scene_of(CAMERA EVEN_SUN FLOOR);
  for (size_t c = 0; c < 5; c++) {
    const abbe_trace_desc desc = {
        .no_map = true, .width = 3, .height = 3, .photons = 256, .threads = 1, .bands = counts[c]};
    OWNED(abbe_image, picture) = traced_picture(&scene, &desc, 2);
    for (size_t i = 0; i < counts[c]; i++) {
      const double middle = 380 + 400 * ((double)i + 0.5) / (double)counts[c];
      assert_near(band_at(&picture, "", middle, 4), 0.00125, 1e-5 * 0.00125);
    }
  }
}

/* All that photons bring through a ball without dispersion. Its mean over bands is what each has,
 * and no band is farther off than errors of so many bands may be. */
TEST(photons_are_even) {
  enum { BANDS = 160, PASSES = 48 };
  OWNED(abbe_scene, scene) = scene_of(CAMERA EVEN_SUN FLOOR BALL("flat"));
  const abbe_trace_desc desc = {
      .no_picture = true, .map_width = 1, .photons = 1 << 14, .threads = 1, .bands = BANDS};
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  double mean = 0, squares = 0, greatest = 0;
  run_passes(tracer, PASSES);
  MADE(abbe_image, map, abbe_tracer_map(tracer, &map, &error));
  for (size_t i = 0; i < BANDS; i++) mean += band_at(&map, "", 381.25 + 2.5 * (double)i, 0) / BANDS;
  for (size_t i = 0; i < BANDS; i++) {
    const double middle = 381.25 + 2.5 * (double)i, error = band_at(&map, "stderr.", middle, 0);
    const double z = (band_at(&map, "", middle, 0) - mean) / error;
    assert_true(error < 0.02 * mean);
    squares += z * z / BANDS;
    greatest = fmax(greatest, fabs(z));
  }
  print_message("%d bands: mean of z^2 %.2f, greatest |z| %.2f\n", BANDS, squares, greatest);
  assert_true(squares < 1.5 && greatest < 5);
}
