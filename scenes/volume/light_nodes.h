/* light_nodes.h: directions to a light for which caustics are computed beforehand, spread evenly
 * over the sphere, and which of them stand for any other direction [WymanHansenShirley2003].
 * Internal to scenes/volume/.
 */
#ifndef ABBE_SCENES_VOLUME_LIGHT_NODES_H
#define ABBE_SCENES_VOLUME_LIGHT_NODES_H

#include "scenes/volume/sphere_mesh.h"

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
