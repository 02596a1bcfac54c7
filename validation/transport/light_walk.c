#include "validation/transport/light_walk.h"

#include "validation/transport/interface.h"
#include "validation/transport/random.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Compiled for several processors, and chosen when the program starts; sanitizers do not bear it.
 */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(NDEBUG)
#define SIDE_BY_SIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SIDE_BY_SIDE
#endif

enum {
  LANES = 16,
  PACKETS = ABBE_LIGHT_WALK_LANDINGS / LANES,
  MAX_STEPS = 10000,
  EVEN_STEPS = 3,     /* whose decisions are spread evenly */
  SMALL_SCENE = 4096, /* faces */
  FEW_FACES = 256,    /* of receivers, held against each other */
  COHERENT_ROUNDS = 2 /* how often rays of a packet are bent before they are told apart */
};

typedef struct path {
  abbe_media_set inside;
  uint32_t id, step;
  float within;
  float flux, full; /* W, and W at the start */
  float y;          /* Y of a watt, for the ledger */
  float carried;    /* matched: share of the light that a splitting path would carry */
  float way[ABBE_LIGHT_WALK_SPLITS];
  uint16_t steps, walls;
  bool begun; /* has met its first interface */
} path;

typedef struct front {
  size_t count;
  struct RTCRayHit16 ray[PACKETS];
  path state[ABBE_LIGHT_WALK_LANDINGS];
} front;

/* Landings that wait for their ray to the lamp. */
typedef struct shadows {
  struct RTCRay16 ray;
  size_t count;
  abbe_landing *landing[LANES];
  double flux[LANES]; /* W, for the ledger */
} shadows;

struct abbe_light_walk {
  shadows shadows;
  const abbe_geometry *g;
  const abbe_media *media;
  abbe_physics physics;
  uint32_t seed;
  uint64_t rays;
  front *now, *next;
  uint32_t shift[4]; /* of the pass's even decisions */
  unsigned parts;    /* interfaces at which photons go both ways, a bit each */
  bool small;        /* so few faces that packets stay together wherever their rays go */
  bool *hides;       /* [lights] some receiver may hide a place on another from the lamp */
  struct RTCRayHit16 *kept;
  size_t kept_count, kept_room;
  abbe_light_walk_room room;
};

/* ---- what receivers may hide ---- */

static float above(const float n[3], const float a[3], const float p[3]) {
  return n[0] * (p[0] - a[0]) + n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2]);
}

/* Whether a corner of a receiver lies on the other side of a face's plane than the lamp. */
static bool stands_before(const abbe_geometry *g, const abbe_light *light, const float corner[3],
                          const float n[3]) {
  float lamp[3], toward = 0;
  for (int k = 0; k < 3; k++) toward -= n[k] * (float)light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_geometry_to_frame(g, light->position, lamp);
    toward = above(n, corner, lamp);
  }
  for (size_t i = 0; i < g->surface_count; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_RECEIVERS) continue;
    size_t count = s->sphere ? 0 : g->scene->object[s->object].mesh.vertex_count;
    for (size_t v = 0; v < count; v++) {
      float behind = above(n, corner, s->position[v]), size = 0;
      for (int k = 0; k < 3; k++)
        size = fmaxf(size, fmaxf(fabsf(s->position[v][k]), fabsf(corner[k])));
      if (toward > 0 ? behind < -1e-5f * size : behind > 1e-5f * size) return true;
    }
  }
  return false;
}

/* Receivers that are the walls of a convex room around the lamp hide nothing. */
static bool receivers_hide(const abbe_geometry *g, const abbe_light *light) {
  size_t faces = 0;
  for (size_t i = 0; i < g->surface_count; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_RECEIVERS) continue;
    faces += g->scene->object[s->object].mesh.face_count;
    if (s->sphere || faces > FEW_FACES) return true;
  }
  for (size_t i = 0; i < g->surface_count; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_RECEIVERS) continue;
    for (size_t f = 0; f < g->scene->object[s->object].mesh.face_count; f++) {
      const float *a = s->position[s->face[f][0]], *b = s->position[s->face[f][1]],
                  *c = s->position[s->face[f][2]];
      float e[3], h[3];
      for (int k = 0; k < 3; k++) {
        e[k] = b[k] - a[k];
        h[k] = c[k] - a[k];
      }
      float n[3] = {e[1] * h[2] - e[2] * h[1], e[2] * h[0] - e[0] * h[2],
                    e[0] * h[1] - e[1] * h[0]};
      float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      if (!(length > 0)) return true;
      for (int k = 0; k < 3; k++) n[k] /= length;
      if (stands_before(g, light, a, n)) return true;
    }
  }
  return false;
}

abbe_result abbe_light_walk_make(const abbe_geometry *geometry, const abbe_media *media,
                                 const abbe_physics *physics, uint32_t seed, abbe_light_walk **out,
                                 abbe_error *error) {
  ABBE_REQUIRE(geometry && geometry->scene && media && physics && out, error);
  *out = NULL;
  abbe_light_walk *w = aligned_alloc(64, (sizeof *w + 63) / 64 * 64);
  size_t lights = geometry->scene->light_count;
  if (w != NULL) {
    memset(w, 0, sizeof *w);
    w->g = geometry;
    w->media = media;
    w->physics = *physics;
    w->seed = seed;
    w->now = aligned_alloc(64, (sizeof *w->now + 63) / 64 * 64);
    w->next = aligned_alloc(64, (sizeof *w->next + 63) / 64 * 64);
    w->hides = calloc(lights + 1, sizeof *w->hides);
  }
  if (w == NULL || w->now == NULL || w->next == NULL || w->hides == NULL) {
    abbe_light_walk_free(w);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a batch of photons");
  }
  size_t faces = 0;
  for (size_t i = 0; i < geometry->scene->object_count; i++)
    faces += geometry->scene->object[i].mesh.face_count;
  w->small = faces < SMALL_SCENE;
  for (size_t i = 0; i < lights; i++)
    w->hides[i] = receivers_hide(geometry, &geometry->scene->light[i]);
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
  free(walk->hides);
  free(walk);
}

abbe_light_walk_room *abbe_light_walk_get_room(abbe_light_walk *walk) {
  return &walk->room;
}

uint64_t abbe_light_walk_rays(const abbe_light_walk *walk) {
  return walk->rays;
}

void abbe_light_walk_part(abbe_light_walk *walk, unsigned interfaces) {
  walk->parts = interfaces & ((1u << ABBE_LIGHT_WALK_SPLITS) - 1);
}

unsigned abbe_light_walk_best_parts(const abbe_landing *landing, size_t count) {
  unsigned best = 0;
  double least = INFINITY;
  for (unsigned parts = 0; parts < 1u << ABBE_LIGHT_WALK_SPLITS; parts++) {
    double squares = 0, rays = 1;
    for (int k = 0; k < ABBE_LIGHT_WALK_SPLITS; k++) rays *= parts >> k & 1 ? 2 : 1;
    for (size_t i = 0; i < count; i++) {
      double weight = 1;
      for (int k = 0; k < ABBE_LIGHT_WALK_SPLITS; k++)
        weight *= parts >> k & 1 ? (double)landing[i].way[k] : 1;
      squares += weight * (double)landing[i].flux * (double)landing[i].flux;
    }
    if (squares * rays < least) {
      least = squares * rays;
      best = parts;
    }
  }
  return best;
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

/* Kept packets say in a lane's flags whether it holds a ray, and how packets were traced. */
enum { KEPT = 1, KEPT_COHERENT = 2 };

static void keep(abbe_light_walk *w, const struct RTCRayHit16 *packet, size_t lanes,
                 bool coherent) {
  if (w->kept_count == w->kept_room) return;
  struct RTCRayHit16 *to = &w->kept[w->kept_count++];
  *to = *packet;
  for (size_t k = 0; k < LANES; k++)
    to->ray.flags[k] = k < lanes ? KEPT | (coherent ? KEPT_COHERENT : 0) : 0;
}

static void trace_packet(const abbe_light_walk *w, struct RTCRayHit16 *packet, size_t lanes,
                         bool coherent) {
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  _Alignas(64) int valid[LANES];
  for (size_t k = 0; k < LANES; k++) valid[k] = k < lanes ? -1 : 0;
  rtcIntersect16(valid, w->g->embree, &context, packet);
}

static void intersect(abbe_light_walk *w, front *f, size_t round) {
  bool coherent = w->small || round < COHERENT_ROUNDS;
  for (size_t first = 0; first < f->count; first += LANES) {
    size_t lanes = f->count - first < LANES ? f->count - first : LANES;
    if (w->kept != NULL) keep(w, &f->ray[first / LANES], lanes, coherent);
    trace_packet(w, &f->ray[first / LANES], lanes, coherent);
  }
  w->rays += f->count;
}

void abbe_light_walk_keep(abbe_light_walk *walk, size_t packets) {
  free(walk->kept);
  walk->kept = packets > 0 ? aligned_alloc(64, packets * sizeof *walk->kept) : NULL;
  walk->kept_room = walk->kept != NULL ? packets : 0;
  walk->kept_count = 0;
}

bool abbe_light_walk_replay(abbe_light_walk *w, double *seconds, uint64_t *rays) {
  if (w->kept_count == 0) return false;
  struct timespec from, to;
  *rays = 0;
  clock_gettime(CLOCK_MONOTONIC, &from);
  for (size_t i = 0; i < w->kept_count; i++) {
    struct RTCRayHit16 *packet = &w->kept[i];
    bool coherent = (packet->ray.flags[0] & KEPT_COHERENT) != 0;
    size_t lanes = 0;
    for (size_t k = 0; k < LANES; k++) {
      lanes += packet->ray.flags[k] & KEPT;
      packet->ray.flags[k] = 0;
    }
    trace_packet(w, packet, lanes, coherent);
    *rays += lanes;
  }
  clock_gettime(CLOCK_MONOTONIC, &to);
  *seconds = (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
  w->kept_count = 0;
  return true;
}

/* ---- one step of sixteen paths ---- */

typedef enum verdict { GOES_ON, LANDS, ESCAPES, DROPS, LOSES, NOT_COUNTED } verdict;

/* A packet's lanes. What is arithmetic stands in arrays, for the compiler to do side by side. */
typedef struct lanes {
  _Alignas(64) float d[3][LANES];
  float p[3][LANES], n[3][LANES], ng[3][LANES]; /* normals on the side that the path comes from */
  float eta[LANES];                             /* 1: passes straight on */
  float chance[LANES];                          /* in [0, 1): decides between ways */
  float share[LANES], out[3][LANES], from[3][LANES];
  int reflects[LANES];
  float size[LANES]; /* of the coordinates, for the offset */
  abbe_media_set before[LANES], after[LANES];
  bool straight[LANES];
  verdict verdict[LANES];
  abbe_hit hit[LANES];
} lanes;

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The number that decides at a path's next interface. Neighbouring photons have neighbouring
 * numbers, so the first decisions are spread evenly over them: the fractional parts of multiples
 * of generalised golden ratios, shifted at random in every pass [Roberts2018]. */
static float chance(const abbe_light_walk *w, const path *s, uint32_t pass) {
  static const uint32_t ratio[EVEN_STEPS] = {3242174889u, 2447445414u, 3679390609u};
  if (s->steps < EVEN_STEPS) return abbe_random_float(s->id * ratio[s->steps] + w->shift[s->steps]);
  float random[4];
  abbe_random4(s->id, s->steps, pass, w->seed, random);
  return random[0];
}

/* Absorption on the way, and the roulette that ends paths with little left. */
static bool absorb(const abbe_light_walk *w, path *s, float length, uint32_t pass,
                   abbe_light_ledger *ledger) {
  if (w->media->attenuation == NULL) return true;
  int medium = abbe_media_of(s->inside);
  float left = expf(-length * abbe_media_attenuation(w->media, medium, s->step, s->within));
  ledger->absorbed += (double)(s->y * s->flux * (1 - left));
  s->flux *= left;
  s->carried *= left;
  const float least = 0.05f;
  if (s->flux >= least * s->full) return true;
  float chance = s->flux / (least * s->full), random[4];
  abbe_random4(s->id, s->steps, pass, ~w->seed, random);
  /* what the roulette takes from some it gives to others: the mean stays */
  float before = s->flux;
  s->flux = random[0] < chance ? least * s->full : 0;
  ledger->absorbed += (double)(s->y * (before - s->flux));
  return s->flux > 0;
}

/* Matched physics: what the renderer's walk would still follow. */
static verdict matched_rules(const abbe_light_walk *w, path *s, bool reflects, float share) {
  if (!w->physics.matched) return GOES_ON;
  s->carried *= reflects ? share : 1 - share;
  if (s->begun) s->walls++;
  if (!s->begun || !reflects) {
    s->begun = true;
    return GOES_ON;
  }
  bool goes_on = s->walls < w->physics.orders && (double)s->carried >= w->physics.energy_share;
  return goes_on ? GOES_ON : DROPS;
}

/* What a path meets at a refractor: normals, indices, media. */
static void meet(const abbe_light_walk *w, const path *s, const float d[3], lanes *l, size_t k) {
  const abbe_hit *hit = &l->hit[k];
  float along = dot(d, hit->ng), shaded = dot(d, hit->n);
  bool entering = along < 0;
  float side = entering ? 1 : -1;
  const float *outside = (shaded < 0) == entering ? hit->n : hit->ng;
  for (int i = 0; i < 3; i++) {
    l->n[i][k] = side * outside[i];
    l->ng[i][k] = side * hit->ng[i];
  }
  abbe_media_cross(s->inside, hit->surface->index, entering, &l->before[k], &l->after[k]);
  int from = abbe_media_of(l->before[k]), to = abbe_media_of(l->after[k]);
  l->straight[k] = abbe_media_same(w->media, from, to);
  l->eta[k] = l->straight[k] ? 1
                             : abbe_media_n(w->media, from, s->step, s->within) /
                                   abbe_media_n(w->media, to, s->step, s->within);
}

/* Lane k of a packet that Embree has been through: where it is, and what becomes of it if that is
 * no interface. */
static void gather(abbe_light_walk *w, const struct RTCRayHit16 *packet, size_t k, path *s,
                   uint32_t pass, lanes *l, abbe_light_ledger *ledger) {
  bool first = s->steps == 0;
  unsigned id = packet->hit.geomID[k];
  float o[3] = {packet->ray.org_x[k], packet->ray.org_y[k], packet->ray.org_z[k]};
  float d[3] = {packet->ray.dir_x[k], packet->ray.dir_y[k], packet->ray.dir_z[k]};
  for (int i = 0; i < 3; i++) l->d[i][k] = d[i];
  if (id == RTC_INVALID_GEOMETRY_ID) {
    l->verdict[k] = first ? NOT_COUNTED : s->inside != 0 ? LOSES : ESCAPES;
    return;
  }
  abbe_hit *hit = &l->hit[k];
  abbe_geometry_place(&w->g->surface[id], packet->hit.primID[k], packet->hit.u[k], packet->hit.v[k],
                      o, d, packet->ray.tfar[k], hit);
  if (hit->surface->kind != ABBE_GEOMETRY_REFRACTORS) {
    l->verdict[k] = first ? NOT_COUNTED : LANDS;
    if (!first && s->inside != 0) ledger->contact += (double)(s->y * s->flux);
    return;
  }
  if (first) ledger->reached += (double)(s->y * s->flux);
  l->verdict[k] = GOES_ON;
  if (s->inside != 0 && !absorb(w, s, packet->ray.tfar[k], pass, ledger))
    l->verdict[k] = NOT_COUNTED;
  l->chance[k] = chance(w, s, pass);
  if (++s->steps >= MAX_STEPS) l->verdict[k] = LOSES;
  for (int i = 0; i < 3; i++) l->p[i][k] = hit->p[i];
  l->size[k] = hit->surface->sphere ? hit->surface->radius : 0;
  meet(w, s, d, l, k);
}

/* Snell, Fresnel, the choice, and the place from which the path goes on, for all lanes. */
SIDE_BY_SIDE static void bend(lanes *l) {
  for (size_t k = 0; k < LANES; k++) {
    float eta = l->eta[k],
          c = -(l->d[0][k] * l->n[0][k] + l->d[1][k] * l->n[1][k] + l->d[2][k] * l->n[2][k]);
    c = c < 1 ? c : 1;
    float cos_t, share = abbe_interface_reflectance(c, eta, &cos_t);
    bool reflects = l->chance[k] < share;
    float turn = reflects ? 2 * c : eta * c - cos_t, stretch = reflects ? 1 : eta;
    float out[3];
    for (int i = 0; i < 3; i++) out[i] = stretch * l->d[i][k] + turn * l->n[i][k];
    /* light stays on the right side of the face where its normal is bent */
    float side = reflects ? 1.0f : -1.0f;
    float scale = 1 / sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3; i++) out[i] *= scale;
    float along = side * (out[0] * l->ng[0][k] + out[1] * l->ng[1][k] + out[2] * l->ng[2][k]);
    float push = along > 0 ? 0 : side * (1e-3f - along);
    for (int i = 0; i < 3; i++) out[i] += push * l->ng[i][k];
    scale = along > 0 ? 1 : 1 / sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    float a = fabsf(l->p[0][k]), b = fabsf(l->p[1][k]), e = fabsf(l->p[2][k]), size = l->size[k];
    size = size > a ? size : a;
    size = size > b ? size : b;
    size = size > e ? size : e;
    float offset = side * size * ABBE_GEOMETRY_OFFSET;
    for (int i = 0; i < 3; i++) {
      l->out[i][k] = out[i] * scale;
      l->from[i][k] = l->p[i][k] + offset * l->ng[i][k];
    }
    l->share[k] = share;
    l->reflects[k] = reflects;
  }
}

/* ---- the batch ---- */

/* The map of a light holds only what lands where the lamp would see the receiver past others: the
 * rays that wait are traced, and their landings marked. */
static void ask_lamp(abbe_light_walk *w, abbe_light_ledger *ledger) {
  shadows *s = &w->shadows;
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  _Alignas(64) int valid[LANES];
  for (size_t k = 0; k < LANES; k++) valid[k] = k < s->count ? -1 : 0;
  if (s->count > 0) rtcOccluded16(valid, w->g->embree, &context, &s->ray);
  for (size_t k = 0; k < s->count; k++) {
    s->landing[k]->hidden = s->ray.tfar[k] < 0;
    if (s->landing[k]->hidden) ledger->hidden += s->flux[k];
  }
  s->count = 0;
}

static void wait_for_lamp(abbe_light_walk *w, const abbe_light *light, const abbe_hit *hit,
                          abbe_landing *landing, double flux, abbe_light_ledger *ledger) {
  shadows *s = &w->shadows;
  size_t at = s->count++;
  float from[3], d[3], o[3], limit = INFINITY;
  for (int k = 0; k < 3; k++) d[k] = -(float)light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_geometry_to_frame(w->g, light->position, from);
    for (int k = 0; k < 3; k++) d[k] = from[k] - hit->p[k];
    limit = sqrtf(dot(d, d));
    for (int k = 0; k < 3; k++) d[k] /= limit;
  }
  abbe_geometry_leave(hit, d, o);
  struct RTCRay16 *ray = &s->ray;
  ray->org_x[at] = o[0];
  ray->org_y[at] = o[1];
  ray->org_z[at] = o[2];
  ray->dir_x[at] = d[0];
  ray->dir_y[at] = d[1];
  ray->dir_z[at] = d[2];
  ray->tnear[at] = 0;
  ray->tfar[at] = limit;
  ray->mask[at] = ABBE_GEOMETRY_RECEIVERS;
  ray->flags[at] = 0;
  s->landing[at] = landing;
  s->flux[at] = flux;
  if (s->count == LANES) ask_lamp(w, ledger);
}

/* The path after the interface, into the next front; what matched physics does not follow ends. */
static verdict go_on(const abbe_light_walk *w, const lanes *l, size_t k, path *s, front *next) {
  float o[3], d[3];
  for (int i = 0; i < 3; i++) {
    o[i] = l->from[i][k];
    d[i] = l->straight[k] ? l->d[i][k] : l->out[i][k];
  }
  bool reflects = l->reflects[k] && !l->straight[k];
  if (!l->straight[k] && matched_rules(w, s, reflects, l->share[k]) == DROPS) return DROPS;
  s->inside = reflects ? l->before[k] : l->after[k];
  put_ray(next, next->count, o, d, ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS);
  next->state[next->count++] = *s;
  return GOES_ON;
}

/* Numbers that decide for one way at any share, but for total reflection's. */
static const float MIRRORS = -1, PASSES = 2;

/* What the path carries on the way that was chosen, or on one of both; false for no light. */
static bool take_way(const lanes *l, size_t k, size_t round, bool parts, path *s) {
  const bool reflects = l->reflects[k] && !l->straight[k];
  const float share = l->straight[k] ? 0 : l->share[k], part = reflects ? share : 1 - share;
  if (!parts) {
    if (round < ABBE_LIGHT_WALK_SPLITS) s->way[round] = part;
    return true;
  }
  const bool first = l->chance[k] < 0;
  if (first != reflects) return false; /* nothing is mirrored where it goes straight on */
  s->flux *= part;
  s->full *= part;
  return part > 0;
}

static void land(const lanes *l, size_t k, const path *s, abbe_landing *out) {
  const abbe_hit *hit = &l->hit[k];
  float d[3] = {l->d[0][k], l->d[1][k], l->d[2][k]};
  *out = (abbe_landing){.surface = hit->surface->object,
                        .face = hit->face,
                        .u = hit->u,
                        .v = hit->v,
                        .side = dot(d, hit->ng) < 0 ? 1 : -1,
                        .flux = s->flux,
                        .step = s->step,
                        .way = {s->way[0], s->way[1]}};
  memcpy(out->p, hit->p, sizeof out->p);
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
                                  .y = p->y,
                                  .carried = 1,
                                  .way = {1, 1}};
  }
}

size_t abbe_light_walk_run(abbe_light_walk *w, const abbe_light *light, uint32_t pass,
                           const abbe_photon *photon, size_t count, abbe_landing *landing,
                           abbe_light_ledger *ledger) {
  size_t landed = 0;
  bool hides = w->hides[light - w->g->scene->light];
  lanes l = {0};
  abbe_random_bits(0x73686966, 0, pass, w->seed, w->shift);
  begin(w->now, photon, count);
  for (size_t round = 0; w->now->count > 0; round++) {
    front *f = w->now, *next = w->next;
    intersect(w, f, round);
    next->count = 0;
    for (size_t first = 0; first < f->count; first += LANES) {
      size_t used = f->count - first < LANES ? f->count - first : LANES;
      for (size_t k = 0; k < used; k++)
        gather(w, &f->ray[first / LANES], k, &f->state[first + k], pass, &l, ledger);
      const bool parts = round < ABBE_LIGHT_WALK_SPLITS && (w->parts >> round & 1) != 0;
      for (int turn = parts ? 0 : 1; turn < 2; turn++) {
        if (parts)
          for (size_t k = 0; k < used; k++) l.chance[k] = turn == 0 ? MIRRORS : PASSES;
        bend(&l);
        for (size_t k = 0; k < used; k++) {
          path s = f->state[first + k];
          verdict v = l.verdict[k];
          if (v != GOES_ON && turn == 0) continue;
          if (v == GOES_ON && !take_way(&l, k, round, parts, &s)) continue;
          if (v == GOES_ON) v = go_on(w, &l, k, &s, next);
          double flux = (double)(s.y * s.flux);
          if (v == LANDS) {
            land(&l, k, &s, &landing[landed]);
            ledger->landed += flux;
            if (hides) wait_for_lamp(w, light, &l.hit[k], &landing[landed], flux, ledger);
            landed++;
          } else if (v == ESCAPES) {
            ledger->escaped += flux;
          } else if (v == DROPS) {
            ledger->dropped += flux;
          } else if (v == LOSES) {
            ledger->lost += flux;
          }
        }
      }
    }
    w->now = next;
    w->next = f;
  }
  ask_lamp(w, ledger);
  return landed;
}
