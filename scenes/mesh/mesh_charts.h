/* mesh_charts.h: charts of a mesh: parts that can be laid out flat, each seen from one direction.
 *
 * A chart is what hangs together by edges of faces whose normals lie within 60 degrees of one of
 * the six axes, so a place on it follows from its projection along that axis unless the chart winds
 * over itself. Every face belongs to one chart. It knows no textures and no light.
 */
#ifndef ABBE_SCENES_MESH_MESH_CHARTS_H
#define ABBE_SCENES_MESH_MESH_CHARTS_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>
#include <stdint.h>

typedef struct abbe_mesh_charts {
  size_t count; /* 0 where no face has an area */
  /* [count] corner, U, V: the rectangle that bounds it, across its axis; U x V points along that, to
   * the side that the normals point to */
  double (*parallelogram)[9];
  uint32_t *face; /* [face_count] chart of each; faces without an area are of the first */
} abbe_mesh_charts;

/* ABBE_INVALID_ARGUMENT for what abbe_topology_make refuses, ABBE_NO_MEMORY. */
abbe_result abbe_mesh_charts_make(const abbe_mesh *mesh, abbe_mesh_charts *out, abbe_error *error);
void abbe_mesh_charts_free(abbe_mesh_charts *charts);

#endif
