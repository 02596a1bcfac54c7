#include "scenes/volume/caustic_volume.h"

#include "base/maths.h"
#include "scenes/volume/half.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double unit_matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static size_t count_of(const abbe_caustic_volume *v) {
  return v->nodes.count * v->region.cells * abbe_caustic_volume_channels(v);
}

abbe_result abbe_caustic_volume_allocate(abbe_caustic_volume *v, abbe_error *error) {
  const size_t each = v->region.cells * abbe_caustic_volume_channels(v);
  if (each == 0 || v->nodes.count == 0 || v->kind == ABBE_VOLUME_EXITS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a volume without nodes, cells or values");
  if (v->nodes.count > ABBE_CAUSTIC_VOLUME_MOST / each)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu nodes of %zu cells are more than a volume holds: ask for fewer of "
                          "either",
                          v->nodes.count, v->region.cells);
  v->value = calloc(count_of(v), sizeof *v->value);
  if (v->value != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu nodes of %zu cells",
                        v->nodes.count, v->region.cells);
}

void abbe_caustic_volume_free(abbe_caustic_volume *v) {
  if (v == NULL) return;
  abbe_volume_region_free(&v->region);
  abbe_light_nodes_free(&v->nodes);
  abbe_light_exits_free(&v->exits);
  free(v->value);
  *v = (abbe_caustic_volume){0};
}

size_t abbe_caustic_volume_bytes(const abbe_caustic_volume *v) {
  if (v->kind == ABBE_VOLUME_EXITS) return abbe_light_exits_bytes(&v->exits);
  return count_of(v) * (v->kind == ABBE_VOLUME_PRINTED ? 1 : sizeof *v->value);
}

abbe_volume_lookup abbe_caustic_volume_resolve(const abbe_caustic_volume *v,
                                               abbe_volume_lookup lookup) {
  if (v->nodes.count == 1) return ABBE_VOLUME_LOOKUP_TURN;
  if (lookup != ABBE_VOLUME_LOOKUP_AUTO) return lookup;
  return v->body.ball ? ABBE_VOLUME_LOOKUP_TURN : ABBE_VOLUME_LOOKUP_BLEND;
}

void abbe_caustic_volume_look(const abbe_caustic_volume *v, abbe_volume_lookup lookup,
                              const double to_light[3], abbe_volume_sight *out) {
  abbe_node_blend blend;
  lookup = abbe_caustic_volume_resolve(v, lookup);
  for (size_t k = 0; k < 3; k++) memcpy(out->turn[k], unit_matrix, sizeof unit_matrix);
  if (lookup == ABBE_VOLUME_LOOKUP_NEAREST)
    abbe_light_nodes_nearest(&v->nodes, to_light, &blend);
  else
    abbe_light_nodes_blend(&v->nodes, to_light, &blend);
  out->count = blend.count;
  for (size_t k = 0; k < blend.count; k++) {
    out->node[k] = blend.node[k];
    out->weight[k] = blend.weight[k];
    if (lookup == ABBE_VOLUME_LOOKUP_TURN)
      abbe_light_nodes_turn(to_light, v->nodes.direction[blend.node[k]], out->turn[k]);
  }
}

/* Rays through cells: abbe_volume_region_walk. */

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

/* ---- making ---- */

static abbe_result check(const abbe_region_desc *d, abbe_error *error) {
  const bool grid = d->kind == ABBE_REGION_GRID;
  if (!(d->outer > 0) || !isfinite(d->outer) ||
      (!grid && (!(d->inner > 0) || !(d->inner < d->outer))))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a region from %g to %g m holds no space",
                          grid ? 0 : d->inner, d->outer);
  if (grid && (d->side < 2 || d->side > ABBE_REGION_MOST_SIDE))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a grid of %zu cells a side; it may be 2 to %d", d->side,
                          ABBE_REGION_MOST_SIDE);
  if (!grid && (d->shells < 1 || d->shells > ABBE_REGION_MOST_SHELLS))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu shells; it may be 1 to %d", d->shells,
                          ABBE_REGION_MOST_SHELLS);
  return ABBE_OK;
}

static abbe_result make_shells(abbe_volume_region *r, abbe_error *error) {
  const abbe_region_desc *d = &r->desc;
  const bool octahedral = d->kind == ABBE_REGION_OCTAHEDRAL;
  ABBE_TRY(octahedral ? abbe_sphere_mesh_octahedral(d->side, &r->mesh, error)
                      : abbe_sphere_mesh_geodesic(d->levels, &r->mesh, error));
  r->rows = d->shells;
  r->row = octahedral ? d->side * d->side : r->mesh.face_count;
  r->radius = calloc(r->rows + 1, sizeof *r->radius);
  r->solid_angle = calloc(r->row, sizeof *r->solid_angle);
  if (r->radius == NULL || r->solid_angle == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shells");
  for (size_t i = 0; i <= r->rows; i++)
    r->radius[i] = d->inner * pow(d->outer / d->inner, (double)i / (double)r->rows);
  r->radius[r->rows] = d->outer;
  for (size_t f = 0; f < r->mesh.face_count; f++)
    r->solid_angle[octahedral ? f / 2 : f] += abbe_sphere_mesh_area(&r->mesh, f);
  return ABBE_OK;
}

abbe_result abbe_volume_region_make(const abbe_region_desc *desc, abbe_volume_region *out,
                                    abbe_error *error) {
  *out = (abbe_volume_region){.desc = *desc};
  abbe_result result = check(desc, error);
  if (result == ABBE_OK && desc->kind == ABBE_REGION_GRID) {
    out->rows = desc->side;
    out->row = desc->side * desc->side;
  } else if (result == ABBE_OK) {
    result = make_shells(out, error);
  }
  out->cells = out->row * out->rows;
  if (result == ABBE_OK && out->cells > ABBE_REGION_MOST_CELLS)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu cells are more than %zu", out->cells,
                            ABBE_REGION_MOST_CELLS);
  if (result != ABBE_OK) abbe_volume_region_free(out);
  return result;
}

void abbe_volume_region_free(abbe_volume_region *r) {
  if (r == NULL) return;
  abbe_sphere_mesh_free(&r->mesh);
  free(r->radius);
  free(r->solid_angle);
  *r = (abbe_volume_region){0};
}

/* ---- places ---- */

static double step_of(const abbe_volume_region *r) {
  return 2 * r->desc.outer / (double)r->desc.side;
}

static size_t cell_of_face(const abbe_volume_region *r, size_t face) {
  return r->desc.kind == ABBE_REGION_OCTAHEDRAL ? face / 2 : face;
}

void abbe_volume_region_middle(const abbe_volume_region *r, size_t cell, double p[3]) {
  const size_t row = cell / r->row, in = cell % r->row, side = r->desc.side;
  if (r->desc.kind == ABBE_REGION_GRID) {
    const size_t at[3] = {in % side, in / side, row};
    for (int k = 0; k < 3; k++) p[k] = ((double)at[k] + 0.5) * step_of(r) - r->desc.outer;
    return;
  }
  if (r->desc.kind == ABBE_REGION_OCTAHEDRAL) {
    const double uv[2] = {2 * ((double)(in % side) + 0.5) / (double)side - 1,
                          2 * ((double)(in / side) + 0.5) / (double)side - 1};
    abbe_octahedral_direction(uv, p);
  } else {
    for (int k = 0; k < 3; k++) {
      p[k] = 0;
      for (int c = 0; c < 3; c++) p[k] += r->mesh.corner[r->mesh.face[in][c]][k];
    }
    abbe_vector_normalise(p);
  }
  const double radius = 0.5 * (r->radius[row] + r->radius[row + 1]);
  for (int k = 0; k < 3; k++) p[k] *= radius;
}

double abbe_volume_region_volume(const abbe_volume_region *r, size_t cell) {
  if (r->desc.kind == ABBE_REGION_GRID) return pow(step_of(r), 3);
  const size_t row = cell / r->row;
  return r->solid_angle[cell % r->row] * (pow(r->radius[row + 1], 3) - pow(r->radius[row], 3)) / 3;
}

/* Half the sum of what d meets of all faces of a triangle's part of a shell, of which sides that
 * two triangles of a cell share are not any. */
static double across_face(const abbe_volume_region *r, size_t row, size_t face, const double d[3]) {
  const double low = r->radius[row], high = r->radius[row + 1];
  const uint32_t *corner = r->mesh.face[face];
  double across[3], sum = 0;
  abbe_vector_triangle(r->mesh.corner[corner[0]], r->mesh.corner[corner[1]],
                       r->mesh.corner[corner[2]], across);
  sum += 0.5 * fabs(abbe_vector_dot(across, d)) * (low * low + high * high);
  for (int k = 0; k < 3; k++) {
    if (cell_of_face(r, r->mesh.next[face][k]) == cell_of_face(r, face)) continue;
    abbe_vector_cross(r->mesh.corner[corner[k]], r->mesh.corner[corner[(k + 1) % 3]], across);
    sum += 0.5 * fabs(abbe_vector_dot(across, d)) * (high * high - low * low);
  }
  return 0.5 * sum;
}

double abbe_volume_region_across(const abbe_volume_region *r, size_t cell, const double d[3]) {
  const size_t row = cell / r->row, in = cell % r->row;
  if (r->desc.kind == ABBE_REGION_GRID)
    return pow(step_of(r), 2) * (fabs(d[0]) + fabs(d[1]) + fabs(d[2]));
  if (r->desc.kind == ABBE_REGION_GEODESIC) return across_face(r, row, in, d);
  return across_face(r, row, 2 * in, d) + across_face(r, row, 2 * in + 1, d);
}
