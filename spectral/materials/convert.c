#include "spectral/materials/convert.h"

#include "spectral/dispersion/index_points.h"

#include <math.h>
#include <string.h>

static const struct {
  const char *first, *second;
} names[] = {
#define ABBE_GIVEN_ROW(code, first, second) {first, second},
    ABBE_GIVENS(ABBE_GIVEN_ROW)
#undef ABBE_GIVEN_ROW
};

static bool known_kind(abbe_given_kind kind) {
  return (int)kind >= 0 && kind < ABBE_GIVEN_KIND_COUNT;
}

const char *abbe_given_first_name(abbe_given_kind kind) {
  return known_kind(kind) ? names[kind].first : "unknown";
}

const char *abbe_given_second_name(abbe_given_kind kind) {
  return known_kind(kind) ? names[kind].second : "unknown";
}

/* ---- what the two numbers mean ---- */

/* An index at one line, and the difference between those at two others. */
typedef struct claim {
  double n_d, spread;
  double short_nm, long_nm;
} claim;

static double x_of(double lambda_nm) {
  return 1e6 / (lambda_nm * lambda_nm);
}

static abbe_result check(const abbe_given *g, abbe_error *error) {
  if (!known_kind(g->kind))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no conversion %d", (int)g->kind);
  const char *first = names[g->kind].first, *second = names[g->kind].second;
  bool zero = g->kind == ABBE_GIVEN_GLTF || g->kind == ABBE_GIVEN_A_B;
  bool may_be_low = g->kind == ABBE_GIVEN_A_B; /* A is not an index */
  if (!(g->first > (may_be_low ? 0 : 1) && g->first <= 10))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s %g is not an index of refraction; it is above %d and at most 10, such "
        "as 1.5168",
        first, g->first, may_be_low ? 0 : 1);
  if (isfinite(g->second) && (g->second > 0 || (zero && g->second == 0))) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s %g is not possible; it is %s 0, such as %s", second, g->second,
                        zero ? "at least" : "above",
                        g->kind == ABBE_GIVEN_ND_VD   ? "64.17"
                        : g->kind == ABBE_GIVEN_ND_BG ? "0.044 (diamond's)"
                        : g->kind == ABBE_GIVEN_A_B   ? "0.0042 (um^2)"
                                                      : "0.36 (diamond's)");
}

static claim claim_of(const abbe_given *g) {
  claim c = {g->first, g->second, ABBE_LINE_F_NM, ABBE_LINE_C_NM};
  switch (g->kind) {
  case ABBE_GIVEN_ND_VD:
    c.spread = (g->first - 1) / g->second;
    break;
  case ABBE_GIVEN_GLTF:
    c.spread = (g->first - 1) * g->second / 20;
    break;
  case ABBE_GIVEN_ND_BG:
    c.short_nm = ABBE_LINE_G_NM;
    c.long_nm = ABBE_LINE_B_NM;
    break;
  default:
    c.n_d = g->first + g->second * x_of(ABBE_LINE_D_NM);
    c.spread = g->second * (x_of(ABBE_LINE_F_NM) - x_of(ABBE_LINE_C_NM));
  }
  return c;
}

/* ---- the forms ---- */

static abbe_dispersion cauchy_of(const claim *c) {
  double B = c->spread / (x_of(c->short_nm) - x_of(c->long_nm));
  return (abbe_dispersion){
      .model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {c->n_d - B * x_of(ABBE_LINE_D_NM), B}};
}

/* One term with its pole at C um^2, and B such that n_d holds. */
static abbe_dispersion sellmeier_at(const claim *c, double C) {
  double L2 = 1 / x_of(ABBE_LINE_D_NM);
  return (abbe_dispersion){.model = ABBE_DISPERSION_SELLMEIER2,
                           .count = 3,
                           .c = {0, (c->n_d * c->n_d - 1) * (L2 - C) / L2, C}};
}

static double spread_at(const claim *c, double C) {
  abbe_dispersion d = sellmeier_at(c, C);
  return abbe_dispersion_n(&d, c->short_nm) - abbe_dispersion_n(&d, c->long_nm);
}

/* The dispersion rises with the pole from none at 0 to any amount at the shorter line. */
static abbe_result sellmeier_of(const claim *c, abbe_dispersion *out, abbe_error *error) {
  double low = 0, high = (1 - 1e-9) / x_of(c->short_nm);
  if (!(spread_at(c, high) > c->spread))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no one-term Sellmeier form has n_d %g and a dispersion of %g", c->n_d,
                          c->spread);
  for (int i = 0; i < 200 && low < high; i++) {
    double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    if (spread_at(c, middle) < c->spread)
      low = middle;
    else
      high = middle;
  }
  *out = sellmeier_at(c, low);
  return ABBE_OK;
}

abbe_result abbe_convert_make(const abbe_given *given, abbe_fit_form form, abbe_dispersion *out,
                              abbe_error *error) {
  *out = (abbe_dispersion){0};
  ABBE_TRY(check(given, error));
  claim c = claim_of(given);
  if (form == ABBE_FIT_CAUCHY && given->kind == ABBE_GIVEN_A_B) {
    *out = (abbe_dispersion){
        .model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {given->first, given->second}};
    return ABBE_OK;
  }
  if (form == ABBE_FIT_CAUCHY) {
    *out = cauchy_of(&c);
    return ABBE_OK;
  }
  if (form != ABBE_FIT_SELLMEIER)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no form %d", (int)form);
  if (!(c.n_d > 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "n_d would be %g; a one-term Sellmeier form has an n_d above 1", c.n_d);
  return sellmeier_of(&c, out, error);
}

/* ---- the error ---- */

/* The largest of the changes that half a last digit makes, the two numbers apart and together. */
static abbe_result rounding_of(const abbe_given *given, abbe_fit_form form,
                               const abbe_dispersion *made, double min_nm, double max_nm,
                               double *out, abbe_error *error) {
  static const int signs[][2] = {{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  *out = 0;
  for (int i = 0; i < 4; i++) {
    abbe_given other = *given;
    abbe_dispersion moved;
    abbe_index_difference d;
    other.first += signs[i][0] * given->first_half;
    other.second += signs[i][1] * given->second_half;
    if (abbe_convert_make(&other, form, &moved, NULL) != ABBE_OK) continue;
    abbe_result result = abbe_index_difference_of_curves(&moved, made, min_nm, max_nm, &d, error);
    if (result == ABBE_NO_MEMORY) return result;
    if (result == ABBE_OK) *out = fmax(*out, d.max);
  }
  return ABBE_OK;
}

/* The same conversion of a material whose curve is known. */
static abbe_result same_of(const abbe_material *m, abbe_given_kind kind, abbe_fit_form form,
                           double min_nm, double max_nm, abbe_index_difference *out,
                           abbe_error *error) {
  abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
  abbe_given given = {.kind = kind, .first = d.n_d, .second = d.v_d};
  if (kind == ABBE_GIVEN_ND_BG) given.second = d.b_g;
  if (kind == ABBE_GIVEN_GLTF) given.second = 20 / d.v_d;
  if (kind == ABBE_GIVEN_A_B) {
    abbe_index_points points;
    abbe_fit fit;
    abbe_result result =
        abbe_index_points_sample(&m->dispersion, min_nm, max_nm, 64, 401, &points, error);
    if (result == ABBE_OK)
      result = abbe_fit_make(&points, &(abbe_fit_request){.terms = 2}, &fit, error);
    abbe_index_points_free(&points);
    if (result != ABBE_OK) return result;
    given.first = fit.dispersion.c[0];
    given.second = fit.dispersion.c[1];
  }
  abbe_dispersion made;
  ABBE_TRY(abbe_convert_make(&given, form, &made, error));
  return abbe_index_difference_of_curves(&made, &m->dispersion, min_nm, max_nm, out, error);
}

/* The materials nearest in V_d, nearest first: index and distance in ln V_d. */
static size_t nearest_in_v_d(const abbe_material_table *known, double v_d, double min_nm,
                             double max_nm, size_t *index) {
  double apart[ABBE_CONVERT_COMPARED];
  size_t count = 0;
  for (size_t i = 0; i < known->count; i++) {
    const abbe_material *m = &known->material[i];
    if (abbe_material_extrapolates(m, min_nm) || abbe_material_extrapolates(m, max_nm)) continue;
    double other = abbe_dispersion_describe(&m->dispersion).v_d;
    double distance = fabs(log(other / v_d));
    if (!isfinite(distance)) continue;
    size_t at = count;
    while (at > 0 && apart[at - 1] > distance) at--;
    if (at == ABBE_CONVERT_COMPARED) continue;
    if (count < ABBE_CONVERT_COMPARED) count++;
    memmove(apart + at + 1, apart + at, (count - 1 - at) * sizeof *apart);
    memmove(index + at + 1, index + at, (count - 1 - at) * sizeof *index);
    apart[at] = distance;
    index[at] = i;
  }
  return count;
}

abbe_result abbe_convert_judge(const abbe_given *given, abbe_fit_form form,
                               const abbe_material_table *known, double min_nm, double max_nm,
                               abbe_convert_error *out, abbe_error *error) {
  abbe_dispersion made;
  *out = (abbe_convert_error){.typical = NAN, .largest = NAN, .at_nm = NAN};
  ABBE_TRY(abbe_convert_make(given, form, &made, error));
  abbe_index_points probe; /* refuses a range that is none, or meets a pole */
  abbe_error why = {0};
  abbe_result result = abbe_index_points_sample(&made, min_nm, max_nm, 401, 4001, &probe, &why);
  abbe_index_points_free(&probe);
  if (result != ABBE_OK)
    return abbe_error_set(error, result,
                          "the numbers %g and %g go with no material: %s; compare them with their "
                          "source, and their units",
                          given->first, given->second, why.text);
  ABBE_TRY(rounding_of(given, form, &made, min_nm, max_nm, &out->rounding, error));
  abbe_dispersion_numbers own = abbe_dispersion_describe(&made);
  size_t index[ABBE_CONVERT_COMPARED];
  size_t count = nearest_in_v_d(known, own.v_d, min_nm, max_nm, index);
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    abbe_index_difference d;
    const abbe_material *m = &known->material[index[i]];
    result = same_of(m, given->kind, form, min_nm, max_nm, &d, error);
    if (result == ABBE_NO_MEMORY) return result;
    if (result != ABBE_OK) continue;
    abbe_dispersion_numbers other = abbe_dispersion_describe(&m->dispersion);
    double scale = (own.n_F - own.n_C) / (other.n_F - other.n_C);
    sum += d.rms * scale;
    out->compared++;
    if (d.max * scale <= out->largest) continue;
    out->largest = d.max * scale;
    out->at_nm = d.max_nm;
    out->worst = index[i];
  }
  if (out->compared > 0) out->typical = sum / (double)out->compared;
  return ABBE_OK;
}
