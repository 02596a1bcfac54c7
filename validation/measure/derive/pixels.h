/* pixels.h: how the camera's picture changes with scalars of its scene: every pixel.
 *
 * Lines run across the film, each with one wavelength, one place on the lens and on each lamp and
 * one of the surroundings' directions (shown.h), and each lamp's own lines bring what it throws
 * onto receivers that are seen straight (derivative.h). Silhouettes, borders of facets and shadows
 * are in it as jumps along the lines (line.h). A pixel is a mean over its area; what lamps throw
 * onto receivers is by a tent that reaches to the neighbours' middles. Standard errors are by 16
 * parts. Left out: paths of more interfaces than asked for or less than 1e-4 of what set out, and
 * receivers' light on each other.
 */
#ifndef ABBE_VALIDATION_MEASURE_DERIVE_PIXELS_H
#define ABBE_VALIDATION_MEASURE_DERIVE_PIXELS_H

#include "colorimetry/rgb_space.h"
#include "validation/measure/derive/derivative.h"

typedef struct abbe_pixels_key {
  const char *name;
  double step;                  /* it is moved so far down and up, in its own unit */
  const abbe_scene *moved[2];   /* down, up; may be the base's */
  abbe_specular_shift shift[2]; /* of a material in it */
} abbe_pixels_key;

typedef struct abbe_pixels_desc {
  const abbe_scene *scene;
  abbe_specular_shift shift; /* of a material in it */
  size_t keys;
  const abbe_pixels_key *key; /* [keys] */
  const abbe_spectral_sampling *sampling;
  abbe_rgb_space space;
  size_t width, height;
  size_t region[4];     /* of means: column and row of its corner, and its size; 0: all pixels */
  size_t samples;       /* a pixel, at least 1 */
  size_t lines, points; /* of each lamp, as in abbe_derivative_desc */
  size_t map_side;      /* of lamps' maps for what is seen through refractors and in mirrors */
  size_t interfaces;
  uint32_t seed;
  size_t threads;
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
} abbe_pixels_desc;

typedef struct abbe_pixels {
  size_t keys, pixels;
  float (*value)[3]; /* [1 + keys][pixels] RGB: the picture, and by each key's unit; owned */
  float (*error)[3]; /* likewise: standard errors; owned */
  double (*mean)[ABBE_DERIVATIVE_PARTS][3]; /* [1 + keys] of the region, by parts; owned */
  bool *felt;                               /* [keys]; owned */
  double left; /* share of what the camera and lamps see that lies on paths that are left out */
  double lost; /* share of the light that jumps whose motion was not found */
} abbe_pixels;

/* ABBE_CANCELLED, ABBE_NO_MEMORY, errors of abbe_specular_make, abbe_specular_match and
 * abbe_specular_wave_make. */
abbe_result abbe_pixels_make(const abbe_pixels_desc *desc, abbe_pixels *out, abbe_error *error);
void abbe_pixels_free(abbe_pixels *pixels);

/* The region's mean (row 0) or its derivative, RGB, and its standard error. */
void abbe_pixels_mean(const abbe_pixels *pixels, size_t row, double mean[3], double error[3]);

#endif
