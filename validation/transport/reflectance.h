/* reflectance.h: what receivers reflect: their colour, and their texture where they have one.
 *
 * A scene states reflectances as linear Rec.709 colours, not as spectra. In pictures the colour of
 * the light is multiplied by the reflectance, component by component in the picture's own space.
 * For bands of wavelengths the colour is spread over the spectrum: blue below 490 nm, green up to
 * 580 nm, red above, 20 nm of passage between them, so that a grey stays grey.
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
/* Of the Rec.709 colour at one wavelength. */
float abbe_reflectance_band(const float rec709[3], double lambda_nm);

#ifdef __cplusplus
}
#endif
#endif
