/* colour_description.h: all that a colorimeter says of a colour. */
#ifndef ABBE_COLORIMETRY_COLOUR_DESCRIPTION_H
#define ABBE_COLORIMETRY_COLOUR_DESCRIPTION_H

#include "colorimetry/chromaticity.h"

#include <stdbool.h>

/* What there is none of is NaN. */
typedef struct abbe_colour_description {
  double xyz[3];
  double xy[2], uv[2];    /* x, y and u', v' (chromaticity.h) */
  abbe_dominant dominant; /* with respect to the white */
  double kelvin, duv;     /* correlated colour temperature (colour_temperature.h) */
} abbe_colour_description;

/* Of XYZ as that observer sees it, with respect to a white of chromaticity white_xy. A correlated
 * colour temperature is defined for the observer of 1931 alone. */
void abbe_colour_description_make(const double xyz[3], const double white_xy[2],
                                  abbe_observer observer, abbe_colour_description *out);

#endif
