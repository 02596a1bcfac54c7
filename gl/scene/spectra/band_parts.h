/* band_parts.h: bands of wavelengths in parts, each of which is attenuated alike, so that a path
 * has its band's mean transmittance whatever its length and whatever it meets. Internal to gl/.
 *
 * A spectrum is cut into narrow steps. A part is a set of steps, not of neighbours alone: one
 * attenuation for like ones, as k-distributions have it [LacisOinas1991].
 */
#ifndef ABBE_GL_SCENE_SPECTRA_BAND_PARTS_H
#define ABBE_GL_SCENE_SPECTRA_BAND_PARTS_H

#include "colorimetry/weights.h"
#include "gl/plan/facts/plan_facts.h"

#include <stddef.h>

enum { ABBE_BAND_PARTS = 8 };

/* A usual path of light inside, m: somewhat more than the mean chord of a solid, four times its
 * volume over its surface by Cauchy, for light is reflected inside; a plate has short paths,
 * however wide it is. */
double abbe_usual_path(const abbe_object *object);

/* Optical depth of what is opaque: its exponential is 0 in floats, and sums of it stay finite. */
#define ABBE_BAND_MOST_DEPTH 1e4

/* Steps of a light's spectrum, and what the plan's refractors and mirrors take of each; where some
 * are pleochroic, then what all take of fields along x, then along y, then along z. */
typedef struct abbe_band_steps {
  size_t count, surfaces;
  double (*xyz)[3]; /* [count] CIE XYZ of the light */
  double *depth;  /* [surfaces][count] optical depth of path_m, or of one reflection straight on */
  double *path_m; /* [surfaces] a usual path inside, m; 0 of a mirror */
  bool *splits; /* [surfaces] what it takes counts where parts are made: not what repeats others */
  double (*mean)[ABBE_BAND_PARTS]; /* [surfaces] of parts while they are found, then their depth */
} abbe_band_steps;

/* Makes so many steps for the plan's surfaces. ABBE_NO_MEMORY; abbe_band_steps_free also
 * then. */
abbe_result abbe_band_steps_make(const abbe_scene *scene, const abbe_plan *plan, size_t count,
                                 abbe_band_steps *out, abbe_error *error);
void abbe_band_steps_free(abbe_band_steps *steps);

/* Fills steps first to end - 1, of equal width, with the wavelengths from_nm to to_nm of the light.
 * ABBE_OUT_OF_RANGE where a metal is not known there. */
abbe_result abbe_band_steps_fill(abbe_band_steps *steps, const abbe_scene *scene,
                                 const abbe_plan *plan, const abbe_weights_range *light,
                                 size_t first, size_t end, double from_nm, double to_nm,
                                 abbe_error *error);

/* Some steps, each with the share of its light that counts: a band, or a part of one. */
typedef struct abbe_band_share {
  size_t first, end;
  const double *share;       /* [end - first], 0 or more; NULL: all of each */
  const unsigned char *part; /* [end - first] of each step, or NULL */
  unsigned only;             /* the part that counts, where there are parts */
} abbe_band_share;

/* Splits the band's steps: the part of each, below ABBE_BAND_PARTS. part: [end - first]. */
void abbe_band_parts_split(const abbe_band_steps *steps, const abbe_band_share *band,
                           unsigned char *part);

/* XYZ of the light in it. */
void abbe_band_share_xyz(const abbe_band_steps *steps, const abbe_band_share *band, double xyz[3]);
/* Optical depth with which all of it is attenuated as its mean is, by path_m of that surface or one
 * reflection; below 0: it has no steps. */
double abbe_band_share_depth(const abbe_band_steps *steps, const abbe_band_share *band,
                             size_t surface);

/* The parts' light for which paths of no length to four usual ones, in one surface and in two,
 * leave what they leave of the whole band: none is below 0, and all together have the band's.
 * steps->mean: the parts' depths; xyz: of each part the light in it, then what it counts as. */
void abbe_band_parts_fit(const abbe_band_steps *steps, const abbe_band_share *band,
                         double xyz[ABBE_BAND_PARTS][3]);

#endif
