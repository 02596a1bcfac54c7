/* exit_walk.h: one ray through an object that stands alone, to where it leaves it for good: the
 * tracer's surfaces, media and laws, with the decisions between reflection and transmission given
 * from outside, so that rays side by side decide alike.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_VOLUME_EXIT_WALK_H
#define ABBE_VALIDATION_VOLUME_EXIT_WALK_H

#include "validation/transport/geometry.h"
#include "validation/transport/media.h"
#include "validation/transport/mirrors.h"

#define ABBE_EXIT_WALK_CHANCES 8 /* of decisions that are given; those after follow from the last  \
                                  */
#define ABBE_EXIT_WALK_MOST 64   /* interfaces; what is longer is dropped */

/* What is the same for all rays. */
typedef struct abbe_exit_space {
  const abbe_geometry *geometry;
  const abbe_media *media;
  const abbe_mirrors *mirrors;
  const uint32_t *facet; /* [faces] of the object: in which of its planes each lies; NULL: one */
} abbe_exit_space;

typedef struct abbe_exit_start {
  float place[3];      /* frame: where it should meet the surface first */
  float way[3];        /* unit, into it */
  uint32_t step;       /* of the media's wavelengths */
  const float *chance; /* [ABBE_EXIT_WALK_CHANCES] in [0, 1) */
} abbe_exit_start;

typedef struct abbe_exit_end {
  float place[3], way[3]; /* frame; unit */
  float carried;   /* share of its light that gets there; 0: something stood before the place,
                      or none of it came out */
  uint32_t facets; /* of what it met and whether it was reflected there: the same for the same
                      sequence */
} abbe_exit_end;

void abbe_exit_walk(const abbe_exit_space *space, const abbe_exit_start *start, abbe_exit_end *end);

#endif
