/* Lights with a size, as the camera's paths see them. */
#include "base/maths.h"
#include "colorimetry/weights.h"
#include "gl/scene/gpu_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool same_surface(const abbe_light *a, const abbe_light *b) {
  return a->points > 0 && b->points > 0 && a->kind == b->kind && a->radius == b->radius &&
         memcmp(a->centre, b->centre, sizeof a->centre) == 0 &&
         memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
         memcmp(a->edge, b->edge, sizeof a->edge) == 0;
}

/* The points of a disk or rectangle follow each other; views of the same light again come after all
 * lights. */
static bool is_first(const abbe_gpu_scene *scene, size_t light) {
  const abbe_light *all = scene->local->light;
  return all[light].points > 0 && scene->plan->light_view[light].light == light &&
         (light == 0 || !same_surface(&all[light], &all[light - 1]));
}

size_t abbe_gpu_area_lights_count(const abbe_gpu_scene *scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) count += is_first(scene, i);
  return count;
}

size_t abbe_gpu_area_lights_of(const abbe_gpu_scene *scene, size_t light) {
  size_t number = 0;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) {
    if (!is_first(scene, i)) continue;
    number++;
    if (same_surface(&scene->local->light[i], &scene->local->light[light])) return number;
  }
  return 0;
}

static GLint place_of(const abbe_gl *gl, GLuint program, const char *what, size_t index) {
  char name[40];
  snprintf(name, sizeof name, "%s[%zu]", what, index);
  return gl->GetUniformLocation(program, name);
}

/* Half a side over its square: how far a place is along it, in halves. Of a disk: radii. */
static void set_edges(const abbe_gl *gl, GLuint program, size_t index, const abbe_light *light) {
  double edge[2][3];
  memcpy(edge, light->edge, sizeof edge);
  if (light->kind == ABBE_LIGHT_DISK) {
    const double *n = light->direction, x[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};
    abbe_vector_cross(n, x, edge[0]);
    abbe_vector_normalise(edge[0]);
    abbe_vector_cross(n, edge[0], edge[1]);
    for (int k = 0; k < 6; k++) edge[k / 3][k % 3] *= light->radius;
  }
  for (size_t i = 0; i < 2; i++) {
    const double scale = 1 / abbe_vector_dot(edge[i], edge[i]);
    gl->Uniform3f(place_of(gl, program, "area_light_edge", 2 * index + i),
                  (float)(scale * edge[i][0]), (float)(scale * edge[i][1]),
                  (float)(scale * edge[i][2]));
  }
}

void abbe_gpu_area_lights_set(const abbe_gpu_scene *scene, GLuint program) {
  const abbe_gl *gl = scene->gpu->gl;
  size_t disk = 0;
  if (place_of(gl, program, "area_light_place", 0) < 0) return;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) {
    const abbe_light *l = &scene->local->light[i];
    if (!is_first(scene, i)) continue;
    const double area = abbe_light_area(l);
    double xyz[3];
    float rgb[3];
    abbe_weights_white(scene->plan->desc.observer, &l->illuminant, scene->plan->desc.min_nm,
                       scene->plan->desc.max_nm, xyz);
    const double scale = l->power * (double)l->points / area;
    for (int k = 0; k < 3; k++)
      rgb[k] = (float)(scale * ((double)scene->rgb_from_xyz[k] * xyz[0] +
                                (double)scene->rgb_from_xyz[3 + k] * xyz[1] +
                                (double)scene->rgb_from_xyz[6 + k] * xyz[2]));
    gl->Uniform4f(place_of(gl, program, "area_light_place", disk), (float)l->centre[0],
                  (float)l->centre[1], (float)l->centre[2],
                  l->kind == ABBE_LIGHT_DISK ? (float)l->radius : 0);
    set_edges(gl, program, disk, l);
    gl->Uniform2i(place_of(gl, program, "area_light_points", disk), (GLint)i, (GLint)l->points);
    gl->Uniform3f(place_of(gl, program, "area_light_facing", disk), (float)l->direction[0],
                  (float)l->direction[1], (float)l->direction[2]);
    gl->Uniform3f(place_of(gl, program, "area_light_radiance", disk), rgb[0], rgb[1], rgb[2]);
    disk++;
  }
}
