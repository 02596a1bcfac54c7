#include "scenes/mesh/edge_collapse.h"
#include "scenes/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Around the first vertex, so that a mesh far from the origin keeps its digits. */
static void to_floats(const abbe_mesh *mesh, float (*out)[3]) {
  for (size_t i = 0; i < mesh->vertex_count; i++)
    for (int k = 0; k < 3; k++) out[i][k] = (float)(mesh->position[i][k] - mesh->position[0][k]);
}

abbe_result abbe_mesh_simplify(const abbe_mesh *mesh, double distance_m, uint32_t (**face)[3],
                               size_t *count, abbe_error *error) {
  ABBE_REQUIRE(mesh && face && count, error);
  *face = NULL;
  *count = 0;
  if (!(distance_m >= 0) || !isfinite(distance_m))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a mesh cannot be simplified to within %g m; it may be 0 and more",
                          distance_m);
  uint32_t(*out)[3] = calloc(mesh->face_count + 1, sizeof *out);
  float(*position)[3] = calloc(mesh->vertex_count + 1, sizeof *position);
  size_t kept = 3 * mesh->face_count;
  bool done = out != NULL && position != NULL;
  if (done && distance_m > 0 && mesh->face_count > 0) {
    to_floats(mesh, position);
    done = abbe_edge_collapse(mesh->face[0], kept, (const float(*)[3])position, mesh->vertex_count,
                              distance_m, out[0], &kept);
  } else if (done && mesh->face_count > 0) {
    memcpy(out, mesh->face, mesh->face_count * sizeof *out);
  }
  free(position);
  if (!done) {
    free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to simplify a mesh of %zu faces",
                          mesh->face_count);
  }
  *face = out;
  *count = kept / 3;
  return ABBE_OK;
}
