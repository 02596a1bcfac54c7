#include "gl/scene/gpu_scene.h"

#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Float copy of the shaders' struct (refraction.comp). */
typedef struct gpu_band {
  float weight_n[4], attenuation[4];
} gpu_band;

static void store(const double v[3], double w, float out[4]) {
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
  out[3] = (float)w;
}

static abbe_result upload_spectra(abbe_gpu_scene *scene, abbe_error *error) {
  size_t n = scene->plan->desc.wavelengths;
  float(*spectrum)[4] = calloc(scene->plan->refractor_count * n + 1, sizeof *spectrum);
  if (spectrum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for spectra");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < scene->plan->refractor_count; i++) {
    const abbe_material *material = scene->local->object[scene->plan->refractor_object[i]].material;
    for (size_t k = 0; k < n && result == ABBE_OK; k++) {
      double index = 1;
      result = abbe_material_n(material, scene->lambda_nm[k], &index, error);
      spectrum[i * n + k][0] = (float)index;
      spectrum[i * n + k][1] = (float)abbe_material_attenuation(material, scene->lambda_nm[k]);
    }
  }
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, scene->plan->refractor_count * n * sizeof *spectrum,
                                  spectrum, &scene->spectra, error);
  free(spectrum);
  return result;
}

/* A pair of bands as one: weights add, index and attenuation are means by brightness. */
static void join_bands(const gpu_band *a, const gpu_band *b, gpu_band *out) {
  double wa = 1e-9, wb = 1e-9;
  for (int c = 0; c < 3; c++) {
    wa += fabs(a->weight_n[c]);
    wb += fabs(b->weight_n[c]);
    out->weight_n[c] = a->weight_n[c] + b->weight_n[c];
  }
  out->weight_n[3] = (float)((wa * a->weight_n[3] + wb * b->weight_n[3]) / (wa + wb));
  out->attenuation[0] = (float)((wa * a->attenuation[0] + wb * b->attenuation[0]) / (wa + wb));
}

static abbe_result fill_bands(const abbe_gpu_scene *scene, const abbe_weights *xyz,
                              size_t refractor, gpu_band *band, abbe_error *error) {
  const abbe_material *material =
      scene->local->object[scene->plan->refractor_object[refractor]].material;
  size_t count = xyz->count;
  for (size_t i = 0; i < count; i++) {
    double n = 1, weight[3];
    abbe_result result = abbe_material_n(material, scene->lambda_nm[i], &n, error);
    if (result != ABBE_OK) return result;
    for (int c = 0; c < 3; c++)
      weight[c] = xyz->sum[c] > 0 ? xyz->weight[i][c] / xyz->sum[c] : 1.0 / (double)count;
    store(weight, n, band[i].weight_n);
    band[i].attenuation[0] = (float)abbe_material_attenuation(material, scene->lambda_nm[i]);
  }
  for (; count > 1; band += count, count = (count + 1) / 2)
    for (size_t i = 0; i < (count + 1) / 2; i++) {
      band[count + i] = band[2 * i];
      if (2 * i + 1 < count) join_bands(&band[2 * i], &band[2 * i + 1], &band[count + i]);
    }
  return ABBE_OK;
}

/* The eye's weights are the first light's in XYZ, where none is negative, by its white. */
static abbe_result upload_bands(abbe_gpu_scene *scene, const abbe_wavelengths *w,
                                abbe_error *error) {
  size_t refractors = scene->plan->refractor_count;
  gpu_band *band = calloc(refractors * scene->band_count + 1, sizeof *band);
  abbe_weights xyz = {0};
  if (band == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  abbe_result result =
      abbe_weights_make(w, &scene->local->light[0].illuminant, ABBE_RGB_SPACE_XYZ, &xyz, error);
  for (size_t i = 0; i < refractors && result == ABBE_OK; i++)
    result = fill_bands(scene, &xyz, i, band + i * scene->band_count, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, refractors * scene->band_count * sizeof *band, band,
                                  &scene->bands, error);
  abbe_weights_free(&xyz);
  free(band);
  return result;
}

abbe_result abbe_gpu_spectra_upload(abbe_gpu_scene *scene, abbe_error *error) {
  const abbe_render_desc *desc = &scene->plan->desc;
  const size_t n = desc->wavelengths;
  abbe_wavelengths w = {0};
  abbe_result result = abbe_wavelengths_make(n, desc->min_nm, desc->max_nm, &w, error);
  if (result != ABBE_OK) return result;
  scene->lambda_nm = malloc(n * sizeof *scene->lambda_nm);
  if (scene->lambda_nm == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  else
    memcpy(scene->lambda_nm, w.lambda_nm, n * sizeof *scene->lambda_nm);
  if (result == ABBE_OK) result = upload_spectra(scene, error);
  if (result == ABBE_OK) result = upload_bands(scene, &w, error);
  abbe_wavelengths_free(&w);
  return result;
}
