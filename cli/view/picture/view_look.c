#include "cli/view/picture/view_look.h"

#include <stdlib.h>

abbe_result abbe_view_look_feed(abbe_renderer *renderer, const abbe_scene *scene,
                                const double point[3], double radius, const volatile int *stop,
                                abbe_view_feed *out, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  abbe_result result = ABBE_OK;
  abbe_view_feed_begin(point, radius, out);
  for (size_t i = 0; i < plan->light_view_count && result == ABBE_OK && !*stop; i++) {
    abbe_view_hits hits = {0};
    float *at = NULL;
    unsigned *cell = NULL;
    if (!plan->reaches[i]) continue; /* no photons start from it */
    result = abbe_renderer_read_hits(renderer, i, &at, &cell, &hits.count, &hits.slots,
                                     &hits.samples, error);
    if (result == ABBE_OK) {
      abbe_renderer_photon_view(renderer, i, &hits.view);
      hits.grid = plan->desc.photons;
      hits.at = at;
      hits.cell = cell;
      result = abbe_view_feed_add(out, &hits, error);
    }
    free(at);
    free(cell);
  }
  abbe_view_feed_end(out, scene);
  return result;
}

abbe_result abbe_view_look_map(abbe_renderer *renderer, abbe_image *out, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  *out = (abbe_image){0};
  for (size_t i = 0; i < plan->light_view_count; i++)
    if (plan->reaches[i]) return abbe_renderer_read_map(renderer, i, false, out, error);
  return ABBE_OK;
}
