#include "scenes/refractor_tilt.h"

#include "scenes/geometry/transform.h"
#include "scenes/object_motion.h"

#include <math.h>

static bool is_refractor(const abbe_object *o) {
  return abbe_object_kind_of(o) == ABBE_OBJECT_REFRACTOR;
}

/* False where there are none. */
static bool find_middle(const abbe_scene *scene, double middle[3]) {
  double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t i = 0; i < scene->object_count; i++)
    for (int k = 0; k < 3 && is_refractor(&scene->object[i]); k++) {
      min[k] = fmin(min[k], scene->object[i].min[k]);
      max[k] = fmax(max[k], scene->object[i].max[k]);
    }
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (min[k] + max[k]);
  return min[0] <= max[0];
}

static void turn_about(const double middle[3], double rad, const double axis[3], double out[16]) {
  const double back[3] = {-middle[0], -middle[1], -middle[2]};
  double step[16];
  abbe_transform_translate(back, out);
  abbe_transform_rotate(rad, axis, step);
  abbe_transform_multiply(step, out, out);
  abbe_transform_translate(middle, step);
  abbe_transform_multiply(step, out, out);
}

abbe_result abbe_refractors_tilt(abbe_scene *scene, double tilt_rad, double axis_rad,
                                 abbe_error *error) {
  const double axis[3] = {cos(axis_rad), sin(axis_rad), 0};
  double middle[3], matrix[16];
  if (!isfinite(tilt_rad) || !isfinite(axis_rad))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a tilt takes two finite angles");
  if (!find_middle(scene, middle))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "nothing to tilt: the scene has no refractor");
  turn_about(middle, tilt_rad, axis, matrix);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++)
    if (is_refractor(&scene->object[i]))
      result = abbe_object_move(&scene->object[i], matrix, error);
  return result == ABBE_OK ? abbe_scene_check(scene, error) : result;
}
