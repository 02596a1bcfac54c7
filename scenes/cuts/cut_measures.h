/* cut_measures.h: the proportions of a stone, as those who cut and sell it give them.
 *
 * Lengths are in the design's units. Length and width are the larger and the smaller extent of the
 * outline along x and y. The girdle reaches from the lowest to the highest of its corners; where no
 * facet is upright its corners are those that crown and pavilion share. What is above it is the
 * crown, what is below the pavilion.
 */
#ifndef ABBE_SCENES_CUTS_CUT_MEASURES_H
#define ABBE_SCENES_CUTS_CUT_MEASURES_H

#include "base/error.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

/* X(code, name): the parts of a stone. */
#define ABBE_CUT_SIDES(X)                                                                          \
  X(CROWN, "crown")                                                                                \
  X(GIRDLE, "girdle")                                                                              \
  X(PAVILION, "pavilion")

typedef enum abbe_cut_side {
#define ABBE_CUT_SIDE_ENUM(code, name) ABBE_CUT_##code,
  ABBE_CUT_SIDES(ABBE_CUT_SIDE_ENUM)
#undef ABBE_CUT_SIDE_ENUM
      ABBE_CUT_SIDE_COUNT
} abbe_cut_side;

const char *abbe_cut_side_name(abbe_cut_side side);
/* By where the facet faces: up, level (abbe_cut_facet_is_girdle), down. */
abbe_cut_side abbe_cut_side_of(const abbe_cut_facet *facet);

typedef struct abbe_cut_measures {
  double length, width, height;
  double side[ABBE_CUT_SIDE_COUNT]; /* heights; of the pavilion its depth */
  double table;                     /* extent of the widest flat face on top, along the width; 0 */
  double girdle_low, girdle_high;   /* z of the girdle's corners */
  double crown_edge,
      pavilion_edge;              /* z of the crown's lowest corner there, the pavilion's highest */
  size_t shared;                  /* corners that crown and pavilion share */
  double shared_low, shared_high; /* z of those */
  size_t faces[ABBE_CUT_SIDE_COUNT];
  size_t dead, doubled; /* facets that have no face */
  double volume;
} abbe_cut_measures;

/* Measures the cut's polyhedron. */
void abbe_cut_measures_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                            abbe_cut_measures *out);

/* Metric carats (0.2 g) of the stone when its width, in metres, is that; density in g/cm3. */
double abbe_cut_measures_carats(const abbe_cut_measures *measures, double width_m,
                                double density_g_cm3);

/* The largest stone of these proportions in a block of those sides, lying along them any way up:
 * metres a unit of the design; and its share of the block. */
double abbe_cut_measures_fit(const abbe_cut_measures *measures, const double rough_m[3]);
double abbe_cut_measures_yield(const abbe_cut_measures *measures, const double rough_m[3]);

#endif
