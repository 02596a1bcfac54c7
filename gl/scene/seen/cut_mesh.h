/* cut_mesh.h: a mesh as a perspective view shows it, where some of its faces reach from close by to far
 * away: such faces are clipped to the window and cut where depth has grown sixteenfold. Single precision
 * interpolates places on each part as well as it knows them. Knows no GL. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SEEN_CUT_MESH_H
#define ABBE_GL_SCENE_SEEN_CUT_MESH_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"
#include "scenes/view/view.h"

/* Whether it has a face whose depth grows more than that in front of the view. min and max: bounds. */
bool abbe_cut_mesh_needed(const abbe_mesh *mesh, const double min[3], const double max[3],
                          const abbe_view *view);

/* Its vertices, and those of the parts behind them; faces that are not cut, in their order, and then the
 * parts of the others. Parts next to each other share their corners to the bit. *face_of: of each face
 * of `out` the mesh's own; malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_cut_mesh_make(const abbe_mesh *mesh, const abbe_view *view, abbe_mesh *out,
                               uint32_t **face_of, abbe_error *error);

#endif
