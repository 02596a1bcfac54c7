/* gem_ascent.h: a search for the angles at which a design does best in a stone, by derivatives.
 *
 * Uphill from place to place by the derivative of a measure (gem_slope.h), along conjugate
 * gradients: of two angles, crown's and pavilion's, from the best of nine places of their ranges;
 * or of every tier's angle and distance by themselves, all meets kept (scenes/cuts/cut_meets.h).
 * gem_optimum.h has the search by a grid. Designs are compared by the measure itself at the end.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_ASCENT_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_ASCENT_H

#include "validation/measure/gem/gem_optimum.h"

/* A design that a search comes to. cut and polyhedron: its own, but for names and texts, which
 * are those of the design that it began with. */
typedef struct abbe_gem_ascent {
  abbe_cut cut;
  abbe_cut_polyhedron polyhedron;
  abbe_gem_number value, design; /* of the measure itself, as abbe_gem_optimum has it; and what the
                                  * search began with has */
  size_t evaluations;            /* stones whose light was followed, with a derivative or without */
  size_t scalars;
  abbe_gem_number *slope; /* [scalars] by each tier's angle alone, a radian; and distance; owned */
} abbe_gem_ascent;

typedef struct abbe_gem_ascent_desc {
  abbe_gem_optimum_desc search; /* ranges, measure, view; not its grid */
  bool tiers;                   /* every tier; else the two angles */
  bool near;                    /* of tiers: from the design alone */
  double fire, spread;          /* as abbe_gem_slope_desc has them; more fire is better */
  size_t most;                  /* evaluations of each way uphill of tiers; 0: 100 */
} abbe_gem_ascent_desc;

/* Errors as abbe_gem_optimum_find and abbe_gem_slope_make. */
abbe_result abbe_gem_ascent_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                 const abbe_material *material, const abbe_wavelengths *wavelengths,
                                 const abbe_weights *weights, const abbe_gem_ascent_desc *desc,
                                 abbe_gem_ascent *out, abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_ascent_free(abbe_gem_ascent *ascent);

#endif
