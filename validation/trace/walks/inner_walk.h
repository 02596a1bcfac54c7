/* inner_walk.h: photons on their way through a convex solid, sixteen side by side, from the face
 * where they came in to where they leave it.
 *
 * At every face Fresnel's law and a number decide between reflection and transmission, as the light
 * walk does at all other interfaces; between faces the material absorbs. It traverses no BVH.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_INNER_WALK_H
#define ABBE_VALIDATION_TRACE_WALKS_INNER_WALK_H

#include "validation/trace/transport/physics.h"
#include "validation/trace/transport/solid.h"
#include "validation/trace/walks/photon.h"
#include "validation/trace/walks/ray_batch.h"

#define ABBE_INNER_MAX_STEPS 10000 /* interfaces of a path, the one where it came in among them */
#define ABBE_EVEN_STEPS 3          /* first interfaces whose decisions are spread evenly */

/* Golden ratios of the even decisions, 2^32 each [Roberts2018]. */
static const uint32_t abbe_even_ratio[ABBE_EVEN_STEPS] = {3242174889u, 2447445414u, 3679390609u};

typedef enum abbe_inner_end {
  ABBE_INNER_LEFT,    /* it is outside, and goes on */
  ABBE_INNER_GONE,    /* absorbed: the roulette took what was left */
  ABBE_INNER_TRAPPED, /* matched: as long as the renderer follows one */
  ABBE_INNER_LOST     /* too long */
} abbe_inner_end;

/* In: a path on the inner side of the solid's surface. Out: where it goes on outside. */
typedef struct abbe_inner_path {
  float p[3], d[3];    /* frame; d unit. Out: p off the surface, for Embree */
  float eta;           /* index of the solid over that of what is around it */
  float attenuation;   /* natural, a frame unit */
  float flux, full;    /* W, and W at the start: less than a twentieth of it goes by roulette */
  float y;             /* Y of a watt, for the ledger */
  float carried;       /* matched: share of the light that a splitting path would carry */
  uint32_t id, steps;  /* number of its random numbers; interfaces met so far, at least 1 */
  uint32_t inner;      /* matched: interfaces met after the first */
  float second_chance; /* out, of a path that came with one step: of the way taken at its next */
  abbe_inner_end end;  /* out */
} abbe_inner_path;

/* What decides: of the pass, and the same for all. */
typedef struct abbe_inner_rules {
  uint32_t seed, pass, shift[4]; /* as in the light walk */
  abbe_physics physics;
} abbe_inner_rules;

/* Follows all paths to their ends; adds what was absorbed to the ledger and the rays to *rays. The
 * order has no part in it: each path is written where it stood. */
void abbe_inner_walk(const abbe_solid *solid, const abbe_inner_rules *rules, abbe_inner_path *path,
                     size_t count, abbe_light_ledger *ledger, abbe_ray_record *record,
                     uint64_t *rays);

#endif
