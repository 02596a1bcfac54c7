/* reflectance.h: what receivers reflect: their colour, and their texture where they have one.
 *
 * A scene states reflectances as linear Rec.709 colours, not as spectra. In pictures the colour of
 * the light is multiplied by the reflectance, component by component in the picture's own space.
 * For bands of wavelengths the colour is lifted to a spectrum (colorimetry/upsampling.h) that has it
 * under D65; so a grey stays grey.
 */
#ifndef ABBE_VALIDATION_TRANSPORT_REFLECTANCE_H
#define ABBE_VALIDATION_TRANSPORT_REFLECTANCE_H

#include "colorimetry/rgb_space.h"
#include "validation/transport/geometry.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_reflectance {
  const abbe_geometry *geometry;
  float to_space[9]; /* from linear Rec.709 to shares of the picture's white, row-major */
} abbe_reflectance;

void abbe_reflectance_make(const abbe_geometry *geometry, abbe_rgb_space space,
                           abbe_reflectance *out);

/* Of a receiver at a place on a face, linear Rec.709. */
void abbe_reflectance_rec709(const abbe_reflectance *r, uint32_t surface, uint32_t face, float u,
                             float v, float out[3]);
/* The same in the picture's space. */
void abbe_reflectance_at(const abbe_reflectance *r, uint32_t surface, uint32_t face, float u,
                         float v, float out[3]);
/* Of the Rec.709 colour in a band, by what that reflects of R, G and B (bands.h). */
static inline float abbe_reflectance_band(const float rec709[3], const float basis[3]) {
  return rec709[0] * basis[0] + rec709[1] * basis[1] + rec709[2] * basis[2];
}

#ifdef __cplusplus
}
#endif
#endif
