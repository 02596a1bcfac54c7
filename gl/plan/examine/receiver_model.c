#include "gl/plan/examine/models.h"

#include "base/maths.h"
#include "gl/plan/examine/reach.h"

#include <math.h>

enum { MAX_PARALLELOGRAMS = 96 };

void abbe_receiver_model_choose(const abbe_scene *scene, abbe_plan *plan) {
  /* The published methods look their receivers up; an exact estimator meets them as the default
   * profile does. */
  const bool looked_up =
      abbe_method_of(plan->desc.profile)->lamp && plan->desc.estimator != ABBE_ESTIMATOR_EXACT;
  const abbe_object *general = NULL, *beyond = NULL;
  plan->receivers = looked_up ? ABBE_RECEIVER_DEPTH : ABBE_RECEIVER_EXACT;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_object *object = &scene->object[plan->receiver_object[i]];
    const bool flat = object->exact.kind == ABBE_EXACT_PARALLELOGRAMS;
    const bool room = flat && object->exact.count <= MAX_PARALLELOGRAMS - plan->parallelogram_count;
    plan->receiver_model[i] = looked_up ? ABBE_RECEIVER_DEPTH
                              : room    ? ABBE_RECEIVER_EXACT
                                        : ABBE_RECEIVER_BVH;
    if (plan->receiver_model[i] == ABBE_RECEIVER_EXACT)
      plan->parallelogram_count += object->exact.count;
    if (!flat && general == NULL) general = object;
    if (flat && !room && beyond == NULL) beyond = object;
  }
  if (!looked_up && (general != NULL || beyond != NULL)) plan->receivers = ABBE_RECEIVER_BVH;
  const char *model = abbe_receiver_model_name(plan->receivers);
  if (looked_up)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: the %s profile knows no other model",
                  model, abbe_profile_name(plan->desc.profile));
  else if (general != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: '%.50s' is a general mesh", model,
                  general->name);
  else if (beyond != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL,
                  "%s: with '%.50s' there are more than %d parallelograms", model, beyond->name,
                  MAX_PARALLELOGRAMS);
  else
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: every receiver is a rectangle or a box",
                  model);
}

/* Whether the parallelogram's plane has everything on one side of it: all other corners, those of
 * the refractors' bounds, and the places that light comes from. To 1e-6 of its own size: what is
 * larger may lie close to what is small. */
static bool bounds_all(const abbe_scene *scene, const abbe_plan *plan, const double p[9]) {
  const double tolerance = 1e-6 * (abbe_vector_length(p + 3) + abbe_vector_length(p + 6));
  double low = 0, high = 0;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_exact *exact = &scene->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count; k++)
      for (int c = 0; c < 4; c++) {
        const double *q = exact->parallelogram[k];
        double corner[3];
        for (int x = 0; x < 3; x++)
          corner[x] = q[x] + (c & 1 ? q[3 + x] : 0) + (c & 2 ? q[6 + x] : 0);
        double side = abbe_reach_side(p, corner);
        low = fmin(low, side);
        high = fmax(high, side);
      }
  }
  for (size_t i = 0; i < 8 * plan->refractor_count; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i / 8]];
    double corner[3];
    for (int x = 0; x < 3; x++) corner[x] = i >> x & 1 ? object->max[x] : object->min[x];
    double side = abbe_reach_side(p, corner);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    double from[3];
    for (int x = 0; x < 3; x++)
      from[x] = light->kind == ABBE_LIGHT_DIRECTIONAL ? p[x] - light->direction[x] * 1e6
                                                      : light->position[x];
    double side = abbe_reach_side(p, from);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  return low > -tolerance || high < tolerance;
}

void abbe_receiver_model_shadows(const abbe_scene *scene, abbe_plan *plan) {
  plan->receiver_shadows = plan->receivers != ABBE_RECEIVER_EXACT;
  for (size_t i = 0; i < plan->receiver_count && !plan->receiver_shadows; i++) {
    const abbe_exact *exact = &scene->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count && !plan->receiver_shadows; k++)
      plan->receiver_shadows = !bounds_all(scene, plan, exact->parallelogram[k]);
  }
  abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_SHADOWS,
                plan->receiver_shadows ? "a receiver may stand between a light and another"
                                       : "the receivers bound a convex room around the lights");
}

bool abbe_receiver_model_is_coloured(const abbe_object *object) {
  const double even = 0.01;
  double least = INFINITY, most = 0;
  if (object->texture.data != NULL) return true;
  if (object->spectrum == NULL) {
    for (int k = 0; k < 3; k++) {
      least = fmin(least, object->reflectance[k]);
      most = fmax(most, object->reflectance[k]);
    }
    return most - least > even * most;
  }
  const double *value = abbe_spectrum_value(object->spectrum);
  for (size_t i = 0; i < abbe_spectrum_count(object->spectrum); i++) {
    least = fmin(least, value[i]);
    most = fmax(most, value[i]);
  }
  return most - least > even * most;
}

bool abbe_receiver_model_disperses(const abbe_scene *scene, const abbe_plan *plan) {
  if (!plan->caustics || !plan->dispersive || plan->desc.wavelengths < 2 ||
      abbe_method_of(plan->desc.profile)->own_passes)
    return false;
  for (size_t i = 0; i < plan->receiver_count; i++)
    if (abbe_receiver_model_is_coloured(&scene->object[plan->receiver_object[i]])) return true;
  return false;
}
