/* What a row's curve does over its range, and whether it is the one that is printed about it. */
#include "spectral/editing/check_parts.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <math.h>

static const double LOW = ABBE_WAVELENGTH_MIN_NM, HIGH = ABBE_WAVELENGTH_MAX_NM;

static double n_at(const abbe_check *c, double lambda_nm) {
  return abbe_dispersion_n(&c->material->dispersion, lambda_nm);
}

static double k_at(const abbe_check *c, double lambda_nm) {
  return abbe_absorption_k(abbe_material_attenuation(c->material, lambda_nm), lambda_nm);
}

/* The largest k of the row. */
static double most_k(const abbe_check *c) {
  const abbe_spectrum *a = c->material->attenuation;
  double most = 0;
  for (size_t i = 0; a != NULL && i < abbe_spectrum_count(a); i++)
    most = fmax(most, k_at(c, abbe_spectrum_lambda_nm(a)[i]));
  return most;
}

/* Thin gases and the vacuum are about 1 to air, and X-rays are refracted the other way. What has a
 * band this strong is a metal, or opaque near it: n may rise there, and be below 1 beside it. */
static const double THIN = 1e-3, XRAY_NM = 120, STRONG = 0.1;

/* False where the formula fails inside its range: nothing else can be checked then. */
static bool check_index(abbe_check *c) {
  enum { STEPS = 2000 };
  double least = INFINITY, least_nm = 0;
  bool bands = most_k(c) > STRONG;
  for (int i = 0; i <= STEPS; i++) {
    double l = c->low_nm + (c->high_nm - c->low_nm) * i / STEPS, n = n_at(c, l);
    if (isnan(n)) {
      abbe_finding *f = abbe_check_find(c, ABBE_FINDING_NO_INDEX, ABBE_FINDING_WRONG);
      if (f == NULL) return false;
      abbe_check_say(c, &f->evidence, "its formula has no real index at %g nm, inside %g to %g nm",
                     l, c->low_nm, c->high_nm);
      abbe_check_say(c, &f->fix,
                     "compare the coefficients with the source: wavelengths are in um, and poles "
                     "lie outside the range");
      return false;
    }
    if (n < least && l >= XRAY_NM && 1 - n >= THIN) least = n, least_nm = l;
  }
  if (least >= 1 || bands) return true;
  bool seen = least_nm >= LOW && least_nm <= HIGH;
  abbe_finding *f =
      abbe_check_find(c, ABBE_FINDING_BELOW_ONE, seen ? ABBE_FINDING_WRONG : ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return false;
  abbe_check_say(c, &f->evidence, "n is %.6g at %g nm", least, least_nm);
  abbe_check_say(c, &f->fix,
                 seen ? "no clear solid or liquid has that in the light: compare the "
                        "coefficients with the source"
                      : "end range_nm where the material becomes opaque");
  return true;
}

/* The largest rise from a wavelength to a longer one that no absorption there accounts for. */
static void check_falling(abbe_check *c) {
  double low = fmax(c->low_nm, LOW), high = fmin(c->high_nm, HIGH);
  double least = INFINITY, least_nm = 0, rise = 0, from_nm = 0, to_nm = 0, k = 0;
  for (double l = low; l <= high; l += 1) {
    double n = n_at(c, l);
    if (fabs(n - 1) < THIN) return;
    k = fmax(k, k_at(c, l));
    if (n < least) least = n, least_nm = l;
    if (n - least > rise) rise = n - least, from_nm = least_nm, to_nm = l;
  }
  if (rise < 1e-6 || rise < k || k > STRONG) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_RISING, ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return;
  abbe_check_say(c, &f->evidence, "n rises by %.2g from %g to %g nm, from %.6g to %.6g", rise,
                 from_nm, to_nm, n_at(c, from_nm), n_at(c, to_nm));
  abbe_check_say(c, &f->fix,
                 "a clear material's index falls: look for a wrong sign or digit, for noise in "
                 "points, or for an absorption band there");
}

/* ---- what is printed ---- */

/* How far half of the last digit of each coefficient moves n_d and V_d. Whole numbers are exact,
 * and where more than a hundredth is left open zeros were lost at the end. */
static void blur_of(const abbe_check *c, double *n_d, double *v_d) {
  const abbe_dispersion *as = &c->material->dispersion;
  abbe_dispersion_numbers here = abbe_dispersion_describe(as);
  *n_d = *v_d = 0;
  for (size_t k = 0; k < as->count; k++) {
    abbe_dispersion moved = *as;
    if (abbe_check_is_exponent(as, k) || as->c[k] == round(as->c[k])) continue;
    moved.c[k] += fmin(abbe_material_half_digit(as->c[k]), 0.01 * fabs(as->c[k]));
    abbe_dispersion_numbers there = abbe_dispersion_describe(&moved);
    if (isfinite(there.n_d)) *n_d += fabs(there.n_d - here.n_d);
    if (isfinite(there.v_d)) *v_d += fabs(there.v_d - here.v_d);
  }
}

static const char *numbers_of(const abbe_check *c) {
  return c->material->dispersion.table != NULL ? "points" : "coefficients";
}

static void check_n_d(abbe_check *c, const abbe_material_numbers *n, double blur) {
  double printed = c->published.n_d, off = fabs(n->n_d - printed);
  /* 1 stands in catalogues where n_d is not given */
  if (!(printed > 1.0001) || !(off > c->published.n_d_half + 5e-6 + blur)) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_OFF_ND,
                                    off > 1e-3 ? ABBE_FINDING_WRONG : ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return;
  abbe_check_say(c, &f->evidence, "its source prints n_d %.7g, its %s give %.7g: %.2g %s", printed,
                 numbers_of(c), n->n_d, off, n->n_d > printed ? "more" : "less");
  abbe_check_say(c, &f->fix, "compare both with the source: a digit is wrong in one of them");
}

static void check_v_d(abbe_check *c, const abbe_material_numbers *n, double blur) {
  double printed = c->published.v_d, off = fabs(n->v_d - printed);
  /* what five units in the sixth decimal of n_F and n_C do */
  blur += n->v_d * 1e-5 / fabs(n->n_F - n->n_C);
  if (!(printed > 0) || !(off > c->published.v_d_half + blur)) return;
  abbe_finding *f = abbe_check_find(
      c, ABBE_FINDING_OFF_VD, off > 0.02 * printed ? ABBE_FINDING_WRONG : ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return;
  abbe_check_say(c, &f->evidence, "its source prints V_d %.5g, its %s give %.5g", printed,
                 numbers_of(c), n->v_d);
  abbe_check_say(c, &f->fix, "compare both with the source: a digit is wrong in one of them");
}

static void check_namesake(abbe_check *c, const abbe_material_numbers *n) {
  const abbe_material *known = c->namesake;
  if (known == NULL || known == c->material || isfinite(c->published.n_d)) return;
  abbe_material_numbers other;
  abbe_material_numbers_make(known, &other);
  double off = fabs(n->n_d - other.n_d), ratio = fabs(n->v_d / other.v_d - 1);
  if (isnan(off) || (off <= 5e-3 && !(ratio > 0.05))) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_UNLIKE, ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return;
  abbe_check_say(c, &f->evidence, "n_d is %.6g and V_d %.4g; the known %s has %.6g and %.4g (%s)",
                 n->n_d, n->v_d, known->name, other.n_d, other.v_d, known->source);
  abbe_check_say(c, &f->fix, "compare the coefficients with the source, or name it otherwise");
}

/* ---- where there are no data ---- */

static void say_step(abbe_check *c, abbe_finding *f, double data_nm, double end_nm) {
  double at_data = n_at(c, data_nm), at_end = n_at(c, end_nm);
  if (isnan(at_end))
    abbe_check_say(c, &f->evidence, "its data end at %g nm, and there is no index at %g nm at all",
                   data_nm, end_nm);
  else
    abbe_check_say(c, &f->evidence,
                   "its data end at %g nm with n %.6g; from there to %g nm n is continued by %+.2g",
                   data_nm, at_data, end_nm, at_end - at_data);
}

void abbe_check_cover(abbe_check *c) {
  const abbe_material *m = c->material;
  bool violet = c->low_nm > LOW, red = c->high_nm < HIGH;
  if (!violet && !red) return;
  if (!m->extrapolate) {
    abbe_finding *f = abbe_check_find(c, ABBE_FINDING_DARK, ABBE_FINDING_NOTE);
    if (f == NULL) return;
    abbe_check_say(c, &f->evidence, "its data reach from %g to %g nm, not over %g to %g nm",
                   c->low_nm, c->high_nm, LOW, HIGH);
    abbe_check_say(c, &f->fix, "%s",
                   abbe_material_is_conductor(m)
                       ? "scenes need a narrower range of wavelengths, or points that reach further"
                       : "scenes need a narrower range of wavelengths, or 'extrapolate: true' and "
                         "a warning that says so");
    return;
  }
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_EXTRAPOLATED,
                                    m->warning != NULL ? ABBE_FINDING_NOTE : ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return;
  double step_violet = violet ? fabs(n_at(c, LOW) - n_at(c, c->low_nm)) : -1;
  double step_red = red ? fabs(n_at(c, HIGH) - n_at(c, c->high_nm)) : -1;
  if (step_red > step_violet || (red && !violet))
    say_step(c, f, c->high_nm, HIGH);
  else
    say_step(c, f, c->low_nm, LOW);
  abbe_check_say(c, &f->fix,
                 m->warning != NULL ? "the record warns of it"
                                    : "add a warning that says so, or data that reach further");
}

void abbe_check_follow_curve(abbe_check *c) {
  abbe_material_numbers numbers;
  abbe_material inside = *c->material;
  double n_d_blur, v_d_blur;
  if (!check_index(c)) return;
  check_falling(c);
  inside.extrapolate = false;
  abbe_material_numbers_make(&inside, &numbers);
  blur_of(c, &n_d_blur, &v_d_blur);
  check_n_d(c, &numbers, n_d_blur);
  check_v_d(c, &numbers, v_d_blur);
  check_namesake(c, &numbers);
  abbe_check_cover(c);
}
