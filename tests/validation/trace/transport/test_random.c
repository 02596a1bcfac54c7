#include "tests/check.h"

#include "validation/trace/transport/random.h"

enum { COUNT = 1 << 17, BINS = 64 };

/* Numbers of one counter that runs from start while the other three stand at 7: which of them runs
 * is `counter`. */
static void numbers_of(int counter, uint32_t start, uint32_t i, float out[4]) {
  uint32_t c[4] = {7, 7, 7, 7};
  c[counter] = start + i;
  abbe_random4(c[0], c[1], c[2], c[3], out);
}

/* Chi-square over the bins has mean BINS - 1 and variance 2 (BINS - 1). It is asked to lie within
 * five standard deviations: by chance one in more than 10^5 does not. */
static void check_chi_square(const double *seen, size_t bins, double count) {
  double chi = 0, expected = count / (double)bins;
  for (size_t b = 0; b < bins; b++) chi += pow(seen[b] - expected, 2) / expected;
  double freedom = (double)bins - 1;
  assert_near(chi, freedom, 5 * sqrt(2 * freedom));
}

TEST(each_number_is_uniform_whichever_counter_runs) {
  static const uint32_t starts[] = {0, 0xfffff000u, 0x61696du};
  for (int counter = 0; counter < 4; counter++)
    for (int s = 0; s < 3; s++) {
      double seen[4][BINS] = {0};
      for (uint32_t i = 0; i < COUNT; i++) {
        float r[4];
        numbers_of(counter, starts[s], i, r);
        for (int k = 0; k < 4; k++) {
          assert_true(r[k] >= 0 && r[k] < 1);
          seen[k][(int)(r[k] * BINS)]++;
        }
      }
      for (int k = 0; k < 4; k++) check_chi_square(seen[k], BINS, COUNT);
    }
}

/* The low bits count as much as the high ones: 24 of them are used. */
TEST(fine_parts_are_uniform) {
  double seen[4][BINS] = {0};
  for (uint32_t i = 0; i < COUNT; i++) {
    float r[4];
    numbers_of(0, 0, i, r);
    for (int k = 0; k < 4; k++) seen[k][(uint32_t)(r[k] * 0x1p24f) % BINS]++;
  }
  for (int k = 0; k < 4; k++) check_chi_square(seen[k], BINS, COUNT);
}

/* Pairs of what neighbours in a counter get, on a grid of 8 by 8: pixels side by side, a path's
 * steps, passes, seeds. */
TEST(neighbours_do_not_know_of_each_other) {
  for (int counter = 0; counter < 4; counter++)
    for (int k = 0; k < 4; k++) {
      double seen[BINS] = {0};
      for (uint32_t i = 0; i < COUNT; i++) {
        float a[4], b[4];
        numbers_of(counter, 0, 2 * i, a);
        numbers_of(counter, 0, 2 * i + 1, b);
        seen[(int)(8 * a[k]) * 8 + (int)(8 * b[k])]++;
      }
      check_chi_square(seen, BINS, COUNT);
    }
}

TEST(the_four_numbers_do_not_know_of_each_other) {
  for (int k = 0; k < 4; k++)
    for (int l = k + 1; l < 4; l++) {
      double seen[BINS] = {0};
      for (uint32_t i = 0; i < COUNT; i++) {
        float r[4];
        numbers_of(0, 0, i, r);
        seen[(int)(8 * r[k]) * 8 + (int)(8 * r[l])]++;
      }
      check_chi_square(seen, BINS, COUNT);
    }
}

/* A grid of pixels and passes, as the eye's paths use them. */
TEST(two_counters_at_once) {
  double seen[BINS] = {0};
  for (uint32_t i = 0; i < COUNT; i++) {
    float r[4];
    abbe_random4(i % 256, i / 256, 1 << 16, 0x657965, r);
    seen[(int)(8 * r[0]) * 8 + (int)(8 * r[1])]++;
  }
  check_chi_square(seen, BINS, COUNT);
}

TEST(the_same_counters_give_the_same_numbers) {
  uint32_t a[4], b[4];
  abbe_random_bits(1, 2, 3, 4, a);
  abbe_random_bits(1, 2, 3, 4, b);
  assert_memory_equal(a, b, sizeof a);
  /* each counter and each of its bits matters */
  for (int counter = 0; counter < 4; counter++)
    for (int bit = 0; bit < 32; bit++) {
      uint32_t c[4] = {1, 2, 3, 4};
      c[counter] ^= (uint32_t)1 << bit;
      abbe_random_bits(c[0], c[1], c[2], c[3], b);
      assert_memory_not_equal(a, b, sizeof a);
    }
}

TEST(numbers_stay_below_one) {
  assert_true(abbe_random_float(0) == 0);
  assert_true(abbe_random_float(0xffffffffu) < 1);
  assert_true(abbe_random_float(0x80000000u) == 0.5f);
  assert_true(abbe_random_double(0, 0x7ff) == 0);
  assert_true(abbe_random_double(0xffffffffu, 0xffffffffu) == 1 - 0x1p-53);
  assert_true(abbe_random_double(0x80000000u, 0x800) == 0.5 + 0x1p-53);
}

/* Parts of the range lie side by side, and the last place of one is below the first of the next. */
TEST(parts_do_not_overlap) {
  for (uint32_t count = 1; count <= 7; count++)
    for (uint32_t i = 0; i < count; i++) {
      const uint32_t first = abbe_random_part(0, i, count);
      const uint32_t last = abbe_random_part(0xffffffffu, i, count);
      const double width = 0x1p32 / count;
      assert_near((double)first, i * width, 1);
      assert_near((double)last, (i + 1) * width, 1);
      if (i + 1 < count) assert_true(last <= abbe_random_part(0, i + 1, count));
      if (i + 1 == count) assert_int_equal(last, 0xffffffffu);
    }
}

/* Drawn from many entries by one number, its fraction decides: of 2^25 entries it is as uniform as
 * of few, also where a lattice is shifted. */
TEST(fractions_of_many_entries_are_uniform) {
  for (int log = 6; log <= 25; log++) {
    double seen[BINS] = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
      uint32_t bits[4];
      abbe_random_bits(i, (uint32_t)log, 7, 7, bits);
      const double at = abbe_random_double((i % 4) * 3785032107u + bits[0], bits[1]) * exp2(log);
      seen[(int)((at - floor(at)) * BINS)]++;
    }
    check_chi_square(seen, BINS, COUNT);
  }
}
