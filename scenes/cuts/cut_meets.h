/* cut_meets.h: the ways in which a design's tiers can move, each by itself, with every meet kept.
 *
 * A tier has an angle and a distance. Where more than three facets meet in a corner they have to go
 * on doing so; the girdle's facets stay, and so does its thickness where it is thinnest. What is
 * left free is found by linear algebra, and larger moves are brought back to the meets by Newton's
 * steps. Stretches (cut_stretch.h) are among these moves, but those of a bound stone that has no
 * girdle.
 */
#ifndef ABBE_SCENES_CUTS_CUT_MEETS_H
#define ABBE_SCENES_CUTS_CUT_MEETS_H

#include "base/error.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

typedef struct abbe_cut_meets {
  size_t scalars;  /* two a tier: its angle from level, rad, and its distance */
  size_t freedoms; /* how many of their combinations are free */
  double *free;    /* [freedoms][scalars] orthonormal, owned */
} abbe_cut_meets;

/* The polyhedron is the cut's. ABBE_NO_MEMORY. */
abbe_result abbe_cut_meets_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                abbe_cut_meets *out, abbe_error *error);
/* Safe on a zeroed one. */
void abbe_cut_meets_free(abbe_cut_meets *meets);

/* Moves the tiers by change[scalars], and by what else the meets take; moved: the new polyhedron,
 * the caller's to free. ABBE_GEOMETRY where they cannot be kept, or where a facet, an edge or a
 * corner would come or go: the cut is as it was then. ABBE_NO_MEMORY. */
abbe_result abbe_cut_meets_move(abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                const double *change, abbe_cut_polyhedron *moved,
                                abbe_error *error);

/* By how much a facet's n and d change with its tier's scalars changing so. */
void abbe_cut_meets_plane(const abbe_cut *cut, size_t facet, const double *change, double by[4]);

#endif
