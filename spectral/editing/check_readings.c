/* Coefficients that make sense only when they are read in another way. A reading is taken where
 * the row as it stands is no transparent material, or is far from what is known of it, and the
 * other reading is near. */
#include "base/number.h"
#include "spectral/editing/check_parts.h"
#include "spectral/materials/partners.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>

/* How near is the same material: melts, temperatures and printed digits differ by less. */
static const double SAME_ND = 2e-3, SAME_VD = 0.02;
/* And how far is another, whichever the melt. */
static const double OTHER_ND = 5e-3;

/* No transparent material that is known has an Abbe number outside; rutile has 9.9, air 89. */
static const double LEAST_VD = 5, MOST_VD = 150;
/* Nor a greater index in the infrared: lead telluride has 5.9. */
static const double MOST_N = 8;

typedef struct reading {
  abbe_dispersion dispersion;
  double n_d, v_d; /* NaN where the row's range does not contain it */
  bool possible;   /* as a transparent material: n above 1, and falling */
  bool plausible;  /* with a usual V_d too, which single materials have not */
} reading;

/* Over what the row has of the visible; a row of another range is held against that. */
static reading read_as(const abbe_check *c, const abbe_dispersion *dispersion) {
  enum { STEPS = 40 };
  double low = fmax(c->low_nm, ABBE_WAVELENGTH_MIN_NM);
  double high = fmin(c->high_nm, ABBE_WAVELENGTH_MAX_NM), before = 5;
  abbe_dispersion_numbers numbers = abbe_dispersion_describe(dispersion);
  bool all = abbe_check_has(c, ABBE_LINE_F_NM) && abbe_check_has(c, ABBE_LINE_C_NM);
  reading r = {.dispersion = *dispersion,
               .n_d = abbe_check_has(c, ABBE_LINE_D_NM) ? numbers.n_d : NAN,
               .v_d = all ? numbers.v_d : NAN};
  r.possible = true;
  if (low >= high) low = c->low_nm, high = c->high_nm, before = MOST_N;
  for (int i = 0; i <= STEPS; i++) {
    double n = abbe_dispersion_n(dispersion, low * pow(high / low, (double)i / STEPS));
    if (!(n > 1 && n <= before)) r.possible = false;
    before = n;
  }
  r.plausible = r.possible && (!all || (r.v_d >= LEAST_VD && r.v_d <= MOST_VD));
  return r;
}

/* What the row should have, where its range allows: from its own source, else from its namesake;
 * NaN where unknown. */
typedef struct target {
  double n_d, v_d;
  const char *the, *whose; /* "the known " and its name, or "" and "its own source" */
} target;

static target target_of(const abbe_check *c) {
  bool spread = abbe_check_has(c, ABBE_LINE_F_NM) && abbe_check_has(c, ABBE_LINE_C_NM);
  if (abbe_check_has(c, ABBE_LINE_D_NM) && c->published.n_d > 1.0001)
    return (target){c->published.n_d, spread ? c->published.v_d : NAN, "", "its own source"};
  if (abbe_check_has(c, ABBE_LINE_D_NM) && c->namesake != NULL && c->namesake != c->material) {
    abbe_material_numbers known;
    abbe_material_numbers_make(c->namesake, &known);
    if (isfinite(known.n_d))
      return (target){known.n_d, spread ? known.v_d : NAN, "the known ", c->namesake->name};
  }
  return (target){NAN, NAN, "", NULL};
}

static bool meets(const reading *r, const target *t) {
  return fabs(r->n_d - t->n_d) < SAME_ND && !(fabs(r->v_d / t->v_d - 1) > SAME_VD);
}

static bool is_far(const reading *r, const target *t) {
  return !(fabs(r->n_d - t->n_d) < OTHER_ND) || fabs(r->v_d / t->v_d - 1) > 0.5;
}

/* Whether the other reading is the right one: the row as it stands cannot be, and the other can
 * and is not far from what the row should have. */
static bool prefers(const reading *now, const reading *other, const target *t) {
  if (!other->plausible) return false;
  if (t->whose != NULL) return meets(other, t) && is_far(now, t);
  return !now->plausible;
}

/* Where nothing is known of the row an unusual V_d is a doubt: lithium chloride has one of 210. */
static bool is_sure(const reading *now, const target *t) {
  return t->whose != NULL || !now->possible;
}

static void say_target(abbe_check *c, abbe_finding *f, const reading *now, const reading *other,
                       const target *t, const char *what) {
  if (t->whose != NULL && isnan(t->v_d))
    abbe_check_say(c, &f->evidence,
                   "%s; as it stands n_d is %.5g and V_d %.4g, read so they are %.5g and %.4g; "
                   "%s%s has n_d %.6g",
                   what, now->n_d, now->v_d, other->n_d, other->v_d, t->the, t->whose, t->n_d);
  else if (t->whose != NULL)
    abbe_check_say(c, &f->evidence,
                   "%s; as it stands n_d is %.5g and V_d %.4g, read so they are %.5g and %.4g; "
                   "%s%s has %.6g and %.4g",
                   what, now->n_d, now->v_d, other->n_d, other->v_d, t->the, t->whose, t->n_d,
                   t->v_d);
  else
    abbe_check_say(c, &f->evidence,
                   "%s; as it stands n_d is %.5g and V_d %.4g, which %s; "
                   "read so they are %.5g and %.4g",
                   what, now->n_d, now->v_d,
                   now->possible ? "hardly a material has" : "is no transparent material",
                   other->n_d, other->v_d);
}

/* ---- Cauchy ---- */

static abbe_dispersion in_um(const abbe_dispersion *d) {
  abbe_dispersion made = *d;
  for (size_t k = 1; k < made.count; k++) made.c[k] /= pow(1e6, (double)k);
  return made;
}

static abbe_dispersion swapped(const abbe_dispersion *d) {
  abbe_dispersion made = *d;
  made.c[0] = d->c[1];
  made.c[1] = d->c[0];
  return made;
}

static bool check_units_and_order(abbe_check *c, const reading *now, const target *t) {
  const abbe_dispersion *as = &c->material->dispersion, turned = swapped(as);
  const struct {
    abbe_finding_kind kind;
    abbe_dispersion dispersion;
    const char *what, *fix;
    bool usable;
  } tries[] = {
      {ABBE_FINDING_B_IN_NM2, in_um(as), "B is in nm^2", "give B in um^2: 1e-6 of what is there",
       fabs(as->c[1]) > 1},
      {ABBE_FINDING_SWAPPED, turned, "A and B have changed places", "exchange A and B",
       as->count == 2},
      {ABBE_FINDING_SWAPPED, in_um(&turned), "A and B have changed places, and B is in nm^2",
       "exchange A and B, and give B in um^2", as->count == 2 && fabs(as->c[0]) > 1},
  };
  for (size_t i = 0; i < sizeof tries / sizeof tries[0]; i++) {
    reading other = read_as(c, &tries[i].dispersion);
    if (!tries[i].usable || now->plausible || !other.plausible) continue;
    if (t->whose != NULL && is_far(&other, t) && i > 0) continue;
    bool sure = is_sure(now, t);
    abbe_finding *f =
        abbe_check_find(c, tries[i].kind, sure ? ABBE_FINDING_WRONG : ABBE_FINDING_DOUBTFUL);
    if (f == NULL) return true;
    say_target(c, f, now, &other, t, tries[i].what);
    abbe_check_say(c, &f->fix, "%s", tries[i].fix);
    abbe_check_set_coefficients(c, f, &tries[i].dispersion);
    f->certain = sure;
    return true;
  }
  return false;
}

/* The curve moved down so that n_d becomes what stands in the place of A. */
static abbe_dispersion with_a_as_n_d(const abbe_dispersion *d) {
  abbe_dispersion made = *d;
  made.c[0] -= abbe_dispersion_n(d, ABBE_LINE_D_NM) - d->c[0];
  made.c[0] = round(made.c[0] * 1e6) / 1e6;
  return made;
}

/* Without a namesake: whether one reading alone is next to a known material. */
static bool known_alone(const abbe_check *c, const reading *now, const reading *other,
                        target *nearest) {
  bool found[2] = {false, false};
  const reading *readings[] = {now, other};
  if (c->known == NULL) return false;
  for (int i = 0; i < 2; i++) {
    abbe_glass_distances near;
    if (abbe_glass_distance_to_numbers(c->known, readings[i]->n_d, readings[i]->v_d, 1, &near,
                                       NULL) != ABBE_OK)
      return false;
    if (near.count > 0) {
      const abbe_glass_distance *first = &near.nearest[0];
      target t = {first->n_d, first->v_d, "the known ", c->known->material[first->index].name};
      found[i] = meets(readings[i], &t);
      if (i == 1) *nearest = t;
    }
    abbe_glass_distances_free(&near);
  }
  return found[1] && !found[0];
}

static bool check_a(abbe_check *c, const reading *now, const target *t) {
  const abbe_dispersion *as = &c->material->dispersion;
  abbe_dispersion right = with_a_as_n_d(as);
  reading other = read_as(c, &right);
  if (!(as->c[1] > 0) || !other.plausible) return false;
  target whose = *t;
  bool sure = t->whose != NULL && meets(&other, t) && is_far(now, t);
  if (!sure && (t->whose != NULL || !known_alone(c, now, &other, &whose))) return false;
  abbe_finding *f =
      abbe_check_find(c, ABBE_FINDING_A_IS_ND, sure ? ABBE_FINDING_WRONG : ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return true;
  char what[200];
  abbe_number_format(what, sizeof what,
                     "A %.6g is %.2g from the n_d of %s%s, and n_d is above A by B / L^2", as->c[0],
                     fabs(as->c[0] - whose.n_d), whose.the, whose.whose);
  say_target(c, f, now, &other, &whose, what);
  abbe_check_say(c, &f->fix, "A is n_d - B / (0.5875618 um)^2 = %.6g", right.c[0]);
  abbe_check_set_coefficients(c, f, &right);
  f->certain = sure;
  return true;
}

/* ---- Sellmeier ---- */

/* Every pole as the other of the two models would have it. */
static bool check_model(abbe_check *c, const reading *now, const target *t) {
  bool squares = c->material->dispersion.model == ABBE_DISPERSION_SELLMEIER;
  abbe_dispersion right = c->material->dispersion;
  right.model = squares ? ABBE_DISPERSION_SELLMEIER2 : ABBE_DISPERSION_SELLMEIER;
  reading other = read_as(c, &right);
  if (!prefers(now, &other, t)) return false;
  bool sure = is_sure(now, t);
  abbe_finding *f =
      abbe_check_find(c, ABBE_FINDING_POLES, sure ? ABBE_FINDING_WRONG : ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return true;
  char what[200];
  abbe_number_format(
      what, sizeof what,
      squares ? "its poles (the first is %.6g) are squares already, and the model squares them"
              : "its poles (the first is %.6g um) are not squared, and the model wants squares",
      right.c[2]);
  say_target(c, f, now, &other, t, what);
  abbe_check_say(c, &f->fix, "the model is %s", abbe_dispersion_model_name(right.model));
  abbe_check_say(c, &f->value, "%s", abbe_dispersion_model_name(right.model));
  f->key = "model";
  f->certain = sure;
  return true;
}

/* One pole that alone was squared, or was not: seen only by n_d and V_d that then come out. */
static bool check_one_pole(abbe_check *c, const reading *now, const target *t) {
  const abbe_dispersion *as = &c->material->dispersion;
  bool off = fabs(now->n_d - t->n_d) > 2e-4 || fabs(now->v_d / t->v_d - 1) > 2e-3;
  if (t->whose == NULL || isnan(t->v_d) || !off) return false;
  for (size_t k = 2; k < as->count; k += 2)
    for (int root = 0; root < 2; root++) {
      abbe_dispersion right = *as;
      right.c[k] = root ? sqrt(fabs(as->c[k])) : as->c[k] * as->c[k];
      reading other = read_as(c, &right);
      bool meets_all = fabs(other.n_d - t->n_d) < 5e-5 && fabs(other.v_d / t->v_d - 1) < 1e-3;
      if (!other.plausible || !meets_all) continue;
      abbe_finding *f = abbe_check_find(c, ABBE_FINDING_POLES, ABBE_FINDING_WRONG);
      if (f == NULL) return true;
      char what[120];
      abbe_number_format(what, sizeof what, "the pole c%zu = %.6g is %s", k, as->c[k],
                         root ? "a square already" : "not squared");
      say_target(c, f, now, &other, t, what);
      abbe_check_say(c, &f->fix, "c%zu is %.9g", k, right.c[k]);
      abbe_check_set_coefficients(c, f, &right);
      f->certain = true;
      return true;
    }
  return false;
}

/* Two columns of a table that have changed places: seen only by n_d and V_d that then come out. */
static bool check_order(abbe_check *c, const reading *now, const target *t) {
  const abbe_dispersion *as = &c->material->dispersion;
  if (t->whose == NULL || isnan(t->v_d) || !is_far(now, t)) return false;
  reading found = {0};
  size_t first = 0, second = 0, ways = 0;
  for (size_t i = 0; i < as->count; i++)
    for (size_t k = i + 1; k < as->count; k++) {
      abbe_dispersion right = *as;
      right.c[i] = as->c[k];
      right.c[k] = as->c[i];
      if (abbe_check_is_exponent(as, i) || abbe_check_is_exponent(as, k)) continue;
      reading other = read_as(c, &right);
      if (!other.plausible || !meets(&other, t)) continue;
      /* strengths of two terms or their poles: the same sum in another order */
      if (ways > 0 && fabs(other.n_d - found.n_d) < 1e-12 && fabs(other.v_d / found.v_d - 1) < 1e-9)
        continue;
      if (ways++ > 0 && fabs(other.n_d - t->n_d) >= fabs(found.n_d - t->n_d)) continue;
      found = other;
      first = i, second = k;
    }
  if (ways == 0) return false;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_ORDER, ABBE_FINDING_WRONG);
  if (f == NULL) return true;
  char what[120];
  snprintf(what, sizeof what, "c%zu and c%zu have changed places", first, second);
  say_target(c, f, now, &found, t, what);
  abbe_check_say(c, &f->fix, "exchange c%zu = %.9g and c%zu = %.9g", first, as->c[first], second,
                 as->c[second]);
  abbe_check_set_coefficients(c, f, &found.dispersion);
  f->certain = ways == 1;
  return true;
}

bool abbe_check_read_anew(abbe_check *c) {
  const abbe_dispersion *as = &c->material->dispersion;
  reading now = read_as(c, as);
  target t = target_of(c);
  if (as->model == ABBE_DISPERSION_CAUCHY && as->count >= 2)
    return check_units_and_order(c, &now, &t) || check_a(c, &now, &t);
  if ((as->model == ABBE_DISPERSION_SELLMEIER || as->model == ABBE_DISPERSION_SELLMEIER2) &&
      as->count >= 3 && (check_model(c, &now, &t) || check_one_pole(c, &now, &t)))
    return true;
  return as->count >= 3 && check_order(c, &now, &t);
}
