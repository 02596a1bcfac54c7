/* What surfaces reflect of light that is spread: of one wavelength and of bands what they do, of
 * white and of tints what the mixture does, of greys always their share. */
#include "tests/check.h"

#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"
#include "tests/random.h"

HOLDS(abbe_reflected_light);

static float cell[ABBE_BAND_REFLECTION_CELLS][4];
static const double even[3] = {1, 1, 1};

static abbe_reflected_light *make(const char *name) {
  abbe_reflected_light *light = NULL;
  MADE(abbe_illuminant, illuminant, abbe_illuminant_make(name, &illuminant, &error));
  OK(abbe_reflected_light_make(&illuminant, 380, 780, &light, &error));
  return light;
}

static abbe_spectrum *patch_of(const char *name) {
  abbe_spectrum *patch = NULL;
  OK(abbe_colour_checker_make(name, &patch, &error));
  return patch;
}

static void fill(const abbe_reflected_light *light, const abbe_spectrum *measured,
                 const double rgb[3]) {
  OK(abbe_band_reflection_fill(light, measured, rgb, cell, &error));
}

TEST(greys_keep_their_share) {
  static const double grey[3] = {0.37, 0.37, 0.37};
  HELD(abbe_reflected_light, light) = make("D65");
  double white[3];
  uint64_t random = 7;
  abbe_reflected_light_white(light, white);
  fill(light, NULL, grey);
  for (int i = 0; i < 2000; i++) {
    double xyz[3], out[3];
    for (int k = 0; k < 3; k++) xyz[k] = random_between(&random, 0, 1);
    abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, out);
    for (int k = 0; k < 3; k++) assert_near(out[k], 0.37 * xyz[k], 1e-6);
  }
}

TEST(white_light_is_exact) {
  static const char *const lights[] = {"D65", "A", "F11", "LED-RGB1"};
  for (size_t l = 0; l < 4; l++) {
    HELD(abbe_reflected_light, light) = make(lights[l]);
    double white[3], wanted[3][3], out[3];
    abbe_reflected_light_white(light, white);
    for (size_t p = 0; p < ABBE_COLOUR_CHECKER_COUNT; p++) {
      abbe_spectrum *patch = patch_of(abbe_colour_checker_name(p));
      abbe_reflected_light_xyz(light, patch, wanted);
      fill(light, patch, even);
      abbe_band_reflection_apply((const float(*)[4])cell, white, white, out);
      for (int k = 0; k < 3; k++) assert_near(out[k], wanted[0][k], 1e-6);
      abbe_spectrum_free(patch);
    }
  }
}

typedef double (*spectrum_of)(double nm, double at);

static double bell(double nm, double at, double width) {
  return exp(-4 * log(2) * pow((nm - at) / width, 2));
}
static double line(double nm, double at) {
  return bell(nm, at, 2);
}
static double narrow(double nm, double at) {
  return bell(nm, at, 30);
}
static double below(double nm, double at) {
  return nm < at;
}
static double soft(double nm, double at) {
  return 1 / (1 + exp((nm - at) / 15));
}
/* From reddish to bluish glass as `at` goes over the range. */
static double tint(double nm, double at) {
  return pow(550 / nm, (at - 555) / 45);
}

/* Of so many lights, |X| + |Y| + |Z| of what is off over what is reflected: by the mixture, and by
 * bands. */
static void measure(const abbe_reflected_light *light, const abbe_spectrum *patch, spectrum_of of,
                    double off[2]) {
  double matrix[3][9], white[3], all = 0, sum[2] = {0, 0};
  abbe_reflected_light_white(light, white);
  abbe_reflected_light_matrices(light, patch, matrix);
  fill(light, patch, even);
  for (double at = 420; at <= 690; at += 5) {
    double xyz[3] = {0}, kept[3] = {0}, said[2][3];
    for (size_t i = 0; i < abbe_reflected_light_steps(light); i++) {
      double nm, step[3];
      abbe_reflected_light_step(light, i, &nm, step);
      for (int k = 0; k < 3; k++) {
        xyz[k] += of(nm, at) * step[k];
        kept[k] += of(nm, at) * abbe_spectrum_at(patch, nm) * step[k];
      }
    }
    abbe_rgb_space_apply(matrix[0], xyz, said[0]);
    abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, said[1]);
    for (int k = 0; k < 3; k++) {
      all += kept[k];
      for (int who = 0; who < 2; who++) sum[who] += fabs(said[who][k] - kept[k]);
    }
  }
  for (int who = 0; who < 2; who++) off[who] = sum[who] / all;
}

/* The most that may be off by bands: of a line, of 30 nm, of all below an edge, of a soft edge, and
 * of tints, where the mixture is right. */
TEST(light_that_is_spread) {
  static const struct {
    const char *what;
    spectrum_of of;
    double most;
  } lights[] = {{"lines", line, 0.06},
                {"bands of 30 nm", narrow, 0.08},
                {"edges", below, 0.09},
                {"soft edges", soft, 0.12},
                {"tints", tint, 0.03}};
  static const char *const patches[] = {"red", "bluish green", "blue flower", "foliage", "orange"};
  HELD(abbe_reflected_light, light) = make("D65");
  for (size_t p = 0; p < 5; p++) {
    abbe_spectrum *patch = patch_of(patches[p]);
    for (size_t l = 0; l < 5; l++) {
      double off[2];
      measure(light, patch, lights[l].of, off);
      print_message("%-13s %-15s mixture %.3f, bands %.3f\n", patches[p], lights[l].what, off[0],
                    off[1]);
      assert_true(off[1] < lights[l].most);
      if (l < 2) assert_true(off[1] < 0.5 * off[0]);
    }
    abbe_spectrum_free(patch);
  }
}

TEST(colours_add_up) {
  static const double rgb[3] = {0.7, 0.2, 0.4}, xyz[3] = {0.5, 0.3, 0.1};
  HELD(abbe_reflected_light, light) = make("A");
  double white[3], whole[3], sum[3] = {0}, part[3];
  abbe_reflected_light_white(light, white);
  fill(light, NULL, rgb);
  abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, whole);
  for (int j = 0; j < 3; j++) {
    const double one[3] = {j == 0 ? rgb[0] : 0, j == 1 ? rgb[1] : 0, j == 2 ? rgb[2] : 0};
    fill(light, NULL, one);
    abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, part);
    for (int k = 0; k < 3; k++) sum[k] += part[k];
  }
  for (int k = 0; k < 3; k++) assert_near(sum[k], whole[k], 1e-6);
}

/* A line, or a range that nobody sees, has no colours to tell bands by. */
TEST(lights_of_few_colours) {
  static const double rgb[3] = {0.7, 0.2, 0.4};
  static const abbe_illuminant d65 = {.kind = ABBE_ILLUMINANT_D65};
  static const double ranges[][2] = {{589, 590}, {900, 1000}};
  for (size_t i = 0; i < 2; i++) {
    HELD(abbe_reflected_light, light) = NULL;
    double white[3], of[3][3], out[3];
    OK(abbe_reflected_light_make(&d65, ranges[i][0], ranges[i][1], &light, &error));
    abbe_reflected_light_white(light, white);
    abbe_reflected_light_xyz(light, NULL, of);
    fill(light, NULL, rgb);
    abbe_band_reflection_apply((const float(*)[4])cell, white, white, out);
    for (int k = 0; k < 3; k++)
      assert_near(out[k], rgb[0] * of[0][k] + rgb[1] * of[1][k] + rgb[2] * of[2][k], 1e-3);
  }
}
