/* run_program.h: runs the program in a folder of its own and looks at what it says and leaves. */
#ifndef ABBE_TESTS_CLI_RUN_PROGRAM_H
#define ABBE_TESTS_CLI_RUN_PROGRAM_H

#include "tests/check.h"

#include <dirent.h>
#include <sys/wait.h>
#include <unistd.h>

static char run_folder[64];
static char run_errors[1 << 14], run_output[1 << 17];

static void run_setup(void) {
  snprintf(run_folder, sizeof run_folder, "/tmp/abbe-test-run-XXXXXX");
  assert_non_null(mkdtemp(run_folder));
}

/* A file of that name in the folder; the text stays for three more. */
static inline const char *run_path(const char *name) {
  static char path[4][400];
  static size_t next;
  char *out = path[next++ % 4];
  snprintf(out, sizeof path[0], "%s/%s", run_folder, name);
  return out;
}

/* Calls visit for every entry of the folder. */
static inline void run_each(void (*visit)(const char *path, const char *name, void *user),
                            void *user) {
  DIR *dir = opendir(run_folder);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
    visit(run_path(entry->d_name), entry->d_name, user);
  }
  closedir(dir);
}

static inline void run_remove(const char *path, const char *name, void *user) {
  (void)name;
  (void)user;
  unlink(path);
}

static inline void run_complain(const char *path, const char *name, void *user) {
  (void)path;
  print_error("left behind: %s\n", name);
  ++*(int *)user;
}

static inline int run_left(void) {
  int count = 0;
  run_each(run_complain, &count);
  return count;
}

static void run_teardown(void) {
  run_each(run_remove, NULL);
  assert_false(rmdir(run_folder));
}

static inline void run_read(const char *name, char *text, size_t size) {
  const char *path = printed("%s.%s", run_folder, name);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  text[fread(text, 1, size - 1, file)] = '\0';
  fclose(file);
  unlink(path);
}

/* A shell line in the folder, with $abbe the program and $house the sources; its exit code. What
 * it writes to its streams is in run_output and run_errors. */
static inline int run_line(const char *line) {
  char command[4096];
  int n = snprintf(command, sizeof command,
                   "cd '%s' && abbe='%s' && house='%s' && { %s\n} >'%s.output' 2>'%s.errors'",
                   run_folder, ABBE_PROGRAM, ABBE_SOURCE_DIR, line, run_folder, run_folder);
  assert_true(n > 0 && (size_t)n < sizeof command);
  int status = system(command);
  run_read("output", run_output, sizeof run_output);
  run_read("errors", run_errors, sizeof run_errors);
  assert_true(WIFEXITED(status));
  return WEXITSTATUS(status);
}

/* The same, of a line that ends well. */
static inline void run_must(const char *line) {
  if (run_line(line) != 0) fail_msg("%s: %s", line, run_errors);
}

/* The same, of one after which the folder is empty. */
static inline void run_clears(const char *line) {
  run_must(line);
  assert_int_equal(run_left(), 0);
}

/* The same, of one that ends with the code and says the words on stderr. */
static inline void run_fails(const char *line, int code, const char *words) {
  const int ended = run_line(line);
  if (ended == code && strstr(run_errors, words) != NULL) return;
  fail_msg("%s: ends with %d, not %d, or without '%s': %s", line, ended, code, words, run_errors);
}

/* The same, of one whose output contains the words. */
static inline void run_says(const char *line, const char *words) {
  run_must(line);
  if (strstr(run_output, words) == NULL) fail_msg("%s: no '%s' in: %s", line, words, run_output);
}

/* Exit code `code`, a sentence on stderr that holds part, nothing on stdout, nothing left. */
static inline bool run_refuses(const char *line, int code, const char *part) {
  int actual = run_line(line);
  bool right = actual == code && strstr(run_errors, part) != NULL && run_output[0] == '\0';
  if (!right)
    print_error("%s\n  ends with %d, not %d; '%s' is expected in:\n%s%s\n", line, actual, code,
                part, run_errors, run_output);
  return (run_left() == 0) && right;
}

#endif
