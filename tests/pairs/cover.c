#include "tests/pairs/cover.h"

#include <string.h>

/* Whether a pair of levels is held: [factor][level][later factor][level]. */
typedef bool pair_set[COVER_FACTORS][COVER_LEVELS][COVER_FACTORS][COVER_LEVELS];

/* Adds a row's pairs; how many of them are new. */
static size_t add(pair_set held, const cover_row *row) {
  size_t added = 0;
  for (size_t a = 0; a < COVER_FACTORS; a++)
    for (size_t b = a + 1; b < COVER_FACTORS; b++) {
      bool *is = &held[a][row->level[a]][b][row->level[b]];
      added += !*is;
      *is = true;
    }
  return added;
}

static size_t new_in(pair_set held, const cover_row *row) {
  size_t count = 0;
  for (size_t a = 0; a < COVER_FACTORS; a++)
    for (size_t b = a + 1; b < COVER_FACTORS; b++)
      count += !held[a][row->level[a]][b][row->level[b]];
  return count;
}

/* The next combination in order; false after the last. */
static bool advance(const size_t levels[COVER_FACTORS], cover_row *row) {
  for (size_t i = COVER_FACTORS; i-- > 0; row->level[i] = 0)
    if (++row->level[i] < levels[i]) return true;
  return false;
}

size_t cover_make(const size_t levels[COVER_FACTORS], cover_can can, cover_row out[COVER_MOST]) {
  pair_set held;
  memset(held, 0, sizeof held);
  for (size_t count = 0; count <= COVER_MOST; count++) {
    cover_row row = {{0}};
    size_t most = 0;
    cover_row best = row;
    do {
      const size_t adds = can(&row) ? new_in(held, &row) : 0;
      if (adds > most) {
        most = adds;
        best = row;
      }
    } while (advance(levels, &row));
    if (most == 0) return count;
    if (count == COVER_MOST) break;
    add(held, &best);
    out[count] = best;
  }
  return 0;
}

void cover_count(const size_t levels[COVER_FACTORS], cover_can can, const cover_row *row,
                 size_t count, size_t *pairs, size_t *missing) {
  pair_set held;
  cover_row any = {{0}};
  memset(held, 0, sizeof held);
  *pairs = *missing = 0;
  for (size_t i = 0; i < count; i++) add(held, &row[i]);
  /* what is still to be added is missing */
  do
    if (can(&any)) *missing += add(held, &any);
  while (advance(levels, &any));
  memset(held, 0, sizeof held);
  any = (cover_row){{0}};
  do
    if (can(&any)) *pairs += add(held, &any);
  while (advance(levels, &any));
}
