/* exit_map.h: a map that light is laid on at places, and what it is of tents of one width in place
 * of places. Of light it knows four channels. Internal to scenes/.
 */
#ifndef ABBE_SCENES_VOLUME_EXITS_EXIT_MAP_H
#define ABBE_SCENES_VOLUME_EXITS_EXIT_MAP_H

#include <stdbool.h>
#include <stddef.h>

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

/* What was added as a sum of tents of that half width each way, in texels; at the ends they are
 * folded back, so that the sum stays. Places are as wide as 1.2 already; of wider tents than a map
 * has room for it makes the widest. side: up to ABBE_EXIT_MAP_MOST_SIDE. */
#define ABBE_EXIT_MAP_MOST_SIDE 1024
void abbe_exit_map_smooth(const float (*from)[4], size_t side, const float wide[2], float (*to)[4]);

#endif
