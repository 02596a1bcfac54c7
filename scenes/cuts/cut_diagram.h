/* cut_diagram.h: a design on a sheet, as cutters work from it.
 *
 * The crown from above, the pavilion from below, two profiles, the wheel of indices around both,
 * names on the facets, the proportions, and a table of the tiers. Drawn by cairo. Sheets are as
 * wide as A4 and as long as the table needs, A4 at the least.
 */
#ifndef ABBE_SCENES_CUTS_CUT_DIAGRAM_H
#define ABBE_SCENES_CUTS_CUT_DIAGRAM_H

#include "base/error.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

/* Pixels of a PNG per point (1/72 inch). */
#define ABBE_CUT_DIAGRAM_PIXELS 2

/* Draws the cut's polyhedron. The format is the name's ending: .pdf, .svg or .png. note, under the
 * proportions, may be NULL. Tiers of the pavilion below the critical angle of index n are marked,
 * 0: none. ABBE_INVALID_ARGUMENT for another ending, ABBE_IO, ABBE_NO_MEMORY. */
abbe_result abbe_cut_diagram_write(const char *path, const abbe_cut *cut,
                                   const abbe_cut_polyhedron *polyhedron, const char *note,
                                   double n, abbe_error *error);

#endif
