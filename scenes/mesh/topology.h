/* topology.h: which vertices of a mesh are one point, which faces share an edge, what hangs
 * together.
 *
 * Vertices within 1e-9 of the bounds' diagonal count as one point, so that meshes whose vertices
 * are split by normal or texture are still seen as closed. Where bodies touch along an edge, more
 * than two faces meet there: they belong together by pairs that have a body between them. Expected
 * time is linear in the mesh. It reads a mesh and changes nothing. Internal to scenes/.
 */
#ifndef ABBE_SCENES_MESH_TOPOLOGY_H
#define ABBE_SCENES_MESH_TOPOLOGY_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_TOPOLOGY_NONE UINT32_MAX

typedef struct abbe_edge {
  uint32_t a, b;           /* points, a < b */
  uint32_t along, against; /* faces that run from a to b, and from b to a */
  uint32_t face[2];        /* the first two of its faces, or ABBE_TOPOLOGY_NONE */
  bool touches;            /* it has more than two, in pairs around the bodies that touch there */
} abbe_edge;

typedef struct abbe_topology {
  size_t point_count, face_count, edge_count, shell_count;
  uint32_t *point;          /* [vertex_count] the point a vertex stands at */
  double (*position)[3];    /* [point_count] */
  uint32_t (*face)[3];      /* [face_count] as points */
  uint32_t (*face_edge)[3]; /* [face_count] edge from corner k to k + 1; ABBE_TOPOLOGY_NONE for
                               faces with repeated points */
  abbe_edge *edge;          /* [edge_count] */
  uint32_t *shell;          /* [face_count] what hangs together over edges */
} abbe_topology;

/* ABBE_INVALID_ARGUMENT for indices outside the mesh or positions that are not finite. */
abbe_result abbe_topology_make(const abbe_mesh *mesh, abbe_topology *out, abbe_error *error);
void abbe_topology_free(abbe_topology *topology);

#endif
