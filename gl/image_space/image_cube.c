#include "gl/image_space/image_cube.h"

#include "gl/light/photon_lights.h"
#include "scenes/geometry/vector.h"

#include <math.h>

static const double widest = 1.55;        /* tangent of a window of objects */
static const double nearest_share = 1e-3; /* of what is farthest */

void abbe_image_cube_one(const abbe_view *view, abbe_image_cube *out) {
  *out = (abbe_image_cube){.faces = 1, .object_faces = 1};
  out->face[0] = out->object_face[0] = *view;
}

static double farthest_of(const abbe_gpu_scene *scene, const size_t *object, size_t count) {
  const double *from = scene->local->light[0].position;
  double far = 0;
  for (size_t i = 0; i < count; i++) {
    const abbe_mesh *mesh = &scene->local->object[object[i]].mesh;
    for (size_t k = 0; k < mesh->vertex_count; k++) {
      double to[3];
      abbe_vector_subtract(mesh->position[k], from, to);
      far = fmax(far, abbe_vector_length(to));
    }
  }
  return far;
}

static void open_faces(const double origin[3], double tangent, double far,
                       abbe_view out[ABBE_LIGHT_CUBE_FACES]) {
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    abbe_light_cube_look(origin, face, &out[face]);
    for (int k = 0; k < 4; k++) out[face].window[k] = k % 2 == 0 ? -tangent : tangent;
    out[face].near = nearest_share * far;
    out[face].far = far;
  }
}

/* A square around all objects; false where one view does not show them well. */
static bool fit_objects(const abbe_gpu_scene *scene, double far, abbe_view *view) {
  const abbe_plan *plan = scene->plan;
  bool all = true;
  abbe_photon_light_look(scene, 0, view);
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_mesh *mesh = &scene->local->object[plan->refractor_object[i]].mesh;
    all = abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count) && all;
  }
  if (!all) return false;
  abbe_view_pad(view, 0.01);
  abbe_view_square(view);
  view->near = nearest_share * far;
  view->far = far;
  for (int k = 0; k < 4; k++) all = all && fabs(view->window[k]) <= widest;
  return all;
}

void abbe_image_cube_make(const abbe_gpu_scene *scene, size_t side, size_t border, bool whole,
                          abbe_image_cube *out) {
  const abbe_plan *plan = scene->plan;
  const double *origin = scene->local->light[0].position;
  const double far = 1.01 * fmax(farthest_of(scene, plan->receiver_object, plan->receiver_count),
                                 farthest_of(scene, plan->refractor_object, plan->refractor_count));
  *out = (abbe_image_cube){.faces = ABBE_LIGHT_CUBE_FACES, .object_faces = 1};
  open_faces(origin, (double)side / (double)(side - 2 * border), far, out->face);
  if (!whole && fit_objects(scene, far, &out->object_face[0])) return;
  out->object_faces = ABBE_LIGHT_CUBE_FACES;
  open_faces(origin, 1, far, out->object_face);
}
