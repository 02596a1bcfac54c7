/* sphere_mesh.h: the unit sphere cut into triangles by great circles: a subdivided icosahedron, or
 * the octahedral map's texels; which of them a direction meets, by a table.
 *
 * It holds directions and no light. Internal to scenes/volume/.
 */
#ifndef ABBE_SCENES_VOLUME_SPHERE_MESH_H
#define ABBE_SCENES_VOLUME_SPHERE_MESH_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_SPHERE_MESH_MOST_LEVELS 6 /* 40962 corners, 81920 faces */
#define ABBE_SPHERE_MESH_MOST_SIDE 256

typedef struct abbe_sphere_mesh {
  size_t corner_count, face_count;
  double (*corner)[3];  /* [corner_count] unit */
  uint32_t (*face)[3];  /* [face_count] corners, anticlockwise from outside */
  uint32_t (*next)[3];  /* [face_count] the face beyond the edge from corner k to k + 1 */
  double (*edge)[3][3]; /* [face_count] unit normals of those edges' planes, to the inside */
  size_t table_side;    /* side of the octahedral table */
  uint32_t *table;      /* [table_side^2] the face in the middle of each texel */
} abbe_sphere_mesh;

/* An icosahedron whose faces are cut into four `levels` times: 20 * 4^levels faces. */
abbe_result abbe_sphere_mesh_geodesic(size_t levels, abbe_sphere_mesh *out, abbe_error *error);
/* Two triangles, 2 i and 2 i + 1, for each texel i of the octahedral map with so many texels a
 * side, an even number: then the map's folds are edges. */
abbe_result abbe_sphere_mesh_octahedral(size_t side, abbe_sphere_mesh *out, abbe_error *error);
/* Both: ABBE_INVALID_ARGUMENT beyond the limits above, ABBE_NO_MEMORY. */
void abbe_sphere_mesh_free(abbe_sphere_mesh *mesh);

/* The face that holds the direction, of any length but 0: from the table's on, over edges. */
size_t abbe_sphere_mesh_find(const abbe_sphere_mesh *mesh, const double d[3]);
/* The table's, which near an edge may be the face beside it. */
size_t abbe_sphere_mesh_look_up(const abbe_sphere_mesh *mesh, const double d[3]);
/* Weights of a face's corners whose sum lies along d; they sum to 1, and on an edge they are the
 * same from both sides. */
void abbe_sphere_mesh_weights(const abbe_sphere_mesh *mesh, size_t face, const double d[3],
                              double weight[3]);
/* Solid angle of a face, sr [VanOosteromStrackee1983]. */
double abbe_sphere_mesh_area(const abbe_sphere_mesh *mesh, size_t face);

/* The octahedral map: a direction to [-1, 1]^2, and back to a unit vector. */
void abbe_octahedral_place(const double d[3], double uv[2]);
void abbe_octahedral_direction(const double uv[2], double d[3]);

/* Directions to a light for which caustics are computed beforehand, spread evenly over the sphere,
 * and which of them stand for any other direction [WymanHansenShirley2003]. */

#define ABBE_LIGHT_NODES_MOST 2562

/* The corners of a subdivided icosahedron, or one direction alone, for what looks the same from all
 * sides. */
typedef struct abbe_light_nodes {
  size_t count;
  double (*direction)[3]; /* [count] unit, from the object to the light */
  abbe_sphere_mesh mesh;  /* whose corners they are; of one node empty */
} abbe_light_nodes;

/* Nodes whose weights sum to 1. */
typedef struct abbe_node_blend {
  size_t count; /* 1 to 3 */
  size_t node[3];
  double weight[3];
} abbe_node_blend;

/* 1 node, along `axis`, or 12, 42, 162, 642 or 2562. ABBE_INVALID_ARGUMENT for other counts,
 * ABBE_NO_MEMORY. */
abbe_result abbe_light_nodes_make(size_t count, const double axis[3], abbe_light_nodes *out,
                                  abbe_error *error);
void abbe_light_nodes_free(abbe_light_nodes *nodes);

/* For a unit direction to the light: the node nearest to it; or the corners of its triangle, by
 * their weights. */
void abbe_light_nodes_nearest(const abbe_light_nodes *nodes, const double to_light[3],
                              abbe_node_blend *out);
void abbe_light_nodes_blend(const abbe_light_nodes *nodes, const double to_light[3],
                            abbe_node_blend *out);

/* The turn about to_light x node, by the angle between them, that brings to_light to the node:
 * row-major; of opposite directions about any axis across them. */
void abbe_light_nodes_turn(const double to_light[3], const double node[3], double turn[9]);

#endif
