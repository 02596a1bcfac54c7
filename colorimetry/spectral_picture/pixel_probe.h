/* pixel_probe.h: what a picture has at a pixel, or in the mean of a region.
 *
 * Every channel, with its standard error where the picture has it ("stderr." before the name); the
 * colour; and the spectrum, where there are bands. It describes no colours (pixel.c).
 */
#ifndef ABBE_COLORIMETRY_SPECTRAL_PICTURE_PIXEL_PROBE_H
#define ABBE_COLORIMETRY_SPECTRAL_PICTURE_PIXEL_PROBE_H

#include "colorimetry/image/picture_space.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

#include <stdbool.h>

/* NaN stands for what is not known. */
typedef struct abbe_pixel_probe {
  abbe_image_window window; /* in the plane that pixels are counted in, both ends included */
  size_t pixels;
  size_t channels;
  double *mean, *error; /* [channels] of the image: standard errors, as of independent pixels */
  bool has_colour;
  abbe_picture_space space;
  double xyz[3];                   /* from R, G, B or X, Y, Z; relative to D65 */
  abbe_spectral_channels spectrum; /* count 0: none; its values are mean[spectrum.channel[i]] */
  bool has_spectral_xyz;
  bool is_relative;         /* spectral_xyz is in the unit of the picture; else lm (of a radiance:
                               cd/m2) */
  double spectral_xyz[3];   /* from the bands, by the view */
  double spectral_error[3]; /* at the most, whatever the correlation of the bands' errors */
  double white_xy[2];       /* the view's white */
} abbe_pixel_probe;

/* Probes image in the window. `layer`: channels LAYER.R and so on; NULL: those without one. `name`
 * is what errors call the picture. ABBE_INVALID_ARGUMENT where the window is not inside the
 * picture's, ABBE_NOT_FOUND where there is neither colour nor spectrum; errors of
 * abbe_picture_space_find, abbe_spectral_channels_find and abbe_spectral_colour_weights. */
abbe_result abbe_pixel_probe_make(const abbe_image *image, const char *layer, const char *name,
                                  abbe_image_window window, const abbe_spectral_view *view,
                                  abbe_pixel_probe *out, abbe_error *error);
void abbe_pixel_probe_free(abbe_pixel_probe *probe);

#endif
