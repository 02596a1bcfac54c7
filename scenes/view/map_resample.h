/* map_resample.h: a map's light in the texels of another layout of the same light.
 *
 * Every texel's flux is taken as spread evenly over its window area, cut into parts, and each part
 * is put whole into the texel that it falls into. So light is kept, but for what falls outside the
 * other window. Maps that were laid out differently can be compared this way, as finely as their
 * texels allow; nothing is sharpened or smoothed.
 */
#ifndef ABBE_SCENES_VIEW_MAP_RESAMPLE_H
#define ABBE_SCENES_VIEW_MAP_RESAMPLE_H

#include "scenes/view/map_layout.h"

#define ABBE_MAP_RESAMPLE_MAX_PARTS 64

/* A map of width x height texels, with all channels of `from` (flux a texel, any unit) and its
 * light's name, laid out as `to`. A texel is cut into parts x parts (1 to
 * ABBE_MAP_RESAMPLE_MAX_PARTS). `name` (a path) stands for `from` in sentences.
 * ABBE_INVALID_ARGUMENT where the two layouts are of lights in different places or for parts out of
 * range; errors of abbe_map_layout_read and abbe_image_make. */
abbe_result abbe_map_resample(const abbe_image *from, const char *name, const abbe_map_layout *to,
                              size_t width, size_t height, size_t parts, abbe_image *out,
                              abbe_error *error);

#endif
