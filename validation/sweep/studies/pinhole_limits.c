#include "validation/sweep/studies/pinhole_limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PICTURES = 4, DRAWS = 3 /* limits of a request */, MAP = 128 };

void abbe_pinhole_limits_free(abbe_pinhole_limits *known) {
  if (known == NULL) return;
  for (size_t i = 0; i < known->count; i++) abbe_image_free(&known->limit[i].picture);
  *known = (abbe_pinhole_limits){0};
}

/* Number k of `count` pictures, each with its own samples: those go with the photons' shift. Each
 * sample is taken by itself, and tiles are coarse, which costs little: both of them are alike in
 * the limit. */
static abbe_result draw(abbe_context *context, const abbe_scene *scene,
                        const abbe_render_desc *desc, size_t k, size_t count, abbe_image *out,
                        abbe_error *error) {
  abbe_render_desc d = *desc;
  abbe_renderer *renderer = NULL;
  d.map_size = MAP;
  if (!abbe_method_of(d.profile)->surroundings) d.clusters = ABBE_RENDER_MAX_CLUSTERS;
  d.photon_shift[0] = ((double)k + 0.5) / (double)count - 0.5;
  abbe_result result = abbe_renderer_make(context, scene, &d, &renderer, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, out, error);
  abbe_renderer_free(renderer);
  return result;
}

abbe_result abbe_pinhole_limits_find(abbe_pinhole_limits *known, abbe_context *context,
                                     const abbe_scene *scene, const abbe_render_desc *desc,
                                     const abbe_image **out, abbe_error *error) {
  abbe_render_desc d = *desc;
  d.pinholes = known->samples > 0 ? known->samples : ABBE_SURFACE_MAX_SAMPLES;
  *out = NULL;
  for (size_t i = 0; i < known->count; i++)
    if (known->limit[i].profile == d.profile && known->limit[i].footprint == d.footprint)
      *out = &known->limit[i].picture;
  if (*out != NULL) return ABBE_OK;
  if (known->count == ABBE_PINHOLE_LIMITS_MOST)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "more than %d kinds of pinholes",
                          ABBE_PINHOLE_LIMITS_MOST);
  const size_t pictures = known->pictures > 0 ? known->pictures : PICTURES;
  abbe_image mean = {0};
  abbe_result result = ABBE_OK;
  for (size_t k = 0; k < pictures && result == ABBE_OK; k++) {
    abbe_image one = {0};
    result = draw(context, scene, &d, k, pictures, k == 0 ? &mean : &one, error);
    const size_t count = mean.width * mean.height * mean.channels;
    for (size_t i = 0; i < count && result == ABBE_OK && k > 0; i++)
      mean.data[i] += (one.data[i] - mean.data[i]) / (float)(k + 1);
    abbe_image_free(&one);
  }
  if (result != ABBE_OK) {
    abbe_image_free(&mean);
    return result;
  }
  known->limit[known->count].profile = d.profile;
  known->limit[known->count].footprint = d.footprint;
  known->limit[known->count].picture = mean;
  *out = &known->limit[known->count++].picture;
  return ABBE_OK;
}

double abbe_pinhole_limits_distance(const abbe_image *picture, const abbe_image *limit) {
  double off = 0, all = 0;
  for (size_t i = 0; i < picture->width * picture->height; i++)
    for (size_t k = 0; k < 3; k++) {
      const double at = (double)limit->data[i * limit->channels + k];
      const double d = (double)picture->data[i * picture->channels + k] - at;
      off += d * d;
      all += at * at;
    }
  return sqrt(off / all);
}

abbe_result abbe_pinhole_limits_measure(abbe_pinhole_limits *known, abbe_context *context,
                                        const abbe_scene *scene, const abbe_render_desc *desc,
                                        double *rmse, abbe_error *error) {
  const abbe_image *limit;
  double square = 0;
  abbe_result result = abbe_pinhole_limits_find(known, context, scene, desc, &limit, error);
  for (size_t k = 0; k < DRAWS && result == ABBE_OK; k++) {
    abbe_image picture = {0};
    result = draw(context, scene, desc, k, DRAWS, &picture, error);
    if (result == ABBE_OK) square += pow(abbe_pinhole_limits_distance(&picture, limit), 2) / DRAWS;
    abbe_image_free(&picture);
  }
  *rmse = result == ABBE_OK ? sqrt(square) : NAN;
  return result;
}
