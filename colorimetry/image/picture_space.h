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

#endif
