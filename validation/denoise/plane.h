/* plane.h: means over squares of pixels.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_DENOISE_PLANE_H
#define ABBE_VALIDATION_DENOISE_PLANE_H

#include <stddef.h>

/* out (not from) of width x height pixels: means over squares of `reach` pixels to each side, less
 * where they leave the plane. `room` is another plane. */
void abbe_plane_mean(const float *from, size_t width, size_t height, size_t reach, size_t threads,
                     float *room, float *out);

#endif
