#include "scenes/shapes/brushing.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"

#include <math.h>
#include <string.h>

/* What of v runs along the surface; false where next to nothing does. */
static bool flatten(const double n[3], double v[3]) {
  const double least = 1e-9, before = abbe_vector_length(v), along = abbe_vector_dot(n, v);
  for (int k = 0; k < 3; k++) v[k] -= along * n[k];
  return abbe_vector_length(v) > least * before && abbe_vector_normalise(v);
}

void abbe_brushing_grain(const abbe_brushing *b, const double p[3], const double n[3],
                         double along[3]) {
  double from[3];
  memcpy(along, b->axis, 3 * sizeof *along);
  if (b->around) {
    abbe_vector_subtract(p, b->centre, from);
    abbe_vector_cross(b->axis, from, along);
  }
  if (flatten(n, along)) return;
  const int least = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2)
                                            : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
  for (int k = 0; k < 3; k++) along[k] = k == least;
  flatten(n, along);
}

void abbe_brushing_move(abbe_brushing *b, const double matrix[16]) {
  abbe_transform_direction(matrix, b->axis, b->axis);
  abbe_vector_normalise(b->axis);
  abbe_transform_point(matrix, b->centre, b->centre);
}
