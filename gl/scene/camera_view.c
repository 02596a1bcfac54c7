#include "gl/scene/camera_view.h"

#include <math.h>
#include <string.h>

/* Mesa's llvmpipe compiles shaders anew for textures whose sides become powers of two, or are so no
 * longer: those of pictures that follow each other in other sizes never are. */
static size_t room_for(size_t samples, bool coarse) {
  while (coarse && (samples & (samples - 1)) == 0) samples++;
  return samples;
}

/* Bounds of a light that is seen: one with a size. */
static bool bound_light(const abbe_light *light, double min[3], double max[3]) {
  const abbe_scene alone = {.light = (abbe_light *)light, .light_count = 1};
  for (int k = 0; k < 3; k++) {
    min[k] = INFINITY;
    max[k] = -INFINITY;
  }
  if (abbe_light_has_size(light)) abbe_scene_hold_lights(&alone, min, max);
  return min[0] <= max[0];
}

static void fit_box(const double min[3], const double max[3], abbe_view *view) {
  double corner[8][3];
  for (int k = 0; k < 24; k++) corner[k / 3][k % 3] = (k / 3 >> k % 3 & 1 ? max : min)[k % 3];
  abbe_view_fit(view, (const double(*)[3])corner, 8);
}

static double distance_to_box(const double p[3], const double min[3], const double max[3]) {
  double square = 0;
  for (int k = 0; k < 3; k++) square += pow(fmax(fmax(min[k] - p[k], p[k] - max[k]), 0), 2);
  return sqrt(square);
}

/* From a place to an object, or to its bounds where that lies outside of them, m. */
static double distance_to(const double p[3], const abbe_object *o) {
  const double gap = distance_to_box(p, o->min, o->max);
  return gap > 0 ? gap : fabs(abbe_object_distance(o, p));
}

/* Before all that is there, which reversed depths resolve however far the scene reaches. Those of
 * the published methods do not. */
static void come_near(const abbe_scene *scene, const abbe_render_desc *desc, abbe_view *view) {
  static const double least = 1e-7;
  double gap = INFINITY, min[3], max[3];
  if (abbe_method_of(desc->profile)->own_passes) return;
  for (size_t i = 0; i < scene->object_count; i++)
    gap = fmin(gap, distance_to(scene->camera.eye, &scene->object[i]));
  for (size_t i = 0; i < scene->light_count; i++)
    if (bound_light(&scene->light[i], min, max))
      gap = fmin(gap, distance_to_box(scene->camera.eye, min, max));
  view->near = fmin(view->near, fmax(0.25 * gap, least * view->far));
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
  for (size_t i = 0; i < scene->object_count; i++)
    fit_box(scene->object[i].min, scene->object[i].max, &out->view);
  for (size_t i = 0; i < scene->light_count; i++) {
    double min[3], max[3];
    if (bound_light(&scene->light[i], min, max)) fit_box(min, max, &out->view);
  }
  abbe_view_pad(&out->view, 0.01);
  come_near(scene, desc, &out->view);
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
