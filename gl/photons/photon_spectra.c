#include "gl/photons/photon_spectra.h"

#include "gl/scene/spectra/interval_sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool abbe_photon_spectra_refines(const abbe_photon_spectra *spectra) {
  return spectra->nodes < spectra->scene->tables.all.count;
}

/* A table of the coarse set and of all wavelengths, or where every photon takes all of them, of
 * those alone: never larger than at first. */
static abbe_result upload(const abbe_photon_spectra *spectra, const void *table, size_t coarse,
                          size_t all, GLuint *buffer, abbe_error *error) {
  const abbe_spectral_tables *t = &spectra->scene->tables;
  const bool two = t->coarse.count < t->all.count;
  const bool skips = two && !abbe_photon_spectra_refines(spectra);
  const char *from = (const char *)table + (skips ? coarse : 0);
  const size_t size = (skips ? 0 : coarse) + (two ? all : 0);
  if (*buffer == 0) return abbe_gpu_make_buffer(spectra->scene->gpu, size, from, buffer, error);
  const abbe_gl *gl = spectra->scene->gpu->gl;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, *buffer);
  gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, from);
  return ABBE_OK;
}

static abbe_result upload_intervals(abbe_photon_spectra *spectra, const float (*table)[4],
                                    abbe_error *error) {
  const abbe_plan *plan = spectra->scene->plan;
  const abbe_spectral_tables *t = &spectra->scene->tables;
  return upload(spectra, table,
                abbe_interval_sums_size(plan, t->steps, t->coarse.count) * sizeof *table,
                abbe_interval_sums_size(plan, t->steps, t->all.count) * sizeof *table,
                &spectra->intervals, error);
}

static abbe_result upload_attenuation(abbe_photon_spectra *spectra, abbe_error *error) {
  const abbe_plan *plan = spectra->scene->plan;
  const abbe_spectral_tables *t = &spectra->scene->tables;
  if (t->bands == NULL) return ABBE_OK;
  return upload(spectra, t->bands,
                abbe_band_attenuation_texels(plan, t->coarse.count) * sizeof *t->bands,
                abbe_band_attenuation_texels(plan, t->all.count) * sizeof *t->bands,
                &spectra->attenuation, error);
}

abbe_result abbe_photon_spectra_weigh(abbe_photon_spectra *spectra, size_t bands, size_t first,
                                      abbe_error *error) {
  const abbe_gpu_scene *scene = spectra->scene;
  float(*table)[4] = NULL;
  if (bands == 0)
    return upload_intervals(spectra, (const float(*)[4])scene->tables.intervals, error);
  abbe_result result = abbe_spectral_tables_intervals(&scene->tables, scene->local, scene->plan,
                                                      bands, first, &table, error);
  if (result == ABBE_OK) result = upload_intervals(spectra, (const float(*)[4])table, error);
  free(table);
  return result;
}

abbe_result abbe_photon_spectra_make(const abbe_gpu_scene *scene, abbe_photon_spectra *out,
                                     abbe_error *error) {
  const abbe_spectral_tables *t = &scene->tables;
  out->scene = scene;
  out->nodes = t->coarse.count;
  abbe_result result = abbe_photon_spectra_weigh(out, 0, 0, error);
  if (result == ABBE_OK) result = upload_attenuation(out, error);
  const size_t size = scene->plan->light_view_count * t->all.count * sizeof *t->sample_weight;
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, size, t->sample_weight, &out->sample_weights, error);
  return result;
}

void abbe_photon_spectra_free(abbe_photon_spectra *spectra) {
  if (spectra->scene == NULL) return;
  GLuint buffers[] = {spectra->intervals, spectra->attenuation, spectra->sample_weights};
  abbe_gpu_drop_buffers(spectra->scene->gpu, sizeof buffers / sizeof *buffers, buffers);
}

abbe_result abbe_photon_spectra_take_all(abbe_photon_spectra *spectra, abbe_error *error) {
  spectra->nodes = spectra->scene->tables.all.count;
  abbe_result result = abbe_photon_spectra_weigh(spectra, 0, 0, error);
  return result == ABBE_OK ? upload_attenuation(spectra, error) : result;
}

size_t abbe_photon_signature_bytes(const abbe_photon_spectra *spectra) {
  return spectra->scene->plan->depths ? 16 : 4;
}

/* Part k of a hit's optical depths (photon_depth.glsl). */
static double depth_of(const GLuint *packed, unsigned k) {
  const unsigned bit = 12 * k, word = bit / 32, shift = bit % 32;
  GLuint q = packed[word] >> shift;
  if (shift > 20) q |= packed[word + 1] << (32 - shift);
  const double root = (double)(q & 4095u) / 4095;
  return ABBE_PHOTON_MOST_DEPTH * root * root;
}

void abbe_photon_attenuate(const abbe_photon_spectra *spectra, size_t count, float *hit,
                           GLuint *signature) {
  enum { BELOW = ABBE_HALF_PARTS - 1, ABOVE = ABBE_HALF_PARTS }; /* the parts beside the node */
  if (!spectra->scene->plan->depths) return;
  for (size_t i = 0; i < count; i++) {
    const GLuint *packed = &signature[4 * i + 1];
    const double depth = 0.5 * (depth_of(packed, BELOW) + depth_of(packed, ABOVE));
    hit[4 * i + 3] *= (float)exp(-depth);
    signature[i] = signature[4 * i];
  }
}
