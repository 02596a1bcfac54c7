/* Lights with a size, as the camera's paths see them. */
#include "colorimetry/weights.h"
#include "gl/scene/gpu_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The points of a disk or rectangle follow each other; views of the same light again come after all
 * lights. */
static bool is_first(const abbe_gpu_scene *scene, size_t light) {
  const abbe_light *all = scene->local->light;
  return all[light].points > 0 && scene->plan->light_view[light].light == light &&
         (light == 0 || all[light - 1].points == 0 ||
          memcmp(all[light].centre, all[light - 1].centre, sizeof all->centre) != 0);
}

size_t abbe_gpu_area_lights_count(const abbe_gpu_scene *scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) count += is_first(scene, i);
  return count;
}

static GLint place_of(const abbe_gl *gl, GLuint program, const char *what, size_t index) {
  char name[40];
  snprintf(name, sizeof name, "%s[%zu]", what, index);
  return gl->GetUniformLocation(program, name);
}

/* Half a side over its square: how far a place is along it, in halves. */
static void set_edge(const abbe_gl *gl, GLuint program, size_t index, const abbe_light *light,
                     const double edge[3]) {
  double square = 0;
  for (int k = 0; k < 3; k++) square += edge[k] * edge[k];
  const double scale = light->kind == ABBE_LIGHT_RECTANGLE ? 1 / square : 0;
  gl->Uniform3f(place_of(gl, program, "area_light_edge", index), (float)(scale * edge[0]),
                (float)(scale * edge[1]), (float)(scale * edge[2]));
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
    for (size_t k = 0; k < 2; k++) set_edge(gl, program, 2 * disk + k, l, l->edge[k]);
    gl->Uniform3f(place_of(gl, program, "area_light_facing", disk), (float)l->direction[0],
                  (float)l->direction[1], (float)l->direction[2]);
    gl->Uniform3f(place_of(gl, program, "area_light_radiance", disk), rgb[0], rgb[1], rgb[2]);
    disk++;
  }
}
