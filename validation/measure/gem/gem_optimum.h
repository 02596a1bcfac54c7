/* gem_optimum.h: the angles of crown and pavilion at which a design does best in a stone.
 *
 * Every pair of angles of a grid is tried; the design is stretched, its meets kept
 * (scenes/cuts/cut_stretch.h). All are seen through the same places of the pixels, so that what is
 * between neighbours is the cut and little of the chance.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_OPTIMUM_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_OPTIMUM_H

#include "validation/measure/gem/gem_judgement.h"
#include "validation/measure/gem/gem_view.h"

enum { ABBE_GEM_MOST_ANGLES = 201 };

typedef struct abbe_gem_optimum_desc {
  double crown_from_rad, crown_to_rad; /* angles of the main tier, above 0 to below pi 2 */
  double pavilion_from_rad, pavilion_to_rad;
  size_t crowns, pavilions; /* 1 to ABBE_GEM_MOST_ANGLES; 1: the mean of both ends */
  abbe_gem_amount measure;
  bool least; /* the least of it is best */
  double width_m;
  abbe_gem_axes axes; /* of a crystal; zeroed: along the cut's */
  abbe_gem_view_desc view;
  size_t part, parts;         /* every parts-th pair from the part-th on; parts 0: all */
  abbe_gem_progress progress; /* or NULL */
  void *user;
} abbe_gem_optimum_desc;

typedef struct abbe_gem_optimum {
  size_t crowns, pavilions;
  double *crown_rad, *pavilion_rad; /* ascending */
  abbe_gem_number *value;           /* [pavilions][crowns]; NaN where a pair is not judged */
  size_t best;                      /* index of the best in value[] */
  abbe_gem_amount measure;
  bool least;
  double design_crown_rad, design_pavilion_rad;
  abbe_gem_number design; /* value of the design as it is */
} abbe_gem_optimum;

/* The grid, with the design judged and no pair. weights: of the wavelengths, in XYZ.
 * ABBE_INVALID_ARGUMENT for what is outside its range, ABBE_GEOMETRY for a design without slanted
 * facets on either side; what abbe_cut_polyhedron_make and abbe_gem_view_make say. */
abbe_result abbe_gem_optimum_begin(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                   const abbe_material *material,
                                   const abbe_wavelengths *wavelengths, const abbe_weights *weights,
                                   const abbe_gem_optimum_desc *desc, abbe_gem_optimum *out,
                                   abbe_error *error);
/* The same, and judges the pairs of desc's part. ABBE_CANCELLED too, and what
 * abbe_cut_stretch_apply says. */
abbe_result abbe_gem_optimum_find(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                  const abbe_material *material,
                                  const abbe_wavelengths *wavelengths, const abbe_weights *weights,
                                  const abbe_gem_optimum_desc *desc, abbe_gem_optimum *out,
                                  abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_optimum_free(abbe_gem_optimum *optimum);

/* What value[i] is, and whether that is the best of those that are known; of pairs as good as each
 * other, the first is. */
void abbe_gem_optimum_know(abbe_gem_optimum *optimum, size_t i, abbe_gem_number value);
/* How many pairs have no value; *first (may be NULL): the first of them. */
size_t abbe_gem_optimum_missing(const abbe_gem_optimum *optimum, size_t *first);

/* Moves the design's planes to the angles of value[i]; the polyhedron is that of the cut as it was.
 * Errors as abbe_cut_stretch_apply, and ABBE_INVALID_ARGUMENT for a pair that is not there. */
abbe_result abbe_gem_optimum_apply(const abbe_gem_optimum *optimum, abbe_cut *cut,
                                   const abbe_cut_polyhedron *polyhedron, size_t i,
                                   abbe_error *error);

/* The stone at the best angles, of other wavelengths if need be. */
abbe_result abbe_gem_optimum_stone(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                   const abbe_material *material,
                                   const abbe_wavelengths *wavelengths,
                                   const abbe_gem_optimum_desc *desc,
                                   const abbe_gem_optimum *optimum, abbe_gem_stone *out,
                                   abbe_error *error);

#endif
