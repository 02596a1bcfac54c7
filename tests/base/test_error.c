#include "tests/check.h"

#include "base/clock.h"
#include "base/error.h"
#include "tests/patience.h"

#include <pthread.h>
#include <time.h>

TEST(every_code_has_its_own_text) {
  for (int i = 0; i < ABBE_RESULT_COUNT; i++) {
    assert_string_not_equal(abbe_result_text((abbe_result)i), "unknown result");
    for (int k = 0; k < i; k++)
      assert_string_not_equal(abbe_result_text((abbe_result)i), abbe_result_text((abbe_result)k));
  }
  assert_string_equal(abbe_result_text((abbe_result)-1), "unknown result");
  assert_string_equal(abbe_result_text(ABBE_RESULT_COUNT), "unknown result");
}

TEST(the_sentence_is_kept_cut_and_optional) {
  REFUSED(ABBE_IO, "", abbe_error_set(&error, ABBE_IO, "%s:%d", "file", 7));
  assert_int_equal(last_error.code, ABBE_IO);
  assert_string_equal(last_error.text, "file:7");
  assert_int_equal(abbe_error_set(NULL, ABBE_GL, "x"), ABBE_GL);
  REFUSED(ABBE_IO, "", abbe_error_set(&error, ABBE_IO, "%5000s", "x"));
  assert_int_equal(strlen(last_error.text), sizeof last_error.text - 1);
}

TEST(the_sentence_is_printable) {
  abbe_error error;
  abbe_error_set(&error, ABBE_IO, "%s: no\n%s\xff", "a\x1b[31m", "b\xc2\x9b");
  assert_string_equal(error.text, "a\xe2\x90\x9b[31m: no b\xef\xbf\xbd\xef\xbf\xbd");
  abbe_error_set(&error, ABBE_IO, "%s, again", error.text); /* its own text in a larger sentence */
  assert_string_equal(error.text, "a\xe2\x90\x9b[31m: no b\xef\xbf\xbd\xef\xbf\xbd, again");
  char many[900];
  memset(many, '\x1b', sizeof many - 1);
  many[sizeof many - 1] = '\0';
  abbe_error_set(&error, ABBE_IO, "%s", many); /* pictures take three bytes: cut between them */
  assert_int_equal(strlen(error.text), (sizeof error.text - 1) / 3 * 3);
}

/* Time that passes. */

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

/* A watch is its thread's own, and over for good. */

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
