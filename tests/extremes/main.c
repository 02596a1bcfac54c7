/* The renderer at the extremes: test_extremes [--table] [--heavy] [GROUP…]. */
#include "tests/extremes/laws.h"
#include "tests/extremes/limits.h"

#include <stdio.h>

typedef struct state {
  abbe_context *context;
  extreme_report report;
} state;

static void run(void *user, const extreme *e) {
  state *s = user;
  extreme_row row = {{0}, {0}};
  extreme_check(s->context, e, &row);
  extreme_report_add(&s->report, e->group, e->name, &row);
}

int main(int count, char **argument) {
  state s = {NULL, extreme_report_make(count, argument)};
  abbe_error error = {0};
  if (abbe_context_make(ABBE_CONTEXT_CPU, &s.context, &error) != ABBE_OK) {
    fprintf(stderr, "%s\n", error.text);
    return 1;
  }
  extreme_for_each(&s.report, run, &s);
  for (size_t i = 0; i < extreme_limit_count && extreme_report_wants(&s.report, "limits"); i++) {
    extreme_row row = {{0}, {0}};
    extreme_limits[i].check(s.context, &row);
    extreme_report_add(&s.report, "limits", extreme_limits[i].name, &row);
  }
  abbe_context_free(s.context);
  return extreme_report_end(&s.report);
}
