/* photon_spectra.h: the wavelengths that photons take, and what lies between them: the light of
 * each interval in steps, what is absorbed in parts of bands, what the ledger weighs samples by. A
 * few wavelengths, the coarse set, are traced for every photon; all of them where it asks for more.
 * Internal to gl/.
 */
#ifndef ABBE_GL_PHOTONS_PHOTON_SPECTRA_H
#define ABBE_GL_PHOTONS_PHOTON_SPECTRA_H

#include "gl/scene/gpu_scene.h"
#include "spectral/wavelengths.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_photon_spectra {
  const abbe_gpu_scene *scene;
  size_t nodes; /* wavelengths of the coarse set; all of them where none are refined */
  size_t steps; /* of an interval */
  size_t map_bands, map_band; /* bands of the range whose light the map sums, and the first of the
                                 three; 0: X, Y, Z */
  GLuint intervals, attenuation, sample_weights;
} abbe_photon_spectra;

abbe_result abbe_photon_spectra_make(const abbe_gpu_scene *scene, abbe_photon_spectra *out,
                                     abbe_error *error);
void abbe_photon_spectra_free(abbe_photon_spectra *spectra);

/* What the map sums: bands first to first + 2 of so many, or with 0 bands X, Y, Z. */
abbe_result abbe_photon_spectra_weigh(abbe_photon_spectra *spectra, size_t bands, size_t first,
                                      abbe_error *error);
/* Every photon takes all wavelengths from now on. */
abbe_result abbe_photon_spectra_take_all(abbe_photon_spectra *spectra, abbe_error *error);

/* Whether some photons take more wavelengths than others. */
bool abbe_photon_spectra_refines(const abbe_photon_spectra *spectra);
/* Index among all wavelengths of node k of so many. */
size_t abbe_photon_spectra_node(size_t wavelengths, size_t nodes, size_t k);
/* The coarse set as a sampling of its own. */
abbe_result abbe_photon_spectra_coarse(const abbe_photon_spectra *spectra,
                                       const abbe_wavelengths *all, abbe_wavelengths *out,
                                       abbe_error *error);

/* band_attenuation.c: what is left of light in parts of its band, where hits keep path lengths; of
 * the coarse set and of all wavelengths, where it is not all of them. */
abbe_result abbe_photon_attenuation_upload(abbe_photon_spectra *spectra,
                                           const abbe_wavelengths *coarse,
                                           const abbe_wavelengths *all, abbe_error *error);
/* Bytes of a hit's signature, with the length of its path where it is kept. */
size_t abbe_photon_signature_bytes(const abbe_photon_spectra *spectra);
/* Of a batch of so many hits, `lanes` wavelengths from `first` on side by side, as read: takes off
 * what is absorbed at their wavelengths, and leaves paths alone in `signature`. */
void abbe_photon_attenuate(const abbe_photon_spectra *spectra, size_t first, size_t lanes,
                           size_t count, float *hit, GLuint *signature);

#endif
