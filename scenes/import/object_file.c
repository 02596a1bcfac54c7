#include "scenes/import/object_file.h"

#include "colorimetry/image/png_file.h"
#include "scenes/geometry/transform.h"
#include "scenes/geometry/vector.h"
#include "scenes/import/object_surface.h"
#include "scenes/shapes/brilliant.h"
#include "scenes/shapes/shape.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RADIANS (3.14159265358979323846 / 180.0)
#define FAR 1e6 /* m: no coordinate or length may be larger */

typedef enum shape_kind {
  SPHERE,
  RING,
  GEM,
  BRILLIANT,
  PRISM,
  BOX,
  RECTANGLE,
  LATHE,
  MESH
} shape_kind;
static const char *const shape_names[] = {"sphere", "ring",      "gem",   "brilliant", "prism",
                                          "box",    "rectangle", "lathe", NULL};

/* What is known of an object while it is read. */
typedef struct reading {
  abbe_yaml *yaml;
  abbe_yaml_node node;
  const char *folder;
  shape_kind kind;
  double radius;     /* of a sphere */
  abbe_mesh_normals normals; /* of a mesh */
  double matrix[16]; /* to world */
} reading;

char *abbe_object_path(const char *folder, const char *path) {
  const size_t prefix = path[0] == '/' ? 0 : strlen(folder), size = prefix + strlen(path) + 1;
  char *joined = malloc(size);
  if (joined) snprintf(joined, size, "%.*s%s", (int)prefix, folder, path);
  return joined;
}

abbe_result abbe_object_locate(const abbe_yaml *yaml, abbe_yaml_node node, abbe_result code,
                               abbe_error *error) {
  ABBE_REQUIRE(yaml, error);
  if (!error) return code;
  char sentence[sizeof error->text];
  memcpy(sentence, error->text, sizeof sentence);
  abbe_yaml_fail(yaml, node, error, "%s", sentence);
  error->code = code;
  return code;
}

abbe_result abbe_object_need_point(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                   double out[3], abbe_error *error) {
  ABBE_REQUIRE(yaml && key && out, error);
  abbe_yaml_node ignored;
  const abbe_result result = abbe_yaml_require(yaml, mapping, key, &ignored, error);
  return result == ABBE_OK ? abbe_yaml_get_numbers(yaml, mapping, key, 3, -FAR, FAR, out, error)
                           : result;
}

/* A length that must be there; the shape itself says that it must be above zero. */
static abbe_result need_length(const reading *r, const char *key, double *out, abbe_error *error) {
  abbe_yaml_node ignored;
  const abbe_result result = abbe_yaml_require(r->yaml, r->node, key, &ignored, error);
  return result == ABBE_OK ? abbe_yaml_get_number(r->yaml, r->node, key, -FAR, FAR, out, error)
                           : result;
}

static abbe_result read_count(const reading *r, const char *key, size_t min, size_t max,
                              size_t *out, abbe_error *error) {
  return abbe_yaml_get_count(r->yaml, r->node, key, min, max, out, error);
}

/* --- shapes --- */

static abbe_result read_sphere(reading *r, abbe_mesh *out, abbe_error *error) {
  size_t levels = 4;
  abbe_result result = need_length(r, "radius", &r->radius, error);
  if (result == ABBE_OK) result = read_count(r, "levels", 0, 9, &levels, error);
  return result == ABBE_OK ? abbe_shape_sphere(r->radius, levels, out, error) : result;
}

static abbe_result read_ring(const reading *r, abbe_mesh *out, abbe_error *error) {
  double major = 0.0, minor = 0.0;
  size_t around = 256, across = 128;
  abbe_result result = need_length(r, "major", &major, error);
  if (result == ABBE_OK) result = need_length(r, "minor", &minor, error);
  if (result == ABBE_OK) result = read_count(r, "around", 3, 4096, &around, error);
  if (result == ABBE_OK) result = read_count(r, "across", 3, 4096, &across, error);
  return result == ABBE_OK ? abbe_shape_ring(major, minor, around, across, out, error) : result;
}

static abbe_result read_gem(const reading *r, abbe_mesh *out, abbe_error *error) {
  static const char *const keys[] = {"girdle", "table", "crown", "pavilion"};
  double length[4] = {0};
  size_t sides = 6;
  abbe_result result = read_count(r, "sides", 3, 1024, &sides, error);
  for (int i = 0; i < 4 && result == ABBE_OK; i++)
    result = need_length(r, keys[i], &length[i], error);
  return result == ABBE_OK
             ? abbe_shape_gem(sides, length[0], length[1], length[2], length[3], out, error)
             : result;
}

/* Angles in degrees, the rest in shares of the diameter or of the way; 0 stays the default. */
static abbe_result read_brilliant(const reading *r, abbe_mesh *out, abbe_error *error) {
  abbe_brilliant cut = {0};
  double crown = 34.5, pavilion = 40.75;
  const struct {
    const char *key;
    double *value;
  } keys[] = {{"table", &cut.table},   {"star", &cut.star}, {"lower", &cut.lower},
              {"girdle", &cut.girdle}, {"crown", &crown},   {"pavilion", &pavilion}};
  abbe_result result = need_length(r, "diameter", &cut.diameter, error);
  for (size_t i = 0; i < sizeof keys / sizeof *keys && result == ABBE_OK; i++)
    result = abbe_yaml_get_number(r->yaml, r->node, keys[i].key, 1e-6, 90, keys[i].value, error);
  cut.crown_rad = crown * RADIANS;
  cut.pavilion_rad = pavilion * RADIANS;
  return result == ABBE_OK ? abbe_brilliant_make(&cut, out, error) : result;
}

static abbe_result read_prism(const reading *r, abbe_mesh *out, abbe_error *error) {
  double apex = 60.0, side = 0.0, length = 0.0;
  abbe_result result = abbe_yaml_get_number(r->yaml, r->node, "apex", -360, 360, &apex, error);
  if (result == ABBE_OK) result = need_length(r, "side", &side, error);
  if (result == ABBE_OK) result = need_length(r, "length", &length, error);
  return result == ABBE_OK ? abbe_shape_prism(apex * RADIANS, side, length, out, error) : result;
}

static abbe_result read_box(const reading *r, abbe_mesh *out, abbe_error *error) {
  double size[3] = {0};
  const abbe_result result = abbe_object_need_point(r->yaml, r->node, "size", size, error);
  return result == ABBE_OK ? abbe_shape_box(size, out, error) : result;
}

static abbe_result read_rectangle(const reading *r, abbe_mesh *out, abbe_error *error) {
  double width = 0.0, height = 0.0;
  abbe_result result = need_length(r, "width", &width, error);
  if (result == ABBE_OK) result = need_length(r, "height", &height, error);
  return result == ABBE_OK ? abbe_shape_rectangle(width, height, out, error) : result;
}

/* The list of [r, z] pairs under "profile". */
static abbe_result read_profile(const reading *r, double (**out)[2], size_t *count,
                                abbe_error *error) {
  abbe_yaml_node list;
  abbe_result result = abbe_yaml_require(r->yaml, r->node, "profile", &list, error);
  if (result != ABBE_OK) return result;
  *count = abbe_yaml_count(r->yaml, list);
  if (!abbe_yaml_is_sequence(r->yaml, list) || *count < 3 || *count > ABBE_SHAPE_MAX_PROFILE)
    return abbe_yaml_fail(r->yaml, list, error, "'profile' wants a list of 3 to %u points [r, z]",
                          ABBE_SHAPE_MAX_PROFILE);
  double(*profile)[2] = malloc(*count * sizeof *profile);
  if (!profile) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a lathe profile");
  for (size_t i = 0; i < *count && result == ABBE_OK; i++) {
    const abbe_yaml_node point = abbe_yaml_item(r->yaml, list, i);
    if (!abbe_yaml_is_sequence(r->yaml, point) || abbe_yaml_count(r->yaml, point) != 2)
      result = abbe_yaml_fail(r->yaml, point, error, "a point of 'profile' is two numbers [r, z]");
    for (size_t k = 0; k < 2 && result == ABBE_OK; k++)
      result = abbe_yaml_number(r->yaml, abbe_yaml_item(r->yaml, point, k), "profile", -FAR, FAR,
                                &profile[i][k], error);
  }
  if (result == ABBE_OK)
    *out = profile;
  else
    free(profile);
  return result;
}

static abbe_result read_lathe(const reading *r, abbe_mesh *out, abbe_error *error) {
  size_t around = 96, round = 0, count = 0, rounded_count = 0;
  double(*profile)[2] = NULL, (*rounded)[2] = NULL;
  abbe_result result = read_count(r, "around", 3, 4096, &around, error);
  if (result == ABBE_OK) result = read_count(r, "round", 0, 8, &round, error);
  if (result == ABBE_OK) result = read_profile(r, &profile, &count, error);
  if (result == ABBE_OK)
    result = abbe_shape_round_profile((const double(*)[2])profile, count, round, &rounded,
                                      &rounded_count, error);
  if (result == ABBE_OK)
    result = abbe_shape_lathe((const double(*)[2])rounded, rounded_count, around, out, error);
  free(profile);
  free(rounded);
  return result;
}

static abbe_result read_mesh(reading *r, abbe_object *out, abbe_error *error) {
  const bool says = abbe_yaml_get(r->yaml, r->node, "smooth").id != 0;
  char *name = NULL;
  size_t levels = 0;
  bool smooth = true;
  abbe_result result = abbe_yaml_get_string(r->yaml, r->node, "mesh", &name, error);
  if (result == ABBE_OK) result = abbe_yaml_get_bool(r->yaml, r->node, "smooth", &smooth, error);
  if (result == ABBE_OK) result = read_count(r, "subdivide", 0, 8, &levels, error);
  if (result == ABBE_OK && levels > 0 && !smooth)
    result = abbe_yaml_fail(r->yaml, r->node, error,
                            "'subdivide' makes a smooth surface; leave it out or leave out "
                            "'smooth: false'");
  if (says || levels > 0) r->normals = smooth ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_FLAT;
  if (result == ABBE_OK) out->mesh_path = abbe_object_path(r->folder, name);
  if (result == ABBE_OK && !out->mesh_path)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  if (result == ABBE_OK)
    result = abbe_mesh_load(out->mesh_path, r->normals, &out->mesh, &out->mesh_others, error);
  if (result == ABBE_OK && levels > 0) result = abbe_mesh_subdivide(&out->mesh, levels, error);
  free(name);
  return result;
}

static abbe_result read_surface(reading *r, abbe_object *object, abbe_error *error) {
  abbe_mesh *out = &object->mesh;
  const abbe_yaml_node shape = abbe_yaml_get(r->yaml, r->node, "shape");
  const abbe_yaml_node mesh = abbe_yaml_get(r->yaml, r->node, "mesh");
  if ((shape.id != 0) == (mesh.id != 0))
    return abbe_yaml_fail(r->yaml, r->node, error,
                          "an object has either a 'shape' or a 'mesh' file; this one has %s",
                          shape.id ? "both" : "neither");
  int kind = MESH;
  abbe_result result = abbe_yaml_get_choice(r->yaml, r->node, "shape", shape_names, &kind, error);
  if (result != ABBE_OK) return result;
  r->kind = (shape_kind)kind;
  switch (r->kind) {
  case SPHERE:
    result = read_sphere(r, out, error);
    break;
  case RING:
    result = read_ring(r, out, error);
    break;
  case GEM:
    result = read_gem(r, out, error);
    break;
  case BRILLIANT:
    result = read_brilliant(r, out, error);
    break;
  case PRISM:
    result = read_prism(r, out, error);
    break;
  case BOX:
    result = read_box(r, out, error);
    break;
  case RECTANGLE:
    result = read_rectangle(r, out, error);
    break;
  case LATHE:
    result = read_lathe(r, out, error);
    break;
  case MESH:
    result = read_mesh(r, object, error);
    break;
  }
  /* schema errors carry their line already; the geometry's own sentences do not */
  if (result != ABBE_OK && result != ABBE_SCHEMA)
    return abbe_object_locate(r->yaml, shape.id ? shape : mesh, result, error);
  return result;
}

/* --- transforms --- */

static abbe_result read_rotate(abbe_yaml *yaml, abbe_yaml_node node, double out[16],
                               abbe_error *error) {
  double axis[3] = {0}, angle = 0.0;
  abbe_yaml_node ignored;
  abbe_result result = abbe_object_need_point(yaml, node, "axis", axis, error);
  if (result == ABBE_OK) result = abbe_yaml_require(yaml, node, "angle", &ignored, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(yaml, node, "angle", -3600, 3600, &angle, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "'rotate'", error);
  if (result == ABBE_OK && !(abbe_vector_length(axis) > 0.0))
    result = abbe_yaml_fail(yaml, node, error, "'axis' is zero; it must point somewhere");
  if (result == ABBE_OK) abbe_transform_rotate(angle * RADIANS, axis, out);
  return result;
}

/* The origin goes to `from`, +z points to `to`, +y as near to `up` as that leaves. */
static abbe_result read_look(abbe_yaml *yaml, abbe_yaml_node node, double out[16],
                             abbe_error *error) {
  double from[3] = {0}, to[3] = {0}, up[3] = {0.0, 0.0, 1.0}, back[3], view[16];
  abbe_result result = abbe_object_need_point(yaml, node, "from", from, error);
  if (result == ABBE_OK) result = abbe_object_need_point(yaml, node, "to", to, error);
  if (result == ABBE_OK) result = abbe_yaml_get_numbers(yaml, node, "up", 3, -FAR, FAR, up, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "'look'", error);
  if (result != ABBE_OK) return result;
  for (int k = 0; k < 3; k++) back[k] = 2.0 * from[k] - to[k];
  abbe_transform_look_at(from, back, up, view);
  if (!(abbe_vector_length(up) > 0.0) || memcmp(from, to, sizeof from) == 0 ||
      !abbe_transform_inverse(view, out))
    return abbe_yaml_fail(yaml, node, error, "'look' wants 'from' and 'to' apart, and 'up' not 0");
  return ABBE_OK;
}

static abbe_result read_scale(abbe_yaml *yaml, abbe_yaml_node step, double out[16],
                              abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(yaml, step, "scale");
  double factor[3] = {1.0, 1.0, 1.0};
  abbe_result result;
  if (abbe_yaml_is_sequence(yaml, node)) {
    result = abbe_yaml_get_numbers(yaml, step, "scale", 3, -FAR, FAR, factor, error);
  } else {
    result = abbe_yaml_get_number(yaml, step, "scale", -FAR, FAR, &factor[0], error);
    factor[1] = factor[2] = factor[0];
  }
  if (result == ABBE_OK && factor[0] * factor[1] * factor[2] == 0.0)
    result = abbe_yaml_fail(yaml, node, error, "'scale' must not be zero");
  if (result == ABBE_OK) abbe_transform_scale(factor, out);
  return result;
}

static abbe_result read_step(abbe_yaml *yaml, abbe_yaml_node step, double out[16],
                             abbe_error *error) {
  double offset[3] = {0};
  const abbe_yaml_node translate = abbe_yaml_get(yaml, step, "translate");
  const abbe_yaml_node rotate = abbe_yaml_get(yaml, step, "rotate");
  const abbe_yaml_node scale = abbe_yaml_get(yaml, step, "scale");
  const abbe_yaml_node look = abbe_yaml_get(yaml, step, "look");
  abbe_result result = abbe_yaml_check_keys(yaml, step, "a step of 'transform'", error);
  if (result != ABBE_OK) return result;
  if (abbe_yaml_count(yaml, step) != 1)
    return abbe_yaml_fail(yaml, step, error,
                          "a step of 'transform' is one of translate, rotate, scale, look");
  if (rotate.id) return read_rotate(yaml, rotate, out, error);
  if (scale.id) return read_scale(yaml, step, out, error);
  if (look.id) return read_look(yaml, look, out, error);
  (void)translate;
  result = abbe_object_need_point(yaml, step, "translate", offset, error);
  if (result == ABBE_OK) abbe_transform_translate(offset, out);
  return result;
}

static abbe_result read_transform(reading *r, abbe_error *error) {
  abbe_transform_identity(r->matrix);
  const abbe_yaml_node list = abbe_yaml_get(r->yaml, r->node, "transform");
  if (list.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(r->yaml, list))
    return abbe_yaml_fail(r->yaml, list, error,
                          "'transform' wants a list of steps, such as - translate: [0, 0, 1]");
  for (size_t i = 0; i < abbe_yaml_count(r->yaml, list); i++) {
    double step[16];
    const abbe_result result = read_step(r->yaml, abbe_yaml_item(r->yaml, list, i), step, error);
    if (result != ABBE_OK) return result;
    abbe_transform_multiply(step, r->matrix, r->matrix);
  }
  return ABBE_OK;
}

/* --- what it is made of --- */

static abbe_result read_reflectance(const reading *r, abbe_object *out, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "reflectance");
  for (int k = 0; k < 3; k++) out->reflectance[k] = 1.0;
  if (abbe_yaml_is_sequence(r->yaml, node))
    return abbe_yaml_get_numbers(r->yaml, r->node, "reflectance", 3, 0, 1, out->reflectance, error);
  const abbe_result result =
      abbe_yaml_get_number(r->yaml, r->node, "reflectance", 0, 1, out->reflectance, error);
  out->reflectance[1] = out->reflectance[2] = out->reflectance[0];
  return result;
}

/* sRGB's transfer function, from encoded to linear [IEC61966]. */
static float linear(float v) {
  return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static abbe_result read_texture(const reading *r, abbe_yaml_node node, abbe_object *out,
                                abbe_error *error) {
  char *name = NULL;
  abbe_result result = abbe_yaml_get_string(r->yaml, r->node, "texture", &name, error);
  if (result == ABBE_OK && !out->mesh.uv)
    result = abbe_yaml_fail(r->yaml, node, error,
                            "a texture needs a surface with texture coordinates: a rectangle, a "
                            "box, or a mesh file that has them");
  if (result == ABBE_OK) {
    out->texture_path = abbe_object_path(r->folder, name);
    result = out->texture_path ? abbe_png_read(out->texture_path, &out->texture, error)
                               : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result != ABBE_OK) abbe_object_locate(r->yaml, node, result, error);
  }
  free(name);
  if (result != ABBE_OK) return result;
  const size_t samples = out->texture.width * out->texture.height * out->texture.channels;
  for (size_t i = 0; i < samples; i++) out->texture.data[i] = linear(out->texture.data[i]);
  return ABBE_OK;
}

static abbe_result read_receiver(const reading *r, abbe_object *out, abbe_error *error) {
  out->texture_repeat[0] = out->texture_repeat[1] = 1.0;
  abbe_result result = read_reflectance(r, out, error);
  const abbe_yaml_node texture = abbe_yaml_get(r->yaml, r->node, "texture");
  const abbe_yaml_node repeat = abbe_yaml_get(r->yaml, r->node, "repeat");
  if (result == ABBE_OK && repeat.id && !texture.id)
    result = abbe_yaml_fail(r->yaml, repeat, error, "'repeat' says nothing without a 'texture'");
  if (result == ABBE_OK)
    result =
        abbe_yaml_get_numbers(r->yaml, r->node, "repeat", 2, 1e-6, 1e6, out->texture_repeat, error);
  if (result == ABBE_OK && texture.id) result = read_texture(r, texture, out, error);
  return result;
}

static abbe_result read_substance(const reading *r, const abbe_material_table *table,
                                  abbe_object *out, abbe_error *error) {
  const abbe_yaml_node material = abbe_yaml_get(r->yaml, r->node, "material");
  const bool receives = abbe_yaml_get(r->yaml, r->node, "reflectance").id ||
                        abbe_yaml_get(r->yaml, r->node, "texture").id;
  if ((material.id != 0) == receives)
    return abbe_yaml_fail(r->yaml, r->node, error,
                          "an object has either a 'material' (it refracts) or a 'reflectance' or "
                          "'texture' (it receives light); this one has %s",
                          material.id ? "both" : "neither");
  if (!material.id) return read_receiver(r, out, error);
  char *name = NULL;
  abbe_result result = abbe_yaml_get_string(r->yaml, r->node, "material", &name, error);
  if (result == ABBE_OK) {
    result = abbe_material_table_find(table, name, &out->material, error);
    if (result != ABBE_OK) abbe_object_locate(r->yaml, material, result, error);
  }
  if (result == ABBE_OK &&
      abbe_material_is_opaque(out->material, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM)) {
    const double middle_nm = 0.5 * (ABBE_WAVELENGTH_MIN_NM + ABBE_WAVELENGTH_MAX_NM);
    const double k =
        abbe_absorption_k(abbe_material_attenuation(out->material, middle_nm), middle_nm);
    result =
        abbe_error_set(error, ABBE_UNSUPPORTED,
                       "the material '%s' absorbs light within a wavelength, as metals do (k is "
                       "%.2g at %g nm): no light comes through it, and its mirror is not "
                       "modelled; take a material with k below 0.08, or a 'reflectance'",
                       name, k, middle_nm);
    abbe_object_locate(r->yaml, material, result, error);
  }
  free(name);
  return result;
}

/* --- the surface in the world --- */

/* Faceted shapes keep one normal a face where they are mended, rounded ones one a point; of others,
 * and of files that do not say, normals go by what is there. */
static abbe_mesh_normals normals_of(const reading *r) {
  return r->kind == GEM || r->kind == BRILLIANT || r->kind == PRISM || r->kind == BOX
             ? ABBE_NORMALS_FLAT
         : r->kind == SPHERE || r->kind == RING ? ABBE_NORMALS_SMOOTH
         : r->kind == MESH                      ? r->normals
                                                : ABBE_NORMALS_AUTO;
}

static abbe_result read_size_and_place(const reading *r, abbe_object_surface *s,
                                       abbe_error *error) {
  const abbe_yaml_node fit = abbe_yaml_get(r->yaml, r->node, "fit");
  s->centred = abbe_yaml_get(r->yaml, r->node, "centre").id != 0;
  abbe_result result = abbe_yaml_get_number(r->yaml, r->node, "fit", 0, FAR, &s->fit, error);
  if (result == ABBE_OK && fit.id && !(s->fit > 0))
    result = abbe_yaml_fail(r->yaml, fit, error,
                            "'fit' is the longest side that the object is to have, in metres, "
                            "above 0");
  if (result == ABBE_OK)
    result = abbe_yaml_get_numbers(r->yaml, r->node, "centre", 3, -FAR, FAR, s->centre, error);
  return result;
}

/* What changes a mesh into a solid says nothing of shapes, which are solids, or of what receives
 * light, which need not be one. */
static abbe_result refuse_elsewhere(const reading *r, const char *key, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, key);
  const bool refracts = abbe_yaml_get(r->yaml, r->node, "material").id != 0;
  if (!node.id || (r->kind == MESH && refracts)) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, node, error, "'%s' is for the mesh of a file that refracts", key);
}

static abbe_result read_solid(const reading *r, abbe_object_surface *s, abbe_error *error) {
  abbe_result result = refuse_elsewhere(r, "repair", error);
  if (result == ABBE_OK) result = refuse_elsewhere(r, "flatten", error);
  if (result == ABBE_OK) result = abbe_yaml_get_bool(r->yaml, r->node, "repair", &s->repair, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, r->node, "flatten", 0, ABBE_CONVEX_MOST_FLATTENED,
                                  &s->flatten, error);
  if (result == ABBE_OK && s->flatten > 0 && r->normals == ABBE_NORMALS_SMOOTH)
    result = abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->node, "flatten"), error,
                            "'flatten' makes a cut solid; leave out 'smooth: true' and "
                            "'subdivide'");
  return result;
}

static abbe_result place(const reading *r, const abbe_object_surface *surface, abbe_object *out,
                         size_t room, size_t *count, abbe_error *error) {
  const abbe_result result = abbe_object_place(surface, out, room, count, error);
  if (result == ABBE_OK) return ABBE_OK;
  char sentence[900];
  snprintf(sentence, sizeof sentence, "%.890s", error ? error->text : "");
  abbe_error_set(error, result, "object '%.60s': %s", out->name, sentence);
  return abbe_object_locate(r->yaml, r->node, result, error);
}

abbe_result abbe_object_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                             const abbe_material_table *table, abbe_object *out, size_t room,
                             size_t *count, abbe_error *error) {
  ABBE_REQUIRE(yaml && folder && table && out && count, error);
  reading r = {.yaml = yaml, .node = node, .folder = folder, .normals = ABBE_NORMALS_AUTO};
  abbe_object_surface surface = {0};
  *count = 1;
  out->line = abbe_yaml_line(yaml, node);
  if (!abbe_yaml_is_mapping(yaml, node))
    return abbe_yaml_fail(yaml, node, error, "an object must be a mapping (key: value)");
  abbe_result result = abbe_yaml_get_name(yaml, node, "name", &out->name, error);
  if (result == ABBE_OK && !out->name) {
    char name[64];
    snprintf(name, sizeof name, "object on line %zu", out->line);
    out->name = strdup(name);
    if (!out->name) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  }
  if (result == ABBE_OK) result = read_surface(&r, out, error);
  if (result == ABBE_OK) result = read_transform(&r, error);
  if (result == ABBE_OK) result = read_size_and_place(&r, &surface, error);
  if (result == ABBE_OK) result = read_solid(&r, &surface, error);
  if (result == ABBE_OK) result = read_substance(&r, table, out, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "an object", error);
  if (result != ABBE_OK) return result;
  memcpy(surface.matrix, r.matrix, sizeof surface.matrix);
  surface.radius = r.kind == SPHERE ? r.radius : 0;
  surface.rectangles = r.kind == RECTANGLE || r.kind == BOX;
  surface.file = r.kind == MESH;
  surface.normals = normals_of(&r);
  return place(&r, &surface, out, room, count, error);
}
