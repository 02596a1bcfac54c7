/* volume_fill.h: caustic volumes filled by photons: an object alone in light from each of the nodes
 * in turn, and what its paths bring to the cells around it once they have met it; or a table of the
 * rays that leave it (exit_fill.h).
 *
 * It is the tracer's own physics (light_walk.h). Same request, same volume, on any number of
 * threads.
 */
#ifndef ABBE_VALIDATION_LAB_VOLUME_FILL_H
#define ABBE_VALIDATION_LAB_VOLUME_FILL_H

#include "scenes/volume/caustic_volume.h"
#include "validation/trace/walks/photon.h"

#define ABBE_VOLUME_FILL_MOST_PHOTONS (1u << 26) /* photons of a pass */
#define ABBE_VOLUME_FILL_MOST_PASSES 100000

/* A zeroed one is a valid request but for the object. */
typedef struct abbe_volume_fill_desc {
  size_t object; /* the scene's: a refractor or a mirror */
  size_t light;  /* the scene's, whose illuminant it is */
  abbe_volume_kind kind;
  size_t nodes;            /* 0: 162; of a ball 1, but for exits */
  size_t exits;            /* above 0: in place of values the rays of so many points, at most
                              ABBE_LIGHT_EXITS_MOST; photons and passes are not read */
  bool asymmetric;         /* the object's symmetry is not looked for */
  abbe_region_desc region; /* without sizes: 24 shells of 5120 triangles, for exits of
                              48 x 48 texels; outer 0: three radii of
                              the object, inner 0: just below its surface */
  size_t photons;          /* a node and pass; 0: 2^18 */
  size_t passes;           /* 0: 4 */
  double until_error;      /* above 0: more passes, until a node's relative error is below */
  double min_nm, max_nm;   /* 0: 380, 780 */
  uint32_t seed;
  size_t threads;                            /* 0: all cores */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops; or NULL */
  const char *checkpoint;   /* whole nodes are kept there; NULL: none are */
  double checkpoint_s;      /* at the least between two */
  bool resume;              /* go on from it, where there is one */
} abbe_volume_fill_desc;

typedef struct abbe_volume_fill_statistics {
  size_t passes; /* passes of all nodes */
  uint64_t photons;
  double seconds; /* wall time */
  double carried; /* for exits: see abbe_exit_fill_statistics, whose rays photons is */
  double alone;
  size_t sequences, maps;
  double error; /* relative standard error, root mean square over nodes; NaN of a pass */
  abbe_light_ledger ledger; /* W for unit irradiance, mean over nodes */
  double outflow[2]; /* for shells, vector: Y, least and greatest over nodes and shells beyond the
                        object, as a share of what left it; else 0 */
} abbe_volume_fill_statistics;

/* ABBE_INVALID_ARGUMENT for what is outside the limits, a receiver, and a scene without lights;
 * ABBE_CANCELLED; errors of the tracer's tables, and of a checkpoint that belongs to something
 * else.
 */
abbe_result abbe_volume_fill(const abbe_scene *scene, const abbe_volume_fill_desc *desc,
                             abbe_caustic_volume *out, abbe_volume_fill_statistics *statistics,
                             abbe_error *error);

#endif
