/* map_layout.h: where the texels of a receiver map lie: a light's view, and its warped axes.
 *
 * A receiver map is a picture that a light projects onto the scene: each texel holds the flux that
 * hits a receiver in it. The layout gives the place of each texel, so that two maps can be compared
 * texel by texel. It holds no light and knows no optics. Texture coordinates run from 0 to 1, x to
 * the right and y upwards; an image's row 0 is at the top. */
#ifndef ABBE_SCENES_VIEW_MAP_LAYOUT_H
#define ABBE_SCENES_VIEW_MAP_LAYOUT_H

#include "base/error.h"
#include "colorimetry/image/image.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_MAP_LAYOUT_STEPS 128

typedef struct abbe_map_layout {
  abbe_view view; /* perspective from a point; parallel for a directional light */
  /* For each axis (x, y): window coordinate k
   * STEPS falls on texture coordinate knot[axis][k]; from 0 to 1, ascending, linear in between. */
  double knot[2][ABBE_MAP_LAYOUT_STEPS + 1];
} abbe_map_layout;

/* The view with texels of one size. */
void abbe_map_layout_make(const abbe_view *view, abbe_map_layout *out);

/* ABBE_INVALID_ARGUMENT says what is wrong: numbers that are not finite, axes that are not unit,
 * right-angled and right-handed, an empty window or range, knots that do not rise from 0 to 1. */
abbe_result abbe_map_layout_check(const abbe_map_layout *layout, abbe_error *error);

/* Whether both put every place into the same texel, up to a share of 1e-9 of a side. The ranges
 * near to far are not compared: they move no texel. */
bool abbe_map_layout_same(const abbe_map_layout *a, const abbe_map_layout *b);

/* Window coordinate to texture coordinate along an axis (0: x, 1: y), and back; both 0 to 1, what
 * lies outside is moved to the nearest end. */
double abbe_map_layout_warp(const abbe_map_layout *layout, int axis, double window);
double abbe_map_layout_unwarp(const abbe_map_layout *layout, int axis, double texture);

/* Texture coordinates of a world point. False (uv untouched) where the map does not hold it: behind
 * the light, or outside the window. */
bool abbe_map_layout_project(const abbe_map_layout *layout, const double p[3], double uv[2]);
/* Column and row (0 at the top) of the point in a map of that size; false as above. */
bool abbe_map_layout_texel(const abbe_map_layout *layout, size_t width, size_t height,
                           const double p[3], size_t *column, size_t *row);
/* The ray of light through texture coordinates: origin and unit direction. */
void abbe_map_layout_ray(const abbe_map_layout *layout, const double uv[2], double origin[3],
                         double direction[3]);

/* Window width (axis 0) or height (axis 1) of texel `index` of `side` texels, counted along the
 * texture coordinate: a difference of tangents (perspective) or metres (parallel). */
double abbe_map_layout_texel_size(const abbe_map_layout *layout, int axis, size_t side,
                                  size_t index);

/* Writes the layout into the image's text attributes abbe:map_view, abbe:map_warp_x and
 * abbe:map_warp_y, every number with the digits that give it back exactly; and abbe:map_light, the
 * name of the light (NULL: none). */
abbe_result abbe_map_layout_write(const abbe_map_layout *layout, const char *light,
                                  abbe_image *image, abbe_error *error);
/* Reads them; `name` (a path) stands in the sentences. ABBE_NOT_FOUND where the image is no map,
 * ABBE_PARSE where an attribute is broken; then out is zeroed. */
abbe_result abbe_map_layout_read(const abbe_image *image, const char *name, abbe_map_layout *out,
                                 abbe_error *error);

/* A map's light in the texels of another layout of the same light.
 *
 * Every texel's flux is taken as spread evenly over its window area, cut into parts, and each part
 * is put whole into the texel that it falls into. So light is kept, but for what falls outside the
 * other window. Maps that were laid out differently can be compared this way, as finely as their
 * texels allow; nothing is sharpened or smoothed. */

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
