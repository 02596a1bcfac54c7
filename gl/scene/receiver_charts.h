/* receiver_charts.h: the charts of a plan's receivers, numbered through.
 *
 * Parallelograms come first, as the shaders count them, then the charts of meshes
 * (scenes/mesh/mesh_charts.h). It knows no light and no GL.
 */
#ifndef ABBE_GL_SCENE_RECEIVER_CHARTS_H
#define ABBE_GL_SCENE_RECEIVER_CHARTS_H

#include "base/error.h"
#include "gl/plan/plan.h"
#include "scenes/scene.h"

#include <stddef.h>
#include <stdint.h>

typedef struct abbe_receiver_charts {
  size_t count;
  double (*parallelogram)[9]; /* [count] corner, U, V */
  size_t *object;             /* [count] the scene's */
  size_t face_count;
  size_t *face_first; /* [receiver_count + 1] of each receiver among all faces */
  int32_t *face_side; /* [face_count] 2 * chart, + 1 where the face's normal points against U x V */
} abbe_receiver_charts;

/* ABBE_NO_MEMORY, ABBE_UNSUPPORTED for more faces or charts than can be numbered. */
abbe_result abbe_receiver_charts_make(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_receiver_charts *out, abbe_error *error);
void abbe_receiver_charts_free(abbe_receiver_charts *charts);

#endif
