/* map_picture.h: texels of a map as it lies on the device, as a picture. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_MAP_PICTURE_H
#define ABBE_GL_CAUSTICS_MAP_PICTURE_H

#include "colorimetry/image/image.h"
#include "scenes/view/map_layout.h"

#include <stddef.h>

/* X, Y, Z, W a texel, of flux over window area for unit power; texel: [side][side][4], rows
 * upwards. ABBE_NO_MEMORY. */
abbe_result abbe_map_picture_flux(const float *texel, size_t side, const abbe_map_layout *layout,
                                  double power, abbe_image *out, abbe_error *error);
/* R, G, B in Rec.709 as they are. */
abbe_result abbe_map_picture_colour(const float *texel, size_t side, abbe_image *out,
                                    abbe_error *error);

#endif
