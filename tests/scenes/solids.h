/* solids.h: meshes for tests: boxes in one mesh, one vertex a corner, and whatever is done to them.
 */
#ifndef ABBE_TESTS_SCENES_SOLIDS_H
#define ABBE_TESTS_SCENES_SOLIDS_H

#include "tests/check.h"

#include "scenes/mesh/mesh.h"
#include "scenes/shapes/shape.h"

typedef struct test_box {
  double min[3], max[3];
  bool inwards;
} test_box;

/* Faces of a box with corners numbered by the bits of their number: x 4, y 2, z 1. */
static const uint32_t test_box_face[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5},
                                              {0, 4, 5}, {0, 5, 1}, {2, 3, 7}, {2, 7, 6},
                                              {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};

static inline abbe_mesh test_boxes(const test_box *box, size_t count) {
  abbe_mesh m;
  OK(abbe_mesh_make(8 * count, 12 * count, false, &m, &error));
  for (size_t i = 0; i < count; i++) {
    for (size_t v = 0; v < 8; v++)
      for (size_t k = 0; k < 3; k++)
        m.position[8 * i + v][k] = v >> (2 - k) & 1 ? box[i].max[k] : box[i].min[k];
    for (size_t f = 0; f < 12; f++)
      for (size_t k = 0; k < 3; k++)
        m.face[12 * i + f][k] = (uint32_t)(8 * i) + test_box_face[f][box[i].inwards ? 2 - k : k];
  }
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_SMOOTH, &error));
  return m;
}

static inline abbe_mesh test_sphere(size_t levels) {
  abbe_mesh m;
  OK(abbe_shape_sphere(1, levels, &m, &error));
  return m;
}

static inline abbe_mesh_report test_mesh_faults(const abbe_mesh *m) {
  abbe_mesh_report r;
  OK(abbe_mesh_check(m, &r, &error));
  return r;
}

static inline void test_turn_face(abbe_mesh *m, size_t f) {
  const uint32_t second = m->face[f][1];
  m->face[f][1] = m->face[f][2];
  m->face[f][2] = second;
}

#endif
