/* estimator_study.h: how far from the truth the estimators of where light meets receivers are in a
 * scene, by iterations and lookups, refraction and reflection apart; and how fast the fixed-point
 * iterations converge beside the law. On the processor, in double precision: no time is taken.
 */
#ifndef ABBE_VALIDATION_LANDING_ESTIMATOR_STUDY_H
#define ABBE_VALIDATION_LANDING_ESTIMATOR_STUDY_H

#include "scenes/view/estimator.h"
#include "validation/landing/landing_rays.h"

#define ABBE_ESTIMATOR_STUDY_MAX 256

typedef struct abbe_estimator_point {
  abbe_estimator kind;
  bool printed; /* its starts, steps and function are as published */
  bool reflected;
  size_t iterations;
  size_t rays;
  double median, p95, worst; /* errors of the place, in texels, of the rays that are found */
  double lost;               /* share of the rays for which nothing is found */
  double lookups, ns;        /* mean, of a ray; ns: on this processor, in double precision */
  /* For shah and axis with lookups of the triangles themselves: median ratio of successive errors,
   * in size, and the median of abbe_estimator_rate for these rays; else NaN. */
  double rate, law;
} abbe_estimator_point;

typedef struct abbe_estimator_study {
  size_t side, grid, hidden; /* numbers of the rays */
  size_t count;
  abbe_estimator_point point[ABBE_ESTIMATOR_STUDY_MAX];
} abbe_estimator_study;

/* Studies the scene's first light, at 550 nm. Errors as of abbe_landing_rays_make. */
abbe_result abbe_estimator_study_make(const abbe_scene *scene, size_t side, size_t grid,
                                      abbe_estimator_study *out, abbe_error *error);

/* CSV. */
abbe_result abbe_estimator_study_save(const abbe_estimator_study *study, const char *path,
                                      abbe_error *error);

#endif
