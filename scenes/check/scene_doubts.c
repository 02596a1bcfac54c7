#include "scenes/import/scene_file.h"

#include "base/maths.h"
#include "base/number.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

/* An object that is smaller than this share of the picture's height is not what it is of. */
#define LEAST_SEEN 0.02
/* A thing that reaches less far below its table, as a share of its height, only touches it. */
#define LEAST_SUNK 0.02

__attribute__((format(printf, 2, 3))) static void doubt(abbe_scene_doubts *out, const char *format,
                                                        ...) {
  va_list arguments;
  if (out->count == ABBE_SCENE_MOST_DOUBTS) return;
  va_start(arguments, format);
  abbe_number_format_list(out->text[out->count++], sizeof *out->text, format, arguments);
  va_end(arguments);
}

static void find_names(const abbe_scene *scene, abbe_scene_doubts *out) {
  for (size_t i = 1; i < scene->object_count; i++)
    for (size_t k = 0; k < i; k++)
      if (strcmp(scene->object[i].name, scene->object[k].name) == 0) {
        doubt(out,
              "two objects are called '%.60s' (lines %zu and %zu): --set and 'frame' cannot tell "
              "them apart; give each a name",
              scene->object[i].name, scene->object[k].line, scene->object[i].line);
        break;
      }
  for (size_t i = 1; i < scene->light_count; i++)
    for (size_t k = 0; k < i; k++)
      if (strcmp(scene->light[i].name, scene->light[k].name) == 0) {
        doubt(out, "two lights are called '%.60s'; give each a name", scene->light[i].name);
        break;
      }
}

static bool is_shown(const abbe_object *object) {
  return abbe_object_kind_of(object) != ABBE_OBJECT_RECEIVER && !object->cloud;
}

static void middle(const abbe_object *object, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = 0.5 * (object->min[k] + object->max[k]);
}

/* The largest in the picture of what refracts and reflects. */
static void find_far_eye(const abbe_scene *scene, abbe_scene_doubts *out) {
  const abbe_object *largest = NULL;
  double share = 0, away = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    double at[3], to[3], size[3];
    if (!is_shown(o)) continue;
    middle(o, at);
    abbe_vector_subtract(at, scene->camera.eye, to);
    abbe_vector_subtract(o->max, o->min, size);
    const double far = abbe_vector_length(to), high = 2 * far * tan(0.5 * scene->camera.fov_y_rad);
    if (largest != NULL && abbe_vector_length(size) / high <= share) continue;
    largest = o;
    share = abbe_vector_length(size) / high;
    away = far;
  }
  if (largest == NULL || share >= LEAST_SEEN) return;
  doubt(out,
        "the camera's eye is %.3g m away from '%.60s', which is %.2g pixels large in the picture: "
        "go nearer, or let 'frame: [%.60s]' place the camera",
        away, largest->name, share * (double)scene->camera.height, largest->name);
}

/* The plane of one of a receiver's parallelograms: normal up, through its corner. */
typedef struct table {
  const double *corner, *u, *v;
  double normal[3];
} table;

static bool table_of(const abbe_object *receiver, size_t i, table *out) {
  const double *p = receiver->exact.parallelogram[i];
  *out = (table){.corner = p, .u = p + 3, .v = p + 6};
  abbe_vector_cross(out->u, out->v, out->normal);
  return abbe_vector_normalise(out->normal);
}

static double height_over(const table *t, const double p[3]) {
  double from[3];
  abbe_vector_subtract(p, t->corner, from);
  return abbe_vector_dot(from, t->normal);
}

/* Whether the point, carried along the normal, lies within the parallelogram. */
static bool is_over(const table *t, const double p[3]) {
  double from[3], across[3], along[3];
  abbe_vector_subtract(p, t->corner, from);
  abbe_vector_cross(t->v, t->normal, across);
  abbe_vector_cross(t->normal, t->u, along);
  const double u = abbe_vector_dot(from, across) / abbe_vector_dot(t->u, across);
  const double v = abbe_vector_dot(from, along) / abbe_vector_dot(t->v, along);
  return u > 0 && u < 1 && v > 0 && v < 1;
}

/* How far below the table the object reaches; 0 where it does not stand in it. What is half as wide
 * as the table is a liquid on its bottom. */
static double sunk(const abbe_object *object, const table *t, double *high) {
  double least = INFINITY, most = -INFINITY, size[3];
  const double side = fmin(abbe_vector_length(t->u), abbe_vector_length(t->v));
  abbe_vector_subtract(object->max, object->min, size);
  if (fmax(size[0], fmax(size[1], size[2])) > 0.5 * side) return 0;
  for (size_t v = 0; v < object->mesh.vertex_count; v++) {
    const double *p = object->mesh.position[v];
    if (!is_over(t, p)) return 0;
    least = fmin(least, height_over(t, p));
    most = fmax(most, height_over(t, p));
  }
  *high = most - least;
  return least < 0 && most > 0 ? fmin(-least, most) : 0;
}

static void find_sunk(const abbe_scene *scene, abbe_scene_doubts *out) {
  for (size_t i = 0; i < scene->object_count; i++)
    for (size_t k = 0; k < scene->object_count && is_shown(&scene->object[i]); k++) {
      const abbe_object *receiver = &scene->object[k];
      if (is_shown(receiver) || receiver->exact.kind != ABBE_EXACT_PARALLELOGRAMS) continue;
      for (size_t j = 0; j < receiver->exact.count; j++) {
        table t;
        double high = 0;
        if (!table_of(receiver, j, &t)) continue;
        const double below = sunk(&scene->object[i], &t, &high);
        if (!(below > LEAST_SUNK * high)) continue;
        doubt(out,
              "'%.60s' (line %zu) stands %.2g mm deep in '%.60s': 'stand: [x, y, z]' puts its "
              "underside where it is to stand",
              scene->object[i].name, scene->object[i].line, 1e3 * below, receiver->name);
        break;
      }
    }
}

/* Whether the segment passes the parallelogram. */
static bool hides(const table *t, const double from[3], const double to[3]) {
  const double a = height_over(t, from), b = height_over(t, to);
  double at[3];
  if (!(a * b < 0)) return false;
  for (int k = 0; k < 3; k++) at[k] = from[k] + a / (a - b) * (to[k] - from[k]);
  return is_over(t, at);
}

/* Whether it stands between the light and all corners of the bounds of all that refracts and
 * reflects. */
static bool hides_all(const abbe_scene *scene, const table *t, const abbe_light *light) {
  static const double FAR = 1e6; /* a sun is there */
  size_t hidden = 0;
  for (size_t i = 0; i < scene->object_count; i++)
    for (int corner = 0; corner < 8 && is_shown(&scene->object[i]); corner++, hidden++) {
      const abbe_object *o = &scene->object[i];
      double p[3], at[3], from[3];
      middle(o, at);
      for (int k = 0; k < 3; k++) p[k] = corner >> k & 1 ? o->max[k] : o->min[k];
      for (int k = 0; k < 3; k++)
        p[k] += 1e-3 * (at[k] - p[k]); /* what stands on it is not in it */
      for (int k = 0; k < 3; k++)
        from[k] = light->kind == ABBE_LIGHT_DIRECTIONAL ? p[k] - FAR * light->direction[k]
                                                        : light->position[k];
      if (!hides(t, from, p)) return false;
    }
  return hidden > 0;
}

static void find_hidden_lamps(const abbe_scene *scene, abbe_scene_doubts *out) {
  for (size_t i = 0; i < scene->light_count; i++)
    for (size_t k = 0; k < scene->object_count; k++) {
      const abbe_light *light = &scene->light[i];
      const abbe_object *receiver = &scene->object[k];
      bool hidden = false;
      if (is_shown(receiver) || receiver->exact.kind != ABBE_EXACT_PARALLELOGRAMS) continue;
      for (size_t j = 0; j < receiver->exact.count && !hidden; j++) {
        table t;
        hidden = table_of(receiver, j, &t) && hides_all(scene, &t, light);
      }
      if (!hidden) continue;
      doubt(out,
            "the light '%.60s' reaches nothing that refracts or reflects: '%.60s' stands between; "
            "move it to the other side",
            light->name, receiver->name);
      break;
    }
}

static void find_cold_metals(const abbe_scene *scene, abbe_scene_doubts *out) {
  const double here_c = scene->conditions.temperature_c;
  for (size_t i = 0; i < scene->object_count && !isnan(here_c); i++) {
    const abbe_object *o = &scene->object[i];
    if (o->conductor != NULL && o->conductor->temperature_c != here_c)
      doubt(out, "the object '%.60s' has n and k of %.60s as they were measured, not at %g C",
            o->name, o->conductor->name, here_c);
  }
}

void abbe_scene_doubt(const abbe_scene *scene, abbe_scene_doubts *out) {
  out->count = 0;
  find_names(scene, out);
  find_far_eye(scene, out);
  find_sunk(scene, out);
  find_hidden_lamps(scene, out);
  find_cold_metals(scene, out);
}
