/* FLIP where it is known in closed form, and against what the authors' program makes of a picture
 * that a formula paints. */
#include "tests/check.h"

#include "colorimetry/difference.h"
#include "validation/measure/compare_state.h"

enum { W = 64, H = 48, PIXELS = W * H };

typedef float picture[PIXELS][3];

static void even(picture p, double r, double g, double b) {
  for (int i = 0; i < PIXELS; i++) {
    p[i][0] = (float)r;
    p[i][1] = (float)g;
    p[i][2] = (float)b;
  }
}

static double mean_of(const float *map) {
  double sum = 0;
  for (int i = 0; i < PIXELS; i++) sum += (double)map[i];
  return sum / PIXELS;
}

static double flip(picture reference, picture test, float *map) {
  abbe_error error = {0};
  if (abbe_flip_map((const float(*)[3])reference, (const float(*)[3])test, W, H, 0, map, &error) !=
      ABBE_OK)
    fail_msg("%s", error.text);
  return mean_of(map);
}

/* Green against blue is the most that two colours differ by: 1. Of greys only L* counts: 100 to the
 * power 0.7 is bent by the greatest distance. */
TEST(even_pictures) {
  static picture a, b;
  static float map[PIXELS];
  even(a, 0, 1, 0);
  even(b, 0, 0, 1);
  assert_near(flip(a, b, map), 1, 1e-4);
  assert_near(flip(a, a, map), 0, 0);
  /* L*, a*, b* of Rec.709's green and blue to two places, as tables of sRGB print them */
  const double green[3] = {87.73, -86.18, 83.18}, blue[3] = {32.30, 79.19, -107.86};
  const double da = 0.01 * (green[0] * green[1] - blue[0] * blue[1]);
  const double db = 0.01 * (green[0] * green[2] - blue[0] * blue[2]);
  const double greatest = pow(green[0] - blue[0] + hypot(da, db), 0.7);
  even(a, 1, 1, 1);
  even(b, 0.184187, 0.184187, 0.184187); /* L* = 50 */
  const double power = pow(50, 0.7);
  double expected = 0.95 / (0.4 * greatest) * power;
  if (power > 0.4 * greatest) expected = 0.95 + (power - 0.4 * greatest) / (0.6 * greatest) * 0.05;
  assert_near(flip(a, b, map), expected, 2e-4);
}

/* What a screen cannot show is not seen, and neither is what is no number. */
TEST(clipping) {
  static picture a, b;
  static float map[PIXELS];
  even(a, 1, 1, 1);
  even(b, 7, 3, 2);
  assert_near(flip(a, b, map), 0, 0);
  even(a, 0, 0, 0);
  even(b, -1, (double)NAN, 0);
  assert_near(flip(a, b, map), 0, 0);
}

/* Smooth colour, noise of a generator, bright spots; the test is shifted by one and dimmer. */
static void paint(picture reference, picture test, double brightest) {
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++)
      for (int c = 0; c < 3; c++) {
        const double wave = 0.5 + 0.45 * sin(0.21 * x + 0.13 * y * (c + 1));
        const double spot = x % 16 == 7 && y % 12 == 5 ? brightest : 1;
        const double other = 0.5 + 0.45 * sin(0.21 * (x + 1) + 0.13 * y * (c + 1));
        reference[y * W + x][c] = (float)(wave * spot);
        test[y * W + x][c] = (float)(0.85 * other * spot);
      }
}

/* Means and exposures of the program of [Andersson2021], version 1.6, for these numbers. */
TEST(published_program) {
  static picture a, b;
  static float map[PIXELS];
  abbe_flip_exposures e;
  paint(a, b, 1);
  assert_near(flip(a, b, map), 0.3877275, 2e-5);
  paint(a, b, 300);
  OK(abbe_flip_hdr_map((const float(*)[3])a, (const float(*)[3])b, W, H, 0, map, &e, &error));
  assert_near(mean_of(map), 0.3350463, 2e-5);
  assert_near(e.first, -6.60921, 1e-4);
  assert_near(e.last, 2.07671, 1e-4);
  assert_int_equal(e.count, 9);
}

TEST(refused) {
  static picture a;
  static float map[PIXELS];
  abbe_flip_exposures e;
  const float(*p)[3] = (const float(*)[3])a;
  assert_int_equal(abbe_flip_map(p, p, 0, 4, 0, map, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_flip_map(p, p, 4, 4, -3, map, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_flip_map(p, p, 4, 4, 1e6, map, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_flip_map(p, p, 4, 4, (double)NAN, map, NULL), ABBE_INVALID_ARGUMENT);
  /* black, and a lone lit pixel, have exposures all the same */
  OK(abbe_flip_hdr_map(p, p, W, H, 0, map, &e, &error));
  assert_int_equal(e.count, 2);
  a[5][1] = 1e20f;
  a[9][1] = a[12][1] = 1e-20f;
  OK(abbe_flip_hdr_map(p, p, W, H, 0, map, &e, &error));
  assert_int_equal(e.count, 32);
  assert_near(mean_of(map), 0, 0);
}
