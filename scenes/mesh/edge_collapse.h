/* edge_collapse.h: fewer faces, through meshoptimizer. Internal to scenes/.
 *
 * The implementation is the C++ bridge edge_collapse.cpp; mesh_simplify.c is what others call.
 */
#ifndef ABBE_SCENES_MESH_EDGE_COLLAPSE_H
#define ABBE_SCENES_MESH_EDGE_COLLAPSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Collapses edges of the triangles index[count / 3][3] as long as the quadrics' distance stays
 * below distance_m [GarlandHeckbert1997]; out has room for count. Returns in *kept how many indices
 * are left. False: no memory. */
bool abbe_edge_collapse(const uint32_t *index, size_t count, const float (*position)[3],
                        size_t vertices, double distance_m, uint32_t *out, size_t *kept);

#ifdef __cplusplus
}
#endif
#endif
