/* glare.h: what the eye scatters of bright light, spread over a picture [Spencer1995].
 *
 * The point spread of an eye in daylight: 0.384 f0 + 0.478 f1 + 0.138 f2 a steradian at theta
 * degrees, with f0 = 2.61e6 exp(-(theta/0.02)^2), f1 = 20.91/(theta + 0.02)^3 and f2 =
 * 72.37/(theta + 0.02)^2. It has no lines and no halo of a dark-adapted eye, and no wavelength.
 */
#ifndef ABBE_COLORIMETRY_SCREEN_GLARE_H
#define ABBE_COLORIMETRY_SCREEN_GLARE_H

#include "colorimetry/image/image.h"

#define ABBE_GLARE_MIN_DEG 0.1
#define ABBE_GLARE_MAX_DEG 120
#define ABBE_GLARE_MAX_PIXELS ((size_t)1 << 24)

/* The point spread, 1/sr, at an angle. */
double abbe_glare_spread(double theta_deg);

/* Spreads the first three channels, linear light, of a picture that is seen so many degrees high.
 * Each pixel's light stays in the picture: it goes on at the edges as in a mirror, and what would
 * go farther than the picture is wide or high stays at its pixel. Not-a-number is dark, and what is
 * infinite the greatest finite value. Exact but for the angle, which is in proportion to pixels.
 * ABBE_INVALID_ARGUMENT for too many pixels, ABBE_NO_MEMORY. */
abbe_result abbe_glare_add(abbe_image *image, double high_deg, abbe_error *error);

#endif
