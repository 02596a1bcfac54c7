/* operations.h: runs an operation once for each of its allocations, and lets that one fail.
 *
 * An operation does one thing from its inputs to freed outputs and hands back its result. Whatever
 * fails, it must hand back ABBE_NO_MEMORY with a sentence, or the very output that it gives when
 * nothing fails; leave no temporary file; and under the sanitizers neither leak nor crash. With
 * ABBE_FAULTS_ALL in the environment every allocation is tried, also where the tests try a share.
 */
#ifndef ABBE_TESTS_FAULTS_OPERATIONS_H
#define ABBE_TESTS_FAULTS_OPERATIONS_H

#include "tests/check.h"
#include "tests/faults/memory.h"

#include "base/error.h"

#include <dirent.h>
#include <unistd.h>

/* What an operation put out, as a number; 0 in the beginning. */
static uint64_t operation_digest;

static inline void digest(const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) operation_digest = (operation_digest ^ p[i]) * 1099511628211u;
}

static inline void digest_text(const char *text) {
  if (text != NULL) digest(text, strlen(text));
}

typedef struct operation {
  const char *name;
  abbe_result (*run)(abbe_error *error);
  size_t most; /* allocations that are tried, spread over all; 0: all */
} operation;

static char operation_folder[64];

static inline void operation_setup(void) {
  snprintf(operation_folder, sizeof operation_folder, "/tmp/abbe-test-faults-XXXXXX");
  assert_non_null(mkdtemp(operation_folder));
}

static inline const char *operation_path(const char *name) {
  static char path[4][400];
  static int turn;
  char *mine = path[turn++ % 4];
  snprintf(mine, sizeof path[0], "%s/%s", operation_folder, name);
  return mine;
}

/* Entries of the folder that are temporary files. */
static inline size_t operation_left(void) {
  size_t count = 0;
  DIR *dir = opendir(operation_folder);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;)
    count += strncmp(entry->d_name, ".abbe-", 6) == 0;
  closedir(dir);
  return count;
}

static inline void operation_teardown(void) {
  DIR *dir = opendir(operation_folder);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;)
    if (entry->d_name[0] != '.') unlink(operation_path(entry->d_name));
  closedir(dir);
  assert_false(rmdir(operation_folder));
}

static inline bool operation_holds(const operation *o, size_t n, bool all, uint64_t whole) {
  abbe_error error = {0};
  operation_digest = 0;
  faults_memory_begin(n, all);
  const abbe_result result = o->run(&error);
  faults_memory_end();
  const char *wrong = NULL;
  if (result == ABBE_OK && operation_digest != whole) wrong = "it goes on with another output";
  if (result != ABBE_OK && faults_memory_failed() == 0) wrong = "it fails for nothing";
  if (result != ABBE_OK && result != ABBE_NO_MEMORY &&
      !(result == ABBE_IO && strstr(error.text, "Cannot allocate memory") != NULL))
    wrong = "its result is not ABBE_NO_MEMORY";
  if (result != ABBE_OK && error.text[0] == '\0') wrong = "it fails without a sentence";
  if (operation_left() > 0) wrong = "it leaves a temporary file";
  if (wrong == NULL) return true;
  print_error("%s, allocation %zu%s (%s): %s: %s: %s\n", o->name, n, all ? " and all after it" : "",
              faults_memory_what(), wrong, abbe_result_text(result), error.text);
  return false;
}

static inline size_t operation_check(const operation *o) {
  abbe_error error = {0};
  operation_digest = 0;
  faults_memory_begin(0, false);
  const abbe_result result = o->run(&error);
  const size_t count = faults_memory_end();
  if (result != ABBE_OK) {
    print_error("%s: %s\n", o->name, error.text);
    return 1;
  }
  const uint64_t whole = operation_digest;
  const bool share = o->most > 0 && o->most < count && getenv("ABBE_FAULTS_ALL") == NULL;
  const size_t tried = share ? o->most : count;
  size_t wrong = 0;
  for (size_t k = 0; k < tried && wrong < 5; k++) {
    const size_t n = 1 + k * count / tried;
    wrong += !operation_holds(o, n, false, whole);
    wrong += !operation_holds(o, n, true, whole);
  }
  if (wrong == 0 && getenv("ABBE_FAULTS_ALL") != NULL)
    printf("%-28s %6zu allocations, %zu tried\n", o->name, count, tried);
  assert_true(count > 0);
  return wrong;
}

static inline void operation_check_all(const operation *list, size_t count) {
  size_t wrong = 0;
  for (size_t i = 0; i < count; i++) wrong += operation_check(&list[i]);
  assert_int_equal(wrong, 0);
}

#endif
