#include "scenes/import/scene_reading.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/image/png_file.h"
#include "scenes/geometry/transform.h"
#include "scenes/import/scene_value.h"
#include "scenes/medium/medium.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- transforms --- */

static abbe_result read_rotate(abbe_yaml *yaml, abbe_yaml_node node, double out[16],
                               abbe_error *error) {
  double axis[3] = {0}, angle = 0.0;
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_scene_value_point(yaml, node, "axis", axis, error));
  ABBE_TRY(abbe_yaml_require(yaml, node, "angle", &ignored, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "angle", -3600, 3600, &angle, error));
  ABBE_TRY(abbe_yaml_check_keys(yaml, node, "'rotate'", error));
  if (!(abbe_vector_length(axis) > 0.0))
    return abbe_yaml_fail(yaml, node, error, "'axis' is zero; it must point somewhere");
  abbe_transform_rotate(angle * ABBE_DEGREE, axis, out);
  return ABBE_OK;
}

/* The origin goes to `from`, +z points to `to`, +y as near to `up` as that leaves. */
static abbe_result read_look(abbe_yaml *yaml, abbe_yaml_node node, double out[16],
                             abbe_error *error) {
  double from[3] = {0}, to[3] = {0}, up[3] = {0.0, 0.0, 1.0}, back[3], view[16];
  ABBE_TRY(abbe_scene_value_point(yaml, node, "from", from, error));
  ABBE_TRY(abbe_scene_value_point(yaml, node, "to", to, error));
  ABBE_TRY(abbe_yaml_get_numbers(yaml, node, "up", 3, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, up, error));
  ABBE_TRY(abbe_yaml_check_keys(yaml, node, "'look'", error));
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
  if (abbe_yaml_is_sequence(yaml, node)) {
    ABBE_TRY(abbe_yaml_get_numbers(yaml, step, "scale", 3, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, factor,
                                   error));
  } else {
    ABBE_TRY(abbe_yaml_get_number(yaml, step, "scale", -ABBE_SCENE_FAR, ABBE_SCENE_FAR, &factor[0],
                                  error));
    factor[1] = factor[2] = factor[0];
  }
  if (factor[0] * factor[1] * factor[2] == 0.0)
    return abbe_yaml_fail(yaml, node, error, "'scale' must not be zero");
  abbe_transform_scale(factor, out);
  return ABBE_OK;
}

static abbe_result read_step(abbe_yaml *yaml, abbe_yaml_node step, double out[16],
                             abbe_error *error) {
  double offset[3] = {0};
  const abbe_yaml_node translate = abbe_yaml_get(yaml, step, "translate");
  const abbe_yaml_node rotate = abbe_yaml_get(yaml, step, "rotate");
  const abbe_yaml_node scale = abbe_yaml_get(yaml, step, "scale");
  const abbe_yaml_node look = abbe_yaml_get(yaml, step, "look");
  ABBE_TRY(abbe_yaml_check_keys(yaml, step, "a step of 'transform'", error));
  if (abbe_yaml_count(yaml, step) != 1)
    return abbe_yaml_fail(yaml, step, error,
                          "a step of 'transform' is one of translate, rotate, scale, look");
  if (rotate.id) return read_rotate(yaml, rotate, out, error);
  if (scale.id) return read_scale(yaml, step, out, error);
  if (look.id) return read_look(yaml, look, out, error);
  (void)translate;
  ABBE_TRY(abbe_scene_value_point(yaml, step, "translate", offset, error));
  abbe_transform_translate(offset, out);
  return ABBE_OK;
}

static abbe_result read_transform(abbe_object_reading *r, abbe_error *error) {
  abbe_transform_identity(r->matrix);
  const abbe_yaml_node list = abbe_yaml_get(r->yaml, r->node, "transform");
  if (list.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(r->yaml, list))
    return abbe_yaml_fail(r->yaml, list, error,
                          "'transform' wants a list of steps, such as - translate: [0, 0, 1]");
  for (size_t i = 0; i < abbe_yaml_count(r->yaml, list); i++) {
    double step[16];
    ABBE_TRY(read_step(r->yaml, abbe_yaml_item(r->yaml, list, i), step, error));
    abbe_transform_multiply(step, r->matrix, r->matrix);
  }
  return ABBE_OK;
}

/* --- what it is made of --- */

static abbe_result read_reflectance(const abbe_object_reading *r, abbe_object *out,
                                    abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "reflectance");
  for (int k = 0; k < 3; k++) out->reflectance[k] = 1.0;
  if (abbe_yaml_is_mapping(r->yaml, node))
    return abbe_reflectance_file_read(r->yaml, node, r->folder, out, error);
  if (abbe_yaml_is_sequence(r->yaml, node))
    return abbe_yaml_get_numbers(r->yaml, r->node, "reflectance", 3, 0, 1, out->reflectance, error);
  ABBE_TRY(abbe_yaml_get_number(r->yaml, r->node, "reflectance", 0, 1, out->reflectance, error));
  out->reflectance[1] = out->reflectance[2] = out->reflectance[0];
  return ABBE_OK;
}

/* sRGB's transfer function, from encoded to linear [IEC61966]. */
static float linear(float v) {
  return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static abbe_result read_texture(const abbe_object_reading *r, abbe_yaml_node node, abbe_object *out,
                                abbe_error *error) {
  char *name = NULL;
  abbe_result result = abbe_yaml_get_string(r->yaml, r->node, "texture", &name, error);
  if (result == ABBE_OK && !out->mesh.uv)
    result = abbe_yaml_fail(r->yaml, node, error,
                            "a texture needs a surface with texture coordinates: a rectangle, a "
                            "box, or a mesh file that has them");
  if (result == ABBE_OK) {
    out->texture_path = abbe_scene_value_path(r->folder, name);
    result = out->texture_path ? abbe_png_read(out->texture_path, &out->texture, error)
                               : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result != ABBE_OK) abbe_scene_value_locate(r->yaml, node, result, error);
  }
  free(name);
  if (result != ABBE_OK) return result;
  const size_t samples = out->texture.width * out->texture.height * out->texture.channels;
  for (size_t i = 0; i < samples; i++) out->texture.data[i] = linear(out->texture.data[i]);
  return ABBE_OK;
}

static abbe_result read_receiver(const abbe_object_reading *r, abbe_object *out,
                                 abbe_error *error) {
  out->texture_repeat[0] = out->texture_repeat[1] = 1.0;
  ABBE_TRY(read_reflectance(r, out, error));
  const abbe_yaml_node texture = abbe_yaml_get(r->yaml, r->node, "texture");
  const abbe_yaml_node repeat = abbe_yaml_get(r->yaml, r->node, "repeat");
  if (repeat.id && !texture.id)
    return abbe_yaml_fail(r->yaml, repeat, error, "'repeat' says nothing without a 'texture'");
  ABBE_TRY(
      abbe_yaml_get_numbers(r->yaml, r->node, "repeat", 2, 1e-6, 1e6, out->texture_repeat, error));
  if (texture.id && out->spectrum != NULL)
    return abbe_yaml_fail(r->yaml, texture, error,
                          "a texture multiplies a reflectance in red, green and blue; leave it "
                          "out, or the spectrum");
  if (texture.id) ABBE_TRY(read_texture(r, texture, out, error));
  return ABBE_OK;
}

/* Why nothing is seen through it, and what to do. */
static abbe_result refuse_opaque(const abbe_object_reading *r, abbe_yaml_node node,
                                 const abbe_material *m, abbe_error *error) {
  const double middle_nm = 0.5 * (ABBE_WAVELENGTH_MIN_NM + ABBE_WAVELENGTH_MAX_NM);
  const double k = abbe_absorption_k(abbe_material_attenuation(m, middle_nm), middle_nm);
  if (abbe_material_is_conductor(m))
    abbe_error_set(error, ABBE_UNSUPPORTED,
                   "the material '%s' is a conductor: no light comes through it; say 'mirror: %s' "
                   "in place of 'material: %s'",
                   m->name, m->name, m->name);
  else
    abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the material '%s' absorbs light within a wavelength, as metals do (k is %.2g at "
        "%g nm): no light comes through it; take a material with k below 0.08, or write "
        "its n and k as 'model: conductor' and say 'mirror: %s'",
        m->name, k, middle_nm, m->name);
  return abbe_scene_value_locate(r->yaml, node, ABBE_UNSUPPORTED, error);
}

static abbe_result find_material(const abbe_object_reading *r, const char *key,
                                 const abbe_material_table *table, const abbe_material **out,
                                 abbe_error *error) {
  char *name = NULL;
  abbe_result result = abbe_yaml_get_string(r->yaml, r->node, key, &name, error);
  if (result == ABBE_OK) {
    result = abbe_material_table_find(table, name, out, error);
    if (result != ABBE_OK)
      abbe_scene_value_locate(r->yaml, abbe_yaml_get(r->yaml, r->node, key), result, error);
  }
  free(name);
  return result;
}

static abbe_result read_refractor(const abbe_object_reading *r, abbe_yaml_node node,
                                  const abbe_material_table *table, abbe_object *out,
                                  abbe_error *error) {
  const char *text = abbe_yaml_text(r->yaml, node);
  const bool own = text != NULL && strcmp(text, ABBE_OBJECT_FROM_FILE) == 0;
  if (own && out->own_material == NULL)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'material: from-file' is for the 'mesh' of a .gltf or .glb file");
  const abbe_result result =
      own ? ABBE_OK : find_material(r, "material", table, &out->material, error);
  if (own) out->material = out->own_material;
  if (result != ABBE_OK ||
      !abbe_material_is_opaque(out->material, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM))
    return result;
  return refuse_opaque(r, node, out->material, error);
}

/* A number, or the name of a conductor. */
static abbe_result read_mirror(const abbe_object_reading *r, abbe_yaml_node node,
                               const abbe_material_table *table, abbe_object *out,
                               abbe_error *error) {
  const char *text = abbe_yaml_text(r->yaml, node), *end = "";
  double number;
  out->mirror = true;
  const bool signs = text != NULL && text[0] != '\0' && strchr(".+-", text[0]) != NULL; /* .nan */
  if (signs || (text != NULL && abbe_number_read(text, &end, &number) && *end == '\0'))
    return abbe_yaml_get_number(r->yaml, r->node, "mirror", 0, 1, &out->mirror_reflectance, error);
  ABBE_TRY(find_material(r, "mirror", table, &out->conductor, error));
  if (abbe_material_is_conductor(out->conductor)) return ABBE_OK;
  abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the material '%s' is no conductor, so 'mirror' cannot be of it; take a metal such "
      "as silver, or a reflectance from 0 to 1; %s",
      out->conductor->name,
      abbe_material_is_opaque(out->conductor, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM)
          ? "a metal's record is of the model conductor, with points [nm, n, k]"
          : "a glass stands under 'material'");
  return abbe_scene_value_locate(r->yaml, node, ABBE_UNSUPPORTED, error);
}

/* What does not refract has no inside. */
static abbe_result read_medium(const abbe_object_reading *r, abbe_object *out, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "medium");
  abbe_yaml_get(r->yaml, r->node, "clouds"); /* read where the object is placed */
  if (node.id == 0) return ABBE_OK;
  if (out->material == NULL)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'medium' is what scatters inside of an object that refracts; this one "
                          "has no 'material' (the air's 'medium' stands beside 'objects')");
  return abbe_medium_file_read(r->yaml, r->node, false, &out->medium, error);
}

/* One number, or one along the grooves and one across. */
static abbe_result read_roughness(const abbe_object_reading *r, abbe_yaml_node node,
                                  abbe_microfacets *out, abbe_error *error) {
  double both[2] = {0, 0};
  if (abbe_yaml_is_sequence(r->yaml, node)) {
    ABBE_TRY(abbe_yaml_get_numbers(r->yaml, r->node, "roughness", 2, 0, 1, both, error));
  } else {
    ABBE_TRY(abbe_yaml_get_number(r->yaml, r->node, "roughness", 0, 1, &both[0], error));
    both[1] = both[0];
  }
  const double least = fmin(both[0], both[1]), most = fmax(both[0], both[1]);
  if (most > 0 && least < ABBE_MICROFACETS_LEAST)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'roughness' is 0, of a smooth mirror, or from %g to 1, both along the "
                          "grooves and across",
                          ABBE_MICROFACETS_LEAST);
  *out = (abbe_microfacets){both[0], both[1]};
  return ABBE_OK;
}

/* In the object's own coordinates, until it is placed. */
static abbe_result read_grooves(const abbe_object_reading *r, abbe_yaml_node node,
                                abbe_brushing *out, abbe_error *error) {
  const abbe_yaml_node along = abbe_yaml_get(r->yaml, node, "along");
  const abbe_yaml_node around = abbe_yaml_get(r->yaml, node, "around");
  if (!abbe_yaml_is_mapping(r->yaml, node) || (along.id != 0) == (around.id != 0))
    return abbe_yaml_fail(r->yaml, node, error,
                          "'brushed' wants {along: [x, y, z]} or {around: [x, y, z]}: grooves that "
                          "run that way, or around that axis");
  out->around = around.id != 0;
  ABBE_TRY(
      abbe_scene_value_point(r->yaml, node, out->around ? "around" : "along", out->axis, error));
  ABBE_TRY(abbe_yaml_check_keys(r->yaml, node, "'brushed'", error));
  if (!abbe_vector_normalise(out->axis))
    return abbe_yaml_fail(r->yaml, node, error, "'brushed' is zero; it must point somewhere");
  return ABBE_OK;
}

static abbe_result read_brushing(const abbe_object_reading *r, abbe_object *out,
                                 abbe_error *error) {
  const abbe_yaml_node rough = abbe_yaml_get(r->yaml, r->node, "roughness");
  const abbe_yaml_node brushed = abbe_yaml_get(r->yaml, r->node, "brushed");
  const bool refracts = out->material != NULL; /* its roughness is read with its coatings */
  if ((rough.id == 0 || refracts) && brushed.id == 0) return ABBE_OK;
  if (!out->mirror)
    return abbe_yaml_fail(
        r->yaml, rough.id && !refracts ? rough : brushed, error,
        "'%s' is of a mirror; %s: leave it out", rough.id && !refracts ? "roughness" : "brushed",
        refracts ? "what refracts has no grooves here" : "what receives light scatters it evenly");
  if (rough.id == 0)
    return abbe_yaml_fail(r->yaml, brushed, error,
                          "'brushed' says which way grooves run; a 'roughness: [along, across]' "
                          "says how deep they are");
  ABBE_TRY(read_roughness(r, rough, &out->brushing.facets, error));
  if (brushed.id) ABBE_TRY(read_grooves(r, brushed, &out->brushing, error));
  const abbe_microfacets *m = &out->brushing.facets;
  if (!brushed.id && (m->x < m->y || m->y < m->x))
    return abbe_yaml_fail(r->yaml, rough, error,
                          "a 'roughness' of two numbers wants 'brushed: {along: [x, y, z]}' or "
                          "'{around: ...}', which says which way the grooves run");
  return ABBE_OK;
}

static abbe_result read_substance(const abbe_object_reading *r, const abbe_material_table *table,
                                  abbe_object *out, abbe_error *error) {
  const abbe_yaml_node material = abbe_yaml_get(r->yaml, r->node, "material");
  const abbe_yaml_node mirror = abbe_yaml_get(r->yaml, r->node, "mirror");
  const bool receives = abbe_yaml_get(r->yaml, r->node, "reflectance").id ||
                        abbe_yaml_get(r->yaml, r->node, "texture").id;
  const int found = (material.id != 0) + (mirror.id != 0) + receives;
  static const char *const keys[] = {"material", "mirror", "reflectance", "texture"};
  for (int i = 0; i < 4 && found == 0; i++) {
    const abbe_result mistyped = abbe_yaml_refuse_near(r->yaml, r->node, keys[i], error);
    if (mistyped != ABBE_OK) return mistyped;
  }
  if (found != 1)
    return abbe_yaml_fail(
        r->yaml, r->node, error,
        "an object has one of these: a 'material' (it refracts), a 'mirror' (it "
        "reflects), or a 'reflectance' or 'texture' (it receives light); this one "
        "has %s",
        found == 0 ? "none" : "more than one");
  ABBE_TRY(material.id ? read_refractor(r, material, table, out, error)
           : mirror.id ? read_mirror(r, mirror, table, out, error)
                       : read_receiver(r, out, error));
  ABBE_TRY(abbe_object_read_axes(r, out, error));
  ABBE_TRY(read_brushing(r, out, error));
  ABBE_TRY(abbe_object_read_coating(r, table, out, error));
  return read_medium(r, out, error);
}

/* --- the surface in the world --- */

/* Faceted shapes keep one normal a face where they are fixed, rounded ones one a point; of others,
 * and of files that do not say, normals go by what is there. */
static abbe_mesh_normals normals_of(const abbe_object_reading *r) {
  return r->form == ABBE_OBJECT_GEM || r->form == ABBE_OBJECT_BRILLIANT ||
                 r->form == ABBE_OBJECT_PRISM || r->form == ABBE_OBJECT_BOX ||
                 r->form == ABBE_OBJECT_CUT
             ? ABBE_NORMALS_FLAT
         : r->form == ABBE_OBJECT_SPHERE || r->form == ABBE_OBJECT_RING ? ABBE_NORMALS_SMOOTH
         : r->form == ABBE_OBJECT_MESH                                  ? r->normals
                                                                        : ABBE_NORMALS_AUTO;
}

/* A size above 0, m; 0 without the key. */
static abbe_result read_extent(const abbe_object_reading *r, const char *key, const char *what,
                               double *out, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, key);
  ABBE_TRY(abbe_yaml_get_length(r->yaml, r->node, key, 0, ABBE_SCENE_FAR, out, error));
  if (node.id == 0 || *out > 0) return ABBE_OK;
  return abbe_yaml_fail(r->yaml, node, error, "'%s' is %s, in metres, above 0", key, what);
}

static abbe_result read_size_and_place(const abbe_object_reading *r, abbe_object_surface *s,
                                       abbe_error *error) {
  const abbe_yaml_node stand = abbe_yaml_get(r->yaml, r->node, "stand");
  const bool centre = abbe_yaml_get(r->yaml, r->node, "centre").id != 0;
  s->stands = stand.id != 0;
  s->centred = centre || s->stands;
  if (centre && s->stands)
    return abbe_yaml_fail(r->yaml, stand, error,
                          "'stand' places the underside, 'centre' the middle: one of the two");
  abbe_result result =
      read_extent(r, "fit", "the longest side that the object is to have", &s->fit, error);
  if (result == ABBE_OK && r->form == ABBE_OBJECT_MESH)
    result =
        read_extent(r, "width", "the smaller side of the object along x and y", &s->width, error);
  if (result == ABBE_OK && s->width > 0 && s->fit > 0)
    return abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, r->node, "fit"), error,
                          "'fit' and 'width' both give the mesh its size: one of the two");
  return result != ABBE_OK
             ? result
             : abbe_yaml_get_lengths(r->yaml, r->node, s->stands ? "stand" : "centre", 3,
                                     -ABBE_SCENE_FAR, ABBE_SCENE_FAR, s->centre, error);
}

/* What changes a mesh into a solid says nothing of shapes, which are solids, or of what receives
 * light, which need not be one. */
static abbe_result read_solid(const abbe_object_reading *r, abbe_object_surface *s,
                              abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "flatten");
  const bool refracts = abbe_yaml_get(r->yaml, r->node, "material").id != 0;
  if (node.id && !(r->form == ABBE_OBJECT_MESH && refracts))
    return abbe_yaml_fail(r->yaml, node, error,
                          "'flatten' is for the mesh of a file that refracts");
  ABBE_TRY(abbe_yaml_get_number(r->yaml, r->node, "flatten", 0, ABBE_CONVEX_MOST_FLATTENED,
                                &s->flatten, error));
  if (s->flatten > 0 && r->normals == ABBE_NORMALS_SMOOTH)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'flatten' makes a cut solid; leave out 'smooth: true' and "
                          "'subdivide'");
  return ABBE_OK;
}

static abbe_result place(const abbe_object_reading *r, const abbe_object_surface *surface,
                         abbe_object *out, size_t room, size_t *count, abbe_error *error) {
  const abbe_result result = abbe_object_place(surface, out, room, count, error);
  if (result == ABBE_OK && *count > 1 && (out->coatings != NULL || out->roughness != NULL))
    return abbe_yaml_fail(r->yaml, r->node, error,
                          "parts of '%s' cross, and films or rough facets on such a mesh are not "
                          "modelled",
                          out->name);
  if (result == ABBE_OK) {
    const abbe_result settled = abbe_object_settle_coating(r, out, error);
    return settled == ABBE_OK ? abbe_object_read_clouds(r, out, room, count, error) : settled;
  }
  char sentence[900];
  snprintf(sentence, sizeof sentence, "%.890s", error ? error->text : "");
  abbe_error_set(error, result, "object '%.60s': %s", out->name, sentence);
  return abbe_scene_value_locate(r->yaml, r->node, result, error);
}

abbe_result abbe_object_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                             const abbe_material_table *table, abbe_object *out, size_t room,
                             size_t *count, abbe_error *error) {
  abbe_object_reading r = {
      .yaml = yaml, .node = node, .folder = folder, .normals = ABBE_NORMALS_AUTO};
  abbe_object_surface surface = {0};
  abbe_object metal[ABBE_SETTINGS_MOST] = {0};
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
  if (result == ABBE_OK) result = abbe_object_read_surface(&r, out, error);
  if (result == ABBE_OK) result = read_transform(&r, error);
  if (result == ABBE_OK) result = read_size_and_place(&r, &surface, error);
  if (result == ABBE_OK) result = read_solid(&r, &surface, error);
  if (result == ABBE_OK) result = read_substance(&r, table, out, error);
  memcpy(surface.matrix, r.matrix, sizeof surface.matrix);
  surface.radius = r.form == ABBE_OBJECT_SPHERE ? r.radius : 0;
  if (result == ABBE_OK)
    result =
        abbe_setting_read(&r, table, out, &surface, room - 1, metal, &surface.setting_count, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "an object", error);
  surface.setting = metal;
  surface.rectangles = r.form == ABBE_OBJECT_RECTANGLE || r.form == ABBE_OBJECT_BOX;
  surface.file = r.form == ABBE_OBJECT_MESH;
  surface.normals = normals_of(&r);
  if (result == ABBE_OK)
    result = place(&r, &surface, out, room - surface.setting_count, count, error);
  free(r.facet);
  return abbe_setting_place(&surface, result, metal, out, count, error);
}
