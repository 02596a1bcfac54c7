/* gem_stretch.h: a stretch of a line across a stone's view on which light meets the same facets in
 * the same order, and how its light and its ends change with the stone's planes.
 *
 * As gem_slope.h has it, which puts stretches together. Internal to validation/measure/gem/.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_STRETCH_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_STRETCH_H

#include "validation/measure/gem/gem_slope.h"

/* Derivatives that are added up: by each plane's n and d, by the wavelength's index, by how much
 * larger the bluer one's is, and by the loss. */
typedef struct abbe_gem_stretch_by {
  double (*plane)[4], n, spread, loss;
} abbe_gem_stretch_by;

typedef struct abbe_gem_meeting {
  size_t plane;
  double p[3], v[3];      /* the place, and its speed along the line */
  double d[3], d_blue[3]; /* directions in which it comes, of the wavelength and of the bluer one */
  double out[3], out_blue[3]; /* and in which a share leaves */
  double cosine, cosine_blue, reflected;
  double way, share;                   /* in the stone up to here; and what arrives */
  double light, by_out[3], by_blue[3]; /* what leaves counts so much in the measure at hand */
} abbe_gem_meeting;

typedef struct abbe_gem_stretch {
  const abbe_gem_stone *stone;
  const abbe_gem_slope_desc *q; /* the measure at hand; what ends paths is the same in all */
  abbe_gem_light light;
  double sight[3], line[3]; /* unit: away from the eye; along the line */
  double n, n_blue, loss;   /* of the wavelength; loss: a unit of length */
  double t;                 /* the place on the line that was followed */
  size_t count;
  abbe_gem_meeting at[ABBE_GEM_SLOPE_MEETINGS];
  double low, high;                              /* the same facets are met from here to here */
  size_t low_at, low_plane, high_at, high_plane; /* the edge that ends it, seen at that meeting */
} abbe_gem_stretch;

/* Follows the place o of the line, which is at stretch->t and before the stone's silhouette, and
 * says from where to where it is so. The rest of what is above `count` is given. */
void abbe_gem_stretch_follow(abbe_gem_stretch *stretch, const double o[3]);
/* Goes to a place of it. Of each measure: its value there, how that drifts along the line, and
 * adds what all of the stretch changes by, weighted. */
void abbe_gem_stretch_light(abbe_gem_stretch *stretch, double t, double weight,
                            const abbe_gem_slope_desc *measure, size_t count, double *value,
                            double *drift, abbe_gem_stretch_by *by);
/* Adds what an end, the high or the low one, moves by times each jump of the line's light there. */
void abbe_gem_stretch_move(abbe_gem_stretch *stretch, bool high, const double *jump, size_t count,
                           abbe_gem_stretch_by *by);

#endif
