#include "validation/measure/gem/gem_derive.h"

#include "base/maths.h"
#include "scenes/cuts/cut_polyhedron.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So far a crossing of the horizon or of the head's rim is softened, as searches for angles do. */
#define SOFT 0.035

static const abbe_gem_amount amounts[] = {
#define AMOUNT_OF(code, amount, name, unit) ABBE_GEM_##amount,
    ABBE_GEM_DERIVE_MEASURES(AMOUNT_OF)};
#define NAME_OF(code, amount, name, unit) name,
#define UNIT_OF(code, amount, name, unit) unit,
static const char *const names[] = {ABBE_GEM_DERIVE_MEASURES(NAME_OF)};
static const char *const units[] = {ABBE_GEM_DERIVE_MEASURES(UNIT_OF)};

const char *abbe_gem_derive_measure_name(abbe_gem_derive_measure measure) {
  return names[measure];
}

const char *abbe_gem_derive_measure_unit(abbe_gem_derive_measure measure) {
  return units[measure];
}

void abbe_gem_derive_stone_free(abbe_gem_derive_stone *s) {
  abbe_gem_stone_free(&s->gem);
  free(s->n);
  free(s->loss);
  *s = (abbe_gem_derive_stone){0};
}

/* The object's planes about its middle, in units of its size. */
static void take_planes(const abbe_object *o, double size, abbe_cut_facet *facet) {
  for (size_t i = 0; i < o->exact.count; i++) {
    const double *plane = o->exact.plane[i];
    double off = plane[3];
    for (int k = 0; k < 3; k++) {
      facet[i].n[k] = plane[k];
      off -= plane[k] * 0.5 * (o->min[k] + o->max[k]);
    }
    facet[i].d = off / size;
  }
}

static abbe_result index_at(const abbe_material *m, const abbe_specular_shift *shift, double nm,
                            double *n, abbe_error *error) {
  double unused;
  return abbe_specular_index(m, shift, nm, n, &unused, error);
}

static abbe_result take_material(const abbe_material *m, const abbe_specular_shift *shift,
                                 const abbe_wavelengths *w, abbe_gem_derive_stone *s,
                                 abbe_error *error) {
  double at_c, at_f;
  s->n = calloc(w->count, sizeof *s->n);
  s->loss = calloc(w->count, sizeof *s->loss);
  if (s->n == NULL || s->loss == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone's indices");
  for (size_t k = 0; k < w->count; k++) {
    ABBE_TRY(abbe_specular_index(m, shift, w->lambda_nm[k], &s->n[k], &s->loss[k], error));
    s->loss[k] *= s->gem.unit_m;
  }
  ABBE_TRY(index_at(m, shift, ABBE_LINE_C_NM, &at_c, error));
  ABBE_TRY(index_at(m, shift, ABBE_LINE_F_NM, &at_f, error));
  s->spread = at_f - at_c;
  return ABBE_OK;
}

abbe_result abbe_gem_derive_cut_make(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                                     const abbe_material *m, const abbe_specular_shift *shift,
                                     double width_m, const abbe_wavelengths *w,
                                     abbe_gem_derive_stone *out, abbe_error *error) {
  *out = (abbe_gem_derive_stone){0};
  ABBE_TRY(abbe_gem_stone_make(cut, p, m, w, width_m, &out->gem, error));
  const abbe_result result = take_material(m, shift, w, out, error);
  if (result != ABBE_OK) abbe_gem_derive_stone_free(out);
  return result;
}

abbe_result abbe_gem_derive_stone_make(const abbe_object *o, const abbe_specular_shift *shift,
                                       const abbe_wavelengths *w, abbe_gem_derive_stone *out,
                                       abbe_error *error) {
  *out = (abbe_gem_derive_stone){0};
  if (abbe_object_kind_of(o) != ABBE_OBJECT_REFRACTOR || o->exact.kind != ABBE_EXACT_CONVEX)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "'%s' is no stone: these are convex, with flat faces, and of a clear "
                          "material",
                          o->name);
  abbe_cut_tier tier = {.count = o->exact.count};
  ABBE_FREED abbe_cut_facet *facet = calloc(o->exact.count + 1, sizeof *facet);
  ABBE_OWNED(abbe_cut_polyhedron, p) = {0};
  const abbe_cut cut = {
      .gear = 96, .tier_count = 1, .tier = &tier, .facet_count = o->exact.count, .facet = facet};
  double diagonal[3];
  if (facet == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone's planes");
  abbe_vector_subtract(o->max, o->min, diagonal);
  const double size = 0.5 * abbe_vector_length(diagonal);
  take_planes(o, size, facet);
  ABBE_TRY(abbe_cut_polyhedron_make(&cut, 0, &p, error));
  const double width = size * fmin(p.max[0] - p.min[0], p.max[1] - p.min[1]);
  return abbe_gem_derive_cut_make(&cut, &p, o->material, shift, width, w, out, error);
}

static double apart(const double a[4], const double b[4]) {
  double sum = 0;
  for (int k = 0; k < 4; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/* Of a moved stone's planes each that is the base's plane i; false where they are not the same. */
static bool match(const abbe_gem_stone *base, const abbe_gem_stone *moved, size_t *of) {
  bool taken[ABBE_CUT_MAX_FACETS] = {false};
  if (moved->plane_count != base->plane_count) return false;
  for (size_t i = 0; i < base->plane_count; i++) {
    double least = INFINITY;
    for (size_t j = 0; j < moved->plane_count; j++)
      if (apart(base->plane[i], moved->plane[j]) < least) {
        least = apart(base->plane[i], moved->plane[j]);
        of[i] = j;
      }
    if (taken[of[i]]) return false;
    taken[of[i]] = true;
  }
  return true;
}

typedef struct change {
  double plane[ABBE_CUT_MAX_FACETS][4], *n, *loss, spread; /* n, loss: owned */
  size_t of[2][ABBE_CUT_MAX_FACETS]; /* planes of the moved stones, by the base's */
} change;

/* Half of the difference over a step. Below its rounding nothing changes. */
static double slope(double low, double high, double step, bool *felt) {
  if (fabs(high - low) <= 1e-13 * (1 + fabs(low))) return 0;
  *felt = true;
  return (high - low) / (2 * step);
}

static abbe_result find_change(const abbe_gem_derive_stone *base, const abbe_gem_derive_key *key,
                               change *c, bool *felt, abbe_error *error) {
  const abbe_gem_derive_stone *low = &key->moved[0], *high = &key->moved[1];
  for (int s = 0; s < 2; s++)
    if (!match(&base->gem, &key->moved[s].gem, c->of[s]))
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "'%s' changes which faces there are, and not only where they lie: it "
                            "has no derivative",
                            key->name);
  *felt = false;
  for (size_t i = 0; i < base->gem.plane_count; i++)
    for (int k = 0; k < 4; k++)
      c->plane[i][k] =
          slope(low->gem.plane[c->of[0][i]][k], high->gem.plane[c->of[1][i]][k], key->step, felt);
  for (size_t k = 0; k < base->gem.wavelengths; k++) {
    c->n[k] = slope(low->n[k], high->n[k], key->step, felt);
    c->loss[k] = slope(low->loss[k], high->loss[k], key->step, felt);
  }
  c->spread = slope(low->spread, high->spread, key->step, felt);
  return ABBE_OK;
}

static abbe_result derive(const abbe_gem_derive_desc *q, const abbe_gem_slope *slope,
                          size_t measures, abbe_gem_number *out, bool *felt, abbe_error *error) {
  const size_t waves = q->base->gem.wavelengths;
  ABBE_FREED change *c = calloc(1, sizeof *c);
  ABBE_FREED double *room = calloc(2 * waves, sizeof *room);
  if (c == NULL || room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone's derivatives");
  c->n = room;
  c->loss = room + waves;
  for (size_t m = 0; m < measures; m++) out[m * (1 + q->keys)] = slope[m].value;
  for (size_t k = 0; k < q->keys; k++) {
    bool changes = false;
    ABBE_TRY(find_change(q->base, &q->key[k], c, &changes, error));
    const abbe_gem_change by = {
        .plane = (const double(*)[4])c->plane, .n = c->n, .loss = c->loss, .spread = c->spread};
    for (size_t m = 0; m < measures; m++)
      out[m * (1 + q->keys) + 1 + k] = abbe_gem_slope_by(&slope[m], &by);
    if (felt != NULL) felt[k] = changes;
  }
  return ABBE_OK;
}

abbe_result abbe_gem_derive_make(const abbe_gem_derive_desc *q,
                                 const abbe_gem_derive_measure *measure, size_t measures,
                                 abbe_gem_number *out, bool *felt, abbe_error *error) {
  abbe_gem_slope_desc desc[ABBE_GEM_SLOPE_MOST];
  abbe_gem_slope slope[ABBE_GEM_SLOPE_MOST];
  for (size_t m = 0; m < measures; m++)
    desc[m] = (abbe_gem_slope_desc){.measure = amounts[measure[m]],
                                    .fire = measure[m] == ABBE_GEM_DERIVE_FIRE,
                                    .spread = q->base->spread,
                                    .head_rad = q->head_rad,
                                    .soft_rad = SOFT,
                                    .least_share = (double)ABBE_GEM_LEAST_SHARE,
                                    .meetings = ABBE_GEM_SLOPE_MEETINGS,
                                    .lines = q->lines / ABBE_GEM_SLOPE_REPEATS,
                                    .threads = q->threads,
                                    .progress = q->progress,
                                    .user = q->user};
  ABBE_TRY(abbe_gem_slope_make(&q->base->gem, q->weights, desc, measures, slope, error));
  const abbe_result result = derive(q, slope, measures, out, felt, error);
  for (size_t m = 0; m < measures; m++) abbe_gem_slope_free(&slope[m]);
  return result;
}
