/* bvh_nodes.h: a hierarchy over triangles as the shaders traverse it (hierarchy.glsl).
 *
 * Boxes stand on a grid of 16 bits over the tree, rounded outwards, and each with a cone that holds
 * the normals below it: a ray that looks for faces of one side alone leaves out what shows it the
 * other, and so what it starts from. It knows nothing of GL.
 */
#ifndef ABBE_GL_SCENE_BVH_NODES_H
#define ABBE_GL_SCENE_BVH_NODES_H

#include "scenes/mesh/bvh.h"

#include <stddef.h>
#include <stdint.h>

/* Texels of four words: two for the tree, then three for each inner node. */
size_t abbe_bvh_nodes_count(const abbe_bvh *bvh);

/* triangle: as the hierarchy was made from. The texels are the first_texel'th and following of
 * the buffer that the shaders read, the triangles, in the hierarchy's order, the first_triangle'th
 * and following; those end below 2^28, texels below 2^31. The root is first_texel.
 *
 * Tree: lowest grid point in x, y, z and, as bits, what the root leads to; width of a grid cell in
 * x, y, z. Inner node: for each of two children, its box (low | high << 16 a word, in x, y, z) and
 * what it leads to; then its cone twice, axis and sine of the half angle, snorm16: x | y << 16, z |
 * sine << 16; a sine of one leaves nothing out. Leads to: an inner node's first texel, or the
 * complement of a leaf's first triangle << 3 | count. ABBE_NO_MEMORY, ABBE_CANCELLED by the
 * thread's watch. */
abbe_result abbe_bvh_nodes_pack(const abbe_bvh *hierarchy, const double (*triangle)[9],
                                size_t first_texel, size_t first_triangle, uint32_t (*out)[4],
                                abbe_error *error);

#endif
