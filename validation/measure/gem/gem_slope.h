/* gem_slope.h: a measure of a cut stone, and how it changes with every plane of the cut and
 * with its material.
 *
 * Seen from far away, light that meets the same facets in the same order goes the same ways, so
 * that along a line across the view what returns is constant but where a facet's image ends. Each
 * such stretch is followed once, to its very ends; so a line's light is exact, and its derivative
 * is what directions and Fresnel's shares change by in each stretch, and by how fast each end moves
 * times what differs there. Both are traced back from the exits through all facets (reverse
 * accumulation), so that a stone costs twice the light without, whatever the number of planes.
 *
 * Where an exit crosses the horizon or the head's rim a whole facet's image jumps. Both are
 * softened by an angle, and the value and the derivative are of that. Stones of one index; a
 * crystal has its ordinary one. Internal to validation/measure/gem/.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_SLOPE_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_SLOPE_H

#include "colorimetry/weights.h"
#include "validation/measure/gem/gem_light.h"

enum { ABBE_GEM_SLOPE_REPEATS = 8, ABBE_GEM_SLOPE_MEETINGS = 64, ABBE_GEM_SLOPE_MOST = 8 };

typedef struct abbe_gem_slope_desc {
  abbe_gem_amount measure; /* ISO, COS, GEMRAY_*, RETURN or DOWN; AMOUNT_COUNT: fire alone */
  /* so much is added of the degrees by which an exit above the horizon is spread, times its share;
   * spread: what the index grows by from the line C to F */
  double fire, spread;
  double axis_rad, tilt_rad, head_rad; /* as a view's */
  double soft_rad;                     /* 0: none */
  /* Paths end below this share, 0: 0.003, and after so many facets, 0: 16. What is beyond adds
   * little to the value and jumps of all kinds to the derivative. */
  double least_share;
  size_t meetings;
  size_t lines;   /* of each repeat, which has a direction of its own; 0: 12 */
  size_t threads; /* 0: as many as OpenMP gives */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
} abbe_gem_slope_desc;

typedef struct abbe_gem_slope {
  abbe_gem_number value; /* a view's, but for what ends paths and what softens */
  size_t planes;
  double sum[ABBE_GEM_SLOPE_REPEATS], area[ABBE_GEM_SLOPE_REPEATS];
  /* [repeats][planes] of the stone's: of sum and of area by n and d of n . x = d; owned */
  double (*by_sum)[4], (*by_area)[4];
  size_t wavelengths;
  /* [repeats][wavelengths] of sum by the index, and by the loss a unit of length; owned */
  double *by_n, *by_loss, by_spread[ABBE_GEM_SLOPE_REPEATS];
} abbe_gem_slope;

/* How a stone changes: each plane's n and d, its index and its loss a unit of length at each
 * wavelength, and what the index grows by from C to F. NULL: not. */
typedef struct abbe_gem_change {
  const double (*plane)[4], *n, *loss;
  double spread;
} abbe_gem_change;

/* Of up to ABBE_GEM_SLOPE_MOST measures, by the same lines: desc differ in measure and fire alone.
 * weights: in XYZ, of the stone's wavelengths. ABBE_UNSUPPORTED for another measure,
 * ABBE_INVALID_ARGUMENT for more meetings than ABBE_GEM_SLOPE_MEETINGS, what
 * abbe_gem_view_check says, ABBE_CANCELLED, ABBE_NO_MEMORY. */
abbe_result abbe_gem_slope_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                                const abbe_gem_slope_desc *desc, size_t count, abbe_gem_slope *out,
                                abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_slope_free(abbe_gem_slope *slope);

/* The derivative while the stone changes so. */
abbe_gem_number abbe_gem_slope_by(const abbe_gem_slope *slope, const abbe_gem_change *change);

#endif
