/* A header stands alone: either its own source reads it before all else, or this program's build
 * compiled a file that includes nothing but it. */
#include "tests/check.h"
#include "tests/house/sources.h"

#define ROOMS "base spectral colorimetry scenes gl validation library"

enum { MOST_ALONE = 512 };

typedef struct headers {
  size_t count;
  char name[MOST_ALONE][SOURCES_MAX_PATH];
} headers;

static void read_alone(headers *out) {
  FILE *file = fopen(ABBE_ALONE_LIST, "r");
  assert_non_null(file);
  out->count = 0;
  while (out->count < MOST_ALONE && fscanf(file, " %1023[^\n]", out->name[out->count]) == 1)
    out->count++;
  fclose(file);
  assert_true(out->count < MOST_ALONE);
}

static bool is_alone(const headers *alone, const char *name) {
  for (size_t i = 0; i < alone->count; i++)
    if (strcmp(alone->name[i], name) == 0) return true;
  return false;
}

static bool is_directive(const char *line) {
  return line[strspn(line, " \t")] == '#';
}

/* Whether the first directive of a source includes this header. No source: it does not. */
static bool is_read_first(const char *source, const char *header) {
  char line[4096] = "", name[SOURCES_MAX_PATH];
  FILE *file = fopen(source, "r");
  if (file == NULL) return false;
  while (!is_directive(line) && fgets(line, sizeof line, file) != NULL) continue;
  fclose(file);
  return sources_included_name(line, name, sizeof name) && strcmp(name, header) == 0;
}

static bool own_source_reads_it_first(const char *header) {
  char source[2 * SOURCES_MAX_PATH];
  snprintf(source, sizeof source, ABBE_SOURCE_DIR "/%.*sc", (int)strlen(header) - 1, header);
  return is_read_first(source, header);
}

TEST(every_header_stands_alone) {
  static headers alone;
  size_t read = 0, wrong = 0;
  read_alone(&alone);
  FILLED(sources, all, sources_read(&all));
  for (size_t i = 0; i < all.count; i++) {
    const char *path = all.file[i].path;
    if (strcmp(sources_ending(path), "h") != 0 || !sources_has_word(ROOMS, sources_room(path)))
      continue;
    read++;
    if (is_alone(&alone, path) || own_source_reads_it_first(path)) continue;
    wrong++;
    print_error("%s: its source has to include it first; then configure the build again\n", path);
  }
  assert_int_equal(wrong, 0);
  assert_true(read > 200);
  assert_true(alone.count < read / 4);
}

TEST(what_comes_first_is_seen) {
  assert_true(is_read_first(ABBE_SOURCE_DIR "/gl/plan/plan.c", "gl/plan/plan.h"));
  assert_false(is_read_first(ABBE_SOURCE_DIR "/gl/plan/plan.c", "gl/plan/examine/examine.h"));
  assert_false(is_read_first(ABBE_SOURCE_DIR "/base/clock.c", "base/clock.h")); /* a #define */
  assert_false(is_read_first(ABBE_SOURCE_DIR "/base/order.c", "base/maths.h")); /* no file */
}
