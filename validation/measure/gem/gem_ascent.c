#include "validation/measure/gem/gem_ascent.h"

#include "base/maths.h"
#include "scenes/cuts/cut_meets.h"
#include "scenes/cuts/cut_stretch.h"
#include "validation/measure/gem/gem_slope.h"
#include "validation/measure/surrogate.h"

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
} work;

static void place_free(place *p) {
  abbe_cut_copy_free(&p->cut);
  abbe_cut_polyhedron_free(&p->polyhedron);
  free(p->gradient);
  free(p->free);
  *p = (place){0};
}

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a search of angles");
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
                                    .fire = s->least ? -w->q->fire : w->q->fire,
                                    .spread = w->q->spread,
                                    .axis_rad = s->view.axis_rad,
                                    .tilt_rad = s->view.tilt_rad,
                                    .head_rad = s->view.head_rad,
                                    .soft_rad = SOFT,
                                    .threads = s->view.threads};
  ABBE_TRY(make_stone(w, &p->cut, &p->polyhedron, stone, error));
  w->evaluations++;
  const abbe_result result = abbe_gem_slope_make(stone, w->weights, &desc, 1, slope, error);
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
    result = abbe_cut_copy(&p->cut, &moved[i], error);
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
  for (int i = 0; i < 2; i++) abbe_cut_copy_free(&moved[i]);
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
    if (result == ABBE_OK)
      out[s] = abbe_gem_slope_by(slope, &(abbe_gem_change){.plane = (const double(*)[4])by});
  }
  free(by);
  free(unit);
  return result;
}

/* ---- places ---- */

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
    result = derive(p, &stone, &slope, true, by, error);
    abbe_gem_slope_free(&slope);
    abbe_gem_stone_free(&stone);
  }
  abbe_cut_meets meets = {0};
  if (result == ABBE_OK) result = abbe_cut_meets_make(&p->cut, &p->polyhedron, &meets, error);
  p->free = meets.free;
  p->freedoms = meets.freedoms;
  for (size_t s = 0; s < w->scalars; s++) p->gradient[s] = sign * by[s].value;
  if (result == ABBE_OK) make_free(w, p, p->gradient);
  free(by);
  return result;
}

/* The design that lies by so much off another. */
static abbe_result go(const place *from, const double *change, place *to, abbe_error *error) {
  *to = (place){0};
  abbe_result result = abbe_cut_copy(&from->cut, &to->cut, error);
  if (result == ABBE_OK)
    result = abbe_cut_meets_move(&to->cut, &from->polyhedron, change, &to->polyhedron, error);
  if (result != ABBE_OK) place_free(to);
  return result;
}

/* ---- uphill ---- */

static double clamp(double x, double low, double high) {
  return fmin(fmax(x, low), high);
}

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
    if (!(length > 0) || go(at, change, &next, NULL) != ABBE_OK) {
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

/* Of two angles so many stones are followed, the first in a square of these, and others until
 * there, where the process is unsure. So many of the best are judged, and what lies beside the best
 * of these. */
enum { PAIRS = 34, ACROSS = 3, UNSURE = 22, JUDGED = 4, BESIDE = 4 };

/* The design at a place of both ranges. */
static abbe_result pair_at(const work *w, const place *design, const double x[2], place *to,
                           abbe_error *error) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  const double crown = s->crown_from_rad + x[0] * (s->crown_to_rad - s->crown_from_rad);
  const double pavilion = s->pavilion_from_rad + x[1] * (s->pavilion_to_rad - s->pavilion_from_rad);
  *to = (place){0};
  abbe_result result = abbe_cut_copy(&design->cut, &to->cut, error);
  if (result == ABBE_OK)
    result = abbe_cut_stretch_to(&to->cut, &design->polyhedron, crown / ABBE_DEGREE,
                                 pavilion / ABBE_DEGREE, error);
  if (result == ABBE_OK) result = abbe_cut_polyhedron_make(&to->cut, 0, &to->polyhedron, error);
  if (result != ABBE_OK) place_free(to);
  return result;
}

static abbe_result look_at_pair(work *w, const place *design, abbe_surrogate *known,
                                abbe_error *error) {
  const abbe_gem_optimum_desc *s = &w->q->search;
  const double wide[2] = {s->crown_to_rad - s->crown_from_rad,
                          s->pavilion_to_rad - s->pavilion_from_rad};
  const double sign = s->least ? -1 : 1;
  const size_t i = known->count;
  place p;
  abbe_gem_stone stone;
  abbe_gem_slope slope;
  abbe_gem_number by[2];
  ABBE_TRY(pair_at(w, design, known->at[i], &p, error));
  abbe_result result = follow(w, &p, &stone, &slope, error);
  if (result == ABBE_OK) {
    result = derive(&p, &stone, &slope, false, by, error);
    known->value[i] = sign * slope.value.value;
    for (int k = 0; k < 2; k++) known->by[i][k] = sign * by[k].value * wide[k];
    known->count++;
    abbe_gem_slope_free(&slope);
    abbe_gem_stone_free(&stone);
  }
  place_free(&p);
  if (result == ABBE_OK && !tell(w, (double)known->count / PAIRS))
    result = abbe_error_set(error, ABBE_CANCELLED, "the search was given up");
  return result;
}

/* The best of what is known, far from those that were; -1: none. */
static int next_best(const abbe_surrogate *known, const int *taken, int count) {
  int best = -1;
  for (int i = 0; i < (int)known->count; i++) {
    bool far = true;
    for (int k = 0; k < count; k++)
      far = far && hypot(known->at[i][0] - known->at[taken[k]][0],
                         known->at[i][1] - known->at[taken[k]][1]) > 0.03;
    if (far && (best < 0 || known->value[i] > known->value[best])) best = i;
  }
  return best;
}

/* Judges a pair, and takes it where it is better than what out has. */
static abbe_result judge_pair(work *w, const place *design, double x[2], bool first,
                              double best_x[2], abbe_gem_ascent *out, place *best,
                              abbe_error *error) {
  place p;
  abbe_gem_number value;
  for (int k = 0; k < 2; k++) x[k] = clamp(x[k], 0, 1);
  ABBE_TRY(pair_at(w, design, x, &p, error));
  const abbe_result result = judge(w, &p, &value, error);
  if (result == ABBE_OK && (first || is_better(w, value, out->value))) {
    memcpy(best_x, x, 2 * sizeof *x);
    out->value = value;
    place_free(best);
    *best = p;
    return ABBE_OK;
  }
  place_free(&p);
  return result;
}

static abbe_result judge_pairs(work *w, const place *design, const abbe_surrogate *known,
                               abbe_gem_ascent *out, place *best, abbe_error *error) {
  int taken[JUDGED];
  double x[2], centre[2], unused[2];
  for (int i = 0; i < JUDGED; i++) {
    taken[i] = next_best(known, taken, i);
    if (taken[i] < 0) break;
    memcpy(x, known->at[taken[i]], sizeof x);
    ABBE_TRY(judge_pair(w, design, x, i == 0, centre, out, best, error));
  }
  for (int i = 0; i < BESIDE; i++) {
    memcpy(x, centre, sizeof x);
    x[1 - i / 2] += i % 2 ? 0.025 : -0.025;
    ABBE_TRY(judge_pair(w, design, x, false, unused, out, best, error));
  }
  return ABBE_OK;
}

/* Stones are followed where those that are known, with their derivatives, promise most. */
static abbe_result search_pair(work *w, const place *design, abbe_gem_ascent *out, place *best,
                               abbe_error *error) {
  abbe_surrogate *known = malloc(sizeof *known);
  if (known == NULL) return no_memory(error);
  known->count = 0;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < PAIRS && result == ABBE_OK; i++) {
    double *x = known->at[i];
    x[0] = (i % ACROSS + 0.5) / ACROSS;
    x[1] = ((i / ACROSS) + 0.5) / ACROSS;
    if (i >= ACROSS * ACROSS) {
      if (!abbe_surrogate_fit(known)) break;
      abbe_surrogate_best(known, i < UNSURE ? 1 : 0, x);
    }
    result = look_at_pair(w, design, known, error);
  }
  if (result == ABBE_OK) result = judge_pairs(w, design, known, out, best, error);
  free(known);
  return result;
}

/* Uphill from a design, and whether that is better than what out has. */
static abbe_result search_from(work *w, const place *design, bool first, abbe_gem_ascent *out,
                               place *best, abbe_error *error) {
  double *none = calloc(w->scalars, sizeof *none);
  if (none == NULL) return no_memory(error);
  place at = {0};
  abbe_gem_number value = {0};
  abbe_result result = go(design, none, &at, error);
  free(none);
  if (result == ABBE_OK) result = look(w, &at, error);
  if (result == ABBE_OK) result = climb(w, &at, w->q->most > 0 ? w->q->most : 100, error);
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

/* From the best of two angles, unless both sides can only be stretched as one, and from the design
 * itself. */
static abbe_result search_tiers(work *w, const place *design, abbe_gem_ascent *out, place *best,
                                abbe_error *error) {
  place pair = {0};
  abbe_result result = ABBE_OK;
  const bool near = w->q->near || abbe_cut_stretch_bound(&design->cut, &design->polyhedron);
  if (!near) result = search_pair(w, design, out, &pair, error);
  if (!near && result == ABBE_OK) result = search_from(w, &pair, true, out, best, error);
  if (result == ABBE_OK) result = search_from(w, design, near, out, best, error);
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
  work w = {material, wavelengths, weights, q, 2 * cut->tier_count, 0};
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
    best.cut = (abbe_cut){0};
    best.polyhedron = (abbe_cut_polyhedron){0};
  }
  place_free(&best);
  if (result != ABBE_OK) abbe_gem_ascent_free(out);
  return result;
}

void abbe_gem_ascent_free(abbe_gem_ascent *a) {
  if (a == NULL) return;
  abbe_cut_copy_free(&a->cut);
  abbe_cut_polyhedron_free(&a->polyhedron);
  free(a->slope);
  *a = (abbe_gem_ascent){0};
}
