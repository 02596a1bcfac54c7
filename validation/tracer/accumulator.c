#include "validation/tracer/accumulator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* 2^61: sums of up to four such fit. */
static const double range = 2305843009213693952.0;

abbe_result abbe_accumulator_make(size_t values, size_t threads, double most, abbe_accumulator *out,
                                  abbe_error *error) {
  ABBE_REQUIRE(out, error);
  *out = (abbe_accumulator){0};
  if (!(most > 0 && isfinite(most)) || values == 0 || threads == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "sums of up to %g cannot be kept: that is not a positive number", most);
  abbe_accumulator a = {.values = values,
                        .threads = threads,
                        .unit = most / range,
                        .per_unit = range / most,
                        .limit = most / 1024};
  a.adding = calloc(threads, sizeof *a.adding);
  a.cut = calloc(threads, sizeof *a.cut);
  a.sum = calloc(values, sizeof *a.sum);
  a.square = calloc(values, sizeof *a.square);
  bool complete = a.adding != NULL && a.cut != NULL && a.sum != NULL && a.square != NULL;
  for (size_t t = 0; t < threads && complete; t++) {
    a.adding[t] = calloc(values, sizeof *a.adding[t]);
    complete = a.adding[t] != NULL;
  }
  *out = a;
  if (complete) return ABBE_OK;
  abbe_accumulator_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY,
                        "no memory for sums of %zu values on %zu threads: ask for fewer pixels, "
                        "bands or threads",
                        values, threads);
}

void abbe_accumulator_free(abbe_accumulator *a) {
  if (a == NULL) return;
  for (size_t t = 0; a->adding != NULL && t < a->threads; t++) free(a->adding[t]);
  free(a->adding);
  free(a->cut);
  free(a->sum);
  free(a->square);
  *a = (abbe_accumulator){0};
}

/* The value's sum of all threads, which is 0 from now on. */
static int64_t take_value(abbe_accumulator *a, size_t value) {
  int64_t whole = 0;
  for (size_t t = 0; t < a->threads; t++) {
    const int64_t more = a->adding[t][value];
    if (more == 0) continue;
    a->adding[t][value] = 0;
    if (!__builtin_add_overflow(whole, more, &whole)) continue;
#pragma omp atomic
    a->cut[t]++;
    whole = more > 0 ? INT64_MAX : INT64_MIN;
  }
  return whole;
}

void abbe_accumulator_end_pass(abbe_accumulator *a) {
#pragma omp parallel for num_threads((int)a->threads)
  for (size_t i = 0; i < a->values; i++) {
    const int64_t whole = take_value(a, i);
    if (whole != 0) abbe_whole_sum_add_sample(whole, &a->sum[i], &a->square[i]);
  }
  a->passes++;
}

int64_t abbe_accumulator_adding(const abbe_accumulator *a, size_t value) {
  int64_t whole = 0;
  for (size_t t = 0; t < a->threads; t++) {
    const int64_t more = a->adding[t][value];
    if (__builtin_add_overflow(whole, more, &whole)) whole = more > 0 ? INT64_MAX : INT64_MIN;
  }
  return whole;
}

void abbe_accumulator_drop_pass(abbe_accumulator *a) {
#pragma omp parallel for num_threads((int)a->threads)
  for (size_t t = 0; t < a->threads; t++) memset(a->adding[t], 0, a->values * sizeof **a->adding);
}

double abbe_accumulator_mean(const abbe_accumulator *a, size_t value) {
  return a->passes > 0 ? abbe_whole_sum_of_values(a->sum[value]) * a->unit / (double)a->passes : 0;
}

double abbe_accumulator_error(const abbe_accumulator *a, size_t value) {
  if (a->passes < 2) return INFINITY;
  const double n = (double)a->passes, mean = abbe_whole_sum_of_values(a->sum[value]) / n;
  const double square = abbe_whole_sum_of_squares(a->sum[value], a->square[value]) / n;
  const double variance = (square - mean * mean) * n / (n - 1);
  return variance > 0 ? a->unit * sqrt(variance / n) : 0;
}

uint64_t abbe_accumulator_cuts(const abbe_accumulator *a) {
  uint64_t cuts = 0;
  for (size_t t = 0; t < a->threads; t++) cuts += a->cut[t];
  return cuts;
}
