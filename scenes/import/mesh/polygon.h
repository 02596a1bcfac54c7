/* polygon.h: cuts the polygons of mesh files into triangles.
 *
 * A polygon's corners lie in a plane or near one, in order around it. It may be concave, have
 * corners in line, and pass points twice, as where a bridge leads to a hole. Whether corners turn
 * left or right is decided exactly. No corners are added. Internal to scenes/.
 */
#ifndef ABBE_SCENES_IMPORT_MESH_POLYGON_H
#define ABBE_SCENES_IMPORT_MESH_POLYGON_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* What all polygons of a file may take together, counted in looks at a corner, each of some
 * nanoseconds: so much, and so much more for each of their corners. */
#define ABBE_POLYGON_WORK 4e9
#define ABBE_POLYGON_WORK_A_CORNER 200.0

/* Cuts it into count - 2 triangles (count >= 3), which run around as it does: triangle[i] are
 * indices into corner. Of a polygon that does not cross itself, seen along the axis that is nearest
 * its normal, they lie inside and not over one another; those of one that does cross itself, or
 * has no area, are any. Longer polygons than four corners get the triangles of Delaunay.
 * *work is what it may take, and then what is left of that. ABBE_UNSUPPORTED where it takes more,
 * ABBE_NO_MEMORY. */
abbe_result abbe_polygon_cut(const double (*corner)[3], size_t count, uint32_t (*triangle)[3],
                             double *work, abbe_error *error);

#endif
