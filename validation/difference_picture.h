/* difference_picture.h: where a field is brighter or darker than a reference, in false colours.
 *
 * Each pixel's difference of Y (or of the sum of bands) on a diverging scale: blue where the
 * test is darker, white where both agree, red where it is brighter; black where a side is not
 * finite. The scale bar stands on the right. Small fields are enlarged by a whole number.
 */
#ifndef ABBE_VALIDATION_DIFFERENCE_PICTURE_H
#define ABBE_VALIDATION_DIFFERENCE_PICTURE_H

#include "validation/field.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A field whose longer side is shorter is enlarged to at least half of this and at most it. */
#define ABBE_DIFFERENCE_PICTURE_SIDE 512

/* sRGB-encoded colour in [0, 1] of t in [-1, 1]; beyond, that of the end. Equal steps of t are
 * about equal steps to the eye: straight lines in CIE L*a*b* from white to a blue and to a red. */
void abbe_difference_picture_colour(double t, double rgb[3]);

/* The least of 1, 2 and 5 times a power of ten that is not below the magnitude that 99 % of the
 * finite differences stay under; 0 where all are 0. Fields as for abbe_compare; `scale` multiplies
 * the test. ABBE_NO_MEMORY. */
abbe_result abbe_difference_picture_range(const abbe_field *reference, const abbe_field *test,
                                          double scale, double *range, abbe_error *error);

/* Draws the differences, -range to range, and the bar, as display-encoded R, G, B for
 * abbe_png_write. ABBE_INVALID_ARGUMENT for a range that is not above 0 and for fields that are
 * not of one size; ABBE_NO_MEMORY. */
abbe_result abbe_difference_picture_make(const abbe_field *reference, const abbe_field *test,
                                         double scale, double range, abbe_image *out,
                                         abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
