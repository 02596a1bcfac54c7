/* map_bands.h: a light's map in bands of wavelengths, three at a time. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_MAP_BANDS_H
#define ABBE_GL_CAUSTICS_MAP_BANDS_H

#include "colorimetry/image/image.h"
#include "gl/caustics/caustics.h"

/* X, Y, Z of the map as it is, and so many bands beside them, in W/nm, times `unit`; photons are
 * followed anew, and once more at the end, so that all is as it was. *out may be made where this
 * fails. */
abbe_result abbe_map_bands_read(abbe_caustics *caustics, size_t light, size_t bands, double unit,
                                abbe_image *out, abbe_error *error);

#endif
