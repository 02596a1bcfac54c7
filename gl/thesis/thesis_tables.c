#include "gl/thesis/thesis_tables.h"

#include "colorimetry/weights.h"

#include <math.h>
#include <stdlib.h>

/* XYZ weights and attenuations of the default profile. */
static void fill_cie(const abbe_spectral_tables *from, abbe_thesis_tables *t) {
  for (size_t i = 0; i < from->all.count; i++) {
    t->attenuation_of[i] = (float)from->attenuation[i];
    for (int c = 0; c < 3; c++) t->colour[i][c] = (float)from->camera.weight[i][c];
  }
  for (int c = 0; c < 3; c++) t->white[c] = (float)from->camera.sum[c];
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
  for (size_t i = 0; i < n; i++) t->index[i] = (float)scene->tables.index[i]; /* of the first */
  if (cie) {
    fill_cie(&scene->tables, t);
    return ABBE_OK;
  }
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    double at = n > 1 ? 6.0 * (double)i / (double)(n - 1) : 3.0, f = at - floor(at);
    size_t k = (size_t)fmin(floor(at), 5);
    f = at - (double)k;
    for (int c = 0; c < 3; c++) {
      double a = abbe_weights_thesis_rgb[k][c], b = abbe_weights_thesis_rgb[k + 1][c];
      t->colour[i][c] = (float)(a + f * (b - a));
      sum[c] += t->colour[i][c];
    }
  }
  for (size_t i = 0; i < n && n != ABBE_WEIGHTS_THESIS_COUNT; i++)
    for (int c = 0; c < 3; c++) t->colour[i][c] *= (float)(ABBE_THESIS_COLOUR_SUM / sum[c]);
  t->attenuation = scene->tables.attenuation_550[0];
  return ABBE_OK;
}

void abbe_thesis_tables_free(abbe_thesis_tables *tables) {
  free(tables->colour);
  free(tables->index);
  free(tables->attenuation_of);
}
