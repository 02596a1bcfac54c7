/* frame_flicker.h: how a series of frames errs over time: each frame's error, what of it changes
 * from frame to frame (flicker), and light where there should be none (ghosts).
 *
 * Frames come one after another, each with its reference or without. The whole picture counts, or
 * its caustic layers (caustic.R ...) alone. It reads pictures and draws none.
 */
#ifndef ABBE_VALIDATION_MEASURE_FRAME_FLICKER_H
#define ABBE_VALIDATION_MEASURE_FRAME_FLICKER_H

#include "base/error.h"
#include "colorimetry/image/image.h"

#include <stdbool.h>
#include <stddef.h>

/* A reference darker than this share of its own mean has no light there. */
#define ABBE_FRAME_FLICKER_DARK 1e-3

typedef struct abbe_frame_error {
  double error;  /* RMSE by the root mean square of the reference; NaN without one */
  double change; /* change of the error since the frame before, likewise; without references of the
                    frame itself, by its own; NaN of the first */
  double ghost; /* light where the reference has none, by all of the reference's; NaN without one */
} abbe_frame_error;

/* Zeroed but for `caustic` before the first frame. */
typedef struct abbe_frame_flicker {
  size_t width, height, count; /* frames so far */
  bool caustic;                /* its layers count, else the picture */
  float *before;               /* [height][width][3] of the last frame: its error, or itself */
} abbe_frame_flicker;

void abbe_frame_flicker_free(abbe_frame_flicker *flicker);

/* Adds a frame. reference: NULL for all frames or for none. ABBE_INVALID_ARGUMENT for another size
 * or other channels than before, ABBE_NO_MEMORY. */
abbe_result abbe_frame_flicker_add(abbe_frame_flicker *flicker, const abbe_image *frame,
                                   const abbe_image *reference, abbe_frame_error *out,
                                   abbe_error *error);

/* Root mean squares over those of the rows that are known; NaN where none is. */
void abbe_frame_flicker_sum_up(const abbe_frame_error *row, size_t count, abbe_frame_error *out);
/* The largest of each: of changes, how far a frame pops. NaN where none is known. */
void abbe_frame_flicker_largest(const abbe_frame_error *row, size_t count, abbe_frame_error *out);

#endif
