/* physics.h: what the tracer models: what light does (full), or what a renderer says it models
 * (matched).
 *
 * Matched leaves out what the renderer's plan leaves out: light that a refractor reflects on its
 * outside reaches no receiver; light that has left a refractor meets no other, nor the same again;
 * paths end below a share of their light or after a number of inner walls; and light counts only
 * where the lamp would see the receiver past others. The surfaces are the true ones in both.
 */
#ifndef ABBE_VALIDATION_PHYSICS_H
#define ABBE_VALIDATION_PHYSICS_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A zeroed struct is full physics. */
typedef struct abbe_physics {
  bool matched;
  size_t orders;       /* matched: inner walls met at the most */
  double energy_share; /* matched: paths below this share of their light end */
} abbe_physics;

#ifdef __cplusplus
}
#endif
#endif
