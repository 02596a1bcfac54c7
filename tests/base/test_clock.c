/* Time that passes. */
#include "tests/check.h"

#include "base/clock.h"

#include <time.h>

static void a_wait_takes_as_long_as_it_lasts(void **state) {
  (void)state;
  const struct timespec wait = {.tv_nsec = 20000000};
  const double start_s = abbe_clock_seconds();
  assert_int_equal(nanosleep(&wait, NULL), 0);
  const double spent_s = abbe_clock_seconds() - start_s;
  assert_true(spent_s > 0.0199); /* however much longer the machine takes */
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_wait_takes_as_long_as_it_lasts)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
