/* difference_picture.h: where a field is brighter or darker than a reference, in false colours.
 *
 * Each pixel's difference of Y (or of the sum of bands): blue where the test is darker, light where
 * both agree, red where it is brighter, green where a side is not finite; with a scale bar, by
 * colorimetry/plot/chart.h. Pixels are enlarged by a whole number, not smoothed.
 */
#ifndef ABBE_VALIDATION_COMPARE_DIFFERENCE_PICTURE_H
#define ABBE_VALIDATION_COMPARE_DIFFERENCE_PICTURE_H

#include "validation/compare/field.h"

/* A field whose longer side is shorter than this is enlarged, to at most this. */
#define ABBE_DIFFERENCE_PICTURE_SIDE 512

/* The least of 1, 2 and 5 times a power of ten that is not below the magnitude that 99 % of the
 * finite differences stay under (of all, where those are 0); 0 where nothing differs. Fields as for
 * abbe_compare; `scale` multiplies the test. ABBE_INVALID_ARGUMENT for fields of two sizes;
 * ABBE_NO_MEMORY. */
abbe_result abbe_difference_picture_range(const abbe_field *reference, const abbe_field *test,
                                          double scale, double *range, abbe_error *error);

/* Writes the differences, from -range to range, to path, a .png or .svg, under a title (NULL:
 * none). ABBE_INVALID_ARGUMENT also for a range that is not above 0; errors of abbe_chart_write. */
abbe_result abbe_difference_picture_write(const char *path, const abbe_field *reference,
                                          const abbe_field *test, double scale, double range,
                                          const char *title, abbe_error *error);

#endif
