#include "gl/scene/gpu_scene.h"

#include <math.h>
#include <stdlib.h>

/* Float copy of the shaders' struct (refraction.comp). */
typedef struct gpu_band {
  float weight_n[4], attenuation[4];
} gpu_band;

size_t abbe_gpu_spectra_room(size_t count) {
  size_t room = 64;
  while (room < count) room *= 2;
  return room;
}

static abbe_result upload_spectra(abbe_gpu_scene *scene, abbe_error *error) {
  const abbe_spectral_tables *tables = &scene->tables;
  const size_t count = scene->plan->refractor_count * tables->all.count;
  const size_t room = abbe_gpu_spectra_room(count);
  float(*spectrum)[4] = calloc(room, sizeof *spectrum);
  if (spectrum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for spectra");
  for (size_t i = 0; i < count; i++) {
    const bool mirror = scene->plan->mirror[i / tables->all.count];
    spectrum[i][0] = (float)tables->index[i];
    spectrum[i][1] = (float)(mirror ? tables->mirror[i].factor : tables->attenuation[i]);
    spectrum[i][2] = (float)tables->mirror[i].n;
    spectrum[i][3] = (float)tables->mirror[i].k;
  }
  abbe_result result =
      abbe_gpu_make_buffer(scene->gpu, room * sizeof *spectrum, spectrum, &scene->spectra, error);
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

/* The camera's weights by their white, and bands joined by twos after them. */
static void fill_bands(const abbe_spectral_tables *tables, size_t refractor, gpu_band *band) {
  const abbe_weights *xyz = &tables->camera;
  size_t count = xyz->count;
  for (size_t i = 0; i < count; i++) {
    for (int c = 0; c < 3; c++)
      band[i].weight_n[c] =
          (float)(xyz->sum[c] > 0 ? xyz->weight[i][c] / xyz->sum[c] : 1.0 / (double)count);
    band[i].weight_n[3] = (float)tables->index[refractor * count + i];
    band[i].attenuation[0] = (float)tables->attenuation[refractor * count + i];
  }
  for (; count > 1; band += count, count = (count + 1) / 2)
    for (size_t i = 0; i < (count + 1) / 2; i++) {
      band[count + i] = band[2 * i];
      if (2 * i + 1 < count) join_bands(&band[2 * i], &band[2 * i + 1], &band[count + i]);
    }
}

static void store_mirror(const abbe_mirror_band *from, gpu_band *out) {
  for (int c = 0; c < 3; c++) out->weight_n[c] = (float)from->weight[c];
  out->weight_n[3] = 1;
  out->attenuation[0] = (float)from->straight;
  out->attenuation[1] = (float)from->factor;
  out->attenuation[2] = (float)from->n;
  out->attenuation[3] = (float)from->k;
}

/* The same of a mirror. */
static abbe_result fill_mirror(const abbe_gpu_scene *scene, size_t refractor, gpu_band *band,
                               abbe_error *error) {
  const abbe_spectral_tables *tables = &scene->tables;
  const abbe_wavelengths *w = &tables->all;
  size_t count = w->count;
  abbe_mirror_band *of = calloc(count + 1, sizeof *of);
  abbe_weights_range light;
  abbe_result result =
      of != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  abbe_weights_range_make(abbe_scene_illuminant(scene->local), w->edge_nm[0], w->edge_nm[count],
                          &light);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = abbe_mirror_band_make(&scene->local->object[scene->plan->refractor_object[refractor]],
                                   &light, tables->camera.sum, w->edge_nm[i], w->edge_nm[i + 1],
                                   &tables->mirror[refractor * count + i], &of[i], error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) store_mirror(&of[i], &band[i]);
  for (; count > 1 && result == ABBE_OK; count = (count + 1) / 2) {
    band += count;
    for (size_t i = 0; i < (count + 1) / 2; i++) {
      of[i] = of[2 * i];
      if (2 * i + 1 < count) {
        const abbe_mirror_band a = of[2 * i];
        abbe_mirror_band_join(&a, &of[2 * i + 1], &of[i]);
      }
      store_mirror(&of[i], &band[i]);
    }
  }
  free(of);
  return result;
}

static abbe_result upload_bands(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t refractors = scene->plan->refractor_count;
  const size_t room = abbe_gpu_spectra_room(refractors * scene->band_count);
  gpu_band *band = calloc(room, sizeof *band);
  if (band == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < refractors && result == ABBE_OK; i++) {
    if (scene->plan->mirror[i])
      result = fill_mirror(scene, i, band + i * scene->band_count, error);
    else
      fill_bands(&scene->tables, i, band + i * scene->band_count);
  }
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, room * sizeof *band, band, &scene->bands, error);
  free(band);
  return result;
}

abbe_result abbe_gpu_spectra_upload(abbe_gpu_scene *scene, abbe_error *error) {
  abbe_result result = upload_spectra(scene, error);
  return result == ABBE_OK ? upload_bands(scene, error) : result;
}
