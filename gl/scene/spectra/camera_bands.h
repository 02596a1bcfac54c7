/* camera_bands.h: the bands of wavelengths that the camera's rays are followed for, of every
 * refractor, as float copies of the shaders' struct (refraction.comp). Internal to gl/.
 *
 * A set has a band for each wavelength, then these joined by twos, and so on to one. The first set
 * is of the plan's wavelengths. The others are for the samples of a pixel, which share the
 * spectrum: their wavelengths stand at one quarter after the other of the plan's bands, so that
 * four samples together have four times as many. Each set by itself makes white of white.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_CAMERA_BANDS_H
#define ABBE_GL_SCENE_SPECTRA_CAMERA_BANDS_H

#include "gl/scene/spectra/spectral_tables.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { ABBE_CAMERA_BAND_SHARES = 4, ABBE_CAMERA_BAND_SETS = 1 + ABBE_CAMERA_BAND_SHARES };

typedef struct abbe_camera_band {
  float weight_n[4];    /* X, Y, Z, each of a sum of 1 over a level; mean index */
  float attenuation[4]; /* 1/m; of a mirror: reflectance at normal incidence, factor, n, k */
} abbe_camera_band;

/* Bands of a set for so many wavelengths, all levels together; *levels: so many. */
size_t abbe_camera_bands_count(size_t wavelengths, size_t *levels);

/* out: [refractors][ABBE_CAMERA_BAND_SETS][abbe_camera_bands_count], zeroed. Errors of
 * abbe_spectral_tables_make. */
abbe_result abbe_camera_bands_fill(const abbe_scene *scene, const abbe_plan *plan,
                                   const abbe_spectral_tables *tables, abbe_camera_band *out,
                                   abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
