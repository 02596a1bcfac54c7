/* cut_stretch.h: a design at other angles, its meets kept.
 *
 * Crown and pavilion are stretched along z, each by a factor k of its own: tangents of angles
 * become k times what they were (cutters' tangent ratio), and whatever met in a point or along an
 * edge still does, for a stretch is an affine map that leaves upright planes where they are. The
 * outline stays; so does the girdle's thickness where it is thinnest.
 */
#ifndef ABBE_SCENES_CUTS_CUT_STRETCH_H
#define ABBE_SCENES_CUTS_CUT_STRETCH_H

#include "base/error.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

/* The proportions of a stone, as those who cut and sell it give them.
 *
 * Lengths are in the design's units. Length and width are the larger and the smaller extent of the
 * outline along x and y. The girdle reaches from the lowest to the highest of its corners; where no
 * facet is upright its corners are those that crown and pavilion share. What is above it is the
 * crown, what is below the pavilion. */

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

/* Factors are between 1 over this and this. */
#define ABBE_CUT_STRETCH_MOST 20.0

/* Angles of a pavilion's main facets, in degrees, at which a ray that comes straight down onto them
 * is totally reflected there and on the facet opposite: above asin(1 / n), and below a third of 180
 * degrees less that (it comes to the second at 180 - 3 a). Where n is below 1 / sin 45 degrees they
 * leave nothing between them. n is above 1. */
void abbe_cut_stretch_window(double n, double *low_deg, double *high_deg);
/* Whether light that comes straight down leaves through a tier of the pavilion: it is flatter than
 * the critical angle of that index. Without one, 0, none is. */
bool abbe_cut_stretch_is_flat(const abbe_cut_tier *tier, double n);
/* The main angle for an index `to` of a design that has `main` for the index `from`: as far from
 * the middle of the window as it was. */
double abbe_cut_stretch_angle(double main_deg, double from, double to);

/* The main tier of that side, crown or pavilion: the one with the largest faces, in the mean,
 * tables and flat culets aside; of a pavilion among those that reach the lowest corner.
 * cut->tier_count where there is none. */
size_t abbe_cut_stretch_main(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                             abbe_cut_side side);
/* That tier's angle, degrees above 0 on either side; 0 where there is none. */
double abbe_cut_stretch_main_deg(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                 abbe_cut_side side);
/* The factor that brings an angle to another, both between 0 and 90 degrees, up or down. */
double abbe_cut_stretch_factor(double from_deg, double to_deg);

/* Whether crown and pavilion meet without a girdle between them, and not at one height: both can
 * only be stretched by one factor. */
bool abbe_cut_stretch_bound(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron);

/* Moves the planes; names, indices and texts stay. ABBE_OUT_OF_RANGE for factors out of range and
 * where a plane would come to the other side of the centre, ABBE_UNSUPPORTED where the sides are
 * bound and the factors differ. The cut is as it was then. */
abbe_result abbe_cut_stretch_apply(abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                   double crown, double pavilion, abbe_error *error);

/* The same by the main tiers' new angles, degrees between 0 and 90; 0: that side stays, or follows
 * the other where they are bound. Also
 * ABBE_OUT_OF_RANGE for other angles, ABBE_NOT_FOUND for a side without a main tier. */
abbe_result abbe_cut_stretch_to(abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                double crown_deg, double pavilion_deg, abbe_error *error);

#endif
