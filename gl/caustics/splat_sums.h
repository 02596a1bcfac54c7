/* splat_sums.h: adds splats to the sums of a map on the processor's own threads, as
 * photon_splat.comp does on the device, where the device is that processor: without atomics, with
 * all vector units full, and without a list of all of them. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_SPLAT_SUMS_H
#define ABBE_GL_CAUSTICS_SPLAT_SUMS_H

#include "base/error.h"
#include "gl/scene/receiver_tiles.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ABBE_SPLAT_WORDS = 12 }; /* of a splat on the list (splat_list.glsl) */

/* What such a splat says (splat_list.glsl), in texels of the finest level and units of the map. */
typedef struct abbe_splat {
  float centre[2], across[2], shift[2], skew[2], off[3][2], narrow, to_next;
  uint32_t units[3];
  int32_t level, tile; /* tile: its number + 1; 0: none */
} abbe_splat;

/* MapSums of photon_splat.comp. */
typedef struct abbe_splat_sums {
  uint32_t *word;
  size_t side, texels; /* of a row of the finest level; of all levels */
  bool wide, edges;
  const abbe_receiver_tiles *tiles; /* NULL: no splat lies on one */
} abbe_splat_sums;

/* Where splats come from: list() writes those of `step` items from `first` on, at most `most`, and
 * returns how many; it adds to `entry` what it is to know of them. */
typedef struct abbe_splat_source {
  size_t (*list)(const void *from, size_t first, abbe_splat *splats, int64_t entry[3]);
  const void *from;
  size_t count, step, most;
} abbe_splat_source;

/* entry grows. goes_on is asked every few milliseconds, and ends it where false; NULL: it goes on.
 * ABBE_NO_MEMORY. */
abbe_result abbe_splat_sums_add(const abbe_splat_sums *sums, const abbe_splat_source *source,
                                int64_t entry[3], bool (*goes_on)(void *user), void *user,
                                abbe_error *error);

#endif
