/* pass_error.h: how far off a traced picture may be, measured by its own passes.
 *
 * Passes are independent, so what the first of them make can be compared with what the others make:
 * neither knows the other's noise, and what few bright photons did to the one they did not do to
 * the other. That is the error of the first passes, which is no less than that of all, however
 * slowly a caustic of rare bright specks comes together. Errors are mean CIEDE2000 in the caustic
 * (the brightest pixels that hold 95 % of its light), relative to the picture's own white.
 */
#ifndef ABBE_VALIDATION_TRACE_PASS_ERROR_H
#define ABBE_VALIDATION_TRACE_PASS_ERROR_H

#include "base/error.h"
#include "colorimetry/image/image.h"

/* A picture of abbe_tracer_picture, and what it was after the first of its passes. */
typedef struct abbe_pass_pictures {
  const abbe_image *part, *whole;
  size_t part_passes, passes; /* behind them: 1 <= part_passes < passes; half is best */
  /* What a filter makes of each, whose error is then estimated; or both NULL. */
  const abbe_image *filtered_part, *filtered;
} abbe_pass_pictures;

/* Mean CIEDE2000, at least 0. */
typedef struct abbe_pass_error {
  double estimate; /* for all passes, were their noise to fall as one over the root of their number;
                      for a filtered picture one over the fourth root */
  double bound; /* error of the first passes, and 1.28 standard errors of that: nine of ten pictures
                   are nearer than this */
} abbe_pass_error;

/* Both NaN where nothing is lit through refractors, the picture is black, or a pixel of the caustic
 * is not finite. ABBE_INVALID_ARGUMENT
 * for counts of passes out of range, pictures of different sizes, or without colours;
 * ABBE_NO_MEMORY. */
abbe_result abbe_pass_error_make(const abbe_pass_pictures *pictures, abbe_pass_error *out,
                                 abbe_error *error);

/* The error of a picture that none of the passes made: compared with all of them, whose own noise,
 * from the first and the others, is taken off in squares. The region is the picture's own caustic.
 * The estimate and the bound are both of the picture as it is. Both NaN too where the first and the
 * others differ by over 12: too noisy to show anything. Filtered pictures are not looked at. Errors
 * as above. */
abbe_result abbe_pass_error_of_picture(const abbe_pass_pictures *pictures,
                                       const abbe_image *picture, abbe_pass_error *out,
                                       abbe_error *error);

#endif
