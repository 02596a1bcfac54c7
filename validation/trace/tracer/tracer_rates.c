/* abbe_tracer_rates: what the photon walk costs beside Embree's own work. */
#include "base/clock.h"
#include "validation/trace/tracer/light_pass.h"
#include "validation/trace/tracer/tracer_state.h"

#include <time.h>

/* Photons emitted, followed, and sorted into texels, by one thread. */
static double walk_seconds(abbe_tracer *t, const abbe_emission *e) {
  abbe_light_walk_room *room = abbe_light_walk_get_room(t->walk[0]);
  abbe_photon *photon = room->photon;
  abbe_photon_hit *hit = room->hit;
  abbe_light_ledger ledger = {0};
  abbe_light_walk_for_map(t->walk[0], abbe_tracer_maps(t, e->light));
  double start = abbe_clock_seconds();
  for (uint32_t j = 0; j < e->count; j += ABBE_LIGHT_WALK_BATCH) {
    size_t count = abbe_emission_batch(e, j, (uint32_t)e->count, photon);
    size_t landed = abbe_light_walk_run(t->walk[0], &t->scene->light[e->light], e->pass, photon,
                                        count, hit, &ledger);
    abbe_tracer_add_to_map(t, 0, e->light, hit, landed);
  }
  double end = abbe_clock_seconds();
  if (!t->desc.no_map) abbe_accumulator_drop_pass(&t->map);
  return end - start;
}

/* The number of rays of both kinds, so far. */
static uint64_t rays_of(const abbe_light_walk *walk) {
  return abbe_light_walk_rays(walk) + abbe_light_walk_lamp_rays(walk);
}

/* The best of a few turns of each, in turn, so that a busy machine harms neither more. */
abbe_result abbe_tracer_rates(abbe_tracer *t, double *walk, double *embree, abbe_error *error) {
  enum { TURNS = 5, PHOTONS = 131072, PACKETS = 65536 };
  *walk = *embree = 0;
  size_t light = 0;
  while (light < t->scene->light_count && t->projection[light].count == 0) light++;
  if (light == t->scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no light reaches a refractor, so there is no walk to time");
  abbe_emission e = {0};
  abbe_result result = abbe_emission_make(t, light, PHOTONS, 0, t->desc.seed, &e, error);
  for (int i = 0; i < TURNS && result == ABBE_OK; i++) {
    uint64_t rays = rays_of(t->walk[0]), replayed;
    double seconds = walk_seconds(t, &e), alone;
    *walk = fmax(*walk, (double)(rays_of(t->walk[0]) - rays) / seconds);
    abbe_light_walk_keep(t->walk[0], PACKETS);
    walk_seconds(t, &e);
    if (abbe_light_walk_replay(t->walk[0], &alone, &replayed))
      *embree = fmax(*embree, (double)replayed / alone);
    abbe_light_walk_keep(t->walk[0], 0);
  }
  t->other_rays = abbe_tracer_walk_rays(t);
  abbe_emission_free(&e);
  return result;
}
