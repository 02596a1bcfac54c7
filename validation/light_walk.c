#include "validation/light_walk.h"

#include "validation/interface.h"
#include "validation/random.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LANES = 16, PACKETS = ABBE_LIGHT_WALK_BATCH / LANES, MAX_STEPS = 10000 };

typedef struct path {
  abbe_media_set inside;
  uint32_t id, step;
  float within;
  float flux, full; /* W, and W at the start */
  float carried;    /* matched: share of the light that a splitting path would carry */
  uint16_t steps, walls;
} path;

typedef struct front {
  size_t count;
  struct RTCRayHit16 ray[PACKETS];
  path state[ABBE_LIGHT_WALK_BATCH];
} front;

struct abbe_light_walk {
  const abbe_geometry *g;
  const abbe_media *media;
  abbe_physics physics;
  uint32_t seed;
  uint64_t rays;
  front *now, *next;
  struct RTCRayHit16 *kept;
  size_t kept_count, kept_room;
};

abbe_result abbe_light_walk_make(const abbe_geometry *geometry, const abbe_media *media,
                                 const abbe_physics *physics, uint32_t seed, abbe_light_walk **out,
                                 abbe_error *error) {
  *out = NULL;
  abbe_light_walk *w = calloc(1, sizeof *w);
  if (w != NULL) {
    *w = (abbe_light_walk){.g = geometry, .media = media, .physics = *physics, .seed = seed};
    w->now = aligned_alloc(64, (sizeof *w->now + 63) / 64 * 64);
    w->next = aligned_alloc(64, (sizeof *w->next + 63) / 64 * 64);
  }
  if (w == NULL || w->now == NULL || w->next == NULL) {
    abbe_light_walk_free(w);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a batch of photons");
  }
  memset(w->now, 0, sizeof *w->now);
  memset(w->next, 0, sizeof *w->next);
  *out = w;
  return ABBE_OK;
}

void abbe_light_walk_free(abbe_light_walk *walk) {
  if (walk == NULL) return;
  free(walk->now);
  free(walk->next);
  free(walk->kept);
  free(walk);
}

uint64_t abbe_light_walk_rays(const abbe_light_walk *walk) {
  return walk->rays;
}

/* ---- rays in packets ---- */

static void put_ray(front *f, size_t i, const float o[3], const float d[3], unsigned mask) {
  struct RTCRayHit16 *p = &f->ray[i / LANES];
  size_t k = i % LANES;
  p->ray.org_x[k] = o[0];
  p->ray.org_y[k] = o[1];
  p->ray.org_z[k] = o[2];
  p->ray.dir_x[k] = d[0];
  p->ray.dir_y[k] = d[1];
  p->ray.dir_z[k] = d[2];
  p->ray.tnear[k] = 0;
  p->ray.tfar[k] = INFINITY;
  p->ray.mask[k] = mask;
  p->ray.flags[k] = 0;
  p->hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
  p->hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
}

static void lane_validity(size_t lanes, int valid[LANES]) {
  for (size_t k = 0; k < LANES; k++) valid[k] = k < lanes ? -1 : 0;
}

static void keep(abbe_light_walk *w, const struct RTCRayHit16 *packet, size_t lanes) {
  if (w->kept_count == w->kept_room) return;
  struct RTCRayHit16 *to = &w->kept[w->kept_count++];
  *to = *packet;
  for (size_t k = 0; k < LANES; k++) to->ray.flags[k] = k < lanes;
}

static void intersect(abbe_light_walk *w, front *f) {
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  _Alignas(64) int valid[LANES];
  for (size_t first = 0; first < f->count; first += LANES) {
    size_t lanes = f->count - first < LANES ? f->count - first : LANES;
    lane_validity(lanes, valid);
    if (w->kept != NULL) keep(w, &f->ray[first / LANES], lanes);
    rtcIntersect16(valid, w->g->embree, &context, &f->ray[first / LANES]);
  }
  w->rays += f->count;
}

void abbe_light_walk_keep(abbe_light_walk *walk, size_t packets) {
  free(walk->kept);
  walk->kept = aligned_alloc(64, packets * sizeof *walk->kept);
  walk->kept_room = walk->kept != NULL ? packets : 0;
  walk->kept_count = 0;
}

bool abbe_light_walk_replay(abbe_light_walk *w, double *seconds, uint64_t *rays) {
  if (w->kept_count == 0) return false;
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  struct timespec from, to;
  *rays = 0;
  clock_gettime(CLOCK_MONOTONIC, &from);
  for (size_t i = 0; i < w->kept_count; i++) {
    _Alignas(64) int valid[LANES];
    for (size_t k = 0; k < LANES; k++) {
      valid[k] = w->kept[i].ray.flags[k] ? -1 : 0;
      *rays += w->kept[i].ray.flags[k];
      w->kept[i].ray.flags[k] = 0;
    }
    rtcIntersect16(valid, w->g->embree, &context, &w->kept[i]);
  }
  clock_gettime(CLOCK_MONOTONIC, &to);
  *seconds = (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
  w->kept_count = 0;
  return true;
}

/* ---- one step of one path ---- */

typedef enum verdict { GOES_ON, LANDS, ESCAPES, DROPS, LOSES, NOT_COUNTED } verdict;

typedef struct lane {
  float o[3], d[3], t;
  abbe_hit hit;
} lane;

static bool get_lane(const abbe_light_walk *w, const front *f, size_t i, lane *l) {
  const struct RTCRayHit16 *p = &f->ray[i / LANES];
  size_t k = i % LANES;
  unsigned id = p->hit.geomID[k];
  if (id == RTC_INVALID_GEOMETRY_ID) return false;
  l->o[0] = p->ray.org_x[k];
  l->o[1] = p->ray.org_y[k];
  l->o[2] = p->ray.org_z[k];
  l->d[0] = p->ray.dir_x[k];
  l->d[1] = p->ray.dir_y[k];
  l->d[2] = p->ray.dir_z[k];
  l->t = p->ray.tfar[k];
  abbe_geometry_place(&w->g->surface[id], p->hit.primID[k], p->hit.u[k], p->hit.v[k], l->o, l->d,
                      l->t, &l->hit);
  return true;
}

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Absorption on the way, and the roulette that ends paths with little left. */
static bool absorb(const abbe_light_walk *w, path *s, float length, float random,
                   abbe_light_ledger *ledger) {
  int medium = abbe_media_of(s->inside);
  if (w->media->attenuation == NULL || medium < 0) return true;
  float left = expf(-length * abbe_media_attenuation(w->media, medium, s->step, s->within));
  ledger->absorbed += (double)(s->flux * (1 - left));
  s->flux *= left;
  s->carried *= left;
  const float least = 0.05f;
  if (s->flux >= least * s->full) return true;
  float chance = s->flux / (least * s->full);
  /* what the roulette takes from some it gives to others: the mean stays */
  float before = s->flux;
  s->flux = random < chance ? least * s->full : 0;
  ledger->absorbed += (double)(before - s->flux);
  return s->flux > 0;
}

/* Matched physics: what the renderer's walk would still follow. */
static verdict matched_rules(const abbe_light_walk *w, path *s, bool entering, bool reflects,
                             float share) {
  if (!w->physics.matched) return GOES_ON;
  if (s->walls == 0 && entering) {
    s->carried = 1 - share;
    return reflects ? DROPS : GOES_ON;
  }
  s->walls++;
  if (!reflects) return GOES_ON;
  s->carried *= share;
  return s->walls >= w->physics.orders || (double)s->carried < w->physics.energy_share ? DROPS
                                                                                       : GOES_ON;
}

/* At a refractor: the new direction in l->d, the place to start from in l->o. */
static verdict refractor_step(const abbe_light_walk *w, lane *l, path *s, float random) {
  float along = dot(l->d, l->hit.ng), shaded = dot(l->d, l->hit.n);
  bool entering = along < 0;
  const float *outside = (shaded < 0) == entering ? l->hit.n : l->hit.ng;
  float n[3], d[3], cos_t, cos_i = fminf(fabsf(outside == l->hit.n ? shaded : along), 1);
  for (int k = 0; k < 3; k++) n[k] = entering ? outside[k] : -outside[k];
  abbe_media_set before, after;
  abbe_media_cross(s->inside, l->hit.surface->index, entering, &before, &after);
  bool foreign = w->physics.matched && s->inside != 0 &&
                 abbe_media_of(s->inside) != (int)l->hit.surface->index;
  int from = abbe_media_of(before), to = abbe_media_of(after);
  if (foreign || from == to) {
    if (!foreign) s->inside = after;
    abbe_geometry_leave(&l->hit, l->d, l->o);
    return GOES_ON;
  }
  float eta = abbe_media_n(w->media, from, s->step, s->within) /
              abbe_media_n(w->media, to, s->step, s->within);
  float share = abbe_interface_reflectance(cos_i, eta, &cos_t);
  bool reflects = random < share;
  if (reflects)
    abbe_interface_reflect(l->d, n, cos_i, d);
  else
    abbe_interface_refract(l->d, n, eta, cos_i, cos_t, d);
  abbe_interface_keep_side(l->hit.ng, entering == reflects ? 1 : -1, d);
  verdict v = matched_rules(w, s, entering, reflects, share);
  s->inside = reflects ? before : after;
  memcpy(l->d, d, sizeof d);
  abbe_geometry_leave(&l->hit, d, l->o);
  return v;
}

static verdict step(const abbe_light_walk *w, bool met, lane *l, path *s, uint32_t pass,
                    abbe_light_ledger *ledger) {
  bool first = s->steps == 0;
  if (!met) return first ? NOT_COUNTED : s->inside != 0 ? LOSES : ESCAPES;
  if (l->hit.surface->kind != ABBE_GEOMETRY_REFRACTORS) {
    if (first) return NOT_COUNTED;
    if (s->inside != 0) ledger->contact += (double)s->flux;
    return LANDS;
  }
  if (first) ledger->reached += (double)s->flux;
  float random[4];
  abbe_random4(s->id, s->steps, pass, w->seed, random);
  if (!absorb(w, s, l->t, random[1], ledger)) return NOT_COUNTED;
  if (++s->steps >= MAX_STEPS) return LOSES;
  return refractor_step(w, l, s, random[0]);
}

/* ---- the batch ---- */

/* Matched: the renderer counts light only where the lamp would see the receiver past others. */
static bool lamp_sees(const abbe_light_walk *w, const abbe_light *light, const lane *l) {
  if (!w->physics.matched) return true;
  float from[3], d[3], o[3], limit = INFINITY;
  for (int k = 0; k < 3; k++) d[k] = -(float)light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_geometry_to_frame(w->g, light->position, from);
    for (int k = 0; k < 3; k++) d[k] = from[k] - l->hit.p[k];
    limit = sqrtf(dot(d, d));
    for (int k = 0; k < 3; k++) d[k] /= limit;
  }
  abbe_geometry_leave(&l->hit, d, o);
  return !abbe_geometry_occluded(w->g, ABBE_GEOMETRY_RECEIVERS, o, d, limit);
}

/* Matched: inside a refractor only its walls count, and what has left it meets none. */
static unsigned next_mask(const abbe_light_walk *w, const path *s) {
  if (!w->physics.matched) return ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS;
  return s->inside != 0 ? ABBE_GEOMETRY_REFRACTORS : ABBE_GEOMETRY_RECEIVERS;
}

static void land(const lane *l, const path *s, abbe_landing *out) {
  *out = (abbe_landing){.surface = l->hit.surface->object,
                        .face = l->hit.face,
                        .u = l->hit.u,
                        .v = l->hit.v,
                        .side = dot(l->d, l->hit.ng) < 0 ? 1 : -1,
                        .flux = s->flux,
                        .step = s->step};
  memcpy(out->p, l->hit.p, sizeof out->p);
}

static void begin(front *f, const abbe_photon *photon, size_t count) {
  f->count = 0;
  for (size_t i = 0; i < count; i++) {
    const abbe_photon *p = &photon[i];
    if (!(p->flux > 0)) continue;
    put_ray(f, f->count, p->o, p->d, ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS);
    f->state[f->count++] = (path){.id = p->id,
                                  .step = p->step,
                                  .within = p->within,
                                  .flux = p->flux,
                                  .full = p->flux,
                                  .carried = 1};
  }
}

size_t abbe_light_walk_run(abbe_light_walk *w, const abbe_light *light, uint32_t pass,
                           const abbe_photon *photon, size_t count, abbe_landing *landing,
                           abbe_light_ledger *ledger) {
  size_t landed = 0;
  begin(w->now, photon, count);
  while (w->now->count > 0) {
    front *f = w->now, *next = w->next;
    intersect(w, f);
    next->count = 0;
    for (size_t i = 0; i < f->count; i++) {
      lane l;
      path *s = &f->state[i];
      bool met = get_lane(w, f, i, &l);
      verdict v = step(w, met, &l, s, pass, ledger);
      if (v == LANDS && !lamp_sees(w, light, &l)) v = DROPS;
      if (v == GOES_ON) {
        put_ray(next, next->count, l.o, l.d, next_mask(w, s));
        next->state[next->count++] = *s;
      } else if (v == LANDS) {
        land(&l, s, &landing[landed++]);
        ledger->landed += (double)s->flux;
      } else if (v == ESCAPES) {
        ledger->escaped += (double)s->flux;
      } else if (v == DROPS) {
        ledger->dropped += (double)s->flux;
      } else if (v == LOSES) {
        ledger->lost += (double)s->flux;
      }
    }
    w->now = next;
    w->next = f;
  }
  return landed;
}
