#include "colorimetry/colour_description.h"

#include "colorimetry/colour_temperature.h"

#include <math.h>

void abbe_colour_description_make(const double xyz[3], const double white_xy[2],
                                  abbe_observer observer, abbe_colour_description *out) {
  *out = (abbe_colour_description){.xyz = {xyz[0], xyz[1], xyz[2]},
                                   .xy = {NAN, NAN},
                                   .uv = {NAN, NAN},
                                   .dominant = {NAN, NAN, NAN},
                                   .kelvin = NAN,
                                   .duv = NAN};
  if (!abbe_chromaticity_xy(xyz, out->xy)) return;
  abbe_chromaticity_uv_of_xy(out->xy, out->uv);
  abbe_chromaticity_dominant(out->xy, white_xy, observer, &out->dominant);
  if (observer == ABBE_OBSERVER_CIE_1931)
    abbe_colour_temperature_find(out->xy, &out->kelvin, &out->duv);
}
