/* The filter of traced pictures, on pictures whose truth is known. */
#include "tests/check.h"

#include "tests/random.h"
#include "tests/validation/trace_scene.h"
#include "validation/trace/denoise.h"

static const char *const layers[] = {"R",
                                     "G",
                                     "B",
                                     "stderr.R",
                                     "stderr.G",
                                     "stderr.B",
                                     "caustic.R",
                                     "caustic.G",
                                     "caustic.B",
                                     "photons.R",
                                     "photons.G",
                                     "photons.B",
                                     "stderr.photons.R",
                                     "stderr.photons.G",
                                     "stderr.photons.B",
                                     "covariance.photons.RG",
                                     "covariance.photons.RB",
                                     "covariance.photons.GB",
                                     "eye.R",
                                     "eye.G",
                                     "eye.B",
                                     "stderr.eye.R",
                                     "stderr.eye.G",
                                     "stderr.eye.B",
                                     "covariance.eye.RG",
                                     "covariance.eye.RB",
                                     "covariance.eye.GB",
                                     "albedo.R",
                                     "albedo.G",
                                     "albedo.B",
                                     "normal.X",
                                     "normal.Y",
                                     "normal.Z",
                                     "depth.Z",
                                     "stderr.albedo.R",
                                     "stderr.albedo.G",
                                     "stderr.albedo.B",
                                     "stderr.normal.X",
                                     "stderr.normal.Y",
                                     "stderr.normal.Z",
                                     "stderr.depth.Z"};
enum {
  LAYERS = sizeof layers / sizeof *layers,
  RGB = 0,
  ERRORS = 3,
  CAUSTIC = 6,
  PHOTONS = 9,
  PHOTON_ERRORS = 12,
  EYE = 18,
  EYE_ERRORS = 21,
  ALBEDO = 27,
  NORMAL = 30
};

/* What a pixel shows: light of the eye's and of photons. */
typedef struct truth {
  double (*eye)(size_t x, size_t y), (*photons)(size_t x, size_t y);
} truth;

static double none(size_t x, size_t y) {
  (void)x, (void)y;
  return 0;
}

static double plain(size_t x, size_t y) {
  (void)x, (void)y;
  return 2;
}

static double lobes(size_t x, size_t y) {
  return 1 + sin(0.05 * (double)x) * cos(0.07 * (double)y);
}

static double edge(size_t x, size_t y) {
  (void)y;
  return x < 40 ? 0.5 : 3;
}

/* Noise of every colour by itself, of `deviation` times the root of the light; its variance known
 * as well as `passes` tell it. */
static abbe_image make(size_t width, size_t height, const truth *t, double deviation, int passes,
                       double unit) {
  abbe_image image;
  OK(abbe_image_make(width, height, LAYERS, layers, &image, &error));
  OK(abbe_image_set_attribute(&image, "abbe:passes", printed("%d", passes), &error));
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
  uint64_t random = 3;
  for (size_t i = 0; i < width * height; i++) {
    float *to = image.data + i * LAYERS;
    const double light[2] = {t->photons(i % width, i / width), t->eye(i % width, i / width)};
    for (int part = 0; part < 2; part++)
      for (int k = 0; k < 3; k++) {
        double sum = 0, squares = 0;
        for (int pass = 0; pass < passes; pass++) {
          const double x =
              light[part] + deviation * sqrt(light[part] * passes) * random_normal(&random);
          sum += x;
          squares += x * x;
        }
        sum /= passes;
        const double error = sqrt(fmax(squares / passes - sum * sum, 0) / (passes - 1));
        to[(part ? EYE : PHOTONS) + k] = (float)(unit * sum);
        to[(part ? EYE_ERRORS : PHOTON_ERRORS) + k] = (float)(unit * error);
        to[RGB + k] += (float)(unit * sum);
        to[ERRORS + k] = hypotf(to[ERRORS + k], (float)(unit * error));
        if (part == 0) to[CAUSTIC + k] = (float)(unit * sum);
      }
    to[ALBEDO] = to[ALBEDO + 1] = to[ALBEDO + 2] = 0.8f;
    to[NORMAL + 2] = 1;
    to[NORMAL + 3] = (float)(5 * unit);
  }
  return image;
}

static abbe_image filter(const abbe_image *image, size_t threads) {
  const abbe_denoise_desc desc = {.threads = threads};
  abbe_image out;
  OK(abbe_denoise_picture(image, &desc, &out, &error));
  return out;
}

static const float *at(const abbe_image *image, const char *name, size_t pixel) {
  const size_t channel = abbe_image_find_channel(image, name);
  assert_true(channel < image->channels);
  return image->data + pixel * image->channels + channel;
}

/* Mean squares over all pixels of what is wrong, of what is stated, and the mean. */
typedef struct judged {
  double square, stated, mean, truth;
} judged;

static judged judge(const abbe_image *image, const char *name, const char *error, const truth *t,
                    double unit) {
  judged j = {0};
  const size_t count = image->width * image->height;
  for (size_t i = 0; i < count; i++) {
    const size_t x = i % image->width, y = i / image->width;
    const double light = unit * (t->eye(x, y) + t->photons(x, y));
    const double value = (double)*at(image, name, i);
    assert_true(isfinite(value));
    j.square += pow(value - light, 2) / (double)count;
    j.stated += pow((double)*at(image, error, i), 2) / (double)count;
    j.mean += value / (double)count;
    j.truth += light / (double)count;
  }
  return j;
}

static const char *const names[3] = {"R", "G", "B"};
static const char *const errors[3] = {"stderr.R", "stderr.G", "stderr.B"};

/* On a plain the variance falls at least thirty times; the picture's mean stays within the noise of
 * the mean; what is stated is not less than what is left, but for chance. In any unit of light. */
TEST(noise_goes_and_light_stays) {
  static const double units[] = {1, 1e-9, 1e9};
  const truth of[2] = {{plain, none}, {none, plain}};
  for (size_t u = 0; u < (SANITIZED ? 1 : 3); u++)
    for (size_t s = u > 0; s < 2; s++) {
      OWNED(abbe_image, image) = make(90, 80, &of[s], 0.3, 8, units[u]), out = filter(&image, 2);
      const judged raw = judge(&image, "R", "stderr.R", &of[s], units[u]);
      for (size_t k = 0; k < 3; k++) {
        const judged j = judge(&out, names[k], errors[k], &of[s], units[u]);
        assert_true(j.square < raw.square / 30);
        assert_true(j.stated / j.square > 0.7 && j.stated / j.square < 8);
        const judged before = judge(&image, names[k], errors[k], &of[s], units[u]);
        assert_near(j.mean / before.mean, 1, 0.01);
      }
    }
}

/* Structure is followed, and what blur there is, is stated. */
TEST(structure_stays) {
  const truth of[] = {{lobes, none}, {none, lobes}, {none, edge}, {edge, none}, {lobes, edge}};
  for (size_t s = 0; s < sizeof of / sizeof *of; s += SANITIZED ? 2 : 1) {
    OWNED(abbe_image, image) = make(90, 80, &of[s], 0.1, 8, 1), out = filter(&image, 2);
    for (size_t k = 0; k < 3; k++) {
      const judged raw = judge(&image, names[k], errors[k], &of[s], 1);
      const judged j = judge(&out, names[k], errors[k], &of[s], 1);
      assert_true(j.square < raw.square / 8);
      assert_true(j.stated / j.square > 0.4 && j.stated / j.square < 8);
      assert_near(j.mean / raw.mean, 1, 2e-3);
    }
  }
}

TEST(what_has_no_noise_stays) {
  const truth of = {edge, lobes};
  OWNED(abbe_image, image) = make(70, 40, &of, 0, 8, 1), out = filter(&image, 2);
  for (size_t i = 0; i < image.width * image.height; i++)
    for (size_t k = 0; k < 3; k++) {
      const double value = (double)*at(&image, names[k], i);
      assert_near((double)*at(&out, names[k], i), value, 3e-6 * value);
    }
}

/* Noise beside pixels without any: means of their variances are differences of sums, and what
 * rounding leaves of those, above 0 or below, is no variance. */
TEST(quiet_pixels_beside_noisy_ones) {
  enum { SIDE = 32, NOISY = 4, PICTURES = SANITIZED ? 20 : 400 };
  uint64_t random = 11;
  const truth t = {plain, none};
  for (int i = 0; i < PICTURES; i++) {
    OWNED(abbe_image, image) = make(SIDE, SIDE, &t, 0, 4, 1);
    const double scale = pow(10, random_between(&random, -3, -0.5));
    for (size_t k = 0; k < (size_t)SIDE * SIDE; k++)
      for (size_t c = 0; c < 3 && k % SIDE < NOISY && k / SIDE < NOISY; c++)
        image.data[k * LAYERS + EYE_ERRORS + c] =
            (float)(scale * pow(10, random_between(&random, -7, 0)));
    OWNED(abbe_image, out) = filter(&image, 1);
    for (size_t k = 0; k < SIDE * SIDE * out.channels; k++)
      if (!isfinite(out.data[k])) fail_msg("picture %d has a sample that is not finite", i);
  }
}

TEST(raw_layers_are_kept) {
  const truth of = {edge, lobes};
  OWNED(abbe_image, image) = make(20, 10, &of, 0.1, 4, 1), out = filter(&image, 2);
  static const char *const pairs[][2] = {{"R", "raw.R"},
                                         {"stderr.G", "stderr.raw.G"},
                                         {"caustic.B", "raw.caustic.B"},
                                         {"albedo.R", "albedo.R"},
                                         {"depth.Z", "depth.Z"}};
  for (size_t i = 0; i < image.width * image.height; i++)
    for (size_t p = 0; p < sizeof pairs / sizeof *pairs; p++)
      assert_true(*at(&image, pairs[p][0], i) == *at(&out, pairs[p][1], i));
  assert_string_equal(abbe_image_attribute_text(&out, "abbe:passes"), "4");
  assert_string_equal(abbe_image_attribute_text(&out, "abbe:filter"), "non-local means");
  assert_memory_equal(out.xy, image.xy, sizeof out.xy);
}

TEST(threads_do_not_matter) {
  const truth of = {edge, lobes};
  OWNED(abbe_image, image) = make(70, 50, &of, 0.1, 4, 1), one = filter(&image, 1);
  for (size_t threads = 2; threads < 5; threads++) {
    OWNED(abbe_image, many) = filter(&image, threads);
    check_same_image(&one, &many);
  }
}

/* Small, black, and with what is no number in it: always a picture, and finite. */
TEST(awkward_pictures) {
  static const size_t sizes[][2] = {{1, 1}, {3, 3}, {1, 40}, {2, 1}};
  const truth of[] = {{edge, lobes}, {none, none}};
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
    for (size_t t = 0; t < 2; t++)
      for (int broken = 0; broken < 2; broken++) {
        OWNED(abbe_image, image) = make(sizes[s][0], sizes[s][1], &of[t], 0.1, 2, 1);
        if (broken) {
          image.data[PHOTONS] = NAN;
          image.data[EYE + 1] = INFINITY;
          image.data[EYE_ERRORS] = NAN;
          image.data[PHOTON_ERRORS] = INFINITY;
          image.data[NORMAL] = NAN;
        }
        OWNED(abbe_image, out) = filter(&image, 2);
        for (size_t i = 0; i < image.width * image.height; i++)
          for (size_t k = 0; k < 3; k++) {
            assert_true(isfinite(*at(&out, names[k], i)));
            assert_true(isfinite(*at(&out, errors[k], i)));
            if (t == 1 && !broken) assert_true(*at(&out, names[k], i) == 0);
          }
      }
}

TEST(a_missing_layer_is_named) {
  const truth of = {edge, lobes};
  OWNED(abbe_image, image) = make(4, 4, &of, 0.1, 4, 1);
  abbe_image out;
  for (size_t c = 0; c < LAYERS; c++) {
    const char kept = image.channel[c][0];
    image.channel[c][0] = '?';
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_denoise_picture(&image, &(abbe_denoise_desc){0}, &out, &error));
    image.channel[c][0] = kept;
    if (c >= ERRORS) assert_contains(last_error.text, layers[c]);
    assert_null(out.data);
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "100000",
          abbe_denoise_picture(&image, &(abbe_denoise_desc){.threads = 100000}, &out, &error));
}

/* ---- of the tracer's own pictures ---- */

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")

static abbe_image trace(const abbe_scene *scene, abbe_rgb_space space, uint32_t seed,
                        size_t passes) {
  const abbe_trace_desc desc = FIELDS(.no_map = true, .guides = true, .width = 40, .height = 30,
                                      .space = space, .bands = 2, .photons = 20000, .seed = seed);
  return traced_picture(scene, &desc, passes);
}

static double distance(const abbe_image *a, const abbe_image *b, const char *name) {
  double sum = 0;
  for (size_t i = 0; i < a->width * a->height; i++)
    sum += pow((double)*at(a, name, i) - (double)*at(b, name, i), 2);
  return sum;
}

/* A few passes, filtered, against many of another seed: nearer than they were, and the bands and
 * the light as a whole are as traced. In R, G, B and in X, Y, Z. */
TEST(a_traced_picture_comes_nearer) {
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  static const abbe_rgb_space spaces[2] = {ABBE_RGB_SPACE_ACESCG, ABBE_RGB_SPACE_XYZ};
  static const char *const of[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
  for (size_t s = 0; s < 2; s++) {
    OWNED(abbe_image, much) = trace(&scene, spaces[s], 1, 24), few = trace(&scene, spaces[s], 2, 4);
    OWNED(abbe_image, out) = filter(&few, 0);
    for (size_t k = 0; k < 3; k++) {
      assert_true(distance(&out, &much, of[s][k]) < 0.9 * distance(&few, &much, of[s][k]));
      assert_near(channel_sum(&out, of[s][k]) / channel_sum(&few, of[s][k]), 1, 3e-3);
    }
    assert_true(channel_sum(&out, "S0.480,000000nm") == channel_sum(&few, "S0.480,000000nm"));
    assert_true(abbe_image_find_channel(&out, "photons.R") == (size_t)-1);
  }
}

/* One pass tells no errors, so there is nothing to go by. */
TEST(one_pass_is_refused) {
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  OWNED(abbe_image, one) = trace(&scene, ABBE_RGB_SPACE_ACESCG, 1, 1);
  abbe_image out;
  REFUSED(ABBE_INVALID_ARGUMENT, "two passes",
          abbe_denoise_picture(&one, &(abbe_denoise_desc){0}, &out, &error));
}
