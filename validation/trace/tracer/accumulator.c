#include "validation/trace/tracer/accumulator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bits of the coarser unit's sums up to `most`: sums of up to four such fit. */
enum { ABOVE = 61, APART = ABBE_ACCUMULATOR_APART, WHOLE_FLOAT = 24 };

static int64_t **make_rows(size_t rows, size_t values) {
  int64_t **row = calloc(rows, sizeof *row);
  for (size_t i = 0; row != NULL && i < rows; i++) row[i] = calloc(values, sizeof **row);
  return row;
}

static bool has_rows(int64_t *const *row, size_t rows) {
  for (size_t i = 0; row != NULL && i < rows; i++)
    if (row[i] == NULL) return false;
  return row != NULL;
}

static void free_rows(int64_t **row, size_t rows) {
  for (size_t i = 0; row != NULL && i < rows; i++) free(row[i]);
  free(row);
}

abbe_result abbe_accumulator_make(size_t values, size_t threads, double most, abbe_accumulator *out,
                                  abbe_error *error) {
  *out = (abbe_accumulator){0};
  if (!(most >= 1e-100 && most <= 1e100) || values == 0 || threads == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "sums of up to %g cannot be kept: that is not a positive number from "
                          "1e-100 to 1e100",
                          most);
  most = exp2(ceil(log2(most)));
  abbe_accumulator a = {.values = values,
                        .threads = threads,
                        .unit = ldexp(most, -ABOVE - APART),
                        .per_unit = {ldexp(1 / most, ABOVE + APART), ldexp(1 / most, ABOVE)},
                        .coarse = ldexp(most, WHOLE_FLOAT - ABOVE),
                        .limit = most / 1024};
  for (int k = 0; k < 2; k++) a.adding[k] = make_rows(threads, values);
  a.cut = calloc(threads, sizeof *a.cut);
  a.sum = calloc(values, sizeof *a.sum);
  a.square = calloc(values, 2 * sizeof *a.square);
  *out = a;
  if (has_rows(a.adding[0], threads) && has_rows(a.adding[1], threads) && a.cut != NULL &&
      a.sum != NULL && a.square != NULL)
    return ABBE_OK;
  abbe_accumulator_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY,
                        "no memory for sums of %zu values on %zu threads: ask for fewer pixels, "
                        "bands or threads",
                        values, threads);
}

void abbe_accumulator_free(abbe_accumulator *a) {
  if (a == NULL) return;
  for (int k = 0; k < 2; k++) free_rows(a->adding[k], a->threads);
  free(a->cut);
  free(a->sum);
  free(a->square);
  *a = (abbe_accumulator){0};
}

void abbe_accumulator_carry(abbe_accumulator *a, size_t thread, size_t value, bool coarse,
                            int64_t more) {
  int64_t *sum = &a->adding[1][thread][value];
  if (!coarse) {
    int64_t *fine = &a->adding[0][thread][value];
    const abbe_whole_sum all = (abbe_whole_sum)*fine + more;
    more = (int64_t)(all >> APART);
    *fine = (int64_t)(all & (((int64_t)1 << APART) - 1));
  }
  if (!__builtin_add_overflow(*sum, more, sum)) return;
  a->cut[thread]++;
  *sum = more > 0 ? INT64_MAX : INT64_MIN;
}

abbe_whole_sum abbe_accumulator_adding(const abbe_accumulator *a, size_t value) {
  abbe_whole_sum whole = 0;
  for (size_t t = 0; t < a->threads; t++)
    whole += a->adding[1][t][value] * ((abbe_whole_sum)1 << APART) + a->adding[0][t][value];
  return whole;
}

/* The value's sum of all threads, which is 0 from now on. */
static abbe_whole_sum take_value(abbe_accumulator *a, size_t value) {
  const abbe_whole_sum whole = abbe_accumulator_adding(a, value);
  for (size_t t = 0; t < a->threads && whole != 0; t++)
    a->adding[0][t][value] = a->adding[1][t][value] = 0;
  return whole;
}

void abbe_accumulator_end_pass(abbe_accumulator *a) {
#pragma omp parallel for num_threads((int)a->threads)
  for (size_t i = 0; i < a->values; i++) {
    const abbe_whole_sum whole = take_value(a, i);
    if (whole == 0) continue;
    a->sum[i] += whole;
    abbe_whole_sum_add_product(whole, whole, &a->square[2 * i]);
  }
  a->passes++;
}

void abbe_accumulator_drop_pass(abbe_accumulator *a) {
#pragma omp parallel for num_threads((int)a->threads)
  for (size_t t = 0; t < a->threads; t++)
    for (int k = 0; k < 2; k++) memset(a->adding[k][t], 0, a->values * sizeof **a->adding[k]);
}

double abbe_accumulator_mean(const abbe_accumulator *a, size_t value) {
  return a->passes > 0 ? (double)a->sum[value] * a->unit / (double)a->passes : 0;
}

double abbe_accumulator_error(const abbe_accumulator *a, size_t value) {
  if (a->passes < 2) return INFINITY;
  const double n = (double)a->passes, mean = (double)a->sum[value] / n;
  const double square = abbe_whole_sum_of_products(&a->square[2 * value]) / n;
  const double variance = (square - mean * mean) * n / (n - 1);
  return variance > 0 ? a->unit * sqrt(variance / n) : 0;
}

uint64_t abbe_accumulator_cuts(const abbe_accumulator *a) {
  uint64_t cuts = 0;
  for (size_t t = 0; t < a->threads; t++) cuts += a->cut[t];
  return cuts;
}
