/* renderer_inputs.h: what each part of a renderer is made from, as a number that is equal where
 * nothing of it has changed. It makes nothing. Internal to gl/.
 *
 * A number is a 64-bit digest of all values that the part and those that it stands on read, so that
 * a difference anywhere is seen whoever made it.
 */
#ifndef ABBE_GL_RENDERER_INPUTS_H
#define ABBE_GL_RENDERER_INPUTS_H

#include "gl/plan/plan.h"
#include "scenes/scene.h"

#include <stdint.h>

/* The parts of a renderer, each made after those above it. */
typedef enum abbe_renderer_part {
  ABBE_PART_GEOMETRY, /* meshes, planes, triangles to be traversed, charts of receivers */
  ABBE_PART_SURFACES, /* reflectances and textures */
  ABBE_PART_SPECTRA,  /* tables over wavelength */
  ABBE_PART_SHADOWS,  /* planes of refractors' shadows: of geometry and lights' places */
  ABBE_PART_LIGHT, /* light views, photons, maps: of geometry, spectra, shadows and lights' beams */
  ABBE_PART_EYE,   /* targets and programs of the camera's passes */
  ABBE_PART_POWERS, /* how strong lights, ambient light and background are, and the picture's space:
                       nothing is made of it but a table */
  ABBE_PART_COUNT
} abbe_renderer_part;

typedef struct abbe_renderer_inputs {
  uint64_t part[ABBE_PART_COUNT];
  uint64_t
      sights;     /* where the camera's rays through refractors go: all of the eye but the lights */
  uint64_t pages; /* what pinholes show: of smooth mirrors and refractors no lamps */
  uint64_t glow;  /* what makes refractors glow: all but the camera */
} abbe_renderer_inputs;

void abbe_renderer_inputs_of(const abbe_scene *scene, const abbe_plan *plan,
                             abbe_renderer_inputs *out);

/* A bit, 1 << part, for each that differs. */
unsigned abbe_renderer_inputs_differ(const abbe_renderer_inputs *a, const abbe_renderer_inputs *b);

#endif
