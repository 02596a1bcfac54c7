#include "tests/check.h"

#include "tests/random.h"
#include "validation/trace/tracer/accumulator.h"

#include <limits.h>

static abbe_accumulator make(size_t values, size_t threads, double most) {
  abbe_accumulator a;
  OK(abbe_accumulator_make(values, threads, most, &a, &error));
  return a;
}

/* The same numbers, in another order and on other threads: the same result to the last bit. */
TEST(order_and_threads_do_not_matter) {
  enum { COUNT = 5000, VALUES = 3 };
  float x[COUNT];
  uint64_t random = 5;
  for (int i = 0; i < COUNT; i++)
    x[i] = (float)(random_normal(&random) * exp(random_between(&random, -60, 3)));
  double mean[4][VALUES], error[4][VALUES];
  abbe_whole_sum adding[4][3 * VALUES];
  for (int way = 0; way < 4; way++) {
    size_t threads = (size_t)way + 1;
    OWNED(abbe_accumulator, a) = make(VALUES, threads, 1e6);
    for (int pass = 0; pass < 3; pass++) {
      for (int i = 0; i < COUNT; i++) {
        int j = way % 2 ? COUNT - 1 - i : i;
        abbe_accumulator_add(&a, (size_t)(j * 7 + pass) % threads, (size_t)(j % VALUES),
                             x[(j + pass) % COUNT]);
      }
      for (size_t v = 0; v < VALUES; v++)
        adding[way][(size_t)pass * VALUES + v] = abbe_accumulator_adding(&a, v);
      abbe_accumulator_end_pass(&a);
    }
    for (size_t v = 0; v < VALUES; v++) {
      mean[way][v] = abbe_accumulator_mean(&a, v);
      error[way][v] = abbe_accumulator_error(&a, v);
    }
    assert_int_equal(abbe_accumulator_cuts(&a), 0);
  }
  for (int way = 1; way < 4; way++) {
    assert_memory_equal(mean[0], mean[way], sizeof mean[0]);
    assert_memory_equal(error[0], error[way], sizeof error[0]);
    assert_memory_equal(adding[0], adding[way], sizeof adding[0]);
  }
}

/* Passes in another order, and in parts that are added up: the same sums to the last bit. */
TEST(order_of_passes_does_not_matter) {
  enum { PASSES = 40 };
  uint64_t random = 11;
  float x[PASSES];
  for (int i = 0; i < PASSES; i++)
    x[i] = (float)(random_normal(&random) * exp(random_between(&random, -20, 3)));
  abbe_whole_sum sum[3] = {0}, square[3][2] = {{0}};
  for (int way = 0; way < 3; way++) {
    OWNED(abbe_accumulator, a) = make(1, 1, 1e6);
    for (int i = 0; i < PASSES; i++) {
      abbe_accumulator_add(&a, 0, 0, x[way == 0 ? i : way == 1 ? PASSES - 1 - i : 7 * i % PASSES]);
      abbe_accumulator_end_pass(&a);
    }
    sum[way] = a.sum[0];
    memcpy(square[way], a.square, sizeof square[way]);
  }
  assert_true(sum[0] == sum[1] && sum[0] == sum[2] && sum[0] != 0);
  assert_memory_equal(square[0], square[1], sizeof square[0]);
  assert_memory_equal(square[0], square[2], sizeof square[0]);
  assert_true(square[0][1] > 0);
}

/* The largest samples there may be, as many as there may be: no sum overflows. */
TEST(the_largest_sums_fit) {
  const abbe_whole_sum most = (abbe_whole_sum)1 << ABBE_WHOLE_SUM_BITS;
  for (int sign = -1; sign <= 1; sign += 2) {
    abbe_whole_sum sum = sign * most, product[2] = {0};
    abbe_whole_sum_add_product(sign * most, most, product);
    assert_near(abbe_whole_sum_of_products(product), sign * 0x1p208, 0);
    product[0] = product[1] = 0;
    abbe_whole_sum_add_product(sign * (most - 1), most - 1, product);
    assert_near(abbe_whole_sum_of_products(product) * 0x1p-208, sign, 1e-15);
    for (uint64_t passes = 1; passes < ABBE_WHOLE_SUM_MOST_PASSES; passes *= 2) /* by doubling */
      assert_false(__builtin_add_overflow(sum, sum, &sum) ||
                   __builtin_add_overflow(product[0], product[0], &product[0]) ||
                   __builtin_add_overflow(product[1], product[1], &product[1]));
    assert_near(abbe_whole_sum_of_products(product) * 0x1p-228, sign, 1e-15);
  }
  assert_true(abbe_whole_sum_quantise(NAN, 4, 2) == 0);
  assert_true(abbe_whole_sum_quantise(3, 4, 2) == 8 && abbe_whole_sum_quantise(-0.3, 4, 2) == -1);
}

/* (a 2^52 + b)(c 2^52 + d), by hand; a product of less has one digit alone. */
TEST(products_are_exact) {
  const abbe_whole_sum shift = (abbe_whole_sum)1 << 52, x = 5 * shift + 7, y = 11 * shift + 13;
  abbe_whole_sum sum[2] = {0};
  abbe_whole_sum_add_product(x, y, sum);
  assert_true(sum[1] == 55 && sum[0] == (5 * 13 + 7 * 11) * shift + 91);
  abbe_whole_sum_add_product(-x, y, sum);
  assert_true(sum[1] == 0 && sum[0] == 0);
  abbe_whole_sum_add_product(-123456789, -987654321, sum);
  assert_true(sum[1] == 0 && sum[0] == (abbe_whole_sum)123456789 * 987654321);
}

/* Beside sums of a billion billion times as much, what is dim is there, to its last bits. */
TEST(bright_light_takes_no_dim_light_away) {
  enum { PASSES = 8 };
  for (int brightness = 0; brightness <= 60; brightness += 5) {
    OWNED(abbe_accumulator, a) = make(2, 2, ldexp(1, brightness) * 0x1p28);
    for (int pass = 0; pass < PASSES; pass++) {
      for (int i = 0; i < 1000; i++)
        abbe_accumulator_add(&a, (size_t)(i % 2), 0, (pass % 2 ? 0.9f : 1.1f) * 1e-3f);
      abbe_accumulator_add(&a, 0, 1, ldexpf(1, brightness));
      abbe_accumulator_end_pass(&a);
    }
    const double slack = 1e-6 + ldexp(1e3, brightness - 65);
    assert_near(abbe_accumulator_mean(&a, 0), 1, slack);
    assert_near(abbe_accumulator_error(&a, 0), 0.1 / sqrt(PASSES - 1), slack);
    assert_near(abbe_accumulator_mean(&a, 1), ldexp(1, brightness), 0);
  }
}

/* As many small additions as a finer sum does not hold go on in the coarser one. */
TEST(sums_are_carried) {
  const float x = 0x1.fffffep-38f; /* just below what the coarser unit takes of 1 */
  for (int sign = -1; sign <= 1; sign += 2) {
    OWNED(abbe_accumulator, a) = make(1, 1, 1);
    assert_true((double)x < a.coarse);
    for (int i = 0; i < 5000; i++) abbe_accumulator_add(&a, 0, 0, (float)sign * x);
    assert_true(a.adding[1][0][0] != 0);
    abbe_accumulator_end_pass(&a);
    assert_true(abbe_accumulator_mean(&a, 0) == sign * 5000 * (double)x);
    assert_int_equal(abbe_accumulator_cuts(&a), 0);
  }
}

/* What is far below the range has its standard error too: no bit of a square is dropped. */
TEST(dim_values_have_an_error) {
  OWNED(abbe_accumulator, a) = make(2, 1, 0x1p93); /* units of 1 */
  for (int pass = 0; pass < 4; pass++) {
    abbe_accumulator_add(&a, 0, 0, pass % 2 ? 300 : 100);
    abbe_accumulator_add(&a, 0, 1, pass % 2 ? -1301 : -1300);
    abbe_accumulator_end_pass(&a);
  }
  assert_near(abbe_accumulator_mean(&a, 0), 200, 0);
  assert_near(abbe_accumulator_error(&a, 0), 100 / sqrt(3), 1e-9);
  assert_near(abbe_accumulator_mean(&a, 1), -1300.5, 0);
  assert_near(abbe_accumulator_error(&a, 1), 0.5 / sqrt(3), 1e-6);
}

/* Passes of 1, 2, 3, 4: mean 2.5, standard error sqrt(5/3 / 4). */
TEST(mean_and_standard_error) {
  OWNED(abbe_accumulator, a) = make(2, 2, 1e6);
  assert_true(abbe_accumulator_mean(&a, 0) == 0);
  assert_true(isinf(abbe_accumulator_error(&a, 0)));
  for (int pass = 1; pass <= 4; pass++) {
    /* half of it by each thread */
    abbe_accumulator_add(&a, 0, 0, (float)(0.5 * pass));
    abbe_accumulator_add(&a, 1, 0, (float)(0.5 * pass));
    abbe_accumulator_add(&a, 1, 1, -1.5f);
    abbe_accumulator_end_pass(&a);
    if (pass == 1) assert_true(isinf(abbe_accumulator_error(&a, 0)));
  }
  assert_int_equal(a.passes, 4);
  assert_near(abbe_accumulator_mean(&a, 0), 2.5, 1e-9);
  assert_near(abbe_accumulator_error(&a, 0), sqrt(5.0 / 3 / 4), 1e-9);
  assert_near(abbe_accumulator_mean(&a, 1), -1.5, 1e-9);
  /* the same in every pass: no error, up to the rounding of squares */
  assert_near(abbe_accumulator_error(&a, 1), 0, 1e-7);
}

/* The error of the mean of n normal numbers of variance 1 is 1 / sqrt(n), known itself to a share
 * of 1 / sqrt(2 n); over 400 values to a twentieth of that. */
TEST(the_error_is_the_spread_of_the_mean) {
  enum { VALUES = 400, PASSES = 50 };
  OWNED(abbe_accumulator, a) = make(VALUES, 1, 1e6);
  uint64_t random = 11;
  for (int pass = 0; pass < PASSES; pass++) {
    for (size_t v = 0; v < VALUES; v++)
      abbe_accumulator_add(&a, 0, v, (float)(10 + random_normal(&random)));
    abbe_accumulator_end_pass(&a);
  }
  double told = 0, true_square = 0;
  for (size_t v = 0; v < VALUES; v++) {
    told += pow(abbe_accumulator_error(&a, v), 2) / VALUES;
    true_square += pow(abbe_accumulator_mean(&a, v) - 10, 2) / VALUES;
  }
  assert_near(told * PASSES, 1, 4 * sqrt(2.0 / PASSES / VALUES));
  assert_near(true_square * PASSES, 1, 4 * sqrt(2.0 / VALUES));
}

TEST(a_dropped_pass_leaves_nothing) {
  OWNED(abbe_accumulator, a) = make(1, 2, 1e6);
  abbe_accumulator_add(&a, 0, 0, 1);
  abbe_accumulator_end_pass(&a);
  abbe_accumulator_add(&a, 0, 0, 50);
  abbe_accumulator_add(&a, 1, 0, 50);
  abbe_accumulator_drop_pass(&a);
  abbe_accumulator_add(&a, 1, 0, 3);
  abbe_accumulator_end_pass(&a);
  assert_int_equal(a.passes, 2);
  assert_near(abbe_accumulator_mean(&a, 0), 2, 1e-12);
  assert_near(abbe_accumulator_error(&a, 0), 1, 1e-9);
}

TEST(what_is_too_large_is_cut_and_counted) {
  OWNED(abbe_accumulator, a) = make(3, 2, 1024);
  assert_near(a.limit, 1, 0);
  const float awkward[] = {2, -INFINITY, NAN, 1, -1, 1.0000001f};
  for (int i = 0; i < 6; i++)
    abbe_accumulator_add(&a, (size_t)(i % 2), (size_t)(i / 2), awkward[i]);
  abbe_accumulator_end_pass(&a);
  assert_int_equal(abbe_accumulator_cuts(&a), 4);
  assert_near(abbe_accumulator_mean(&a, 0), 0, 1e-12); /* 1 - 1 */
  assert_near(abbe_accumulator_mean(&a, 1), 1, 1e-12); /* nothing, and 1 whole */
  assert_near(abbe_accumulator_mean(&a, 2), 0, 1e-12);
}

/* More than a pass holds: no overflow, and it is told. */
TEST(a_sum_that_runs_over_is_told) {
  for (int sign = -1; sign <= 1; sign += 2) {
    OWNED(abbe_accumulator, a) = make(1, 3, 1024);
    for (int i = 0; i < 30000; i++) abbe_accumulator_add(&a, (size_t)(i % 3), 0, (float)sign);
    abbe_accumulator_end_pass(&a);
    assert_true(abbe_accumulator_cuts(&a) > 0);
    assert_true(sign * abbe_accumulator_mean(&a, 0) >= 1024);
  }
}

/* Numbers of 2^-50 of what a pass holds still count. */
TEST(small_numbers_are_not_lost) {
  OWNED(abbe_accumulator, a) = make(1, 1, 1);
  for (int i = 0; i < 1000; i++) abbe_accumulator_add(&a, 0, 0, 0x1p-50f);
  abbe_accumulator_add(&a, 0, 0, 0x1p-11f);
  abbe_accumulator_add(&a, 0, 0, -0x1p-11f);
  abbe_accumulator_end_pass(&a);
  assert_near(abbe_accumulator_mean(&a, 0) * 0x1p50, 1000, 1e-9);
}

TEST(what_cannot_be_kept_is_refused) {
  OWNED(abbe_accumulator, a);
  const double most[] = {0, -1, NAN, INFINITY, 1e101, 1e-101};
  for (int i = 0; i < 6; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, "positive", abbe_accumulator_make(1, 1, most[i], &a, &error));
  }
  assert_int_equal(abbe_accumulator_make(0, 1, 1, &a, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_accumulator_make(1, 0, 1, &a, NULL), ABBE_INVALID_ARGUMENT);
  abbe_accumulator_free(NULL);
}
