#include "scenes/view/coverage.h"

#include "base/maths.h"
#include "scenes/mesh/bvh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The corners of all objects' faces. */
static abbe_result gather(const abbe_scene *scene, double (**out)[9], size_t *count,
                          abbe_error *error) {
  *count = 0;
  for (size_t i = 0; i < scene->object_count; i++) *count += scene->object[i].mesh.face_count;
  *out = malloc((*count + 1) * sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu faces", *count);
  double(*at)[9] = *out;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_mesh *m = &scene->object[i].mesh;
    for (size_t f = 0; f < m->face_count; f++, at++)
      for (int k = 0; k < 3; k++)
        memcpy(*at + 3 * k, m->position[m->face[f][k]], 3 * sizeof(double));
  }
  return ABBE_OK;
}

/* Right, up and forward. */
static void look(const abbe_camera *camera, double axis[3][3]) {
  abbe_vector_subtract(camera->target, camera->eye, axis[2]);
  abbe_vector_normalise(axis[2]);
  abbe_vector_cross(axis[2], camera->up, axis[0]);
  abbe_vector_normalise(axis[0]);
  abbe_vector_cross(axis[0], axis[2], axis[1]);
}

abbe_result abbe_coverage_make(const abbe_scene *scene, size_t width, size_t height, size_t samples,
                               abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"A"};
  double(*triangle)[9] = NULL, axis[3][3];
  size_t count = 0;
  abbe_bvh bvh = {0};
  memset(out, 0, sizeof *out);
  if (samples < 1 || samples > 16)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "1 to 16 samples a pixel's side, not %zu",
                          samples);
  abbe_result result = gather(scene, &triangle, &count, error);
  if (result == ABBE_OK) result = abbe_image_make(width, height, 1, names, out, error);
  if (result == ABBE_OK && count > 0)
    result = abbe_bvh_make((const double(*)[9])triangle, count, &bvh, error);
  look(&scene->camera, axis);
  const double tangent = tan(0.5 * scene->camera.fov_y_rad);
  const double wide = (double)(width * samples), high = (double)(height * samples);
  for (size_t y = 0; y < height * samples && result == ABBE_OK && count > 0; y++)
    for (size_t x = 0; x < width * samples; x++) {
      const double right = tangent * (2 * ((double)x + 0.5) - wide) / high;
      const double up = tangent * (high - 2 * ((double)y + 0.5)) / high;
      double d[3];
      abbe_bvh_hit hit;
      for (int k = 0; k < 3; k++) d[k] = axis[2][k] + right * axis[0][k] + up * axis[1][k];
      if (abbe_bvh_trace(&bvh, (const double(*)[9])triangle, scene->camera.eye, d, 0, 0, INFINITY,
                         &hit))
        out->data[y / samples * width + x / samples] += 1.0f / (float)(samples * samples);
    }
  abbe_bvh_free(&bvh);
  free(triangle);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
