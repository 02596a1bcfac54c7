/* The key 'clouds' of what refracts: balls and boxes in it in which light is scattered otherwise.
 * Each is an object of its own of the same material, so that it has no surface of its own. */
#include "scenes/import/scene_reading.h"

#include "scenes/geometry/transform.h"
#include "scenes/import/scene_value.h"
#include "scenes/shapes/shape.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS = 4, MOST_CLOUDS = 32 };

/* The mesh about its own middle, which lies at `middle` of the stone's own coordinates. */
static abbe_result read_shape(const abbe_object_reading *r, abbe_yaml_node node, double middle[3],
                              abbe_object_surface *surface, abbe_mesh *out, abbe_error *error) {
  const bool round = abbe_yaml_get(r->yaml, node, "radius").id != 0;
  const abbe_yaml_node box = abbe_yaml_get(r->yaml, node, "size");
  double size[3] = {0, 0, 0};
  if (!abbe_yaml_is_mapping(r->yaml, node) || round == (box.id != 0))
    return abbe_yaml_fail(r->yaml, node, error,
                          "a cloud has a 'radius' or a 'size', such as {centre: [0, 0, 0], radius: "
                          "0.001, medium: {scattering: 300}} or {size: [0.001, 0.002, 0.001]}");
  surface->normals = round ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_FLAT;
  for (int k = 0; k < 3; k++) middle[k] = 0;
  ABBE_TRY(round ? abbe_yaml_get_length(r->yaml, node, "radius", 0, ABBE_SCENE_FAR,
                                        &surface->radius, error)
                 : abbe_yaml_get_lengths(r->yaml, node, "size", 3, 0, ABBE_SCENE_FAR, size, error));
  ABBE_TRY(abbe_yaml_get_lengths(r->yaml, node, "centre", 3, -ABBE_SCENE_FAR, ABBE_SCENE_FAR,
                                 middle, error));
  if (!(round ? surface->radius > 0 : size[0] > 0 && size[1] > 0 && size[2] > 0))
    return abbe_yaml_fail(r->yaml, round ? abbe_yaml_get(r->yaml, node, "radius") : box, error,
                          "the '%s' of a cloud is above 0", round ? "radius" : "size");
  return round ? abbe_shape_sphere(surface->radius, LEVELS, out, error)
               : abbe_shape_box(size, out, error);
}

/* Where the stone was put: from its own coordinates. */
static void place_of(const abbe_object_reading *r, const abbe_object *stone, double out[16]) {
  const double factor[3] = {stone->fitted, stone->fitted, stone->fitted};
  double step[16];
  abbe_transform_scale(factor, step);
  abbe_transform_multiply(step, r->matrix, out);
  abbe_transform_translate(stone->centring, step);
  abbe_transform_multiply(step, out, out);
}

static abbe_result read_cloud(const abbe_object_reading *r, abbe_yaml_node node, size_t number,
                              const abbe_object *stone, abbe_object *out, abbe_error *error) {
  abbe_object_surface surface = {0};
  double middle[3], step[16];
  size_t one = 1;
  const size_t size = strlen(stone->name) + 32;
  out->material = stone->material;
  out->line = stone->line;
  out->cloud = true;
  out->name = malloc(size);
  if (out->name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  snprintf(out->name, size, "%s (cloud %zu)", stone->name, number);
  ABBE_TRY(read_shape(r, node, middle, &surface, &out->mesh, error));
  ABBE_TRY(abbe_medium_file_read(r->yaml, node, false, &out->medium, error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "a cloud", error));
  place_of(r, stone, surface.matrix);
  abbe_transform_translate(middle, step);
  abbe_transform_multiply(surface.matrix, step, surface.matrix);
  ABBE_TRY(abbe_object_place(&surface, out, 1, &one, error));
  memcpy(out->axis, stone->axis, sizeof out->axis);
  memcpy(out->axis_x, stone->axis_x, sizeof out->axis_x);
  for (size_t v = 0; v < out->mesh.vertex_count; v++)
    if (!abbe_object_contains(stone, out->mesh.position[v]))
      return abbe_yaml_fail(r->yaml, node, error, "the cloud reaches out of '%s'", stone->name);
  return ABBE_OK;
}

abbe_result abbe_object_read_clouds(const abbe_object_reading *r, abbe_object *out, size_t room,
                                    size_t *count, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "clouds");
  if (node.id == 0) return ABBE_OK;
  if (out->material == NULL || *count > 1)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'clouds' are in one solid that refracts; this object %s",
                          *count > 1 ? "is several, which cross" : "has no 'material'");
  const size_t clouds = abbe_yaml_is_sequence(r->yaml, node) ? abbe_yaml_count(r->yaml, node) : 0;
  if (clouds == 0 || clouds > MOST_CLOUDS || clouds >= room)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'clouds' wants a list of 1 to %d balls and boxes, as far as the scene "
                          "has room for objects",
                          MOST_CLOUDS);
  for (size_t i = 0; i < clouds; i++) {
    abbe_object *cloud = &out[(*count)++];
    ABBE_TRY(read_cloud(r, abbe_yaml_item(r->yaml, node, i), i + 1, out, cloud, error));
  }
  return ABBE_OK;
}
