#include "validation/trace/walks/light_walk.h"

#include "validation/trace/transport/interface.h"
#include "validation/trace/walks/light_path.h"
#include "validation/trace/walks/ray_batch.h"
#include "validation/trace/walks/scatter.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  LANES = ABBE_RAY_LANES,
  COHERENT_BOUNCES = 2 /* how often rays of a packet are scattered before they are separated */
};

/* ---- one bounce of sixteen paths ---- */

/* What becomes of a path at what its ray met. */
typedef enum path_state {
  SCATTERS,   /* at an interface */
  DEPOSITED,  /* on a receiver */
  MISSED,     /* met nothing any more */
  MIRRORED,   /* at a mirror */
  TRAPPED,    /* matched: as long as the renderer follows one, and not out yet */
  LOST,       /* inside of nothing, or too long */
  NOT_COUNTED /* never met a refractor, or has no light left */
} path_state;

/* A packet of paths between their rays of this bounce and those of the next. */
typedef struct packet {
  abbe_scatter scatter;
  abbe_mirroring mirroring;
  abbe_media_set before[LANES], after[LANES];
  bool straight[LANES]; /* media of one index: no interface */
  bool crystal[LANES];  /* on either side, or the light is polarised */
  int film[LANES];      /* on the face, or -1 */
  float rough[LANES];   /* how rough it is, by GGX's alpha; 0: smooth */
  float passes[LANES];  /* what it does not absorb */
  uint8_t wave[LANES];  /* that a path goes on as, in a crystal */
  float stokes[LANES][3];
  path_state state[LANES];
  abbe_hit hit[LANES];
} packet;

/* A batch in progress: what the photons of one light have in common. */
typedef struct run {
  abbe_light_walk *w;
  const abbe_light *light;
  abbe_inner_rules rules;
  bool hidden, parallel;
  bool plain; /* no crystal, film, rough face or polarised light anywhere: no lane has any */
  packet packet;
  size_t hits;
  abbe_photon_hit *hit;
  abbe_light_ledger *ledger;
} run;

/* Numbers that decide for one branch at any share, but for total reflection's. */
static const float REFLECT = -1, TRANSMIT = 2;

/* What a face is besides: coated, rough, a crystal's. */
static void meet_dressed(run *r, abbe_light_path *s, size_t k, int from, int to) {
  const abbe_media *m = r->w->media;
  packet *p = &r->packet;
  p->film[k] = abbe_media_film(m, from, to, &p->hit[k]);
  p->rough[k] = abbe_media_roughness(m, from, to, &p->hit[k]);
  p->straight[k] = p->straight[k] && p->film[k] < 0;
  p->crystal[k] =
      !p->straight[k] && (r->rules.physics.polarised || abbe_media_is_crystal(m, from) ||
                          abbe_media_is_crystal(m, to));
  if (p->rough[k] > 0 && !s->frosted) r->ledger->frosted += (double)(s->y * s->flux);
  s->frosted = s->frosted || p->rough[k] > 0;
  if (s->steps == 0) s->shown = s->frosted;
}

/* What a path meets at a refractor: normals, indices, media. */
static void meet_interface(run *r, abbe_light_path *s, size_t k) {
  const abbe_light_walk *w = r->w;
  packet *p = &r->packet;
  const abbe_hit *hit = &p->hit[k];
  const float d[3] = {p->scatter.d[0][k], p->scatter.d[1][k], p->scatter.d[2][k]};
  const bool entering = abbe_scatter_meet(&p->scatter, k, hit, d);
  abbe_media_cross(s->inside, hit->surface->index, entering, &p->before[k], &p->after[k]);
  int from = abbe_media_of(p->before[k]), to = abbe_media_of(p->after[k]);
  p->straight[k] = abbe_media_same(w->media, from, to);
  if (!r->plain) meet_dressed(r, s, k, from, to);
  p->scatter.eta[k] = p->straight[k] ? 1
                                     : abbe_media_n(w->media, from, s->step, s->within) /
                                           abbe_media_n(w->media, to, s->step, s->within);
}

/* Whether haze turns the path before that; it goes on from there then. */
static bool turns(run *r, const struct RTCRayHit16 *rays, size_t k, abbe_light_path *s) {
  ray_batch *next = r->w->next;
  float o[3], d[3];
  const size_t light =
      r->light != NULL ? (size_t)(r->light - r->w->g->scene->light) : r->w->g->scene->light_count;
  if (!abbe_light_path_turn(&r->rules, r->w->media, light, s, rays, k, o, d, r->ledger))
    return false;
  if (!(s->flux > 0) || !abbe_light_path_survives(&r->rules, s, r->ledger)) return true;
  if (s->steps >= ABBE_INNER_MAX_STEPS) {
    r->ledger->lost += (double)(s->y * s->flux);
    return true;
  }
  abbe_ray_put(next->ray, next->count, o, d);
  next->path[next->count++] = *s;
  return true;
}

/* Lane k of a packet of rays that Embree has been through: where the path is, and what becomes of
 * it there. */
static path_state read_hit(run *r, const struct RTCRayHit16 *rays, size_t k, abbe_light_path *s) {
  packet *p = &r->packet;
  const bool first = s->steps == 0;
  const unsigned id = rays->hit.geomID[k];
  if (r->w->take != NULL && !first) {
    const abbe_light_stretch stretch = abbe_light_path_stretch(s, rays, k);
    r->w->take(r->w->watcher, &stretch);
  }
  if (id == RTC_INVALID_GEOMETRY_ID && (first || s->inside != 0)) return first ? NOT_COUNTED : LOST;
  if (abbe_haze_is(&r->w->media->haze) && turns(r, rays, k, s)) return NOT_COUNTED;
  const bool left = first || abbe_light_path_absorb(&r->rules, r->w->media, s, rays, k, r->ledger);
  if (id == RTC_INVALID_GEOMETRY_ID) return left ? MISSED : NOT_COUNTED;
  const abbe_surface *surface = &r->w->g->surface[id];
  if (first && surface->kind == ABBE_GEOMETRY_RECEIVERS) return NOT_COUNTED;
  if (surface->kind == ABBE_GEOMETRY_LAMPS) {
    if (!first && left) r->ledger->absorbed += (double)(s->y * s->flux);
    return NOT_COUNTED;
  }
  abbe_ray_place(rays, k, surface, &p->hit[k]);
  if (surface->kind == ABBE_GEOMETRY_RECEIVERS) {
    if (s->inside != 0) r->ledger->contact += (double)(s->y * s->flux);
    return left ? DEPOSITED : NOT_COUNTED;
  }
  if (first) abbe_light_path_begin(&r->w->media->haze, s, r->parallel, rays, k);
  if (first) r->ledger->reached += (double)(s->y * s->flux);
  if (surface->kind == ABBE_GEOMETRY_MIRRORS) {
    if (!left) return NOT_COUNTED;
    abbe_scatter_meet_mirror(&p->scatter, &p->mirroring, k, &p->hit[k], r->w->mirrors, s->step,
                             s->within);
    return MIRRORED;
  }
  p->scatter.chance[k] = abbe_light_path_chance(&r->rules, s);
  meet_interface(r, s, k);
  return ++s->steps >= ABBE_INNER_MAX_STEPS ? LOST : left ? SCATTERS : NOT_COUNTED;
}

/* Whether lane k's path splits at its interface. */
static bool is_split(const abbe_light_walk *w, const packet *p, size_t k,
                     const abbe_light_path *s) {
  return s->steps <= ABBE_PHOTON_SPLITS && (w->splits >> (s->steps - 1u) & 1) != 0 &&
         !(p->rough[k] > 0);
}

/* What the path carries on the branch that was chosen, or on one of both; false for no light. */
static bool take_branch(const packet *p, size_t k, bool split, abbe_light_path *s) {
  const size_t interface = s->steps - 1u;
  if (!split && interface >= ABBE_PHOTON_SPLITS) return true;
  const bool reflects = p->scatter.reflects[k] && !p->straight[k];
  const float share = p->straight[k] ? 0 : p->scatter.share[k];
  const float part = p->rough[k] > 0 ? 1 : reflects ? share : 1 - share;
  if (!split) {
    s->chance[interface] = part;
    return true;
  }
  const bool reflecting = p->scatter.chance[k] < 0;
  if (reflecting != reflects) return false; /* nothing is mirrored where it goes straight on */
  s->flux *= part;
  s->full *= part;
  return part > 0;
}

static void leave_solid(run *r);

/* Whether the path goes on through a solid and needs nothing of Embree. */
static bool stays_in_solid(const abbe_light_walk *w, const abbe_light_path *s) {
  if (s->inside == 0) return false;
  if (s->steps < ABBE_PHOTON_SPLITS && w->splits >> s->steps != 0) return false; /* one is split */
  const int medium = abbe_media_of(s->inside);
  return !w->physics.polarised && abbe_solid_is(&w->g->solid[medium]) &&
         !abbe_media_is_crystal(w->media, medium) && !abbe_haze_scatters(&w->media->haze, medium) &&
         !abbe_haze_glows(&w->media->haze, medium);
}

/* Into the batch of its solid, whose paths leave it first where it is another's. */
static void enter_solid(run *r, size_t k, const float d[3], const abbe_light_path *s) {
  inner_batch *b = r->w->inner;
  const uint32_t refractor = (uint32_t)abbe_media_of(s->inside);
  if (b->count > 0 && b->refractor != refractor) leave_solid(r);
  b->refractor = refractor;
  b->path[b->count] = *s;
  b->inner[b->count++] =
      abbe_light_path_in_solid(r->w->media, (int)refractor, s, r->packet.hit[k].p, d);
}

/* The path after the interface, into the next batch; what matched physics does not follow ends. */
static path_state go_on(run *r, size_t k, abbe_light_path *s) {
  const packet *p = &r->packet;
  ray_batch *next = r->w->next;
  float o[3], d[3];
  for (int i = 0; i < 3; i++) {
    o[i] = p->scatter.from[i][k];
    d[i] = p->straight[k] ? p->scatter.d[i][k] : p->scatter.out[i][k];
  }
  bool reflects = p->scatter.reflects[k] && !p->straight[k];
  if (!p->straight[k] && !abbe_light_path_is_followed(&r->rules, s, reflects, p->scatter.share[k]))
    return TRAPPED;
  s->inside = reflects ? p->before[k] : p->after[k];
  if (p->crystal[k]) {
    s->wave = p->wave[k];
    memcpy(s->stokes, p->stokes[k], sizeof s->stokes);
  }
  if (stays_in_solid(r->w, s)) {
    enter_solid(r, k, d, s);
    return SCATTERS;
  }
  abbe_ray_put(next->ray, next->count, o, d);
  next->path[next->count++] = *s;
  return SCATTERS;
}

/* A mirror absorbs what it does not reflect; the path goes into the next batch. */
static path_state leave_mirror(run *r, size_t k, const abbe_light_path *path) {
  packet *p = &r->packet;
  abbe_light_path_roughen(&r->rules, r->w->mirrors, &p->hit[k], path, &p->scatter, &p->mirroring,
                          k);
  ray_batch *next = r->w->next;
  abbe_light_path *s = &next->path[next->count];
  float share = p->mirroring.share[k], o[3], d[3];
  *s = *path;
  share *= abbe_light_path_mirrored(&r->rules, r->w->mirrors, &p->hit[k], &p->scatter, k, s);
  r->ledger->absorbed += (double)(s->y * s->flux * (1 - share));
  s->flux *= share;
  s->carried *= share;
  if (++s->steps >= ABBE_INNER_MAX_STEPS) return LOST;
  if (!(s->flux > 0) || !abbe_light_path_survives(&r->rules, s, r->ledger)) return NOT_COUNTED;
  for (int i = 0; i < 3; i++) {
    o[i] = p->scatter.from[i][k];
    d[i] = p->scatter.out[i][k];
  }
  abbe_ray_put(next->ray, next->count++, o, d);
  return MIRRORED;
}

static void deposit(run *r, size_t k, const abbe_light_path *s) {
  const abbe_hit *hit = &r->packet.hit[k];
  abbe_photon_hit *out = &r->hit[r->hits++];
  const double flux = (double)(s->y * s->flux);
  abbe_light_path_hit(s, hit, &r->packet.scatter, k, out);
  r->ledger->deposited += flux;
  if (r->hidden)
    abbe_lamp_rays_add(&r->w->lamp_rays, r->w->g, r->light, hit, out, flux, r->ledger,
                       &r->w->record);
}

static void end_path(run *r, size_t k, path_state state, const abbe_light_path *s) {
  const double flux = (double)(s->y * s->flux);
  if (state == DEPOSITED) deposit(r, k, s);
  if (state == MISSED) r->ledger->missed += flux;
  if (state == TRAPPED) r->ledger->trapped += flux;
  if (state == LOST) r->ledger->lost += flux;
}

/* The paths of a packet on the branches that its lanes have taken, or with `second` those of split
 * paths, which are kept for it, on the other. */
static void advance(run *r, abbe_light_path *paths, size_t count, bool second) {
  for (size_t k = 0; k < count; k++) {
    path_state state = r->packet.state[k];
    if (state != SCATTERS) {
      if (second || state == NOT_COUNTED) continue;
      if (state != MIRRORED)
        end_path(r, k, state, &paths[k]);
      else if (leave_mirror(r, k, &paths[k]) == LOST)
        end_path(r, k, LOST, &r->w->next->path[r->w->next->count]);
      continue;
    }
    abbe_light_path *s = &paths[k], branch;
    const bool split = is_split(r->w, &r->packet, k, s);
    if (second && !split) continue;
    if (split) {
      branch = *s;
      s = &branch;
    }
    if (!r->plain && (r->packet.film[k] >= 0 || r->packet.rough[k] > 0) &&
        !abbe_light_path_pass(&r->rules, r->packet.passes[k], split, second, s, r->ledger))
      continue;
    if (!take_branch(&r->packet, k, split, s)) continue;
    state = go_on(r, k, s);
    if (state != SCATTERS) end_path(r, k, state, s);
  }
}

static void scatter_packet(run *r, const abbe_light_path *paths, size_t count) {
  packet *p = &r->packet;
  const abbe_media *m = r->w->media;
  const bool polarised = r->rules.physics.polarised;
  abbe_scatter_packet(&p->scatter);
  for (size_t k = 0; !r->plain && k < count; k++) {
    const int from = abbe_media_of(p->before[k]), to = abbe_media_of(p->after[k]);
    abbe_wave_face face = {.from = from,
                           .to = to,
                           .film = p->film[k],
                           .entering = p->after[k] > p->before[k],
                           .wave = paths[k].wave,
                           .rough = p->rough[k],
                           .stokes = polarised ? paths[k].stokes : NULL};
    if (p->state[k] == SCATTERS && p->rough[k] > 0)
      p->wave[k] = abbe_light_path_roughen_face(&r->rules, m, &paths[k], &face, &p->scatter, k,
                                                &p->passes[k], p->stokes[k]);
    else if (p->state[k] == SCATTERS && p->crystal[k])
      p->wave[k] = abbe_light_path_bend(&r->rules, m, &paths[k], &face, &p->scatter, k,
                                        &p->passes[k], p->stokes[k]);
    else if (p->state[k] == SCATTERS && p->film[k] >= 0)
      p->passes[k] = abbe_light_path_coat(m, &paths[k], &face, &p->scatter, k);
  }
}

/* Each lane's path goes on as its number decides; one that is split is reflected, and then
 * transmitted. */
static void scatter(run *r, abbe_light_path *paths, size_t count) {
  abbe_scatter *s = &r->packet.scatter;
  bool splits[LANES], any = false, scatters = false, mirrors = false;
  for (size_t k = 0; k < count; k++) {
    splits[k] = r->packet.state[k] == SCATTERS && is_split(r->w, &r->packet, k, &paths[k]);
    if (splits[k]) s->chance[k] = REFLECT;
    scatters = scatters || r->packet.state[k] == SCATTERS;
    mirrors = mirrors || r->packet.state[k] == MIRRORED;
    any = any || splits[k];
  }
  if (mirrors) abbe_scatter_turn(s);
  if (scatters || mirrors) scatter_packet(r, paths, count);
  if (mirrors) abbe_scatter_mirror(s, &r->packet.mirroring);
  advance(r, paths, count, false);
  if (!any) return;
  for (size_t k = 0; k < count; k++)
    if (splits[k]) s->chance[k] = TRANSMIT;
  scatter_packet(r, paths, count);
  advance(r, paths, count, true);
}

/* The paths of a solid's batch to where they leave it, and on. */
static void leave_solid(run *r) {
  abbe_light_walk *w = r->w;
  inner_batch *b = w->inner;
  abbe_inner_walk(&w->g->solid[b->refractor], &r->rules, b->inner, b->count, r->ledger, &w->record,
                  &w->rays);
  for (size_t i = 0; i < b->count; i++) {
    static const path_state states[] = {[ABBE_INNER_LEFT] = SCATTERS,
                                        [ABBE_INNER_GONE] = NOT_COUNTED,
                                        [ABBE_INNER_TRAPPED] = TRAPPED,
                                        [ABBE_INNER_LOST] = LOST};
    const abbe_inner_path *from = &b->inner[i];
    abbe_light_path *s = &b->path[i];
    abbe_light_path_out_of_solid(from, s);
    if (from->end == ABBE_INNER_LEFT) {
      abbe_ray_put(w->next->ray, w->next->count, from->p, from->d);
      w->next->path[w->next->count++] = *s;
    } else {
      end_path(r, 0, states[from->end], s);
    }
  }
  b->count = 0;
}

/* ---- the batch ---- */

static void begin(const run *r, ray_batch *b, const abbe_photon *photon, size_t count) {
  const bool sheet = r->rules.physics.polarised && r->light != NULL;
  b->count = 0;
  for (size_t i = 0; i < count; i++) {
    const abbe_photon *p = &photon[i];
    if (!(p->flux > 0)) continue;
    abbe_ray_put(b->ray, b->count, p->o, p->d);
    abbe_light_path_start(p, &b->path[b->count]);
    if (sheet) abbe_polarised_lamp(r->light, p->d, b->path[b->count].stokes);
    b->count++;
  }
}

/* Traces the rays of a bounce and puts those of the next into w->next. */
static void follow(run *r, size_t bounce) {
  abbe_light_walk *w = r->w;
  ray_batch *b = w->batch;
  abbe_ray_batch_trace(b->ray, b->count, w->small || bounce < COHERENT_BOUNCES, w->g->embree,
                       &w->record);
  w->rays += b->count;
  w->next->count = 0;
  for (size_t first = 0; first < b->count; first += LANES) {
    const size_t used = b->count - first < LANES ? b->count - first : LANES;
    abbe_light_path *paths = &b->path[first];
    const struct RTCRayHit16 *rays = &b->ray[first / LANES];
    abbe_scatter *s = &r->packet.scatter;
    memcpy(s->d[0], rays->ray.dir_x, sizeof s->d[0]);
    memcpy(s->d[1], rays->ray.dir_y, sizeof s->d[1]);
    memcpy(s->d[2], rays->ray.dir_z, sizeof s->d[2]);
    for (size_t k = 0; k < used; k++) r->packet.state[k] = read_hit(r, rays, k, &paths[k]);
    scatter(r, paths, used);
  }
  leave_solid(r);
}

size_t abbe_light_walk_run(abbe_light_walk *w, const abbe_light *light, uint32_t pass,
                           const abbe_photon *photon, size_t count, abbe_photon_hit *hit,
                           abbe_light_ledger *ledger) {
  run r = {.w = w,
           .light = light,
           .rules = {.seed = w->seed, .pass = pass, .physics = w->physics},
           .hidden = w->for_map && light != NULL && w->hidden[light - w->g->scene->light],
           .parallel = light == NULL || light->kind == ABBE_LIGHT_DIRECTIONAL,
           .plain = w->media->crystal == NULL && w->media->films.count == 0 &&
                    w->media->rough == NULL && !w->physics.polarised,
           .hit = hit,
           .ledger = ledger};
  abbe_random_bits(0x73686966, 0, pass, w->seed, r.rules.shift);
  begin(&r, w->batch, photon, count);
  for (size_t bounce = 0; w->batch->count > 0; bounce++) {
    follow(&r, bounce);
    ray_batch *done = w->batch;
    w->batch = w->next;
    w->next = done;
  }
  abbe_lamp_rays_trace(&w->lamp_rays, w->g, ledger, &w->record);
  return r.hits;
}

unsigned abbe_path_splitting_best(const abbe_photon_hit *hit, size_t count) {
  unsigned best = 0;
  double least = INFINITY;
  for (unsigned splits = 0; splits < 1u << ABBE_PHOTON_SPLITS; splits++) {
    double squares = 0, rays = 1;
    for (int k = 0; k < ABBE_PHOTON_SPLITS; k++) rays *= splits >> k & 1 ? 2 : 1;
    for (size_t i = 0; i < count; i++) {
      double weight = 1;
      for (int k = 0; k < ABBE_PHOTON_SPLITS; k++)
        weight *= splits >> k & 1 ? (double)hit[i].chance[k] : 1;
      squares += weight * (double)hit[i].flux * (double)hit[i].flux;
    }
    if (squares * rays < least) {
      least = squares * rays;
      best = splits;
    }
  }
  return best;
}
