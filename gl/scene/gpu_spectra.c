#include "gl/scene/gpu_scene.h"

#include "gl/device/bindings.h"
#include "gl/scene/spectra/camera_bands.h"

#include <stdlib.h>

size_t abbe_gpu_spectra_room(size_t count) {
  size_t room = 2048; /* what a uniform block holds of the largest element */
  while (room < count) room *= 2;
  return room;
}

static abbe_result upload_spectra(abbe_gpu_scene *scene, abbe_error *error) {
  const abbe_spectral_tables *tables = &scene->tables;
  const size_t n = tables->all.count, count = scene->plan->refractor_count * n;
  const size_t room = abbe_gpu_spectra_room(count + n);
  float(*spectrum)[4] = calloc(room, sizeof *spectrum);
  if (spectrum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for spectra");
  for (size_t i = 0; i < count; i++) {
    const bool mirror = scene->plan->mirror[i / n];
    const size_t object = scene->plan->refractor_object[i / n];
    spectrum[i][0] = (float)tables->index[i];
    spectrum[i][1] = (float)(mirror ? tables->mirror[i].factor : tables->attenuation[i]);
    spectrum[i][2] = (float)(mirror ? tables->mirror[i].n
                                    : abbe_medium_scattering(scene->local->object[object].medium,
                                                             tables->all.lambda_nm[i % n]));
    spectrum[i][3] = (float)tables->mirror[i].k;
  }
  for (size_t i = 0; i < n; i++) {
    const double scattering =
        abbe_medium_scattering(scene->local->medium, tables->all.lambda_nm[i]);
    spectrum[count + i][0] = 1;
    spectrum[count + i][1] = (float)(scattering + abbe_medium_absorption(scene->local->medium,
                                                                         tables->all.lambda_nm[i]));
    spectrum[count + i][2] = (float)scattering;
  }
  abbe_result result =
      abbe_gpu_make_buffer(scene->gpu, room * sizeof *spectrum, spectrum, &scene->spectra, error);
  free(spectrum);
  return result;
}

static abbe_result upload_bands(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t count = scene->plan->refractor_count * ABBE_CAMERA_BAND_SETS * scene->band_count;
  const size_t room = abbe_gpu_spectra_room(count);
  const size_t texels = abbe_camera_bands_texels(scene->plan);
  abbe_camera_band *band = calloc(room, sizeof *band);
  float(*texel)[4] = calloc(texels + 1, sizeof *texel);
  abbe_result result = band != NULL && texel != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  if (result == ABBE_OK)
    result = abbe_camera_bands_fill(scene->local, scene->plan, &scene->tables, band, texel, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, room * sizeof *band, band, &scene->bands, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texels(scene->gpu, GL_RGBA32F, (texels + 1) * sizeof *texel, texel,
                                  UNIT_BAND_TEXELS, &scene->band_texels,
                                  &scene->band_texels_texture, error);
  free(band);
  free(texel);
  return result;
}

static abbe_result upload_films(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t texels = abbe_film_tables_texels(scene->local, scene->plan);
  if (!scene->plan->filmed) return ABBE_OK;
  GLint most = 0;
  scene->gpu->gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (texels > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "films take %zu texels in a buffer; this OpenGL reads at most %d: take "
                          "fewer coatings or wavelengths",
                          texels, most);
  float(*texel)[4] = calloc(texels, sizeof *texel);
  if (texel == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for films");
  abbe_result result =
      abbe_film_tables_fill(scene->local, scene->plan, &scene->tables, texel, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texels(scene->gpu, GL_RGBA32F, texels * sizeof *texel, texel, UNIT_FILMS,
                                  &scene->film_texels, &scene->film_texels_texture, error);
  free(texel);
  return result;
}

abbe_result abbe_gpu_spectra_upload(abbe_gpu_scene *scene, abbe_error *error) {
  ABBE_TRY(upload_spectra(scene, error));
  ABBE_TRY(upload_bands(scene, error));
  return upload_films(scene, error);
}
