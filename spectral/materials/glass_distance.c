#include "spectral/materials/glass_distance.h"

#include "spectral/dispersion/index_points.h"
#include "spectral/materials/material_numbers.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>

void abbe_glass_distances_free(abbe_glass_distances *distances) {
  if (distances == NULL) return;
  free(distances->nearest);
  *distances = (abbe_glass_distances){0};
}

static int by_distance(const void *a, const void *b) {
  const abbe_glass_distance *x = a, *y = b;
  if (x->rms != y->rms) return x->rms < y->rms ? -1 : 1;
  return x->index < y->index ? -1 : x->index > y->index;
}

static abbe_result open_list(const abbe_material_table *table, abbe_glass_distances *out,
                             abbe_error *error) {
  *out = (abbe_glass_distances){0};
  out->nearest = calloc(table->count + 1, sizeof *out->nearest);
  if (out->nearest != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu distances", table->count);
}

static void close_list(abbe_glass_distances *out, size_t wanted) {
  qsort(out->nearest, out->count, sizeof *out->nearest, by_distance);
  if (wanted > 0 && out->count > wanted) out->count = wanted;
}

/* ---- by numbers ---- */

/* n = n_d + spread (x - x_d) / (x_F - x_C), x = 1 / L^2: mean and mean square of its second factor
 * over the wavelengths from 380 to 780 nm, so that a distance is a form in the two differences. */
typedef struct shape {
  double mean, square;
} shape;

static double x_of(double lambda_nm) {
  return 1 / (lambda_nm * lambda_nm);
}

static shape shape_of_cauchy(void) {
  shape s = {0};
  double unit = x_of(ABBE_LINE_F_NM) - x_of(ABBE_LINE_C_NM);
  int count = 0;
  for (double l = ABBE_WAVELENGTH_MIN_NM; l <= ABBE_WAVELENGTH_MAX_NM; l += 1, count++) {
    double value = (x_of(l) - x_of(ABBE_LINE_D_NM)) / unit;
    s.mean += value;
    s.square += value * value;
  }
  return (shape){s.mean / count, s.square / count};
}

abbe_result abbe_glass_distance_to_numbers(const abbe_material_table *table, double n_d, double v_d,
                                           size_t wanted, abbe_glass_distances *out,
                                           abbe_error *error) {
  *out = (abbe_glass_distances){0};
  if (!(n_d > 1) || !isfinite(n_d) || !(v_d > 0))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "n_d %g and V_d %g are not those of a glass; n_d is above 1 and V_d above "
        "0, such as 1.5168 and 64.17",
        n_d, v_d);
  abbe_result result = open_list(table, out, error);
  if (result != ABBE_OK) return result;
  shape s = shape_of_cauchy();
  for (size_t i = 0; i < table->count; i++) {
    abbe_material_numbers m;
    abbe_material_numbers_make(&table->material[i], &m);
    if (abbe_material_is_conductor(&table->material[i])) continue;
    double shift = m.n_d - n_d, spread = (m.n_F - m.n_C) - (n_d - 1) / v_d;
    double square = shift * shift + 2 * shift * spread * s.mean + spread * spread * s.square;
    if (isnan(square)) {
      out->skipped++;
      continue;
    }
    out->nearest[out->count++] =
        (abbe_glass_distance){i, sqrt(fmax(square, 0)), NAN, NAN, m.n_d, m.v_d};
  }
  close_list(out, wanted);
  return ABBE_OK;
}

/* ---- by the curve ---- */

abbe_result abbe_glass_distance_to_points(const abbe_material_table *table,
                                          const abbe_index_points *points, size_t wanted,
                                          abbe_glass_distances *out, abbe_error *error) {
  *out = (abbe_glass_distances){0};
  if (points->count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there are no points to compare with");
  abbe_result result = open_list(table, out, error);
  if (result != ABBE_OK) return result;
  double low = points->lambda_nm[0], high = points->lambda_nm[points->count - 1];
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    if (abbe_material_is_conductor(m)) continue;
    abbe_index_difference d;
    bool beyond = abbe_material_extrapolates(m, low) || abbe_material_extrapolates(m, high);
    if ((beyond && !m->extrapolate) ||
        abbe_index_difference_of_points(&m->dispersion, points, low, high, &d, NULL) != ABBE_OK) {
      out->skipped++;
      continue;
    }
    abbe_material_numbers numbers;
    abbe_material_numbers_make(m, &numbers);
    out->nearest[out->count++] =
        (abbe_glass_distance){i, d.rms, d.max, d.max_nm, numbers.n_d, numbers.v_d};
  }
  close_list(out, wanted);
  return ABBE_OK;
}

abbe_result abbe_glass_distance_to_curve(const abbe_material_table *table,
                                         const abbe_dispersion *curve, double min_nm, double max_nm,
                                         size_t wanted, abbe_glass_distances *out,
                                         abbe_error *error) {
  *out = (abbe_glass_distances){0};
  abbe_index_points points;
  abbe_result result = abbe_index_points_sample(curve, min_nm, max_nm, 41, 401, &points, error);
  if (result == ABBE_OK) result = abbe_glass_distance_to_points(table, &points, wanted, out, error);
  abbe_index_points_free(&points);
  return result;
}
