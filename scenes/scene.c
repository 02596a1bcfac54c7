#include "scenes/scene.h"

#include "base/number.h"
#include "scenes/geometry/transform.h"
#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void object_free(abbe_object *object) {
  free(object->name);
  abbe_mesh_free(&object->mesh);
  free(object->exact.plane);
  free(object->exact.parallelogram);
  free(object->texture_path);
  abbe_image_free(&object->texture);
  free(object->mesh_path);
  free(object->mesh_others);
  free(object->fixes);
}

void abbe_scene_free(abbe_scene *scene) {
  if (!scene) return;
  for (size_t i = 0; i < scene->light_count; i++) {
    free(scene->light[i].name);
    abbe_illuminant_free(&scene->light[i].illuminant);
    free(scene->light[i].illuminant_path);
  }
  for (size_t i = 0; i < scene->object_count; i++) object_free(&scene->object[i]);
  abbe_environment_free(scene->environment);
  free(scene->environment);
  free(scene->light);
  free(scene->object);
  abbe_material_table_free(&scene->table);
  free(scene->path);
  free(scene->description);
  memset(scene, 0, sizeof *scene);
}

const abbe_illuminant *abbe_scene_illuminant(const abbe_scene *scene) {
  return scene->light_count > 0 ? &scene->light[0].illuminant : &scene->environment->illuminant;
}

/* The path of that index in a list of them, or NULL. */
static const char *other_file(const char *paths, size_t index) {
  if (!paths) return NULL;
  while (*paths != '\0' && index-- > 0) paths += strlen(paths) + 1;
  return *paths != '\0' ? paths : NULL;
}

static size_t other_count(const abbe_object *object) {
  size_t count = 0;
  while (other_file(object->mesh_others, count)) count++;
  return count;
}

size_t abbe_scene_file_count(const abbe_scene *scene) {
  size_t count = 4 + scene->light_count + 2 * scene->object_count;
  for (size_t i = 0; i < scene->object_count; i++) count += other_count(&scene->object[i]);
  return count;
}

const char *abbe_scene_file(const abbe_scene *scene, size_t index) {
  size_t size;
  if (index == 0) return scene->path;
  if (index == 1)
    return abbe_material_table_shipped(scene->table.path, &size) ? NULL : scene->table.path;
  index -= 2;
  if (index < scene->light_count) return scene->light[index].illuminant_path;
  index -= scene->light_count;
  if (index < 2 && !scene->environment) return NULL;
  if (index == 0) return scene->environment->path;
  if (index == 1) return scene->environment->illuminant_path;
  index -= 2;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    const size_t files = 2 + other_count(object);
    if (index == 0) return object->mesh_path;
    if (index == 1) return object->texture_path;
    if (index < files) return other_file(object->mesh_others, index - 2);
    index -= files;
  }
  return NULL;
}

const abbe_object *abbe_scene_mirror(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].mirror) return &scene->object[i];
  return NULL;
}

bool abbe_scene_bounds(const abbe_scene *scene, bool refractors, bool receivers, double min[3],
                       double max[3]) {
  bool any = false;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    const abbe_object_kind kind = abbe_object_kind_of(object);
    if ((!refractors && kind != ABBE_OBJECT_RECEIVER) ||
        (!receivers && kind != ABBE_OBJECT_REFRACTOR))
      continue;
    for (int k = 0; k < 3; k++) {
      min[k] = any ? fmin(min[k], object->min[k]) : object->min[k];
      max[k] = any ? fmax(max[k], object->max[k]) : object->max[k];
    }
    any = true;
  }
  return any;
}

static void list_lights(const abbe_scene *scene, char *out, size_t size) {
  size_t used = 0;
  out[0] = '\0';
  for (size_t i = 0; i < scene->light_count && used < size; i++)
    used += (size_t)snprintf(out + used, size - used, "%s%zu '%.40s'", i > 0 ? ", " : "", i + 1,
                             scene->light[i].name);
}

abbe_result abbe_scene_find_light(const abbe_scene *scene, const char *text, size_t *index,
                                  abbe_error *error) {
  ABBE_REQUIRE(scene && text && index, error);
  size_t found = 0;
  char names[512], *end;
  for (size_t i = 0; i < scene->light_count; i++)
    if (scene->light[i].name != NULL && strcmp(scene->light[i].name, text) == 0 && ++found == 1)
      *index = i;
  if (found == 1) return ABBE_OK;
  const unsigned long number = strtoul(text, &end, 10);
  if (found == 0 && text[0] >= '0' && text[0] <= '9' && *end == '\0' && number >= 1 &&
      number <= scene->light_count) {
    *index = number - 1;
    return ABBE_OK;
  }
  list_lights(scene, names, sizeof names);
  return abbe_error_set(
      error, ABBE_INVALID_ARGUMENT, "%s: %s light is called '%.60s'; its lights are %s",
      scene->path ? scene->path : "scene", found > 1 ? "more than one" : "no", text, names);
}

double abbe_light_profile(const abbe_light *light, const double direction[3]) {
  if (light->kind == ABBE_LIGHT_DISK)
    return fmax(abbe_vector_dot(light->direction, direction), 0.0);
  if (light->kind != ABBE_LIGHT_SPOT) return 1.0;
  const double cosine = abbe_vector_dot(light->direction, direction);
  const double outer = cos(light->cone_rad);
  const double inner = cos(fmax(light->cone_rad - light->soft_rad, 0.0));
  if (!(cosine >= outer)) return 0.0;
  if (cosine >= inner) return 1.0;
  const double x = (cosine - outer) / (inner - outer);
  return x * x * (3.0 - 2.0 * x);
}

/* The nearest place on a triangle is inside it where the plane's is, else on an edge. */
static double from_triangle(const double p[3], const double *const corner[3]) {
  double n[3], least = INFINITY;
  bool inside = true;
  abbe_vector_triangle(corner[0], corner[1], corner[2], n);
  for (int k = 0; k < 3; k++) {
    double edge[3], to[3], outward[3], apart[3];
    abbe_vector_subtract(corner[(k + 1) % 3], corner[k], edge);
    abbe_vector_subtract(p, corner[k], to);
    abbe_vector_cross(edge, n, outward);
    inside = inside && abbe_vector_dot(to, outward) <= 0;
    const double length2 = abbe_vector_dot(edge, edge);
    const double t = length2 > 0 ? abbe_vector_dot(to, edge) / length2 : 0;
    for (int c = 0; c < 3; c++) apart[c] = to[c] - fmin(fmax(t, 0), 1) * edge[c];
    least = fmin(least, abbe_vector_length(apart));
  }
  const double length = abbe_vector_length(n);
  if (!inside || !(length > 0)) return least;
  double to[3];
  abbe_vector_subtract(p, corner[0], to);
  return fabs(abbe_vector_dot(to, n)) / length;
}

double abbe_object_distance(const abbe_object *object, const double point[3]) {
  double least = INFINITY;
  if (object->exact.kind == ABBE_EXACT_SPHERE) {
    double to[3];
    abbe_vector_subtract(point, object->exact.centre, to);
    return abbe_vector_length(to) - object->exact.radius;
  }
  for (size_t i = 0; i < object->mesh.face_count; i++) {
    const uint32_t *face = object->mesh.face[i];
    const double *corner[3] = {object->mesh.position[face[0]], object->mesh.position[face[1]],
                               object->mesh.position[face[2]]};
    least = fmin(least, from_triangle(point, corner));
  }
  return least;
}

/* The normal of the largest face: of a plate, across it, however it is turned. */
static bool normal_of_largest_face(const abbe_mesh *mesh, double out[3]) {
  double most = 0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *face = mesh->face[f];
    double n[3];
    abbe_vector_triangle(mesh->position[face[0]], mesh->position[face[1]], mesh->position[face[2]],
                         n);
    if (!(abbe_vector_length(n) > most)) continue;
    most = abbe_vector_length(n);
    memcpy(out, n, sizeof n);
  }
  return most > 0 && abbe_vector_normalise(out);
}

/* Relative to a vertex: far from the origin nothing cancels. */
static double width_along(const abbe_mesh *mesh, const double direction[3]) {
  double low = 0, high = 0;
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    double from[3];
    abbe_vector_subtract(mesh->position[v], mesh->position[0], from);
    low = fmin(low, abbe_vector_dot(direction, from));
    high = fmax(high, abbe_vector_dot(direction, from));
  }
  return high - low;
}

double abbe_object_thickness(const abbe_object *object) {
  double least = INFINITY, n[3];
  for (int k = 0; k < 3; k++) least = fmin(least, object->max[k] - object->min[k]);
  if (object->exact.kind == ABBE_EXACT_SPHERE) return least;
  for (size_t i = 0; object->exact.kind == ABBE_EXACT_CONVEX && i < object->exact.count; i++)
    least = fmin(least, width_along(&object->mesh, object->exact.plane[i]));
  if (normal_of_largest_face(&object->mesh, n)) least = fmin(least, width_along(&object->mesh, n));
  return least;
}

static bool inside(const abbe_object *object, const double p[3]) {
  for (int k = 0; k < 3; k++)
    if (!(p[k] >= object->min[k] && p[k] <= object->max[k])) return false;
  if (object->exact.kind == ABBE_EXACT_SPHERE) {
    double from[3];
    abbe_vector_subtract(p, object->exact.centre, from);
    return abbe_vector_length(from) < object->exact.radius;
  }
  if (object->exact.kind == ABBE_EXACT_CONVEX) {
    for (size_t i = 0; i < object->exact.count; i++)
      if (!(abbe_vector_dot(object->exact.plane[i], p) < object->exact.plane[i][3])) return false;
    return true;
  }
  return abbe_mesh_contains(&object->mesh, p);
}

/* Distance from p to the segment from a to b. */
static double to_segment(const double p[3], const double a[3], const double b[3]) {
  double along[3], from[3];
  abbe_vector_subtract(b, a, along);
  abbe_vector_subtract(p, a, from);
  const double length2 = abbe_vector_dot(along, along);
  double t = length2 > 0.0 ? abbe_vector_dot(from, along) / length2 : 0.0;
  t = fmin(fmax(t, 0.0), 1.0);
  for (int k = 0; k < 3; k++) from[k] -= t * along[k];
  return abbe_vector_length(from);
}

/* Whether the triangle passes through the disk: the segment that it shares with the disk's plane
 * comes nearer to the centre than the radius. */
static bool triangle_cuts(const abbe_light *disk, const double *corner[3]) {
  double height[3], end[2][3];
  int ends = 0;
  for (int i = 0; i < 3; i++) {
    double from[3];
    abbe_vector_subtract(corner[i], disk->position, from);
    height[i] = abbe_vector_dot(from, disk->direction);
  }
  for (int i = 0; i < 3 && ends < 2; i++) {
    const int j = (i + 1) % 3;
    if (height[i] == 0.0) {
      memcpy(end[ends++], corner[i], sizeof *end);
    } else if (height[j] != 0.0 && (height[i] < 0.0) != (height[j] < 0.0)) {
      const double t = height[i] / (height[i] - height[j]);
      for (int k = 0; k < 3; k++) end[ends][k] = corner[i][k] + t * (corner[j][k] - corner[i][k]);
      ends++;
    }
  }
  if (ends == 0) return false;
  return to_segment(disk->position, end[0], end[ends - 1]) < disk->radius;
}

/* Whether some part of the disk lies in the solid, given that its centre does not. */
static bool cuts(const abbe_object *object, const abbe_light *disk) {
  if (object->exact.kind == ABBE_EXACT_SPHERE) {
    double from[3];
    abbe_vector_subtract(object->exact.centre, disk->position, from);
    const double height = abbe_vector_dot(from, disk->direction), r = object->exact.radius;
    if (!(fabs(height) < r)) return false;
    const double aside2 = abbe_vector_dot(from, from) - height * height;
    return sqrt(fmax(aside2, 0.0)) < disk->radius + sqrt(r * r - height * height);
  }
  for (int k = 0; k < 3; k++)
    if (disk->position[k] + disk->radius < object->min[k] ||
        disk->position[k] - disk->radius > object->max[k])
      return false;
  for (size_t f = 0; f < object->mesh.face_count; f++) {
    const uint32_t *face = object->mesh.face[f];
    const double *corner[3] = {object->mesh.position[face[0]], object->mesh.position[face[1]],
                               object->mesh.position[face[2]]};
    if (triangle_cuts(disk, corner)) return true;
  }
  return false;
}

static bool refracts(const abbe_object *object) {
  return abbe_object_kind_of(object) == ABBE_OBJECT_REFRACTOR;
}

static const abbe_object *refractor_in(const abbe_scene *scene, const abbe_light *disk) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (refracts(&scene->object[i]) && cuts(&scene->object[i], disk)) return &scene->object[i];
  return NULL;
}

static const abbe_object *refractor_around(const abbe_scene *scene, const double p[3]) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (refracts(&scene->object[i]) && inside(&scene->object[i], p)) return &scene->object[i];
  return NULL;
}

/* What is nearer to the surface of a refractor or a mirror than this, m, is on it. */
static double least_gap(const abbe_scene *scene) {
  double min[3], max[3], size[3];
  if (!abbe_scene_bounds(scene, true, abbe_scene_mirror(scene) != NULL, min, max)) return 0.0;
  abbe_vector_subtract(max, min, size);
  return ABBE_SCENE_LEAST_GAP * 0.5 * abbe_vector_length(size);
}

static const abbe_object *surface_at(const abbe_scene *scene, const double p[3], double gap) {
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    bool near = abbe_object_kind_of(object) != ABBE_OBJECT_RECEIVER;
    for (int k = 0; k < 3; k++)
      near = near && p[k] > object->min[k] - gap && p[k] < object->max[k] + gap;
    if (near && fabs(abbe_object_distance(object, p)) < gap) return object;
  }
  return NULL;
}

/* A disk that lies on a refractor's surface meets it when it is moved along its normal. */
static const abbe_object *refractor_under(const abbe_scene *scene, const abbe_light *disk,
                                          double gap) {
  const abbe_object *under = NULL;
  for (int side = -1; side <= 1 && under == NULL; side += 2) {
    abbe_light moved = *disk;
    for (int k = 0; k < 3; k++) moved.position[k] += side * gap * disk->direction[k];
    under = refractor_in(scene, &moved);
  }
  return under;
}

/* Whether three points in camera space (looking along -z) lie all beyond one side of the view. */
static bool outside_view(const double p[3][3], double tangent_x, double tangent_y) {
  int beyond[5] = {0};
  for (int i = 0; i < 3; i++) {
    const double depth = -p[i][2];
    beyond[0] += p[i][0] > tangent_x * depth;
    beyond[1] += p[i][0] < -tangent_x * depth;
    beyond[2] += p[i][1] > tangent_y * depth;
    beyond[3] += p[i][1] < -tangent_y * depth;
    beyond[4] += !(depth > 0.0);
  }
  for (int k = 0; k < 5; k++)
    if (beyond[k] == 3) return true;
  return false;
}

static bool object_in_view(const abbe_object *object, const abbe_camera *camera) {
  double view[16];
  abbe_transform_look_at(camera->eye, camera->target, camera->up, view);
  const double tangent_y = tan(0.5 * camera->fov_y_rad);
  const double tangent_x = tangent_y * (double)camera->width / (double)camera->height;
  for (size_t f = 0; f < object->mesh.face_count; f++) {
    double corner[3][3];
    for (int k = 0; k < 3; k++)
      abbe_transform_point(view, object->mesh.position[object->mesh.face[f][k]], corner[k]);
    if (!outside_view((const double(*)[3])corner, tangent_x, tangent_y)) return true;
  }
  return false;
}

static const char *path_of(const abbe_scene *scene) {
  return scene->path ? scene->path : "scene";
}

/* The longest side of some bounds. */
static double longest(const double min[3], const double max[3]) {
  return fmax(fmax(max[0] - min[0], max[1] - min[1]), max[2] - min[2]);
}

/* How large a refractor is beside all else, where that is why something stands inside it: a file in
 * millimetres makes a stone as large as a house. */
static void compare_sizes(const abbe_scene *scene, const abbe_object *around, char *text,
                          size_t size) {
  double min[3], max[3];
  bool any = false;
  text[0] = '\0';
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->line == around->line) continue; /* itself, and other parts of its mesh */
    for (int k = 0; k < 3; k++) {
      min[k] = any ? fmin(min[k], o->min[k]) : o->min[k];
      max[k] = any ? fmax(max[k], o->max[k]) : o->max[k];
    }
    any = true;
  }
  const double own = longest(around->min, around->max), rest = any ? longest(min, max) : 0;
  abbe_number_format(
      text, size, "; '%.60s' is %.3g m wide, all other objects together %.3g m%s", around->name,
      own, rest,
      own > rest ? ": if its file is in another unit, 'fit: METRES' gives it its size" : "");
}

static abbe_result check_places(const abbe_scene *scene, abbe_error *error) {
  char sizes[256];
  const double gap = least_gap(scene);
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (light->kind == ABBE_LIGHT_DIRECTIONAL) continue;
    const bool disk = light->kind == ABBE_LIGHT_DISK;
    const abbe_object *on = surface_at(scene, light->position, gap);
    const abbe_object *around = on ? NULL : refractor_around(scene, light->position);
    if (around) compare_sizes(scene, around, sizes, sizeof sizes);
    if (around)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: the light '%s' is inside the refractor '%s' (line %zu); lights "
                            "are modelled in air only, so move it outside%s",
                            path_of(scene), light->name, around->name, around->line, sizes);
    around = disk && !on ? refractor_in(scene, light) : NULL;
    if (around)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: the disk of the light '%s' is partly inside the refractor '%s' "
                            "(line %zu); lights are modelled in air only, so move it or make it "
                            "smaller",
                            path_of(scene), light->name, around->name, around->line);
    if (disk && !on) on = refractor_under(scene, light, gap);
    if (on)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: the light '%s' is on the surface of the %s '%s' (line "
                            "%zu), or less than %.2g m away, which single precision does not tell "
                            "from it; move it farther off",
                            path_of(scene), light->name,
                            abbe_object_kind_name(abbe_object_kind_of(on)), on->name, on->line,
                            gap);
  }
  const abbe_object *around = surface_at(scene, scene->camera.eye, gap);
  if (around)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: the camera's eye is on the surface of the %s '%s' (line %zu), "
                          "or less than %.2g m away, which single precision does not tell from it; "
                          "move it farther off",
                          path_of(scene), abbe_object_kind_name(abbe_object_kind_of(around)),
                          around->name, around->line, gap);
  around = refractor_around(scene, scene->camera.eye);
  if (around) compare_sizes(scene, around, sizes, sizeof sizes);
  if (around)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: the camera's eye is inside the refractor '%s' (line %zu); it is "
                          "modelled in air only, so move it outside%s",
                          path_of(scene), around->name, around->line, sizes);
  return ABBE_OK;
}

abbe_result abbe_scene_check(const abbe_scene *scene, abbe_error *error) {
  ABBE_REQUIRE(scene, error);
  if (scene->light_count == 0 && scene->environment == NULL)
    return abbe_error_set(error, ABBE_SCHEMA,
                          "%s: the scene has no light; give it at least one under 'lights', or "
                          "surroundings under 'environment'",
                          path_of(scene));
  size_t receivers = 0;
  bool seen = false;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object_kind kind = abbe_object_kind_of(&scene->object[i]);
    if (kind == ABBE_OBJECT_REFRACTOR) continue;
    receivers += kind == ABBE_OBJECT_RECEIVER;
    seen = seen || object_in_view(&scene->object[i], &scene->camera);
  }
  if (receivers == 0)
    return abbe_error_set(error, ABBE_SCHEMA,
                          "%s: the scene has no receiver, so light has nowhere to fall; give at "
                          "least one object a 'reflectance' in place of a 'material'",
                          path_of(scene));
  const abbe_result result = check_places(scene, error);
  if (result != ABBE_OK) return result;
  if (!seen)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: no receiver is in the camera's view, so no caustic could be seen; "
                          "turn the camera towards one of the %zu receivers",
                          path_of(scene), receivers);
  return ABBE_OK;
}

void abbe_object_bound(abbe_object *o) {
  for (int k = 0; k < 3; k++) {
    o->min[k] = INFINITY;
    o->max[k] = -INFINITY;
    for (size_t v = 0; v < o->mesh.vertex_count; v++) {
      o->min[k] = fmin(o->min[k], o->mesh.position[v][k]);
      o->max[k] = fmax(o->max[k], o->mesh.position[v][k]);
    }
    if (o->exact.kind != ABBE_EXACT_SPHERE) continue;
    o->min[k] = o->exact.centre[k] - o->exact.radius;
    o->max[k] = o->exact.centre[k] + o->exact.radius;
  }
}
