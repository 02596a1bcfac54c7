/* A watch is its thread's own, and over for good. */
#include "tests/check.h"
#include "tests/patience.h"

#include <pthread.h>

TEST(it_is_over_for_good) {
  patience p = {.most = 2};
  abbe_watch watch = {patience_lasts, &p, false};
  assert_true(abbe_watch_goes_on());
  abbe_watch_set(&watch);
  assert_true(abbe_watch_goes_on());
  OK(abbe_watch_check(&error));
  REFUSED(ABBE_CANCELLED, "", abbe_watch_check(&error));
  p.most = 9;
  assert_false(abbe_watch_goes_on());
  assert_int_equal(p.asked, 3);
  abbe_watch_set(NULL);
  assert_true(abbe_watch_goes_on());
  assert_int_equal(p.asked, 3);
}

static void *ask(void *user) {
  *(bool *)user = abbe_watch_goes_on();
  return NULL;
}

TEST(another_thread_has_none) {
  patience p = {.most = 0};
  abbe_watch watch = {patience_lasts, &p, false};
  pthread_t thread;
  bool wanted = false;
  abbe_watch_set(&watch);
  assert_int_equal(pthread_create(&thread, NULL, ask, &wanted), 0);
  pthread_join(thread, NULL);
  assert_true(wanted);
  assert_false(abbe_watch_goes_on());
  abbe_watch_set(NULL);
}
