/* light_walk.h: photons from a light through refractors to receivers.
 *
 * A batch of photons is followed side by side: every interface reflects or transmits each of them
 * by Fresnel's law and a random number, so a photon keeps its whole flux but for what is absorbed.
 * Paths run until they land, leave the scene, or lose the roulette. Light that reaches a receiver
 * without meeting a refractor is not counted: the camera finds it by itself. Internal to
 * validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_LIGHT_WALK_H
#define ABBE_VALIDATION_TRACE_WALKS_LIGHT_WALK_H

#include "base/error.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"
#include "validation/trace/transport/physics.h"
#include "validation/trace/walks/photon.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_LIGHT_WALK_BATCH 1024u /* photons side by side */
#define ABBE_LIGHT_WALK_HITS (ABBE_LIGHT_WALK_BATCH << ABBE_PHOTON_SPLITS)

typedef struct abbe_light_walk abbe_light_walk; /* one a thread */

/* geometry, media and mirrors outlive it. seed: of all random numbers. */
abbe_result abbe_light_walk_make(const abbe_geometry *geometry, const abbe_media *media,
                                 const abbe_mirrors *mirrors, const abbe_physics *physics,
                                 uint32_t seed, abbe_light_walk **out, abbe_error *error);
void abbe_light_walk_free(abbe_light_walk *walk);

/* Capacity for a batch and its hits, the walk's own and for its callers: a quarter of a megabyte,
 * which a thread's stack may not have. */
typedef struct abbe_light_walk_room {
  abbe_photon photon[ABBE_LIGHT_WALK_BATCH];
  abbe_photon_hit hit[ABBE_LIGHT_WALK_HITS];
} abbe_light_walk_room;
abbe_light_walk_room *abbe_light_walk_get_room(abbe_light_walk *walk);

/* At which of its first interfaces (bit 0: the first) a path of the next runs is split: it takes
 * both branches, each with its share of the light, where it else takes one of them by chance.
 * Nothing is biased by either: splitting pays where the branch that is rarely taken is the one that
 * meets receivers.
 */
void abbe_light_walk_split(abbe_light_walk *walk, unsigned interfaces);

/* Whether the hits of the next runs are for a map of their light: then they and the ledger hold
 * what receivers hide from it, which needs a ray each. At first they are. */
void abbe_light_walk_for_map(abbe_light_walk *walk, bool map);

typedef void (*abbe_light_walk_stretch)(void *user, const abbe_light_stretch *stretch);
/* Gets every segment of the next runs, in the open and in refractors, but for those inside of
 * convex solids in which nothing scatters; NULL: nobody does. */
void abbe_light_walk_watch(abbe_light_walk *walk, abbe_light_walk_stretch take, void *user);

/* Follows count <= ABBE_LIGHT_WALK_BATCH photons of one light of the geometry's scene, or of its
 * environment (light NULL: nothing is hidden from it, for it has no map); writes at
 * most count hits, twice as many for each interface to split at (ABBE_LIGHT_WALK_HITS), and adds to
 * the ledger. pass: of the random numbers. Returns the number of hits. */
size_t abbe_light_walk_run(abbe_light_walk *walk, const abbe_light *light, uint32_t pass,
                           const abbe_photon *photon, size_t count, abbe_photon_hit *hit,
                           abbe_light_ledger *ledger);

/* Rays of paths that were traced so far; and those that test what is hidden from a light. */
uint64_t abbe_light_walk_rays(const abbe_light_walk *walk);
uint64_t abbe_light_walk_lamp_rays(const abbe_light_walk *walk);
/* Keeps every packet of rays of both kinds of the next runs, up to a limit, to trace them again for
 * its own sake: seconds that Embree alone takes for them, and their number. False before any were
 * kept. */
void abbe_light_walk_keep(abbe_light_walk *walk, size_t packets);
bool abbe_light_walk_replay(abbe_light_walk *walk, double *seconds, uint64_t *rays);

/* At which of their first interfaces the paths of photons should be split. */

/* The interfaces to split at (bit 0: the first), by the hits of a trial without: those that make
 * the least of the mean square of a hit's light, times the number of rays. */
unsigned abbe_path_splitting_best(const abbe_photon_hit *hit, size_t count);

#endif
