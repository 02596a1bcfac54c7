/* splat_sums.h: adds listed splats to the sums of a map on the processor's own threads, as
 * photon_splat.comp does on the device, where the device is that processor: without atomics and
 * with all vector units full. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_SPLAT_SUMS_H
#define ABBE_GL_CAUSTICS_SPLAT_SUMS_H

#include "gl/scene/receiver_tiles.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ABBE_SPLAT_WORDS = 12 }; /* of a splat on the list (splat_list.glsl) */

/* MapSums of photon_splat.comp. */
typedef struct abbe_splat_sums {
  uint32_t *word;
  size_t side, texels; /* of a row of the finest level; of all levels */
  bool wide, edges;
  const abbe_receiver_tiles *tiles; /* NULL: no splat lies on one */
} abbe_splat_sums;

/* goes_on is asked every few milliseconds, and ends it where false; NULL: it goes on. */
void abbe_splat_sums_add(const abbe_splat_sums *sums, const uint32_t *splats, size_t count,
                         bool (*goes_on)(void *user), void *user);

#endif
