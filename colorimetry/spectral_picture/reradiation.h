/* reradiation.h: a material's re-radiation matrix as a picture of the spectral layout, and back.
 *
 * "T.400,000000nm.550,000000nm" is so much of what is absorbed at 400 nm, by its mean a nm over the
 * band, as comes back a nm at 550 (spectral_channels.h): of light that is absorbed, not of light
 * that falls on a surface. It reads no files. */
#ifndef ABBE_COLORIMETRY_SPECTRAL_PICTURE_RERADIATION_H
#define ABBE_COLORIMETRY_SPECTRAL_PICTURE_RERADIATION_H

#include "colorimetry/image/image.h"
#include "spectral/materials/material.h"

/* One pixel, with a band of no reflectance for each wavelength. ABBE_INVALID_ARGUMENT of what does
 * not glow; ABBE_UNSUPPORTED where it has too many channels. */
abbe_result abbe_reradiation_picture(const abbe_material *material, abbe_image *out,
                                     abbe_error *error);

/* The rows of the picture's matrix, the mean of its pixels, as the value of a record's key
 * fluorescence: "{matrix: [{nm: 400, emission: [[600, 0], …]}, …]}", for the caller to free. `name`
 * is what errors call the picture. ABBE_NOT_FOUND where it has no re-radiation between bands;
 * ABBE_INVALID_ARGUMENT for light at shorter wavelengths than what excites. */
abbe_result abbe_reradiation_text(const abbe_image *image, const char *name, char **out,
                                  abbe_error *error);

#endif
