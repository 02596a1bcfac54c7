#include "cli/view/picture/view_look.h"

/* All wavelengths of a light, batch by batch: each begins with the last one of that before it. */
static abbe_result add_light(abbe_renderer *renderer, size_t light, const volatile int *stop,
                             abbe_view_feed *feed, abbe_error *error) {
  const size_t wavelengths = abbe_renderer_plan(renderer)->desc.wavelengths;
  abbe_result result = ABBE_OK;
  for (size_t first = 0; first < wavelengths && result == ABBE_OK && !*stop;) {
    abbe_renderer_hits hits;
    result = abbe_renderer_read_hits(renderer, light, first, &hits, error);
    if (result != ABBE_OK) break;
    const bool last = first + hits.samples >= wavelengths;
    const abbe_view_hits batch = {.at = hits.at,
                                  .path = hits.path,
                                  .cell = hits.cell,
                                  .count = hits.count,
                                  .slots = hits.slots,
                                  .samples = hits.samples,
                                  .grid = {hits.grid[0], hits.grid[1]},
                                  .last = last,
                                  .view = hits.view};
    result = abbe_view_feed_add(feed, &batch, error);
    first = last || hits.samples < 2 ? first + hits.samples : first + hits.samples - 1;
    abbe_renderer_hits_free(&hits);
  }
  return result;
}

abbe_result abbe_view_look_feed(abbe_renderer *renderer, const abbe_scene *scene,
                                const double point[3], double radius, double nm,
                                const volatile int *stop, abbe_view_feed *out, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  abbe_result result = ABBE_OK;
  abbe_view_feed_begin(point, radius, out);
  const bool sees = abbe_view_feed_look(out, scene, nm);
  for (size_t i = 0; sees && i < plan->light_view_count && result == ABBE_OK && !*stop; i++)
    if (plan->reaches[i]) result = add_light(renderer, i, stop, out, error);
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
