/* light_path.h: a photon between its interfaces: the number that decides at the next, absorption
 * and the roulette, what a crystal's face makes of it, and how far matched physics follows it.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_LIGHT_PATH_H
#define ABBE_VALIDATION_TRACE_WALKS_LIGHT_PATH_H

#include "validation/trace/medium/glow.h"
#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"
#include "validation/trace/transport/random.h"
#include "validation/trace/walks/inner_walk.h"
#include "validation/trace/walks/light_walk.h"
#include "validation/trace/walks/photon.h"
#include "validation/trace/walks/ray_batch.h"
#include "validation/trace/walks/scatter.h"

#include <string.h>

/* A photon on its way. */
typedef struct abbe_light_path {
  abbe_media_set inside;
  uint32_t id, step;
  float within;
  float flux, full; /* W, and W at the start */
  float y;          /* Y of a watt, for the ledger */
  float carried;    /* matched: share of the light that a splitting path would carry */
  float chance[ABBE_PHOTON_SPLITS];
  uint16_t steps, inner;        /* interfaces met; matched: of them, after the first */
  uint8_t wave;                 /* in a crystal: which of its two */
  bool begun : 1;               /* has met its first interface */
  bool turned : 1, frosted : 1; /* by haze in a refractor; at a rough face */
  bool shown : 1;               /* its first interface was one */
  bool glows : 1;               /* it is of the glow of something */
  float stokes[3];              /* of polarised light, outside of crystals */
} abbe_light_path;
_Static_assert(sizeof(abbe_light_path) == 64, "paths are copied at every interface");

/* Along the ray of lane k, which Embree has been through. */
static inline abbe_light_stretch abbe_light_path_stretch(const abbe_light_path *s,
                                                         const struct RTCRayHit16 *rays, size_t k) {
  abbe_light_stretch out;
  out.length = rays->ray.tfar[k];
  out.flux = s->flux;
  out.step = s->step;
  out.within = s->within;
  out.id = s->id;
  out.steps = s->steps;
  out.medium = abbe_media_of(s->inside);
  out.known = s->turned || s->shown;
  out.glows = s->glows;
  out.wave = s->wave;
  abbe_ray_take(rays, k, out.o, out.d);
  return out;
}

/* As the photon starts. */
static inline void abbe_light_path_start(const abbe_photon *p, abbe_light_path *out) {
  memset(out, 0, sizeof *out);
  out->id = p->id;
  out->step = p->step;
  out->within = p->within;
  out->flux = out->full = p->flux;
  out->y = p->y;
  out->carried = 1;
  for (int i = 0; i < ABBE_PHOTON_SPLITS; i++) out->chance[i] = 1;
}

/* The number that decides at a path's next interface. Neighbouring photons have neighbouring
 * numbers, so the first decisions are spread evenly over them: the fractional parts of multiples
 * of generalised golden ratios, shifted at random in every pass [Roberts2018]. */
static inline float abbe_light_path_chance(const abbe_inner_rules *r, const abbe_light_path *s) {
  if (s->steps < ABBE_EVEN_STEPS)
    return abbe_random_float(s->id * abbe_even_ratio[s->steps] + r->shift[s->steps]);
  float random[4];
  abbe_random4(s->id, s->steps, r->pass, r->seed, random);
  return random[0];
}

/* Ends paths with little left; true: it goes on. */
static inline bool abbe_light_path_survives(const abbe_inner_rules *r, abbe_light_path *s,
                                            abbe_light_ledger *ledger) {
  const float least = 0.05f;
  if (s->flux >= least * s->full) return true;
  float chance = s->flux / (least * s->full), random[4];
  abbe_random4(s->id, s->steps, r->pass, ~r->seed, random);
  /* what the roulette takes from some it gives to others: the mean stays */
  float before = s->flux;
  s->flux = random[0] < chance ? least * s->full : 0;
  ledger->absorbed += (double)(s->y * (before - s->flux));
  return s->flux > 0;
}

/* What a haze takes on the way of that length: absorbed, or scattered off the path. */
static inline bool abbe_light_path_fade(const abbe_inner_rules *r, const abbe_media *media,
                                        abbe_light_path *s, const struct RTCRayHit16 *rays,
                                        size_t k, abbe_light_ledger *ledger) {
  const abbe_haze *haze = &media->haze;
  const int medium = abbe_media_of(s->inside);
  float o[3], d[3], from = 0, to = rays->ray.tfar[k];
  abbe_ray_take(rays, k, o, d);
  if (!abbe_haze_clip(haze, medium, o, d, &from, &to)) return true;
  const float whole = abbe_media_extinction(media, medium, s->step, s->within, d, s->wave);
  if (!(whole > 0)) return true;
  const float glow = abbe_glow_rate(media, medium, s->step, s->within, d, s->wave);
  const float off = abbe_haze_scattering(haze, medium, s->step, s->within);
  const bool turns = abbe_haze_turns(haze, medium); /* what is scattered has gone its own way */
  const float part = turns ? 0 : off / whole;
  const float left = expf(-(to - from) * ((turns ? whole - off : whole) - glow));
  const float taken = s->y * s->flux * (1 - left);
  ledger->scattered += (double)(part * taken);
  ledger->absorbed += (double)((1 - part) * taken);
  s->flux *= left;
  s->carried *= left;
  return abbe_light_path_survives(r, s, ledger);
}

/* What a refractor absorbs of the path there comes back at another wavelength: one that is traced,
 * or the path ends, without light. light: whose path it is. */
static inline void abbe_light_path_glow(const abbe_inner_rules *r, const abbe_media *media,
                                        size_t light, abbe_light_path *s, float d[3],
                                        abbe_light_ledger *ledger) {
  const abbe_glow *g = media->haze.glow;
  const abbe_spectral_sampling *sampling = g->sampling;
  const int medium = abbe_media_of(s->inside);
  const size_t row = s->glows ? sampling->lights + light : light;
  const double nm = abbe_spectral_sampling_lambda(sampling, s->step, s->within);
  const double watts = (double)s->flux * (double)sampling->power[row * sampling->steps + s->step];
  const double yield = abbe_glow_photons(g, medium, s->step);
  float random[4];
  abbe_random4(s->id, s->steps, r->pass, r->seed ^ 0x676c6f77u, random);
  ledger->excited += (double)(s->y * s->flux);
  ledger->quanta[0] += watts * nm;
  ledger->quanta[1] += watts * nm * yield;
  s->flux = 0;
  if (!abbe_glow_emit(g, medium, random[0], &s->step, &s->within)) return;
  const double to_nm = abbe_spectral_sampling_lambda(sampling, s->step, s->within);
  s->flux = s->full = (float)(watts * yield * nm / to_nm);
  s->y = sampling->xyz[(sampling->lights + light) * sampling->steps + s->step][1];
  s->glows = true;
  ledger->glowing += (double)(s->y * s->flux);
  abbe_glow_turn(random[1], random[2], d);
}

/* Where haze in a refractor turns the path before it meets what its ray met, or absorbs it to glow:
 * on from o along d; false: it does not. light: whose path it is. */
static inline bool abbe_light_path_turn(const abbe_inner_rules *r, const abbe_media *media,
                                        size_t light, abbe_light_path *s,
                                        const struct RTCRayHit16 *rays, size_t k, float o[3],
                                        float d[3], abbe_light_ledger *ledger) {
  const abbe_haze *haze = &media->haze;
  const int medium = abbe_media_of(s->inside);
  const bool turns = abbe_haze_turns(haze, medium);
  if (!turns && !abbe_haze_glows(haze, medium)) return false;
  float random[4], kind[4], along[3];
  abbe_random4(s->id, s->steps, r->pass, r->seed ^ 0x7475726eu, random);
  abbe_ray_take(rays, k, o, along);
  const float glow = abbe_glow_rate(media, medium, s->step, s->within, along, s->wave);
  const float off = (turns ? abbe_haze_scattering(haze, medium, s->step, s->within) : 0) + glow;
  const float t = -log1pf(-random[0]) / off;
  if (!(t < rays->ray.tfar[k])) return false;
  const float whole = abbe_media_extinction(media, medium, s->step, s->within, along, s->wave);
  const float left = expf(-t * (whole - off));
  ledger->absorbed += (double)(s->y * s->flux * (1 - left));
  s->flux *= left;
  abbe_random4(s->id, s->steps, r->pass, r->seed ^ 0x6b696e64u, kind);
  const bool glowing = kind[0] * off < glow;
  if (!s->turned && !glowing) ledger->turned += (double)(s->y * s->flux);
  s->turned = true;
  s->wave = random[3] < 0.5f;
  memset(s->stokes, 0, sizeof s->stokes);
  s->steps++;
  for (int i = 0; i < 3; i++) o[i] += t * along[i];
  abbe_haze_turn(haze, medium, along, random[1], random[2], d);
  if (glowing) abbe_light_path_glow(r, media, light, s, d, ledger);
  return true;
}

/* Haze on the way from the light to what a path meets first; the ledger begins there. parallel:
 * from beyond everything. */
static inline void abbe_light_path_begin(const abbe_haze *haze, abbe_light_path *s, bool parallel,
                                         const struct RTCRayHit16 *rays, size_t k) {
  float o[3], d[3];
  if (!abbe_haze_is(haze)) return;
  abbe_ray_take(rays, k, o, d);
  s->flux *= abbe_haze_left(haze, -1, o, d, parallel ? -INFINITY : 0, rays->ray.tfar[k], s->step,
                            s->within);
  s->full = s->flux;
}

/* Absorption on the way, haze, and the roulette. */
static inline bool abbe_light_path_absorb(const abbe_inner_rules *r, const abbe_media *media,
                                          abbe_light_path *s, const struct RTCRayHit16 *rays,
                                          size_t k, abbe_light_ledger *ledger) {
  if (abbe_haze_is(&media->haze)) return abbe_light_path_fade(r, media, s, rays, k, ledger);
  int medium = abbe_media_of(s->inside);
  if (medium < 0 || media->attenuation == NULL) return true;
  float o[3], d[3];
  abbe_ray_take(rays, k, o, d);
  float left =
      expf(-rays->ray.tfar[k] * abbe_media_loss(media, medium, s->step, s->within, d, s->wave));
  ledger->absorbed += (double)(s->y * s->flux * (1 - left));
  s->flux *= left;
  s->carried *= left;
  return abbe_light_path_survives(r, s, ledger);
}

/* At a rough mirror: puts into lane k, in place of what a smooth one does, where the path goes on
 * and the share that does. */
static inline void abbe_light_path_roughen(const abbe_inner_rules *r, const abbe_mirrors *m,
                                           const abbe_hit *hit, const abbe_light_path *s,
                                           abbe_scatter *p, abbe_mirroring *mirroring, size_t k) {
  const size_t mirror = hit->surface->index;
  if (!abbe_mirrors_is_rough(m, mirror)) return;
  float d[3], n[3], ng[3], out[3], random[4], pdf, cos_h;
  for (int i = 0; i < 3; i++) {
    d[i] = p->d[i][k];
    n[i] = p->n[i][k];
    ng[i] = p->ng[i][k];
  }
  abbe_rough_hit rough;
  abbe_random4(s->id, s->steps, r->pass, r->seed ^ 0x6c6f6265u, random);
  abbe_mirrors_meet(m, mirror, hit->p, n, d, &rough);
  const float share = abbe_mirrors_scatter(&rough, random, out, &pdf, &cos_h);
  mirroring->share[k] = share * abbe_mirrors_reflect(m, mirror, cos_h, s->step, s->within);
  abbe_interface_keep_side(ng, 1, out);
  for (int i = 0; i < 3; i++) p->out[i][k] = out[i];
}

/* Behind a mirror: what polarised light is then, and its share over that of unpolarised light. */
static inline float abbe_light_path_mirrored(const abbe_inner_rules *r, const abbe_mirrors *m,
                                             const abbe_hit *hit, const abbe_scatter *p, size_t k,
                                             abbe_light_path *s) {
  float d[3], out[3];
  if (!r->physics.polarised) return 1;
  for (int i = 0; i < 3; i++) {
    d[i] = p->d[i][k];
    out[i] = p->out[i][k];
  }
  return abbe_polarised_mirror(m, hit->surface->index, d, out, s->step, s->within, s->stokes);
}

/* From a place on a solid's inside along unit d, and from where it has left it. */
static inline abbe_inner_path abbe_light_path_in_solid(const abbe_media *m, int refractor,
                                                       const abbe_light_path *s, const float p[3],
                                                       const float d[3]) {
  return (abbe_inner_path){.p = {p[0], p[1], p[2]},
                           .d = {d[0], d[1], d[2]},
                           .eta = abbe_media_n(m, refractor, s->step, s->within),
                           .attenuation = abbe_media_attenuation(m, refractor, s->step, s->within),
                           .flux = s->flux,
                           .full = s->full,
                           .y = s->y,
                           .carried = s->carried,
                           .id = s->id,
                           .steps = s->steps,
                           .inner = s->inner};
}

static inline void abbe_light_path_out_of_solid(const abbe_inner_path *from, abbe_light_path *s) {
  if (s->steps == 1) s->chance[1] = from->second_chance;
  s->flux = from->flux;
  s->carried = from->carried;
  s->inner = (uint16_t)from->inner;
  s->steps = (uint16_t)from->steps;
  s->inside = 0;
}

/* At a face of a crystal: puts into lane k, in place of what it has, where the path goes on as that
 * lane's number decides; *passes as of a film, and what the light is then. Returns the wave that
 * it goes on as. */
static inline uint8_t abbe_light_path_bend(const abbe_inner_rules *r, const abbe_media *media,
                                           const abbe_light_path *s, abbe_wave_face *face,
                                           abbe_scatter *p, size_t k, float *passes,
                                           float stokes[3]) {
  float d[3], ng[3], random[4];
  for (int i = 0; i < 3; i++) {
    face->d[i] = p->d[i][k];
    face->n[i] = p->n[i][k];
    ng[i] = p->ng[i][k];
  }
  abbe_wave_ways ways;
  abbe_media_ways(media, face, s->step, s->within, &ways);
  *passes = ways.passes;
  abbe_random4(s->id, s->steps, r->pass, r->seed ^ 0x77617665u, random);
  const abbe_wave_way *way = abbe_wave_ways_choose(&ways, p->chance[k], random[0]);
  for (int i = 0; i < 3; i++) {
    d[i] = way->d[i];
    stokes[i] = way->stokes[i];
  }
  abbe_interface_keep_side(ng, way->reflected ? 1 : -1, d);
  if (r->physics.polarised && memcmp(d, way->d, sizeof d) != 0)
    abbe_polarised_bend(way->d, d, stokes);
  for (int i = 0; i < 3; i++) {
    p->out[i][k] = d[i];
    /* off the face to the other side */
    if (way->reflected != (p->reflects[k] != 0)) p->from[i][k] = 2 * p->p[i][k] - p->from[i][k];
  }
  p->share[k] = ways.reflected;
  p->reflects[k] = way->reflected;
  return way->wave;
}

/* At a rough face: the same, and the share that is not absorbed in *passes. */
static inline uint8_t abbe_light_path_roughen_face(const abbe_inner_rules *r,
                                                   const abbe_media *media,
                                                   const abbe_light_path *s, abbe_wave_face *face,
                                                   abbe_scatter *p, size_t k, float *passes,
                                                   float stokes[3]) {
  float ng[3], d[3];
  for (int i = 0; i < 3; i++) {
    face->d[i] = p->d[i][k];
    face->n[i] = p->n[i][k];
    ng[i] = p->ng[i][k];
  }
  const uint32_t key[4] = {s->id, s->steps, r->pass, r->seed ^ 0x66726f73u};
  abbe_wave_way way;
  abbe_media_roughen(media, face, s->step, s->within, key, NULL, 0, &way);
  for (int i = 0; i < 3; i++) {
    d[i] = way.d[i];
    stokes[i] = way.stokes[i];
  }
  abbe_interface_keep_side(ng, way.reflected ? 1 : -1, d);
  if (face->stokes != NULL && memcmp(d, way.d, sizeof d) != 0)
    abbe_polarised_bend(way.d, d, stokes);
  for (int i = 0; i < 3; i++) {
    p->out[i][k] = d[i];
    if (way.reflected != (p->reflects[k] != 0)) p->from[i][k] = 2 * p->p[i][k] - p->from[i][k];
  }
  p->reflects[k] = way.reflected;
  *passes = way.share;
  return way.wave;
}

/* At a coated face: the same of the film; returns what it does not absorb. */
static inline float abbe_light_path_coat(const abbe_media *media, const abbe_light_path *s,
                                         const abbe_wave_face *face, abbe_scatter *p, size_t k) {
  float d[3], n[3], ng[3], out[3], cos_t, passes;
  for (int i = 0; i < 3; i++) {
    d[i] = p->d[i][k];
    n[i] = p->n[i][k];
    ng[i] = p->ng[i][k];
  }
  const float cosine = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]), cos_i = fminf(cosine, 1);
  p->share[k] = abbe_films_reflectance(&media->films, face->film, face->entering,
                                       abbe_media_n(media, face->from, s->step, s->within),
                                       abbe_media_n(media, face->to, s->step, s->within), cos_i,
                                       s->step, s->within, &passes);
  const bool reflects = p->chance[k] < p->share[k];
  if (reflects == (p->reflects[k] != 0)) return passes;
  abbe_interface_reflectance(cos_i, p->eta[k], &cos_t);
  if (reflects)
    abbe_interface_reflect(d, n, cos_i, out);
  else
    abbe_interface_refract(d, n, p->eta[k], cos_i, cos_t, out);
  abbe_interface_keep_side(ng, reflects ? 1 : -1, out);
  for (int i = 0; i < 3; i++) {
    p->out[i][k] = out[i];
    p->from[i][k] = 2 * p->p[i][k] - p->from[i][k];
  }
  p->reflects[k] = reflects;
  return passes;
}

/* What a film absorbs, once of a path that is split; false: nothing is left. */
static inline bool abbe_light_path_pass(const abbe_inner_rules *r, float passes, bool split,
                                        bool second, abbe_light_path *s,
                                        abbe_light_ledger *ledger) {
  if (!second) ledger->absorbed += (double)(s->y * s->flux * (1 - passes));
  s->flux *= passes;
  s->carried *= passes;
  return split || abbe_light_path_survives(r, s, ledger);
}

/* Where lane k's path comes to a receiver. */
static inline void abbe_light_path_hit(const abbe_light_path *s, const abbe_hit *hit,
                                       const abbe_scatter *p, size_t k, abbe_photon_hit *out) {
  float along = 0;
  for (int i = 0; i < 3; i++) along += p->d[i][k] * hit->ng[i];
  out->surface = hit->surface->object;
  out->face = hit->face;
  out->u = hit->u;
  out->v = hit->v;
  memcpy(out->p, hit->p, sizeof out->p);
  out->side = along < 0 ? 1 : -1;
  out->flux = s->flux;
  out->step = s->step;
  memcpy(out->chance, s->chance, sizeof out->chance);
  out->hidden = false;
  out->glows = s->glows;
}

/* Matched physics: whether the renderer would still follow the path. */
static inline bool abbe_light_path_is_followed(const abbe_inner_rules *r, abbe_light_path *s,
                                               bool reflects, float share) {
  if (!r->physics.matched) return true;
  s->carried *= reflects ? share : 1 - share;
  if (s->begun) s->inner++;
  if (!s->begun || !reflects) {
    s->begun = true;
    return true;
  }
  return s->inner < r->physics.orders && (double)s->carried >= r->physics.energy_share;
}

/* Whether the light would see the places that its photons hit past other receivers.
 *
 * The map of a light holds only those: the others are flagged as hidden. Refractors and mirrors
 * hide nothing: what falls in their shadow has its place in the map. Rays to the light wait until
 * there is a packet of them.
 * */

/* Whether a receiver may hide a place on another from the light: those that are the walls of a
 * convex space around it hide nothing, and no ray need be traced. */
bool abbe_lamp_is_hidden(const abbe_geometry *g, const abbe_light *light);

/* Photon hits that wait for their ray to the light, of one light. A zeroed one has none. */
typedef struct abbe_lamp_rays {
  struct RTCRay16 ray;
  size_t count;
  uint64_t traced; /* so far */
  const abbe_light *light;
  float p[3][ABBE_RAY_LANES], ng[3][ABBE_RAY_LANES], size[ABBE_RAY_LANES];
  abbe_photon_hit *photon[ABBE_RAY_LANES];
  double flux[ABBE_RAY_LANES]; /* W, for the ledger */
} abbe_lamp_rays;

/* One more; a full packet is traced. */
void abbe_lamp_rays_add(abbe_lamp_rays *rays, const abbe_geometry *g, const abbe_light *light,
                        const abbe_hit *hit, abbe_photon_hit *photon, double flux,
                        abbe_light_ledger *ledger, abbe_ray_record *record);
/* Traces those that wait, flags what is hidden and adds it to the ledger. */
void abbe_lamp_rays_trace(abbe_lamp_rays *rays, const abbe_geometry *g, abbe_light_ledger *ledger,
                          abbe_ray_record *record);

/* ---- a walk ---- */

/* Paths that are followed side by side, and the ray of each. */
typedef struct ray_batch {
  size_t count;
  struct RTCRayHit16 ray[ABBE_LIGHT_WALK_HITS / ABBE_RAY_LANES];
  abbe_light_path path[ABBE_LIGHT_WALK_HITS];
} ray_batch;

/* Paths on the inner side of one solid's surface. */
typedef struct inner_batch {
  size_t count;
  uint32_t refractor;
  abbe_inner_path inner[ABBE_LIGHT_WALK_HITS];
  abbe_light_path path[ABBE_LIGHT_WALK_HITS];
} inner_batch;

struct abbe_light_walk {
  abbe_lamp_rays lamp_rays;
  const abbe_geometry *g;
  const abbe_media *media;
  const abbe_mirrors *mirrors;
  abbe_physics physics;
  uint32_t seed;
  uint64_t rays;
  ray_batch *batch, *next; /* rays of this bounce and of the next */
  inner_batch *inner;
  uint32_t shift[4]; /* shifts of the pass's even decisions */
  unsigned splits;   /* interfaces at which paths are split, a bit each */
  bool small;        /* so few faces that packets stay together wherever their rays go */
  bool *hidden;      /* [lights] abbe_lamp_is_hidden */
  bool for_map;
  abbe_light_walk_stretch take; /* NULL: nobody watches */
  void *watcher;
  abbe_ray_record record;
  abbe_light_walk_room room;
};

#endif
