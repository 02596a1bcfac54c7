#include "cli/view/state/view_outline.h"

#include "base/maths.h"
#include "base/number.h"
#include "base/yaml/yaml.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_TRANSFORM = 1024 };

/* What shapes are set by, as docs/scene-files.md has them. */
static const struct {
  const char *shape, *key, *label, *unit;
  double scale, initial, min, max;
} values[] = {
    {"gem", "crown", "crown height", "mm", 1e3, 0, 0.001, 0.1},
    {"gem", "pavilion", "pavilion depth", "mm", 1e3, 0, 0.001, 0.1},
    {"gem", "girdle", "girdle radius", "mm", 1e3, 0, 0.005, 0.1},
    {"gem", "table", "table radius", "mm", 1e3, 0, 0.002, 0.1},
    {"brilliant", "crown", "crown angle", "\u00b0", 1, 34.5, 20, 50},
    {"brilliant", "pavilion", "pavilion angle", "\u00b0", 1, 40.75, 35, 50},
    {"brilliant", "table", "table, of diameter", "", 1, 0.56, 0.4, 0.75},
    {"brilliant", "diameter", "diameter", "mm", 1e3, 0, 0.001, 0.1},
    {"cut", "crown", "crown angle", "\u00b0", 1, 0, 0, 0}, /* ends and start are the design's */
    {"cut", "pavilion", "pavilion angle", "\u00b0", 1, 0, 0, 0},
    {"cut", "width", "width", "mm", 1e3, 0, 0.001, 0.1},
    {"sphere", "radius", "radius", "mm", 1e3, 0, 0.001, 0.2},
    {"ring", "major", "major radius", "mm", 1e3, 0, 0.005, 0.2},
    {"ring", "minor", "minor radius", "mm", 1e3, 0, 0.001, 0.05},
    {"prism", "apex", "apex angle", "\u00b0", 1, 60, 10, 90},
    {NULL, "fit", "longest side", "mm", 1e3, 0, 0.001, 0.1}, /* for whatever has one */
};

/* Values that set nothing but a size, which is that of `fit` where there is one. */
static const char *const sizes[] = {"diameter", "width", "radius"};

static bool is_shown(const char *shape, const char *value_of, const char *key, bool fitted) {
  if (value_of == NULL) return fitted;
  bool size = false;
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) size = size || !strcmp(key, sizes[i]);
  return shape != NULL && strcmp(value_of, shape) == 0 && !(fitted && size);
}

static void number_of(abbe_yaml *yaml, abbe_yaml_node node, const char *key, double *out) {
  abbe_yaml_get_length(yaml, node, key, -1e30, 1e30, out, NULL);
}

/* "KIND.NAME" where the name is the item's own, else "KIND.NUMBER". */
static void key_of(abbe_yaml *yaml, const char *kind, abbe_yaml_node list, size_t index,
                   char *out) {
  const char *name =
      abbe_yaml_text(yaml, abbe_yaml_get(yaml, abbe_yaml_item(yaml, list, index), "name"));
  bool own = name != NULL && strpbrk(name, "=.") == NULL && strlen(name) < ABBE_VIEW_NAME &&
             name[0] != '\0' && strspn(name, "0123456789") != strlen(name);
  for (size_t i = 0; own && i < abbe_yaml_count(yaml, list); i++) {
    const char *other =
        abbe_yaml_text(yaml, abbe_yaml_get(yaml, abbe_yaml_item(yaml, list, i), "name"));
    own = i == index || other == NULL || strcmp(other, name) != 0;
  }
  if (own)
    snprintf(out, ABBE_VIEW_KEY, "%.30s.%.90s", kind, name);
  else
    snprintf(out, ABBE_VIEW_KEY, "%.30s.%zu", kind, index);
}

static void join(const char *key, const char *value, char *out) {
  char whole[2 * ABBE_VIEW_KEY];
  snprintf(whole, sizeof whole, "%s.%s", key, value);
  memcpy(out, whole, ABBE_VIEW_KEY);
  out[ABBE_VIEW_KEY - 1] = '\0';
}

/* So near to the middle that its handle is seen. */
static void place_sun(const abbe_camera *camera, const double direction[3], abbe_view_light *out) {
  double to[3];
  abbe_vector_subtract(camera->target, camera->eye, to);
  const double away = 0.15 * abbe_vector_length(to);
  for (int k = 0; k < 3; k++) {
    out->aim[k] = camera->target[k];
    out->position[k] = camera->target[k] - away * direction[k];
  }
}

static void make_light(abbe_yaml *yaml, abbe_yaml_node list, size_t i, const abbe_scene *scene,
                       abbe_view_light *out) {
  const abbe_light *light = &scene->light[i];
  static const char *const keys[] = {"intensity", "intensity", "irradiance", "radiance",
                                     "radiance"};
  static const char *const units[] = {"W/sr", "W/sr", "W/m\u00b2", "W/(m\u00b2 sr)",
                                      "W/(m\u00b2 sr)"};
  const abbe_yaml_node node = abbe_yaml_item(yaml, list, i);
  key_of(yaml, "lights", list, i, out->key);
  snprintf(out->name, sizeof out->name, "%.79s", light->name);
  out->kind = light->kind;
  const bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL;
  out->placed = abbe_yaml_get(yaml, node, sun ? "direction" : "position").id != 0;
  memcpy(out->position, light->position, sizeof out->position);
  if (sun) place_sun(&scene->camera, light->direction, out);
  out->power = (abbe_view_value){
      .label = keys[light->kind], .unit = units[light->kind], .value = light->power, .scale = 1};
  join(out->key, keys[light->kind], out->power.key);
  /* from a round number on, which mostly stays when the value moves */
  const double decade = pow(10, ceil(log10(light->power)));
  out->power.min = decade / 100;
  out->power.max = decade * 2;
}

/* A node as one line, no longer than size. */
static bool flow(abbe_yaml *yaml, abbe_yaml_node node, char *out, size_t size) {
  const char *text = abbe_yaml_text(yaml, node);
  size_t used = 0;
  if (text != NULL) return snprintf(out, size, "%s", text) < (int)size;
  const bool mapping = abbe_yaml_is_mapping(yaml, node);
  const size_t count = abbe_yaml_count(yaml, node);
  if (size < 3) return false;
  out[used++] = mapping ? '{' : '[';
  for (size_t i = 0; i < count; i++) {
    const abbe_yaml_node value =
        mapping ? abbe_yaml_value(yaml, node, i) : abbe_yaml_item(yaml, node, i);
    const char *key = mapping ? abbe_yaml_text(yaml, abbe_yaml_key(yaml, node, i)) : "";
    const int n =
        snprintf(out + used, size - used, "%s%s%s", i > 0 ? ", " : "", key, mapping ? ": " : "");
    if (n < 0 || (size_t)n >= size - used) return false;
    used += (size_t)n;
    if (!flow(yaml, value, out + used, size - used)) return false;
    used += strlen(out + used);
  }
  if (used + 2 > size) return false;
  out[used++] = mapping ? '}' : ']';
  out[used] = '\0';
  return true;
}

/* The steps that `fit` and `centre` are, behind `used` bytes of text: the middle of what is fitted
 * comes to the origin, from where `translate` moves it to its place. False where they do not fit.
 */
static bool add_fit(const abbe_object *object, size_t used, char *text, size_t size,
                    abbe_view_object *out) {
  char scale[48] = "";
  double back[3];
  for (int k = 0; k < 3; k++) {
    out->translate[k] = out->middle[k];
    back[k] = object->centring[k] - out->middle[k];
  }
  if (out->fitted || out->sized)
    abbe_number_format(scale, sizeof scale, "{scale: %.12g}, ", object->fitted);
  const int n =
      abbe_number_format(text + used, size - used, "%s%s{translate: [%.12g, %.12g, %.12g]}",
                         used > 0 ? ", " : "", scale, back[0], back[1], back[2]);
  return n > 0 && (size_t)n < size - used;
}

/* How the object was put there; false where it does not fit in a line, or memory lacks. */
static bool read_transform(abbe_yaml *yaml, abbe_yaml_node node, const abbe_object *object,
                           abbe_view_object *out) {
  const abbe_yaml_node list = abbe_yaml_get(yaml, node, "transform");
  char text[LONGEST_TRANSFORM] = "";
  size_t count = abbe_yaml_count(yaml, list), used = 0;
  const abbe_yaml_node last = count > 0 ? abbe_yaml_item(yaml, list, count - 1) : list;
  out->fitted = abbe_yaml_get(yaml, node, "fit").id != 0;
  out->centred = abbe_yaml_get(yaml, node, "centre").id != 0;
  out->stands = abbe_yaml_get(yaml, node, "stand").id != 0;
  out->sized =
      abbe_yaml_get(yaml, node, "mesh").id != 0 && abbe_yaml_get(yaml, node, "width").id != 0;
  const bool keys = out->fitted || out->sized || out->centred || out->stands;
  if (count > 0 && !keys && abbe_yaml_get(yaml, last, "translate").id != 0) {
    abbe_yaml_get_lengths(yaml, last, "translate", 3, -1e30, 1e30, out->translate, NULL);
    count--;
  }
  for (size_t i = 0; i < count; i++) {
    if (i > 0) used += (size_t)snprintf(text + used, sizeof text - used, ", ");
    if (used + 8 > sizeof text ||
        !flow(yaml, abbe_yaml_item(yaml, list, i), text + used, sizeof text - used - 8))
      return false;
    used += strlen(text + used);
  }
  if (keys && !add_fit(object, used, text, sizeof text, out)) return false;
  return (out->before = strdup(text)) != NULL;
}

/* A value stays on its slider: angles and shares by wider ends, lengths of another scale than usual
 * by ends about them. */
static void hold_value(abbe_view_value *v) {
  const bool length = v->scale != 1 && v->value > 0;
  if (v->value >= v->min && v->value <= v->max) return;
  const double decade = length ? pow(10, ceil(log10(v->value))) : 0;
  v->min = length ? decade / 100 : fmin(v->min, v->value);
  v->max = length ? 2 * decade : fmax(v->max, v->value);
}

/* The design's own angle, and its tangent halved and doubled. False where the side has none. */
static bool start_angle(const abbe_object *object, const char *key, abbe_view_value *v) {
  const double turn = 180 / ABBE_PI;
  v->value = object->cut_deg[strcmp(key, "crown") == 0 ? 0 : 1];
  v->min = atan(0.5 * tan(v->value / turn)) * turn;
  v->max = atan(2 * tan(v->value / turn)) * turn;
  return v->value > 0;
}

static void read_values(abbe_yaml *yaml, abbe_yaml_node node, const abbe_object *object,
                        abbe_view_object *out) {
  const char *shape = abbe_yaml_text(yaml, abbe_yaml_get(yaml, node, "shape"));
  for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
    if (!is_shown(shape, values[i].shape, values[i].key, out->fitted) ||
        out->value_count == ABBE_VIEW_MOST_VALUES)
      continue;
    abbe_view_value *v = &out->value[out->value_count];
    *v = (abbe_view_value){.label = values[i].label,
                           .unit = values[i].unit,
                           .value = values[i].initial,
                           .min = values[i].min,
                           .max = values[i].max,
                           .scale = values[i].scale};
    if (v->max == 0 && !start_angle(object, values[i].key, v)) continue;
    out->value_count++;
    join(out->key, values[i].key, v->key);
    number_of(yaml, node, values[i].key, &v->value);
    hold_value(v);
  }
}

double abbe_view_outline_value(const abbe_view_value *value, const abbe_view_document *document) {
  const char *set = abbe_view_document_value(document, value->key), *end;
  double own;
  return set != NULL && abbe_number_read_length(set, &end, &own) && *end == '\0' ? own
                                                                                 : value->value;
}

/* The first of the scene's objects that item i is: a stone, its crossing parts and its setting.
 * Items of one line are not told apart. */
static const abbe_object *objects_of(const abbe_scene *scene, abbe_yaml *yaml, abbe_yaml_node list,
                                     size_t i, size_t *count) {
  const size_t line = abbe_yaml_line(yaml, abbe_yaml_item(yaml, list, i));
  const abbe_object *first = NULL;
  *count = 0;
  for (size_t k = 0; k < abbe_yaml_count(yaml, list); k++)
    if (k != i && abbe_yaml_line(yaml, abbe_yaml_item(yaml, list, k)) == line) return NULL;
  for (size_t k = 0; k < scene->object_count; k++) {
    if (scene->object[k].line != line) continue;
    if (first == NULL) first = &scene->object[k];
    ++*count;
  }
  return first;
}

static void find_bounds(const abbe_object *object, size_t count, abbe_view_object *out) {
  double min[3], max[3], size[3];
  memcpy(min, object->min, sizeof min);
  memcpy(max, object->max, sizeof max);
  for (size_t i = 1; i < count && !object[i].holds; i++)
    for (int k = 0; k < 3; k++) {
      min[k] = fmin(min[k], object[i].min[k]);
      max[k] = fmax(max[k], object[i].max[k]);
    }
  for (int k = 0; k < 3; k++) out->middle[k] = 0.5 * (min[k] + max[k]);
  abbe_vector_subtract(max, min, size);
  out->radius = 0.5 * abbe_vector_length(size);
}

/* How high the parallelogram is at a place, by x and y; false where it is upright or elsewhere. */
static bool height_at(const double p[9], const double at[3], double *out) {
  const double *u = p + 3, *v = p + 6, x = at[0] - p[0], y = at[1] - p[1];
  const double area = u[0] * v[1] - u[1] * v[0];
  const double a = (x * v[1] - y * v[0]) / area, b = (u[0] * y - u[1] * x) / area;
  *out = p[2] + a * u[2] + b * v[2];
  return fabs(area) > 1e-3 * abbe_vector_length(u) * abbe_vector_length(v) && a >= 0 && a <= 1 &&
         b >= 0 && b <= 1;
}

/* From the highest flat receiver below its middle to its underside. */
static double height_above(const abbe_scene *scene, const abbe_object *object, size_t count,
                           const double middle[3]) {
  const double *top = NULL;
  double best = -INFINITY, least = INFINITY, z = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->material != NULL || o->mirror || o->line == object->line) continue;
    for (size_t k = 0; k < o->exact.count && o->exact.kind == ABBE_EXACT_PARALLELOGRAMS; k++) {
      const double *p = o->exact.parallelogram[k];
      if (!height_at(p, middle, &z) || z <= best || z > middle[2]) continue;
      best = z;
      top = p;
    }
  }
  for (size_t i = 0; top != NULL && i < count; i++)
    for (size_t v = 0; v < object[i].mesh.vertex_count; v++) {
      height_at(top, object[i].mesh.position[v], &z);
      least = fmin(least, object[i].mesh.position[v][2] - z);
    }
  return top != NULL ? least : NAN;
}

static void make_object(abbe_yaml *yaml, abbe_yaml_node list, size_t i, const abbe_scene *scene,
                        abbe_view_outline *outline) {
  const abbe_yaml_node node = abbe_yaml_item(yaml, list, i);
  size_t count;
  const abbe_object *object = objects_of(scene, yaml, list, i, &count);
  abbe_view_object *out = &outline->object[outline->object_count];
  *out = (abbe_view_object){0};
  if (object == NULL) return;
  find_bounds(object, count, out);
  if (!read_transform(yaml, node, object, out)) return;
  if (object->cut_deg[1] > 0 && object->material != NULL) out->design = strdup(object->mesh_path);
  key_of(yaml, "objects", list, i, out->key);
  snprintf(out->name, sizeof out->name, "%.79s", object->name);
  const abbe_material *material = object->mirror ? object->conductor : object->material;
  out->mirror = object->mirror;
  out->bends = object->mirror || material != NULL;
  out->thick =
      out->bends || object->exact.kind != ABBE_EXACT_PARALLELOGRAMS || object->exact.count > 1;
  if (material != NULL) snprintf(out->material, sizeof out->material, "%.79s", material->name);
  out->above = height_above(scene, object, count, out->middle);
  out->scene_index = (size_t)(object - scene->object);
  read_values(yaml, node, object, out);
  outline->object_count++;
}

abbe_result abbe_view_outline_make(const abbe_scene *scene, const char *text, size_t size,
                                   abbe_view_outline *out, abbe_error *error) {
  abbe_yaml *yaml = NULL;
  *out = (abbe_view_outline){.camera = scene->camera};
  abbe_result result = abbe_yaml_parse(text, size, scene->path, &yaml, error);
  if (result != ABBE_OK) return result;
  const abbe_yaml_node root = abbe_yaml_root(yaml);
  const abbe_yaml_node lights = abbe_yaml_get(yaml, root, "lights");
  const abbe_yaml_node objects = abbe_yaml_get(yaml, root, "objects");
  for (size_t i = 0; i < scene->light_count && i < abbe_yaml_count(yaml, lights); i++)
    make_light(yaml, lights, i, scene, &out->light[out->light_count++]);
  for (size_t i = 0; i < abbe_yaml_count(yaml, objects); i++)
    if (out->object_count < ABBE_VIEW_MOST_OBJECTS) make_object(yaml, objects, i, scene, out);
  snprintf(out->table, sizeof out->table, "%s", scene->table.path);
  out->surrounded = scene->environment != NULL;
  out->rotate = (abbe_view_value){.key = "environment.rotate",
                                  .label = "surroundings",
                                  .unit = "\u00b0",
                                  .min = -180,
                                  .max = 180,
                                  .scale = 1};
  if (out->surrounded)
    number_of(yaml, abbe_yaml_get(yaml, root, "environment"), "rotate", &out->rotate.value);
  out->ambient = (abbe_view_value){.key = "ambient",
                                   .label = "ambient",
                                   .unit = "W/m\u00b2",
                                   .value = scene->ambient,
                                   .max = 2,
                                   .scale = 1};
  if (!abbe_view_outline_list_materials(&scene->table, out))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the names of materials");
  abbe_yaml_free(yaml);
  if (result != ABBE_OK) abbe_view_outline_free(out);
  return result;
}

void abbe_view_outline_free(abbe_view_outline *outline) {
  for (size_t i = 0; i < outline->object_count; i++) {
    free(outline->object[i].before);
    free(outline->object[i].own_before);
    free(outline->object[i].design);
  }
  for (size_t i = 0; i < outline->stone_count; i++) free(outline->stone[i]);
  for (size_t i = 0; i < outline->metal_count; i++) free(outline->metal[i]);
  *outline = (abbe_view_outline){0};
}

bool abbe_view_outline_transform(const abbe_view_object *object, double tilt_rad,
                                 const double axis[3], const double translate[3], char *out,
                                 size_t size) {
  char tilt[160] = "";
  const double degrees = tilt_rad * 180 / ABBE_PI;
  if (tilt_rad != 0)
    abbe_number_format(tilt, sizeof tilt, "%s{rotate: {axis: [%.6g, %.6g, %.6g], angle: %.6g}}",
                       object->before[0] != '\0' ? ", " : "", axis[0], axis[1], axis[2], degrees);
  const int n =
      abbe_number_format(out, size, "[%s%s%s{translate: [%.6g, %.6g, %.6g]}]", object->before, tilt,
                         object->before[0] != '\0' || tilt[0] != '\0' ? ", " : "", translate[0],
                         translate[1], translate[2]);
  return n > 0 && (size_t)n < size;
}

/* Takes over the steps before the last one, by which it rises; tilted it has another underside. */
static void set_before(abbe_view_object *object, char *before, double rises) {
  object->above = strcmp(before, object->before) == 0 ? object->above + rises : NAN;
  free(object->before);
  object->before = before;
}

/* As a value of abbe_view_outline_transform says; false for another. */
static bool place(abbe_view_object *object, const char *transform) {
  static const char word[] = "{translate: [";
  const char *last = NULL, *end;
  double to[3];
  for (const char *at = transform; (at = strstr(at, word)) != NULL; at++) last = at;
  if (transform[0] != '[' || last == NULL) return false;
  end = last + sizeof word - 1;
  for (int k = 0; k < 3; k++)
    if (!abbe_number_read(end, &end, &to[k]) || *end++ != (k < 2 ? ',' : ']')) return false;
  if (strcmp(end, "}]") != 0) return false;
  const size_t length = last > transform + 2 ? (size_t)(last - transform) - 3 : 0;
  char *before = strndup(transform + 1, length);
  if (before == NULL) return false;
  set_before(object, before, to[2] - object->translate[2]);
  for (int k = 0; k < 3; k++) object->middle[k] += to[k] - object->translate[k];
  memcpy(object->translate, to, sizeof to);
  return true;
}

static void place_own(abbe_view_object *object) {
  char *before = object->own_before != NULL ? strdup(object->own_before) : NULL;
  if (before == NULL) return;
  set_before(object, before, object->own_middle[2] - object->middle[2]);
  memcpy(object->translate, object->own_translate, sizeof object->translate);
  memcpy(object->middle, object->own_middle, sizeof object->middle);
}

/* A sun that shines so already stays where it is on its way. */
static bool place_light(abbe_view_light *light, const char *value) {
  double point[3], across[3], to[3];
  if (!abbe_view_document_read(value, point)) return false;
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
    abbe_vector_subtract(light->aim, light->position, to);
    abbe_vector_cross(to, point, across);
    const double lengths = abbe_vector_length(to) * abbe_vector_length(point);
    if (abbe_vector_length(across) <= 1e-5 * lengths) return true;
    for (int k = 0; k < 3; k++) point[k] = light->aim[k] - point[k];
  }
  memcpy(light->position, point, sizeof point);
  return true;
}

/* What the document says of where it stands, or NULL. */
static const char *place_of_light(const abbe_view_light *light, const abbe_view_document *d) {
  char key[ABBE_VIEW_KEY + 16];
  const bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL;
  snprintf(key, sizeof key, "%s.%s", light->key, sun ? "direction" : "position");
  return abbe_view_document_value(d, key);
}

static const char *place_of_object(const abbe_view_object *object, const abbe_view_document *d) {
  char key[ABBE_VIEW_KEY + 16];
  snprintf(key, sizeof key, "%s.transform", object->key);
  return abbe_view_document_value(d, key);
}

static void own_light(abbe_view_light *light, const abbe_view_document *document,
                      const abbe_view_outline *before) {
  light->owned = document != NULL && place_of_light(light, document) == NULL;
  if (light->owned) memcpy(light->own, light->position, sizeof light->own);
  for (size_t i = 0; !light->owned && i < before->light_count; i++) {
    const abbe_view_light *was = &before->light[i];
    if (strcmp(was->key, light->key) != 0 || !was->owned) continue;
    light->owned = true;
    memcpy(light->own, was->own, sizeof light->own);
  }
}

static void own_object(abbe_view_object *object, const abbe_view_document *document,
                       abbe_view_outline *before) {
  if (document != NULL && place_of_object(object, document) == NULL) {
    object->own_before = strdup(object->before);
    memcpy(object->own_translate, object->translate, sizeof object->own_translate);
    memcpy(object->own_middle, object->middle, sizeof object->own_middle);
  }
  for (size_t i = 0; object->own_before == NULL && i < before->object_count; i++) {
    abbe_view_object *was = &before->object[i];
    if (strcmp(was->key, object->key) != 0 || was->own_before == NULL) continue;
    object->own_before = was->own_before;
    was->own_before = NULL;
    memcpy(object->own_translate, was->own_translate, sizeof object->own_translate);
    memcpy(object->own_middle, was->own_middle, sizeof object->own_middle);
  }
}

void abbe_view_outline_own(abbe_view_outline *outline, const abbe_view_document *document,
                           abbe_view_outline *before) {
  for (size_t i = 0; i < outline->light_count; i++) own_light(&outline->light[i], document, before);
  for (size_t i = 0; i < outline->object_count; i++)
    own_object(&outline->object[i], document, before);
}

void abbe_view_outline_stand(abbe_view_outline *outline, const abbe_view_document *document) {
  for (size_t i = 0; i < outline->light_count; i++) {
    abbe_view_light *light = &outline->light[i];
    if (place_light(light, place_of_light(light, document)) || !light->owned) continue;
    memcpy(light->position, light->own, sizeof light->position);
  }
  for (size_t i = 0; i < outline->object_count; i++) {
    abbe_view_object *object = &outline->object[i];
    const char *value = place_of_object(object, document);
    if (value == NULL || !place(object, value)) place_own(object);
  }
}
