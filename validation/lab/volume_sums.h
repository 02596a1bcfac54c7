/* volume_sums.h: segments of light's paths added up over the cells of a region, pass by pass, with
 * standard errors.
 *
 * Of vector irradiance a cell's is the flux of every segment in it, times its length and direction,
 * over the cell's space. As the method was printed a segment counts once in every cell that it
 * comes to, with the cosine to where the cell lies from the centre, over what the beam alone would
 * bring there. Internal to validation/lab/.
 */
#ifndef ABBE_VALIDATION_LAB_VOLUME_SUMS_H
#define ABBE_VALIDATION_LAB_VOLUME_SUMS_H

#include "scenes/volume/volume_region.h"
#include "validation/trace/tracer/accumulator.h"

typedef struct abbe_volume_sums {
  const abbe_volume_region *region;
  bool printed;
  size_t channels; /* 9, of X, Y and Z in turn; printed 3 */
  double *weight;  /* [cells] 1 / m3; printed 1 / m2 */
  abbe_accumulator sums;
  abbe_region_piece *piece; /* [threads][ABBE_REGION_MOST_PIECES] */
} abbe_volume_sums;

/* A cell with less of its space left than that holds nothing. */
#define ABBE_VOLUME_SUMS_LEAST_SPACE 0.02f

/* share[cells]: of each that is empty (lone_object.h), NULL: all; not read of a printed one, which
 * reads the unit direction of the beam instead. The region outlives it. ABBE_NO_MEMORY. */
abbe_result abbe_volume_sums_make(const abbe_volume_region *region, bool printed,
                                  const float *share, const double beam[3], size_t threads,
                                  abbe_volume_sums *out, abbe_error *error);
void abbe_volume_sums_free(abbe_volume_sums *sums);

/* A segment from o (from the region's centre, m) along unit d, of length m or INFINITY, with the
 * flux of each colour, W, of light with an irradiance of 1 across its beam. */
void abbe_volume_sums_add(abbe_volume_sums *sums, size_t thread, const double o[3],
                          const double d[3], double length, const float flux[3]);
/* Ends the pass: abbe_accumulator_end_pass(&sums->sums). Mean of a cell's value and its standard
 * error, infinite before two passes. */
double abbe_volume_sums_mean(const abbe_volume_sums *sums, size_t cell, size_t channel);
double abbe_volume_sums_error(const abbe_volume_sums *sums, size_t cell, size_t channel);

/* Root mean square of the standard errors of Y's (G's) values over that of the values. */
double abbe_volume_sums_relative_error(const abbe_volume_sums *sums);
/* Flux of Y that goes out through a shell, W: of F's radial part, times the cells' solid angles at
 * their middles. Of shells, not printed. */
double abbe_volume_sums_outflow(const abbe_volume_sums *sums, size_t shell);

#endif
