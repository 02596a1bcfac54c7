#include "scenes/environment/alias_table.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Splits the entries into those below the mean, from the front of the list, and those at or above
 * it, from its end; then fills up each of the first from one of the second. */
static void fill(const double *weight, double mean, size_t heaviest, uint32_t *list,
                 abbe_alias_table *out) {
  const size_t count = out->count;
  double *left = out->keep; /* an entry's share, until it is final */
  size_t low = 0, high = count;
  for (size_t i = 0; i < count; i++) {
    left[i] = weight[i] / mean;
    list[left[i] < 1 ? low++ : --high] = (uint32_t)i;
  }
  while (low > 0 && high < count) {
    const uint32_t small = list[--low], large = list[high];
    out->other[small] = large;
    left[large] -= 1 - left[small];
    if (left[large] < 1) {
      high++;
      list[low++] = large;
    }
  }
  /* what is left would be full but for rounding */
  for (; low > 0; low--) {
    const uint32_t i = list[low - 1];
    out->keep[i] = weight[i] > 0 ? 1 : 0;
    out->other[i] = (uint32_t)heaviest;
  }
  for (; high < count; high++) {
    out->keep[list[high]] = 1;
    out->other[list[high]] = list[high];
  }
}

abbe_result abbe_alias_table_make(const double *weight, size_t count, abbe_alias_table *out,
                                  abbe_error *error) {
  *out = (abbe_alias_table){0};
  double sum = 0;
  size_t heaviest = 0;
  bool fine = count > 0 && count <= UINT32_MAX;
  for (size_t i = 0; i < count && fine; i++) {
    fine = isfinite(weight[i]) && weight[i] >= 0;
    if (weight[i] > weight[heaviest]) heaviest = i;
    sum += weight[i];
  }
  const double mean = fine ? sum / (double)count : 0;
  if (!(mean > 0) || !isfinite(1 / mean) || !isfinite(sum))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "there is nothing to draw from: weights want to be finite, at least 0 "
                          "and not all 0");
  uint32_t *list = malloc(count * sizeof *list);
  abbe_alias_table table = {count, malloc(count * sizeof *table.keep),
                            malloc(count * sizeof *table.other)};
  const bool room = list && table.keep && table.other;
  if (room)
    fill(weight, mean, heaviest, list, &table);
  else
    abbe_alias_table_free(&table);
  free(list);
  if (!room)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a table of %zu entries", count);
  *out = table;
  return ABBE_OK;
}

void abbe_alias_table_free(abbe_alias_table *table) {
  if (table == NULL) return;
  free(table->keep);
  free(table->other);
  *table = (abbe_alias_table){0};
}

size_t abbe_alias_table_draw(const abbe_alias_table *table, double u) {
  const double at = u * (double)table->count;
  size_t i = (size_t)at;
  if (i >= table->count) i = table->count - 1;
  return at - (double)i < table->keep[i] ? i : table->other[i];
}
