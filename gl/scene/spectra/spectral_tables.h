/* spectral_tables.h: where the scene's materials and lights are evaluated over the spectrum, once
 * for all passes: wavelengths and those of them that every photon takes, index and attenuation of
 * every refractor, weights of every light, and what photons need between wavelengths. It knows no
 * device; passes make their buffers of it. Internal to gl/.
 *
 * Whoever changes a material, a light's spectrum or the wavelengths frees the tables, makes them
 * again and has the passes upload anew: no pass keeps a pointer into them.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_SPECTRAL_TABLES_H
#define ABBE_GL_SCENE_SPECTRA_SPECTRAL_TABLES_H

#include "colorimetry/weights.h"
#include "gl/plan/facts/plan_facts.h"
#include "gl/scene/spectra/mirror_nodes.h"
#include "spectral/wavelengths.h"

#include <stddef.h>

/* What refractors and mirrors take of the bands of photons' wavelengths, by what a path passed of
 * them (gl/plan/examine/spectral_needs.h). */

enum { ABBE_TINT_TEXELS = 2 };

typedef struct abbe_spectral_tables {
  abbe_wavelengths all;    /* the plan's */
  abbe_wavelengths coarse; /* those that every photon takes, with bands of their own; or all */

  double *index, *attenuation; /* [refractors][all]; of a mirror as mirror_nodes.h says; 1/m */
  double *attenuation_550;     /* [refractors], 1/m at 550 nm */
  abbe_mirror_node *mirror;    /* [refractors][all]; zero of what is none */
  abbe_weights camera;         /* XYZ of all under the first light: none is negative */

  /* Tables for photons, where the plan has caustics; else NULL. First by the coarse set, then by
   * all, where that is more. */
  size_t steps;                        /* steps of an interval */
  float (*intervals)[4];               /* interval_sums.h: X, Y, Z */
  float (*tints)[ABBE_TINT_TEXELS][4]; /* spectral_tables.h; NULL where hits keep none */
  /* [light views][all]: Y of the band below and above the node, by all and by the coarse set */
  float (*sample_weight)[4];
  float *interval_weight; /* [light views][coarse - 1]: shares of X + Y + Z, of mean 1 */
} abbe_spectral_tables;

/* Makes the tables of the scene's and the plan's lights, refractors and wavelengths.
 * ABBE_OUT_OF_RANGE where an index is not known, ABBE_INVALID_ARGUMENT where the range holds no
 * light, ABBE_NO_MEMORY; abbe_spectral_tables_free also then. */
abbe_result abbe_spectral_tables_make(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_spectral_tables *out, abbe_error *error);
void abbe_spectral_tables_free(abbe_spectral_tables *tables);

/* Intervals as the tables' own, but of bands first to first + 2 of so many instead of X, Y and Z;
 * malloc'd. */
abbe_result abbe_spectral_tables_intervals(const abbe_spectral_tables *tables,
                                           const abbe_scene *scene, const abbe_plan *plan,
                                           size_t bands, size_t first, float (**out)[4],
                                           abbe_error *error);

/* Index among so many wavelengths of node k of a coarse set of so many. */
size_t abbe_spectral_tables_node(size_t wavelengths, size_t nodes, size_t k);

#endif
