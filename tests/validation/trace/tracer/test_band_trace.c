/* Bands of the tracer: exact however many there are, within their own standard errors. */
#include "tests/check.h"

#include "colorimetry/spectral_picture/relight.h"
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
  static const size_t counts[] = {1, 7, 20, 80, 160, 256};
  OWNED(abbe_scene, scene) = scene_of(CAMERA EVEN_SUN FLOOR);
  for (size_t c = 0; c < 6; c++) {
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

/* A traced spectral picture looked at under another illuminant is the trace under that one. */

enum { SIDE = 32, PASSES = 24 };

static const char SCENE[] =
    "materials: glass.yaml\n"
    "camera: {eye: [0, -0.6, 0.5], target: [0, 0, 0], up: [0, 0, 1], fov: 30, size: [32, 32]}\n"
    "lights:\n"
    "- {name: lamp, kind: spot, position: [0, 0, 1], target: [0, 0, 0.1], cone: 12, intensity: 1,\n"
    "   illuminant: %s}\n"
    "objects:\n"
    "- {name: ball, shape: sphere, radius: 0.07, transform: [{translate: [0, 0, 0.1]}],\n"
    "   material: crown}\n"
    "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.8}\n";

static void trace(const char *illuminant, size_t bands, abbe_image *out) {
  OWNED(abbe_scene, scene) = scene_of(printed(SCENE, illuminant));
  const abbe_trace_desc desc =
      FIELDS(.width = SIDE, .height = SIDE, .bands = bands, .space = ABBE_RGB_SPACE_XYZ,
             .photons = 1 << 15, .no_map = true, .threads = 2);
  *out = traced_picture(&scene, &desc, PASSES);
}

/* XYZ over the picture, and the standard errors that the file states, as of independent pixels. */
static void sums(const abbe_image *image, double xyz[3], double error[3]) {
  static const char *const names[3] = {"stderr.X", "stderr.Y", "stderr.Z"};
  for (int k = 0; k < 3; k++) {
    const size_t at = abbe_image_find_channel(image, names[k]),
                 value = abbe_image_find_channel(image, names[k] + 7);
    double squares = 0;
    xyz[k] = 0;
    for (size_t p = 0; p < image->width * image->height; p++) {
      xyz[k] += (double)image->data[p * image->channels + value];
      if (at != (size_t)-1) squares += pow((double)image->data[p * image->channels + at], 2);
    }
    error[k] = sqrt(squares);
  }
}

TEST(a_trace_under_another_lamp) {
  const abbe_illuminant d65 = {0}, a = {.kind = ABBE_ILLUMINANT_A};
  OWNED(abbe_image, made) = {0}, under_a = {0};
  double expected[3], found[3], own[3], none[3];
  trace("D65", 40, &made);
  trace("A", 0, &under_a);
  const abbe_relight_desc desc = {.view = {.from = &d65, .to = &a}, .space = ABBE_RGB_SPACE_XYZ};
  MADE(abbe_image, relit, abbe_relight_make(&made, "it", &desc, &relit, &error));
  sums(&under_a, expected, own);
  sums(&relit, found, none);
  for (int k = 0; k < 3; k++) {
    print_message("%c: relit %.6g, traced %.6g, apart by %.2g, of errors %.2g\n", "XYZ"[k],
                  found[k], expected[k], found[k] / expected[k] - 1, own[k] / expected[k]);
    /* the two traces are independent, and both are as far off as the one says */
    assert_near(found[k], expected[k], 5 * own[k] + 2e-3 * expected[k]);
  }
}
