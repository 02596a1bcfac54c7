/* decimal_comma.h: a locale with a decimal comma, made where the system has none. */
#ifndef ABBE_TESTS_DECIMAL_COMMA_H
#define ABBE_TESTS_DECIMAL_COMMA_H

#include "tests/check.h"

#include <locale.h>
#include <unistd.h>

#define COMMA "de_DE.UTF-8"

static char comma_folder[] = "/tmp/abbe-test-locale-XXXXXX";

static inline bool comma_is_there(void) {
  const bool there =
      setlocale(LC_ALL, COMMA) != NULL && strcmp(localeconv()->decimal_point, ",") == 0;
  setlocale(LC_ALL, "C");
  return there;
}

/* Of a group of tests: they fail where there is no such locale and localedef makes none. */
static void comma_setup(void) {
  assert_non_null(mkdtemp(comma_folder));
  if (comma_is_there()) return;
  const char *command = printed("localedef -i de_DE -f UTF-8 %s/" COMMA, comma_folder);
  if (system(command) != 0 || setenv("LOCPATH", comma_folder, 1) != 0 || !comma_is_there()) {
    print_error("there is no locale " COMMA " and localedef (package locales) makes none\n");
    fail();
  }
}

static void comma_teardown(void) {
  setlocale(LC_ALL, "C");
  assert_false(system(printed("rm -r %s", comma_folder)));
}

#endif
