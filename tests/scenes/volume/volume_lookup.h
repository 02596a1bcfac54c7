/* volume_lookup.h: what volume_lookup.glsl does, in doubles: which cells hold a place or lie
 * around it, and what volumes and maps of rays have there. */
#ifndef ABBE_TESTS_SCENES_VOLUME_VOLUME_LOOKUP_H
#define ABBE_TESTS_SCENES_VOLUME_VOLUME_LOOKUP_H

#include "base/maths.h"
#include "scenes/volume/caustic_volume.h"
#include "scenes/volume/exits/exit_pages.h"
#include "scenes/volume/half.h"

#include <math.h>
#include <string.h>

static inline double step_of(const abbe_volume_region *r) {
  return 2 * r->desc.outer / (double)r->desc.side;
}

static inline size_t cell_of_face(const abbe_volume_region *r, size_t face) {
  return r->desc.kind == ABBE_REGION_OCTAHEDRAL ? face / 2 : face;
}

/* Which shell, as a number: 0 at the inside of the first, `rows` at the outside of the last. */
static inline double shell_of(const abbe_volume_region *r, double radius) {
  return (double)r->rows * log(radius / r->desc.inner) / log(r->desc.outer / r->desc.inner);
}

static inline bool find(const abbe_volume_region *r, const double p[3], bool by_table,
                        size_t *cell) {
  if (r->desc.kind == ABBE_REGION_GRID) {
    size_t at[3];
    for (int k = 0; k < 3; k++) {
      const double x = (p[k] + r->desc.outer) / step_of(r);
      if (!(x >= 0) || !(x < (double)r->desc.side)) return false;
      at[k] = (size_t)x;
    }
    *cell = (at[2] * r->desc.side + at[1]) * r->desc.side + at[0];
    return true;
  }
  const double radius = abbe_vector_length(p);
  if (!(radius >= r->desc.inner) || !(radius < r->desc.outer)) return false;
  const double shell = shell_of(r, radius);
  size_t row = shell > 0 ? (size_t)shell : 0;
  if (row >= r->rows) row = r->rows - 1;
  by_table = by_table && r->desc.kind == ABBE_REGION_GEODESIC;
  *cell = row * r->row + cell_of_face(r, by_table ? abbe_sphere_mesh_look_up(&r->mesh, p)
                                                  : abbe_sphere_mesh_find(&r->mesh, p));
  return true;
}

/* The cell of a place; false outside the region, and within its first shell. */
static inline bool abbe_volume_region_find(const abbe_volume_region *r, const double p[3],
                                           size_t *cell) {
  return find(r, p, false, cell);
}

/* The same by the table of directions, which near an edge of triangles may have the one beside. */
static inline bool abbe_volume_region_look_up(const abbe_volume_region *r, const double p[3],
                                              size_t *cell) {
  return find(r, p, true, cell);
}

/* Below and above x, cells' middles being at 0.5, 1.5 ..., and the share of the second. */
static inline double split(double x, size_t count, size_t at[2]) {
  const double most = (double)count - 1, y = fmin(fmax(x - 0.5, 0), most);
  at[0] = (size_t)y;
  at[1] = at[0] + 1 < count ? at[0] + 1 : at[0];
  return y - (double)at[0];
}

/* Texel (i, j) of the octahedral map, which may lie one beyond its rim. */
static inline size_t fold(size_t side, long i, long j) {
  const long n = (long)side;
  if (i < 0 || i >= n) {
    i = i < 0 ? 0 : n - 1;
    j = n - 1 - j;
  }
  if (j < 0 || j >= n) {
    j = j < 0 ? 0 : n - 1;
    i = n - 1 - i;
  }
  return (size_t)j * side + (size_t)i;
}

static inline size_t between_octahedral(const abbe_volume_region *r, const double p[3],
                                        size_t in[4], double weight[4]) {
  double uv[2], part[2];
  long at[2];
  abbe_octahedral_place(p, uv);
  for (int k = 0; k < 2; k++) {
    const double x = (uv[k] + 1) / 2 * (double)r->desc.side - 0.5;
    at[k] = (long)floor(x);
    part[k] = x - floor(x);
  }
  for (size_t k = 0; k < 4; k++) {
    const bool right = k % 2 != 0, up = k / 2 != 0;
    in[k] = fold(r->desc.side, at[0] + right, at[1] + up);
    weight[k] = (right ? part[0] : 1 - part[0]) * (up ? part[1] : 1 - part[1]);
  }
  return 4;
}

static inline size_t between_grid(const abbe_volume_region *r, const double p[3], size_t cell[8],
                                  double weight[8]) {
  size_t at[3][2];
  double part[3];
  for (int k = 0; k < 3; k++)
    part[k] = split((p[k] + r->desc.outer) / step_of(r), r->desc.side, at[k]);
  for (size_t i = 0; i < 8; i++) {
    cell[i] = (at[2][i / 4] * r->desc.side + at[1][i / 2 % 2]) * r->desc.side + at[0][i % 2];
    weight[i] = 1;
    for (size_t k = 0; k < 3; k++) weight[i] *= (i >> k & 1) ? part[k] : 1 - part[k];
  }
  return 8;
}

/* The cells that a place lies between and their weights, which sum to 1: on a grid and of an
 * octahedral map eight by linear interpolation, of triangles two shells' one; clamped to the
 * region's own. Returns how many. */
static inline size_t abbe_volume_region_between(const abbe_volume_region *r, const double p[3],
                                                size_t cell[8], double weight[8]) {
  if (r->desc.kind == ABBE_REGION_GRID) return between_grid(r, p, cell, weight);
  size_t row[2], in[4] = {0}, count = 1;
  double share[4] = {1};
  const double radius = fmax(abbe_vector_length(p), 1e-300);
  const double part = split(shell_of(r, radius), r->rows, row);
  if (r->desc.kind == ABBE_REGION_OCTAHEDRAL)
    count = between_octahedral(r, p, in, share);
  else
    in[0] = abbe_sphere_mesh_look_up(&r->mesh, p);
  for (size_t i = 0; i < 2 * count; i++) {
    cell[i] = row[i / count] * r->row + in[i % count];
    weight[i] = share[i % count] * (i < count ? 1 - part : part);
  }
  return 2 * count;
}

/* Into the region, towards its centre or away from it; the share of the distance that is left. */
static inline double clamp_place(const abbe_volume_region *r, const double p[3], double q[3]) {
  const bool grid = r->desc.kind == ABBE_REGION_GRID;
  const double most = 1 - 1e-9;
  double size = grid ? fmax(fmax(fabs(p[0]), fabs(p[1])), fabs(p[2])) : abbe_vector_length(p);
  double scale = size > most * r->desc.outer ? most * r->desc.outer / size : 1;
  if (!grid && size < r->desc.inner && size > 0) scale = r->desc.inner * (1 + 1e-9) / size;
  for (int k = 0; k < 3; k++) q[k] = scale * p[k];
  return scale;
}

static inline void apply(const double m[9], const double p[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = abbe_vector_dot(&m[3 * i], p);
}

static inline const uint16_t *values_at(const abbe_caustic_volume *v, size_t node, size_t cell) {
  return v->value + (node * v->region.cells + cell) * abbe_caustic_volume_channels(v);
}

/* Vector irradiance at p of light of unit irradiance: f[0] of X, f[1] of Y, f[2] of Z, interpolated
 * between cells; beyond the region that of its rim towards p, thinned by the square of the
 * distance. ABBE_VOLUME_VECTOR alone. */
static inline void abbe_caustic_volume_flux(const abbe_caustic_volume *v,
                                            const abbe_volume_sight *sight, const double p[3],
                                            double f[3][3]) {
  double q[3];
  const double scale = fmin(clamp_place(&v->region, p, q), 1);
  memset(f, 0, 9 * sizeof(double));
  for (size_t k = 0; k < sight->count; k++) {
    const double *turn = sight->turn[k];
    double at[3], weight[8], sum[9] = {0};
    size_t cell[8];
    apply(turn, q, at);
    const size_t count = abbe_volume_region_between(&v->region, at, cell, weight);
    for (size_t i = 0; i < count; i++) {
      const uint16_t *value = values_at(v, sight->node[k], cell[i]);
      for (int c = 0; c < 9; c++) sum[c] += weight[i] * abbe_half_value(value[c]);
    }
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) /* turned back */
          f[c][i] += sight->weight[k] * scale * scale * turn[3 * j + i] * sum[3 * c + j];
  }
}

/* R, G and B of a printed volume's nearest cell, beyond the region that of its rim; before the
 * cosine between the receiver's normal and -p. */
static inline void abbe_caustic_volume_ratio(const abbe_caustic_volume *v,
                                             const abbe_volume_sight *sight, const double p[3],
                                             double rgb[3]) {
  double q[3];
  clamp_place(&v->region, p, q);
  for (int c = 0; c < 3; c++) rgb[c] = 0;
  for (size_t k = 0; k < sight->count; k++) {
    double at[3];
    size_t cell;
    apply(sight->turn[k], q, at);
    if (!abbe_volume_region_look_up(&v->region, at, &cell)) continue;
    const uint16_t *value = values_at(v, sight->node[k], cell);
    for (int c = 0; c < 3; c++) rgb[c] += sight->weight[k] * v->byte * abbe_half_value(value[c]);
  }
}

static inline const float *texel(const abbe_exit_pages *p, size_t page, size_t fine, size_t x,
                                 size_t y) {
  return p->value[((2 * page + fine) * p->side + y) * p->side + x];
}

/* XYZ at a place of a tile, u and v of 0 to 1, between its texels, as the renderer has it. */
static inline void abbe_exit_pages_at(const abbe_exit_pages *p, size_t page, double u, double v,
                                      double xyz[3]) {
  const float *w = p->window[page];
  const double at[2] = {(u - (double)w[0]) * (double)w[2], (v - (double)w[1]) * (double)w[3]};
  const bool fine = at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1 && w[2] > 0;
  const double most = (double)p->side - 1, place[2] = {fine ? at[0] : u, fine ? at[1] : v};
  size_t low[2], high[2];
  double part[2];
  for (int a = 0; a < 2; a++) {
    const double x = fmin(fmax(place[a] * (double)p->side - 0.5, 0), most);
    low[a] = (size_t)x;
    high[a] = low[a] + 1 < p->side ? low[a] + 1 : low[a];
    part[a] = x - (double)low[a];
  }
  for (int k = 0; k < 3; k++) {
    const double a = (double)texel(p, page, fine, low[0], low[1])[k],
                 b = (double)texel(p, page, fine, high[0], low[1])[k],
                 c = (double)texel(p, page, fine, low[0], high[1])[k],
                 d = (double)texel(p, page, fine, high[0], high[1])[k];
    const double near_v = a + part[0] * (b - a), far_v = c + part[0] * (d - c);
    xyz[k] = near_v + part[1] * (far_v - near_v);
  }
}

#endif
