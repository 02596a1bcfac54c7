/* abbe_scene_check: what cannot be rendered, and why. */
#include "base/maths.h"
#include "base/number.h"
#include "scenes/geometry/transform.h"
#include "scenes/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool abbe_object_contains(const abbe_object *object, const double p[3]) {
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
    if (refracts(&scene->object[i]) && abbe_object_contains(&scene->object[i], p))
      return &scene->object[i];
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
    if (near && fabs(abbe_object_distance_within(object, p, gap)) < gap) return object;
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

const abbe_object *abbe_scene_around_eye(const abbe_scene *scene) {
  return refractor_around(scene, scene->camera.eye);
}

/* A camera inside is mostly a mesh in another unit: the scene must declare that it is meant. */
static abbe_result check_inside(const abbe_scene *scene, abbe_error *error) {
  char sizes[256];
  const abbe_object *around = abbe_scene_around_eye(scene);
  if (around == NULL) return ABBE_OK;
  compare_sizes(scene, around, sizes, sizeof sizes);
  if (!scene->camera.inside)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: the camera's eye is inside the refractor '%s' (line %zu); move it "
                          "outside, or say 'inside: true' in the camera if it is meant to be%s",
                          path_of(scene), around->name, around->line, sizes);
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    const bool absorbs =
        refracts(o) && o->medium == NULL &&
        (o->material->attenuation != NULL || abbe_material_is_fluorescent(o->material));
    const bool clear = !refracts(o) || (!absorbs && !abbe_material_is_crystal(o->material));
    if (clear || !abbe_object_contains(o, scene->camera.eye)) continue;
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: the camera's eye is inside the refractor '%s' (line %zu) of the "
                          "material '%s', which %s; an eye may be inside clear glass or water, or "
                          "what has a medium",
                          path_of(scene), o->name, o->line, o->material->name,
                          absorbs ? "absorbs light" : "is a crystal");
  }
  return ABBE_OK;
}

static abbe_result check_places(const abbe_scene *scene, abbe_error *error) {
  char sizes[256];
  const double gap = least_gap(scene);
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (light->kind == ABBE_LIGHT_DIRECTIONAL) continue;
    const bool disk = abbe_light_has_size(light); /* or the one around it */
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
                            "%s: the area of the light '%s' is partly inside the refractor '%s' "
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
  return check_inside(scene, error);
}

abbe_result abbe_scene_check(const abbe_scene *scene, abbe_error *error) {
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
  if (receivers == 0 && scene->environment == NULL)
    return abbe_error_set(error, ABBE_SCHEMA,
                          "%s: the scene has no receiver, so light has nowhere to fall; give at "
                          "least one object a 'reflectance' in place of a 'material', or the scene "
                          "surroundings under 'environment', which are seen themselves",
                          path_of(scene));
  ABBE_TRY(check_places(scene, error));
  if (!seen && scene->environment == NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: no receiver is in the camera's view, so no caustic could be seen; "
                          "turn the camera towards one of the %zu receivers",
                          path_of(scene), receivers);
  return ABBE_OK;
}
