/* rings.h: the texels of a receiver map as rings around a point, and what a round profile puts
 * into them.
 *
 * A texel belongs to the ring that its middle lies in, so the rings of a map have ragged edges and
 * a circle's flux is not theirs. Both halves of a comparison go over the same texels here: the
 * map's are summed, and the profile's flux is shared out between the rings wherever a circle
 * passes texels of both. It knows nothing of how either came about. Internal to
 * validation/lab/known/.
 */
#ifndef ABBE_VALIDATION_LAB_KNOWN_RINGS_H
#define ABBE_VALIDATION_LAB_KNOWN_RINGS_H

#include "base/error.h"
#include "scenes/view/map_layout.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_RINGS_MAX 64
#define ABBE_RINGS_STEPS 24 /* circles across a ragged edge */

typedef struct abbe_rings {
  abbe_map_layout layout;
  size_t width, height;            /* texels */
  double centre[3];                /* on the receiver: a level plane */
  size_t count;                    /* rings */
  double edge[ABBE_RINGS_MAX + 1]; /* m, ascending from 0 or more */
  double ragged;                   /* m: no texel reaches further over the edge of its ring */
  uint8_t *ring;                   /* [width * height], row 0 at the top; count: in none */
} abbe_rings;

/* Rings around centre on the level plane through it, between edge[0], edge[1], ... edge[count].
 * ABBE_INVALID_ARGUMENT for edges that do not ascend or more than ABBE_RINGS_MAX rings. */
abbe_result abbe_rings_make(const abbe_map_layout *layout, size_t width, size_t height,
                            const double centre[3], const double *edge, size_t count,
                            abbe_rings *out, abbe_error *error);
void abbe_rings_free(abbe_rings *rings);

/* Sums of a map's channel (samples `stride` apart, row 0 at the top) over each ring into
 * sum[count]; squared: sums of the squared samples, for variances. */
void abbe_rings_sum(const abbe_rings *rings, const float *sample, size_t stride, bool squared,
                    double *sum);

/* Radii in m, ascending within an edge, at which the profile must be known: for each edge
 * ABBE_RINGS_STEPS + 1 of them; radius[(count + 1) * (ABBE_RINGS_STEPS + 1)]. */
void abbe_rings_radii(const abbe_rings *rings, double *radius);

/* What a profile with these enclosed fluxes (W at those radii; `stride` apart) puts into each
 * ring's texels: flux[count]. */
void abbe_rings_expect(const abbe_rings *rings, const double *enclosed, size_t stride,
                       double *flux);

#endif
