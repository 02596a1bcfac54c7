/* spectral_colour.h: the colour of a spectral picture, for any observer and under any light.
 *
 * A picture of bands keeps what the light of each wavelength did in the scene; so it can be looked
 * at by another observer, and under another illuminant than it was made with, by new weights of its
 * bands, without tracing anything anew. It knows nothing of screens.
 */
#ifndef ABBE_COLORIMETRY_SPECTRAL_PICTURE_SPECTRAL_COLOUR_H
#define ABBE_COLORIMETRY_SPECTRAL_PICTURE_SPECTRAL_COLOUR_H

#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

/* lm/W at 540 THz, the definition of the candela; in use for every observer here. */
#define ABBE_SPECTRAL_COLOUR_KM 683.0

/* Zeroed: the observer of 1931, and the light that there is. The illuminants are not owned. */
typedef struct abbe_spectral_view {
  abbe_observer observer;
  const abbe_illuminant *from; /* emissive: that all lights of the scene had; NULL: not known */
  const abbe_illuminant *to;   /* to look at it under; NULL: as it is, a reflectance under D65 */
} abbe_spectral_view;

/* What a unit of each band adds to X, Y and Z, whatever unit the picture states:
 * weight[channels->count].
 *
 * Emissive, `from` not known: each band is even within itself, and XYZ is in lm (of a radiance in
 * W/(m2 sr nm): cd/m2). `from` known: within a band light has its shape, and XYZ is in the unit of
 * Abbe's pictures, where a light of one watt is white with Y = 1; under `to`, every light of the
 * scene has that illuminant instead, with as many of these units. Reflective: relative to a perfect
 * white under `to`, whose Y is 1.
 *
 * ABBE_INVALID_ARGUMENT where there are less than two bands, where they hold no light that the eye
 * sees, and where `to` is given for a light that is not known. */
abbe_result abbe_spectral_colour_weights(const abbe_spectral_channels *channels,
                                         const abbe_spectral_view *view, const char *name,
                                         double (*weight)[3], abbe_error *error);

/* XYZ with Y = 1 of the white of that view, over the bands' range: `to`, else `from`, else D65. */
void abbe_spectral_colour_white(const abbe_spectral_channels *channels,
                                const abbe_spectral_view *view, double xyz[3]);

#endif
