/* physics.h: what the tracer models: what light does (full), or what a renderer declares to model
 * (matched).
 *
 * Matched leaves out what the renderer's plan leaves out: where a path that has met its first
 * interface is reflected, it ends if it is left with less than a share of its light or has met a
 * number of interfaces since. The surfaces are the true ones in both, and so is what the map of a
 * light holds: what lands where the light would see the receiver past others.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_PHYSICS_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_PHYSICS_H

#include <stdbool.h>
#include <stddef.h>

/* A zeroed struct is full physics. */
typedef struct abbe_physics {
  bool matched;
  size_t orders;       /* matched: interfaces after the first that may reflect, and one */
  double energy_share; /* matched: what is reflected below this share of its light ends */
  size_t eye_orders;   /* the same of the camera's paths; 0: as the light's */
  double eye_share;
  bool polarised; /* not matched: paths carry the light's polarisation */
  bool once; /* a medium scatters light once, as the renderer has it; matched physics always does */
} abbe_physics;

#endif
