#include "base/text_diff.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CONTEXT = 3, MAX_CELLS = 4 << 20 };

typedef struct line {
  const char *text;
  size_t size;  /* with its newline, where it has one */
  bool changed; /* not in the other text */
} line;

typedef struct lines {
  line *at;
  size_t count;
} lines;

static bool split(const char *text, size_t size, lines *out) {
  size_t count = 0;
  for (size_t i = 0; i < size; i++) count += text[i] == '\n' || i + 1 == size;
  *out = (lines){calloc(count + 1, sizeof(line)), 0};
  if (out->at == NULL) return false;
  for (size_t i = 0; i < size;) {
    const char *end = memchr(text + i, '\n', size - i);
    size_t length = end == NULL ? size - i : (size_t)(end - text) - i + 1;
    out->at[out->count++] = (line){text + i, length, false};
    i += length;
  }
  return true;
}

static bool same(const line *a, const line *b) {
  return a->size == b->size && memcmp(a->text, b->text, a->size) == 0;
}

static void change_all(line *at, size_t count) {
  for (size_t i = 0; i < count; i++) at[i].changed = true;
}

/* Finds what is in only one of a[n] and b[m]: cell (i, j) holds the length of the longest common
 * sequence of the lines from i and j on. */
static void mark(line *a, size_t n, line *b, size_t m) {
  uint32_t *cell = n > 0 && m > 0 && n < MAX_CELLS && m < MAX_CELLS && (n + 1) * (m + 1) < MAX_CELLS
                       ? calloc((n + 1) * (m + 1), sizeof *cell)
                       : NULL;
  if (cell == NULL) {
    change_all(a, n);
    change_all(b, m);
    return;
  }
  for (size_t i = n; i-- > 0;)
    for (size_t j = m; j-- > 0;) {
      uint32_t down = cell[(i + 1) * (m + 1) + j], right = cell[i * (m + 1) + j + 1];
      cell[i * (m + 1) + j] = same(&a[i], &b[j]) ? cell[(i + 1) * (m + 1) + j + 1] + 1
                              : down > right     ? down
                                                 : right;
    }
  size_t i = 0, j = 0;
  while (i < n || j < m) {
    if (i < n && j < m && same(&a[i], &b[j]))
      i++, j++;
    else if (j == m || (i < n && cell[(i + 1) * (m + 1) + j] >= cell[i * (m + 1) + j + 1]))
      a[i++].changed = true;
    else
      b[j++].changed = true;
  }
  free(cell);
}

static void compare(lines a, lines b) {
  size_t head = 0, tail = 0;
  while (head < a.count && head < b.count && same(&a.at[head], &b.at[head])) head++;
  while (tail < a.count - head && tail < b.count - head &&
         same(&a.at[a.count - 1 - tail], &b.at[b.count - 1 - tail]))
    tail++;
  mark(a.at + head, a.count - head - tail, b.at + head, b.count - head - tail);
}

static void print_line(FILE *out, char sign, const line *l) {
  fputc(sign, out);
  fwrite(l->text, 1, l->size, out);
  if (l->text[l->size - 1] != '\n') fputs("\n\\ No newline at end of file\n", out);
}

/* Goes through both texts once, from a[*i] and b[*j] to the end of a hunk; out NULL only counts. */
static void walk(lines a, lines b, size_t *i, size_t *j, FILE *out) {
  size_t after = 0; /* unchanged lines since the last change */
  while (*i < a.count || *j < b.count) {
    if (*i < a.count && a.at[*i].changed) {
      if (out != NULL) print_line(out, '-', &a.at[*i]);
      ++*i;
      after = 0;
    } else if (*j < b.count && b.at[*j].changed) {
      if (out != NULL) print_line(out, '+', &b.at[*j]);
      ++*j;
      after = 0;
    } else {
      size_t ahead = 0; /* unchanged lines until the next change, or more than any hunk bridges */
      while (ahead <= 2 * CONTEXT && *i + ahead < a.count && *j + ahead < b.count &&
             !a.at[*i + ahead].changed && !b.at[*j + ahead].changed)
        ahead++;
      bool more = *i + ahead < a.count || *j + ahead < b.count;
      if (after >= CONTEXT && (!more || after + ahead > 2 * CONTEXT)) return;
      if (out != NULL) print_line(out, ' ', &a.at[*i]);
      ++*i;
      ++*j;
      after++;
    }
  }
}

static void print_range(FILE *out, char sign, size_t from, size_t to) {
  size_t count = to - from;
  fprintf(out, " %c%zu", sign, count == 0 ? from : from + 1);
  if (count != 1) fprintf(out, ",%zu", count);
}

static void print_hunks(FILE *out, lines a, lines b) {
  for (size_t i = 0, j = 0;;) {
    while (i < a.count && j < b.count && !a.at[i].changed && !b.at[j].changed) i++, j++;
    if (i == a.count && j == b.count) return;
    size_t back = i < CONTEXT ? i : CONTEXT;
    size_t from_i = i - back, from_j = j - back;
    walk(a, b, &i, &j, NULL);
    fputs("@@", out);
    print_range(out, '-', from_i, i);
    print_range(out, '+', from_j, j);
    fputs(" @@\n", out);
    for (size_t k = 0; k < back; k++) print_line(out, ' ', &a.at[from_i + k]);
    i = from_i + back;
    j = from_j + back;
    walk(a, b, &i, &j, out);
  }
}

abbe_result abbe_text_diff(const char *before, size_t before_size, const char *after,
                           size_t after_size, const char *path, char **out, abbe_error *error) {
  *out = NULL;
  lines a = {0}, b = {0};
  size_t size = 0;
  FILE *stream = open_memstream(out, &size);
  bool good = stream != NULL && split(before, before_size, &a) && split(after, after_size, &b);
  if (good &&
      (before_size != after_size || (before_size > 0 && memcmp(before, after, before_size) != 0))) {
    compare(a, b);
    fprintf(stream, "--- %s\n+++ %s\n", path, path);
    print_hunks(stream, a, b);
  }
  good = good && !ferror(stream);
  if (stream != NULL) good = fclose(stream) == 0 && good;
  free(a.at);
  free(b.at);
  if (good) return ABBE_OK;
  free(*out);
  *out = NULL;
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to compare it", path);
}
