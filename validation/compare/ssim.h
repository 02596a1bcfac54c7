/* ssim.h: structural similarity of two grey pictures.
 *
 * [Wang2004]'s index: windows of 11 x 11 under a Gaussian of 1.5 pixels, K1 = 0.01, K2 = 0.03, for
 * values from 0 to 1. What the values mean is the caller's.
 */
#ifndef ABBE_VALIDATION_COMPARE_SSIM_H
#define ABBE_VALIDATION_COMPARE_SSIM_H

#include "base/error.h"

#include <stddef.h>

enum { ABBE_SSIM_REACH = 5 }; /* pixels from a window's middle to its edge */

/* The index, -1 to 1 (equal), of the window about each pixel, into out[width * height], row by row;
 * NaN where the window reaches over the picture's edge, and where it has a value that is not
 * finite. ABBE_NO_MEMORY. */
abbe_result abbe_ssim_map(const float *a, const float *b, size_t width, size_t height, float *out,
                          abbe_error *error);

#endif
