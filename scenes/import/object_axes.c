/* How the axes of a crystal lie in its object: in the object's own coordinates, until it is placed.
 */
#include "scenes/import/scene_reading.h"

#include "base/maths.h"
#include "scenes/import/scene_value.h"
#include "scenes/object_motion.h"

#include <math.h>
#include <string.h>

static abbe_result read_direction(const abbe_object_reading *r, abbe_yaml_node parent,
                                  const char *key, double out[3], abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, parent, key);
  if (node.id == 0) return ABBE_OK;
  ABBE_TRY(
      abbe_yaml_get_numbers(r->yaml, parent, key, 3, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out, error));
  if (!abbe_vector_normalise(out))
    return abbe_yaml_fail(r->yaml, node, error, "'%s' is zero; it must point somewhere", key);
  return ABBE_OK;
}

/* x and z, made square: x is turned. */
static abbe_result read_both(const abbe_object_reading *r, abbe_yaml_node node, abbe_object *out,
                             abbe_error *error) {
  if (!abbe_yaml_is_mapping(r->yaml, node))
    return abbe_yaml_fail(r->yaml, node, error,
                          "'axes' wants the principal axes x and z, such as {x: [1, 0, 0], z: [0, "
                          "0, 1]}");
  ABBE_TRY(read_direction(r, node, "x", out->axis_x, error));
  ABBE_TRY(read_direction(r, node, "z", out->axis, error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "'axes'", error));
  const bool both = abbe_yaml_get(r->yaml, node, "x").id != 0;
  const double sine = abbe_object_square_axes(out);
  if (both && sine < ABBE_AXES_SQUARE)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'axes': x and z are parallel; they are to be at right angles");
  out->axes_turned = both ? acos(fmin(sine, 1)) : 0;
  return ABBE_OK;
}

abbe_result abbe_object_read_axes(const abbe_object_reading *r, abbe_object *out,
                                  abbe_error *error) {
  const abbe_yaml_node axis = abbe_yaml_get(r->yaml, r->node, "axis"),
                       axes = abbe_yaml_get(r->yaml, r->node, "axes");
  const double along_x[3] = {1, 0, 0}, along_z[3] = {0, 0, 1};
  memcpy(out->axis_x, along_x, sizeof along_x);
  memcpy(out->axis, along_z, sizeof along_z);
  const abbe_yaml_node node = axes.id != 0 ? axes : axis;
  const char *key = axes.id != 0 ? "axes" : "axis";
  if (node.id == 0) return ABBE_OK;
  if (axis.id != 0 && axes.id != 0)
    return abbe_yaml_fail(r->yaml, axes, error,
                          "'axis' and 'axes' both say how the crystal lies; leave one out");
  if (out->material == NULL)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'%s' is %s of a crystal that refracts; this object has no 'material'",
                          key, axes.id != 0 ? "for the axes" : "the optic axis");
  if (!abbe_material_is_crystal(out->material))
    return abbe_yaml_fail(r->yaml, node, error,
                          "'%s' is %s crystal; the material '%s' has one index in all directions: "
                          "leave the key out, or take a material with %s",
                          key, axes.id != 0 ? "for the axes of a" : "the optic axis of a uniaxial",
                          out->material->name,
                          axes.id != 0 ? "'biaxial' indices" : "an 'extraordinary' index");
  if (axes.id != 0) return read_both(r, axes, out, error);
  if (abbe_material_is_biaxial(out->material))
    return abbe_yaml_fail(r->yaml, node, error,
                          "'axis' is the optic axis of a uniaxial crystal; the material '%s' has "
                          "three indices: give 'axes', such as {x: [1, 0, 0], z: [0, 0, 1]}",
                          out->material->name);
  ABBE_TRY(read_direction(r, r->node, "axis", out->axis, error));
  abbe_object_square_axes(out);
  return ABBE_OK;
}
