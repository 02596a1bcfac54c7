#include "gl/plan/examine/examine.h"

#include "base/maths.h"
#include "scenes/view/view.h"

#include <float.h>
#include <math.h>

/* A float keeps 2^-24 of a distance. A refractor's shape is safe at 2^16 times its radius, where
 * that is a part in 256 of it; its front and back are separate at 2^20 times its thickness. */
static const double most_radii = 65536, most_thicknesses = 1048576;

static abbe_result check_distance(const abbe_scene *scene, const abbe_light *light,
                                  const abbe_object *object, abbe_error *error) {
  /* Parallel light is followed from close before all refractors. */
  bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double min[3], max[3], apart[3], half[3], size[3];
  abbe_scene_bounds(scene, true, false, min, max);
  for (int k = 0; k < 3; k++) {
    apart[k] = 0.5 * (object->min[k] + object->max[k]) - light->position[k];
    half[k] = 0.5 * (object->max[k] - object->min[k]);
    size[k] = max[k] - min[k];
  }
  double distance = abbe_vector_length(sun ? size : apart),
         thick = object->mirror ? 0 : abbe_object_thickness(object);
  double radius =
      object->exact.kind == ABBE_EXACT_SPHERE ? object->exact.radius : abbe_vector_length(half);
  if (distance > most_radii * radius && sun)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the refractors reach over %.3g m, and '%s' is %.3g m wide: single "
                          "precision loses its shape "
                          "in the light '%s' of them all; move them nearer together",
                          distance, object->name, 2 * radius, light->name);
  if (distance > most_radii * radius)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the light '%s' is %.3g m from the refractor '%s', which is %.3g m wide: "
                          "single precision loses its shape over that distance; make it a "
                          "directional light of %.6g W/m2",
                          light->name, distance, object->name, 2 * radius,
                          light->power / (distance * distance));
  if (distance > most_thicknesses * thick && !object->mirror)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the refractor '%s' is %.3g m thin, %.3g m from the light '%s': single "
                          "precision does not tell its front from its back; make it at least %.3g "
                          "m thick, or leave it out",
                          object->name, thick, distance, light->name, distance / most_thicknesses);
  return ABBE_OK;
}

/* The lesser side of an object's window, in cells of a grid over the window of all. */
static double count_cells(const abbe_plan *plan, const abbe_view *own, const abbe_view *all) {
  double share = INFINITY;
  for (int axis = 0; axis < 2; axis++) {
    const double *a = &all->window[2 * axis], *o = &own->window[2 * axis];
    if (a[1] > a[0]) share = fmin(share, (o[1] - o[0]) / (a[1] - a[0]));
  }
  return share * (double)plan->desc.photons;
}

/* Photons are the middles of a grid's cells over all refractors: one that is smaller than half a
 * cell is met by chance. A grid of less than four a side is no grid. */
static abbe_result check_cells(const abbe_plan *plan, const abbe_light *light,
                               const abbe_object *object, double cells, abbe_error *error) {
  if (plan->desc.photons < 4 || cells >= 0.5) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the refractor '%s' is %.2g cells of the photon grid of the light '%s' "
                        "wide, so that its light would be a matter of chance; ask for %.0f photons "
                        "a side, or move the refractors nearer together",
                        object->name, cells, light->name, ceil((double)plan->desc.photons / cells));
}

static abbe_result check_one_view(const abbe_scene *scene, const abbe_plan *plan,
                                  const abbe_light *light, abbe_error *error) {
  abbe_view view;
  abbe_light_views_fit(scene, light, plan, &view, NULL);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_object *object = &scene->object[plan->refractor_object[k]];
    abbe_view own = view; /* with one refractor it is that one's own */
    if (plan->refractor_count > 1) {
      abbe_view_look(view.origin, view.forward, view.up, view.orthographic, &own);
      abbe_view_fit(&own, (const double(*)[3])object->mesh.position, object->mesh.vertex_count);
    }
    ABBE_TRY(check_distance(scene, light, object, error));
    ABBE_TRY(check_cells(plan, light, object, count_cells(plan, &own, &view), error));
  }
  return ABBE_OK;
}

/* Floats know the distance from the light to a surface to 2^-24 of the surface's own size. */
static abbe_result check_gap(const abbe_light *light, const abbe_object *object,
                             abbe_error *error) {
  static const double least_gap = 1.0 / 4096;
  double half[3];
  for (int k = 0; k < 3; k++) half[k] = 0.5 * (object->max[k] - object->min[k]);
  const double least = least_gap * abbe_vector_length(half);
  double gap = abbe_object_distance(object, light->position);
  if (object->mirror) gap = fabs(gap); /* from inside it mirrors, too */
  if (gap < 1e-9 * least) gap = 0;     /* a double's rounding */
  if (gap >= least) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the light '%s' is %.3g m from the surface of the refractor '%s': single "
                        "precision does not resolve what it lights there; move it at least %.3g m "
                        "away, or trace the scene",
                        light->name, gap, object->name, least);
}

/* A refractor that the seams of faces cut is resolved where its largest part is. */
static abbe_result check_cube(const abbe_scene *scene, const abbe_plan *plan, size_t light,
                              abbe_error *error) {
  const abbe_light *from = &scene->light[light];
  abbe_view all[ABBE_LIGHT_CUBE_FACES];
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    abbe_light_cube_look(from->position, face, &all[face]);
    for (size_t k = 0; k < plan->refractor_count; k++) {
      const abbe_object *object = &scene->object[plan->refractor_object[k]];
      if (abbe_light_cube_reached(from, object) >> face & 1)
        abbe_light_cube_fit(&all[face], object);
    }
  }
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_object *object = &scene->object[plan->refractor_object[k]];
    const unsigned faces = abbe_light_cube_reached(from, object);
    double cells = 0;
    if (faces == 0) continue;
    for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
      abbe_view own;
      if ((faces >> face & 1) == 0) continue;
      abbe_light_cube_look(from->position, face, &own);
      abbe_light_cube_fit(&own, object);
      cells = fmax(cells, count_cells(plan, &own, &all[face]));
    }
    ABBE_TRY(check_distance(scene, from, object, error));
    ABBE_TRY(check_gap(from, object, error));
    ABBE_TRY(check_cells(plan, from, object, cells, error));
  }
  return ABBE_OK;
}

abbe_result abbe_precision_check(const abbe_scene *scene, const abbe_plan *plan,
                                 abbe_error *error) {
  if (plan->refractor_count == 0 || abbe_method_of(plan->desc.profile)->printed) return ABBE_OK;
  for (size_t i = 0; i < scene->light_count; i++)
    if (plan->reaches[i])
      ABBE_TRY(plan->light_view[i].face >= 0 || plan->desc.faces > 1
                   ? check_cube(scene, plan, i, error)
                   : check_one_view(scene, plan, &scene->light[i], error));
  return ABBE_OK;
}

bool abbe_absorption_shows(const abbe_scene *scene, double per_m) {
  double low[3], high[3], size[3];
  if (!(per_m > 0) || !abbe_scene_bounds(scene, true, true, low, high)) return per_m > 0;
  abbe_vector_subtract(high, low, size);
  return 100 * per_m * abbe_vector_length(size) > 0.25 * (double)FLT_EPSILON;
}
