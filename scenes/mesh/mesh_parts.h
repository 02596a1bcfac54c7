/* mesh_parts.h: what the sources behind mesh.h share. Internal to scenes/. */
#ifndef ABBE_SCENES_MESH_MESH_PARTS_H
#define ABBE_SCENES_MESH_MESH_PARTS_H

#include "scenes/mesh/mesh.h"
#include "scenes/mesh/topology.h"

#include <stddef.h>
#include <stdint.h>

/* A normal for every corner of every face, by the angles between faces: corner[3 f + k]. */
abbe_result abbe_mesh_crease_normals(const abbe_mesh *mesh, const abbe_topology *topology,
                                     double (*corner)[3], abbe_error *error);

/* Vertices anew: one for each point, normal and texture coordinate that corners have. point: of
 * each vertex, as the topology numbers them. */
abbe_result abbe_mesh_take_normals(abbe_mesh *mesh, const uint32_t *point,
                                   const double (*corner)[3], abbe_error *error);

/* The unit vector, turned to the face's side; the face's own where it is none or grazes it. */
void abbe_mesh_fair_normal(const double normal[3], const double face[3], double out[3]);

/* Whether a face has no usable normal: its height is under 1e-9 of its longest side. tip: the
 * corner opposite that side. */
bool abbe_mesh_is_sliver(const double *const corner[3], int *tip);

/* abbe_mesh_check of a mesh whose topology is known. */
abbe_result abbe_mesh_check_known(const abbe_mesh *mesh, const abbe_topology *topology,
                                  abbe_mesh_report *report, abbe_error *error);

/* The diagonal of the bounds; centre: their middle, may be NULL. There is a vertex. */
double abbe_mesh_diagonal(const abbe_mesh *mesh, double centre[3]);

/* Drops vertices that no face names. */
abbe_result abbe_mesh_drop_unused(abbe_mesh *mesh, abbe_error *error);

/* Makes a copy of a mesh with open edges, in which corners that lie a little apart are one, if that
 * closes it, by the least of a few shares of its size up to 3e-4, with its topology. *moved counts
 * the points that moved, by *farthest at most, in the mesh's own unit; 0, and no copy, where that
 * does not close it. */
abbe_result abbe_mesh_join_corners(const abbe_mesh *mesh, const abbe_topology *topology,
                                   abbe_mesh *joined, abbe_topology *own, size_t *moved,
                                   double *farthest, abbe_error *error);

/* Steps of fixing, over a mesh of one vertex a point. */

/* Drops faces that are there twice and counts them; those that lie on one another back to back
 * stay. */
abbe_result abbe_mesh_drop_doubles(abbe_mesh *mesh, size_t *doubles, abbe_error *error);

/* Closes holes by a fan where that is safe. *widest: the longest side of the widest one's bounds,
 * in the mesh's own unit. */
abbe_result abbe_mesh_close_holes(abbe_mesh *mesh, size_t *closed, double *widest,
                                  abbe_error *error);

#endif
