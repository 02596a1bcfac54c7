/* A scene as a binary glTF 2.0: y up, so (x, y, z) is (x, z, -y); photometric lights
 * (KHR_lights_punctual); refractors by KHR_materials_ior, transmission, volume and dispersion. */
#include "scenes/export/export_writing.h"

#include "base/file.h"
#include "base/maths.h"
#include "base/text.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/weights.h"
#include "scenes/mesh/mesh.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <cjson/cJSON.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define LUMENS 683.002 /* a watt of 555 nm [CIE015] */

typedef struct building {
  const abbe_export_writing *w;
  cJSON *root, *nodes, *meshes, *materials, *accessors, *views, *lights, *images;
  FILE *bytes;
  size_t size;
} building;

static void turn(const double from[3], double to[3]) {
  to[0] = from[0];
  to[1] = from[2];
  to[2] = -from[1];
}

static cJSON *add_numbers(cJSON *to, const char *key, const double *v, size_t count) {
  cJSON *list = cJSON_AddArrayToObject(to, key);
  for (size_t i = 0; i < count; i++) cJSON_AddItemToArray(list, cJSON_CreateNumber(v[i]));
  return list;
}

static cJSON *add_object(cJSON *list) {
  cJSON *item = cJSON_CreateObject();
  cJSON_AddItemToArray(list, item);
  return item;
}

static void put_u32(building *b, uint32_t value) {
  for (int i = 0; i < 4; i++) putc((int)(value >> 8 * i & 255), b->bytes);
  b->size += 4;
}

static void put_float(building *b, double value) {
  const float narrow = (float)value;
  uint32_t bits;
  memcpy(&bits, &narrow, sizeof bits);
  put_u32(b, bits);
}

/* ---- geometry ---- */

static size_t add_view(building *b, size_t from, int target) {
  cJSON *view = add_object(b->views);
  cJSON_AddNumberToObject(view, "buffer", 0);
  cJSON_AddNumberToObject(view, "byteOffset", (double)from);
  cJSON_AddNumberToObject(view, "byteLength", (double)(b->size - from));
  if (target != 0) cJSON_AddNumberToObject(view, "target", target);
  return (size_t)cJSON_GetArraySize(b->views) - 1;
}

static cJSON *add_accessor(building *b, size_t from, int target, int type, size_t count,
                           const char *shape) {
  const size_t view = add_view(b, from, target);
  cJSON *accessor = add_object(b->accessors);
  cJSON_AddNumberToObject(accessor, "bufferView", (double)view);
  cJSON_AddNumberToObject(accessor, "componentType", type);
  cJSON_AddNumberToObject(accessor, "count", (double)count);
  cJSON_AddStringToObject(accessor, "type", shape);
  return accessor;
}

static double last_accessor(const building *b) {
  return cJSON_GetArraySize(b->accessors) - 1;
}

static void put_vectors(building *b, const double (*v)[3], size_t count, double min[3],
                        double max[3]) {
  for (int k = 0; k < 3; k++) min[k] = DBL_MAX, max[k] = -DBL_MAX;
  for (size_t i = 0; i < count; i++) {
    double at[3];
    turn(v[i], at);
    for (int k = 0; k < 3; k++) {
      put_float(b, at[k]);
      min[k] = fmin(min[k], (double)(float)at[k]);
      max[k] = fmax(max[k], (double)(float)at[k]);
    }
  }
}

static void add_mesh(building *b, const char *name, const abbe_mesh *mesh, const double repeat[2],
                     size_t material) {
  enum { FLOAT = 5126, UNSIGNED = 5125, ARRAY = 34962, ELEMENTS = 34963 };
  double min[3], max[3], ignored[2][3];
  cJSON *item = add_object(b->meshes);
  cJSON_AddStringToObject(item, "name", name);
  cJSON *primitive = add_object(cJSON_AddArrayToObject(item, "primitives"));
  cJSON *attributes = cJSON_AddObjectToObject(primitive, "attributes");
  size_t from = b->size;
  put_vectors(b, (const double(*)[3])mesh->position, mesh->vertex_count, min, max);
  cJSON *places = add_accessor(b, from, ARRAY, FLOAT, mesh->vertex_count, "VEC3");
  add_numbers(places, "min", min, 3);
  add_numbers(places, "max", max, 3);
  cJSON_AddNumberToObject(attributes, "POSITION", last_accessor(b));
  from = b->size;
  put_vectors(b, (const double(*)[3])mesh->normal, mesh->vertex_count, ignored[0], ignored[1]);
  add_accessor(b, from, ARRAY, FLOAT, mesh->vertex_count, "VEC3");
  cJSON_AddNumberToObject(attributes, "NORMAL", last_accessor(b));
  if (mesh->uv != NULL && repeat != NULL) { /* rows of pictures go downwards with v */
    from = b->size;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
      put_float(b, repeat[0] * mesh->uv[i][0]);
      put_float(b, 1 - repeat[1] * mesh->uv[i][1]);
    }
    add_accessor(b, from, ARRAY, FLOAT, mesh->vertex_count, "VEC2");
    cJSON_AddNumberToObject(attributes, "TEXCOORD_0", last_accessor(b));
  }
  from = b->size;
  for (size_t f = 0; f < mesh->face_count; f++)
    for (int k = 0; k < 3; k++) put_u32(b, mesh->face[f][k]);
  add_accessor(b, from, ELEMENTS, UNSIGNED, 3 * mesh->face_count, "SCALAR");
  cJSON_AddNumberToObject(primitive, "indices", last_accessor(b));
  cJSON_AddNumberToObject(primitive, "material", (double)material);
  cJSON *node = add_object(b->nodes);
  cJSON_AddStringToObject(node, "name", name);
  cJSON_AddNumberToObject(node, "mesh", cJSON_GetArraySize(b->meshes) - 1);
}

/* ---- materials ---- */

static cJSON *begin_material(building *b, const char *name, const double rgb[3], double metallic,
                             double roughness) {
  const double colour[4] = {rgb[0], rgb[1], rgb[2], 1};
  cJSON *material = add_object(b->materials);
  cJSON_AddStringToObject(material, "name", name);
  cJSON *surface = cJSON_AddObjectToObject(material, "pbrMetallicRoughness");
  add_numbers(surface, "baseColorFactor", colour, 4);
  cJSON_AddNumberToObject(surface, "metallicFactor", metallic);
  cJSON_AddNumberToObject(surface, "roughnessFactor", roughness);
  return material;
}

static void add_glass(building *b, const abbe_object *o) {
  static const double white[3] = {1, 1, 1};
  const abbe_scene_export_glass *g = &b->w->report->glass[abbe_export_glass_of(b->w, o->material)];
  const double thickness = abbe_object_thickness(o);
  cJSON *material = begin_material(b, g->material->name, white, 0, 0);
  cJSON *extensions = cJSON_AddObjectToObject(material, "extensions");
  cJSON *part = cJSON_AddObjectToObject(extensions, "KHR_materials_transmission");
  cJSON_AddNumberToObject(part, "transmissionFactor", 1);
  part = cJSON_AddObjectToObject(extensions, "KHR_materials_ior");
  cJSON_AddNumberToObject(part, "ior", g->index.value[0]);
  part = cJSON_AddObjectToObject(extensions, "KHR_materials_dispersion");
  cJSON_AddNumberToObject(part, "dispersion", g->index.value[1]);
  part = cJSON_AddObjectToObject(extensions, "KHR_materials_volume");
  cJSON_AddNumberToObject(part, "thicknessFactor", thickness);
  if (g->material->attenuation == NULL) return;
  double per_m[3], left[3];
  abbe_export_attenuation_rgb(g->material, per_m);
  for (int c = 0; c < 3; c++) left[c] = abbe_absorption_transmittance(per_m[c], thickness);
  cJSON_AddNumberToObject(part, "attenuationDistance", thickness);
  add_numbers(part, "attenuationColor", left, 3);
}

static abbe_result add_texture(building *b, const abbe_object *o, cJSON *material,
                               abbe_error *error) {
  char *data = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_file_read(o->texture_path, ABBE_PNG_FREE_BYTES, &data, &size, error));
  const size_t from = b->size;
  fwrite(data, 1, size, b->bytes);
  free(data);
  b->size += size;
  cJSON *image = add_object(b->images);
  cJSON_AddNumberToObject(image, "bufferView", (double)add_view(b, from, 0));
  cJSON_AddStringToObject(image, "mimeType", "image/png");
  while (b->size % 4 != 0) {
    putc(0, b->bytes);
    b->size++;
  }
  cJSON *surface = cJSON_GetObjectItemCaseSensitive(material, "pbrMetallicRoughness");
  cJSON *texture = cJSON_AddObjectToObject(surface, "baseColorTexture");
  cJSON_AddNumberToObject(texture, "index", cJSON_GetArraySize(b->images) - 1);
  return ABBE_OK;
}

static abbe_result add_surface(building *b, const abbe_object *o, const char *name,
                               abbe_error *error) {
  if (o->material != NULL) {
    add_glass(b, o);
    return ABBE_OK;
  }
  double rgb[3];
  if (o->mirror) abbe_export_mirror_rgb(o, rgb);
  cJSON *material = begin_material(b, name, o->mirror ? rgb : o->reflectance, o->mirror,
                                   o->mirror ? sqrt(abbe_export_roughness(o)) : 1);
  cJSON_AddBoolToObject(material, "doubleSided", true);
  return o->texture_path != NULL ? add_texture(b, o, material, error) : ABBE_OK;
}

/* ---- lights and camera ---- */

/* Columns in glTF's axes. */
static void add_matrix(cJSON *node, const double a[3], const double b[3], const double c[3],
                       const double at[3]) {
  double m[16] = {0};
  turn(a, m);
  turn(b, m + 4);
  turn(c, m + 8);
  turn(at, m + 12);
  m[15] = 1;
  add_numbers(node, "matrix", m, 16);
}

static void add_camera(building *b) {
  const abbe_camera *c = &b->w->scene->camera;
  double right[3], up[3], back[3];
  cJSON *camera = add_object(cJSON_AddArrayToObject(b->root, "cameras"));
  cJSON_AddStringToObject(camera, "type", "perspective");
  cJSON *view = cJSON_AddObjectToObject(camera, "perspective");
  cJSON_AddNumberToObject(view, "aspectRatio", (double)c->width / (double)c->height);
  cJSON_AddNumberToObject(view, "yfov", c->fov_y_rad);
  cJSON_AddNumberToObject(view, "znear", 1e-3);
  cJSON *node = add_object(b->nodes);
  cJSON_AddStringToObject(node, "name", "camera");
  cJSON_AddNumberToObject(node, "camera", 0);
  abbe_export_camera(c, right, up, back);
  for (int k = 0; k < 3; k++) back[k] = -back[k];
  add_matrix(node, right, up, back, c->eye);
}

/* Lumens of the power's one watt. */
static double efficacy(const abbe_illuminant *illuminant) {
  abbe_weights_range range;
  double watts = 0;
  const double from = ABBE_WAVELENGTH_MIN_NM, to = ABBE_WAVELENGTH_MAX_NM;
  abbe_weights_range_make(illuminant, from, to, &range);
  double line[ABBE_ILLUMINANT_MOST_LINES];
  const size_t points = 3 * abbe_illuminant_lines(illuminant, line);
  for (size_t i = 0; i < points; i++)
    watts += ABBE_ILLUMINANT_LINE_HALF_NM * abbe_spectrum_value(illuminant->spectrum)[i];
  for (double nm = from; nm < to && points == 0; nm += 1)
    watts +=
        0.5 * (abbe_illuminant_power(illuminant, nm) + abbe_illuminant_power(illuminant, nm + 1));
  return LUMENS * range.white_y / watts;
}

/* A light's colour, from 0 to 1 as the format wants it, and what its strength is multiplied by. */
static double light_colour(const abbe_light *light, double colour[3]) {
  abbe_export_light_rgb(&light->illuminant, colour);
  const double most = fmax(fmax(colour[0], colour[1]), colour[2]);
  for (int c = 0; c < 3; c++) colour[c] /= most;
  return most;
}

static void add_glow(building *b, const abbe_light *light, const char *name) {
  static const double black[3] = {0};
  double colour[3], most = light_colour(light, colour);
  cJSON *material = begin_material(b, name, black, 0, 1);
  add_numbers(material, "emissiveFactor", colour, 3);
  cJSON *extensions = cJSON_AddObjectToObject(material, "extensions");
  cJSON *part = cJSON_AddObjectToObject(extensions, "KHR_materials_emissive_strength");
  cJSON_AddNumberToObject(part, "emissiveStrength",
                          most * light->power * efficacy(&light->illuminant));
}

static abbe_result add_light(building *b, size_t i, abbe_error *error) {
  const abbe_light *light = &b->w->scene->light[i];
  char name[ABBE_EXPORT_NAME_SIZE];
  double colour[3], x[3], y[3], back[3] = {0, 0, 1};
  abbe_export_name(name, "l", i, light->name);
  if (abbe_light_has_size(light)) {
    abbe_mesh mesh = {0};
    const abbe_result result = abbe_export_light_mesh(light, &mesh, error);
    add_glow(b, light, name);
    if (result == ABBE_OK)
      add_mesh(b, name, &mesh, NULL, (size_t)cJSON_GetArraySize(b->materials) - 1);
    abbe_mesh_free(&mesh);
    return result;
  }
  cJSON *item = add_object(b->lights);
  cJSON_AddStringToObject(item, "name", name);
  cJSON_AddStringToObject(item, "type",
                          light->kind == ABBE_LIGHT_POINT  ? "point"
                          : light->kind == ABBE_LIGHT_SPOT ? "spot"
                                                           : "directional");
  const double most = light_colour(light, colour);
  add_numbers(item, "color", colour, 3);
  cJSON_AddNumberToObject(item, "intensity", most * light->power * efficacy(&light->illuminant));
  if (light->kind == ABBE_LIGHT_SPOT) {
    cJSON *spot = cJSON_AddObjectToObject(item, "spot");
    const double inner = fmax(light->cone_rad - light->soft_rad, 0);
    cJSON_AddNumberToObject(spot, "innerConeAngle", fmin(inner, 0.999999 * light->cone_rad));
    cJSON_AddNumberToObject(spot, "outerConeAngle", light->cone_rad);
  }
  for (int k = 0; k < 3 && light->kind != ABBE_LIGHT_POINT; k++) back[k] = -light->direction[k];
  abbe_export_basis(back, x, y);
  cJSON *node = add_object(b->nodes);
  cJSON_AddStringToObject(node, "name", name);
  add_matrix(node, x, y, back, light->position);
  cJSON *extensions = cJSON_AddObjectToObject(node, "extensions");
  cJSON *part = cJSON_AddObjectToObject(extensions, "KHR_lights_punctual");
  cJSON_AddNumberToObject(part, "light", cJSON_GetArraySize(b->lights) - 1);
  return ABBE_OK;
}

/* ---- the file ---- */

static void add_asset(building *b) {
  const abbe_scene_export_report *r = b->w->report;
  char text[512];
  cJSON *asset = cJSON_AddObjectToObject(b->root, "asset");
  cJSON_AddStringToObject(asset, "version", "2.0");
  cJSON_AddStringToObject(asset, "generator", "abbe");
  cJSON *extras = cJSON_AddObjectToObject(asset, "extras");
  cJSON *glasses = cJSON_AddArrayToObject(extras, "materials");
  for (size_t i = 0; i < r->glass_count; i++) {
    cJSON *glass = add_object(glasses);
    cJSON_AddStringToObject(glass, "name", r->glass[i].material->name);
    cJSON_AddNumberToObject(glass, "worst", r->glass[i].index.worst);
    cJSON_AddNumberToObject(glass, "worst_nm", r->glass[i].index.worst_nm);
    cJSON_AddNumberToObject(glass, "rms", r->glass[i].index.rms);
  }
  cJSON *notes = cJSON_AddArrayToObject(extras, "notes");
  for (size_t i = 0; i < r->notes.count; i++) {
    const abbe_note *note = &r->notes.note[i];
    snprintf(text, sizeof text, "%s: %s: %s", abbe_note_kind_word(note->kind), note->name,
             note->text);
    cJSON_AddItemToArray(notes, cJSON_CreateString(text));
  }
}

/* The names of all extensions that stand in what was built. */
static void add_extensions(building *b) {
  static const char *const all[] = {
      "KHR_lights_punctual",  "KHR_materials_ior",        "KHR_materials_transmission",
      "KHR_materials_volume", "KHR_materials_dispersion", "KHR_materials_emissive_strength"};
  const bool used[] = {cJSON_GetArraySize(b->lights) > 0, b->w->report->glass_count > 0,
                       b->w->report->glass_count > 0,     b->w->report->glass_count > 0,
                       b->w->report->glass_count > 0,     false};
  bool glows = false;
  for (size_t i = 0; i < b->w->scene->light_count; i++)
    glows = glows || abbe_light_has_size(&b->w->scene->light[i]);
  cJSON *list = cJSON_CreateArray();
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (used[i] || (i == 5 && glows)) cJSON_AddItemToArray(list, cJSON_CreateString(all[i]));
  if (cJSON_GetArraySize(list) > 0)
    cJSON_AddItemToObject(b->root, "extensionsUsed", list);
  else
    cJSON_Delete(list);
}

static void add_list(building *b, const char *key, cJSON *list) {
  if (cJSON_GetArraySize(list) > 0)
    cJSON_AddItemToObject(b->root, key, list);
  else
    cJSON_Delete(list);
}

static void add_lists(building *b) {
  cJSON *scene = add_object(cJSON_AddArrayToObject(b->root, "scenes"));
  cJSON *roots = cJSON_AddArrayToObject(scene, "nodes");
  for (int i = 0; i < cJSON_GetArraySize(b->nodes); i++)
    cJSON_AddItemToArray(roots, cJSON_CreateNumber(i));
  cJSON_AddNumberToObject(b->root, "scene", 0);
  add_extensions(b);
  if (cJSON_GetArraySize(b->lights) > 0) {
    cJSON *extensions = cJSON_AddObjectToObject(b->root, "extensions");
    cJSON *part = cJSON_AddObjectToObject(extensions, "KHR_lights_punctual");
    cJSON_AddItemToObject(part, "lights", b->lights);
  } else {
    cJSON_Delete(b->lights);
  }
  if (cJSON_GetArraySize(b->images) > 0) {
    cJSON *textures = cJSON_AddArrayToObject(b->root, "textures");
    for (int i = 0; i < cJSON_GetArraySize(b->images); i++)
      cJSON_AddNumberToObject(add_object(textures), "source", i);
  }
  add_list(b, "nodes", b->nodes);
  add_list(b, "meshes", b->meshes);
  add_list(b, "materials", b->materials);
  add_list(b, "accessors", b->accessors);
  add_list(b, "bufferViews", b->views);
  add_list(b, "images", b->images);
  cJSON *buffer = add_object(cJSON_AddArrayToObject(b->root, "buffers"));
  cJSON_AddNumberToObject(buffer, "byteLength", (double)b->size);
}

static void put_word(FILE *file, uint32_t value) {
  for (int i = 0; i < 4; i++) putc((int)(value >> 8 * i & 255), file);
}

static abbe_result write_binary(const abbe_export_writing *w, const char *json, const char *bytes,
                                size_t size, abbe_error *error) {
  enum { JSON = 0x4e4f534a, BIN = 0x004e4942, MAGIC = 0x46546c67 };
  const size_t length = strlen(json), pad = (4 - length % 4) % 4;
  if (length + size > UINT32_MAX - 64)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the scene needs more than the 4 GiB that a glTF binary can have");
  put_word(w->file, MAGIC);
  put_word(w->file, 2);
  put_word(w->file, (uint32_t)(12 + 8 + length + pad + 8 + size));
  put_word(w->file, (uint32_t)(length + pad));
  put_word(w->file, JSON);
  fwrite(json, 1, length, w->file);
  for (size_t i = 0; i < pad; i++) putc(' ', w->file);
  put_word(w->file, (uint32_t)size);
  put_word(w->file, BIN);
  fwrite(bytes, 1, size, w->file);
  return ABBE_OK;
}

static abbe_result build(building *b, abbe_error *error) {
  const abbe_scene *scene = b->w->scene;
  char name[ABBE_EXPORT_NAME_SIZE];
  abbe_result result = ABBE_OK;
  add_asset(b);
  add_camera(b);
  for (size_t i = 0; i < scene->light_count && result == ABBE_OK; i++)
    result = add_light(b, i, error);
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->cloud) continue;
    abbe_export_name(name, "o", i, o->name);
    result = add_surface(b, o, name, error);
    if (result == ABBE_OK)
      add_mesh(b, name, &o->mesh, o->texture_path != NULL ? o->texture_repeat : NULL,
               (size_t)cJSON_GetArraySize(b->materials) - 1);
  }
  if (result == ABBE_OK) {
    add_lists(b);
    return ABBE_OK;
  }
  cJSON *const lists[] = {b->nodes, b->meshes, b->materials, b->accessors,
                          b->views, b->lights, b->images};
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) cJSON_Delete(lists[i]);
  return result;
}

abbe_result abbe_export_gltf(const abbe_export_writing *w, abbe_error *error) {
  char *bytes = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&bytes, &size);
  if (memory == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a scene");
  building b = {.w = w,
                .root = cJSON_CreateObject(),
                .nodes = cJSON_CreateArray(),
                .meshes = cJSON_CreateArray(),
                .materials = cJSON_CreateArray(),
                .accessors = cJSON_CreateArray(),
                .views = cJSON_CreateArray(),
                .lights = cJSON_CreateArray(),
                .images = cJSON_CreateArray(),
                .bytes = memory};
  abbe_result result = build(&b, error);
  char *json = result == ABBE_OK ? abbe_json_text(b.root, false) : NULL;
  const bool whole = fclose(memory) == 0;
  cJSON_Delete(b.root);
  if (result == ABBE_OK && (json == NULL || !whole || size != b.size))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a scene");
  if (result == ABBE_OK) result = write_binary(w, json, bytes, size, error);
  cJSON_free(json);
  free(bytes);
  return result;
}
