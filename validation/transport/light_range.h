/* light_range.h: how bright a white receiver in the middle of the scene is by each of its lights, its
 * ambient light, its background and its environment: the range that a picture's sums are to hold.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRANSPORT_LIGHT_RANGE_H
#define ABBE_VALIDATION_TRANSPORT_LIGHT_RANGE_H

#include "validation/transport/geometry.h"

/* W/(m2 sr): about, of what is not dark; both 1 where all is. */
typedef struct abbe_light_range {
  double least, greatest;
} abbe_light_range;

void abbe_light_range_find(const abbe_geometry *geometry, abbe_light_range *out);

#endif
