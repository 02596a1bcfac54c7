/* gem_view.h: a stone seen from one side, and what its light comes to under each hemisphere.
 *
 * For each pixel, repeat and wavelength one ray of the eye, followed to all its exits. Means are
 * over the silhouette; those in white light are weighted by what the eye makes of each wavelength
 * under an illuminant (colorimetry/weights.h). Errors come from each pixel's scatter. Results do
 * not depend on the number of threads. Internal to validation/measure/gem/.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_VIEW_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_VIEW_H

#include "colorimetry/weights.h"
#include "validation/measure/gem/gem_light.h"

enum { ABBE_GEM_MOST_SIDE = 2048, ABBE_GEM_MOST_REPEATS = 64 };

typedef struct abbe_gem_view_desc {
  double axis_rad, tilt_rad; /* as abbe_gem_eye_make has them */
  double head_rad;           /* half angle; 0: no head */
  size_t side;               /* pixels, 1 to ABBE_GEM_MOST_SIDE; 0: 128 */
  size_t repeats;            /* 2 to ABBE_GEM_MOST_REPEATS; 0: 8 */
  size_t threads;            /* 0: as many as OpenMP gives */
} abbe_gem_view_desc;

typedef struct abbe_gem_view {
  size_t side, repeats, wavelengths;
  float *hit; /* [side][side][repeats] 1 where the ray met the stone, else 0 */
  /* [side][side][repeats][ABBE_GEM_AMOUNT_COUNT] of the ray's white light */
  float *amount;
  /* [side][side][3] XYZ under light that is 1 everywhere above the girdle plane but at the head;
   * mean of all repeats, those that missed count as black; and what of them met the stone */
  float *xyz, *cover;
  /* [wavelengths] over rays that met it */
  abbe_gem_sums (*spectrum)[ABBE_GEM_AMOUNT_COUNT];
  abbe_gem_sums colour[3]; /* XYZ of the same light */
} abbe_gem_view;

/* weights: in XYZ, of the stone's wavelengths. ABBE_INVALID_ARGUMENT for sizes outside their
 * ranges, angles that are not finite, a head of a half angle outside [0, pi / 4), weights of
 * another count; ABBE_GEOMETRY where no ray met the stone; ABBE_NO_MEMORY. */
abbe_result abbe_gem_view_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                               const abbe_gem_view_desc *desc, abbe_gem_view *out,
                               abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_view_free(abbe_gem_view *view);
/* ABBE_INVALID_ARGUMENT for a head of a half angle outside [0, pi / 4), for a stone that is empty,
 * for weights of another count than its wavelengths or that sum to no light. */
abbe_result abbe_gem_view_check(const abbe_gem_stone *stone, const abbe_weights *weights,
                                double head_rad, abbe_error *error);

/* Mean over the silhouette, in white light. */
abbe_gem_number abbe_gem_view_amount(const abbe_gem_view *view, abbe_gem_amount amount);
/* At one of the wavelengths. */
abbe_gem_number abbe_gem_view_at(const abbe_gem_view *view, abbe_gem_amount amount,
                                 size_t wavelength);

/* Shares of the silhouette's area, by which part of a place's light that is not absorbed is the
 * greatest: what returns, what leaks (a window), or what comes from the head and is left
 * (extinction, as is a place where all is absorbed). They add up to 1. Places are rays, and not
 * pixels: so these do not depend on the grid. */
typedef struct abbe_gem_areas {
  abbe_gem_number brilliant, window, extinct;
} abbe_gem_areas;

/* ABBE_NO_MEMORY. */
abbe_result abbe_gem_view_areas(const abbe_gem_view *view, abbe_gem_areas *out, abbe_error *error);

/* Standard deviation of the light return over the places of the silhouette, over its mean
 * [Peli1990]; of rays, and not of pixels, as the areas. */
abbe_gem_number abbe_gem_view_contrast(const abbe_gem_view *view);

#endif
