/* band_picture.h: a picture in bands of wavelengths, a frame a band.
 *
 * Each band is a picture of its own: the light of its wavelengths alone, receivers with what they
 * reflect there, by the same passes as any other. So it costs as many frames as there are bands,
 * and the photons of each are followed and fitted anew; that is what makes each band as sharp as
 * its own width. Within a band light counts by its power, not by what the eye makes of it.
 * Reflectances, which scenes state as colours, are lifted to spectra (upsampling.h).
 * It is refused where surroundings have colours (ABBE_UNSUPPORTED).
 */
#ifndef ABBE_GL_BAND_PICTURE_H
#define ABBE_GL_BAND_PICTURE_H

#include "gl/renderer.h"

/* desc as of abbe_renderer_make; its range is shared out to so many bands (1 to
 * ABBE_RENDER_MAX_BANDS) of equal width, its wavelengths too: at least two a band, where it has
 * more than one. progress may be NULL. Channels "S0.550,000000nm" and so on, the mean spectral
 * radiance over each band in W/(m2 sr nm), with the attributes of that layout [Fichet2021].
 * ABBE_INVALID_ARGUMENT for a published profile and for so many bands that light would be beyond
 * what the eye sees; errors of abbe_renderer_make and abbe_renderer_frame. */
abbe_result abbe_band_picture_make(abbe_context *context, const abbe_scene *scene,
                                   const abbe_render_desc *desc, size_t bands,
                                   abbe_render_progress progress, void *user, abbe_image *out,
                                   abbe_error *error);

#endif
