/* Rays through cells: abbe_volume_region_walk. */
#include "base/maths.h"
#include "scenes/volume/volume_region.h"

/* A ray and what it has been through. */
typedef struct walk {
  const abbe_volume_region *region;
  const double *o, *d;
  abbe_region_piece *piece;
  size_t count;
} walk;

static void add(walk *w, size_t cell, double length) {
  if (!(length > 0)) return;
  if (w->count > 0 && w->piece[w->count - 1].cell == cell)
    w->piece[w->count - 1].length += length;
  else if (w->count < ABBE_REGION_MOST_PIECES)
    w->piece[w->count++] = (abbe_region_piece){cell, length};
}

static void walk_grid(walk *w, double limit) {
  const size_t side = w->region->desc.side;
  const double half = w->region->desc.outer, step = 2 * half / (double)side;
  double t = 0, end = limit, next[3], each[3];
  long at[3], way[3];
  for (int k = 0; k < 3; k++) {
    const double a = (-half - w->o[k]) / w->d[k], b = (half - w->o[k]) / w->d[k];
    if (w->d[k] == 0 && !(fabs(w->o[k]) < half)) return;
    if (w->d[k] == 0) continue;
    t = fmax(t, fmin(a, b));
    end = fmin(end, fmax(a, b));
  }
  if (!(t < end)) return;
  for (int k = 0; k < 3; k++) {
    const double x = (w->o[k] + t * w->d[k] + half) / step;
    at[k] = (long)fmin(fmax(floor(x), 0), (double)(side - 1));
    way[k] = w->d[k] > 0 ? 1 : -1;
    each[k] = w->d[k] != 0 ? step / fabs(w->d[k]) : INFINITY;
    const double face = (double)(at[k] + (way[k] > 0)) * step - half;
    next[k] = w->d[k] != 0 ? (face - w->o[k]) / w->d[k] : INFINITY;
  }
  while (t < end) {
    const int k = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const double to = fmin(fmax(next[k], t), end);
    add(w, ((size_t)at[2] * side + (size_t)at[1]) * side + (size_t)at[0], to - t);
    t = to;
    next[k] += each[k];
    at[k] += way[k];
    if (at[k] < 0 || at[k] >= (long)side) return;
  }
}

/* Where the ray meets a sphere around the centre, the nearer or further place; NaN: nowhere. */
static double meet(const walk *w, double radius, bool further) {
  const double b = abbe_vector_dot(w->o, w->d), c = abbe_vector_dot(w->o, w->o);
  const double root = sqrt(b * b - c + radius * radius);
  return further ? -b + root : -b - root;
}

/* The edge that the ray leaves a face over, and where; at least t. */
static double leave_face(const walk *w, size_t face, double t, int *edge) {
  double least = INFINITY;
  *edge = 0;
  for (int k = 0; k < 3; k++) {
    const double *n = w->region->mesh.edge[face][k], along = abbe_vector_dot(n, w->d);
    if (!(along < 0)) continue;
    const double at = fmax(-abbe_vector_dot(n, w->o) / along, t);
    if (!(at < least)) continue;
    least = at;
    *edge = k;
  }
  return least;
}

/* Through the shell that it is in at t, and out of it; the shell that follows. */
static long cross_shell(walk *w, long shell, size_t *face, double *t, double end) {
  const abbe_volume_region *r = w->region;
  const double nearest = -abbe_vector_dot(w->o, w->d);
  const double in = *t < nearest ? meet(w, r->radius[shell], false) : NAN;
  const bool inwards = !isnan(in);
  const double out = fmax(inwards ? in : meet(w, r->radius[shell + 1], true), *t);
  const size_t most = 8 * r->mesh.face_count;
  for (size_t turn = 0; turn < most; turn++) {
    int edge;
    const double leave = leave_face(w, *face, *t, &edge), to = fmin(fmin(leave, out), end);
    const size_t in_row = r->desc.kind == ABBE_REGION_OCTAHEDRAL ? *face / 2 : *face;
    add(w, (size_t)shell * r->row + in_row, to - *t);
    *t = to;
    if (!(leave < out) || !(to < end)) break;
    *face = r->mesh.next[*face][edge];
  }
  return inwards ? shell - 1 : shell + 1;
}

static void find_face(const walk *w, double t, size_t *face) {
  double p[3];
  for (int k = 0; k < 3; k++) p[k] = w->o[k] + t * w->d[k];
  *face = abbe_sphere_mesh_find(&w->region->mesh, p);
}

static void walk_shells(walk *w, double limit) {
  const abbe_volume_region *r = w->region;
  const double first = meet(w, r->desc.outer, false), last = meet(w, r->desc.outer, true);
  if (isnan(first) || !(last > 0)) return;
  const double end = fmin(last, limit);
  double t = fmax(first, 0), p[3];
  for (int k = 0; k < 3; k++) p[k] = w->o[k] + t * w->d[k];
  const double radius = abbe_vector_length(p);
  long shell = (long)r->rows - 1;
  while (shell >= 0 && first < 0 && radius < r->radius[shell]) shell--;
  size_t face = abbe_sphere_mesh_find(&r->mesh, p);
  for (size_t turn = 0; turn < 4 * r->rows + 4 && t < end && shell < (long)r->rows; turn++) {
    if (shell >= 0) {
      shell = cross_shell(w, shell, &face, &t, end);
      continue;
    }
    t = fmax(meet(w, r->desc.inner, true), t);
    find_face(w, t, &face);
    shell = 0;
  }
}

size_t abbe_volume_region_walk(const abbe_volume_region *region, const double o[3],
                               const double d[3], double limit, abbe_region_piece *piece) {
  walk w = {.region = region, .o = o, .d = d, .piece = piece};
  if (region->desc.kind == ABBE_REGION_GRID)
    walk_grid(&w, limit);
  else
    walk_shells(&w, limit);
  return w.count;
}
