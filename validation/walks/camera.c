#include "validation/walks/camera.h"

#include "scenes/geometry/transform.h"

void abbe_trace_camera_make(const abbe_geometry *geometry, size_t width, size_t height,
                            abbe_trace_camera *out) {
  const abbe_camera *c = &geometry->scene->camera;
  double view[16];
  abbe_transform_look_at(c->eye, c->target, c->up, view);
  *out = (abbe_trace_camera){.width = width, .height = height};
  abbe_geometry_to_frame(geometry, c->eye, out->eye);
  for (int k = 0; k < 3; k++) {
    out->right[k] = (float)view[4 * k];
    out->up[k] = (float)view[4 * k + 1];
    out->forward[k] = (float)-view[4 * k + 2];
  }
  double tangent = tan(0.5 * c->fov_y_rad);
  out->half_height = (float)tangent;
  out->half_width = (float)(tangent * (double)width / (double)height);
  out->pixel_area = (float)(4 * tangent * tangent / ((double)height * (double)height));
}
