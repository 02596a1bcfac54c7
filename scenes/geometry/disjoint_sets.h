/* disjoint_sets.h: a forest over numbers from 0, of which each tree is a set (union-find). It owns
 * no memory: parent[i] begins as i. Internal to scenes/. */
#ifndef ABBE_SCENES_GEOMETRY_DISJOINT_SETS_H
#define ABBE_SCENES_GEOMETRY_DISJOINT_SETS_H

#include <stdint.h>

/* The number that stands for the set of x; paths to it are halved as they are followed. */
static inline uint32_t abbe_disjoint_sets_find(uint32_t *parent, uint32_t x) {
  while (parent[x] != x) x = parent[x] = parent[parent[x]];
  return x;
}

/* Joins the sets of a and b; b's stands for both. */
static inline void abbe_disjoint_sets_unite(uint32_t *parent, uint32_t a, uint32_t b) {
  parent[abbe_disjoint_sets_find(parent, a)] = abbe_disjoint_sets_find(parent, b);
}

#endif
