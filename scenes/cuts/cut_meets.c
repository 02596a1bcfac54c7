#include "scenes/cuts/cut_meets.h"

#include "base/maths.h"
#include "scenes/cuts/cut_stretch.h"

#include <gsl/gsl_eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A combination is free where a whole turn, or a whole unit, moves corners apart by no more than
 * the square root of this. */
#define FREE 1e-9
/* How well corners meet after Newton's steps, units of the design. */
#define MET 1e-12

/* ---- what has to meet ---- */

typedef struct work {
  abbe_cut *cut;
  const abbe_cut_polyhedron *p;
  size_t scalars, most;     /* of facets in a corner */
  size_t *first, *facet;    /* of each corner, into facet[] */
  bool *fixed;              /* [scalars] it does not move */
  double *level;            /* [vertices] the height at which it stays, or NaN */
  double *rows, *matrix;    /* [most + 1][scalars], [scalars][scalars] */
  double *pull, (*near)[3]; /* [scalars] against what does not meet; [most] */
} work;

static void work_free(work *w) {
  free(w->first);
  free(w->facet);
  free(w->level);
  free(w->fixed);
  free(w->rows);
  free(w->matrix);
  free(w->pull);
  free(w->near);
}

static void list_corners(work *w) {
  const abbe_cut_polyhedron *p = w->p;
  for (size_t i = 0; i < p->corner_count; i++) w->first[p->corner[i] + 1]++;
  for (size_t v = 0; v < p->vertex_count; v++) {
    w->most = w->first[v + 1] > w->most ? w->first[v + 1] : w->most;
    w->first[v + 1] += w->first[v];
  }
  for (size_t f = 0; f < p->face_count; f++)
    for (size_t i = 0; i < p->face[f].count; i++) {
      const size_t v = p->corner[p->face[f].first + i];
      w->facet[w->first[v]++] = p->face[f].facet;
    }
  for (size_t v = p->vertex_count; v > 0; v--) w->first[v] = w->first[v - 1];
  w->first[0] = 0;
}

static bool is_flat(const abbe_cut_facet *f) {
  return hypot(f->n[0], f->n[1]) < 1e-9;
}

/* The girdle's scalars, flat facets' angles and what has no face stay; so do the corners where the
 * girdle is thinnest. */
static void hold(work *w) {
  const abbe_cut_polyhedron *p = w->p;
  abbe_cut_measures m;
  abbe_cut_measures_make(w->cut, p, &m);
  for (size_t s = 0; s < w->scalars; s++) w->fixed[s] = true;
  for (size_t f = 0; f < p->face_count; f++) {
    const abbe_cut_facet *facet = &w->cut->facet[p->face[f].facet];
    if (abbe_cut_side_of(facet) == ABBE_CUT_GIRDLE) continue;
    w->fixed[2 * facet->tier + 1] = false;
    if (!is_flat(facet)) w->fixed[2 * facet->tier] = false;
  }
  const double near = 1e-6 * m.width;
  for (size_t v = 0; v < p->vertex_count; v++) {
    bool side[ABBE_CUT_SIDE_COUNT] = {false};
    for (size_t i = w->first[v]; i < w->first[v + 1]; i++)
      side[abbe_cut_side_of(&w->cut->facet[w->facet[i]])] = true;
    const double z = p->vertex[v][2];
    w->level[v] = NAN;
    if (side[ABBE_CUT_GIRDLE] && side[ABBE_CUT_CROWN] && fabs(z - m.crown_edge) < near)
      w->level[v] = m.crown_edge;
    if (side[ABBE_CUT_GIRDLE] && side[ABBE_CUT_PAVILION] && fabs(z - m.pavilion_edge) < near)
      w->level[v] = m.pavilion_edge;
  }
}

static abbe_result work_make(const abbe_cut *cut, const abbe_cut_polyhedron *p, work *w,
                             abbe_error *error) {
  *w = (work){.cut = (abbe_cut *)cut, .p = p, .scalars = 2 * cut->tier_count};
  w->first = calloc(p->vertex_count + 2, sizeof *w->first);
  w->facet = calloc(p->corner_count + 1, sizeof *w->facet);
  w->level = calloc(p->vertex_count, sizeof *w->level);
  w->fixed = calloc(w->scalars, sizeof *w->fixed);
  w->matrix = calloc(w->scalars * w->scalars, sizeof *w->matrix);
  w->pull = calloc(w->scalars, sizeof *w->pull);
  if (w->first && w->facet) list_corners(w);
  w->rows = calloc((w->most + 1) * w->scalars, sizeof *w->rows);
  w->near = calloc(w->most + 1, sizeof *w->near);
  if (w->first && w->facet && w->level && w->fixed && w->matrix && w->pull && w->rows && w->near) {
    hold(w);
    return ABBE_OK;
  }
  work_free(w);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design's meets");
}

/* ---- equations ---- */

/* Derivatives of n by the angle, and of d by the distance: the rest is 0. */
static void lean(const abbe_cut_facet *f, double by[3]) {
  const double side = hypot(f->n[0], f->n[1]), up = fabs(f->n[2]);
  for (int k = 0; k < 2; k++) by[k] = side > 0 ? f->n[k] / side * up : 0;
  by[2] = f->n[2] < 0 ? side : -side;
}

void abbe_cut_meets_plane(const abbe_cut *cut, size_t facet, const double *change, double by[4]) {
  const abbe_cut_facet *f = &cut->facet[facet];
  lean(f, by);
  for (int k = 0; k < 3; k++) by[k] *= change[2 * f->tier];
  by[3] = change[2 * f->tier + 1];
}

static bool invert(const double a[3][3], double out[3][3]) {
  double x[3], y[3], z[3];
  abbe_vector_cross(a[1], a[2], x);
  abbe_vector_cross(a[2], a[0], y);
  abbe_vector_cross(a[0], a[1], z);
  const double det = abbe_vector_dot(a[0], x);
  for (int k = 0; k < 3; k++) {
    out[k][0] = x[k] / det;
    out[k][1] = y[k] / det;
    out[k][2] = z[k] / det;
  }
  return fabs(det) > 1e-15;
}

/* A row of the equations, row . change = -off. */
static void add_row(work *w, const double *row, double off) {
  for (size_t a = 0; a < w->scalars; a++) {
    if (row[a] == 0) continue;
    w->pull[a] -= row[a] * off;
    for (size_t b = 0; b < w->scalars; b++) w->matrix[a * w->scalars + b] += row[a] * row[b];
  }
}

/* The corner at x is where its planes are nearest to, by least squares: near[i] is that place's
 * derivative by d of plane i. */
static bool find_corner(work *w, size_t v, double x[3]) {
  double square[3][3] = {{0}}, inverse[3][3];
  const size_t count = w->first[v + 1] - w->first[v], *facet = w->facet + w->first[v];
  for (size_t i = 0; i < count; i++)
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        square[a][b] += w->cut->facet[facet[i]].n[a] * w->cut->facet[facet[i]].n[b];
  if (!invert((const double(*)[3])square, inverse)) return false;
  memset(x, 0, 3 * sizeof *x);
  for (size_t i = 0; i < count; i++)
    for (int a = 0; a < 3; a++) {
      w->near[i][a] = abbe_vector_dot(inverse[a], w->cut->facet[facet[i]].n);
      x[a] += w->near[i][a] * w->cut->facet[facet[i]].d;
    }
  return true;
}

/* Adds what a corner asks for; returns by how much its planes miss it, -1 where they are one. */
static double add_corner(work *w, size_t v) {
  double x[3], worst = 0, height;
  const size_t count = w->first[v + 1] - w->first[v], *facet = w->facet + w->first[v];
  const bool held = !isnan(w->level[v]);
  if (count < 4 && !held) return 0;
  if (!find_corner(w, v, x)) return -1;
  double *up = w->rows + count * w->scalars;
  memset(w->rows, 0, (count + 1) * w->scalars * sizeof *w->rows);
  for (size_t j = 0; j < count; j++) {
    const abbe_cut_facet *f = &w->cut->facet[facet[j]];
    double by[3];
    lean(f, by);
    /* plane j is off the place x by so much a change, and the place moves against it */
    const double off[2] = {abbe_vector_dot(by, x), -1};
    for (int k = 0; k < 2; k++) {
      const size_t s = 2 * f->tier + (size_t)k;
      if (w->fixed[s]) continue;
      up[s] -= w->near[j][2] * off[k];
      for (size_t i = 0; i < count; i++)
        w->rows[i * w->scalars + s] +=
            off[k] * ((i == j) - abbe_vector_dot(w->cut->facet[facet[i]].n, w->near[j]));
    }
  }
  for (size_t i = 0; i < count; i++) {
    const abbe_cut_facet *f = &w->cut->facet[facet[i]];
    const double off = abbe_vector_dot(f->n, x) - f->d;
    worst = fmax(worst, fabs(off));
    add_row(w, w->rows + i * w->scalars, off);
  }
  height = x[2] - w->level[v];
  if (held) add_row(w, up, height);
  return held ? fmax(worst, fabs(height)) : worst;
}

/* All equations of where the planes are; returns by how much they are not met, or -1. */
static double gather(work *w) {
  double worst = 0;
  memset(w->matrix, 0, w->scalars * w->scalars * sizeof *w->matrix);
  memset(w->pull, 0, w->scalars * sizeof *w->pull);
  for (size_t v = 0; v < w->p->vertex_count && worst >= 0; v++) {
    const double off = add_corner(w, v);
    worst = off < 0 ? -1 : fmax(worst, off);
  }
  for (size_t s = 0; s < w->scalars; s++)
    if (w->fixed[s]) w->matrix[s * w->scalars + s] = 1;
  return worst;
}

/* Eigenvalues, and vectors as columns. false without memory. */
static bool solve(work *w, gsl_vector **values, gsl_matrix **vectors) {
  *values = gsl_vector_alloc(w->scalars);
  *vectors = gsl_matrix_alloc(w->scalars, w->scalars);
  gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(w->scalars);
  const bool made = *values != NULL && *vectors != NULL && space != NULL;
  if (made) {
    gsl_matrix_view m = gsl_matrix_view_array(w->matrix, w->scalars, w->scalars);
    gsl_eigen_symmv(&m.matrix, *values, *vectors, space);
  }
  gsl_eigen_symmv_free(space);
  return made;
}

abbe_result abbe_cut_meets_make(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                                abbe_cut_meets *out, abbe_error *error) {
  work w;
  gsl_vector *values = NULL;
  gsl_matrix *vectors = NULL;
  *out = (abbe_cut_meets){.scalars = 2 * cut->tier_count};
  ABBE_TRY(work_make(cut, p, &w, error));
  abbe_result result = ABBE_OK;
  gather(&w);
  out->free = calloc(w.scalars * w.scalars, sizeof *out->free);
  if (out->free == NULL || !solve(&w, &values, &vectors))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a design's meets");
  for (size_t i = 0; i < w.scalars && result == ABBE_OK; i++) {
    if (gsl_vector_get(values, i) > FREE) continue;
    for (size_t s = 0; s < w.scalars; s++)
      out->free[out->freedoms * w.scalars + s] = gsl_matrix_get(vectors, s, i);
    out->freedoms++;
  }
  gsl_vector_free(values);
  gsl_matrix_free(vectors);
  work_free(&w);
  if (result != ABBE_OK) abbe_cut_meets_free(out);
  return result;
}

void abbe_cut_meets_free(abbe_cut_meets *meets) {
  free(meets->free);
  *meets = (abbe_cut_meets){0};
}

/* ---- moves ---- */

/* Leans and moves a tier's facets; false where it would pass level or upright. */
static bool move_tier(abbe_cut *cut, size_t tier, double angle, double distance) {
  abbe_cut_tier *t = &cut->tier[tier];
  const double to = fabs(t->angle_deg) * ABBE_DEGREE + angle;
  const double least = ABBE_CUT_GIRDLE_DEG * ABBE_DEGREE;
  if (angle != 0 && !(to > least && to < ABBE_PI / 2 - least)) return false;
  t->distance += distance;
  for (size_t i = t->first; i < t->first + t->count; i++) {
    abbe_cut_facet *f = &cut->facet[i];
    const double side = hypot(f->n[0], f->n[1]);
    f->d += distance;
    if (angle == 0) continue;
    for (int k = 0; k < 2; k++) f->n[k] *= sin(to) / side;
    f->n[2] = copysign(cos(to), f->n[2]);
  }
  if (angle != 0) t->angle_deg = copysign(to / ABBE_DEGREE, t->angle_deg);
  return t->distance > 1 / ABBE_CUT_FAR;
}

static bool move_all(work *w, const double *change) {
  for (size_t t = 0; t < w->cut->tier_count; t++) {
    const size_t s = 2 * t;
    if (!move_tier(w->cut, t, w->fixed[s] ? 0 : change[s], w->fixed[s + 1] ? 0 : change[s + 1]))
      return false;
  }
  return true;
}

/* One of Newton's steps, the smallest that brings the corners together. */
static bool newton(work *w) {
  gsl_vector *values = NULL;
  gsl_matrix *vectors = NULL;
  bool made = solve(w, &values, &vectors);
  double *step = w->rows; /* its first row: of no use until the next step */
  memset(step, 0, w->scalars * sizeof *step);
  for (size_t i = 0; made && i < w->scalars; i++) {
    const double value = gsl_vector_get(values, i);
    double pull = 0;
    if (value <= FREE) continue;
    for (size_t s = 0; s < w->scalars; s++) pull += gsl_matrix_get(vectors, s, i) * w->pull[s];
    for (size_t s = 0; s < w->scalars; s++) step[s] += gsl_matrix_get(vectors, s, i) * pull / value;
  }
  gsl_vector_free(values);
  gsl_matrix_free(vectors);
  return made && move_all(w, step);
}

static bool bring_together(work *w) {
  double off = gather(w);
  for (int i = 0; i < 20 && off > MET; i++) {
    if (!newton(w)) return false;
    off = gather(w);
  }
  return off >= 0 && off <= MET;
}

static abbe_result settle(work *w, const double *change, abbe_cut_polyhedron *moved,
                          abbe_error *error) {
  if (!move_all(w, change) || !bring_together(w))
    return abbe_error_set(error, ABBE_GEOMETRY, "the meets cannot be kept so far from the design");
  ABBE_TRY(abbe_cut_polyhedron_make(w->cut, 0, moved, error));
  const abbe_cut_polyhedron *p = w->p;
  if (moved->face_count == p->face_count && moved->vertex_count == p->vertex_count) return ABBE_OK;
  abbe_cut_polyhedron_free(moved);
  return abbe_error_set(error, ABBE_GEOMETRY, "facets or corners would come or go");
}

abbe_result abbe_cut_meets_move(abbe_cut *cut, const abbe_cut_polyhedron *p, const double *change,
                                abbe_cut_polyhedron *moved, abbe_error *error) {
  work w;
  abbe_cut own;
  ABBE_TRY(abbe_cut_copy(cut, &own, error));
  abbe_result result = work_make(&own, p, &w, error);
  if (result == ABBE_OK) {
    result = settle(&w, change, moved, error);
    work_free(&w);
  }
  if (result == ABBE_OK) {
    memcpy(cut->tier, own.tier, cut->tier_count * sizeof *own.tier);
    memcpy(cut->facet, own.facet, cut->facet_count * sizeof *own.facet);
  }
  abbe_cut_copy_free(&own);
  return result;
}
