/* bands.h: the bands of wavelengths of a spectral picture or map.
 *
 * Bands of equal width tile the range; a band's value is the mean over it, a nanometre. Their
 * channels are named as [Fichet2021] lays them out, by the wavelength in the middle.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_BANDS_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_BANDS_H

#include "base/error.h"
#include "validation/trace/transport/spectral_sampling.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_BANDS_MAX 256

typedef struct abbe_bands {
  size_t count; /* 0: none */
  double width_nm;
  double *middle_nm; /* [count] */
  uint16_t *of_step; /* [steps] the band that a sampling step lies in */
  float *power;      /* [lights][count] power of the light in the band, per watt and nm */
} abbe_bands;

/* count bands over the range of a sampling that was made for as many. ABBE_INVALID_ARGUMENT beyond
 * ABBE_BANDS_MAX. */
abbe_result abbe_bands_make(const abbe_spectral_sampling *sampling, size_t count, abbe_bands *out,
                            abbe_error *error);
void abbe_bands_free(abbe_bands *bands);

/* "S0.550,000000nm" */
void abbe_bands_name(const abbe_bands *bands, size_t band, char *out, size_t size);

#endif
