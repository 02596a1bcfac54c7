#include "spectral/materials/partners.h"

#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>
#include <strings.h>

/* Catalogues of two makers, and of two years, print the same glass to this. */
#define SAME_N 5e-6

/* Cauchy's first two terms have one P_gF, whatever they are of. */
static bool usable(const abbe_material *m, abbe_material_numbers *out) {
  abbe_material_numbers_make(m, out);
  if (m->dispersion.model == ABBE_DISPERSION_CAUCHY && m->dispersion.count < 3) return false;
  return !abbe_material_is_conductor(m) && !abbe_material_is_crystal(m) && isfinite(out->v_d) &&
         isfinite(out->p_gF);
}

/* Power of the lenses at a line, from their indices there and at d. */
static double power_at(const double power[3], const double n[3], const double n_d[3]) {
  double sum = 0;
  for (int i = 0; i < 3; i++)
    if (power[i] < 0 || power[i] > 0) sum += power[i] * (n[i] - 1) / (n_d[i] - 1);
  return sum;
}

/* Powers p with sum 1 and sum p / V = 0, of three also sum p P_gF / V = 0: across both rows. */
static void combine(const abbe_material_numbers *glass, const abbe_material_numbers *third,
                    abbe_glass_partner *p) {
  const abbe_material_numbers *const of[3] = {glass, &p->numbers, third};
  const int count = third != NULL ? 3 : 2;
  double a[3] = {0}, b[3] = {0, 0, 1}, n_d[3] = {0}, n_F[3] = {0}, n_x[3] = {0}, sum = 0;
  for (int i = 0; i < count; i++) {
    a[i] = 1 / of[i]->v_d;
    if (count == 3) b[i] = of[i]->p_gF / of[i]->v_d;
    n_d[i] = of[i]->n_d;
    n_F[i] = of[i]->n_F;
    n_x[i] = count == 3 ? of[i]->n_d : of[i]->n_g;
  }
  for (int i = 0; i < 3; i++) {
    const int k = (i + 1) % 3, l = (i + 2) % 3;
    p->power[i] = a[k] * b[l] - a[l] * b[k];
    sum += p->power[i];
  }
  for (int i = 0; i < 3; i++) {
    p->power[i] /= sum;
    p->power_sum += fabs(p->power[i]);
  }
  p->secondary = 1 / power_at(p->power, n_x, n_d) - 1 / power_at(p->power, n_F, n_d);
}

static int by_secondary(const void *a, const void *b) {
  const abbe_glass_partner *p = a, *q = b;
  const double s = fabs(p->secondary), t = fabs(q->secondary);
  if (s < t || s > t) return s < t ? -1 : 1;
  return (p->power_sum > q->power_sum) - (p->power_sum < q->power_sum);
}

static bool same_glass(const abbe_material_numbers *a, const abbe_material_numbers *b) {
  return fabs(a->n_d - b->n_d) < SAME_N && fabs(a->n_F - b->n_F) < SAME_N &&
         fabs(a->n_C - b->n_C) < SAME_N && fabs(a->n_g - b->n_g) < SAME_N;
}

/* How well a catalogue speaks for it: for sale, then of unknown status, then obsolete; of these
 * what has a cost. */
static int standing(const abbe_material *m) {
  const abbe_material_catalogue *c = &m->catalogue;
  const bool cost = c->rating_count > 0 && c->ratings[0] > 0;
  const int status = c->status == NULL ? 1 : strcasecmp(c->status, "obsolete") == 0 ? 0 : 2;
  return 2 * status + cost;
}

static void join_doubles(abbe_glass_partners *p) {
  size_t kept = 0;
  for (size_t i = 0; i < p->count; i++) {
    size_t k = 0;
    while (k < kept && !same_glass(&p->partner[k].numbers, &p->partner[i].numbers)) k++;
    if (k == kept) {
      p->partner[kept++] = p->partner[i];
      continue;
    }
    const size_t doubles = p->partner[k].doubles + 1;
    if (standing(p->partner[i].material) > standing(p->partner[k].material))
      p->partner[k] = p->partner[i];
    p->partner[k].doubles = doubles;
  }
  p->count = kept;
  qsort(p->partner, p->count, sizeof *p->partner, by_secondary);
}

abbe_result abbe_glass_partners_find(const abbe_material_table *table, const abbe_material *glass,
                                     const abbe_material *third, double most_power,
                                     abbe_glass_partners *out, abbe_error *error) {
  abbe_material_numbers own, with;
  *out = (abbe_glass_partners){0};
  const abbe_material *wrong = !usable(glass, &own)                     ? glass
                               : third != NULL && !usable(third, &with) ? third
                                                                        : NULL;
  if (wrong != NULL)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE, "%s has no single index with a V_d and a P_gF",
                          wrong->name);
  if (third != NULL && same_glass(&own, &with))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s and %s are one glass, and three lenses take three", glass->name,
                          third->name);
  out->partner = calloc(table->count + 1, sizeof *out->partner);
  if (out->partner == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu glasses", table->count);
  for (size_t i = 0; i < table->count; i++) {
    abbe_glass_partner p = {.material = &table->material[i]};
    if (!usable(p.material, &p.numbers)) {
      out->skipped += !abbe_material_is_conductor(p.material);
      continue;
    }
    combine(&own, third != NULL ? &with : NULL, &p);
    if (p.power_sum <= most_power) out->partner[out->count++] = p;
  }
  qsort(out->partner, out->count, sizeof *out->partner, by_secondary);
  join_doubles(out);
  return ABBE_OK;
}

void abbe_glass_partners_free(abbe_glass_partners *partners) {
  free(partners->partner);
  *partners = (abbe_glass_partners){0};
}

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
  ABBE_TRY(open_list(table, out, error));
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
  ABBE_TRY(open_list(table, out, error));
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
  ABBE_OWNED(abbe_index_points, points) = {0};
  ABBE_TRY(abbe_index_points_sample(curve, min_nm, max_nm, 41, 401, &points, error));
  return abbe_glass_distance_to_points(table, &points, wanted, out, error);
}
