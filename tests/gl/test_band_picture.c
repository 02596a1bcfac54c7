/* Bands against the picture that they make up, against the tracer, and against what is known. */
#include "tests/gl/frame.h"

#include "colorimetry/spectral_picture/relight.h"
#include "colorimetry/weights.h"
#include "gl/band_picture.h"
#include "tests/validation/trace_scene.h"

enum { SIDE = 48, BANDS = 10 };

static const abbe_render_desc frame = {
    .width = SIDE, .height = SIDE, .photons = 128, .map_size = 256};

static abbe_context *context;

static void setup(void) {
  OK(abbe_context_make(ABBE_CONTEXT_CPU, &context, &error));
}

static void teardown(void) {
  abbe_context_free(context);
}

/* A grey and a coloured card under two lamps, no refractor. */
static const char CARDS[] =
    "camera: {eye: [0, -1, 2], target: [0, 0, 0], up: [0, 0, 1], fov: 40}\nambient: %s\n"
    "lights:\n"
    "- {name: one, kind: point, position: [1, -1, 2], intensity: 3%s}\n"
    "- {name: two, kind: directional, direction: [-0.2, 0.3, -1], irradiance: 2%s}\n"
    "objects:\n"
    "- {name: grey, shape: rectangle, width: 9, height: 9, reflectance: 0.4}\n"
    "- {name: wood, shape: rectangle, width: 0.8, height: 0.8, reflectance: [0.6, 0.32, 0.13],\n"
    "   transform: [{translate: [0.5, 0, 0.05]}]}\n";

static void load_cards(const char *ambient, const char *one, const char *two, abbe_scene *scene) {
  *scene = scene_of(printed(CARDS, ambient, one, two));
}

static void make_bands(const abbe_scene *scene, const abbe_render_desc *desc, size_t bands,
                       abbe_image *out) {
  OK(abbe_band_picture_make(context, scene, desc, bands, NULL, NULL, out, &error));
}

static void make_picture(const abbe_scene *scene, abbe_rgb_space space, abbe_image *out) {
  abbe_render_desc desc = frame;
  desc.space = space;
  HELD(abbe_renderer, renderer) = NULL;
  OK(abbe_renderer_make(context, scene, &desc, &renderer, &error));
  OK(abbe_renderer_frame(renderer, NULL, NULL, NULL, &error));
  OK(abbe_renderer_read(renderer, false, out, &error));
}

/* The bands through the observer. */
static void sum_bands(const abbe_image *bands, const abbe_illuminant *light, abbe_rgb_space space,
                      abbe_image *out) {
  const abbe_relight_desc desc = {.view.from = light, .space = space};
  OK(abbe_relight_make(bands, "bands", &desc, out, &error));
}

/* Root mean square of the difference over the second's mean. */
static double apart(const abbe_image *a, const abbe_image *b) {
  double squares = 0, sum = 0;
  const size_t values = a->width * a->height * 3;
  for (size_t i = 0; i < values; i++) {
    const double x = (double)a->data[i / 3 * a->channels + i % 3],
                 y = (double)b->data[i / 3 * b->channels + i % 3];
    squares += (x - y) * (x - y);
    sum += fabs(y);
  }
  return sqrt(squares / (double)values) / (sum / (double)values);
}

GROUP(setup, teardown);

/* Without refractors a grey reflects E rho / pi times the light's own spectrum: each band is known,
 * and the sum is the picture to single precision. */
TEST(cards_in_bands) {
  const abbe_illuminant d65 = {0};
  const size_t p = (SIDE - 3) * SIDE + 2; /* shows the grey */
  OWNED(abbe_image, bands) = {0}, sum = {0}, picture = {0};
  FILLED(abbe_scene, scene, load_cards("0", "", "", &scene));
  make_bands(&scene, &frame, BANDS, &bands);
  assert_string_equal(bands.channel[0], "S0.400,000000nm");
  make_picture(&scene, ABBE_RGB_SPACE_XYZ, &picture);
  sum_bands(&bands, &d65, ABBE_RGB_SPACE_XYZ, &sum);
  for (int k = 0; k < 3; k++)
    assert_near((double)sum.data[3 * p + k], (double)picture.data[3 * p + k],
                2e-5 * (double)picture.data[3 * p + k]);
  for (int i = 0; i < BANDS; i++) {
    const double expected = (double)picture.data[3 * p + 1] *
                            abbe_weights_band_power(&d65, 380, 780, 380 + 40 * i, 420 + 40 * i) /
                            40;
    assert_near((double)bands.data[BANDS * p + i], expected, 2e-5 * expected);
  }
  print_message("cards: bands' sum and the picture are apart by %.5f\n", apart(&sum, &picture));
  assert_true(apart(&sum, &picture) < 0.01);
}

static void trace_bands(const abbe_scene *scene, int passes, abbe_image *out) {
  const abbe_trace_desc desc = {
      .width = SIDE, .height = SIDE, .bands = BANDS, .no_map = true, .threads = 2};
  *out = traced_picture(scene, &desc, passes);
}

/* A band's sum over the traced one's, and the root mean square of what they are apart by, over the
 * traced mean. */
static double compare_band(const abbe_image *bands, const abbe_image *traced, size_t band,
                           double *ratio) {
  const size_t at = abbe_image_find_channel(traced, bands->channel[band]);
  double a = 0, b = 0, squares = 0;
  assert_true(at != (size_t)-1);
  for (size_t p = 0; p < SIDE * SIDE; p++) {
    const double x = (double)bands->data[p * bands->channels + band],
                 y = (double)traced->data[p * traced->channels + at];
    a += x;
    b += y;
    squares += (x - y) * (x - y);
  }
  *ratio = a / b;
  return sqrt(squares / (SIDE * SIDE)) / (b / (SIDE * SIDE));
}

/* Two illuminants, ambient light, colours: the tracer's bands of the same scene. It gives each of
 * its 4096 steps of wavelength, 0.1 nm or so, to one band alone: at most 2 x 0.1 nm of 40 nm. */
TEST(cards_against_the_tracer) {
  double ratio;
  FILLED(abbe_scene, scene, load_cards("1", "", ", illuminant: A", &scene));
  FILLED(abbe_image, bands, make_bands(&scene, &frame, BANDS, &bands));
  FILLED(abbe_image, traced, trace_bands(&scene, 16, &traced));
  for (size_t i = 0; i < BANDS; i++) {
    compare_band(&bands, &traced, i, &ratio);
    assert_near(ratio, 1, 5e-3);
  }
}

/* A prism spreads each band over many pixels: light must lie there by its power. By what the eye
 * makes of it, the first band would be off by three quarters. */
TEST(a_prism_against_the_tracer) {
  double ratio;
  OWNED(abbe_scene, scene) = shipped_scene("prism");
  FILLED(abbe_image, bands, make_bands(&scene, &frame, BANDS, &bands));
  FILLED(abbe_image, traced, trace_bands(&scene, 12, &traced));
  for (size_t i = 0; i < BANDS; i++) {
    const double off = compare_band(&bands, &traced, i, &ratio);
    print_message("%s: over traced %.4f, apart by %.4f\n", bands.channel[i], ratio, off);
    assert_near(ratio, 1, 0.02);
    assert_true(off < 0.1);
  }
}

/* The law of refractors: the bands through the observer are the picture, as near as bands of such a
 * width tell: a pixel of a prism's spectrum that shows a part of a band gets the whole one's
 * colour.
 */
TEST(sums_are_pictures) {
  static const struct {
    const char *name;
    size_t bands;
    double limit;
  } scenes[] = {{"gem", 10, 0.08}, {"prism", 20, 0.06}, {"sphere", 10, 0.05}};
  const abbe_illuminant d65 = {0};
  for (size_t i = 0; i < (all_cases() ? 3 : 1); i++) {
    OWNED(abbe_image, bands) = {0}, sum = {0}, picture = {0};
    OWNED(abbe_scene, scene) = shipped_scene(scenes[i].name);
    make_bands(&scene, &frame, scenes[i].bands, &bands);
    make_picture(&scene, ABBE_RGB_SPACE_XYZ, &picture);
    sum_bands(&bands, &d65, ABBE_RGB_SPACE_XYZ, &sum);
    double total[2] = {0};
    for (size_t p = 0; p < SIDE * SIDE; p++) {
      total[0] += (double)sum.data[3 * p + 1];
      total[1] += (double)picture.data[3 * p + 1];
    }
    print_message("%s: bands' sum over the picture %.5f, apart by %.4f\n", scenes[i].name,
                  total[0] / total[1], apart(&sum, &picture));
    assert_near(total[0] / total[1], 1, 0.01);
    assert_true(apart(&sum, &picture) < scenes[i].limit);
  }
}

static bool stop_now(void *user, double done) {
  double *least = user;
  *least = fmin(*least, done);
  return done < 0.5;
}

TEST(refusals_and_cancelling) {
  abbe_image bands;
  double least = 1;
  FILLED(abbe_scene, scene, load_cards("0", "", "", &scene));
  REFUSED(ABBE_INVALID_ARGUMENT, "1 to 256",
          abbe_band_picture_make(context, &scene, &frame, 0, NULL, NULL, &bands, &error));
  abbe_render_desc thesis = frame;
  thesis.profile = ABBE_PROFILE_THESIS;
  REFUSED(ABBE_INVALID_ARGUMENT, "thesis",
          abbe_band_picture_make(context, &scene, &thesis, 4, NULL, NULL, &bands, &error));
  REFUSED(ABBE_CANCELLED, "",
          abbe_band_picture_make(context, &scene, &frame, 4, stop_now, &least, &bands, &error));
  assert_true(least < 0.5 && bands.data == NULL);
}

/* The light of a sodium lamp has one colour wherever it goes, and is in the one band of its lines,
 * as the tracer has it. */
TEST(a_sodium_lamp_has_no_colour_but_one) {
  static const char text[] =
      CAMERA "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1,\n"
             "   illuminant: sodium}\n" FLOOR BALL("crown");
  OWNED(abbe_image, bands) = {0}, picture = {0}, traced = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  const size_t lit = 5; /* 580 to 620 nm */
  double white[3], sum[3] = {0};
  abbe_weights_white(ABBE_OBSERVER_CIE_1931, &scene.light[0].illuminant, 380, 780, white);
  make_bands(&scene, &frame, BANDS, &bands);
  make_picture(&scene, ABBE_RGB_SPACE_XYZ, &picture);
  trace_bands(&scene, 4, &traced);
  for (size_t p = 0; p < SIDE * SIDE; p++) {
    const float *xyz = picture.data + 3 * p;
    for (int k = 0; k < 3; k += 2)
      assert_near((double)xyz[k], white[k] * (double)xyz[1], 1e-3 * (double)xyz[1] + 1e-7);
    for (size_t i = 0; i < BANDS; i++) {
      const size_t at = abbe_image_find_channel(&traced, bands.channel[i]);
      const float one = bands.data[BANDS * p + i], other = traced.data[traced.channels * p + at];
      sum[1] += i == lit ? 40 * (double)one : 0;
      sum[2] += i == lit ? 40 * (double)other : 0;
      if (i != lit) assert_true(one == 0 && other == 0);
    }
    sum[0] += (double)xyz[1];
  }
  print_message("sodium: bands %.5f and the tracer's %.5f of the picture\n", sum[1] / sum[0],
                sum[2] / sum[0]);
  assert_near(sum[1] / sum[0], 1, 2e-3);
  assert_near(sum[2] / sum[0], 1, 0.02);
}
