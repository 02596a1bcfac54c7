#include "colorimetry/plot/material_chart.h"

#include "colorimetry/plot/chart.h"
#include "spectral/materials/material_query.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 600, MAX_SERIES = 5 * ABBE_MATERIAL_CHART_MAX + 1, LABEL = 128 };

/* The series of a picture, and the memory of their numbers and labels. */
typedef struct series_list {
  abbe_chart_series series[MAX_SERIES];
  char label[MAX_SERIES][LABEL];
  double *number[4 * MAX_SERIES];
  size_t count, numbers;
} series_list;

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a chart");
}

static double *make_numbers(series_list *list, size_t count) {
  double *numbers = calloc(count + 1, sizeof *numbers);
  if (numbers != NULL) list->number[list->numbers++] = numbers;
  return numbers;
}

static void free_list(series_list *list) {
  for (size_t i = 0; list != NULL && i < list->numbers; i++) free(list->number[i]);
  free(list);
}

/* A series of count points with x and y to be filled; NULL where memory is out. */
static abbe_chart_series *add_series(series_list *list, size_t count, abbe_chart_style style,
                                     int colour, const char *label, double **x, double **y) {
  *x = make_numbers(list, count);
  *y = make_numbers(list, count);
  if (*x == NULL || *y == NULL) return NULL;
  abbe_chart_series *s = &list->series[list->count];
  if (label != NULL) snprintf(list->label[list->count], LABEL, "%s", label);
  *s = (abbe_chart_series){.label = label != NULL ? list->label[list->count] : NULL,
                           .style = style,
                           .count = count,
                           .x = *x,
                           .y = *y,
                           .colour = colour};
  list->count++;
  return s;
}

/* ---- n over wavelength ---- */

typedef struct sheet {
  const abbe_material_chart *chart;
  double from, to;
  series_list *curves, *residuals;
} sheet;

static int colour_of(size_t index) {
  return (int)(index % ABBE_CHART_COLOURS) + 1;
}

/* The curve over [from, to], where that is a range at all. */
static abbe_result add_curve(sheet *s, const abbe_dispersion *d, double from, double to,
                             abbe_chart_style style, int colour, const char *label,
                             abbe_error *error) {
  double *x, *y;
  from = fmax(from, s->from);
  to = fmin(to, s->to);
  if (!(from < to)) return ABBE_OK;
  if (add_series(s->curves, STEPS + 1, style, colour, label, &x, &y) == NULL)
    return no_memory(error);
  for (int i = 0; i <= STEPS; i++) {
    x[i] = from + (to - from) * i / STEPS;
    y[i] = abbe_dispersion_n(d, x[i]);
  }
  return ABBE_OK;
}

/* n and k of a conductor, in a colour each. */
static abbe_result add_conductor(sheet *s, size_t index, abbe_error *error) {
  const abbe_material *m = s->chart->material[index];
  double from = fmax(m->min_nm, s->from), to = fmin(m->max_nm, s->to), *x, *y;
  for (int which = 0; which < 2 && from < to; which++) {
    char label[LABEL];
    snprintf(label, sizeof label, "%s, %c", m->name, which == 0 ? 'n' : 'k');
    int colour = colour_of(which == 0 ? index : s->chart->count + index);
    if (add_series(s->curves, STEPS + 1, ABBE_CHART_LINE, colour, label, &x, &y) == NULL)
      return no_memory(error);
    for (int i = 0; i <= STEPS; i++) {
      double n = NAN, k = NAN;
      x[i] = from + (to - from) * i / STEPS;
      abbe_dispersion_nk(&m->dispersion, x[i], &n, &k);
      y[i] = which == 0 ? n : k;
    }
  }
  return ABBE_OK;
}

static abbe_result add_material(sheet *s, size_t index, abbe_error *error) {
  const abbe_material *m = s->chart->material[index];
  if (abbe_material_is_conductor(m)) return add_conductor(s, index, error);
  int colour = colour_of(index);
  ABBE_TRY(
      add_curve(s, &m->dispersion, m->min_nm, m->max_nm, ABBE_CHART_LINE, colour, m->name, error));
  if (!m->extrapolate) return ABBE_OK;
  ABBE_TRY(
      add_curve(s, &m->dispersion, s->from, m->min_nm, ABBE_CHART_DASHED, colour, NULL, error));
  return add_curve(s, &m->dispersion, m->max_nm, s->to, ABBE_CHART_DASHED, colour, NULL, error);
}

static abbe_result add_fit(sheet *s, size_t index, int which, abbe_error *error) {
  const abbe_material *m = s->chart->material[index];
  const abbe_material_fit *fit = &m->fit[which];
  abbe_dispersion d = abbe_material_fit_dispersion(fit);
  double *x, *y, from = fmax(fit->min_nm, s->from), to = fmin(fit->max_nm, s->to);
  char label[LABEL];
  bool alone = s->chart->count == 1;
  if (d.count == 0 || !(from < to)) return ABBE_OK;
  /* one material: a colour a fit; several: a colour a material, dashes for the fits */
  int colour = alone ? which + 2 : colour_of(index);
  snprintf(label, sizeof label, "%s%sCauchy, %zu terms", alone ? "" : m->name, alone ? "" : ": ",
           fit->terms);
  if (alone) ABBE_TRY(add_curve(s, &d, from, to, ABBE_CHART_DASHED, colour, label, error));
  abbe_chart_style style = !alone && which == 0 ? ABBE_CHART_DASHED : ABBE_CHART_LINE;
  if (add_series(s->residuals, STEPS + 1, style, colour, label, &x, &y) == NULL)
    return no_memory(error);
  for (int i = 0; i <= STEPS; i++) {
    x[i] = from + (to - from) * i / STEPS;
    double n = 0;
    bool known = abbe_material_n(m, x[i], &n, NULL) == ABBE_OK;
    y[i] = known ? n - abbe_dispersion_n(&d, x[i]) : NAN;
  }
  return ABBE_OK;
}

static abbe_result add_points(sheet *s, abbe_error *error) {
  const abbe_index_points *p = s->chart->points;
  const abbe_material *m = s->chart->material[0];
  for (int panel = 0; panel < 2; panel++) {
    double *x, *y, *low = NULL, *high = NULL;
    series_list *list = panel == 0 ? s->curves : s->residuals;
    char label[LABEL];
    snprintf(label, sizeof label, panel == 0 ? "measured" : "measured − %s", m->name);
    abbe_chart_series *q = add_series(list, p->count, ABBE_CHART_POINTS, 7, label, &x, &y);
    if (p->uncertainty != NULL) low = make_numbers(list, p->count);
    if (p->uncertainty != NULL) high = make_numbers(list, p->count);
    if (q == NULL || (p->uncertainty != NULL && (low == NULL || high == NULL)))
      return no_memory(error);
    for (size_t i = 0; i < p->count; i++) {
      double n = 0;
      x[i] = p->lambda_nm[i];
      y[i] = p->n[i];
      if (panel == 1 && abbe_material_n(m, x[i], &n, NULL) != ABBE_OK) n = NAN;
      y[i] -= n;
      if (low == NULL || high == NULL) continue;
      low[i] = y[i] - p->uncertainty[i];
      high[i] = y[i] + p->uncertainty[i];
    }
    q->low = low;
    q->high = high;
  }
  return ABBE_OK;
}

static abbe_result add_all(sheet *s, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < s->chart->count && result == ABBE_OK; i++)
    result = add_material(s, i, error);
  if (result == ABBE_OK && s->curves->count == 0)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "%s has no index from %g to %g nm: its data reach from %g to %g nm",
                          s->chart->material[0]->name, s->from, s->to,
                          s->chart->material[0]->min_nm, s->chart->material[0]->max_nm);
  for (size_t i = 0; i < s->chart->count && s->chart->fits; i++)
    for (int which = 0; which < 2 && result == ABBE_OK; which++)
      result = add_fit(s, i, which, error);
  if (result == ABBE_OK && s->chart->points != NULL) result = add_points(s, error);
  return result;
}

/* What one material alone leaves open at either end of the picture. */
static size_t shade(const sheet *s, abbe_chart_shade out[2]) {
  const abbe_material *m = s->chart->material[0];
  size_t count = 0;
  if (s->chart->count != 1) return 0;
  const char *label = m->extrapolate ? "beyond the data" : "no data";
  if (m->min_nm > s->from) out[count++] = (abbe_chart_shade){s->from, m->min_nm, false, label};
  if (!(m->max_nm < s->to)) return count;
  out[count] = (abbe_chart_shade){m->max_nm, s->to, false, count == 0 ? label : NULL};
  return count + 1;
}

/* What the data vouch for decides the height; what is continued may add its own height again, so
 * that a pole does not press the rest flat. */
static void fit_height(const series_list *list, abbe_chart_axis *y) {
  double low = INFINITY, high = -INFINITY, span = 0;
  for (int round = 0; round < 2; round++) {
    double least = low - span, most = high + span; /* used in the second round */
    for (size_t k = 0; k < list->count; k++) {
      const abbe_chart_series *s = &list->series[k];
      if ((s->style == ABBE_CHART_DASHED) != (round == 1)) continue;
      for (size_t i = 0; i < s->count; i++) {
        if (!isfinite(s->y[i])) continue;
        low = fmin(low, round == 0 ? s->y[i] : fmax(s->y[i], least));
        high = fmax(high, round == 0 ? s->y[i] : fmin(s->y[i], most));
      }
    }
    span = high - low;
  }
  if (!(span > 0)) return; /* flat, or nothing but continued: as the chart has it */
  y->min = low - 0.05 * span;
  y->max = high + 0.05 * span;
}

static abbe_result write_sheet(const char *path, sheet *s, abbe_error *error) {
  abbe_chart_shade shades[2];
  const abbe_material_chart *c = s->chart;
  const abbe_material *m = c->material[0];
  char title[LABEL];
  snprintf(title, sizeof title, "%s",
           c->count > 1             ? "Refractive index"
           : m->description != NULL ? m->description
                                    : m->name);
  bool below = s->residuals->count > 0;
  abbe_chart_axis y = {.label = "n"};
  for (size_t i = 0; i < c->count; i++)
    if (abbe_material_is_conductor(c->material[i])) y.label = "n, k";
  if (c->points == NULL) fit_height(s->curves, &y);
  size_t shade_count = shade(s, shades);
  abbe_chart_axis x = {.label = "wavelength, nm", .min = s->from, .max = s->to}, bare = x;
  bare.label = NULL;
  abbe_chart panel[2] = {{.title = title,
                          .x = below ? bare : x,
                          .y = y,
                          .series_count = s->curves->count,
                          .series = s->curves->series,
                          .shade_count = shade_count,
                          .shade = shades},
                         {.x = x,
                          .y = {.label = c->points == NULL ? "n − fit" : "difference of n"},
                          .series_count = s->residuals->count,
                          .series = s->residuals->series,
                          .share = 0.6}};
  return abbe_chart_write(path, panel, below ? 2 : 1, c->width, c->height, error);
}

abbe_result abbe_material_chart_write(const char *path, const abbe_material_chart *chart,
                                      abbe_error *error) {
  if (chart->count < 1 || chart->count > ABBE_MATERIAL_CHART_MAX)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu materials in one chart; 1 to %d fit",
                          chart->count, ABBE_MATERIAL_CHART_MAX);
  for (size_t i = 0; i < chart->count; i++)
    if (abbe_material_is_conductor(chart->material[i]) && (chart->fits || chart->points != NULL))
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s is a conductor: it has n and k, and no real index that fits and "
                            "measured indices are held against",
                            chart->material[i]->name);
  bool usual = chart->min_nm == 0 && chart->max_nm == 0;
  sheet s = {.chart = chart,
             .from = usual ? ABBE_WAVELENGTH_MIN_NM : chart->min_nm,
             .to = usual ? ABBE_WAVELENGTH_MAX_NM : chart->max_nm,
             .curves = calloc(1, sizeof *s.curves),
             .residuals = calloc(1, sizeof *s.residuals)};
  abbe_result result;
  if (s.curves == NULL || s.residuals == NULL)
    result = no_memory(error);
  else
    result = add_all(&s, error);
  if (result == ABBE_OK) result = write_sheet(path, &s, error);
  free_list(s.curves);
  free_list(s.residuals);
  return result;
}

/* ---- the map of glasses ---- */

typedef struct spots {
  bool partial;
  double *v_d, *y; /* n_d or P_gF */
  const char **name;
  size_t count, room;
} spots;

static bool add_spot(spots *s, const abbe_material *m) {
  abbe_material_numbers numbers;
  abbe_material_numbers_make(m, &numbers);
  const double y = s->partial ? numbers.p_gF : numbers.n_d;
  if (!isfinite(y) || !isfinite(numbers.v_d) || s->count == s->room) return false;
  s->v_d[s->count] = numbers.v_d;
  s->y[s->count] = y;
  s->name[s->count++] = m->name;
  return true;
}

static bool make_spots(spots *s, size_t room, bool partial) {
  *s = (spots){partial,
               calloc(room + 1, sizeof(double)),
               calloc(room + 1, sizeof(double)),
               calloc(room + 1, sizeof(char *)),
               0,
               room};
  return s->v_d != NULL && s->y != NULL && s->name != NULL;
}

static void free_spots(spots *s) {
  free(s->v_d);
  free(s->y);
  free(s->name);
}

static abbe_result write_map(const char *path, const abbe_material_map *map, spots *s,
                             abbe_error *error) {
  abbe_chart_series series[ABBE_MATERIAL_MAP_MAX_TABLES + 1];
  size_t count = 0, spots_count = 0;
  for (size_t i = 0; i <= map->table_count; i++) { /* the highlighted ones last, on top */
    bool marked = i == map->table_count;
    if (s[i].count == 0) continue;
    spots_count += s[i].count;
    series[count++] =
        (abbe_chart_series){.label = marked                 ? "marked"
                                     : map->table_count > 1 ? map->table[i]->path
                                                            : NULL,
                            .style = ABBE_CHART_POINTS,
                            .count = s[i].count,
                            .x = s[i].v_d,
                            .y = s[i].y,
                            .text = s[i].name,
                            .colour = marked   ? 2
                                      : i == 0 ? 1
                                               : (int)(i + 1) % ABBE_CHART_COLOURS + 1};
  }
  if (spots_count == 0)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the table '%.100s' has no material with an n_d and a finite V_d",
                          map->table[0]->path);
  abbe_chart chart = {.title = "Glass map",
                      .x = {.label = "Abbe number V_d", .reversed = true},
                      .y = {.label = map->partial ? "P_gF" : "n_d"},
                      .series_count = count,
                      .series = series};
  return abbe_chart_write(path, &chart, 1, map->width, map->height, error);
}

/* Highlighted materials are not drawn a second time in their table's colour. */
static bool is_marked(const abbe_material_map *map, const abbe_material *m) {
  for (size_t i = 0; i < map->marked_count; i++)
    if (map->marked[i] == m) return true;
  return false;
}

abbe_result abbe_material_map_write(const char *path, const abbe_material_map *map,
                                    size_t *left_out, abbe_error *error) {
  if (map->table_count < 1 || map->table_count > ABBE_MATERIAL_MAP_MAX_TABLES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu tables in one map; 1 to %d fit",
                          map->table_count, ABBE_MATERIAL_MAP_MAX_TABLES);
  spots s[ABBE_MATERIAL_MAP_MAX_TABLES + 1] = {0};
  size_t missing = 0;
  bool good = make_spots(&s[map->table_count], map->marked_count, map->partial);
  for (size_t i = 0; i < map->table_count && good; i++) {
    const abbe_material_table *t = map->table[i];
    good = make_spots(&s[i], t->count, map->partial);
    for (size_t k = 0; k < t->count && good; k++)
      if (!is_marked(map, &t->material[k]) && !abbe_material_is_conductor(&t->material[k]))
        missing += !add_spot(&s[i], &t->material[k]);
  }
  for (size_t i = 0; i < map->marked_count && good; i++)
    missing += !add_spot(&s[map->table_count], map->marked[i]);
  if (left_out != NULL) *left_out = missing;
  const abbe_result result = good ? write_map(path, map, s, error) : no_memory(error);
  for (size_t i = 0; i <= map->table_count; i++) free_spots(&s[i]);
  return result;
}
