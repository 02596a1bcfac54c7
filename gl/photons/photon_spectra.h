/* photon_spectra.h: the wavelengths that photons take, and the scene's tables of what lies between
 * them, on the device. A few wavelengths, the coarse set, are traced for every photon; all of them
 * where it needs more. Internal to gl/.
 */
#ifndef ABBE_GL_PHOTONS_PHOTON_SPECTRA_H
#define ABBE_GL_PHOTONS_PHOTON_SPECTRA_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_photon_spectra {
  const abbe_gpu_scene *scene;
  size_t nodes; /* wavelengths of the coarse set; all of them where none are refined */
  GLuint intervals, tints, sample_weights;
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

/* Bytes of a hit's signature and tints, and the format of a texture of them. */
size_t abbe_photon_signature_bytes(const abbe_plan *plan);
GLenum abbe_photon_signature_format(const abbe_plan *plan);
/* For so many hits, as read, of which each path has `stride` from wavelength `first` on: takes off
 * what is absorbed beside these, and leaves paths alone in `signature`. */
void abbe_photon_attenuate(const abbe_photon_spectra *spectra, size_t first, size_t stride,
                           size_t count, float *hit, GLuint *signature);

#endif
