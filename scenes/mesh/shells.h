/* shells.h: how the closed shells of a mesh lie to one another: which is inside which, and which
 * cross.
 *
 * A shell is what hangs together over edges (topology.h). One that lies in an odd number of others
 * bounds a hollow, one in an even number a body; bodies that cross are no one solid until they are
 * shared out among several meshes, or united. Crossings shallower than 1e-6 of the bounds' diagonal
 * count as touching. Faces of two shells that lie on one another, back to back or flush, are no
 * crossing, but no one solid either. It reads a mesh and changes nothing. Internal to scenes/mesh/.
 */
#ifndef ABBE_SCENES_MESH_SHELLS_H
#define ABBE_SCENES_MESH_SHELLS_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/topology.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct abbe_shell {
  double volume;        /* signed, of its own; negative: its faces look inwards */
  uint32_t depth;       /* number of shells that it lies wholly within */
  uint32_t first, last; /* range of these in abbe_shells.around, last is one past them */
  uint32_t solid;       /* which of the solids it belongs to */
} abbe_shell;

typedef struct abbe_shells {
  size_t count;
  abbe_shell *shell;       /* [count], as the topology numbers them */
  uint32_t *around;        /* the shells around each */
  size_t crossing_count;   /* pairs of shells that cross, or have faces that lie on one another */
  uint32_t (*crossing)[2]; /* [crossing_count] in order, the lesser first */
  double place[3];         /* where the first that was found do */
  size_t flush_count;      /* pairs of faces of different shells that lie on one another */
  size_t self_count;       /* pairs of faces of one shell that cross */
  double self_place[3];    /* where the first that was found do */
  size_t solid_count;      /* least number found of solids within which no shells cross */
} abbe_shells;

/* The mesh is closed, and each shell consistently oriented, outwards or inwards. ABBE_GEOMETRY
 * where hollows cross, so that solids are ambiguous, with the place. ABBE_UNSUPPORTED where so many
 * faces and shells cross or nest that it would take too long. ABBE_NO_MEMORY. */
abbe_result abbe_shells_find(const abbe_mesh *mesh, const abbe_topology *topology, abbe_shells *out,
                             abbe_error *error);
void abbe_shells_free(abbe_shells *shells);

/* What the search for how shells lie (scenes/mesh/shells.c) works with. */

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
