#include "cli/view/picture/view_feed.h"

#include <math.h>

static bool goes_on(void *user, double done) {
  const volatile int *stop = user;
  (void)done;
  return *stop == 0;
}

/* One batch of a light's wavelengths. last: no other follows. Where the next begins: with the last
 * one of this. */
static abbe_result add_batch(abbe_renderer *renderer, size_t light, size_t first, bool alone,
                             volatile int *stop, abbe_view_feed *feed, size_t *next,
                             abbe_error *error) {
  const size_t wavelengths = abbe_renderer_plan(renderer)->desc.wavelengths;
  abbe_renderer_hits hits;
  abbe_result result =
      abbe_renderer_read_hits(renderer, light, first, goes_on, (void *)stop, &hits, error);
  if (result != ABBE_OK) return result;
  const bool last = first + hits.samples >= wavelengths;
  const abbe_view_hits batch = {.at = hits.at,
                                .path = hits.path,
                                .cell = hits.cell,
                                .count = hits.count,
                                .slots = hits.slots,
                                .samples = hits.samples,
                                .grid = {hits.grid[0], hits.grid[1]},
                                .last = last || alone,
                                .stop = stop,
                                .view = hits.view};
  result = abbe_view_feed_add(feed, &batch, error);
  *next = last || hits.samples < 2 ? first + hits.samples : first + hits.samples - 1;
  abbe_renderer_hits_free(&hits);
  return result;
}

/* The number of the wavelength before this one. */
static size_t wavelength_before(const abbe_render_desc *desc, double nm) {
  const double share = (nm - desc->min_nm) / (desc->max_nm - desc->min_nm);
  return (size_t)(fmin(fmax(share, 0), 1) * (double)(desc->wavelengths - 1));
}

/* Adds all lights: a batch about a wavelength, or all of them. */
static abbe_result add_lights(abbe_renderer *renderer, double nm, bool all, volatile int *stop,
                              abbe_view_feed *feed, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  const size_t most = plan->desc.wavelengths;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < plan->light_view_count; i++) {
    size_t first = all ? 0 : wavelength_before(&plan->desc, nm);
    while (plan->reaches[i] && first < most && result == ABBE_OK && !*stop) {
      result = add_batch(renderer, i, first, !all, stop, feed, &first, error);
      if (!all) break;
    }
  }
  return result;
}

abbe_result abbe_view_look_feed(abbe_renderer *renderer, const abbe_scene *scene,
                                const double point[3], double radius, double nm, volatile int *stop,
                                abbe_view_feed *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_view_feed_begin(point, radius, out);
  if (abbe_view_feed_look(out, scene, nm)) {
    result = add_lights(renderer, nm, false, stop, out, error);
    if (result == ABBE_OK && out->photons == 0)
      result = add_lights(renderer, nm, true, stop, out, error);
  }
  abbe_view_feed_end(out, scene, stop);
  if (result != ABBE_OK || !*stop) return result;
  return abbe_error_set(error, ABBE_CANCELLED, "the look was cancelled");
}

/* For photons alone: the smallest picture. */
static abbe_render_desc desc_of(const abbe_renderer *renderer, volatile int *stop) {
  abbe_render_desc desc = abbe_renderer_plan(renderer)->desc;
  desc.width = desc.height = 16;
  desc.supersample = desc.receiver_samples = desc.adaptive = 1;
  desc.upsample = 0;
  desc.history = 0;
  desc.aovs = false;
  desc.coarse = ABBE_COARSE_NONE;
  desc.progress = goes_on;
  desc.progress_user = (void *)stop;
  return desc;
}

abbe_result abbe_view_look_closer(abbe_context *context, const abbe_renderer *renderer,
                                  const abbe_scene *scene, const double point[3], double radius,
                                  double nm, volatile int *stop, abbe_view_feed *out,
                                  abbe_error *error) {
  abbe_render_desc desc = desc_of(renderer, stop);
  abbe_renderer *closer = NULL;
  abbe_result result = ABBE_OK;
  for (desc.photons *= 2; desc.photons <= ABBE_VIEW_LOOK_PHOTONS && result == ABBE_OK;
       desc.photons *= 2) {
    if (desc.map_size < 2 * desc.photons) desc.map_size = 2 * desc.photons; /* keeps all cells */
    result = closer == NULL ? abbe_renderer_make(context, scene, &desc, &closer, error)
                            : abbe_renderer_change(closer, scene, &desc, error);
    if (result == ABBE_OK)
      result = abbe_view_look_feed(closer, scene, point, radius, nm, stop, out, error);
    if (out->photons > 0) break;
  }
  abbe_renderer_free(closer);
  return result;
}

abbe_result abbe_view_look_map(abbe_renderer *renderer, abbe_image *out, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  *out = (abbe_image){0};
  for (size_t i = 0; i < plan->light_view_count; i++)
    if (plan->reaches[i]) return abbe_renderer_read_map(renderer, i, false, out, error);
  return ABBE_OK;
}
