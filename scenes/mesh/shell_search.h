/* shell_search.h: what the search for how shells lie (scenes/mesh/shells.c) works with.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_MESH_SHELL_SEARCH_H
#define ABBE_SCENES_MESH_SHELL_SEARCH_H

#include "scenes/mesh/shells.h"
#include "scenes/mesh/topology.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What is needed while they are looked at. */
typedef struct abbe_shell_search {
  const abbe_topology *t;
  double (*triangle)[9]; /* [face_count] */
  double tolerance;
  abbe_shells *out;
  size_t room; /* for crossings */
  uint64_t work, most_work;
  bool within; /* crossings are looked for within shells, else between them */
  bool no_memory;
} abbe_shell_search;

/* Out of memory, or past the work that it may do. */
static inline bool abbe_shell_search_gives_up(const abbe_shell_search *s) {
  return s->no_memory || s->work > s->most_work;
}

/* ---- a tree of boxes, each over half of the faces of the one above ---- */

typedef struct abbe_shell_box {
  double low[3], high[3];
} abbe_shell_box;

enum { ABBE_SHELL_LEAF = 4 }; /* faces */

typedef struct abbe_shell_tree {
  uint32_t *face;          /* [count] in the order of the leaves */
  abbe_shell_box *of_face; /* [face_count] */
  abbe_shell_box *node;    /* node i is over the faces of 2 i + 1 and 2 i + 2 */
  uint32_t *shell;         /* shell of all faces of the node; ABBE_TOPOLOGY_NONE: of several */
} abbe_shell_tree;

/* A node and the faces that it is over. */
typedef struct abbe_shell_part {
  size_t node, first, last;
} abbe_shell_part;

/* False where memory ran out; it is freed all the same. */
bool abbe_shell_tree_make(const abbe_shell_search *s, abbe_shell_tree *t);
void abbe_shell_tree_free(abbe_shell_tree *t);

static inline abbe_shell_part abbe_shell_part_child(abbe_shell_part p, int which) {
  const size_t half = (p.first + p.last) / 2;
  p.node = 2 * p.node + 1 + (size_t)which;
  if (which == 0)
    p.last = half;
  else
    p.first = half;
  return p;
}

static inline bool abbe_shell_boxes_meet(const abbe_shell_box *a, const abbe_shell_box *b) {
  for (int k = 0; k < 3; k++)
    if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
  return true;
}

/* ---- what is looked for ---- */

/* Adds the crossings of faces within shells, or of those of different shells, as they are met. */
void abbe_shell_find_crossings(abbe_shell_search *s, const abbe_shell_tree *t, bool within);
/* Puts them in order, each pair once. */
void abbe_shell_sort_crossings(abbe_shells *out);
/* Fills around, and with it depths; false where memory ran out. */
bool abbe_shell_find_nesting(abbe_shell_search *s, const abbe_shell_tree *t);

#endif
