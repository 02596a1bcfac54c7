#include "validation/lab/known/known_answers.h"

#include "colorimetry/plot/chart.h"

#include <math.h>
#include <stdlib.h>

enum { MAX_GROUPS = 32 };

/* Columns of numbers, each [count]; one piece of memory. */
typedef struct columns {
  double *x, *share;                               /* values of every row */
  double *photons, *error, *low, *high, *expected; /* values of the rows that stand over photons */
  size_t levels;
} columns;

static abbe_result fill(const abbe_known_answers *a, columns *c, abbe_error *error) {
  double *all = calloc(7 * a->count, sizeof *all);
  if (all == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a chart of %zu rows",
                          a->count);
  double **const column[7] = {&c->x,   &c->share, &c->photons, &c->error,
                              &c->low, &c->high,  &c->expected};
  for (size_t k = 0; k < 7; k++) *column[k] = all + k * a->count;
  for (size_t i = 0; i < a->count; i++) {
    const abbe_known_answer *r = &a->row[i];
    c->x[i] = (double)i + 1;
    c->share[i] = r->tolerance > 0 ? r->error / r->tolerance : r->error == 0 ? 0 : NAN;
    if (!(r->photons > 0)) continue;
    size_t k = c->levels++;
    c->photons[k] = r->photons;
    c->error[k] = r->traced;
    c->low[k] = r->traced - r->standard_error;
    c->high[k] = r->traced + r->standard_error;
    c->expected[k] = r->exact;
  }
  return ABBE_OK;
}

static size_t add_groups(const abbe_known_answers *a, const columns *c,
                         abbe_chart_series series[MAX_GROUPS]) {
  size_t count = 0;
  for (size_t from = 0, to; from < a->count && count < MAX_GROUPS; from = to) {
    for (to = from; to < a->count && a->row[to].group == a->row[from].group;) to++;
    series[count++] = (abbe_chart_series){.label = a->row[from].group,
                                          .style = ABBE_CHART_POINTS,
                                          .count = to - from,
                                          .x = c->x + from,
                                          .y = c->share + from};
  }
  return count;
}

abbe_result abbe_known_chart_write(const char *path, const abbe_known_answers *answers,
                                   abbe_error *error) {
  if (answers->count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: there are no answers to draw", path);
  columns c = {0};
  abbe_result result = fill(answers, &c, error);
  if (result != ABBE_OK) return result;
  double reach = 1; /* rows out of tolerance are to be seen */
  for (size_t i = 0; i < answers->count; i++)
    if (isfinite(c.share[i])) reach = fmax(reach, 1.1 * fabs(c.share[i]));
  abbe_chart_series groups[MAX_GROUPS];
  const size_t count = add_groups(answers, &c, groups);
  const abbe_chart_series falling[] = {
      {.label = "1 / square root of the photons, from the passes' spread",
       .style = ABBE_CHART_LINE,
       .count = c.levels,
       .x = c.photons,
       .y = c.expected},
      {.label = "measured against the quadrature",
       .style = ABBE_CHART_POINTS,
       .count = c.levels,
       .x = c.photons,
       .y = c.error,
       .low = c.low,
       .high = c.high},
  };
  const abbe_chart charts[] = {
      {.title = "Error of the rings under a sphere",
       .x = {.label = "photons", .log = true},
       .y = {.label = "relative error, RMS", .log = true},
       .series_count = 2,
       .series = falling},
      {.title = "Errors of all known answers",
       .x = {.label = "row", .max = 1.3 * (double)answers->count + 1}, /* space for the legend */
       .y = {.label = "error / tolerance", .min = -reach, .max = reach},
       .series_count = count,
       .series = groups},
  };
  const bool both = c.levels > 1;
  result = abbe_chart_write(path, both ? charts : charts + 1, both ? 2 : 1, 960, both ? 900 : 480,
                            error);
  free(c.x);
  return result;
}
