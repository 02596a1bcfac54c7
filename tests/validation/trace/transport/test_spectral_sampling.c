#include "tests/scenes/scene_text.h"

#include "colorimetry/observer.h"
#include "validation/trace/transport/spectral_sampling.h"

#define LIGHTS_OF_THREE_KINDS                                                                      \
  "lights:\n"                                                                                      \
  "- {name: day, kind: point, position: [0, 0, 1], intensity: 1}\n"                                \
  "- {name: bulb, kind: point, position: [0, 1, 1], intensity: 7, illuminant: A}\n"                \
  "- {name: even, kind: directional, direction: [0, 0, -1], irradiance: 1e-3, illuminant: E}\n"

enum { STEPS = ABBE_SPECTRAL_SAMPLING_STEPS };

static void make(abbe_scene *scene, double min_nm, double max_nm, double uniform,
                 abbe_spectral_sampling *s) {
  *scene = scene_of(CAMERA LIGHTS_OF_THREE_KINDS FLOOR);
  const abbe_spectral_sampling_desc desc = {.min_nm = min_nm, .max_nm = max_nm, .uniform = uniform};
  OK(abbe_spectral_sampling_make(scene, &desc, s, &error));
}

static void drop(abbe_scene *scene, abbe_spectral_sampling *s) {
  abbe_spectral_sampling_free(s);
  abbe_scene_free(scene);
}

static const double ranges[][2] = {{380, 780}, {300, 900}, {589, 590}, {650, 1200}, {400, 401}};

TEST(the_mean_of_all_paths_is_white) {
  for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++) {
    abbe_scene scene;
    abbe_spectral_sampling s;
    make(&scene, ranges[r][0], ranges[r][1], 0.15, &s);
    assert_int_equal(s.lights, 3);
    for (size_t l = 0; l < 3; l++) {
      double mean[3] = {0}, power = 0;
      for (size_t k = 0; k < STEPS; k++) {
        power += (double)s.power[l * STEPS + k] / STEPS;
        for (int c = 0; c < 3; c++) {
          assert_true(s.xyz[l * STEPS + k][c] >= 0);
          mean[c] += (double)s.xyz[l * STEPS + k][c] / STEPS;
        }
      }
      assert_near(s.white[l][1], 1, 1e-9);
      assert_near(power, 1, 1e-6);
      for (int c = 0; c < 3; c++) assert_near(mean[c], s.white[l][c], 1e-6);
    }
    drop(&scene, &s);
  }
}

/* D65's white over the whole visible range, by its chromaticity [CIE 15]. */
TEST(the_white_of_d65) {
  abbe_scene scene;
  abbe_spectral_sampling s;
  make(&scene, 360, 830, 0.15, &s);
  double sum = s.white[0][0] + s.white[0][1] + s.white[0][2];
  assert_near(s.white[0][0] / sum, 0.31272, 2e-5);
  assert_near(s.white[0][1] / sum, 0.32903, 2e-5);
  drop(&scene, &s);
}

TEST(steps_rise_from_end_to_end) {
  for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++) {
    abbe_scene scene;
    abbe_spectral_sampling s;
    make(&scene, ranges[r][0], ranges[r][1], 0.01, &s);
    assert_true(s.lambda_nm[0] == ranges[r][0] && s.lambda_nm[STEPS] == ranges[r][1]);
    for (size_t k = 0; k < STEPS; k++) assert_true(s.lambda_nm[k] < s.lambda_nm[k + 1]);
    drop(&scene, &s);
  }
}

/* What the eye sees of the three lights at lambda, and a sum over the range to divide it by. */
static double seen(const abbe_scene *scene, double lambda, double part[3]) {
  double xyz[3];
  abbe_observer_xyz(lambda, xyz);
  for (int l = 0; l < 3; l++)
    part[l] =
        abbe_illuminant_power(&scene->light[l].illuminant, lambda) * (xyz[0] + xyz[1] + xyz[2]);
  return part[0] + part[1] + part[2];
}

/* Every step has the same probability: the mean of the lights' visible spectra and a flat one,
 * integrated over it by itself. */
TEST(steps_are_equally_probable) {
  abbe_scene scene;
  abbe_spectral_sampling s;
  const double uniform = 0.15, range = 400;
  make(&scene, 380, 780, uniform, &s);
  enum { FINE = 400000 };
  double sum[3] = {0}, part[3];
  for (int i = 0; i < FINE; i++) {
    seen(&scene, 380 + range * (i + 0.5) / FINE, part);
    for (int l = 0; l < 3; l++) sum[l] += part[l] * range / FINE;
  }
  for (size_t k = 0; k < STEPS; k += 7) {
    double width = s.lambda_nm[k + 1] - s.lambda_nm[k], density = uniform / range;
    seen(&scene, s.lambda_nm[k] + 0.5 * width, part);
    for (int l = 0; l < 3; l++) density += (1 - uniform) * part[l] / sum[l] / 3;
    assert_near(density * width * STEPS, 1, 0.01);
  }
  drop(&scene, &s);
}

/* A uniform part of the density bounds how much brighter than the mean a path can be: none of the
 * lights' shares, a third each, is starved. */
TEST(no_path_carries_much_more_than_the_mean) {
  abbe_scene scene;
  abbe_spectral_sampling s;
  make(&scene, 380, 780, 0.15, &s);
  for (size_t i = 0; i < 3 * STEPS; i++) {
    float all = s.xyz[i][0] + s.xyz[i][1] + s.xyz[i][2];
    double white = 0;
    for (int c = 0; c < 3; c++) white += s.white[i / STEPS][c];
    assert_true((double)all <= white * 3 / (1 - 0.15) * 1.001);
  }
  drop(&scene, &s);
}

TEST(a_number_finds_its_step_and_wavelength) {
  abbe_scene scene;
  abbe_spectral_sampling s;
  make(&scene, 380, 780, 0.15, &s);
  const uint32_t x[] = {0, 1, 0x40000000u, 0xb504f333u, 0xffffffffu};
  double last = 0;
  for (size_t i = 0; i < sizeof x / sizeof *x; i++) {
    float within;
    uint32_t k = abbe_spectral_sampling_step(x[i], &within);
    assert_true(k < STEPS && within >= 0 && within < 1);
    assert_near(((double)k + (double)within) / STEPS, (double)x[i] * 0x1p-32, 0);
    double lambda = abbe_spectral_sampling_lambda(&s, k, within);
    assert_true(lambda >= 380 && lambda < 780 && lambda > last);
    last = lambda;
  }
  drop(&scene, &s);
}

TEST(colours_are_the_xyz_in_the_space) {
  abbe_scene scene;
  abbe_spectral_sampling s;
  make(&scene, 380, 780, 0.15, &s);
  static float rgb[3 * STEPS][3];
  for (int space = 0; space < ABBE_RGB_SPACE_COUNT; space++) {
    double to_xyz[9], mean[3] = {0};
    abbe_spectral_sampling_colours(&s, (abbe_rgb_space)space, rgb);
    abbe_rgb_space_to_xyz((abbe_rgb_space)space, to_xyz);
    for (size_t k = 0; k < STEPS; k++)
      for (int c = 0; c < 3; c++) mean[c] += (double)rgb[k][c] / STEPS;
    abbe_rgb_space_apply(to_xyz, mean, mean);
    for (int c = 0; c < 3; c++) assert_near(mean[c], s.white[0][c], 2e-6);
  }
  drop(&scene, &s);
}

TEST(what_cannot_be_sampled_is_refused) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA LIGHTS_OF_THREE_KINDS FLOOR);
  OWNED(abbe_spectral_sampling, s) = {0};
  /* no eye sees it */
  const abbe_spectral_sampling_desc unseen = {.min_nm = 900, .max_nm = 1000, .uniform = 0.15};
  REFUSED(ABBE_INVALID_ARGUMENT, "'day'", abbe_spectral_sampling_make(&scene, &unseen, &s, &error));
  assert_contains(last_error.text, "between 900 and 1000 nm");
  assert_null(s.xyz);
  const double bad[][3] = {{780, 380, 0.1}, {500, 500, 0.1}, {-1, 500, 0.1},       {0, 500, 0.1},
                           {NAN, 500, 0.1}, {500, NAN, 0.1}, {500, INFINITY, 0.1}, {380, 780, 0},
                           {380, 780, 2},   {380, 780, NAN}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    const abbe_spectral_sampling_desc desc = {
        .min_nm = bad[i][0], .max_nm = bad[i][1], .uniform = bad[i][2]};
    assert_int_equal(abbe_spectral_sampling_make(&scene, &desc, &s, NULL), ABBE_INVALID_ARGUMENT);
  }
}

/* Light of lines comes at their wavelengths, whatever else shines and where bands end. */
TEST(paths_of_lines_have_their_wavelengths) {
  for (size_t bands = 0; bands <= 7; bands += 7) {
    abbe_spectral_sampling s;
    abbe_scene scene = scene_of(
        CAMERA
        "lights:\n- {name: lamp, kind: point, position: [0, 0, 1], intensity: 1, illuminant: "
        "sodium}\n- {name: day, kind: point, position: [0, 1, 1], intensity: 1}\n" FLOOR);
    const abbe_spectral_sampling_desc desc = {
        .min_nm = 380, .max_nm = 780, .uniform = 0.15, .bands = bands};
    OK(abbe_spectral_sampling_make(&scene, &desc, &s, &error));
    size_t bright[2] = {0};
    double sum = 0, power[2] = {0};
    for (size_t k = 0; k < STEPS; k++) {
      if (!(s.power[k] > 0)) continue;
      const double middle = 0.5 * (s.lambda_nm[k] + s.lambda_nm[k + 1]);
      const int line = middle < 589.3 ? 0 : 1;
      assert_near(s.lambda_nm[k], line == 0 ? 588.9950 : 589.5924, 1.001e-3);
      assert_near(s.lambda_nm[k + 1], line == 0 ? 588.9950 : 589.5924, 1.001e-3);
      bright[line]++;
      power[line] += (double)s.power[k] / STEPS;
      sum += (double)s.xyz[k][1] / STEPS;
    }
    assert_near(power[0], 2.0 / 3, 1e-6);
    assert_near(power[1], 1.0 / 3, 1e-6);
    assert_near(sum, 1, 1e-6);
    /* half of the visible paths are the lamp's */
    assert_near((double)(bright[0] + bright[1]) / STEPS, 0.85 / 2, 0.005);
    drop(&scene, &s);
  }
}
