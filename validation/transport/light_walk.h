/* light_walk.h: photons from a light through refractors to receivers.
 *
 * A batch of photons is followed side by side: every interface reflects or transmits each of them
 * by Fresnel's law and a random number, so a photon keeps its whole flux but for what is absorbed.
 * Paths run until they land, leave the scene, or lose the roulette. Light that reaches a receiver
 * without meeting a refractor is not counted: the eye finds it by itself.
 */
#ifndef ABBE_VALIDATION_TRANSPORT_LIGHT_WALK_H
#define ABBE_VALIDATION_TRANSPORT_LIGHT_WALK_H

#include "base/error.h"
#include "validation/transport/geometry.h"
#include "validation/transport/media.h"
#include "validation/transport/physics.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_LIGHT_WALK_BATCH 1024u /* photons side by side */
#define ABBE_LIGHT_WALK_SPLITS 2    /* first interfaces that a photon may be parted at */
#define ABBE_LIGHT_WALK_LANDINGS (ABBE_LIGHT_WALK_BATCH << ABBE_LIGHT_WALK_SPLITS)

typedef struct abbe_photon {
  float o[3], d[3]; /* frame; d unit */
  float flux;       /* W */
  float y;          /* Y of a watt at its wavelength, for the ledger; mean 1 */
  uint32_t step;    /* of the spectral sampling */
  float within;     /* place in the step, [0, 1) */
  uint32_t id;      /* its random numbers; unique in its pass, and next to its neighbours' */
} abbe_photon;

/* Where a photon landed on a receiver. */
typedef struct abbe_landing {
  uint32_t surface, face;
  float u, v;
  float p[3]; /* frame */
  float side; /* +1: on the side of the face's normal, -1: on the other */
  float flux; /* W */
  uint32_t step;
  /* Chance with which the first interfaces sent it where they did; 1 where it was parted there, or
   * where there was no choice. */
  float way[ABBE_LIGHT_WALK_SPLITS];
  bool hidden; /* from the lamp by other receivers, so that its map has no place for it */
} abbe_landing;

/* Where the light of the photons went: W, each wavelength with its share of Y. */
typedef struct abbe_light_ledger {
  double reached; /* brought to a refractor, before anything else */
  double landed;  /* on receivers */
  double contact; /* the part of it that came from inside a refractor that touches the receiver */
  double hidden;  /* the part of it that other receivers hide from the lamp: in no map */
  double absorbed;
  double escaped; /* met nothing any more */
  double dropped; /* not modelled by matched physics */
  double lost;    /* where single precision lost track of inside and outside, or the path was
                     longer than 10000 steps */
} abbe_light_ledger;

typedef struct abbe_light_walk abbe_light_walk; /* one a thread */

/* geometry and media outlive it. seed: of all random numbers. */
abbe_result abbe_light_walk_make(const abbe_geometry *geometry, const abbe_media *media,
                                 const abbe_physics *physics, uint32_t seed, abbe_light_walk **out,
                                 abbe_error *error);
void abbe_light_walk_free(abbe_light_walk *walk);

/* Room for a batch and its landings, the walk's own and for its callers: a quarter of a megabyte,
 * which a thread's stack may not have. */
typedef struct abbe_light_walk_room {
  abbe_photon photon[ABBE_LIGHT_WALK_BATCH];
  abbe_landing landing[ABBE_LIGHT_WALK_LANDINGS];
} abbe_light_walk_room;
abbe_light_walk_room *abbe_light_walk_get_room(abbe_light_walk *walk);

/* At which of its first interfaces (bit 0: the first) a photon of the next runs goes both ways, each
 * with its share of the light, where it else takes one of them by chance. Nothing is biased by
 * either: parting pays where the way that is rarely taken is the one that lands. */
void abbe_light_walk_part(abbe_light_walk *walk, unsigned interfaces);
/* The interfaces to part at, by the landings of a trial without: those that make the least of the
 * mean square of a landing's light, times the number of rays. */
unsigned abbe_light_walk_best_parts(const abbe_landing *landing, size_t count);

/* Follows count <= ABBE_LIGHT_WALK_BATCH photons of one light of the geometry's scene; writes at most
 * count landings, twice as many for each interface to part at (ABBE_LIGHT_WALK_LANDINGS), and adds to
 * the ledger. pass: of the random numbers. Returns the number of landings. */
size_t abbe_light_walk_run(abbe_light_walk *walk, const abbe_light *light, uint32_t pass,
                           const abbe_photon *photon, size_t count, abbe_landing *landing,
                           abbe_light_ledger *ledger);

/* Rays of paths that were traced so far; those that ask what is hidden are not among them. */
uint64_t abbe_light_walk_rays(const abbe_light_walk *walk);
/* Keeps every packet of rays of the next runs, up to a limit, to trace them again for its own
 * sake: seconds that Embree alone takes for them, and their number. False before any were kept. */
void abbe_light_walk_keep(abbe_light_walk *walk, size_t packets);
bool abbe_light_walk_replay(abbe_light_walk *walk, double *seconds, uint64_t *rays);

#ifdef __cplusplus
}
#endif
#endif
