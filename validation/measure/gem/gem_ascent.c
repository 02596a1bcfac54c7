#include "validation/measure/gem/gem_ascent.h"

#include "base/maths.h"
#include "scenes/cuts/cut_meets.h"
#include "scenes/cuts/cut_stretch.h"
#include "validation/measure/gem/gem_slope.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So far a crossing of the horizon is softened, rad. */
#define SOFT 0.035
/* The first step, and the least; rad, and a tier's distance in units of the design. */
#define STEP 0.02
#define LEAST_STEP 2e-4

/* A design on the way. */
typedef struct place {
  abbe_cut cut;
  abbe_cut_polyhedron polyhedron;
  double value;            /* softened, and more is better */
  double *gradient, *free; /* [scalars], [freedoms][scalars] */
  size_t freedoms;
} place;

typedef struct work {
  const abbe_material *material;
  const abbe_wavelengths *wavelengths;
  const abbe_weights *weights;
  const abbe_gem_ascent_desc *q;
  size_t scalars, evaluations;
  bool tiers; /* and not the two angles */
} work;

static void place_free(place *p) {
  free(p->cut.tier);
  free(p->cut.facet);
  abbe_cut_polyhedron_free(&p->polyhedron);
  free(p->gradient);
  free(p->free);
  *p = (place){0};
}

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a search of angles");
}

/* Tiers and facets of its own. */
static abbe_result copy_cut(const abbe_cut *cut, abbe_cut *out, abbe_error *error) {
  *out = *cut;
  out->tier = malloc(cut->tier_count * sizeof *out->tier);
  out->facet = malloc(cut->facet_count * sizeof *out->facet);
  if (out->tier == NULL || out->facet == NULL) {
    free(out->tier);
    free(out->facet);
    out->tier = NULL;
    out->facet = NULL;
    return no_memory(error);
  }
  memcpy(out->tier, cut->tier, cut->tier_count * sizeof *out->tier);
  memcpy(out->facet, cut->facet, cut->facet_count * sizeof *out->facet);
  return ABBE_OK;
}

/* ---- the light of a design ---- */

static abbe_result make_stone(const work *w, const abbe_cut *cut, const abbe_cut_polyhedron *p,
                              abbe_gem_stone *out, abbe_error *error) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  ABBE_TRY(abbe_gem_stone_make(cut, p, w->material, w->wavelengths, s->width_m, out, error));
  abbe_result result = ABBE_OK;
  if (abbe_vector_length(s->axes.z) > 0) result = abbe_gem_stone_turn(out, &s->axes, error);
  if (result != ABBE_OK) abbe_gem_stone_free(out);
  return result;
}

static abbe_result follow(work *w, const place *p, abbe_gem_stone *stone, abbe_gem_slope *slope,
                          abbe_error *error) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  const abbe_gem_slope_desc desc = {.measure = s->measure,
                                    .fire = w->q->fire,
                                    .spread = w->q->spread,
                                    .axis_rad = s->view.axis_rad,
                                    .tilt_rad = s->view.tilt_rad,
                                    .head_rad = s->view.head_rad,
                                    .soft_rad = SOFT,
                                    .threads = s->view.threads};
  ABBE_TRY(make_stone(w, &p->cut, &p->polyhedron, stone, error));
  w->evaluations++;
  const abbe_result result = abbe_gem_slope_make(stone, w->weights, &desc, slope, error);
  if (result != ABBE_OK) abbe_gem_stone_free(stone);
  return result;
}

/* Planes' derivatives in the cut become those of the stone's. */
static void to_stone(const abbe_gem_stone *stone, double by[4]) {
  by[3] = (by[3] - abbe_vector_dot(by, stone->middle)) / stone->radius;
}

/* By the angle of the crown (side 0) or of the pavilion: all of its planes are stretched. */
static abbe_result by_side(const place *p, const abbe_gem_stone *stone, int side, double (*by)[4],
                           abbe_error *error) {
  const double h = 1e-6;
  const double angle =
      ABBE_DEGREE * abbe_cut_stretch_main_deg(&p->cut, &p->polyhedron,
                                              side == 0 ? ABBE_CUT_CROWN : ABBE_CUT_PAVILION);
  abbe_cut moved[2] = {{0}};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    const double factor = tan(angle + (i == 0 ? -h : h)) / tan(angle);
    result = copy_cut(&p->cut, &moved[i], error);
    if (result == ABBE_OK)
      result = abbe_cut_stretch_apply(&moved[i], &p->polyhedron, side == 0 ? factor : 1,
                                      side == 1 ? factor : 1, error);
  }
  for (size_t f = 0; f < stone->plane_count && result == ABBE_OK; f++) {
    const size_t facet = p->polyhedron.face[f].facet;
    const abbe_cut_facet *low = &moved[0].facet[facet], *high = &moved[1].facet[facet];
    for (int k = 0; k < 3; k++) by[f][k] = (high->n[k] - low->n[k]) / (2 * h);
    by[f][3] = (high->d - low->d) / (2 * h);
    to_stone(stone, by[f]);
  }
  for (int i = 0; i < 2; i++) {
    free(moved[i].tier);
    free(moved[i].facet);
  }
  return result;
}

/* By a tier's angle or distance alone. */
static void by_tier(const place *p, const abbe_gem_stone *stone, size_t scalar, double *unit,
                    double (*by)[4]) {
  unit[scalar] = 1;
  for (size_t f = 0; f < stone->plane_count; f++) {
    abbe_cut_meets_plane(&p->cut, p->polyhedron.face[f].facet, unit, by[f]);
    to_stone(stone, by[f]);
  }
  unit[scalar] = 0;
}

/* All derivatives of the design's measure; room: [planes][4] and [scalars] of zeros. */
static abbe_result derive(const place *p, const abbe_gem_stone *stone, const abbe_gem_slope *slope,
                          bool tiers, abbe_gem_number *out, abbe_error *error) {
  const size_t scalars = tiers ? 2 * p->cut.tier_count : 2;
  double(*by)[4] = calloc(stone->plane_count, sizeof *by);
  double *unit = calloc(scalars, sizeof *unit);
  abbe_result result = by == NULL || unit == NULL ? no_memory(error) : ABBE_OK;
  for (size_t s = 0; s < scalars && result == ABBE_OK; s++) {
    if (tiers)
      by_tier(p, stone, s, unit, by);
    else
      result = by_side(p, stone, (int)s, by, error);
    if (result == ABBE_OK) out[s] = abbe_gem_slope_by(slope, (const double(*)[4])by);
  }
  free(by);
  free(unit);
  return result;
}

/* ---- places ---- */

/* Which combinations of scalars are free there. */
static abbe_result find_free(const work *w, place *p, abbe_error *error) {
  abbe_cut_meets meets = {.scalars = 2, .freedoms = 2};
  if (w->tiers)
    ABBE_TRY(abbe_cut_meets_make(&p->cut, &p->polyhedron, &meets, error));
  else if ((meets.free = calloc(4, sizeof *meets.free)) == NULL)
    return no_memory(error);
  else
    meets.free[0] = meets.free[3] = 1;
  p->free = meets.free;
  p->freedoms = meets.freedoms;
  return ABBE_OK;
}

/* What of a combination is free. */
static void make_free(const work *w, const place *p, double *direction) {
  double *sum = calloc(w->scalars, sizeof *sum);
  for (size_t f = 0; f < p->freedoms && sum != NULL; f++) {
    double along = 0;
    for (size_t s = 0; s < w->scalars; s++) along += direction[s] * p->free[f * w->scalars + s];
    for (size_t s = 0; s < w->scalars; s++) sum[s] += along * p->free[f * w->scalars + s];
  }
  if (sum != NULL) memcpy(direction, sum, w->scalars * sizeof *sum);
  free(sum);
}

/* Its light and how that changes, uphill being better. */
static abbe_result look(work *w, place *p, abbe_error *error) {
  abbe_gem_stone stone;
  abbe_gem_slope slope;
  abbe_gem_number *by = calloc(w->scalars, sizeof *by);
  p->gradient = calloc(w->scalars, sizeof *p->gradient);
  if (by == NULL || p->gradient == NULL) {
    free(by);
    return no_memory(error);
  }
  const double sign = w->q->search.least ? -1 : 1;
  abbe_result result = follow(w, p, &stone, &slope, error);
  if (result == ABBE_OK) {
    p->value = sign * slope.value.value;
    result = derive(p, &stone, &slope, w->tiers, by, error);
    abbe_gem_slope_free(&slope);
    abbe_gem_stone_free(&stone);
  }
  if (result == ABBE_OK) result = find_free(w, p, error);
  for (size_t s = 0; s < w->scalars; s++) p->gradient[s] = sign * by[s].value;
  if (result == ABBE_OK) make_free(w, p, p->gradient);
  free(by);
  return result;
}

static double clamp(double x, double low, double high) {
  return fmin(fmax(x, low), high);
}

/* The two angles, which stay in their ranges. */
static abbe_result stretch(const work *w, const place *from, const double angle[2], place *to,
                           abbe_error *error) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  const double crown = clamp(angle[0], s->crown_from_rad, s->crown_to_rad);
  const double pavilion = clamp(angle[1], s->pavilion_from_rad, s->pavilion_to_rad);
  ABBE_TRY(abbe_cut_stretch_to(&to->cut, &from->polyhedron, crown / ABBE_DEGREE,
                               pavilion / ABBE_DEGREE, error));
  return abbe_cut_polyhedron_make(&to->cut, 0, &to->polyhedron, error);
}

static void angles_of(const place *p, double angle[2]) {
  angle[0] = ABBE_DEGREE * abbe_cut_stretch_main_deg(&p->cut, &p->polyhedron, ABBE_CUT_CROWN);
  angle[1] = ABBE_DEGREE * abbe_cut_stretch_main_deg(&p->cut, &p->polyhedron, ABBE_CUT_PAVILION);
}

/* The design that lies by so much off another. */
static abbe_result go(const work *w, const place *from, const double *change, place *to,
                      abbe_error *error) {
  *to = (place){0};
  abbe_result result = copy_cut(&from->cut, &to->cut, error);
  if (result == ABBE_OK && w->tiers)
    result = abbe_cut_meets_move(&to->cut, &from->polyhedron, change, &to->polyhedron, error);
  if (result == ABBE_OK && !w->tiers) {
    double angle[2];
    angles_of(from, angle);
    for (int k = 0; k < 2; k++) angle[k] += change[k];
    result = stretch(w, from, angle, to, error);
  }
  if (result != ABBE_OK) place_free(to);
  return result;
}

/* ---- uphill ---- */

static double dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* A direction conjugate to the last one [PolakRibiere1969], or the gradient. */
static void turn(const work *w, const place *was, const place *is, double *direction) {
  const size_t n = w->scalars;
  const double square = dot(was->gradient, was->gradient, n);
  double share =
      (dot(is->gradient, is->gradient, n) - dot(is->gradient, was->gradient, n)) / square;
  share = square > 0 ? clamp(share, 0, 2) : 0;
  for (size_t s = 0; s < n; s++) direction[s] = is->gradient[s] + share * direction[s];
  make_free(w, is, direction);
  if (dot(direction, is->gradient, n) > 0) return;
  memcpy(direction, is->gradient, n * sizeof *direction);
}

/* Where a parabola through two values and the first's slope is highest, of the step. */
static double shorter(double before, double slope, double after) {
  const double bend = before + slope - after;
  return bend > 0 ? clamp(0.5 * slope / bend, 0.1, 0.5) : 0.5;
}

/* Along one free combination alone, uphill. */
static void turn_to(const work *w, const place *at, size_t freedom, double *direction) {
  const double *free = at->free + freedom * w->scalars, along = dot(free, at->gradient, w->scalars);
  for (size_t s = 0; s < w->scalars; s++) direction[s] = along * free[s];
}

/* From `at`, which has been looked at, to the best that is found. Where the gradient leads no
 * further, be it that a facet would vanish, each free combination is tried by itself. */
static abbe_result climb(work *w, place *at, size_t most, abbe_error *error) {
  const size_t n = w->scalars, first = w->evaluations;
  double *direction = malloc(2 * n * sizeof *direction), step = STEP, least = LEAST_STEP;
  if (direction == NULL) return no_memory(error);
  double *change = direction + n;
  size_t alone = 0; /* the next of them */
  memcpy(direction, at->gradient, n * sizeof *direction);
  abbe_result result = ABBE_OK;
  while (result == ABBE_OK && w->evaluations < first + most) {
    if (step < least) {
      if (alone == at->freedoms) break;
      turn_to(w, at, alone++, direction);
      step = 0.25 * STEP;
      least = 0.1 * STEP;
    }
    const double length = sqrt(dot(direction, direction, n));
    for (size_t s = 0; s < n; s++) change[s] = length > 0 ? direction[s] / length * step : 0;
    place next = {0};
    if (!(length > 0) || go(w, at, change, &next, NULL) != ABBE_OK) {
      step *= length > 0 ? 0.5 : 0;
      continue;
    }
    result = look(w, &next, error);
    if (result == ABBE_OK && next.value > at->value) {
      turn(w, at, &next, direction);
      step = fmax(1.5 * step, 4 * LEAST_STEP);
      least = LEAST_STEP;
      alone = 0;
      place_free(at);
      *at = next;
      continue;
    }
    step *= shorter(at->value, dot(direction, at->gradient, n) / length * step, next.value);
    if (least == LEAST_STEP) memcpy(direction, at->gradient, n * sizeof *direction);
    place_free(&next);
  }
  free(direction);
  return result;
}

/* ---- searches ---- */

enum { ACROSS = 4, STARTS = ACROSS * ACROSS, WAYS = 2 };

static int better_first(const void *a, const void *b) {
  const double x = ((const place *)a)->value, y = ((const place *)b)->value;
  return (x < y) - (x > y);
}

/* The measure itself, as a search by a grid has it. */
static abbe_result judge(work *w, const place *p, abbe_gem_number *out, abbe_error *error) {
  abbe_gem_stone stone;
  abbe_gem_view view = {0};
  ABBE_TRY(make_stone(w, &p->cut, &p->polyhedron, &stone, error));
  w->evaluations++;
  abbe_result result = abbe_gem_view_make(&stone, w->weights, &w->q->search.view, &view, error);
  if (result == ABBE_OK) *out = abbe_gem_view_amount(&view, w->q->search.measure);
  abbe_gem_view_free(&view);
  abbe_gem_stone_free(&stone);
  return result;
}

static bool is_better(const work *w, abbe_gem_number a, abbe_gem_number b) {
  return w->q->search.least ? a.value < b.value : a.value > b.value;
}

static bool tell(const work *w, double done) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  return s->progress == NULL || s->progress(s->user, done);
}

/* Places all over the ranges; uphill from the best of them; and the best of these. */
static abbe_result search_pair(work *w, const place *design, abbe_gem_ascent *out, place *best,
                               abbe_error *error) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  const size_t most = 11;
  place start[STARTS] = {0};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < STARTS && result == ABBE_OK; i++) {
    const double across = (i % ACROSS + 0.5) / ACROSS,
                 up = ((i / ACROSS) + 0.5) / ACROSS; /* cells' middles */
    const double angle[2] = {s->crown_from_rad + across * (s->crown_to_rad - s->crown_from_rad),
                             s->pavilion_from_rad +
                                 up * (s->pavilion_to_rad - s->pavilion_from_rad)};
    result = copy_cut(&design->cut, &start[i].cut, error);
    if (result == ABBE_OK) result = stretch(w, design, angle, &start[i], error);
    if (result == ABBE_OK) result = look(w, &start[i], error);
    if (result == ABBE_OK && !tell(w, (i + 1.0) / 40))
      result = abbe_error_set(error, ABBE_CANCELLED, "the search was given up");
  }
  if (result == ABBE_OK) qsort(start, STARTS, sizeof *start, better_first);
  for (int i = 0; i < WAYS && result == ABBE_OK; i++) {
    abbe_gem_number value = {0};
    result = climb(w, &start[i], most, error);
    if (result == ABBE_OK) result = judge(w, &start[i], &value, error);
    if (result == ABBE_OK && !tell(w, 0.25 * (i + 2)))
      result = abbe_error_set(error, ABBE_CANCELLED, "the search was given up");
    if (result != ABBE_OK || (i > 0 && !is_better(w, value, out->value))) continue;
    out->value = value;
    place_free(best);
    *best = start[i];
    start[i] = (place){0};
  }
  for (int i = 0; i < STARTS; i++) place_free(&start[i]);
  return result;
}

/* Uphill from a design, and whether that is better than what out has. */
static abbe_result search_from(work *w, const place *design, bool first, abbe_gem_ascent *out,
                               place *best, abbe_error *error) {
  double *none = calloc(w->scalars, sizeof *none);
  if (none == NULL) return no_memory(error);
  place at = {0};
  abbe_gem_number value = {0};
  abbe_result result = go(w, design, none, &at, error);
  free(none);
  if (result == ABBE_OK) result = look(w, &at, error);
  if (result == ABBE_OK) result = climb(w, &at, w->q->most > 0 ? w->q->most : 60, error);
  if (result == ABBE_OK) result = judge(w, &at, &value, error);
  if (result == ABBE_OK && (first || is_better(w, value, out->value))) {
    out->value = value;
    place_free(best);
    *best = at;
    at = (place){0};
  }
  place_free(&at);
  return result;
}

/* From the best of two angles, and from the design itself. */
static abbe_result search_tiers(work *w, const place *design, abbe_gem_ascent *out, place *best,
                                abbe_error *error) {
  place pair = {0};
  abbe_result result = search_pair(w, design, out, &pair, error);
  w->tiers = true;
  w->scalars = 2 * design->cut.tier_count;
  if (result == ABBE_OK) result = search_from(w, &pair, true, out, best, error);
  if (result == ABBE_OK) result = search_from(w, design, false, out, best, error);
  place_free(&pair);
  return result;
}

/* By each tier's angle and distance. */
static abbe_result find_slopes(work *w, const place *p, abbe_gem_ascent *out, abbe_error *error) {
  abbe_gem_stone stone;
  abbe_gem_slope slope;
  out->scalars = 2 * p->cut.tier_count;
  out->slope = calloc(out->scalars, sizeof *out->slope);
  if (out->slope == NULL) return no_memory(error);
  ABBE_TRY(follow(w, p, &stone, &slope, error));
  const abbe_result result = derive(p, &stone, &slope, true, out->slope, error);
  abbe_gem_slope_free(&slope);
  abbe_gem_stone_free(&stone);
  return result;
}

abbe_result abbe_gem_ascent_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                 const abbe_material *material, const abbe_wavelengths *wavelengths,
                                 const abbe_weights *weights, const abbe_gem_ascent_desc *q,
                                 abbe_gem_ascent *out, abbe_error *error) {
  *out = (abbe_gem_ascent){0};
  work w = {material, wavelengths, weights, q, 2, 0, false};
  const place design = {.cut = *cut, .polyhedron = *polyhedron};
  place best = {0};
  abbe_result result = judge(&w, &design, &out->design, error);
  if (result == ABBE_OK) result = find_slopes(&w, &design, out, error);
  if (result == ABBE_OK)
    result = q->tiers ? search_tiers(&w, &design, out, &best, error)
                      : search_pair(&w, &design, out, &best, error);
  out->evaluations = w.evaluations;
  if (result == ABBE_OK) {
    out->cut = best.cut;
    out->polyhedron = best.polyhedron;
    best.cut.tier = NULL;
    best.cut.facet = NULL;
    best.polyhedron = (abbe_cut_polyhedron){0};
  }
  place_free(&best);
  if (result != ABBE_OK) abbe_gem_ascent_free(out);
  return result;
}

void abbe_gem_ascent_free(abbe_gem_ascent *a) {
  if (a == NULL) return;
  free(a->cut.tier);
  free(a->cut.facet);
  abbe_cut_polyhedron_free(&a->polyhedron);
  free(a->slope);
  *a = (abbe_gem_ascent){0};
}
