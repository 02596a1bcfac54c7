#include "base/nearest.h"

#include <ctype.h>
#include <string.h>

enum { MAX_LENGTH = 127 };

static size_t smaller(size_t a, size_t b) {
  return a < b ? a : b;
}

static int lower(char c) {
  return tolower((unsigned char)c);
}

/* Edit distance in which swapping two neighbours counts once (optimal string alignment). */
static size_t distance(const char *a, size_t a_length, const char *b, size_t b_length) {
  size_t rows[3][MAX_LENGTH + 1];
  size_t *before = rows[0], *above = rows[1], *here = rows[2];
  for (size_t j = 0; j <= b_length; j++) above[j] = before[j] = j;
  for (size_t i = 1; i <= a_length; i++) {
    here[0] = i;
    for (size_t j = 1; j <= b_length; j++) {
      size_t differs = lower(a[i - 1]) != lower(b[j - 1]);
      here[j] = smaller(above[j - 1] + differs, smaller(above[j], here[j - 1]) + 1);
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1]))
        here[j] = smaller(here[j], before[j - 2] + 1);
    }
    size_t *oldest = before;
    before = above;
    above = here;
    here = oldest;
  }
  return above[b_length];
}

const char *abbe_nearest_word(const char *word, const char *const *candidates, size_t count) {
  size_t length = strlen(word), best = (size_t)-1;
  const char *nearest = NULL;
  if (length > MAX_LENGTH) return NULL;
  for (size_t i = 0; i < count; i++) {
    size_t other = strlen(candidates[i]);
    if (other > MAX_LENGTH) continue;
    size_t longer = length > other ? length : other;
    size_t limit = longer / 3 > 2 ? longer / 3 : 2;
    size_t steps = distance(word, length, candidates[i], other);
    /* two slips must leave more than half of a word: 'zip' is no 'rii' */
    if (steps > limit || steps >= longer || steps >= best) continue;
    if (steps > 1 && 2 * steps >= longer) continue;
    best = steps;
    nearest = candidates[i];
  }
  return nearest;
}
