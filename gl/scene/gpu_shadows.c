#include "gl/scene/gpu_scene.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A light's place with a fourth coordinate: 1, or 0 for a direction towards the light. */
static void place_of(const abbe_light *light, double out[4]) {
  const bool far = light->kind == ABBE_LIGHT_DIRECTIONAL;
  for (int k = 0; k < 3; k++) out[k] = far ? -light->direction[k] : light->position[k];
  out[3] = far ? 0 : 1;
}

/* A plane of the shadow's side, scaled to 1 at the place inside: as such they lie in one plane, and
 * only the corners of their convex hull bound the shadow. */
typedef struct side {
  double n[3], d;
  double at[2];             /* in that plane */
  const double *lit, *dark; /* faces that meet in it */
} side;

static int by_place(const void *a, const void *b) {
  const side *x = a, *y = b;
  for (int k = 0; k < 2; k++)
    if (x->at[k] != y->at[k]) return x->at[k] < y->at[k] ? -1 : 1;
  return 0;
}

/* Whether b lies on the line from a to c, to rounding, or to the right of it. */
static bool turns_right(const side *a, const side *b, const side *c) {
  double size = 0, u[2], v[2];
  for (int k = 0; k < 2; k++) {
    u[k] = b->at[k] - a->at[k];
    v[k] = c->at[k] - a->at[k];
    size += a->at[k] * a->at[k] + b->at[k] * b->at[k] + c->at[k] * c->at[k];
  }
  return u[0] * v[1] - u[1] * v[0] <= 1e-14 * size;
}

/* The hull's corners in order, its lower chain and then its upper one [Andrew1979]; hull has
 * capacity for two times `count`. */
static size_t keep_hull(side *all, size_t count, side *hull) {
  size_t n = 0;
  qsort(all, count, sizeof *all, by_place);
  for (size_t i = 0; i < count; i++) {
    while (n >= 2 && turns_right(&hull[n - 2], &hull[n - 1], &all[i])) n--;
    hull[n++] = all[i];
  }
  for (size_t i = count - 1, lower = n; i-- > 0;) {
    while (n > lower && turns_right(&hull[n - 2], &hull[n - 1], &all[i])) n--;
    hull[n++] = all[i];
  }
  return n > 1 ? n - 1 : n;
}

/* Two directions across an axis, each other and unit. */
static void across(const double axis[3], double u[3], double v[3]) {
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(axis[k]) < fabs(axis[least])) least = k;
  double other[3] = {0, 0, 0};
  other[least] = 1;
  abbe_vector_cross(axis, other, u);
  abbe_vector_normalise(u);
  abbe_vector_cross(axis, u, v);
  abbe_vector_normalise(v);
}

/* The plane through the light and the line where a lit face meets one that is not: of their planes
 * the sum that the light lies in. Of faces that do not meet it bounds the shadow too, elsewhere. */
static void join(const double lit[4], double before, const double dark[4], double behind,
                 const double inside[3], side *out) {
  for (int k = 0; k < 3; k++) out->n[k] = before * dark[k] + behind * lit[k];
  out->d = before * dark[3] + behind * lit[3];
  out->lit = lit;
  out->dark = dark;
  const double depth = out->d - abbe_vector_dot(out->n, inside);
  for (int k = 0; k < 3; k++) out->n[k] /= depth;
  out->d /= depth;
}

/* By the plane through the edge across the side: how far behind it a place is along its ray, over
 * the edge's distance from the light, or for a directional one in metres. */
static void find_edge(const side *s, const double at[4], double out[4]) {
  const double a = abbe_vector_dot(s->dark, s->n), b = -abbe_vector_dot(s->lit, s->n);
  const double d = a * s->lit[3] + b * s->dark[3];
  for (int k = 0; k < 3; k++) out[k] = a * s->lit[k] + b * s->dark[k];
  const double scale = at[3] * d - abbe_vector_dot(out, at);
  out[3] = at[3] == 0 ? -d : -scale;
  for (int k = 0; k < 4; k++) out[k] = scale == 0 ? 0 : out[k] / scale;
}

static size_t store_sides(const side *hull, size_t count, bool far, double (*out)[4]) {
  for (size_t i = 0; i < count; i++) {
    const double length = abbe_vector_length(hull[i].n);
    for (int k = 0; k < 3; k++) out[i][k] = hull[i].n[k] / length;
    out[i][3] = far ? hull[i].d / length : 0; /* else the light's own place, the new origin */
  }
  return count;
}

abbe_result abbe_shadow_planes_make(const double (*plane)[4], size_t count, const double inside[3],
                                    const abbe_light *light, bool faces, double (*out)[4],
                                    double (*edge)[4], size_t *found, abbe_error *error) {
  double at[4], axis[3], u[3], v[3];
  size_t lit = 0, pairs = 0, n = 0;
  *found = 0;
  double *before = malloc((count + 1) * sizeof *before); /* for each face, how far the light is */
  if (before == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a shadow");
  place_of(light, at);
  for (int k = 0; k < 3; k++) axis[k] = at[k] - at[3] * inside[k];
  across(axis, u, v);
  for (size_t i = 0; i < count; i++) {
    before[i] = abbe_vector_dot(plane[i], at) - plane[i][3] * at[3];
    lit += before[i] > 0;
  }
  side *all = malloc((3 * lit * (count - lit) + 2) * sizeof *all);
  if (all == NULL) {
    free(before);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a shadow");
  }
  for (size_t i = 0; i < count; i++) {
    if (!(before[i] > 0)) continue;
    for (size_t j = 0; j < count; j++) {
      if (before[j] > 0) continue;
      side *one = &all[pairs++];
      join(plane[i], before[i], plane[j], -before[j], inside, one);
      one->at[0] = abbe_vector_dot(one->n, u);
      one->at[1] = abbe_vector_dot(one->n, v);
    }
  }
  if (pairs > 0) n = store_sides(all + pairs, keep_hull(all, pairs, all + pairs), at[3] == 0, out);
  memset(edge, 0, (2 * count + 1) * sizeof *edge);
  for (size_t i = 0; i < n; i++) find_edge(&all[pairs + i], at, edge[i]);
  for (size_t i = 0; i < count && faces; i++) {
    if (!(before[i] > 0)) continue;
    memcpy(out[n], plane[i], sizeof out[n]);
    out[n++][3] = at[3] == 0 ? plane[i][3] : -before[i]; /* from the light */
  }
  if (lit == 0) {
    memcpy(out[0], (double[4]){0, 0, 0, -1}, sizeof out[0]);
    n = 1;
  }
  free(all);
  free(before);
  *found = n;
  return ABBE_OK;
}

/* Whether a plane through the parallelogram's corner has it on one side and the rest on the other.
 */
static bool own_plane_parts(const double p[9], const abbe_object *convex, const double at[4],
                            double rounding_m) {
  double n[3], least = INFINITY, most = -INFINITY;
  abbe_vector_cross(p + 3, p + 6, n);
  if (!abbe_vector_normalise(n)) return false;
  const double d = abbe_vector_dot(n, p), light = abbe_vector_dot(n, at) - d * at[3];
  for (size_t i = 0; i < convex->mesh.vertex_count; i++) {
    const double height = abbe_vector_dot(n, convex->mesh.position[i]) - d;
    least = fmin(least, height);
    most = fmax(most, height);
  }
  return (least >= -rounding_m && light >= 0) || (most <= rounding_m && light <= 0);
}

bool abbe_shadow_planes_in_front(const abbe_object *convex, const abbe_light *light,
                                 const abbe_object *object) {
  double at[4], size = 0;
  place_of(light, at);
  for (int k = 0; k < 3; k++) size = hypot(size, convex->max[k] - convex->min[k]);
  const double rounding_m = 1e-6 * size;
  for (int k = 0; k < 3; k++) {
    const bool far = at[3] == 0;
    const double low = far ? (at[k] < 0 ? -INFINITY : convex->min[k]) : fmin(at[k], convex->min[k]);
    const double high = far ? (at[k] > 0 ? INFINITY : convex->max[k]) : fmax(at[k], convex->max[k]);
    if (object->max[k] <= low + rounding_m || object->min[k] >= high - rounding_m) return false;
  }
  if (object->exact.kind != ABBE_EXACT_PARALLELOGRAMS) return true;
  for (size_t i = 0; i < object->exact.count; i++)
    if (!own_plane_parts(object->exact.parallelogram[i], convex, at, rounding_m)) return true;
  return false;
}

typedef struct shadow {
  double plane[2 * ABBE_SCENE_MAX_PLANES + 1][4], edge[2 * ABBE_SCENE_MAX_PLANES + 1][4];
  size_t count;
} shadow;

/* The mean of a solid's corners lies inside. */
static void middle_of(const abbe_mesh *mesh, double out[3]) {
  for (int k = 0; k < 3; k++) {
    out[k] = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) out[k] += mesh->position[i][k];
    out[k] /= (double)mesh->vertex_count;
  }
}

/* A place between the solid and the light is asked for where a receiver may have any, and in haze.
 */
static bool needs_faces(const abbe_gpu_scene *scene, const abbe_object *convex,
                        const abbe_light *light) {
  bool needs = scene->plan->desc.everything || scene->local->medium != NULL;
  for (size_t i = 0; i < scene->plan->receiver_count && !needs; i++)
    needs = abbe_shadow_planes_in_front(convex, light,
                                        &scene->local->object[scene->plan->receiver_object[i]]);
  return needs;
}

static abbe_result make_shadow(abbe_gpu_scene *scene, size_t light, size_t refractor, shadow *out,
                               abbe_error *error) {
  const abbe_object *object = &scene->local->object[scene->plan->refractor_object[refractor]];
  if (scene->plan->model[refractor] != ABBE_REFRACTOR_CONVEX || !scene->plan->reaches[light])
    return ABBE_OK;
  double middle[3];
  middle_of(&object->mesh, middle);
  return abbe_shadow_planes_make((const double(*)[4])object->exact.plane, object->exact.count,
                                 middle, &scene->local->light[light],
                                 needs_faces(scene, object, &scene->local->light[light]),
                                 out->plane, out->edge, &out->count, error);
}

double abbe_gpu_shadows_radius(const abbe_light *light) {
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) return light->radius;
  if (light->points == 0) return 0;
  return sqrt(abbe_light_area(light) / ((double)light->points * ABBE_PI));
}

/* Half of the width of the smooth step that has the disk's variance across a plane. */
static double half_width(const abbe_light *light, const double normal[3]) {
  const double off = abbe_vector_dot(light->direction, normal);
  return sqrt(1.25 * fmax(1 - off * off, 0)) * abbe_gpu_shadows_radius(light);
}

bool abbe_gpu_shadows_soft(const abbe_gpu_scene *scene) {
  for (size_t i = 0; i < scene->plan->light_view_count; i++)
    if (abbe_gpu_shadows_radius(&scene->local->light[i]) > 0) return true;
  return false;
}

/* A few counts for all: shaders are compiled for so many, and a light that moves changes its own.
 */
static size_t padded(size_t planes) {
  enum { STEP = 8 };
  return (planes + STEP - 1) / STEP * STEP;
}

static abbe_result keep_shadows(abbe_gpu_scene *scene, const shadow *found, size_t pairs,
                                abbe_error *error) {
  static const float on_no_side[4] = {0, 0, 0, 1e30f}; /* whatever is asked lies within it */
  size_t planes = 0, next = 0;
  for (size_t i = 0; i < pairs; i++) planes += found[i].count;
  const size_t rows = padded(planes), tables = abbe_gpu_shadows_soft(scene) ? 2 : 1;
  if (planes == 0 || (pairs + tables * rows) * sizeof *scene->shadow_row > ABBE_GPU_BLOCK_BYTES)
    return ABBE_OK;
  scene->shadow_row = calloc(pairs + tables * rows, sizeof *scene->shadow_row);
  if (scene->shadow_row == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shadows");
  scene->shadow_planes = rows;
  for (size_t i = 0; i < pairs; i++) {
    scene->shadow_row[i].range[0] = (int)next;
    scene->shadow_row[i].range[1] = (int)found[i].count;
    for (size_t k = 0; k < found[i].count; k++, next++) {
      const double *plane = found[i].plane[k], *edge = found[i].edge[k];
      for (int c = 0; c < 4; c++) scene->shadow_row[pairs + next].plane[c] = (float)plane[c];
      const abbe_light *from = &scene->local->light[i / scene->plan->refractor_count];
      const double wide = half_width(from, plane);
      for (int c = 0; c < 4 && wide > 0; c++)
        scene->shadow_row[pairs + rows + next].plane[c] = (float)(wide * edge[c]);
    }
  }
  for (; next < rows; next++)
    memcpy(scene->shadow_row[pairs + next].plane, on_no_side, sizeof on_no_side);
  return ABBE_OK;
}

static abbe_result upload(abbe_gpu_scene *scene, size_t pairs, abbe_error *error) {
  if (scene->shadow_planes == 0) return ABBE_OK;
  const size_t tables = abbe_gpu_shadows_soft(scene) ? 2 : 1;
  return abbe_gpu_make_buffer(scene->gpu,
                              (pairs + tables * scene->shadow_planes) * sizeof *scene->shadow_row,
                              scene->shadow_row, &scene->shadows, error);
}

abbe_result abbe_gpu_shadows_make(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t refractors = scene->plan->convex ? scene->plan->refractor_count : 0;
  const size_t pairs = scene->plan->light_view_count * refractors;
  if (pairs == 0 || pairs * sizeof *scene->shadow_row > ABBE_GPU_BLOCK_BYTES) return ABBE_OK;
  shadow *found = calloc(pairs, sizeof *found);
  abbe_result result = ABBE_OK;
  if (found == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shadows");
  for (size_t i = 0; result == ABBE_OK && i < pairs; i++)
    result = make_shadow(scene, i / refractors, i % refractors, &found[i], error);
  if (result == ABBE_OK) result = keep_shadows(scene, found, pairs, error);
  free(found);
  return result == ABBE_OK ? upload(scene, pairs, error) : result;
}

void abbe_gpu_shadows_free(abbe_gpu_scene *scene) {
  abbe_gpu_drop_buffers(scene->gpu, 1, &scene->shadows);
  free(scene->shadow_row);
  scene->shadow_row = NULL;
  scene->shadow_planes = 0;
}
