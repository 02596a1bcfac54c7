#include "spectral/materials/partners.h"

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
