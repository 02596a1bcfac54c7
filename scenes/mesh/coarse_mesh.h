/* coarse_mesh.h: a smooth mesh by fewer triangles, for pictures that are drawn in a hurry.
 *
 * Vertices are merged cell by cell of a grid; each group is stood for by that vertex of it which is
 * nearest to its middle [RossignacBorrel1993]. So what is left lies on the surface, with its
 * normals. Vertices of a cell that look away from each other are two groups: the sides of a thin
 * wall stay apart. Where two vertices stand at the same place, along a seam of normals, they stay
 * as they are. It has no bound on its error but the cells' size.
 */
#ifndef ABBE_SCENES_MESH_COARSE_MESH_H
#define ABBE_SCENES_MESH_COARSE_MESH_H

#include "scenes/mesh/mesh.h"

/* About as many triangles as that are left, or more where a mesh is much folded. */
#define ABBE_COARSE_MESH_FACES 24000u

/* Whether it has many triangles and is smooth, but for some seams. */
bool abbe_coarse_mesh_serves(const abbe_mesh *mesh);

/* Triangles of the mesh's own vertices: *face is malloc'd, *count of them. What is seen of a closed
 * mesh has no holes; triangles that would lie folded between others are left out. NULL and 0 for a
 * mesh of which that saves less than half, and for one that it does not serve. ABBE_NO_MEMORY. */
abbe_result abbe_coarse_mesh_make(const abbe_mesh *mesh, uint32_t (**face)[3], size_t *count,
                                  abbe_error *error);

#endif
