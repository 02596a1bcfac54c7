/* interval_sums.h: the light between neighbouring wavelengths, summed in steps, with how far along
 * the index has moved: what photons lay between their hits. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_INTERVAL_SUMS_H
#define ABBE_GL_SCENE_SPECTRA_INTERVAL_SUMS_H

#include "gl/plan/facts/plan_facts.h"
#include "spectral/wavelengths.h"

#include <stddef.h>

typedef struct abbe_interval_sums {
  const abbe_scene *scene;
  const abbe_plan *plan;
  size_t steps; /* steps of an interval; even */
  size_t bands,
      band; /* band of the range whose light is summed, and the first of the three; 0: X, Y, Z */
} abbe_interval_sums;

/* Texels of a step: XYZ up to it and how far along the index has moved; the sums of XYZ times that,
 * and the index; where hits keep tints, XYZ times the refractor's attenuation, by amount. */
size_t abbe_interval_sums_texels(const abbe_plan *plan);
/* Texels of all lights and refractors for a sampling of so many nodes. */
size_t abbe_interval_sums_size(const abbe_plan *plan, size_t steps, size_t nodes);

/* out: [light views][refractors][w->count + 1 intervals][steps + 1][texels]; returns its end. */
float (*abbe_interval_sums_fill(const abbe_interval_sums *of, const abbe_wavelengths *w,
                                float (*out)[4]))[4];

#endif
