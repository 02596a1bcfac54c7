#include "spectral/materials/table_compare.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *abbe_row_part_name(abbe_row_part part) {
  static const char *const names[] = {
#define ABBE_ROW_PART_NAME(code, name) name,
      ABBE_ROW_PARTS(ABBE_ROW_PART_NAME)
#undef ABBE_ROW_PART_NAME
  };
  return (unsigned)part < ABBE_ROW_PART_COUNT ? names[part] : "unknown";
}

/* ---- two rows ---- */

static bool same_text(const char *a, const char *b) {
  return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

static bool same_number(double a, double b) {
  return a == b || (isnan(a) && isnan(b));
}

static bool same_numbers(const double *a, const double *b, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!same_number(a[i], b[i])) return false;
  return true;
}

static bool same_points(const abbe_spectrum *a, const abbe_spectrum *b) {
  if (a == NULL || b == NULL) return a == b;
  size_t count = abbe_spectrum_count(a);
  if (count != abbe_spectrum_count(b)) return false;
  return same_numbers(abbe_spectrum_lambda_nm(a), abbe_spectrum_lambda_nm(b), count) &&
         same_numbers(abbe_spectrum_value(a), abbe_spectrum_value(b), count) &&
         /* the same points, joined differently */
         same_number(abbe_spectrum_integral(a, 1, 1e6), abbe_spectrum_integral(b, 1, 1e6));
}

static bool same_fits(const abbe_material *a, const abbe_material *b) {
  for (int i = 0; i < 2; i++) {
    const abbe_material_fit *p = &a->fit[i], *q = &b->fit[i];
    if (p->terms != q->terms || !same_numbers(p->c, q->c, p->terms)) return false;
    if (p->terms > 0 &&
        (p->max_error != q->max_error || p->min_nm != q->min_nm || p->max_nm != q->max_nm))
      return false;
  }
  return true;
}

static bool same_catalogue(const abbe_material_catalogue *a, const abbe_material_catalogue *b) {
  return same_text(a->code, b->code) && same_text(a->status, b->status) &&
         a->melt_frequency == b->melt_frequency && a->density_g_cm3 == b->density_g_cm3 &&
         same_numbers(a->expansion_per_k, b->expansion_per_k, 2) &&
         same_numbers(a->expansion_range_k, b->expansion_range_k, 4) && a->dpgf == b->dpgf &&
         same_numbers(a->thermal, b->thermal, 6) && a->rating_count == b->rating_count &&
         same_numbers(a->ratings, b->ratings, a->rating_count);
}

static bool same_index(const abbe_dispersion *a, const abbe_dispersion *b) {
  return a->model == b->model && a->count == b->count && same_numbers(a->c, b->c, a->count) &&
         same_points(a->table, b->table);
}

static unsigned parts_of(const abbe_material *a, const abbe_material *b) {
  const abbe_dispersion *p = &a->dispersion, *q = &b->dispersion;
  const bool same[ABBE_ROW_PART_COUNT] = {
      [ABBE_ROW_PART_DESCRIPTION] = same_text(a->description, b->description),
      [ABBE_ROW_PART_MODEL] = p->model == q->model,
      [ABBE_ROW_PART_COEFFICIENTS] = p->count == q->count && same_numbers(p->c, q->c, p->count),
      [ABBE_ROW_PART_POINTS] = same_points(p->table, q->table) && same_points(p->k, q->k),
      [ABBE_ROW_PART_RANGE] = a->min_nm == b->min_nm && a->max_nm == b->max_nm,
      [ABBE_ROW_PART_EXTRAORDINARY] = same_index(&a->extraordinary, &b->extraordinary) &&
                                      same_index(&a->outer[0], &b->outer[0]) &&
                                      same_index(&a->outer[1], &b->outer[1]),
      [ABBE_ROW_PART_EXTRAPOLATE] = a->extrapolate == b->extrapolate,
      [ABBE_ROW_PART_TEMPERATURE] = same_number(a->temperature_c, b->temperature_c),
      [ABBE_ROW_PART_ABSOLUTE] = a->n_absolute == b->n_absolute,
      [ABBE_ROW_PART_PUBLISHED] =
          a->published_n_d == b->published_n_d && a->published_v_d == b->published_v_d,
      [ABBE_ROW_PART_SOURCE] = same_text(a->source, b->source),
      [ABBE_ROW_PART_WARNING] = same_text(a->warning, b->warning),
      [ABBE_ROW_PART_COMMENT] = same_text(a->comment, b->comment),
      [ABBE_ROW_PART_ABSORPTION] = same_points(a->attenuation, b->attenuation) &&
                                   same_points(a->attenuation_yz[0], b->attenuation_yz[0]) &&
                                   same_points(a->attenuation_yz[1], b->attenuation_yz[1]),
      [ABBE_ROW_PART_FLUORESCENCE] =
          a->fluorescence.yield == b->fluorescence.yield &&
          same_points(a->fluorescence.excitation, b->fluorescence.excitation) &&
          same_points(a->fluorescence.emission, b->fluorescence.emission),
      [ABBE_ROW_PART_CATALOGUE] = same_catalogue(&a->catalogue, &b->catalogue),
      [ABBE_ROW_PART_FIT] = same_fits(a, b),
  };
  unsigned parts = 0;
  for (unsigned i = 0; i < ABBE_ROW_PART_COUNT; i++) parts |= same[i] ? 0 : 1u << i;
  return parts;
}

static const unsigned CURVE = 1u << ABBE_ROW_PART_MODEL | 1u << ABBE_ROW_PART_COEFFICIENTS |
                              1u << ABBE_ROW_PART_POINTS | 1u << ABBE_ROW_PART_RANGE;

static abbe_row_difference compare_rows(const abbe_material *a, const abbe_material *b) {
  abbe_row_difference row = {
      .first = a, .second = b, .parts = parts_of(a, b), .min_nm = NAN, .max_nm = NAN};
  row.index = (abbe_index_difference){NAN, NAN, NAN, NAN};
  row.kind = row.parts == 0 ? ABBE_ROW_SAME : ABBE_ROW_CHANGED;
  double low = fmax(a->min_nm, b->min_nm), high = fmin(a->max_nm, b->max_nm);
  abbe_index_difference index;
  if (low < high && abbe_index_difference_of_curves(&b->dispersion, &a->dispersion, low, high,
                                                    &index, NULL) == ABBE_OK) {
    row.min_nm = low;
    row.max_nm = high;
    row.index = index;
  }
  return row;
}

/* ---- two tables ---- */

static int by_name(const void *a, const void *b) {
  const abbe_material *const *p = a, *const *q = b;
  return strcasecmp((*p)->name, (*q)->name);
}

/* The curve's own numbers first: whoever has them all has the curve. */
static int by_curve(const void *a, const void *b) {
  const abbe_material *p = *(const abbe_material *const *)a, *q = *(const abbe_material *const *)b;
  const abbe_dispersion *d = &p->dispersion, *e = &q->dispersion;
  if (d->model != e->model) return d->model < e->model ? -1 : 1;
  if (d->count != e->count) return d->count < e->count ? -1 : 1;
  for (size_t i = 0; i < d->count; i++)
    if (d->c[i] != e->c[i]) return d->c[i] < e->c[i] ? -1 : 1;
  if (p->min_nm != q->min_nm) return p->min_nm < q->min_nm ? -1 : 1;
  return (p->max_nm > q->max_nm) - (p->max_nm < q->max_nm);
}

/* A row of the second table that no row has been matched with yet, and that order finds equal. */
static const abbe_material **find(const abbe_material *wanted, const abbe_material **sorted,
                                  size_t count, int (*order)(const void *, const void *)) {
  return bsearch(&wanted, sorted, count, sizeof *sorted, order);
}

static void compare(const abbe_material_table *first, const abbe_material_table *second,
                    const abbe_material **sorted, bool *taken, abbe_table_difference *out) {
  size_t count = second->count;
  for (size_t i = 0; i < count; i++) sorted[i] = &second->material[i];
  qsort(sorted, count, sizeof *sorted, by_name);
  for (size_t i = 0; i < first->count; i++) {
    const abbe_material *m = &first->material[i], **match = find(m, sorted, count, by_name);
    out->row[out->count] = (abbe_row_difference){.kind = ABBE_ROW_ONLY_IN_FIRST, .first = m};
    if (match != NULL) {
      out->row[out->count] = compare_rows(m, *match);
      taken[*match - second->material] = true;
    }
    out->count++;
  }
  size_t left = 0;
  for (size_t i = 0; i < count; i++)
    if (!taken[i]) sorted[left++] = &second->material[i];
  qsort(sorted, left, sizeof *sorted, by_curve);
  for (size_t i = 0; i < out->count && left > 0; i++) {
    if (out->row[i].kind != ABBE_ROW_ONLY_IN_FIRST) continue;
    const abbe_material **match = find(out->row[i].first, sorted, left, by_curve);
    if (match == NULL || taken[*match - second->material]) continue;
    abbe_row_difference row = compare_rows(out->row[i].first, *match);
    if ((row.parts & CURVE) != 0) continue; /* tabulated, with other points */
    row.kind = ABBE_ROW_RENAMED;
    taken[*match - second->material] = true;
    out->row[i] = row;
  }
  for (size_t i = 0; i < count; i++)
    if (!taken[i])
      out->row[out->count++] =
          (abbe_row_difference){.kind = ABBE_ROW_ONLY_IN_SECOND, .second = &second->material[i]};
}

abbe_result abbe_table_compare(const abbe_material_table *first, const abbe_material_table *second,
                               abbe_table_difference *out, abbe_error *error) {
  *out =
      (abbe_table_difference){.row = malloc((first->count + second->count + 1) * sizeof *out->row)};
  const abbe_material **sorted = malloc((second->count + 1) * sizeof *sorted);
  bool *taken = calloc(second->count + 1, sizeof *taken);
  bool good = out->row != NULL && sorted != NULL && taken != NULL;
  if (good) compare(first, second, sorted, taken, out);
  for (size_t i = 0; i < out->count; i++) {
    abbe_row_difference *row = &out->row[i];
    out->kinds[row->kind]++;
    if (row->first != NULL && row->second != NULL) continue;
    row->min_nm = row->max_nm = NAN;
    row->index = (abbe_index_difference){NAN, NAN, NAN, NAN};
  }
  free(sorted);
  free(taken);
  if (good) return ABBE_OK;
  abbe_table_difference_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to compare two tables");
}

void abbe_table_difference_free(abbe_table_difference *difference) {
  if (difference == NULL) return;
  free(difference->row);
  *difference = (abbe_table_difference){0};
}
