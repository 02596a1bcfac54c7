/* caustic_volume.h: the light that an object sends to the space around it, for directional lights
 * from many directions, computed beforehand: for each light node and cell the vector irradiance of
 * unit light; or, as the method was printed, the share of the beam's light
 * [WymanHansenShirley2003]; or the rays that leave the object (light_exits.h), from which the cells
 * are filled for a light where it stands (exit_light.h).
 *
 * All in the object's own coordinates: places from its centre in m, as it stood when the volume was
 * made. It holds numbers; validation/volume/volume_fill.h finds them out, volume_file.h stores
 * them.
 */
#ifndef ABBE_SCENES_VOLUME_CAUSTIC_VOLUME_H
#define ABBE_SCENES_VOLUME_CAUSTIC_VOLUME_H

#include "base/error.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/light_nodes.h"
#include "scenes/volume/volume_body.h"
#include "scenes/volume/volume_region.h"

#include <stddef.h>
#include <stdint.h>

/* Values at light nodes as sums of a few modes of the light's direction: the singular value
 * decomposition of the values, cut off. Of all sums of so many terms these leave the least mean
 * square [EckartYoung1936]. */

/* Of halves value[nodes][each]: singular values that fall, singular[nodes], and modes in their
 * order, mode[nodes][nodes], a mode a row. Modes are orthogonal, of mean square 1 over the nodes;
 * the values times a mode, over the number of nodes, are its term. What is left out by the terms
 * from k on has as its sum of squares that of singular[k] and all behind it. ABBE_INVALID_ARGUMENT
 * for no nodes, ABBE_NO_MEMORY. */
abbe_result abbe_light_modes_find(size_t nodes, size_t each, const uint16_t *value,
                                  double *singular, double *mode, abbe_error *error);

/* Functions of the direction to a light as sums of spherical harmonics, and their coefficients
 * from values at light nodes by least squares. */

#define ABBE_LIGHT_HARMONICS_MOST 12 /* degree */
#define ABBE_LIGHT_HARMONICS_MOST_COUNT 169

/* Of all degrees up to that one: (degree + 1)^2. */
static inline size_t abbe_light_harmonics_count(size_t degree) {
  return (degree + 1) * (degree + 1);
}

/* The real harmonics of a unit direction, each of unit square over the sphere: value[l (l + 1) +
 * m], m from -l to l. degree: at most ABBE_LIGHT_HARMONICS_MOST. */
void abbe_light_harmonics_at(size_t degree, const double direction[3], double *value);

/* fit[count][nodes->count]: a coefficient is the sum of its row times the values at the nodes. The
 * nodes' spacing is not quite even, so that equal weights would not give a harmonic back; least
 * squares do. ABBE_INVALID_ARGUMENT for more coefficients than nodes, ABBE_NO_MEMORY. */
abbe_result abbe_light_harmonics_fit(const abbe_light_nodes *nodes, size_t degree, double *fit,
                                     abbe_error *error);

typedef enum abbe_volume_kind {
  /* F of X, Y and Z, of light with an irradiance of 1 across its beam whose white has Y = 1: what
   * lies before it gets -n . F, where all light comes from the front. */
  ABBE_VOLUME_VECTOR,
  /* R, G and B (linear Rec.709 of equal white) in bytes: light on a surface that faces the object's
   * centre, of that of the beam. */
  ABBE_VOLUME_PRINTED,
  /* Rays that leave the object; it has no values, and looks none up. */
  ABBE_VOLUME_EXITS
} abbe_volume_kind;

/* Where light from between nodes is looked up: at the node nearest to it; at the three around it;
 * there, about the axes that bring the light to each of them. */
#define ABBE_VOLUME_LOOKUPS(X)                                                                     \
  X(AUTO, "auto") X(NEAREST, "nearest") X(BLEND, "blend") X(TURN, "turn")
typedef enum abbe_volume_lookup {
#define ABBE_VOLUME_LOOKUP_ENUM(code, name) ABBE_VOLUME_LOOKUP_##code,
  ABBE_VOLUME_LOOKUPS(ABBE_VOLUME_LOOKUP_ENUM)
#undef ABBE_VOLUME_LOOKUP_ENUM
      ABBE_VOLUME_LOOKUP_COUNT
} abbe_volume_lookup;

typedef struct abbe_caustic_volume {
  abbe_volume_kind kind;
  abbe_volume_body body;
  abbe_volume_region region;
  abbe_light_nodes nodes;
  size_t degree;   /* above 0: harmonics of the light's direction, to that degree, in place of
                      values at the nodes */
  size_t rank;     /* above 0: so many modes of the light's direction in their place */
  double white[3]; /* XYZ of the light that it was made for, Y = 1 */
  double min_nm, max_nm;
  double byte;            /* PRINTED: what a byte of 1 stands for */
  double error;           /* relative standard error of what was summed up; 0: not known */
  uint16_t *value;        /* halves [blocks][region.cells][channels]; EXITS: NULL */
  uint16_t *mode;         /* halves [rank][nodes.count], caustic_volume.h; without a rank NULL */
  abbe_light_exits exits; /* EXITS: for the nodes, and cells of the region */
} abbe_caustic_volume;

#define ABBE_CAUSTIC_VOLUME_MOST_RANK 256

/* One for each node, coefficient or mode. */
static inline size_t abbe_caustic_volume_blocks(const abbe_caustic_volume *v) {
  if (v->rank > 0) return v->rank;
  return v->degree > 0 ? abbe_light_harmonics_count(v->degree) : v->nodes.count;
}

/* Whether any light takes all blocks by their weights, not those of a node or three. */
static inline bool abbe_caustic_volume_is_sum(const abbe_caustic_volume *v) {
  return v->degree > 0 || v->rank > 0;
}

/* 9: F.x, F.y, F.z of X, then of Y, then of Z; printed 3. */
static inline size_t abbe_caustic_volume_channels(const abbe_caustic_volume *v) {
  return v->kind == ABBE_VOLUME_PRINTED ? 3 : 9;
}

/* Room for the values of a body, a region and nodes that are there, all 0: ABBE_NO_MEMORY;
 * ABBE_INVALID_ARGUMENT for more than ABBE_CAUSTIC_VOLUME_MOST of them, and for exits. */
#define ABBE_CAUSTIC_VOLUME_MOST ((size_t)1 << 31)
abbe_result abbe_caustic_volume_allocate(abbe_caustic_volume *volume, abbe_error *error);
void abbe_caustic_volume_free(abbe_caustic_volume *volume);
/* Of values or exits, in memory. */
size_t abbe_caustic_volume_bytes(const abbe_caustic_volume *volume);

/* Values at nodes become coefficients of harmonics to that degree, 1 to ABBE_LIGHT_HARMONICS_MOST,
 * by least squares. ABBE_INVALID_ARGUMENT for another than a vector volume, and as
 * abbe_light_harmonics_fit. */
abbe_result abbe_caustic_volume_project(abbe_caustic_volume *volume, size_t degree,
                                        abbe_error *error);

/* Values at nodes become the `rank` terms of their singular value decomposition that leave the
 * least mean square, 1 to as many as there are nodes and ABBE_CAUSTIC_VOLUME_MOST_RANK. *left: the
 * root of what they leave, of the root of all squares. ABBE_INVALID_ARGUMENT for other ranks, and
 * for another than a vector volume; ABBE_NO_MEMORY. */
abbe_result abbe_caustic_volume_reduce(abbe_caustic_volume *volume, size_t rank, double *left,
                                       abbe_error *error);

/* Joins cells of every block within a tolerance of unit irradiance (volume_tree.h): each has the
 * joint value then. *bytes: what the joint values take. ABBE_INVALID_ARGUMENT as
 * abbe_volume_order_make, and for another than a vector volume. */
abbe_result abbe_caustic_volume_join(abbe_caustic_volume *volume, double tolerance, size_t *bytes,
                                     abbe_error *error);

/* How a lookup that is left open is done: by turns of a ball, which they are exact for, and where
 * there is one node; else by three nodes, printed too. */
abbe_volume_lookup abbe_caustic_volume_resolve(const abbe_caustic_volume *volume,
                                               abbe_volume_lookup lookup);

/* Which blocks light from unit direction to_light is looked up at, by their weights: of nodes at
 * most three, with the turn of each into its node's light (row-major; the unit matrix but of TURN);
 * of harmonics and modes all, with none. */
typedef struct abbe_volume_sight {
  size_t count;
  size_t block[ABBE_CAUSTIC_VOLUME_MOST_RANK]; /* more than there are harmonics */
  double weight[ABBE_CAUSTIC_VOLUME_MOST_RANK];
  double turn[3][9];
} abbe_volume_sight;
void abbe_caustic_volume_look(const abbe_caustic_volume *volume, abbe_volume_lookup lookup,
                              const double to_light[3], abbe_volume_sight *out);

/* All blocks by their weights, without turns: one block for that light, sums[region.cells *
 * channels]. */
void abbe_caustic_volume_sum(const abbe_caustic_volume *volume, const abbe_volume_sight *sight,
                             float *sums);

/* Vector irradiance at p of light of unit irradiance: f[0] of X, f[1] of Y, f[2] of Z, interpolated
 * between cells; beyond the region that of its rim on the way there, thinned by the square of the
 * distance. ABBE_VOLUME_VECTOR alone. */
void abbe_caustic_volume_flux(const abbe_caustic_volume *volume, const abbe_volume_sight *sight,
                              const double p[3], double f[3][3]);
/* Of a printed one: R, G and B of the nearest cell, beyond the region of its rim; before the cosine
 * between the receiver's normal and -p. */
void abbe_caustic_volume_ratio(const abbe_caustic_volume *volume, const abbe_volume_sight *sight,
                               const double p[3], double rgb[3]);

#endif
