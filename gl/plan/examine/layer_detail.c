#include "gl/plan/examine/layer_detail.h"

#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdio.h>

/* Of a cell and of a sample. Normals between fewer vertices turn light aside by more than the faces
 * are moved: 1/60 of a cell of 64 adds 1 % to the mean CIEDE2000 of the ring's caustic, 1/30
 * adds 3. */
static const double cell_share = 1.0 / 50, sample_share = 1.0 / 16;

bool abbe_layer_detail_asks(const abbe_scene *scene, const abbe_plan *plan, size_t i) {
  const abbe_object *object = &scene->object[plan->refractor_object[i]];
  return plan->model[i] == ABBE_REFRACTOR_LAYERS && !plan->desc.everything &&
         !abbe_profile_is_thesis(plan->desc.profile) &&
         object->mesh.face_count > ABBE_LAYER_DETAIL_FACES;
}

const abbe_object *abbe_layer_detail_finest(const abbe_scene *scene, const abbe_plan *plan) {
  const abbe_object *finest = NULL;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i]];
    if (abbe_layer_detail_asks(scene, plan, i) &&
        (finest == NULL || object->mesh.face_count > finest->mesh.face_count))
      finest = object;
  }
  return finest;
}

bool abbe_layer_detail_reason(const abbe_scene *scene, const abbe_plan *plan, char reason[160]) {
  const abbe_object *fine = abbe_layer_detail_finest(scene, plan);
  if (fine != NULL)
    snprintf(reason, 160, "'%.50s' has %zu faces: fewer, where no cell or sample tells", fine->name,
             fine->mesh.face_count);
  else
    snprintf(reason, 160, "%s",
             plan->desc.everything ? "every face is drawn, as asked"
                                   : "no mesh known by its layers has more than 2048 faces");
  return fine != NULL;
}

bool abbe_layer_detail_saves(size_t kept, size_t faces) {
  return 2 * kept <= faces;
}

double abbe_layer_detail_step(const abbe_view *view, const size_t steps[2], const abbe_mesh *mesh) {
  double nearest = view->orthographic ? 1 : INFINITY;
  for (size_t i = 0; i < mesh->vertex_count && !view->orthographic; i++) {
    double to[3];
    abbe_vector_subtract(mesh->position[i], view->origin, to);
    nearest = fmin(nearest, abbe_vector_dot(to, view->forward));
  }
  const double across = (view->window[1] - view->window[0]) / (double)steps[0];
  const double up = (view->window[3] - view->window[2]) / (double)steps[1];
  return fmax(nearest, 0) * fmin(across, up);
}

double abbe_layer_detail_distance(double cell_m, double sample_m) {
  return fmin(cell_share * cell_m, sample_share * sample_m);
}
