/* environment_picture.h: pictures of surroundings into a map: OpenEXR and Radiance files.
 *
 * Latitude-longitude pictures (2:1, as radiance_map.h lays them out) and unfolded cubes: crosses,
 * upright (3:4) or lying (4:3), and OpenEXR's column of faces (1:6). In both crosses the middle of
 * the left, front, right row is the front, +x; above it is the top, +z; left of it the left, +y;
 * below it the bottom. The back is right of the right face in the lying cross, and below the
 * bottom, upside down, in the upright one. The column holds OpenEXR's +X, -X, +Y, -Y, +Z and -Z
 * from above [OpenEXRImages], where +Z is ahead and +Y is up: the left, right, top, bottom, front
 * and back. Colours are taken by the file's chromaticities; a file that says nothing is linear
 * Rec.709. Internal to scenes/.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_PICTURE_H
#define ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_PICTURE_H

#include "base/error.h"
#include "scenes/environment/radiance_map.h"

typedef enum abbe_environment_layout {
  ABBE_LAYOUT_BY_ASPECT, /* what the picture's sides say */
  ABBE_LAYOUT_LATLONG,
  ABBE_LAYOUT_CUBE
} abbe_environment_layout;

/* Reads path, a file or FILE#PART of an OpenEXR file: R, G, B, or X, Y, Z, or Y alone (grey). What
 * Rec.709 cannot hold of another space is clipped at 0. A cube becomes a map four of its faces
 * wide, up to ABBE_RADIANCE_MAP_MAX_WIDTH, each texel a mean by its share. Errors of abbe_exr_read
 * and abbe_radiance_read; ABBE_UNSUPPORTED for a file of another kind and for one that is too
 * large; ABBE_SCHEMA, with the picture's size, for sides that fit no layout or not the one asked
 * for, and, with the pixel and its value, for one that is negative or not finite; ABBE_NOT_FOUND
 * without such channels. */
abbe_result abbe_environment_picture_read(const char *path, abbe_environment_layout layout,
                                          abbe_radiance_map *out, abbe_error *error);

#endif
