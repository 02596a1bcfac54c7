#include "tests/check.h"

typedef struct pair {
  void (*before)(void), (*after)(void);
} pair;

static check_test *first;
static pair group, each;

void check_add(check_test *test) {
  check_test **at = &first;
  while (*at != NULL && (*at)->line < test->line) at = &(*at)->next;
  test->next = *at;
  *at = test;
}

void check_group(void (*before)(void), void (*after)(void)) {
  group = (pair){before, after};
}

void check_each(void (*before)(void), void (*after)(void)) {
  each = (pair){before, after};
}

abbe_error last_error;

void check_ok(abbe_result result, const abbe_error *error, const char *call, const char *file,
              int line) {
  if (result == ABBE_OK) return;
  const abbe_error *told = error->text[0] != '\0' ? error : &last_error;
  print_error("%s\n  fails (%d): %s\n", call, (int)result, told->text);
  _fail(file, line);
}

void check_refusal(abbe_result code, const char *words, abbe_result result, const abbe_error *error,
                   const char *call, const char *file, int line) {
  last_error = *error;
  if (result == code && error->text[0] != '\0' && strstr(error->text, words) != NULL) return;
  print_error("%s\n  is to be refused (%d) with '%s', and gives (%d) '%s'\n", call, (int)code,
              words, (int)result, error->text);
  _fail(file, line);
}

const char *printed(const char *format, ...) {
  static char text[64][8192];
  static size_t next;
  char *out = text[next++ % 64];
  va_list values;
  va_start(values, format);
  const int size = vsnprintf(out, sizeof text[0], format, values);
  va_end(values);
  assert_true(size >= 0 && (size_t)size < sizeof text[0]);
  return out;
}

static void call(void (*function)(void)) {
  if (function != NULL) function();
}

static int begin(void **state) {
  (void)state;
  call(group.before);
  return 0;
}

static int end(void **state) {
  (void)state;
  call(group.after);
  return 0;
}

static int before(void **state) {
  call(each.before);
  call(((const check_test *)*state)->before);
  return 0;
}

static void run(void **state) {
  ((const check_test *)*state)->run();
}

static int after(void **state) {
  call(((const check_test *)*state)->after);
  call(each.after);
  return 0;
}

static bool is_wanted(const check_test *test, size_t number, int count, char **parts) {
  bool wanted = count == 0;
  for (int i = 0; i < count; i++) {
    size_t share, of;
    if (sscanf(parts[i], "%zu/%zu", &share, &of) == 2)
      wanted |= of > 0 && number % of == share % of;
    else
      wanted |= strstr(test->name, parts[i]) != NULL;
  }
  return wanted;
}

static int list(void) {
  for (const check_test *test = first; test != NULL; test = test->next) puts(test->name);
  return 0;
}

int main(int count, char **argument) {
  static struct CMUnitTest tests[200];
  size_t n = 0, number = 0;
  if (count == 2 && strcmp(argument[1], "--list") == 0) return list();
  for (check_test *test = first; test != NULL; test = test->next) {
    if (!is_wanted(test, number++, count - 1, argument + 1)) continue;
    if (n == sizeof tests / sizeof *tests) return fputs("too many tests\n", stderr), 2;
    tests[n++] = (struct CMUnitTest){test->name, run, before, after, test};
  }
  if (n == 0) return fputs("no such test\n", stderr), 2;
  return cmocka_run_group_tests(tests, begin, end);
}
