#include "gl/thesis/thesis_tables.h"

#include "colorimetry/weights.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>

/* XYZ weights, indices and attenuations of the default profile. */
static abbe_result fill_cie(const abbe_gpu_scene *scene, abbe_thesis_tables *t, abbe_error *error) {
  size_t n = scene->plan->desc.wavelengths;
  const abbe_material *material = scene->local->object[scene->plan->refractor_object[0]].material;
  abbe_wavelengths nodes = {0};
  abbe_weights xyz = {0};
  abbe_result result =
      abbe_wavelengths_make(n, scene->plan->desc.min_nm, scene->plan->desc.max_nm, &nodes, error);
  if (result == ABBE_OK)
    result = abbe_weights_make(&nodes, &scene->local->light[0].illuminant, ABBE_RGB_SPACE_XYZ, &xyz,
                               error);
  for (size_t i = 0; i < n && result == ABBE_OK; i++) {
    double index = 1;
    result = abbe_material_n(material, nodes.lambda_nm[i], &index, error);
    t->index[i] = (float)index;
    t->attenuation_of[i] = (float)abbe_material_attenuation(material, nodes.lambda_nm[i]);
    for (int c = 0; c < 3; c++) {
      t->colour[i][c] = (float)xyz.weight[i][c];
      t->white[c] = (float)xyz.sum[c];
    }
  }
  abbe_weights_free(&xyz);
  abbe_wavelengths_free(&nodes);
  return result;
}

/* The seven colours, or as many as asked for along the same curve, with the same sum. */
abbe_result abbe_thesis_tables_make(const abbe_gpu_scene *scene, bool cie, abbe_thesis_tables *t,
                                    abbe_error *error) {
  size_t n = scene->plan->desc.wavelengths;
  t->colour = calloc(n, sizeof *t->colour);
  t->index = calloc(n, sizeof *t->index);
  t->attenuation_of = calloc(n, sizeof *t->attenuation_of);
  if (t->colour == NULL || t->index == NULL || t->attenuation_of == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the thesis's colours");
  if (cie) return fill_cie(scene, t, error);
  const abbe_material *material = scene->local->object[scene->plan->refractor_object[0]].material;
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    double at = n > 1 ? 6.0 * (double)i / (double)(n - 1) : 3.0, f = at - floor(at), index = 1;
    size_t k = (size_t)fmin(floor(at), 5);
    f = at - (double)k;
    for (int c = 0; c < 3; c++) {
      double a = abbe_weights_thesis_rgb[k][c], b = abbe_weights_thesis_rgb[k + 1][c];
      t->colour[i][c] = (float)(a + f * (b - a));
      sum[c] += t->colour[i][c];
    }
    abbe_result result = abbe_material_n(material, scene->lambda_nm[i], &index, error);
    if (result != ABBE_OK) return result;
    t->index[i] = (float)index;
  }
  for (size_t i = 0; i < n && n != ABBE_WEIGHTS_THESIS_COUNT; i++)
    for (int c = 0; c < 3; c++) t->colour[i][c] *= (float)(ABBE_THESIS_COLOUR_SUM / sum[c]);
  t->attenuation = abbe_material_attenuation(material, 550.0);
  return ABBE_OK;
}

void abbe_thesis_tables_free(abbe_thesis_tables *tables) {
  free(tables->colour);
  free(tables->index);
  free(tables->attenuation_of);
}
