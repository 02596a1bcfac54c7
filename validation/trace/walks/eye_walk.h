/* eye_walk.h: what one pixel sees in one pass: paths from the camera through glass to what shows.
 *
 * Receivers are lit directly, with shadows, by point, spot, directional and disk lights, and by the
 * environment, which is seen where a path meets nothing. A pixel
 * that shows a refractor is split: the mirror image on its outside, and a few wavelengths that go
 * through it. At every further interface both ways on are followed; Russian roulette takes what is
 * faint. The caustic on a
 * receiver seen that way comes from the photons around the place (consistent); on a receiver that
 * the camera sees straight it is left out, for the photons themselves find the camera (unbiased).
 * In haze it is alike: what comes straight from lights is sampled along every path, what comes
 * through refractors and off mirrors is gathered or, where it is seen straight, left to the
 * photons. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_EYE_WALK_H
#define ABBE_VALIDATION_TRACE_WALKS_EYE_WALK_H

#include "base/error.h"
#include "validation/trace/medium/haze_grid.h"
#include "validation/trace/transport/bands.h"
#include "validation/trace/transport/environment_light.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"
#include "validation/trace/transport/physics.h"
#include "validation/trace/transport/reflectance.h"
#include "validation/trace/transport/spectral_sampling.h"
#include "validation/trace/walks/camera.h"
#include "validation/trace/walks/light_walk.h"

#include <stddef.h>
#include <stdint.h>

/* The photons of one pass, found by place.
 *
 * A hashed grid of cubes; a gather adds up the hits within a radius on the same side of the
 * same surface. The estimate is the flux within the disk over its area: its bias vanishes as the
 * radius shrinks from pass to pass [KnausZwicker2011]. */

/* A photon as the grid keeps it. */
typedef struct abbe_grid_photon {
  float p[3];
  float flux; /* W; the sign is the side of the face that it hit */
  uint32_t surface;
  uint32_t colour; /* light * steps + step */
} abbe_grid_photon;

typedef struct abbe_photon_grid {
  size_t count, room;
  abbe_grid_photon *photon; /* [count] sorted by cell */
  uint32_t *own;            /* [count] cells of the photons that it was filled with */
  uint32_t *first;          /* [cells + 1] */
  size_t cells;             /* a power of two */
  float cell;               /* side, frame */
} abbe_photon_grid;

void abbe_photon_grid_free(abbe_photon_grid *grid);

/* Sorts count photons (kept in their order within a cell) for gathers of up to that radius.
 * Reuses the grid's memory. ABBE_NO_MEMORY. */
abbe_result abbe_photon_grid_fill(abbe_photon_grid *grid, const abbe_grid_photon *photon,
                                  size_t count, float radius, size_t threads, abbe_error *error);

/* Calls take(user, photon) for each photon on that surface and side within radius (at most the
 * one that the grid was filled for) of p. */
void abbe_photon_grid_gather(const abbe_photon_grid *grid, const float p[3], float radius,
                             uint32_t surface, float side,
                             void (*take)(void *user, const abbe_grid_photon *photon), void *user);

/* Variance times rays is about least with it, in cut stones, prisms and rings. */
#define ABBE_EYE_LEAST_BRANCH 0.4f

/* A mirror image is tinted by so many wavelengths, each for its share of all parts. */
enum { ABBE_EYE_MIRRORED = 8, ABBE_EYE_PARTS = 128 };

/* All that a walk reads; nothing is written. */
typedef struct abbe_eye_walk {
  const abbe_geometry *geometry;
  const abbe_media *media;
  const abbe_mirrors *mirrors;
  const abbe_spectral_sampling *sampling;
  const abbe_bands *bands;
  const abbe_trace_camera *camera;
  const abbe_reflectance *reflectance;
  const abbe_environment_light *environment; /* may be zeroed: none */
  const float (*colour)[3]; /* [lights][steps] in the picture's space, mean: white */
  const float (*white)[3];  /* [lights] in the picture's space */
  abbe_physics physics;
  uint32_t seed;
  abbe_media_set inside; /* refractors that the camera is in; their media are clear */
  float least_branch; /* share of what came into the glass below which roulette decides; 1: at all
                         interfaces */
  const uint8_t *samples;       /* [pixels] of each pixel in a pass; NULL: one */
  const abbe_photon_grid *grid; /* NULL: no photons */
  float radius;                 /* radius of the gather, frame */
  double window_nm;             /* half the range of wavelengths that a dispersed path gathers */
  const abbe_haze_grid *shafts; /* grid of photons that a medium scatters; NULL: none */
  float shaft_radius;           /* radius of their gather, frame */
  float shaft_near; /* as far as this the camera gathers those that it sees straight, by a quarter
                       of the radius, frame */
  float mirrored[ABBE_EYE_MIRRORED][3]; /* colours of a mirror image's bands, and of all parts: */
  float sampled[3];
} abbe_eye_walk;

/* The mean colour of band number b of so many. */
void abbe_eye_walk_band(const abbe_eye_walk *walk, uint32_t bands, uint32_t b, float out[3]);
/* Fills in mirrored and sampled; once all else is there. */
void abbe_eye_walk_prepare(abbe_eye_walk *walk);

typedef struct abbe_eye_sample {
  float rgb[3];     /* radiance, W/(m2 sr), white Y = 1 */
  float caustic[3]; /* the part that came to its receiver through a refractor */
  float albedo[3];  /* reflectance of what shows, by each path's share of the pixel */
  float normal[3];  /* normal of what the ray meets first, towards the camera; none: 0 */
  float depth;      /* along the ray to there, frame; none: 0 */
  bool refractor;   /* the pixel's ray met one, or a mirror, first */
  uint32_t rays;
  float band[ABBE_BANDS_MAX]; /* W/(m2 sr nm), of as many as there are */
} abbe_eye_sample;

/* What the pixel (row * width + column) shows in a pass: the mean of its samples, spread evenly
 * over the pixel and the wavelengths. */
void abbe_eye_walk_pixel(const abbe_eye_walk *walk, size_t pixel, uint32_t pass,
                         abbe_eye_sample *out);

#endif
