#include "gl/plan/examine/tints.h"

#include "spectral/optics.h"

#include <math.h>

enum { RANGE_STEPS = 81 };

/* 1/m: no light is left of a wavelength. */
#define MOST_PER_M 1e30
#define MOST_MIRROR_DEPTH 80.0

static const abbe_object *object_of(const abbe_scene *scene, const abbe_plan *plan, size_t r) {
  return &scene->object[plan->refractor_object[r]];
}

double abbe_tint_attenuation(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                             double lambda_nm) {
  const abbe_object *object = object_of(scene, plan, r);
  if (!plan->mirror[r])
    return fmin(abbe_material_attenuation(object->material, lambda_nm) +
                    abbe_medium_scattering(object->medium, lambda_nm),
                MOST_PER_M);
  double n = 0, k = 0, reflected = object->mirror_reflectance;
  if (object->conductor != NULL &&
      abbe_material_nk(object->conductor, lambda_nm, &n, &k, NULL) == ABBE_OK)
    reflected = abbe_optics_fresnel_conductor(1, n, k);
  return fmin(-log(fmax(reflected, 1e-300)), MOST_MIRROR_DEPTH);
}

static bool is_even(const abbe_scene *scene, const abbe_plan *plan, size_t r) {
  const double min = plan->desc.min_nm, max = plan->desc.max_nm;
  double least = INFINITY, most = 0;
  for (int i = 0; i < RANGE_STEPS; i++) {
    const double here =
        abbe_tint_attenuation(scene, plan, r, min + (max - min) * i / (RANGE_STEPS - 1));
    least = fmin(least, here);
    most = fmax(most, here);
  }
  return (float)least == (float)most;
}

int abbe_tint_of(const abbe_scene *scene, const abbe_plan *plan, size_t r) {
  const abbe_object *object = object_of(scene, plan, r);
  for (size_t k = 0; k < r; k++) {
    const abbe_object *other = object_of(scene, plan, k);
    if (plan->mirror[k] == plan->mirror[r] && other->material == object->material &&
        other->medium == object->medium && other->conductor == object->conductor &&
        other->mirror_reflectance == object->mirror_reflectance)
      return abbe_tint_of(scene, plan, k);
  }
  return is_even(scene, plan, r) ? -1 : (int)r;
}

size_t abbe_tint_count(const abbe_scene *scene, const abbe_plan *plan) {
  size_t count = 0;
  for (size_t r = 0; r < plan->refractor_count && count < ABBE_MOST_TINTS; r++)
    count += abbe_tint_of(scene, plan, r) == (int)r;
  return count;
}
