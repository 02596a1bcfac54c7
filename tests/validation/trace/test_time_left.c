/* What fits into the time that is left. */
#include "tests/check.h"

#include "validation/trace/checked_picture.h"

static double two_seconds(void *user) {
  ++*(int *)user;
  return 2;
}

static double none(void *user) {
  (void)user;
  return -1;
}

TEST(what_fits) {
  int asked = 0;
  const abbe_time_left two = {two_seconds, &asked}, over = {none, NULL};
  assert_near(abbe_time_left_seconds(&two), 2, 0);
  assert_true(abbe_time_left_holds(&two, 1.5));
  assert_false(abbe_time_left_holds(&two, 1.6)); /* it may take a third longer */
  assert_int_equal(asked, 3);
  assert_false(abbe_time_left_holds(&two, NAN));
  assert_false(abbe_time_left_holds(&over, 0));
}

TEST(without_an_end) {
  const abbe_time_left always = {0};
  assert_true(isinf(abbe_time_left_seconds(&always)));
  assert_true(abbe_time_left_holds(&always, 1e9));
  assert_true(abbe_time_left_holds(&always, NAN));
}
