#include "gl/scene/camera_view.h"

#include <math.h>
#include <string.h>

/* Mesa's llvmpipe compiles shaders anew for textures whose sides become powers of two, or are so no
 * longer: those of pictures that follow each other in other sizes never are. */
static size_t room_for(size_t samples, bool coarse) {
  while (coarse && (samples & (samples - 1)) == 0) samples++;
  return samples;
}

/* A light with a size is seen. */
static void fit_light(const abbe_light *light, abbe_view *view) {
  if (!abbe_light_has_size(light)) return;
  const abbe_scene alone = {.light = (abbe_light *)light, .light_count = 1};
  double end[2][3] = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  double corner[8][3];
  abbe_scene_hold_lights(&alone, end[0], end[1]);
  for (int k = 0; k < 24; k++) corner[k / 3][k % 3] = end[k / 3 >> k % 3 & 1][k % 3];
  abbe_view_fit(view, (const double(*)[3])corner, 8);
}

void abbe_camera_view_fit(const abbe_scene *scene, const abbe_render_desc *desc,
                          abbe_camera_view *out) {
  const size_t pixels[2] = {desc->width, desc->height};
  const abbe_camera *camera = &scene->camera;
  double forward[3];
  for (int axis = 0; axis < 2; axis++) {
    out->samples[axis] = (pixels[axis] * desc->supersample + desc->upsample - 1) / desc->upsample;
    out->receiver_samples[axis] =
        desc->receiver_samples == 1 && desc->supersample > 1 ? pixels[axis] : out->samples[axis];
    const bool coarse = desc->coarse != ABBE_COARSE_NONE;
    out->room[axis] = room_for(out->samples[axis], coarse);
    out->receiver_room[axis] = room_for(out->receiver_samples[axis], coarse);
  }
  for (int k = 0; k < 3; k++) forward[k] = camera->target[k] - camera->eye[k];
  abbe_view_look(camera->eye, forward, camera->up, false, &out->view);
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    double corner[8][3];
    for (int k = 0; k < 24; k++)
      corner[k / 3][k % 3] = (k / 3 >> k % 3) & 1 ? o->max[k % 3] : o->min[k % 3];
    abbe_view_fit(&out->view, (const double(*)[3])corner, 8);
  }
  for (size_t i = 0; i < scene->light_count; i++) fit_light(&scene->light[i], &out->view);
  abbe_view_pad(&out->view, 0.01);
  double y = tan(0.5 * camera->fov_y_rad);
  double x = y * (double)desc->width / (double)desc->height;
  /* Whole samples, the last of which may stand for pixels beyond the picture. */
  const double side = (double)desc->upsample / (double)desc->supersample;
  const double wide = side * 2 * x / (double)desc->width;
  const double high = side * 2 * y / (double)desc->height;
  const double left = wide * desc->sample_shift[0] - x;
  const double bottom = high * desc->sample_shift[1] - y;
  const double window[4] = {left, left + wide * (double)out->samples[0], bottom,
                            bottom + high * (double)out->samples[1]};
  memcpy(out->view.window, window, sizeof window);
}
