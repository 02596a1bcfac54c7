/* check.h: what the tests share: cmocka's includes in order, tests that register themselves, and
 * comparisons that say the values. tests/check.c runs the tests of a program in the order in which
 * they stand: `test_NAME [PART…]`, `test_NAME --list`. A part is of a name, or K/N: every N-th
 * test. */
#ifndef ABBE_TESTS_CHECK_H
#define ABBE_TESTS_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether faults of memory are looked for. The tests of label cpu run in release as well: there
 * they hold laws over many cases, of which a few are enough to look for faults. */
#ifdef __SANITIZE_ADDRESS__
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

/* Whether a law is held to all its cases, as script/test --long does; else to those that differ
 * most, for each of the others compiles shaders of its own. */
static inline bool all_cases(void) {
  return getenv("ABBE_ALL_CASES") != NULL;
}

/* Of cmocka 2, where assert_in_range is deprecated. */
#ifndef assert_int_in_range
#define assert_int_in_range assert_in_range
#endif

/* The braces of a row or of a struct's fields, which so may share a line. */
#define FIELDS(...)                                                                                \
  { __VA_ARGS__ }

typedef struct check_test {
  const char *name;
  int line;
  void (*run)(void), (*before)(void), (*after)(void);
  struct check_test *next;
} check_test;
void check_add(check_test *test);
void check_group(void (*before)(void), void (*after)(void));
void check_each(void (*before)(void), void (*after)(void));

/* TEST(name) { … } is a test of this program; TEST_WITH's is run between two functions. */
#define TEST(name) TEST_WITH(name, NULL, NULL)
#define TEST_WITH(name, before, after)                                                             \
  static void test_##name(void);                                                                   \
  __attribute__((constructor)) static void add_##name(void) {                                      \
    static check_test test = {#name, __LINE__, test_##name, before, after, NULL};                  \
    check_add(&test);                                                                              \
  }                                                                                                \
  static void test_##name(void)
/* What is run around all tests of the program, or around each; NULL for nothing. */
#define GROUP(before, after)                                                                       \
  __attribute__((constructor)) static void add_group(void) {                                       \
    check_group(before, after);                                                                    \
  }                                                                                                \
  struct check_test
#define EACH(before, after)                                                                        \
  __attribute__((constructor)) static void add_each(void) {                                        \
    check_each(before, after);                                                                     \
  }                                                                                                \
  struct check_test

/* OK(call) and REFUSED(code, words, call): the call succeeds, or fails with that code and a
 * sentence that contains the words ("" for any sentence). The call names its error as &error, which
 * is the macro's own. last_error is what the last REFUSED was told; calls that have no error to
 * give may fill it. */
extern abbe_error last_error;
#define OK(...)                                                                                    \
  do {                                                                                             \
    abbe_error error = {.text = ""};                                                               \
    check_ok((__VA_ARGS__), &error, #__VA_ARGS__, __FILE__, __LINE__);                             \
  } while (0)
#define REFUSED(code, words, ...)                                                                  \
  do {                                                                                             \
    abbe_error error = {.text = ""};                                                               \
    check_refusal(code, words, (__VA_ARGS__), &error, #__VA_ARGS__, __FILE__, __LINE__);           \
  } while (0)
void check_ok(abbe_result result, const abbe_error *error, const char *call, const char *file,
              int line);
void check_refusal(abbe_result code, const char *words, abbe_result result, const abbe_error *error,
                   const char *call, const char *file, int line);

/* Not after a failure. */
#define OWNED ABBE_OWNED
#define HOLDS(type) ABBE_HOLDS(type) struct check_test
#define HELD ABBE_HELD
/* Its own, for tests that use no part of the product. */
#define FREED __attribute__((cleanup(check_free)))
static inline void check_free(void *pointer) {
  free(*(void **)pointer);
}

/* An OWNED local that the call makes: MADE's call may fail, as OK's; FILLED's returns nothing. */
#define MADE(type, name, ...)                                                                      \
  OWNED(type, name) = {0};                                                                         \
  OK(__VA_ARGS__)
#define FILLED(type, name, ...)                                                                    \
  OWNED(type, name) = {0};                                                                         \
  __VA_ARGS__

/* The text of a format, below 8 KiB; it stays for 63 more. */
const char *printed(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* |a - b| <= tolerance; a NaN on either side fails. */
#define assert_near(a, b, tolerance) check_near(a, b, tolerance, #a, __FILE__, __LINE__)
static inline void check_near(double a, double b, double tolerance, const char *what,
                              const char *file, int line) {
  if (fabs(a - b) <= tolerance) return;
  print_error("%s is %.17g, not %.17g within %g\n", what, a, b, tolerance);
  _fail(file, line);
}

#define assert_contains(text, part) check_contains(text, part, __FILE__, __LINE__)
static inline void check_contains(const char *text, const char *part, const char *file, int line) {
  if (strstr(text, part) != NULL) return;
  print_error("'%s' does not contain '%s'\n", text, part);
  _fail(file, line);
}

#endif
