#include "tests/check.h"

#include "scenes/environment/environment.h"

/* The share of each entry, from the table itself. */
static void check_shares(const double *weight, size_t count) {
  double share[64] = {0}, sum = 0;
  MADE(abbe_alias_table, table, abbe_alias_table_make(weight, count, &table, &error));
  for (size_t i = 0; i < count; i++) {
    sum += weight[i];
    share[i] += table.keep[i];
    assert_true(table.keep[i] >= 0 && table.keep[i] <= 1);
    if (table.keep[i] < 1) share[table.other[i]] += 1 - table.keep[i];
  }
  for (size_t i = 0; i < count; i++) {
    assert_near(share[i] / (double)count, weight[i] / sum, 1e-15);
    if (weight[i] == 0) assert_true(share[i] == 0);
  }
}

TEST(shares_are_the_weights) {
  double weight[64];
  check_shares((const double[]){3}, 1);
  check_shares((const double[]){1, 1}, 2);
  check_shares((const double[]){1, 2, 3, 4}, 4);
  check_shares((const double[]){0, 0, 1e-20, 0}, 4);
  check_shares((const double[]){0.1, 0, 0.2, 0.7, 0, 1e9, 3}, 7);
  for (size_t n = 1; n <= 64; n++) {
    for (size_t i = 0; i < n; i++)
      weight[i] = i % 3 == 0 ? 0.1 * (double)(i * i % 17) + 0.1 : i % 5 ? 0 : 0.3;
    check_shares(weight, n);
  }
}

TEST(draws) {
  const double weight[] = {0, 5, 0, 1, 2};
  size_t hits[5] = {0};
  abbe_alias_table table;
  OK(abbe_alias_table_make(weight, 5, &table, &error));
  for (int i = 0; i < 80000; i++) hits[abbe_alias_table_draw(&table, (i + 0.5) / 80000)]++;
  for (int i = 0; i < 5; i++) assert_near((double)hits[i], weight[i] * 10000, 3);
  assert_true(weight[abbe_alias_table_draw(&table, 1 - 0x1p-53)] > 0);
  abbe_alias_table_free(&table);
  abbe_alias_table_free(NULL);
}

TEST(what_is_refused) {
  static const double bad[][2] = {{0, 0},        {-1, 2},        {NAN, 1},
                                  {INFINITY, 1}, {1e308, 1e308}, {0, 1e-320}};
  abbe_alias_table table;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, "weights want to be finite, at least",
            abbe_alias_table_make(bad[i], 2, &table, &error));
    assert_null(table.keep);
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "weights want to be finite, at least",
          abbe_alias_table_make(bad[0], 0, &table, &error));
}
