#include "validation/trace/walks/light_path.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL_SCENE = 4096 }; /* faces */

abbe_result abbe_light_walk_make(const abbe_geometry *geometry, const abbe_media *media,
                                 const abbe_mirrors *mirrors, const abbe_physics *physics,
                                 uint32_t seed, abbe_light_walk **out, abbe_error *error) {
  assert(geometry->scene);
  *out = NULL;
  abbe_light_walk *w = aligned_alloc(64, (sizeof *w + 63) / 64 * 64);
  size_t lights = geometry->scene->light_count;
  if (w != NULL) {
    memset(w, 0, sizeof *w);
    w->g = geometry;
    w->media = media;
    w->mirrors = mirrors;
    w->physics = *physics;
    w->seed = seed;
    w->for_map = true;
    w->batch = aligned_alloc(64, (sizeof *w->batch + 63) / 64 * 64);
    w->next = aligned_alloc(64, (sizeof *w->next + 63) / 64 * 64);
    w->inner = malloc(sizeof *w->inner);
    w->hidden = calloc(lights + 1, sizeof *w->hidden);
  }
  if (w == NULL || w->batch == NULL || w->next == NULL || w->inner == NULL || w->hidden == NULL) {
    abbe_light_walk_free(w);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a batch of photons");
  }
  size_t faces = 0;
  for (size_t i = 0; i < geometry->scene->object_count; i++)
    faces += geometry->scene->object[i].mesh.face_count;
  w->small = faces < SMALL_SCENE;
  for (size_t i = 0; i < lights; i++)
    w->hidden[i] = abbe_lamp_is_hidden(geometry, &geometry->scene->light[i]);
  memset(w->batch, 0, sizeof *w->batch);
  memset(w->next, 0, sizeof *w->next);
  w->inner->count = 0;
  abbe_ray_prepare(w->batch->ray, ABBE_LIGHT_WALK_HITS / ABBE_RAY_LANES);
  abbe_ray_prepare(w->next->ray, ABBE_LIGHT_WALK_HITS / ABBE_RAY_LANES);
  *out = w;
  return ABBE_OK;
}

void abbe_light_walk_free(abbe_light_walk *walk) {
  if (walk == NULL) return;
  free(walk->batch);
  free(walk->next);
  free(walk->inner);
  abbe_ray_record_free(&walk->record);
  free(walk->hidden);
  free(walk);
}

abbe_light_walk_room *abbe_light_walk_get_room(abbe_light_walk *walk) {
  return &walk->room;
}

uint64_t abbe_light_walk_rays(const abbe_light_walk *walk) {
  return walk->rays;
}

uint64_t abbe_light_walk_lamp_rays(const abbe_light_walk *walk) {
  return walk->lamp_rays.traced;
}

void abbe_light_walk_split(abbe_light_walk *walk, unsigned interfaces) {
  walk->splits = interfaces & ((1u << ABBE_PHOTON_SPLITS) - 1);
}

void abbe_light_walk_for_map(abbe_light_walk *walk, bool map) {
  walk->for_map = map;
}

void abbe_light_walk_watch(abbe_light_walk *walk, abbe_light_walk_stretch take, void *user) {
  walk->take = take;
  walk->watcher = user;
}

void abbe_light_walk_keep(abbe_light_walk *walk, size_t packets) {
  abbe_ray_record_free(&walk->record);
  abbe_ray_record_make(packets, &walk->record);
}

bool abbe_light_walk_replay(abbe_light_walk *w, double *seconds, uint64_t *rays) {
  return abbe_ray_record_replay(&w->record, w->g->embree, seconds, rays);
}
