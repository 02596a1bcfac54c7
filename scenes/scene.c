#include "scenes/scene.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/screen/screen_png.h"

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
  abbe_spectrum_free(object->spectrum);
  free(object->spectrum_path);
  abbe_image_free(&object->texture);
  free(object->mesh_path);
  free(object->mesh_others);
  abbe_material_free(object->own_material);
  free(object->own_material);
  abbe_medium_free(object->medium);
  abbe_coatings_free(object->coatings);
  abbe_coatings_free(object->roughness);
  free(object->fixes);
}

void abbe_lights_free(abbe_light *light, size_t count) {
  if (!light) return;
  for (size_t i = 0; i < count; i++) {
    free(light[i].name);
    abbe_illuminant_free(&light[i].illuminant);
    free(light[i].illuminant_path);
  }
  free(light);
}

abbe_result abbe_scene_mark_exposure(const abbe_scene *scene, abbe_image *image,
                                     abbe_error *error) {
  const abbe_camera *c = &scene->camera;
  char text[ABBE_NUMBER_TEXT_SIZE] = "auto";
  if (!c->exposed && c->exposure == 0) return ABBE_OK;
  if (!c->exposed) abbe_number_format(text, sizeof text, "%.9g", c->exposure);
  return abbe_image_set_attribute(image, ABBE_SCREEN_EXPOSURE, text, error);
}

void abbe_scene_free(abbe_scene *scene) {
  if (!scene) return;
  abbe_lights_free(scene->light, scene->light_count);
  for (size_t i = 0; i < scene->object_count; i++) object_free(&scene->object[i]);
  abbe_environment_free(scene->environment);
  free(scene->environment);
  abbe_medium_free(scene->medium);
  free(scene->object);
  abbe_material_table_free(&scene->table);
  free(scene->path);
  free(scene->description);
  memset(scene, 0, sizeof *scene);
}

const abbe_illuminant *abbe_scene_illuminant(const abbe_scene *scene) {
  const bool own = scene->light_count > scene->environment_lights;
  return own ? &scene->light[0].illuminant : &scene->environment->illuminant;
}

/* The path of that index in a list of them, or NULL. */
static const char *other_file(const char *paths, size_t index) {
  if (!paths) return NULL;
  while (*paths != '\0' && index-- > 0) paths += strlen(paths) + 1;
  return *paths != '\0' ? paths : NULL;
}

static size_t coating_count(const abbe_object *object) {
  return object->coatings != NULL ? object->coatings->count : 0;
}

static size_t other_count(const abbe_object *object) {
  size_t count = 0;
  while (other_file(object->mesh_others, count)) count++;
  return count;
}

size_t abbe_scene_file_count(const abbe_scene *scene) {
  size_t count = 4 + scene->light_count + 3 * scene->object_count;
  for (size_t i = 0; i < scene->object_count; i++)
    count += other_count(&scene->object[i]) + coating_count(&scene->object[i]);
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
    const size_t coated = 3 + coating_count(object), files = coated + other_count(object);
    if (index == 0) return object->mesh_path;
    if (index == 1) return object->texture_path;
    if (index == 2) return object->spectrum_path;
    if (index < coated) return object->coatings->coating[index - 3].path;
    if (index < files) return other_file(object->mesh_others, index - coated);
    index -= files;
  }
  return NULL;
}

bool abbe_scene_is_hazy(const abbe_scene *scene) {
  bool hazy = scene->medium != NULL;
  for (size_t i = 0; i < scene->object_count; i++) hazy = hazy || scene->object[i].medium != NULL;
  return hazy;
}

bool abbe_scene_is_polarised(const abbe_scene *scene) {
  bool any = scene->camera.polariser.kind != ABBE_POLARISER_NONE;
  for (size_t i = 0; i < scene->light_count; i++)
    any = any || scene->light[i].polariser.kind != ABBE_POLARISER_NONE;
  return any;
}

/* Whether balls around two objects meet on some line from a place, or of w 0 along a direction. */
static bool are_in_line(const abbe_object *a, const abbe_object *b, const double from[3],
                        bool far) {
  const abbe_object *both[2] = {a, b};
  double to[2][3], reach = 0;
  for (int i = 0; i < 2; i++) {
    double size[3];
    for (int k = 0; k < 3; k++) {
      size[k] = 0.5 * (both[i]->max[k] - both[i]->min[k]);
      to[i][k] = 0.5 * (both[i]->max[k] + both[i]->min[k]) - (far ? 0 : from[k]);
    }
    const double radius = abbe_vector_length(size), away = abbe_vector_length(to[i]);
    reach += far ? radius : radius < away ? asin(radius / away) : ABBE_PI;
  }
  if (!far)
    return acos(fmax(-1, fmin(1, abbe_vector_dot(to[0], to[1]) / abbe_vector_length(to[0]) /
                                     abbe_vector_length(to[1])))) < reach;
  double apart[3], across[3];
  abbe_vector_subtract(to[0], to[1], apart);
  abbe_vector_cross(apart, from, across);
  return abbe_vector_length(across) < reach;
}

const abbe_object *abbe_scene_crystal_in_line(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->object_count; i++)
    for (size_t k = 0; k < i; k++) {
      const abbe_object *a = &scene->object[i], *b = &scene->object[k];
      if (a->material == NULL || b->material == NULL || !abbe_material_is_crystal(a->material) ||
          !abbe_material_is_crystal(b->material))
        continue;
      bool line = are_in_line(a, b, scene->camera.eye, false);
      for (size_t l = 0; l < scene->light_count; l++) {
        const bool far = scene->light[l].kind == ABBE_LIGHT_DIRECTIONAL;
        const double *from = far ? scene->light[l].direction : scene->light[l].position;
        line = line || are_in_line(a, b, from, far);
      }
      if (line) return a;
    }
  return NULL;
}

void abbe_light_upright(const double direction[3], double across[3], double up[3]) {
  const double z[3] = {0, 0, 1}, y[3] = {0, 1, 0}, upright = 1e-6;
  abbe_vector_cross(hypot(direction[0], direction[1]) < upright ? y : z, direction, across);
  abbe_vector_normalise(across);
  abbe_vector_cross(direction, across, up);
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
        (!receivers && kind == ABBE_OBJECT_RECEIVER))
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

bool abbe_light_has_size(const abbe_light *light) {
  return light->kind == ABBE_LIGHT_DISK || light->kind == ABBE_LIGHT_RECTANGLE;
}

void abbe_scene_hold_lights(const abbe_scene *scene, double min[3], double max[3]) {
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *l = &scene->light[i];
    const double *middle = l->points > 0 ? l->centre : l->position;
    if (!abbe_light_has_size(l)) continue;
    for (int k = 0; k < 3; k++) {
      const double across = sqrt(fmax(1 - l->direction[k] * l->direction[k], 0));
      const double half = l->kind == ABBE_LIGHT_DISK ? l->radius * across
                                                     : fabs(l->edge[0][k]) + fabs(l->edge[1][k]);
      min[k] = fmin(min[k], middle[k] - half);
      max[k] = fmax(max[k], middle[k] + half);
    }
  }
}

double abbe_light_area(const abbe_light *light) {
  if (light->kind == ABBE_LIGHT_DISK) return ABBE_PI * light->radius * light->radius;
  if (light->kind != ABBE_LIGHT_RECTANGLE) return 0;
  return 4 * abbe_vector_length(light->edge[0]) * abbe_vector_length(light->edge[1]);
}

double abbe_light_profile(const abbe_light *light, const double direction[3]) {
  if (abbe_light_has_size(light)) return fmax(abbe_vector_dot(light->direction, direction), 0.0);
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

/* Whether all corners lie farther than `least` from p on one side of it, along some axis. */
static bool is_beyond(const double p[3], const double *const corner[3], double least) {
  for (int k = 0; k < 3; k++) {
    const double a = corner[0][k] - p[k], b = corner[1][k] - p[k], c = corner[2][k] - p[k];
    if ((a > least && b > least && c > least) || (a < -least && b < -least && c < -least))
      return true;
  }
  return false;
}

double abbe_object_distance(const abbe_object *object, const double point[3]) {
  return abbe_object_distance_within(object, point, INFINITY);
}

double abbe_object_distance_within(const abbe_object *object, const double point[3], double most) {
  double least = most;
  if (object->exact.kind == ABBE_EXACT_SPHERE) {
    double to[3];
    abbe_vector_subtract(point, object->exact.centre, to);
    return abbe_vector_length(to) - object->exact.radius;
  }
  for (size_t i = 0; i < object->mesh.face_count; i++) {
    const uint32_t *face = object->mesh.face[i];
    const double *corner[3] = {object->mesh.position[face[0]], object->mesh.position[face[1]],
                               object->mesh.position[face[2]]};
    if (!is_beyond(point, corner, least)) least = fmin(least, from_triangle(point, corner));
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
    if (!(abbe_vector_dot(n, n) > most)) continue;
    most = abbe_vector_dot(n, n);
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
    const double at = abbe_vector_dot(direction, from);
    low = at < low ? at : low;
    high = at > high ? at : high;
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
