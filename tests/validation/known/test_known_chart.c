/* The chart of known answers: what is in it, and what is refused. */
#include "tests/check.h"
#include "tests/fontconfig.h"

#include "base/file.h"
#include "validation/known/known_chart.h"

#include <stdlib.h>
#include <unistd.h>

/* The text of the picture that these rows make; the caller frees. */
static char *draw(abbe_known_answer *row, size_t count) {
  char path[64], *text = NULL;
  size_t size = 0;
  abbe_error error = {0};
  const abbe_known_answers answers = {.count = count, .row = row};
  snprintf(path, sizeof path, "/tmp/abbe_test_known_chart_%ld.svg", (long)getpid());
  if (abbe_known_chart_write(path, &answers, &error) != ABBE_OK) fail_msg("%s", error.text);
  assert_int_equal(abbe_file_read(path, 1 << 22, &text, &size, NULL), ABBE_OK);
  unlink(path);
  return text;
}

static void rows_are_drawn_even_broken_ones(void **state) {
  (void)state;
  abbe_known_answer rows[] = {{.group = "a", .error = 0.5, .tolerance = 1},
                              {.group = "a", .error = -7, .tolerance = 1},
                              {.group = "b", .error = NAN, .tolerance = 1},
                              {.group = "b", .error = 1, .tolerance = NAN},
                              {.group = "b", .error = 0, .tolerance = 0},
                              {.group = "b", .error = 3, .tolerance = 0},
                              {.group = "c", .error = 1e300, .tolerance = 1e-300}};
  char *text = draw(rows, 7);
  assert_contains(text, "<svg");
  free(text);
}

/* Two rows that stand over photons make the second chart: a taller picture. */
static void photons_make_a_chart_of_their_own(void **state) {
  (void)state;
  abbe_known_answer rows[] = {
      {.group = "a", .exact = 0.1, .traced = 0.11, .tolerance = 0.1, .photons = 1000},
      {.group = "a", .exact = 0.05, .traced = 0.04, .tolerance = 0.1, .photons = 4000}};
  char *both = draw(rows, 2), *one = draw(rows, 1);
  assert_contains(both, "900");
  assert_contains(one, "480");
  free(both);
  free(one);
}

static void nothing_is_refused(void **state) {
  (void)state;
  abbe_error error = {0};
  const abbe_known_answers none = {0};
  assert_int_equal(abbe_known_chart_write("x.svg", &none, &error), ABBE_INVALID_ARGUMENT);
  assert_contains(error.text, "x.svg: there are no answers");
  abbe_known_answer row = {.group = "a", .tolerance = 1};
  const abbe_known_answers one = {.count = 1, .row = &row};
  assert_int_equal(abbe_known_chart_write("/no/such/folder/x.svg", &one, &error), ABBE_IO);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_drawn_even_broken_ones),
      cmocka_unit_test(photons_make_a_chart_of_their_own),
      cmocka_unit_test(nothing_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
