/* lib_weights.h: what each wavelength sample adds to a colour, for programs outside. */
#ifndef ABBE_LIBRARY_LIB_WEIGHTS_H
#define ABBE_LIBRARY_LIB_WEIGHTS_H

#include "base/error.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* count samples evenly over min_nm to max_nm, ends included, into lambda_nm[count], and their
 * weights into weight[3 * count], three a sample: each the integral of observer times illuminant
 * over the sample's own band, all together the illuminant's white with Y = 1. illuminant: D65 (also
 * NULL), D50, A, E or a file of two columns; space: xyz (also NULL), rec709 or acescg.
 * ABBE_INVALID_ARGUMENT for a count outside 1 to 4096 or a range that is none; ABBE_NOT_FOUND for a
 * space that is none; ABBE_IO, ABBE_PARSE, ABBE_SCHEMA of a file. */
abbe_result abbe_lib_weights_fill(const char *illuminant, const char *space, double min_nm,
                                  double max_nm, size_t count, double *lambda_nm, double *weight,
                                  abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
