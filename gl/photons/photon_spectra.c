#include "gl/photons/photon_spectra.h"

#include "gl/scene/spectra/spectral_tables.h"

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

static abbe_result upload_tints(abbe_photon_spectra *spectra, abbe_error *error) {
  const abbe_spectral_tables *t = &spectra->scene->tables;
  const size_t a_node = abbe_plan_surfaces(spectra->scene->plan) * sizeof *t->tints;
  if (t->tints == NULL) return ABBE_OK;
  return upload(spectra, t->tints, t->coarse.count * a_node, t->all.count * a_node, &spectra->tints,
                error);
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
  ABBE_TRY(abbe_photon_spectra_weigh(out, 0, 0, error));
  ABBE_TRY(upload_tints(out, error));
  const size_t size = scene->plan->light_view_count * t->all.count * sizeof *t->sample_weight;
  return abbe_gpu_make_buffer(scene->gpu, size, t->sample_weight, &out->sample_weights, error);
}

void abbe_photon_spectra_free(abbe_photon_spectra *spectra) {
  if (spectra->scene == NULL) return;
  GLuint buffers[] = {spectra->intervals, spectra->tints, spectra->sample_weights};
  abbe_gpu_drop_buffers(spectra->scene->gpu, sizeof buffers / sizeof *buffers, buffers);
}

abbe_result abbe_photon_spectra_take_all(abbe_photon_spectra *spectra, abbe_error *error) {
  spectra->nodes = spectra->scene->tables.all.count;
  ABBE_TRY(abbe_photon_spectra_weigh(spectra, 0, 0, error));
  return upload_tints(spectra, error);
}

size_t abbe_photon_signature_bytes(const abbe_plan *plan) {
  return plan->tints == 0 ? 4 : plan->tints == 1 ? 8 : 16;
}

GLenum abbe_photon_signature_format(const abbe_plan *plan) {
  return plan->tints == 0 ? GL_R32UI : plan->tints == 1 ? GL_RG32UI : GL_RGBA32UI;
}

/* Optical depth of a hit's tints at a node, by its words (tints.glsl). */
static double depth_of(const abbe_photon_spectra *spectra, size_t node, const GLuint *word) {
  const abbe_plan *plan = spectra->scene->plan;
  const abbe_spectral_tables *t = &spectra->scene->tables;
  const size_t before = t->coarse.count < t->all.count ? t->coarse.count : 0;
  double depth = 0;
  for (size_t k = 0; k < plan->tints; k++) {
    const size_t r = word[k] & 255u;
    const GLuint bits = (word[k] & ~255u) >> 1;
    float amount = 0;
    memcpy(&amount, &bits, sizeof amount);
    if (r >= abbe_plan_surfaces(plan)) continue;
    const float *part = t->tints[(before + node) * abbe_plan_surfaces(plan) + r][0];
    depth += (double)amount * 0.5 * ((double)part[1] + (double)part[2]); /* beside the node */
  }
  return depth;
}

void abbe_photon_attenuate(const abbe_photon_spectra *spectra, size_t first, size_t stride,
                           size_t count, float *hit, GLuint *signature) {
  const size_t words = abbe_photon_signature_bytes(spectra->scene->plan) / sizeof *signature;
  if (words == 1) return;
  for (size_t i = 0; i < count; i++) {
    const GLuint *of = &signature[words * i];
    const size_t node = first + i % stride;
    if (of[0] != 0 && node < spectra->scene->tables.all.count)
      hit[4 * i + 3] *= (float)exp(-depth_of(spectra, node, of + 1));
    signature[i] = of[0];
  }
}
