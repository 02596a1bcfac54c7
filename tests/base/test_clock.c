/* Time that passes. */
#include "tests/check.h"

#include "base/clock.h"

#include <time.h>

TEST(a_wait_takes_as_long_as_it_lasts) {
  const struct timespec wait = {.tv_nsec = 20000000};
  const double start_s = abbe_clock_seconds();
  assert_int_equal(nanosleep(&wait, NULL), 0);
  const double spent_s = abbe_clock_seconds() - start_s;
  assert_true(spent_s > 0.0199); /* however much longer the machine takes */
}

/* While a thread waits no processor works for it. */
TEST(work_alone_counts_for_a_thread) {
  const struct timespec wait = {.tv_nsec = 20000000};
  const double start_s = abbe_clock_thread_seconds();
  assert_int_equal(nanosleep(&wait, NULL), 0);
  const double waited_s = abbe_clock_thread_seconds();
  assert_true(waited_s - start_s < 0.01);
  const double from_s = abbe_clock_seconds();
  volatile unsigned steps = 0;
  while (abbe_clock_thread_seconds() - waited_s < 0.002) steps++;
  assert_true(abbe_clock_seconds() - from_s > 0.0019);
}
