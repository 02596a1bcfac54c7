/* lut.h: what a display transform makes of scene-linear light, as a look-up table for other
 * programs.
 *
 * A table of .cube is of DaVinci Resolve's kind, with one dimension of 65,536 entries before three
 * dimensions, one of .clf [CLF3] a logarithm. Both shape light x by s = (log2(x + a) - log2 a) /
 * (log2(h + a) - log2 a), where a and h are the lowest and the highest stop, so that 0 is 0. Light
 * outside 0 to h is clipped.
 */
#ifndef ABBE_COLORIMETRY_SCREEN_LUT_H
#define ABBE_COLORIMETRY_SCREEN_LUT_H

#include "base/error.h"
#include "colorimetry/image/display_ocio.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_LUT_MIN_NODES 2
#define ABBE_LUT_MAX_NODES 129 /* OpenColorIO's most */
#define ABBE_LUT_MAX_STOPS 40.0

/* Zeroes for nodes, low and high: 33, -10 and 6.5. */
typedef struct abbe_lut_desc {
  const abbe_display *display;
  const char *input;  /* what the light's colour space is called, such as "ACEScg" */
  const char *output; /* what comes out, such as "sRGB / Looking" */
  size_t nodes;       /* of each of the three dimensions */
  double low, high;   /* stops from 0.18, within ABBE_LUT_MAX_STOPS, low < high */
} abbe_lut_desc;

/* How far the file's numbers, as OpenColorIO reads them by tetrahedra, are from the display's own,
 * where no node is: the greatest component's distance, 1 being the display's white. */
typedef struct abbe_lut_error {
  double mean, most; /* over colours spread evenly in s */
  double most_grey;  /* over greys */
} abbe_lut_error;

/* Whether the path's ending is one of a table: .cube or .clf. */
bool abbe_lut_is_meant(const char *path);

/* Writes the file and measures it. ABBE_INVALID_ARGUMENT for nodes or stops out of range and for
 * another ending, ABBE_NO_MEMORY, ABBE_IO, ABBE_COLOUR where OpenColorIO does not take it back. */
abbe_result abbe_lut_write(const abbe_lut_desc *desc, const char *path, abbe_lut_error *off,
                           abbe_error *error);

#ifdef __cplusplus
extern "C" {
#endif
/* Replaces R, G, B by what the table in the file makes of them. */
abbe_result abbe_lut_apply(const char *path, abbe_image *image, abbe_error *error);
#ifdef __cplusplus
}
#endif
#endif
