/* lib_comparison.h: how far a picture or a receiver map is from a reference, and whether noise
 * explains it. docs/validation.md says what each metric is; nothing is moved, blurred or
 * tone-mapped.
 */
#ifndef ABBE_LIBRARY_LIB_COMPARISON_H
#define ABBE_LIBRARY_LIB_COMPARISON_H

#include "base/error.h"
#include "library/lib_picture.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_lib_comparison abbe_lib_comparison;

/* Both pictures are copied. mask: a picture whose first channel is above 0.5 inside, or NULL.
 * Settings: mask (caustic: the brightest pixels of the reference's caustic; instead of a drawn
 * one), mask_share (of the caustic's light, 0.95), best_scale (1: the test times the factor that
 * fits best), structure (1: SSIM and both FLIP too), seed (of the noise that stands in for the
 * reference's). ABBE_INVALID_ARGUMENT where the two cannot be compared, with what differs;
 * ABBE_NO_MEMORY. */
abbe_result abbe_lib_comparison_make(const abbe_lib_picture *reference,
                                     const abbe_lib_picture *test, const abbe_lib_picture *mask,
                                     const char *const *settings, size_t count,
                                     abbe_lib_comparison **out, abbe_error *error);
void abbe_lib_comparison_free(abbe_lib_comparison *comparison);

/* "relative_rmse", "ciede2000_mean", …; NULL past the last one. */
const char *abbe_lib_comparison_metric(size_t index);

/* A metric over the whole field, or over the mask; what it would be of an exact test, by the
 * reference's noise alone; and up to where that noise explains it. NaN stands for what is not
 * known: no standard errors, no such channels. ABBE_NOT_FOUND for a metric that is none,
 * ABBE_INVALID_ARGUMENT without a mask. */
abbe_result abbe_lib_comparison_value(const abbe_lib_comparison *comparison, const char *metric,
                                      bool masked, double *value, double *noise, double *limit,
                                      abbe_error *error);
/* What it would be by the noise of both, where the test has standard errors; else NaN. */
double abbe_lib_comparison_both_noise(const abbe_lib_comparison *comparison, const char *metric,
                                      bool masked);
/* The factor that the test was multiplied by; 1 without best_scale. */
double abbe_lib_comparison_scale(const abbe_lib_comparison *comparison);
/* "unknown", "below the reference's noise", "below the noise of both" or "above the noise". NULL
 * where there is no such metric. */
const char *abbe_lib_comparison_verdict(const abbe_lib_comparison *comparison, const char *metric,
                                        bool masked);
/* How many pixels were compared, of the mask or of the whole field; 0 without a mask. */
size_t abbe_lib_comparison_pixels(const abbe_lib_comparison *comparison, bool masked);

/* Where the test is brighter (red) or darker (blue), from -range to range, as a .png or .svg; range
 * 0: what 99 % of the differences stay within. title may be NULL. ABBE_INVALID_ARGUMENT, ABBE_IO,
 * ABBE_NO_MEMORY. */
abbe_result abbe_lib_comparison_draw(const abbe_lib_comparison *comparison, const char *path,
                                     double range, const char *title, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
