#include "validation/tradeoff/sweep_plot.h"

#include "base/file.h"
#include "colorimetry/plot/chart.h"
#include "validation/tradeoff/pareto_front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHARTS = 4, MAX_PROFILES = 16, LABEL = 64 };

/* One chart's numbers, in pieces of memory of a row each. */
typedef struct figures {
  double *x, *y;        /* [count] of all rows, in the table's order */
  double *px, *py;      /* [count] profile by profile */
  double *fx, *fy;      /* [front] in the order of time */
  char (*label)[LABEL]; /* [front] */
  const char **text;    /* [front] */
  size_t *order, front;
  double *bx, *by; /* the other profiles' fronts, one after another */
  const char *profile[MAX_PROFILES];
  size_t profiles, start[MAX_PROFILES + 1];
  double noise_x[2], noise_y[2];
  abbe_chart_series series[2 * MAX_PROFILES + 2];
  size_t series_count;
  char x_label[96], y_label[96];
} figures;

static void close_figures(figures *f) {
  free(f->x);
  free(f->label);
  free(f->text);
  free(f->order);
}

static abbe_result open_figures(size_t count, figures *f, abbe_error *error) {
  f->x = calloc(9 * count + 1, sizeof *f->x);
  f->label = calloc(count + 1, sizeof *f->label);
  f->text = calloc(count + 1, sizeof *f->text);
  f->order = calloc(count + 1, sizeof *f->order);
  if (f->x == NULL || f->label == NULL || f->text == NULL || f->order == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sweep's chart");
  f->y = f->x + count;
  f->px = f->x + 2 * count;
  f->py = f->x + 3 * count;
  f->fx = f->x + 4 * count;
  f->fy = f->x + 5 * count;
  f->bx = f->x + 6 * count;
  f->by = f->x + 7 * count;
  return ABBE_OK;
}

/* The same in every chart, whatever a table's order is; blue is the front of all. */
static const struct {
  const char *profile;
  int colour;
} colours[] = {{"default", 2},        {"thesis", 3},       {"thesis-cie", 4},
               {ABBE_SWEEP_TRACE, 5}, {"trace-filter", 6}, {"shah2007", 7},
               {"shah2007-cie", 8},   {"wyman2006", 11},   {"wyman2006-cie", 12}};

static int colour_of(const char *profile, size_t number) {
  for (size_t i = 0; i < sizeof colours / sizeof *colours; i++)
    if (strcmp(profile, colours[i].profile) == 0) return colours[i].colour;
  return (int)(number % 4) + 13;
}

static void find_profiles(const abbe_sweep_table *table, figures *f) {
  for (size_t i = 0; i < table->count; i++) {
    size_t k = 0;
    while (k < f->profiles && strcmp(f->profile[k], table->row[i].setting.profile) != 0) k++;
    if (k == f->profiles && k < MAX_PROFILES)
      f->profile[f->profiles++] = table->row[i].setting.profile;
  }
}

static void add_points(const abbe_sweep_table *table, figures *f) {
  size_t at = 0;
  for (size_t k = 0; k < f->profiles; k++) {
    f->start[k] = at;
    for (size_t i = 0; i < table->count; i++) {
      if (strcmp(table->row[i].setting.profile, f->profile[k]) != 0) continue;
      f->px[at] = f->x[i];
      f->py[at++] = f->y[i];
    }
    f->series[f->series_count++] = (abbe_chart_series){.label = f->profile[k],
                                                       .style = ABBE_CHART_POINTS,
                                                       .count = at - f->start[k],
                                                       .x = f->px + f->start[k],
                                                       .y = f->py + f->start[k],
                                                       .colour = colour_of(f->profile[k], k)};
  }
}

/* The best that each profile has, in its colour, but for one. */
static void add_profile_fronts(const abbe_sweep_table *table, const char *but,
                               abbe_chart_style style, figures *f) {
  double *own = f->by + table->count;
  size_t at = 0;
  for (size_t k = 0; k < f->profiles; k++) {
    if (but != NULL && strcmp(f->profile[k], but) == 0) continue;
    for (size_t i = 0; i < table->count; i++)
      own[i] = strcmp(table->row[i].setting.profile, f->profile[k]) == 0 ? f->x[i] : NAN;
    size_t count = abbe_pareto_front_order(own, f->y, table->count, f->order);
    for (size_t i = 0; i < count; i++) {
      f->bx[at + i] = f->x[f->order[i]];
      f->by[at + i] = f->y[f->order[i]];
    }
    f->series[f->series_count++] = (abbe_chart_series){.label = but == NULL ? f->profile[k] : NULL,
                                                       .style = style,
                                                       .count = count,
                                                       .x = f->bx + at,
                                                       .y = f->by + at,
                                                       .colour = colour_of(f->profile[k], k)};
    at += count;
  }
}

static void add_front(const abbe_sweep_table *table, figures *f) {
  f->front = abbe_pareto_front_order(f->x, f->y, table->count, f->order);
  for (size_t k = 0; k < f->front; k++) {
    f->fx[k] = f->x[f->order[k]];
    f->fy[k] = f->y[f->order[k]];
    abbe_sweep_setting_label(&table->row[f->order[k]].setting, f->label[k], LABEL);
    f->text[k] = f->label[k];
  }
  f->series[f->series_count++] = (abbe_chart_series){.label = "Pareto front",
                                                     .style = ABBE_CHART_JOINED_POINTS,
                                                     .count = f->front,
                                                     .x = f->fx,
                                                     .y = f->fy,
                                                     .text = f->text,
                                                     .colour = 1};
}

/* The noise is the reference's alone, so nearly the same in every row: the median of them. */
static void add_noise(const abbe_sweep_table *table, abbe_sweep_number number, figures *f) {
  double sum = 0, low = INFINITY, high = 0;
  size_t known = 0;
  for (size_t i = 0; i < table->count; i++) {
    double noise = table->row[i].number[number + 1];
    if (isfinite(f->x[i]) && f->x[i] > 0) {
      low = fmin(low, f->x[i]);
      high = fmax(high, f->x[i]);
    }
    if (!isfinite(noise) || !(noise > 0)) continue;
    sum += log(noise);
    known++;
  }
  if (known == 0 || !(low < high)) return;
  f->noise_x[0] = low;
  f->noise_x[1] = high;
  f->noise_y[0] = f->noise_y[1] = exp(sum / (double)known);
  f->series[f->series_count++] = (abbe_chart_series){.label = "the reference's own noise",
                                                     .style = ABBE_CHART_DASHED,
                                                     .count = 2,
                                                     .x = f->noise_x,
                                                     .y = f->noise_y,
                                                     .colour = 7};
}

static abbe_result make_chart(const abbe_sweep_table *table, abbe_sweep_number time,
                              abbe_sweep_number number, figures *f, abbe_chart *chart,
                              abbe_error *error) {
  if (!abbe_sweep_number_is_error(number))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%s' is no error that can be drawn",
                          abbe_sweep_number_name(number));
  abbe_result result = open_figures(table->count, f, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < table->count; i++) {
    f->x[i] = table->row[i].number[time];
    f->y[i] = table->row[i].number[number];
  }
  find_profiles(table, f);
  add_points(table, f);
  add_profile_fronts(table, "default", ABBE_CHART_LINE, f);
  add_front(table, f);
  add_noise(table, number, f);
  if (f->front == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no setting has a known '%s' to draw",
                          abbe_sweep_number_name(number));
  snprintf(f->x_label, sizeof f->x_label, "%s (median)", abbe_sweep_number_text(time));
  snprintf(f->y_label, sizeof f->y_label, "%s", abbe_sweep_number_text(number));
  *chart = (abbe_chart){.x = {.label = f->x_label, .log = true},
                        .y = {.label = f->y_label, .log = true},
                        .series_count = f->series_count,
                        .series = f->series};
  return ABBE_OK;
}

abbe_result abbe_sweep_plot(const char *path, const abbe_sweep_table *table, abbe_sweep_number time,
                            const abbe_sweep_number *errors, size_t count, abbe_error *error) {
  figures f[MAX_CHARTS];
  abbe_chart charts[MAX_CHARTS];
  char title[600];
  if (count < 1 || count > MAX_CHARTS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu charts of a sweep; 1 to %d can be drawn", count, MAX_CHARTS);
  memset(f, 0, sizeof f);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = make_chart(table, time, errors[i], &f[i], &charts[i], error);
  snprintf(title, sizeof title, "%s, %s", abbe_file_name(table->fact[ABBE_SWEEP_FACT_SCENE]),
           table->fact[ABBE_SWEEP_FACT_SIZE]);
  charts[0].title = title;
  if (result == ABBE_OK) result = abbe_chart_write(path, charts, count, 1100, 560 * count, error);
  for (size_t i = 0; i < count; i++) close_figures(&f[i]);
  return result;
}

/* ---- several scenes ---- */

enum { MAX_SCENES = 16, ALL_PROFILES = MAX_PROFILES };

/* One scene against one time: each profile's own front. */
static abbe_result make_fronts(const abbe_sweep_table *table, abbe_sweep_number time,
                               abbe_sweep_number number, figures *f, abbe_chart *chart,
                               abbe_error *error) {
  abbe_result result = open_figures(table->count, f, error);
  if (result != ABBE_OK) return result;
  size_t known = 0;
  for (size_t i = 0; i < table->count; i++) {
    f->x[i] = table->row[i].number[time];
    f->y[i] = table->row[i].number[number];
    known += isfinite(f->x[i]) && isfinite(f->y[i]);
  }
  if (known == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: no setting has a known '%s' and '%s'",
                          abbe_file_name(table->fact[ABBE_SWEEP_FACT_SCENE]),
                          abbe_sweep_number_name(time), abbe_sweep_number_name(number));
  find_profiles(table, f);
  add_profile_fronts(table, NULL, ABBE_CHART_JOINED_POINTS, f);
  add_noise(table, number, f);
  snprintf(f->x_label, sizeof f->x_label, "%s: %s",
           abbe_file_name(table->fact[ABBE_SWEEP_FACT_SCENE]), abbe_sweep_number_text(time));
  snprintf(f->y_label, sizeof f->y_label, "%s", abbe_sweep_number_text(number));
  *chart = (abbe_chart){.x = {.label = f->x_label, .log = true},
                        .y = {.label = f->y_label, .log = true},
                        .series_count = f->series_count,
                        .series = f->series};
  return ABBE_OK;
}

static size_t known_times(const abbe_sweep_table *tables, size_t count,
                          abbe_sweep_number out[ABBE_SWEEP_TIMES]) {
  size_t times = 0;
  for (size_t t = 0; t < ABBE_SWEEP_TIMES; t++) {
    bool known = false;
    for (size_t i = 0; i < count && !known; i++)
      for (size_t k = 0; k < tables[i].count && !known; k++)
        known = isfinite(tables[i].row[k].number[abbe_sweep_times[t]]);
    if (known) out[times++] = abbe_sweep_times[t];
  }
  return times;
}

/* Whose fronts the charts hold, each profile once. */
static size_t list_labels(const figures *f, size_t charts, const char *out[ALL_PROFILES]) {
  size_t count = 0;
  for (size_t i = 0; i < charts; i++)
    for (size_t k = 0; k < f[i].profiles && count < ALL_PROFILES; k++) {
      size_t m = 0;
      while (m < count && strcmp(out[m], f[i].profile[k]) != 0) m++;
      if (m == count) out[count++] = f[i].profile[k];
    }
  return count;
}

/* A legend of all would hide half of a small chart: each chart of the first row has a part of it,
 * of what other scenes hold too. */
static void share_legend(figures *f, abbe_chart *chart, size_t charts, size_t times) {
  const char *label[ALL_PROFILES];
  const size_t count = list_labels(f, charts, label);
  for (size_t i = 0; i < charts; i++)
    for (size_t k = 0; k < f[i].series_count; k++)
      if (i + 1 != times || f[i].series[k].style != ABBE_CHART_DASHED) f[i].series[k].label = NULL;
  for (size_t k = 0; k < count; k++) {
    figures *at = &f[k * times / count];
    at->series[at->series_count++] = (abbe_chart_series){
        .label = label[k], .style = ABBE_CHART_JOINED_POINTS, .colour = colour_of(label[k], k)};
    chart[k * times / count].series_count = at->series_count;
  }
}

abbe_result abbe_sweep_plot_scenes(const char *path, const abbe_sweep_table *tables, size_t count,
                                   abbe_sweep_number number, abbe_error *error) {
  if (count < 1 || count > MAX_SCENES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu tables in one chart; 1 to %d can be drawn", count, MAX_SCENES);
  if (!abbe_sweep_number_is_error(number))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%s' is no error that can be drawn",
                          abbe_sweep_number_name(number));
  abbe_sweep_number time[ABBE_SWEEP_TIMES];
  const size_t times = known_times(tables, count, time);
  if (times == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no setting has a known time to draw");
  const size_t charts = count * times;
  figures *f = calloc(charts, sizeof *f);
  abbe_chart chart[MAX_SCENES * ABBE_SWEEP_TIMES];
  abbe_result result =
      f != NULL ? ABBE_OK
                : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sweeps' charts");
  for (size_t i = 0; i < charts && result == ABBE_OK; i++)
    result = make_fronts(&tables[i / times], time[i % times], number, &f[i], &chart[i], error);
  if (result == ABBE_OK) share_legend(f, chart, charts, times);
  if (result == ABBE_OK)
    result = abbe_chart_write_grid(path, chart, charts, times, 420 * times, 230 * count, error);
  for (size_t i = 0; i < charts && f != NULL; i++) close_figures(&f[i]);
  free(f);
  return result;
}
