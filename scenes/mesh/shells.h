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

#endif
