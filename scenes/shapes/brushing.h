/* brushing.h: how rough a mirror is and in which direction its grooves run. What that does to light
 * is in spectral/microfacets.h. Internal to scenes/. */
#ifndef ABBE_SCENES_SHAPES_BRUSHING_H
#define ABBE_SCENES_SHAPES_BRUSHING_H

#include "spectral/microfacets.h"

#include <stdbool.h>

/* A zeroed one is smooth. */
typedef struct abbe_brushing {
  abbe_microfacets facets; /* x: along the grooves, y: across; both 0: smooth */
  bool around;             /* they run around the axis through `centre`, as on a lathe; else along
                              the axis, as far as the surface does */
  double axis[3],
      centre[3]; /* world; of no meaning where x and y are alike. A zero axis: any direction */
} abbe_brushing;

static inline bool abbe_brushing_is_rough(const abbe_brushing *b) {
  return b->facets.x > 0;
}

/* Unit vector along the grooves at p, where n is the surface's unit normal; where they have no
 * direction, one of those across n. */
void abbe_brushing_grain(const abbe_brushing *b, const double p[3], const double n[3],
                         double along[3]);

/* Moves it with its object, by an affine 4x4 matrix. */
void abbe_brushing_move(abbe_brushing *b, const double matrix[16]);

#endif
