/* ply_strips.h: PLY files whose faces are triangle strips, as Cyberware's scanners wrote them.
 *
 * assimp takes one triangle of each strip, so these are read here: positions and strips, in text or
 * binary of either order. Everything else in the file is passed over.
 */
#ifndef ABBE_SCENES_MESH_PLY_STRIPS_H
#define ABBE_SCENES_MESH_PLY_STRIPS_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The triangles of all strips, positions as in the file, normals zero. data is the whole file, with
 * a zero byte past its end; path stands in messages. ABBE_PARSE for a header or a body that is not
 * whole, ABBE_GEOMETRY for vertices that are not there or not finite, or a file without triangles,
 * ABBE_NO_MEMORY. */
abbe_result abbe_ply_read_strips(const char *data, size_t size, const char *path, abbe_mesh *out,
                                 abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
