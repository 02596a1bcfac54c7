/* No folder is too full to be seen at a glance, and no source too long to be read at a sitting. */
#include "tests/check.h"
#include "tests/house/sources.h"

enum { MOST_FILES = 28, MOST_LINES = 500 };

/* Folders of data, which nobody reads from end to end. */
static const char *const data_folders[] = {"tests/bad", NULL};

static bool is_among(const char *name, const char *const *list) {
  for (size_t i = 0; list[i] != NULL; i++)
    if (strcmp(list[i], name) == 0) return true;
  return false;
}

typedef struct sized {
  const char *name;
  size_t size;
} sized;

/* What is above the limit without being an exception, and each exception that is not above it. */
static size_t judge(const sized *list, size_t count, size_t most, const char *unit,
                    const char *const *exceptions) {
  size_t wrong = 0;
  for (size_t i = 0; i < count; i++) {
    if (list[i].size <= most || is_among(list[i].name, exceptions)) continue;
    print_error("%s has %zu %s; at most %zu are allowed\n", list[i].name, list[i].size, unit, most);
    wrong++;
  }
  for (size_t k = 0; exceptions[k] != NULL; k++) {
    bool needed = false;
    for (size_t i = 0; i < count; i++)
      needed = needed || (list[i].size > most && strcmp(list[i].name, exceptions[k]) == 0);
    if (needed) continue;
    print_error("the exception '%s' is not needed any more; take it out\n", exceptions[k]);
    wrong++;
  }
  return wrong;
}

TEST(sources_can_be_read) {
  static sized list[4096];
  size_t count = 0;
  FILLED(sources, all, sources_read(&all));
  for (size_t i = 0; i < all.count && count < 4096; i++)
    if (all.file[i].is_source) list[count++] = (sized){all.file[i].path, all.file[i].lines};
  assert_true(count > 500 && count < 4096);
  static const char *const no_exceptions[] = {NULL};
  const size_t wrong = judge(list, count, MOST_LINES, "lines", no_exceptions);
  assert_int_equal(wrong, 0);
}

TEST(folders_can_be_seen) {
  static char name[512][SOURCES_MAX_PATH];
  static sized list[512];
  size_t count = 0;
  FILLED(sources, all, sources_read(&all));
  for (size_t i = 0; i < all.count; i++) {
    char folder[SOURCES_MAX_PATH];
    size_t at = 0;
    sources_folder(all.file[i].path, folder);
    while (at < count && strcmp(name[at], folder) != 0) at++;
    assert_true(at < 512);
    if (at == count) {
      strcpy(name[at], folder);
      list[count++] = (sized){name[at], 0};
    }
    list[at].size++;
  }
  assert_true(count > 50);
  assert_int_equal(judge(list, count, MOST_FILES, "files", data_folders), 0);
}

TEST(the_judge_sees_both_ends) {
  static const char *const none[] = {NULL}, *const b[] = {"b", NULL}, *const a[] = {"a", NULL};
  const sized list[] = {{"a", 10}, {"b", 11}};
  assert_int_equal(judge(list, 2, 11, "lines", none), 0);
  assert_int_equal(judge(list, 2, 10, "lines", b), 0);
  print_message("the next lines are of sizes made wrong on purpose\n");
  assert_int_equal(judge(list, 2, 10, "lines", none), 1);
  assert_int_equal(judge(list, 2, 10, "lines", a), 2);
  assert_int_equal(judge(list, 2, 11, "lines", b), 1);
}
