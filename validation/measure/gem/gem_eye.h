/* gem_eye.h: an eye far away that looks at a stone: parallel rays through a square of pixels.
 *
 * The stone lies level or is tilted about a horizontal axis of its own; the square is the same at
 * all tilts, the least that holds the ball around the stone's corners. Internal to
 * validation/measure/gem/.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_EYE_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_EYE_H

#include <stddef.h>
#include <stdint.h>

/* Unit vectors in the stone's axes. */
typedef struct abbe_gem_eye {
  double right[3], up[3]; /* directions of the picture; x and y where the stone lies level */
  double to_eye[3];       /* z there */
} abbe_gem_eye;

/* axis_rad: azimuth of the axis, from x to y; tilt_rad: above 0, the stone turns by it as a right
 * hand's fingers about the axis: what is to the left of the axis' arrow comes towards the eye. */
abbe_gem_eye abbe_gem_eye_make(double axis_rad, double tilt_rad);

/* The ray of pixel (column, row) of side x side, row 0 at the top, at (u, v) in it, each 0 to 1,
 * from the left and top: a place outside the stone, and the direction away from the eye. */
void abbe_gem_eye_ray(const abbe_gem_eye *eye, size_t side, size_t column, size_t row, double u,
                      double v, double o[3], double d[3]);

/* A place in a pixel, by chance: each repeat is a jittered grid by itself, and independent of the
 * others, so that their scatter shows their error. Returns a seed for what else the ray decides. */
uint32_t abbe_gem_eye_place(size_t side, size_t column, size_t row, size_t repeat, double *u,
                            double *v);

#endif
