/* exit_pages.h: what the rays that leave an object (exit_light.h) bring to parallelograms, as maps
 * on them: for each of their sides one of the whole and a finer one of where most of it lands.
 *
 * A ray ends at the first parallelogram that it meets, and they hide the light from the object. It
 * knows no other receivers.
 */
#ifndef ABBE_SCENES_VOLUME_EXITS_EXIT_PAGES_H
#define ABBE_SCENES_VOLUME_EXITS_EXIT_PAGES_H

#include "scenes/volume/exits/exit_light.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_EXIT_PAGES_MOST_SIDE 1024

typedef struct abbe_exit_pages {
  size_t side, count; /* texels; sides of parallelograms: 2 i is where the normal U x V of the i-th
                         points to, 2 i + 1 the other */
  float (*window)[4]; /* [count] the finer map's least u and v, 0 to 1, and 1 over its width in
                         each; widths of 0: nothing lands on that side */
  float (*value)[4]; /* [count][2][side][side] irradiance of X, Y, Z and 0, W/m2 of a light of power
                        1: of the whole without the window, and of the window */
  double flux;       /* flux of Y on all receivers, W */
} abbe_exit_pages;

/* parallelogram[parallelograms]: corner, U, V, in the world; the desc's sheets are not read.
 * ABBE_INVALID_ARGUMENT for a side beyond 1 to ABBE_EXIT_PAGES_MOST_SIDE and as
 * abbe_exit_light_colours, ABBE_NO_MEMORY. */
abbe_result abbe_exit_pages_make(const abbe_caustic_volume *volume,
                                 const abbe_exit_light_desc *desc, const double (*parallelogram)[9],
                                 size_t parallelograms, size_t side, abbe_exit_pages *out,
                                 abbe_error *error);
void abbe_exit_pages_free(abbe_exit_pages *pages);

/* A map of half as many texels a side, each the mean of 2 x 2; side is even, and `to` may not be
 * `from`. */
void abbe_exit_pages_halve(const float (*from)[4], size_t side, float (*to)[4]);

/* A map that light is laid on at places, and what it is of tents of one width in place of places.
 * Of light it knows four channels. */

/* Adds to the four texels around (x, y), texels from the map's corner; what would lie beyond its
 * ends is folded back. */
static inline void abbe_exit_map_add(float (*map)[4], int side, float x, float y,
                                     const float value[4]) {
  const float most = (float)side - 0.5f;
  x = (x < 0.5f ? 0.5f : x > most ? most : x) - 0.5f;
  y = (y < 0.5f ? 0.5f : y > most ? most : y) - 0.5f;
  const int left = (int)x, low = (int)y;
  const float across = x - (float)left, up = y - (float)low;
  float(*to)[4] = map + (size_t)low * (size_t)side + (size_t)left;
  const size_t right = left + 1 < side ? 1 : 0, above = low + 1 < side ? (size_t)side : 0;
  const float share[4] = {(1 - across) * (1 - up), across * (1 - up), (1 - across) * up,
                          across * up};
  for (int k = 0; k < 4; k++) to[0][k] += share[0] * value[k];
  for (int k = 0; k < 4; k++) to[right][k] += share[1] * value[k];
  for (int k = 0; k < 4; k++) to[above][k] += share[2] * value[k];
  for (int k = 0; k < 4; k++) to[above + right][k] += share[3] * value[k];
}

/* What was added as a sum of tents of that half width to either side, in texels; at the ends they
 * are folded back, so that the sum stays. Places are as wide as 1.2 already; of wider tents than a
 * map can hold it makes the widest. side: up to ABBE_EXIT_MAP_MOST_SIDE. */
#define ABBE_EXIT_MAP_MOST_SIDE 1024
void abbe_exit_map_smooth(const float (*from)[4], size_t side, const float wide[2], float (*to)[4]);

#endif
