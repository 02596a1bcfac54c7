#include "gl/plan/transport.h"

#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdio.h>

enum { RANGE_STEPS = 81, MAX_WALK_REFRACTORS = 32 };

double abbe_transport_side(const double p[9], const double at[3]) {
  const double *u = p + 3, *v = p + 6;
  double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  double sum = 0, length = 0;
  for (int k = 0; k < 3; k++) {
    sum += n[k] * (at[k] - p[k]);
    length += n[k] * n[k];
  }
  return sum / sqrt(length);
}

/* Between the boxes that bound them. */
static bool boxes_meet(const double a_min[3], const double a_max[3], const double b_min[3],
                       const double b_max[3]) {
  for (int k = 0; k < 3; k++)
    if (!(a_min[k] < b_max[k] && b_min[k] < a_max[k])) return false;
  return true;
}

bool abbe_transport_overlap(const abbe_object *a, const abbe_object *b) {
  if (!boxes_meet(a->min, a->max, b->min, b->max)) return false;
  if (a->exact.kind != ABBE_EXACT_SPHERE || b->exact.kind != ABBE_EXACT_SPHERE) return true;
  double apart[3];
  abbe_vector_subtract(a->exact.centre, b->exact.centre, apart);
  return abbe_vector_length(apart) < a->exact.radius + b->exact.radius;
}

/* An index as near to air's as this bends no ray by more than that, a few grazing ones aside. */
static const double invisible = 2e-6;

/* Whether light goes through the object as through air: clear, of air's index, and no bubble. */
bool abbe_transport_invisible(const abbe_scene *scene, const abbe_object *object,
                              const abbe_plan *plan) {
  const double min = plan->desc.min_nm, max = plan->desc.max_nm;
  if (plan->desc.profile == ABBE_PROFILE_THESIS) return false;
  for (int i = 0; i < RANGE_STEPS; i++) {
    double lambda_nm = min + (max - min) * i / (RANGE_STEPS - 1), n = 0;
    if (abbe_material_n(object->material, lambda_nm, &n, NULL) != ABBE_OK) return false;
    if (!(fabs(n - 1) <= invisible)) return false;
    if (abbe_material_attenuation(object->material, lambda_nm) > 0) return false;
  }
  for (size_t i = 0; i < scene->object_count; i++)
    if (&scene->object[i] != object && scene->object[i].material != NULL &&
        abbe_transport_overlap(&scene->object[i], object))
      return false;
  return true;
}

/* Whether the box has corners on both sides of the parallelogram's plane, near enough to touch it.
 */
static bool reaches_into(const double p[9], const abbe_object *refractor) {
  double min[3], max[3], low = INFINITY, high = -INFINITY;
  for (int k = 0; k < 3; k++) {
    min[k] = p[k] + fmin(p[3 + k], 0) + fmin(p[6 + k], 0);
    max[k] = p[k] + fmax(p[3 + k], 0) + fmax(p[6 + k], 0);
    /* a parallelogram in a plane of two axes has no third extent */
    double least = 1e-9 * (refractor->max[k] - refractor->min[k]);
    min[k] -= least;
    max[k] += least;
  }
  if (!boxes_meet(min, max, refractor->min, refractor->max)) return false;
  for (int c = 0; c < 8; c++) {
    double corner[3];
    for (int k = 0; k < 3; k++) corner[k] = c >> k & 1 ? refractor->max[k] : refractor->min[k];
    double side = abbe_transport_side(p, corner);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  return low < 0 && high > 0;
}

static bool receiver_reaches(const abbe_scene *scene, const abbe_object *refractor) {
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->material != NULL) continue;
    if (o->exact.kind != ABBE_EXACT_PARALLELOGRAMS &&
        boxes_meet(o->min, o->max, refractor->min, refractor->max))
      return true;
    for (size_t k = 0; o->exact.kind == ABBE_EXACT_PARALLELOGRAMS && k < o->exact.count; k++)
      if (reaches_into(o->exact.parallelogram[k], refractor)) return true;
  }
  return false;
}

/* Why light that has left a refractor may meet one again, or a receiver within; NULL: it cannot. */
const char *abbe_transport_walk(const abbe_scene *scene, const abbe_plan *plan) {
  const abbe_object *only = NULL;
  size_t refractors = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->material == NULL || abbe_transport_invisible(scene, o, plan)) continue;
    only = o;
    refractors++;
  }
  if (abbe_profile_is_thesis(plan->desc.profile) || refractors == 0) return NULL;
  if (plan->desc.model == ABBE_MODEL_LAYERS || refractors > MAX_WALK_REFRACTORS) return NULL;
  if (plan->desc.model == ABBE_MODEL_HIERARCHY) return "as asked";
  if (refractors > 1) return "there is more than one refractor";
  if (only->exact.kind != ABBE_EXACT_SPHERE && only->exact.kind != ABBE_EXACT_CONVEX &&
      !abbe_mesh_is_convex(&only->mesh))
    return "the refractor is not convex";
  if (receiver_reaches(scene, only)) return "a receiver may reach into the refractor";
  return NULL;
}

/* Whether a model that is asked for can serve the object. */
abbe_result abbe_transport_check(const abbe_object *object, const abbe_plan *plan,
                                 abbe_error *error) {
  ABBE_REQUIRE(object && plan, error);
  abbe_model asked = plan->desc.model;
  char why[128];
  abbe_convex_reason(&object->exact.convex, why, sizeof why);
  if (asked == ABBE_MODEL_SPHERE && object->exact.kind != ABBE_EXACT_SPHERE)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the model 'sphere' cannot serve '%s', which is no sphere", object->name);
  if (asked == ABBE_MODEL_CONVEX && object->exact.kind != ABBE_EXACT_CONVEX)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the model 'convex' cannot serve '%s', which is no convex solid of at "
                          "most %d faces%s%s",
                          object->name, ABBE_SCENE_MAX_PLANES, why[0] != '\0' ? ": " : "", why);
  if (asked == ABBE_MODEL_HIERARCHY && !plan->walk)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the model 'hierarchy' follows light through at most %d refractors; the "
                          "scene has more",
                          MAX_WALK_REFRACTORS);
  return ABBE_OK;
}

abbe_refractor_model abbe_transport_model(const abbe_object *object, const abbe_plan *plan) {
  if (abbe_profile_is_thesis(plan->desc.profile)) return ABBE_REFRACTOR_LAYERS;
  if (plan->desc.model != ABBE_MODEL_AUTO)
    return (abbe_refractor_model)(plan->desc.model - ABBE_MODEL_SPHERE);
  if (object->exact.kind == ABBE_EXACT_SPHERE) return ABBE_REFRACTOR_SPHERE;
  if (object->exact.kind == ABBE_EXACT_CONVEX) return ABBE_REFRACTOR_CONVEX;
  return plan->walk ? ABBE_REFRACTOR_HIERARCHY : ABBE_REFRACTOR_LAYERS;
}

void abbe_transport_reason(const abbe_object *object, const abbe_plan *plan, char *text,
                           size_t size) {
  char why[128];
  abbe_convex_reason(&object->exact.convex, why, sizeof why);
  if (abbe_profile_is_thesis(plan->desc.profile))
    snprintf(text, size, "the thesis profile knows no other model");
  else if (plan->desc.model != ABBE_MODEL_AUTO)
    snprintf(text, size, "as asked");
  else if (object->exact.kind == ABBE_EXACT_SPHERE)
    snprintf(text, size, "the object is a sphere");
  else if (object->exact.kind == ABBE_EXACT_CONVEX)
    snprintf(text, size, "the object is a convex faceted solid: %s", why);
  else if (plan->walk)
    snprintf(text, size, "the object is a general mesh, and light may meet it more than twice%s%s",
             why[0] != '\0' ? ": " : "", why);
  else
    snprintf(text, size,
             "the object is a convex mesh and stands alone: a view sees all of it, front and "
             "back%s%s",
             why[0] != '\0' ? "; " : "", why);
}
