/* scatter.h: Snell's and Fresnel's laws for a packet of sixteen paths, each at its own interface.
 *
 * Arithmetic alone, in arrays of a lane each, for the compiler to do side by side.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_WALKS_SCATTER_H
#define ABBE_VALIDATION_WALKS_SCATTER_H

#include "validation/walks/ray_batch.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_scatter {
  /* In: unit directions, places, unit normals on the side that the path comes from (n interpolated,
   * ng of the face), the ratio of indices (1: it passes straight on), a number in [0, 1) that
   * decides between reflection and transmission, and the size of what is met, for the offset. */
  __attribute__((aligned(64))) float d[3][ABBE_RAY_LANES];
  float p[3][ABBE_RAY_LANES], n[3][ABBE_RAY_LANES], ng[3][ABBE_RAY_LANES];
  float eta[ABBE_RAY_LANES], chance[ABBE_RAY_LANES], size[ABBE_RAY_LANES];
  /* Out: Fresnel's reflectance, whether it is reflected, and the ray that goes on. */
  float share[ABBE_RAY_LANES];
  int reflects[ABBE_RAY_LANES];
  float out[3][ABBE_RAY_LANES], from[3][ABBE_RAY_LANES];
} abbe_scatter;

/* All lanes, whether they hold a path or not. */
void abbe_scatter_packet(abbe_scatter *s);

#ifdef __cplusplus
}
#endif
#endif
