/* What receivers in colours reflect of bands of each light, for the shaders: a row for each
 * receiver and light with the light's white x, y and where its tables begin, 0: it has none; then
 * the tables, one for each of a texture's channels. */
#include "colorimetry/reflectance/band_reflection.h"
#include "gl/plan/examine/models.h"
#include "gl/scene/gpu_scene.h"

#include <stdlib.h>
#include <string.h>

typedef struct work {
  const abbe_gpu_scene *scene;
  size_t lights, receivers, channels, used;
  float (*row)[4];
} work;

static const abbe_object *receiver(const work *w, size_t i) {
  return &w->scene->local->object[w->scene->plan->receiver_object[i]];
}

/* The first light of the same spectrum. */
static size_t like(const work *w, size_t light) {
  const abbe_light *all = w->scene->local->light;
  size_t i = 0;
  while (all[i].illuminant.kind != all[light].illuminant.kind ||
         all[i].illuminant.spectrum != all[light].illuminant.spectrum)
    i++;
  return i;
}

static abbe_result fill_tables(work *w, const abbe_reflected_light *light,
                               const abbe_object *object, abbe_error *error) {
  for (size_t j = 0; j < w->channels; j++) {
    float(*cell)[4] = w->row + w->used;
    const bool one = w->channels == 1;
    const double rgb[3] = {one || j == 0 ? object->reflectance[0] : 0,
                           one || j == 1 ? object->reflectance[1] : 0,
                           one || j == 2 ? object->reflectance[2] : 0};
    w->used += ABBE_BAND_REFLECTION_CELLS;
    if (object->spectrum != NULL && j > 0) continue; /* it has one channel alone */
    abbe_result result = abbe_band_reflection_fill(light, object->spectrum, rgb, cell, error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

static abbe_result fill_light(work *w, size_t l, abbe_error *error) {
  const abbe_render_desc *d = &w->scene->plan->desc;
  const size_t before = like(w, l);
  if (before < l) {
    for (size_t i = 0; i < w->receivers; i++)
      memcpy(w->row[i * w->lights + l], w->row[i * w->lights + before], sizeof *w->row);
    return ABBE_OK;
  }
  abbe_reflected_light *light;
  abbe_result result = abbe_reflected_light_make_by(
      d->observer, &w->scene->local->light[l].illuminant, d->min_nm, d->max_nm, &light, error);
  if (result != ABBE_OK) return result;
  double white[3];
  abbe_reflected_light_white(light, white);
  const double sum = white[0] + white[1] + white[2];
  for (size_t i = 0; i < w->receivers && result == ABBE_OK; i++) {
    if (!(sum > 0) || !abbe_receiver_model_is_coloured(receiver(w, i))) continue;
    float *row = w->row[i * w->lights + l];
    row[0] = (float)(white[0] / sum);
    row[1] = (float)(white[1] / sum);
    row[2] = (float)w->used;
    result = fill_tables(w, light, receiver(w, i), error);
  }
  abbe_reflected_light_free(light);
  return result;
}

abbe_result abbe_gpu_band_reflections_upload(abbe_gpu_scene *scene, abbe_error *error) {
  const abbe_plan *plan = scene->plan;
  if (!plan->receiver_colours) return ABBE_OK;
  work w = {.scene = scene,
            .lights = plan->light_view_count,
            .receivers = plan->receiver_count,
            .channels = plan->textured ? 3 : 1};
  size_t tables = 0;
  for (size_t i = 0; i < w.receivers; i++)
    tables += abbe_receiver_model_is_coloured(receiver(&w, i)) ? w.channels : 0;
  size_t spectra = 0;
  for (size_t l = 0; l < w.lights; l++) spectra += like(&w, l) == l;
  w.used = w.receivers * w.lights;
  w.row = calloc(w.used + tables * spectra * ABBE_BAND_REFLECTION_CELLS + 1, sizeof *w.row);
  if (w.row == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for reflections");
  abbe_result result = ABBE_OK;
  for (size_t l = 0; l < w.lights && result == ABBE_OK; l++) result = fill_light(&w, l, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, (w.used + 1) * sizeof *w.row, w.row,
                                  &scene->band_reflections, error);
  free(w.row);
  return result;
}
