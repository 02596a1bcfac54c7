/* The eye's glare: its point spread by the paper's numbers, and that no light is lost. */
#include "tests/check.h"

#include "base/maths.h"
#include "colorimetry/screen/screen_file.h"

#include <time.h>

static void make(size_t width, size_t height, abbe_image *image) {
  static const char *const names[] = {"R", "G", "B"};
  OK(abbe_image_make(width, height, 3, names, image, &error));
}

static double total(const abbe_image *image, size_t channel) {
  double sum = 0;
  for (size_t i = 0; i < image->width * image->height; i++)
    sum += (double)image->data[3 * i + channel];
  return sum;
}

/* Light within theta, of 1: the paper's three functions are each one's whole over the hemisphere.
 */
static double within(double theta_deg) {
  enum { STEPS = 200000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    const double t = theta_deg * pow((i + 0.5) / STEPS, 3);
    const double dt = theta_deg * (pow((i + 1.0) / STEPS, 3) - pow((double)i / STEPS, 3));
    sum += abbe_glare_spread(t) * 2 * ABBE_PI * sin(t * ABBE_DEGREE) * dt * ABBE_DEGREE;
  }
  return sum;
}

TEST(the_spread_is_the_whole_light) {
  assert_near(within(90), 1, 0.004);
}

TEST(a_point_becomes_the_spread) {
  enum { SIDE = 257, MIDDLE = SIDE / 2 };
  static const double highs[] = {2, 20};
  for (size_t k = 0; k < 2; k++) {
    const double deg = highs[k] / SIDE;
    FILLED(abbe_image, image, make(SIDE, SIDE, &image));
    image.data[3 * (MIDDLE * SIDE + MIDDLE) + 1] = 1000;
    OK(abbe_glare_add(&image, highs[k], &error));
    assert_near(total(&image, 1), 1000, 1e-3);
    assert_near(total(&image, 0), 0, 1e-3);
    assert_near(total(&image, 2), 0, 1e-3);
    for (int far = 8; far < 40; far += 7) {
      const double got = (double)image.data[3 * (MIDDLE * SIDE + MIDDLE + far) + 1];
      const double want = 1000 * abbe_glare_spread(far * deg) * pow(deg * ABBE_DEGREE, 2);
      /* the mirror images of the point add to it */
      assert_near(got, want,
                  0.02 * want +
                      8 * 1000 * abbe_glare_spread((SIDE - far) * deg) * pow(deg * ABBE_DEGREE, 2));
    }
    double ring = 0;
    for (int y = 0; y < SIDE; y++)
      for (int x = 0; x < SIDE; x++) {
        const double far = hypot(x - MIDDLE, y - MIDDLE);
        if (far > 5 && far < 60) ring += (double)image.data[3 * (y * SIDE + x) + 1] / 1000;
      }
    print_message("%g degrees: %.4f of the light between 5 and 60 pixels, %.4f by the formula\n",
                  highs[k], ring, within(60 * deg) - within(5 * deg));
    assert_near(ring, within(60 * deg) - within(5 * deg), 0.003);
  }
}

TEST(no_light_is_lost) {
  for (size_t wide = 37; wide <= 103; wide += 66) { /* 103: with a longer side */
    FILLED(abbe_image, image, make(wide, 21, &image));
    for (size_t i = 0; i < wide * 21 * 3; i++)
      image.data[i] = i % 3 == 2 ? 0.7f : (float)(i * i % 97);
    const double before[] = {total(&image, 0), total(&image, 1), total(&image, 2)};
    OK(abbe_glare_add(&image, 10, &error));
    for (size_t k = 0; k < 3; k++) assert_near(total(&image, k), before[k], 1e-5 * before[k]);
    /* what is even stays so, at the edges too */
    for (size_t i = 2; i < wide * 21 * 3; i += 3) assert_near((double)image.data[i], 0.7, 1e-6);
  }
}

TEST(what_is_not_finite_does_not_spread) {
  FILLED(abbe_image, image, make(8, 8, &image));
  image.data[0] = NAN;
  image.data[4] = INFINITY;
  OK(abbe_glare_add(&image, 10, &error));
  for (size_t i = 0; i < 8 * 8 * 3; i++) assert_true(isfinite(image.data[i]));
  image.height = ABBE_GLARE_MAX_PIXELS;
  REFUSED(ABBE_INVALID_ARGUMENT, "at most", abbe_glare_add(&image, 10, &error));
  image.height = 8;
}

/* 32749 is prime. */
TEST(sides_without_factors_are_fast) {
  FILLED(abbe_image, image, make(32749, 1, &image));
  for (size_t i = 0; i < 32749; i++) image.data[3 * i] = (float)(i % 97);
  const double before = total(&image, 0);
  const clock_t start = clock();
  OK(abbe_glare_add(&image, 0.1, &error));
  const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  print_message("%.3f s\n", seconds);
  assert_true(seconds < 2);
  assert_near(total(&image, 0), before, 1e-5 * before);
}
