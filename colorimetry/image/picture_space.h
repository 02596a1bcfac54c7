/* picture_space.h: which colours a picture's numbers are: the transform from its R, G, B to XYZ. */
#ifndef ABBE_COLORIMETRY_IMAGE_PICTURE_SPACE_H
#define ABBE_COLORIMETRY_IMAGE_PICTURE_SPACE_H

#include "colorimetry/image/image.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"

#include <stdbool.h>

typedef struct abbe_picture_space {
  abbe_observer observer; /* whose XYZ it is: the attribute abbe:observer; 1931 without */
  abbe_rgb_space space;   /* ABBE_RGB_SPACE_COUNT: of other chromaticities */
  double to_xyz[9];       /* row-major, to XYZ relative to D65 */
  char text[40];          /* "acescg", ..., "RGB of the file's chromaticities" */
  bool assumed;           /* the file does not state its space; Rec.709 was taken */
} abbe_picture_space;

/* The space of channels X, Y, Z (is_xyz) or R, G, B: of R, G, B the attribute colorInteropID, else
 * abbe:space, else the chromaticities, else what their absence means in OpenEXR: Rec.709. `name` is
 * what errors call the picture. ABBE_INVALID_ARGUMENT for chromaticities that span no space,
 * ABBE_COLOUR for an abbe:space and an observer that are none. */
abbe_result abbe_picture_space_find(const abbe_image *image, bool is_xyz, const char *name,
                                    abbe_picture_space *out, abbe_error *error);

/* The colorInteropID of R, G and B: of those of the standard observer in a space that has one; NULL
 * of all else, and of spectra and X, Y, Z. */
const char *abbe_picture_space_id(const abbe_image *image);

/* Numbers as colours, for false-colour pictures and their scale bars.
 *
 * Two maps: one for amounts, from black to white with lightness rising throughout, so that it also
 * reads in grey [Green2011]; one for differences about a middle, from blue over light grey to red
 * [Moreland2009]. It scales nothing: that is the caller's axis. */

typedef enum abbe_colour_map {
  ABBE_COLOUR_MAP_AMOUNT,    /* 0 black, 1 white */
  ABBE_COLOUR_MAP_DIFFERENCE /* 0 blue, 0.5 light grey, 1 red */
} abbe_colour_map;

/* The sRGB-encoded colour of t, components in [0, 1]. t is held in [0, 1]; NaN is a flat green that
 * neither map has. */
void abbe_colour_map_at(abbe_colour_map map, double t, double rgb[3]);

#endif
