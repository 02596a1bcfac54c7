/* cut_polyhedron.h: the stone that a cut's planes enclose: corners, edges and faces.
 *
 * Corners are found as the facets of the hull of the dual points n / d, by Qhull [Barber1996]. Cuts
 * are made to meet: where more than three planes nearly go through one point, their corners become
 * one and the planes of all meet there, so that V - E + F stays 2. The planes themselves are not
 * moved. It knows nothing of light or of units.
 */
#ifndef ABBE_SCENES_CUTS_CUT_POLYHEDRON_H
#define ABBE_SCENES_CUTS_CUT_POLYHEDRON_H

#include "base/error.h"
#include "scenes/cuts/cut.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>
#include <stdint.h>

/* Corners nearer to one another than this share of half the stone's width are one. */
#define ABBE_CUT_WELD 1e-6
#define ABBE_CUT_MOST_WELD 0.01

typedef enum abbe_cut_fate {
  ABBE_CUT_FACE,  /* the facet has a face */
  ABBE_CUT_DEAD,  /* it lies outside the others, or touches no more than an edge */
  ABBE_CUT_DOUBLE /* an earlier facet has the same plane */
} abbe_cut_fate;

typedef struct abbe_cut_face {
  size_t facet;        /* facet of the cut */
  size_t first, count; /* range in corner[], counter-clockwise seen from outside */
  double area;
} abbe_cut_face;

typedef struct abbe_cut_polyhedron {
  size_t vertex_count, edge_count, face_count, corner_count, facet_count;
  double (*vertex)[3];
  abbe_cut_face *face; /* in the order of their facets */
  uint32_t *corner;    /* vertices of the faces */
  abbe_cut_fate *fate; /* [facet_count] of each of the cut's facets */
  double min[3], max[3];
  double volume, area;
} abbe_cut_polyhedron;

/* weld: 0 for ABBE_CUT_WELD, else above 0 to ABBE_CUT_MOST_WELD. ABBE_GEOMETRY where the planes
 * leave the stone open, or corners are welded so widely that its faces do not close any more; what
 * abbe_cut_check says; ABBE_NO_MEMORY. */
abbe_result abbe_cut_polyhedron_make(const abbe_cut *cut, double weld, abbe_cut_polyhedron *out,
                                     abbe_error *error);
/* Safe on a zeroed one. */
void abbe_cut_polyhedron_free(abbe_cut_polyhedron *polyhedron);

/* Its faces as triangles, scaled, with the planes' normals. ABBE_NO_MEMORY. */
abbe_result abbe_cut_polyhedron_mesh(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                     double scale, abbe_mesh *out, abbe_error *error);

#endif
