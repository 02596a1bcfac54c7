#include "scenes/import/scene_reading.h"

#include "base/maths.h"
#include "scenes/import/scene_value.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FAINTEST 1e-30

static const char *const light_kinds[] = {"point", "spot",      "directional",
                                          "disk",  "rectangle", NULL};

/* The key belongs to other kinds of light. */
static abbe_result refuse_key(abbe_yaml *yaml, abbe_yaml_node node, const char *key, int kind,
                              const char *instead, abbe_error *error) {
  const abbe_yaml_node found = abbe_yaml_get(yaml, node, key);
  if (found.id == 0) return ABBE_OK;
  return abbe_yaml_fail(yaml, found, error, "a %s light has no '%s'; %s", light_kinds[kind], key,
                        instead);
}

static abbe_result read_direction(abbe_yaml *yaml, abbe_yaml_node node, abbe_light *out,
                                  abbe_error *error) {
  const abbe_yaml_node direction = abbe_yaml_get(yaml, node, "direction");
  const abbe_yaml_node target = abbe_yaml_get(yaml, node, "target");
  if ((direction.id != 0) == (target.id != 0))
    return abbe_yaml_fail(yaml, node, error,
                          "a %s light has either a 'direction' (the way the light travels) or a "
                          "'target' point; this one has %s",
                          light_kinds[out->kind], direction.id ? "both" : "neither");
  if (direction.id) {
    ABBE_TRY(abbe_scene_value_point(yaml, node, "direction", out->direction, error));
  } else {
    if (out->kind == ABBE_LIGHT_DIRECTIONAL)
      ABBE_TRY(abbe_scene_value_point(yaml, node, "position", out->position, error));
    ABBE_TRY(abbe_scene_value_point(yaml, node, "target", out->direction, error));
    abbe_vector_subtract(out->direction, out->position, out->direction);
  }
  if (!abbe_vector_normalise(out->direction))
    return abbe_yaml_fail(yaml, direction.id ? direction : target, error,
                          "the light's direction is zero; it must point somewhere");
  return ABBE_OK;
}

static abbe_result read_cone(abbe_yaml *yaml, abbe_yaml_node node, abbe_light *out,
                             abbe_error *error) {
  double cone = 0.0, soft = 0.0;
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(yaml, node, "cone", &ignored, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "cone", 0.001, 85, &cone, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "soft", 0, cone, &soft, error));
  out->cone_rad = cone * ABBE_DEGREE;
  out->soft_rad = soft * ABBE_DEGREE;
  return ABBE_OK;
}

static abbe_result read_radius(abbe_yaml *yaml, abbe_yaml_node node, abbe_light *out,
                               abbe_error *error) {
  abbe_yaml_node value;
  ABBE_TRY(abbe_yaml_require(yaml, node, "radius", &value, error));
  ABBE_TRY(abbe_yaml_get_length(yaml, node, "radius", 0, ABBE_SCENE_FAR, &out->radius, error));
  if (!(out->radius > 0.0))
    return abbe_yaml_fail(yaml, value, error,
                          "'radius' is zero; a disk has an area (a light without one is a point)");
  return ABBE_OK;
}

static abbe_result read_side(abbe_yaml *yaml, abbe_yaml_node node, const char *key, double *out,
                             abbe_error *error) {
  abbe_yaml_node value;
  ABBE_TRY(abbe_yaml_require(yaml, node, key, &value, error));
  ABBE_TRY(abbe_yaml_get_length(yaml, node, key, 0, ABBE_SCENE_FAR, out, error));
  if (!(*out > 0.0))
    return abbe_yaml_fail(yaml, value, error, "'%s' is zero; a rectangle has an area", key);
  return ABBE_OK;
}

/* The height grows along z, or along y where the light looks along z; roll turns it about the
 * normal. */
static abbe_result read_rectangle(abbe_yaml *yaml, abbe_yaml_node node, abbe_light *out,
                                  abbe_error *error) {
  double width = 0, height = 0, roll = 0, across[3], up[3];
  ABBE_TRY(read_side(yaml, node, "width", &width, error));
  ABBE_TRY(read_side(yaml, node, "height", &height, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "roll", -360, 360, &roll, error));
  abbe_light_upright(out->direction, across, up);
  const double c = cos(roll * ABBE_DEGREE), s = sin(roll * ABBE_DEGREE);
  for (int k = 0; k < 3; k++) {
    out->edge[0][k] = 0.5 * width * (c * across[k] + s * up[k]);
    out->edge[1][k] = 0.5 * height * (c * up[k] - s * across[k]);
  }
  out->radius = 0.5 * hypot(width, height);
  return ABBE_OK;
}

static abbe_result refuse_sides(abbe_yaml *yaml, abbe_yaml_node node, int kind, abbe_error *error) {
  static const char *const keys[] = {"width", "height", "roll"};
  for (int i = 0; i < 3; i++)
    ABBE_TRY(refuse_key(yaml, node, keys[i], kind, "a rectangle light has", error));
  return ABBE_OK;
}

static abbe_result read_shape_of_light(abbe_yaml *yaml, abbe_yaml_node node, abbe_light *out,
                                       abbe_error *error) {
  if (out->kind != ABBE_LIGHT_DIRECTIONAL)
    ABBE_TRY(abbe_scene_value_point(yaml, node, "position", out->position, error));
  if (out->kind == ABBE_LIGHT_POINT) {
    ABBE_TRY(refuse_key(yaml, node, "direction", 0, "it shines in every direction", error));
    ABBE_TRY(refuse_key(yaml, node, "target", 0, "it shines in every direction", error));
  } else {
    ABBE_TRY(read_direction(yaml, node, out, error));
  }
  if (out->kind == ABBE_LIGHT_DISK)
    ABBE_TRY(read_radius(yaml, node, out, error));
  else
    ABBE_TRY(refuse_key(yaml, node, "radius", (int)out->kind, "a disk light has", error));
  if (out->kind == ABBE_LIGHT_RECTANGLE)
    ABBE_TRY(read_rectangle(yaml, node, out, error));
  else
    ABBE_TRY(refuse_sides(yaml, node, (int)out->kind, error));
  if (out->kind == ABBE_LIGHT_SPOT) return read_cone(yaml, node, out, error);
  ABBE_TRY(refuse_key(yaml, node, "cone", (int)out->kind, "a spot light has", error));
  return refuse_key(yaml, node, "soft", (int)out->kind, "a spot light has", error);
}

/* What each kind of light is bright in. */
static const struct {
  const char *key, *said;
} powers[] = {[ABBE_LIGHT_POINT] = {"intensity", "it has an 'intensity' (W/sr)"},
              [ABBE_LIGHT_SPOT] = {"intensity", "it has an 'intensity' (W/sr)"},
              [ABBE_LIGHT_DIRECTIONAL] = {"irradiance", "it has an 'irradiance' (W/m2)"},
              [ABBE_LIGHT_DISK] = {"radiance", "it has a 'radiance' (W/(m2 sr))"},
              [ABBE_LIGHT_RECTANGLE] = {"radiance", "it has a 'radiance' (W/(m2 sr))"}};

static abbe_result read_power(abbe_yaml *yaml, abbe_yaml_node node, abbe_light *out,
                              abbe_error *error) {
  const char *key = powers[out->kind].key;
  abbe_yaml_node value;
  for (size_t i = 0; i < sizeof powers / sizeof *powers; i++)
    if (strcmp(powers[i].key, key) != 0)
      ABBE_TRY(
          refuse_key(yaml, node, powers[i].key, (int)out->kind, powers[out->kind].said, error));
  ABBE_TRY(abbe_yaml_require(yaml, node, key, &value, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, key, 0, ABBE_SCENE_BRIGHTEST, &out->power, error));
  if (!(out->power > 0.0))
    return abbe_yaml_fail(yaml, value, error, "'%s' is zero; a light must shine", key);
  if (out->power < FAINTEST)
    return abbe_yaml_fail(yaml, value, error,
                          "'%s: %g' is too faint: pictures and maps are kept in single precision, "
                          "which takes %g and more",
                          key, out->power, FAINTEST);
  return ABBE_OK;
}

static abbe_result read_light(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                              abbe_light *out, abbe_error *error) {
  int kind = 0;
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(yaml, node, "kind", &ignored, error));
  ABBE_TRY(abbe_yaml_get_choice(yaml, node, "kind", light_kinds, &kind, error));
  out->kind = (abbe_light_kind)kind;
  ABBE_TRY(abbe_yaml_get_name(yaml, node, "name", &out->name, error));
  if (!out->name) {
    char name[64];
    snprintf(name, sizeof name, "light on line %zu", abbe_yaml_line(yaml, node));
    out->name = strdup(name);
    if (!out->name) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  }
  ABBE_TRY(read_shape_of_light(yaml, node, out, error));
  ABBE_TRY(read_power(yaml, node, out, error));
  ABBE_TRY(abbe_scene_value_illuminant(yaml, node, folder, &out->illuminant, &out->illuminant_path,
                                       error));
  if (out->kind == ABBE_LIGHT_POINT)
    ABBE_TRY(refuse_key(yaml, node, "polariser", kind,
                        "a sheet is flat, and it shines to all sides: take a spot", error));
  ABBE_TRY(abbe_scene_value_polariser(yaml, node, &out->polariser, error));
  return abbe_yaml_check_keys(yaml, node, "a light", error);
}

abbe_result abbe_lights_read(abbe_yaml *yaml, abbe_yaml_node root, const char *folder,
                             abbe_light **out, size_t *count, abbe_error *error) {
  abbe_yaml_node list;
  size_t listed;
  abbe_result result =
      abbe_scene_value_list(yaml, root, "lights", ABBE_SCENE_MAX_LIGHTS, &list, &listed, error);
  *out = NULL;
  *count = 0;
  if (result != ABBE_OK || listed == 0) return result;
  abbe_light *light = calloc(listed, sizeof *light);
  if (!light) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu lights", listed);
  *out = light;
  for (size_t i = 0; i < listed && result == ABBE_OK; i++) {
    *count = i + 1;
    result = read_light(yaml, abbe_yaml_item(yaml, list, i), folder, &light[i], error);
  }
  return result;
}
