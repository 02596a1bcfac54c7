/* scatter.h: Snell's and Fresnel's laws for a packet of sixteen paths, each at its own interface.
 *
 * Arithmetic alone, in arrays of a lane each, for the compiler to do side by side.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_SCATTER_H
#define ABBE_VALIDATION_TRACE_WALKS_SCATTER_H

#include "validation/trace/transport/mirrors.h"
#include "validation/trace/walks/ray_batch.h"

typedef struct abbe_scatter {
  /* In: unit directions, places, unit normals on the side that the path comes from (n interpolated,
   * ng of the face), the ratio of indices (1: it passes straight on), a number in [0, 1) that
   * decides between reflection and transmission, and the size of what is met, for the offset. */
  __attribute__((aligned(64))) float d[3][ABBE_RAY_LANES];
  float p[3][ABBE_RAY_LANES], n[3][ABBE_RAY_LANES], ng[3][ABBE_RAY_LANES];
  float eta[ABBE_RAY_LANES], chance[ABBE_RAY_LANES], size[ABBE_RAY_LANES];
  /* Out: Fresnel's reflectance, whether it is reflected, and the ray that goes on. */
  float share[ABBE_RAY_LANES];
  int reflects[ABBE_RAY_LANES];
  float out[3][ABBE_RAY_LANES], from[3][ABBE_RAY_LANES];
} abbe_scatter;

/* All lanes, whether they hold a path or not. */
void abbe_scatter_packet(abbe_scatter *s);

/* What mirrors reflect of a packet's paths. */
typedef struct abbe_mirroring {
  /* In: n and k of a metal, or a reflectance; that below 0 for a metal. */
  __attribute__((aligned(64))) float n[ABBE_RAY_LANES], k[ABBE_RAY_LANES], grey[ABBE_RAY_LANES];
  float share[ABBE_RAY_LANES]; /* out */
} abbe_mirroring;

/* By the directions and normals of s; all lanes, whatever they hold. */
void abbe_scatter_mirror(const abbe_scatter *s, abbe_mirroring *m);

/* Where lane k comes along unit d to a hit: its place, normals and size; true: from outside. */
static inline bool abbe_scatter_meet(abbe_scatter *s, size_t k, const abbe_hit *hit,
                                     const float d[3]) {
  const float along = d[0] * hit->ng[0] + d[1] * hit->ng[1] + d[2] * hit->ng[2];
  const float shaded = d[0] * hit->n[0] + d[1] * hit->n[1] + d[2] * hit->n[2];
  const bool entering = along < 0;
  const float side = entering ? 1 : -1;
  const float *outside = (shaded < 0) == entering ? hit->n : hit->ng;
  for (int i = 0; i < 3; i++) {
    s->n[i][k] = side * outside[i];
    s->ng[i][k] = side * hit->ng[i];
    s->p[i][k] = hit->p[i];
  }
  s->size[k] = hit->surface->sphere ? hit->surface->radius : 0;
  return entering;
}

/* Lane k comes to a mirror, from either side, within step at the share `within` of it: of one index
 * on both sides, and all that goes on is reflected. Its normals point outwards until they are
 * turned. */
static inline void abbe_scatter_meet_mirror(abbe_scatter *s, abbe_mirroring *m, size_t k,
                                            const abbe_hit *hit, const abbe_mirrors *mirrors,
                                            uint32_t step, float within) {
  const size_t mirror = hit->surface->index;
  float nk[2] = {1, 1};
  for (int i = 0; i < 3; i++) {
    s->n[i][k] = hit->n[i];
    s->ng[i][k] = hit->ng[i];
    s->p[i][k] = hit->p[i];
  }
  s->size[k] = hit->surface->sphere ? hit->surface->radius : 0;
  s->eta[k] = 1;
  s->chance[k] = -1;
  if (!abbe_mirrors_is_grey(mirrors, mirror)) abbe_mirrors_nk(mirrors, mirror, step, within, nk);
  m->n[k] = nk[0];
  m->k[k] = nk[1];
  m->grey[k] = mirrors->reflectance[mirror];
}

/* Turns the normals of all lanes to the side that the light comes from; those that point there
 * stay. */
void abbe_scatter_turn(abbe_scatter *s);

#endif
