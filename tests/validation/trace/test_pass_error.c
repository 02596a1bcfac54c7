/* How far off a picture is, told by its own passes: noise of known variance, even and of rare
 * bright specks, as it comes and filtered. The truth is known here.
 */
#include "tests/check.h"

#include "validation/measure/compare.h"
#include "validation/trace/pass_error.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, TRIALS = 40 };

static const char *const channels[] = {"R", "G", "B", "caustic.R", "caustic.G", "caustic.B"};

static abbe_image make_image(void) {
  abbe_image image;
  OK(abbe_image_make(SIDE, SIDE, 6, channels, &image, &error));
  return image;
}

static double uniform(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return ((double)(*state >> 11) + 0.5) * 0x1p-53;
}

/* A floor of 0.05, and on it bright bands of caustic that fade. */
static void light_of(size_t pixel, double rgb[3]) {
  const double x = (double)(pixel % SIDE), y = (double)(pixel / SIDE);
  const double band = fabs(fmod(x + 0.3 * y, 16) - 4);
  const double light = band < 4 ? 2 * (1 - band / 4) : 0;
  for (int c = 0; c < 3; c++) rgb[c] = light * (1 + 0.3 * (c - 1) * y / SIDE);
}

static void set(abbe_image *image, size_t pixel, const double rgb[3]) {
  for (size_t c = 0; c < 3; c++) {
    image->data[6 * pixel + c] = (float)(0.05 + rgb[c]);
    image->data[6 * pixel + 3 + c] = (float)rgb[c];
  }
}

static abbe_image make_truth(void) {
  abbe_image image = make_image();
  for (size_t i = 0; i < PIXELS; i++) {
    double rgb[3];
    light_of(i, rgb);
    set(&image, i, rgb);
  }
  return image;
}

/* Means over so many passes, in each of which a pixel has all of its light with a chance of `often`
 * and none else: a variance of (1 / often - 1) times its light squared, a pass. */
static abbe_image make_mean(size_t passes, double often, uint64_t *state, const abbe_image *first,
                            size_t done) {
  abbe_image image = make_image();
  for (size_t i = 0; i < PIXELS; i++) {
    double rgb[3], hits = 0;
    light_of(i, rgb);
    for (size_t k = done; k < passes; k++) hits += uniform(state) < often;
    for (size_t c = 0; c < 3; c++) {
      rgb[c] *= hits / often;
      if (done > 0) rgb[c] += (double)done * (double)first->data[6 * i + 3 + c];
      rgb[c] /= (double)passes;
    }
    set(&image, i, rgb);
  }
  return image;
}

/* A filter: means over squares of pixels, which blur the bands. */
static abbe_image blur(const abbe_image *in) {
  enum { REACH = 1 };
  abbe_image out = make_image();
  for (size_t i = 0; i < PIXELS; i++) {
    double rgb[3] = {0, 0, 0}, count = 0;
    for (size_t y = i / SIDE < REACH ? 0 : i / SIDE - REACH; y <= i / SIDE + REACH && y < SIDE; y++)
      for (size_t x = i % SIDE < REACH ? 0 : i % SIDE - REACH; x <= i % SIDE + REACH && x < SIDE;
           x++, count++)
        for (size_t c = 0; c < 3; c++) rgb[c] += (double)in->data[6 * (y * SIDE + x) + 3 + c];
    for (size_t c = 0; c < 3; c++) rgb[c] /= count;
    set(&out, i, rgb);
  }
  return out;
}

/* What abbe compare says of the caustic. */
static double true_error(const abbe_image *truth, const abbe_image *picture) {
  OWNED(abbe_mask, mask) = {0};
  const abbe_compare_options options = {.mask = &mask};
  MADE(abbe_field, a, abbe_field_make(truth, "truth", &a, &error));
  MADE(abbe_field, b, abbe_field_make(picture, "picture", &b, &error));
  OK(abbe_mask_make_caustic(&a, "truth", ABBE_MASK_CAUSTIC_SHARE, &mask, &error));
  MADE(abbe_comparison, c, abbe_compare(&a, &b, &options, &c, &error));
  return c.mask.metric[ABBE_COMPARE_CIEDE2000_MEAN].value;
}

typedef struct trials {
  double least, most, mean; /* estimate over truth */
  double widest;            /* bound over truth */
  int kept;                 /* bounds that the truth keeps */
} trials;

static trials run(size_t part, size_t passes, double often, bool filtered) {
  trials t = {.least = INFINITY};
  OWNED(abbe_image, truth) = make_truth();
  uint64_t state = 7;
  for (int i = 0; i < TRIALS; i++) {
    abbe_pass_error own;
    OWNED(abbe_image, a) = make_mean(part, often, &state, NULL, 0);
    OWNED(abbe_image, b) = make_mean(passes, often, &state, &a, part);
    OWNED(abbe_image, fa) = blur(&a), fb = blur(&b);
    abbe_pass_pictures p = {.part = &a, .whole = &b, .part_passes = part, .passes = passes};
    if (filtered) {
      p.filtered_part = &fa;
      p.filtered = &fb;
    }
    OK(abbe_pass_error_make(&p, &own, &error));
    const double met = true_error(&truth, filtered ? &fb : &b);
    t.least = fmin(t.least, own.estimate / met);
    t.most = fmax(t.most, own.estimate / met);
    t.mean += own.estimate / met / TRIALS;
    t.widest = fmax(t.widest, own.bound / met);
    t.kept += own.bound >= met;
  }
  return t;
}

static void assert_honest(const trials *t, double mean, double within, double widest) {
  if (fabs(t->mean - mean) > within || t->kept < TRIALS * 9 / 10 || t->widest > widest)
    fail_msg("estimates are %.3g to %.3g of the truth, in the mean %.3g; %d of %d bounds hold, the "
             "widest is %.3g times the truth",
             t->least, t->most, t->mean, t->kept, (int)TRIALS, t->widest);
}

/* Half of the light's pixels in every pass: the noise is small, and falls as it should. */
TEST(even_noise) {
  trials t = run(32, 64, 0.5, false);
  assert_honest(&t, 1, 0.05, 1.6);
  t = run(48, 64, 0.5, false); /* parts that are not halves */
  assert_honest(&t, 1, 0.05, 1.4);
}

/* Of 16 passes one or two hit a pixel, or none, so that most of what is lit is dark or far too
 * bright, and errors fall slowly. */
TEST(rare_specks) {
  trials t = run(8, 16, 0.1, false);
  assert_honest(&t, 0.95, 0.15, 1.7);
  t = run(2, 4, 0.1, false);
  assert_honest(&t, 0.95, 0.2, 1.8);
}

/* What the filter blurs is known too, though both of its pictures are blurred alike: with next to
 * no noise all is blur, which more passes do not lessen. The blurred caustic is also wider than the
 * true one, and its edge counts. */
TEST(a_filter) {
  trials t = run(128, 256, 0.999, true);
  assert_honest(&t, 1, 0.25, 1.5);
  t = run(64, 128, 0.5, true);
  assert_honest(&t, 1.1, 0.25, 1.9);
  t = run(8, 16, 0.1, true);
  assert_honest(&t, 4, 1,
                6); /* too noisy to tell what the filter is worth: as far off as unfiltered */
}

/* A picture that no pass made, off by what is known: blurred, and 10 % too bright. */
static trials run_given(size_t passes, double often, double factor) {
  trials t = {.least = INFINITY};
  OWNED(abbe_image, truth) = make_truth(), given = blur(&truth);
  for (size_t i = 0; i < 6 * PIXELS; i++) given.data[i] *= (float)factor;
  const double met = true_error(&truth, &given);
  uint64_t state = 11;
  for (int i = 0; i < TRIALS; i++) {
    abbe_pass_error own;
    OWNED(abbe_image, a) = make_mean(passes / 2, often, &state, NULL, 0);
    OWNED(abbe_image, b) = make_mean(passes, often, &state, &a, passes / 2);
    abbe_pass_pictures p = {.part = &a, .whole = &b, .part_passes = passes / 2, .passes = passes};
    OK(abbe_pass_error_of_picture(&p, &given, &own, &error));
    t.least = fmin(t.least, own.estimate / met);
    t.most = fmax(t.most, own.estimate / met);
    t.mean += own.estimate / met / TRIALS;
    t.widest = fmax(t.widest, own.bound / met);
    t.kept += own.bound >= met;
  }
  return t;
}

TEST(a_picture_of_another_make) {
  /* The region is the given picture's own, which is blurred and so wider than the true one. */
  trials t = run_given(128, 0.999, 1.1);
  assert_honest(&t, 1.25, 0.02, 1.3);
  t = run_given(1024, 0.5, 1.1);
  assert_honest(&t, 1.25, 0.05, 1.35);
  t = run_given(128, 0.5, 1.1);
  assert_honest(&t, 1.25, 0.1, 1.6);
  t = run_given(16, 0.1, 1); /* specks: nothing is told */
  assert_true(isnan(t.mean) && t.kept == 0);
  abbe_pass_error own;
  OWNED(abbe_image, image) = make_image(), truth = make_truth();
  abbe_pass_pictures p = {.part = &truth, .whole = &truth, .part_passes = 1, .passes = 2};
  OK(abbe_pass_error_of_picture(&p, &truth, &own, &error));
  assert_near(own.bound, 0, 1e-6);
  OK(abbe_pass_error_of_picture(&p, &image, &own, &error)); /* black */
  assert_true(isnan(own.estimate) && isnan(own.bound));
  MADE(abbe_image, small, abbe_image_make(8, 8, 6, channels, &small, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "differ in size",
          abbe_pass_error_of_picture(&p, &small, &own, &error));
}

TEST(what_has_no_caustic) {
  abbe_pass_error own;
  OWNED(abbe_image, image) = make_image();
  abbe_pass_pictures p = {.part = &image, .whole = &image, .part_passes = 1, .passes = 2};
  OK(abbe_pass_error_make(&p, &own, &error));
  assert_true(isnan(own.estimate) && isnan(own.bound));
  for (size_t i = 0; i < PIXELS; i++) image.data[6 * i] = 1; /* lit, and not through refractors */
  OK(abbe_pass_error_make(&p, &own, &error));
  assert_true(isnan(own.estimate) && isnan(own.bound));
  OWNED(abbe_image, truth) = make_truth(), other = make_truth();
  p = (abbe_pass_pictures){.part = &truth,
                           .whole = &truth,
                           .part_passes = 1,
                           .passes = 2,
                           .filtered_part = &other,
                           .filtered = &truth};
  OK(abbe_pass_error_make(&p, &own, &error));
  assert_near(own.bound, 0, 1e-6);
  other.data[6 * 4 + 1] = NAN; /* one of the caustic's: no error is not what is told */
  OK(abbe_pass_error_make(&p, &own, &error));
  assert_true(isnan(own.estimate) && isnan(own.bound));
  p = (abbe_pass_pictures){.part = &image, .whole = &image, .part_passes = 1, .passes = 2};
  p.part_passes = 2;
  REFUSED(ABBE_INVALID_ARGUMENT, "2 of 2 passes", abbe_pass_error_make(&p, &own, &error));
  MADE(abbe_image, small, abbe_image_make(8, 8, 6, channels, &small, &error));
  p = (abbe_pass_pictures){.part = &small, .whole = &image, .part_passes = 1, .passes = 2};
  REFUSED(ABBE_INVALID_ARGUMENT, "differ in size", abbe_pass_error_make(&p, &own, &error));
}
