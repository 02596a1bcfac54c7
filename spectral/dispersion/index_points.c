#include "spectral/dispersion/index_points.h"

#include "base/file.h"
#include "spectral/dispersion/csv_points.h"

#include <math.h>
#include <stdlib.h>

enum { MAX_BYTES = 16 << 20 };

void abbe_index_points_free(abbe_index_points *points) {
  if (points == NULL) return;
  free(points->lambda_nm);
  free(points->n);
  free(points->uncertainty);
  *points = (abbe_index_points){0};
}

static abbe_result allocate(abbe_index_points *points, size_t count, bool uncertain,
                            abbe_error *error) {
  points->lambda_nm = calloc(count, sizeof(double));
  points->n = calloc(count, sizeof(double));
  if (uncertain) points->uncertainty = calloc(count, sizeof(double));
  if (points->lambda_nm != NULL && points->n != NULL && (points->uncertainty != NULL || !uncertain))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", count);
}

/* ---- of a formula ---- */

abbe_result abbe_index_points_sample(const abbe_dispersion *dispersion, double min_nm,
                                     double max_nm, size_t at_least, size_t at_most,
                                     abbe_index_points *out, abbe_error *error) {
  *out = (abbe_index_points){.exact = true};
  if (!isfinite(min_nm) || !isfinite(max_nm) || min_nm <= 0 || min_nm >= max_nm)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g:%g nm is not one, such as 380:780", min_nm, max_nm);
  if (at_least < 2 || at_most < at_least || at_most > ABBE_INDEX_POINTS_MAX_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu to %zu points of a formula are asked for; 2 to %d are possible",
                          at_least, at_most, ABBE_INDEX_POINTS_MAX_COUNT);
  double span = max_nm - min_nm;
  bool by_nm = ceil(span) + 1 >= (double)at_least && ceil(span) + 1 <= (double)at_most;
  size_t count = by_nm ? (size_t)ceil(span) + 1 : span < (double)at_least ? at_least : at_most;
  abbe_result result = allocate(out, count, false, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    double step = by_nm ? (double)i : span * (double)i / (double)(count - 1);
    out->lambda_nm[i] = i + 1 == count ? max_nm : min_nm + step;
    out->n[i] = abbe_dispersion_n(dispersion, out->lambda_nm[i]);
    if (isnan(out->n[i]))
      result =
          abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the %s formula has no real index at %g nm",
                         abbe_dispersion_model_name(dispersion->model), out->lambda_nm[i]);
  }
  out->count = count;
  if (result != ABBE_OK) abbe_index_points_free(out);
  return result;
}

/* ---- of a file ---- */

/* What an import may pass over would be a hole in a measurement. */
static abbe_result refuse_notes(const abbe_report *report, const char *name, abbe_error *error) {
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *note = &report->note[i];
    if (note->kind == ABBE_NOTE_SKIPPED)
      return abbe_error_set(error, ABBE_PARSE,
                            "%s:%zu: %s; a line is a wavelength, an index and, if known, its "
                            "uncertainty, such as 587.6, 1.5168, 0.00002",
                            name, note->line, note->text);
    if (note->kind == ABBE_NOTE_LOST)
      return abbe_error_set(error, ABBE_SCHEMA,
                            "%s: %s; a first line such as 'wavelength_um, n' names the unit", name,
                            note->text);
  }
  return ABBE_OK;
}

static abbe_result take(const abbe_points *points, const char *name, abbe_index_points *out,
                        abbe_error *error) {
  size_t uncertain = 0;
  for (size_t i = 0; i < points->count; i++) uncertain += points->point[i].error > 0;
  if (points->count == 0) return abbe_error_set(error, ABBE_SCHEMA, "%s has no indices", name);
  if (uncertain > 0 && uncertain < points->count)
    return abbe_error_set(
        error, ABBE_SCHEMA,
        "%s: %zu of %zu points have an uncertainty above 0; all have one, or none", name, uncertain,
        points->count);
  ABBE_TRY(allocate(out, points->count, uncertain > 0, error));
  out->count = points->count;
  for (size_t i = 0; i < points->count; i++) {
    out->lambda_nm[i] = points->point[i].lambda_nm;
    out->n[i] = points->point[i].value;
    if (uncertain > 0) out->uncertainty[i] = points->point[i].error;
  }
  return ABBE_OK;
}

abbe_result abbe_index_points_parse(const char *text, size_t size, const char *name,
                                    abbe_index_points *out, abbe_error *error) {
  *out = (abbe_index_points){0};
  const abbe_csv_options options = {.repeats = true};
  abbe_csv_points csv;
  abbe_report report = {0};
  abbe_error why = {0};
  abbe_result result = abbe_csv_points_parse(text, size, name, &options, &csv, &report, &why);
  abbe_result refused = refuse_notes(&report, name, error);
  /* a line that was passed over explains more than that nothing remained */
  if (result != ABBE_OK && refused == ABBE_OK) abbe_error_set(error, result, "%s", why.text);
  if (refused != ABBE_OK) result = refused;
  if (result == ABBE_OK) result = take(&csv.n, name, out, error);
  if (result != ABBE_OK) abbe_index_points_free(out);
  abbe_csv_points_free(&csv);
  abbe_report_free(&report);
  return result;
}

abbe_result abbe_index_points_load(const char *path, abbe_index_points *out, abbe_error *error) {
  *out = (abbe_index_points){0};
  ABBE_FREED char *text = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_file_read_text(path, MAX_BYTES, &text, &size, error));
  return abbe_index_points_parse(text, size, path, out, error);
}

abbe_result abbe_index_difference_of_points(const abbe_dispersion *a,
                                            const abbe_index_points *points, double min_nm,
                                            double max_nm, abbe_index_difference *out,
                                            abbe_error *error) {
  abbe_index_difference found = {.max = -1};
  size_t used = 0;
  for (size_t i = 0; i < points->count; i++) {
    double lambda_nm = points->lambda_nm[i];
    if (lambda_nm < min_nm || lambda_nm > max_nm) continue;
    double off = abbe_dispersion_n(a, lambda_nm) - points->n[i];
    if (isnan(off))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the %s formula has no real index at %g nm",
                            abbe_dispersion_model_name(a->model), lambda_nm);
    found.rms += off * off;
    found.mean += off;
    if (fabs(off) > found.max) {
      found.max = fabs(off);
      found.max_nm = lambda_nm;
    }
    used++;
  }
  if (used == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no point lies within %g:%g nm", min_nm,
                          max_nm);
  found.rms = sqrt(found.rms / (double)used);
  found.mean /= (double)used;
  *out = found;
  return ABBE_OK;
}

abbe_result abbe_index_difference_of_curves(const abbe_dispersion *a, const abbe_dispersion *b,
                                            double min_nm, double max_nm,
                                            abbe_index_difference *out, abbe_error *error) {
  ABBE_OWNED(abbe_index_points, points) = {0};
  ABBE_TRY(abbe_index_points_sample(b, min_nm, max_nm, 401, 4001, &points, error));
  return abbe_index_difference_of_points(a, &points, min_nm, max_nm, out, error);
}

/* 1/2 at the violet end, -1/2 at the red one. */
static double along(double lambda_nm) {
  return ((ABBE_POVRAY_VIOLET_NM + ABBE_POVRAY_RED_NM) / 2 - lambda_nm) /
         (ABBE_POVRAY_RED_NM - ABBE_POVRAY_VIOLET_NM);
}

double abbe_povray_index_at(const abbe_povray_index *index, double lambda_nm) {
  return index->ior * pow(index->dispersion, along(lambda_nm));
}

abbe_povray_index abbe_povray_index_fit(const double *lambda_nm, const double *n,
                                        const double *weight, size_t count) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < count; i++) {
    double w = weight != NULL ? weight[i] : 1, x = along(lambda_nm[i]), y = log(n[i]);
    s += w;
    sx += w * x;
    sy += w * y;
    sxx += w * x * x;
    sxy += w * x * y;
  }
  double spread = s * sxx - sx * sx;
  double slope = spread > 1e-12 * s * s ? (s * sxy - sx * sy) / spread : 0;
  if (fabs(slope) < 1e-12) slope = 0; /* rounding errors of a constant index */
  return (abbe_povray_index){exp((sy - slope * sx) / s), exp(slope)};
}
