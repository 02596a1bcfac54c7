/* cover.h: few combinations of factors' levels that hold every pair of levels: a covering array of
 * strength 2, where some combinations cannot be [Cohen1997].
 *
 * Greedy: the combination that holds most pairs which no earlier one holds comes next, the first of
 * those that hold as many. It knows levels by their numbers alone.
 */
#ifndef ABBE_TESTS_PAIRS_COVER_H
#define ABBE_TESTS_PAIRS_COVER_H

#include <stdbool.h>
#include <stddef.h>

enum { COVER_FACTORS = 4, COVER_MOST = 40, COVER_LEVELS = 8 };

typedef struct cover_row {
  size_t level[COVER_FACTORS];
} cover_row;

typedef bool (*cover_can)(const cover_row *row);

/* Rows in order of what they add; 0 where COVER_MOST do not hold all pairs. levels[]: how many each
 * factor has, at most COVER_LEVELS. */
size_t cover_make(const size_t levels[COVER_FACTORS], cover_can can, cover_row out[COVER_MOST]);

/* How many pairs there are in combinations that can be, and how many of them no row holds. */
void cover_count(const size_t levels[COVER_FACTORS], cover_can can, const cover_row *row,
                 size_t count, size_t *pairs, size_t *missing);

#endif
