/* relight.h: a spectral picture as another observer sees it, or under another illuminant, made of
 * its bands alone: nothing is rendered anew.
 *
 * The bands do not separate the lights: all lights of the scene are taken to have one illuminant.
 * It knows nothing of screens. */
#ifndef ABBE_COLORIMETRY_SPECTRAL_PICTURE_RELIGHT_H
#define ABBE_COLORIMETRY_SPECTRAL_PICTURE_RELIGHT_H

#include "colorimetry/rgb_space.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

#include <stdbool.h>

/* Zeroed: the bands outside of layers, as the observer of 1931 sees them, ACEScg. */
typedef struct abbe_relight_desc {
  const char *layer; /* the bands' own, as spectral_channels.h; NULL: none */
  abbe_spectral_view view;
  abbe_rgb_space space;
  bool bands; /* keep them too, and what is re-radiated between them: emissive ones under view.to
                 where there is one */
  /* where the light is not known: light of 1 W/(m2 sr nm) at all wavelengths has Y = 1, instead of
   * lm */
  bool relative;
  struct abbe_exr_reader *file; /* the picture's pixels are there and not in the image (exr.h), of
                                   which only the colours are held; NULL: they are in the image */
  abbe_image_odd *odd;          /* filled, of the bands; may be NULL */
} abbe_relight_desc;

/* The picture's colours as channels R, G, B (X, Y, Z), with the space's chromaticities, windows and
 * the attributes abbe:space, abbe:observer and abbe:unit. RGB of an observer other than that of
 * 1931 is its XYZ through the space's matrix. An infinite band counts as the brightest finite one
 * of the picture, and as 65504, the greatest half, at least. `name` is what errors call the
 * picture. ABBE_NOT_FOUND where it has no bands; errors of abbe_spectral_channels_find and
 * abbe_spectral_colour_weights. */
abbe_result abbe_relight_make(const abbe_image *image, const char *name,
                              const abbe_relight_desc *desc, abbe_image *out, abbe_error *error);

/* Whether its colours are in its bands alone: it has bands there, and neither R, G, B nor X, Y, Z
 * nor Y. */
bool abbe_relight_is_needed(const abbe_image *image, const char *layer);

#endif
