/* same_material.h: whether two records say the same, for round trips. */
#ifndef ABBE_TESTS_SPECTRAL_SAME_MATERIAL_H
#define ABBE_TESTS_SPECTRAL_SAME_MATERIAL_H

#include "tests/check.h"

#include "spectral/materials/material.h"

static inline bool same_text(const char *a, const char *b) {
  return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

static inline bool same_number(double a, double b, double relative) {
  if (isnan(a) || isnan(b)) return isnan(a) && isnan(b);
  return fabs(a - b) <= relative * fmax(fabs(a), fabs(b));
}

static inline bool same_numbers(const double *a, const double *b, size_t count, double relative) {
  for (size_t i = 0; i < count; i++)
    if (!same_number(a[i], b[i], relative)) return false;
  return true;
}

static inline bool same_spectrum(const abbe_spectrum *a, const abbe_spectrum *b, double relative) {
  if (a == NULL || b == NULL) return a == b;
  size_t count = abbe_spectrum_count(a);
  return count == abbe_spectrum_count(b) &&
         (abbe_spectrum_interpolation(a) == abbe_spectrum_interpolation(b)) &&
         same_numbers(abbe_spectrum_lambda_nm(a), abbe_spectrum_lambda_nm(b), count, 1e-15) &&
         same_numbers(abbe_spectrum_value(a), abbe_spectrum_value(b), count, relative);
}

/* Terms of a polynomial whose coefficient is 0 say nothing. */
static inline abbe_dispersion without_zero_terms(const abbe_dispersion *d) {
  abbe_dispersion made = *d;
  if (d->model != ABBE_DISPERSION_POLYNOMIAL) return made;
  made.count = 1;
  for (size_t k = 1; k + 1 < d->count; k += 2) {
    if (d->c[k] == 0) continue;
    made.c[made.count++] = d->c[k];
    made.c[made.count++] = d->c[k + 1];
  }
  return made;
}

static inline bool same_dispersion(const abbe_dispersion *p, const abbe_dispersion *q) {
  abbe_dispersion a = without_zero_terms(p), b = without_zero_terms(q);
  return a.model == b.model && a.count == b.count && same_numbers(a.c, b.c, a.count, 0) &&
         same_spectrum(a.table, b.table, 0);
}

static inline bool same_catalogue(const abbe_material_catalogue *a,
                                  const abbe_material_catalogue *b) {
  return same_text(a->code, b->code) && same_text(a->status, b->status) &&
         a->melt_frequency == b->melt_frequency && a->density_g_cm3 == b->density_g_cm3 &&
         same_numbers(a->expansion_per_k, b->expansion_per_k, 2, 0) &&
         same_numbers(a->expansion_range_k, b->expansion_range_k, 4, 0) && a->dpgf == b->dpgf &&
         same_numbers(a->thermal, b->thermal, 6, 0) && a->rating_count == b->rating_count &&
         same_numbers(a->ratings, b->ratings, a->rating_count, 0);
}

static inline bool same_fits(const abbe_material *a, const abbe_material *b) {
  for (int i = 0; i < 2; i++) {
    const abbe_material_fit *p = &a->fit[i], *q = &b->fit[i];
    if (p->terms != q->terms) return false;
    if (p->terms > 0 && (!same_numbers(p->c, q->c, p->terms, 0) || p->max_error != q->max_error ||
                         p->min_nm != q->min_nm || p->max_nm != q->max_nm))
      return false;
  }
  return true;
}

static inline void check_same(bool same, const char *what, const char *name, const char *file,
                              int line) {
  if (same) return;
  print_error("%s: its %s differs\n", name, what);
  _fail(file, line);
}

/* Everything that a catalogue and a table both carry; attenuation to the given relative error. */
static inline void check_carried(const abbe_material *a, const abbe_material *b, double relative,
                                 const char *file, int line) {
  check_same(same_text(a->name, b->name), "name", a->name, file, line);
  check_same(same_dispersion(&a->dispersion, &b->dispersion), "dispersion", a->name, file, line);
  check_same(a->min_nm == b->min_nm && a->max_nm == b->max_nm, "range", a->name, file, line);
  check_same(same_number(a->temperature_c, b->temperature_c, 0), "temperature", a->name, file,
             line);
  check_same(same_text(a->source, b->source), "source", a->name, file, line);
  check_same(same_text(a->comment, b->comment), "comment", a->name, file, line);
  check_same(same_spectrum(a->attenuation, b->attenuation, relative), "absorption", a->name, file,
             line);
  check_same(same_catalogue(&a->catalogue, &b->catalogue), "catalogue", a->name, file, line);
}
#define assert_carried(a, b, relative) check_carried(a, b, relative, __FILE__, __LINE__)

/* Every field of the record. */
static inline void check_same_record(const abbe_material *a, const abbe_material *b,
                                     const char *file, int line) {
  check_carried(a, b, 0, file, line);
  check_same(same_text(a->description, b->description), "description", a->name, file, line);
  check_same(same_text(a->warning, b->warning), "warning", a->name, file, line);
  check_same(same_dispersion(&a->extraordinary, &b->extraordinary), "extraordinary index", a->name,
             file, line);
  for (int i = 0; i < 2; i++)
    check_same(same_spectrum(a->attenuation_yz[i], b->attenuation_yz[i], 0),
               "absorption along axes", a->name, file, line);
  for (int i = 0; i < 2; i++)
    check_same(same_dispersion(&a->outer[i], &b->outer[i]), "outer index", a->name, file, line);
  check_same(a->n_absolute == b->n_absolute, "n_absolute", a->name, file, line);
  check_same(a->extrapolate == b->extrapolate, "extrapolate", a->name, file, line);
  check_same(a->published_n_d == b->published_n_d && a->published_v_d == b->published_v_d,
             "n_d and V_d", a->name, file, line);
  check_same(same_fits(a, b), "fits", a->name, file, line);
}
#define assert_same_record(a, b) check_same_record(a, b, __FILE__, __LINE__)

#endif
