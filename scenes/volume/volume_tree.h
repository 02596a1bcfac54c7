/* volume_tree.h: the cells of a block of a volume joined where they hold nearly the same: several
 * resolutions in one [WymanHansenShirley2003].
 *
 * Neighbours are joined by fours in a shell and by eights in a grid, and what is joined again, as
 * long as no cell's value changes by more than a tolerance; the joint value is their mean by
 * volume, so that flux is kept. Internal to scenes/volume/.
 */
#ifndef ABBE_SCENES_VOLUME_VOLUME_TREE_H
#define ABBE_SCENES_VOLUME_VOLUME_TREE_H

#include "scenes/volume/volume_region.h"

/* An order of cells in which those that may be joined follow each other. */
typedef struct abbe_volume_order {
  size_t cells, branch; /* 4 or 8 that are joined at a time */
  size_t levels;        /* how often at the most */
  uint32_t *place;      /* [cells] of a cell */
  double *volume;       /* [cells] by place, m3 */
} abbe_volume_order;

/* ABBE_INVALID_ARGUMENT where a grid or an octahedral map has not a power of two cells a side;
 * ABBE_NO_MEMORY. */
abbe_result abbe_volume_order_make(const abbe_volume_region *region, abbe_volume_order *out,
                                   abbe_error *error);
void abbe_volume_order_free(abbe_volume_order *order);

/* Leaves in the order of their places: leaf i begins at first[i], and ends where the next begins.
 */
typedef struct abbe_volume_tree {
  size_t leaves;
  uint32_t *first; /* [leaves] */
  uint16_t *value; /* [leaves][channels] halves */
} abbe_volume_tree;

/* Makes a tree of halves value[cells][channels], by cell. tolerance: at least 0; with 0 cells are
 * joined that are the same, and it gives every bit back. ABBE_NO_MEMORY. */
abbe_result abbe_volume_tree_make(const abbe_volume_order *order, size_t channels,
                                  const uint16_t *value, double tolerance, abbe_volume_tree *out,
                                  abbe_error *error);
void abbe_volume_tree_free(abbe_volume_tree *tree);

/* The leaf of a cell. */
size_t abbe_volume_tree_find(const abbe_volume_tree *tree, const abbe_volume_order *order,
                             size_t cell);
/* All cells again: value[cells][channels]. */
void abbe_volume_tree_expand(const abbe_volume_tree *tree, const abbe_volume_order *order,
                             size_t channels, uint16_t *value);
/* Bytes that it takes. */
static inline size_t abbe_volume_tree_bytes(const abbe_volume_tree *tree, size_t channels) {
  return tree->leaves * (sizeof *tree->first + channels * sizeof *tree->value);
}

#endif
