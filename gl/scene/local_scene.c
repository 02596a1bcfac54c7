#include "gl/scene/local_scene.h"

#include "base/maths.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* 2^-24 of that is 1/65536 of the radius. */
static const double most_radii = 256;

static void move(const double origin[3], double point[3]) {
  for (int k = 0; k < 3; k++) point[k] -= origin[k];
}

static void *copy_of(const void *from, size_t size) {
  void *to = malloc(size > 0 ? size : 1);
  if (to != NULL && size > 0) memcpy(to, from, size);
  return to;
}

/* The arrays that are moved become the copy's own; on failure what is left NULL is not. */
static bool move_object(const double origin[3], abbe_object *o) {
  const abbe_object from = *o;
  o->mesh.position =
      copy_of(from.mesh.position, from.mesh.vertex_count * sizeof *from.mesh.position);
  o->exact.plane = copy_of(
      from.exact.plane, from.exact.plane != NULL ? from.exact.count * sizeof *from.exact.plane : 0);
  o->exact.parallelogram = copy_of(
      from.exact.parallelogram,
      from.exact.parallelogram != NULL ? from.exact.count * sizeof *from.exact.parallelogram : 0);
  if (o->mesh.position == NULL || o->exact.plane == NULL || o->exact.parallelogram == NULL)
    return false;
  for (size_t i = 0; i < o->mesh.vertex_count; i++) move(origin, o->mesh.position[i]);
  for (size_t i = 0; i < o->exact.count && from.exact.plane != NULL; i++)
    o->exact.plane[i][3] -= abbe_vector_dot(o->exact.plane[i], origin);
  for (size_t i = 0; i < o->exact.count && from.exact.parallelogram != NULL; i++)
    move(origin, o->exact.parallelogram[i]);
  move(origin, o->exact.centre);
  move(origin, o->brushing.centre);
  move(origin, o->min);
  move(origin, o->max);
  return true;
}

static bool needs_move(const abbe_scene *scene, double centre[3]) {
  double min[3], max[3], half[3];
  if (!abbe_scene_bounds(scene, true, false, min, max) &&
      !abbe_scene_bounds(scene, true, true, min, max))
    return false;
  for (int k = 0; k < 3; k++) {
    centre[k] = 0.5 * (min[k] + max[k]);
    half[k] = 0.5 * (max[k] - min[k]);
  }
  return abbe_vector_length(centre) > most_radii * abbe_vector_length(half);
}

static abbe_result move_scene(const abbe_scene *scene, abbe_local_scene *out, abbe_error *error) {
  abbe_scene *copy = &out->copy;
  *copy = *scene;
  copy->medium = NULL;
  copy->light = copy_of(scene->light, scene->light_count * sizeof *scene->light);
  copy->object = calloc(scene->object_count + 1, sizeof *scene->object);
  bool whole = copy->light != NULL && copy->object != NULL;
  for (size_t i = 0; i < scene->object_count && whole; i++) {
    copy->object[i] = scene->object[i];
    whole = move_object(out->origin, &copy->object[i]);
  }
  if (!whole) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to move the scene");
  for (size_t i = 0; i < scene->light_count; i++) {
    move(out->origin, copy->light[i].position);
    move(out->origin, copy->light[i].centre);
  }
  if (scene->medium != NULL) {
    copy->medium = copy_of(scene->medium, sizeof *scene->medium);
    if (copy->medium == NULL)
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to move the scene");
    move(out->origin, copy->medium->min);
    move(out->origin, copy->medium->max);
  }
  move(out->origin, copy->camera.eye);
  move(out->origin, copy->camera.target);
  return ABBE_OK;
}

abbe_result abbe_local_scene_make(const abbe_scene *scene, abbe_local_scene *out,
                                  abbe_error *error) {
  double centre[3];
  memset(out, 0, sizeof *out);
  out->scene = scene;
  out->unit = 1;
  if (!needs_move(scene, centre)) return ABBE_OK;
  out->moved = true;
  memcpy(out->origin, centre, sizeof centre);
  abbe_result result = move_scene(scene, out, error);
  if (result != ABBE_OK) {
    abbe_local_scene_free(out);
    return result;
  }
  out->scene = &out->copy;
  return ABBE_OK;
}

abbe_result abbe_local_scene_repeat_lights(abbe_local_scene *local, const size_t *of, size_t count,
                                           abbe_error *error) {
  const abbe_scene *scene = local->scene;
  const size_t own = scene->light_count;
  abbe_light *light = calloc(own + count + 1, sizeof *light);
  if (light == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for lights");
  if (own > 0) memcpy(light, scene->light, own * sizeof *light);
  for (size_t i = 0; i < count; i++) light[own + i] = scene->light[of[i]];
  if (local->moved || local->repeated)
    free(local->copy.light);
  else
    local->copy = *scene;
  local->copy.light = light;
  local->copy.light_count = own + count;
  local->repeated = true;
  local->scene = &local->copy;
  return ABBE_OK;
}

abbe_result abbe_local_scene_scale_light(abbe_local_scene *local, abbe_error *error) {
  assert(local->scene);
  static const double faint = 0x1p-40, bright = 0x1p40;
  const abbe_scene *scene = local->scene;
  double most = fmax(scene->ambient, scene->background);
  if (scene->environment != NULL) most = fmax(most, scene->environment->luminance);
  for (size_t i = 0; i < local->scene->light_count; i++)
    most = fmax(most, local->scene->light[i].power);
  if (!(most > 0) || (most >= faint && most <= bright)) return ABBE_OK;
  ABBE_TRY(abbe_local_scene_repeat_lights(local, NULL, 0, error));
  local->unit = ldexp(1, ilogb(most));
  for (size_t i = 0; i < local->copy.light_count; i++) local->copy.light[i].power /= local->unit;
  local->copy.ambient /= local->unit;
  local->copy.background /= local->unit;
  return ABBE_OK;
}

void abbe_local_scene_free(abbe_local_scene *local) {
  if (local == NULL) return;
  if (local->repeated && !local->moved) free(local->copy.light);
  if (local->moved) {
    for (size_t i = 0; local->copy.object != NULL && i < local->copy.object_count; i++) {
      free(local->copy.object[i].mesh.position);
      free(local->copy.object[i].exact.plane);
      free(local->copy.object[i].exact.parallelogram);
    }
    free(local->copy.light);
    free(local->copy.object);
    free(local->copy.medium); /* its tables are the original's */
  }
  memset(local, 0, sizeof *local);
}

void abbe_local_scene_from_world(const abbe_local_scene *local, abbe_view *view) {
  move(local->origin, view->origin);
}

void abbe_local_scene_to_world(const abbe_local_scene *local, abbe_view *view) {
  for (int k = 0; k < 3; k++) view->origin[k] += local->origin[k];
}

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

/* What is sharp stays where it is in the picture. */
static void see_from_lens(const abbe_camera *camera, const double place[2], abbe_view *view) {
  if (!(camera->aperture > 0)) return;
  const double right = 0.5 * camera->aperture * place[0], up = 0.5 * camera->aperture * place[1];
  for (int k = 0; k < 3; k++) view->origin[k] += right * view->right[k] + up * view->up[k];
  for (int k = 0; k < 4; k++) view->window[k] -= (k < 2 ? right : up) / camera->focus;
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
  see_from_lens(camera, desc->lens_place, &out->view);
}
