/* shaft_photons.h: photons in participating media: each segment of a path is scattered at one
 * place of it, which the camera may see.
 *
 * A place that the camera sees straight, in the medium that the camera is in, adds to its pixel at
 * once, unbiased; nearer than a distance it does not, where few would add much. All are kept for
 * gathers along paths of the camera. The path goes on with what is left of it, whatever happened
 * here. In a refractor whose haze scatters more than once paths of the camera are turned too, and
 * find all light but that of lights without size at its first turn, where its first interface was
 * not a rough face.
 *
 * What a refractor absorbs to glow near its faces is kept once more behind each of them, as mirrors
 * show it: a gather that a face cuts finds as much as one inside. Glow that is even is so up to
 * flat faces and right-angled edges.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_SHAFT_PHOTONS_H
#define ABBE_VALIDATION_TRACE_TRACER_SHAFT_PHOTONS_H

#include "validation/trace/medium/haze_grid.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/walks/camera.h"
#include "validation/trace/walks/photon.h"

#include <stdbool.h>

enum { ABBE_SHAFT_LANES = 16 };

/* On its way to the camera. */
typedef struct abbe_shaft_splat {
  size_t pixel;
  uint32_t step;
  bool glows;  /* it is of the glow of something */
  float value; /* radiance that the pixel's mean gains */
} abbe_shaft_splat;

/* Photons of one light and one thread. What is above `add` is given; the rest starts zeroed. */
typedef struct abbe_shaft_photons {
  const abbe_geometry *geometry;
  const abbe_media *media;
  const abbe_trace_camera *camera;
  int eye_medium; /* refractor that the camera is in, or -1 */
  float near;     /* frame: no nearer to the camera are places splatted */
  float radius;   /* frame: of the pass's gathers */
  uint32_t pass, seed;
  uint32_t colour, glow; /* colour of the light's first step, and of its glow's */
  bool found;            /* paths of the camera meet the light by themselves: it has a size */
  void (*add)(void *user, const abbe_shaft_splat *splat);
  void *user;
  struct RTCRay16 packet; /* to the camera, of splats that wait */
  abbe_shaft_splat splat[ABBE_SHAFT_LANES];
  size_t waiting;
  uint64_t rays;
  size_t count, room;
  abbe_haze_photon *photon; /* [count] owned */
  bool full;                /* there was no memory for another */
} abbe_shaft_photons;

/* A watcher of light walks (abbe_light_walk_watch); user: an abbe_shaft_photons. */
void abbe_shaft_photons_take(void *user, const abbe_light_stretch *stretch);
/* Splats that wait are traced and added. */
void abbe_shaft_photons_flush(abbe_shaft_photons *photons);
void abbe_shaft_photons_free(abbe_shaft_photons *photons);

#endif
