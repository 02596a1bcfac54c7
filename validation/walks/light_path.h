/* light_path.h: a photon between its interfaces: the number that decides at the next, absorption
 * and the roulette, and how far matched physics follows it.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_WALKS_LIGHT_PATH_H
#define ABBE_VALIDATION_WALKS_LIGHT_PATH_H

#include "validation/transport/media.h"
#include "validation/transport/random.h"
#include "validation/walks/inner_walk.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A photon on its way. */
typedef struct abbe_light_path {
  abbe_media_set inside;
  uint32_t id, step;
  float within;
  float flux, full; /* W, and W at the start */
  float y;          /* Y of a watt, for the ledger */
  float carried;    /* matched: share of the light that a splitting path would carry */
  float chance[ABBE_PHOTON_SPLITS];
  uint16_t steps, inner; /* interfaces met; matched: of them, after the first */
  bool begun;            /* has met its first interface */
} abbe_light_path;

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

/* Absorption on the way, and the roulette. */
static inline bool abbe_light_path_absorb(const abbe_inner_rules *r, const abbe_media *media,
                                          abbe_light_path *s, float length,
                                          abbe_light_ledger *ledger) {
  if (media->attenuation == NULL) return true;
  int medium = abbe_media_of(s->inside);
  float left = expf(-length * abbe_media_attenuation(media, medium, s->step, s->within));
  ledger->absorbed += (double)(s->y * s->flux * (1 - left));
  s->flux *= left;
  s->carried *= left;
  return abbe_light_path_survives(r, s, ledger);
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

#ifdef __cplusplus
}
#endif
#endif
