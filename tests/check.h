/* check.h: what the cmocka tests share: its includes in order, and comparisons that say the values.
 */
#ifndef ABBE_TESTS_CHECK_H
#define ABBE_TESTS_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether faults of memory are looked for. The tests of label cpu run in release as well: there they
 * hold laws over many cases, of which a few are enough to look for faults. */
#ifdef __SANITIZE_ADDRESS__
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

/* Whether a law is held to all its cases, as script/test --long does; else to those that differ most,
 * for each of the others compiles shaders of its own. */
static inline bool all_cases(void) {
  return getenv("ABBE_ALL_CASES") != NULL;
}

/* Of cmocka 2, where assert_in_range is deprecated. */
#ifndef assert_int_in_range
#define assert_int_in_range assert_in_range
#endif

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
