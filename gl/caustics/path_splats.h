/* path_splats.h: lists the splats of photons' paths on the processor's own threads, as
 * photon_deposit.comp does on the device, where the device is that processor. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_PATH_SPLATS_H
#define ABBE_GL_CAUSTICS_PATH_SPLATS_H

#include "gl/caustics/splat_sums.h"
#include "gl/light/photon_start.h"

enum { ABBE_PATHS = 8 };      /* that are laid side by side */
enum { ABBE_PATH_TINTS = 3 }; /* stuffs of which a hit says how much its path passed, at most */

/* What photon_deposit.comp reads, by its names. */
typedef struct abbe_path_splats {
  const float (*hits)[4], (*node_hits)[4], (*intervals)[4], (*tints)[4], (*warp)[4];
  const uint32_t *signatures, *node_signatures, *photon_of_cell, *wants, *pairs, *paths;
  const abbe_photon *photons;
  const int *coarse_node; /* the wavelength of each of the coarse set */
  float tile[ABBE_RECEIVER_TILES][ABBE_TILE_FLOATS], view[24]; /* view: the map's */
  size_t count;                                                /* paths */
  size_t light, refractors, slots, stride, signature_words, tint_count, interval_texels;
  size_t table_first; /* rows of `intervals` before those of these nodes */
  int grid[2], map_size, map_levels, warp_steps, steps;
  int sample_first, sample_count, interval_first, interval_end, nodes, fine_nodes;
  float unit, ledger_unit; /* W */
  float depth[4];          /* of the view: what its places are divided by */
  bool bridges, doubts;
} abbe_path_splats;

/* The splats of ABBE_PATHS paths, at the most. */
size_t abbe_path_splats_most(const abbe_path_splats *paths);
/* An abbe_splat_source's, of the paths from `first` on. The entry: interpolated, absorbed and
 * missed, in ledger_unit. */
size_t abbe_path_splats_list(const void *paths, size_t first, abbe_splat *splats, int64_t entry[3]);

#endif
