/* volume_space.h: how much of each cell of a region lies outside the object that stands in it.
 *
 * Straight lines from all sides, evenly spread, are cut by the object's surface: what lies outside
 * of it, of all that lies in a cell. It follows no light. Internal to validation/volume/.
 */
#ifndef ABBE_VALIDATION_VOLUME_VOLUME_SPACE_H
#define ABBE_VALIDATION_VOLUME_VOLUME_SPACE_H

#include "scenes/volume/volume_region.h"
#include "validation/transport/geometry.h"

/* share[region->cells], 0 to 1; of cells beyond `radius` (m, that bounds the object around
 * `centre`) 1. Of a geometry with that object alone. An open mirror takes no space. ABBE_NO_MEMORY.
 */
abbe_result abbe_volume_space_measure(const abbe_geometry *geometry,
                                      const abbe_volume_region *region, const double centre[3],
                                      double radius, size_t lines, float *share, abbe_error *error);

#endif
