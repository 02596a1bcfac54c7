/* exit_fill.h: tables of the rays that leave an object (scenes/volume/light_exits.h), filled by
 * following them: for each node's light a ray from each point that faces it, and two beside it,
 * which tell how it changes with the light.
 *
 * Same request, same table, on any number of threads. Internal to validation/volume/.
 */
#ifndef ABBE_VALIDATION_VOLUME_EXIT_FILL_H
#define ABBE_VALIDATION_VOLUME_EXIT_FILL_H

#include "scenes/volume/caustic_volume.h"
#include "validation/volume/lone_object.h"

typedef struct abbe_exit_fill_desc {
  size_t points;   /* on all of the surface */
  bool asymmetric; /* its symmetry is not looked for */
  double min_nm, max_nm;
  uint32_t seed;
  size_t threads;                            /* at least 1 */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops; or NULL */
  const char *checkpoint;   /* kept there (volume_checkpoint.h); NULL: none is */
  double checkpoint_s;
  bool resume;
} abbe_exit_fill_desc;

typedef struct abbe_exit_fill_statistics {
  uint64_t rays;    /* that were followed */
  double carried;   /* share of the light that met the object and left it */
  double alone;     /* share of exits whose change with the light is not known */
  size_t sequences; /* of facets, told apart */
  size_t maps;      /* that bring it onto itself */
} abbe_exit_fill_statistics;

/* Into a volume whose body, region and nodes are there. ABBE_UNSUPPORTED for a crystal, which a ray
 * leaves as two; ABBE_CANCELLED; errors of abbe_light_exits_make, of checkpoints
 * and of the tracer's tables. */
abbe_result abbe_exit_fill(const abbe_lone_object *lone, const abbe_exit_fill_desc *desc,
                           abbe_caustic_volume *volume, abbe_exit_fill_statistics *statistics,
                           abbe_error *error);

#endif
