#include "gl/methods/image_space/method.h"

abbe_result abbe_method_see_from_light(abbe_method *m, abbe_error *error) {
  abbe_gpu *gpu = m->scene->gpu;
  abbe_gpu_start_lap(gpu);
  abbe_result result = abbe_image_places_receivers(&m->light, error);
  if (result == ABBE_OK) result = abbe_image_places_shadow(&m->light, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_RECEIVER_DEPTH);
  if (result == ABBE_OK) result = abbe_image_places_objects(&m->light, error);
  m->photon_count = abbe_image_places_count(&m->light);
  abbe_gpu_book_lap(gpu, ABBE_PASS_LIGHT_FRONT_AND_BACK);
  return result;
}
