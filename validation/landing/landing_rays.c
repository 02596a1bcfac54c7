#include "validation/landing/landing_rays.h"

#include "base/maths.h"
#include "spectral/optics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SIDE = 4096 };

/* All triangles of refractors and mirrors. */
typedef struct solids {
  abbe_bvh bvh;
  double (*triangle)[9];
  size_t *first; /* [objects + 1] triangle of each of the scene's objects */
  double *index; /* [objects] n; 0: a mirror */
} solids;

static void free_solids(solids *s) {
  abbe_bvh_free(&s->bvh);
  free(s->triangle);
  free(s->first);
  free(s->index);
}

static void add_triangles(const abbe_mesh *mesh, double (*triangle)[9], size_t *count) {
  for (size_t i = 0; i < mesh->face_count; i++, ++*count)
    for (int k = 0; k < 3; k++)
      memcpy(&triangle[*count][3 * k], mesh->position[mesh->face[i][k]], 3 * sizeof(double));
}

static size_t count_faces(const abbe_scene *scene, bool receivers) {
  size_t count = 0;
  for (size_t i = 0; i < scene->object_count; i++)
    if ((abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_RECEIVER) == receivers)
      count += scene->object[i].mesh.face_count;
  return count;
}

static abbe_result make_receivers(const abbe_scene *scene, abbe_landing_rays *out,
                                  abbe_error *error) {
  const size_t room = count_faces(scene, true);
  size_t count = 0;
  out->triangle = calloc(room + 1, sizeof *out->triangle);
  if (out->triangle == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  for (size_t i = 0; i < scene->object_count; i++)
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_RECEIVER)
      add_triangles(&scene->object[i].mesh, out->triangle, &count);
  return abbe_bvh_make((const double(*)[9])out->triangle, count, &out->receivers, error);
}

static abbe_result make_solids(const abbe_scene *scene, double lambda_nm, solids *out,
                               abbe_error *error) {
  const size_t room = count_faces(scene, false);
  size_t count = 0;
  out->triangle = calloc(room + 1, sizeof *out->triangle);
  out->first = calloc(scene->object_count + 1, sizeof *out->first);
  out->index = calloc(scene->object_count + 1, sizeof *out->index);
  if (out->triangle == NULL || out->first == NULL || out->index == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for refractors");
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    out->first[i] = count;
    if (abbe_object_kind_of(o) == ABBE_OBJECT_RECEIVER) continue;
    abbe_result result =
        o->mirror ? ABBE_OK : abbe_material_n(o->material, lambda_nm, &out->index[i], error);
    if (result != ABBE_OK) return result;
    add_triangles(&o->mesh, out->triangle, &count);
  }
  out->first[scene->object_count] = count;
  return abbe_bvh_make((const double(*)[9])out->triangle, count, &out->bvh, error);
}

/* The object of a hit, its face, and the interpolated normal there. */
static size_t object_at(const abbe_scene *scene, const solids *s, const abbe_bvh_hit *hit,
                        double n[3]) {
  size_t i = 0;
  while (i + 1 < scene->object_count && s->first[i + 1] <= hit->index) i++;
  const abbe_mesh *mesh = &scene->object[i].mesh;
  const uint32_t *f = mesh->face[hit->index - s->first[i]];
  for (int k = 0; k < 3; k++)
    n[k] = (1 - hit->u - hit->v) * mesh->normal[f[0]][k] + hit->u * mesh->normal[f[1]][k] +
           hit->v * mesh->normal[f[2]][k];
  if (!abbe_vector_normalise(n)) memcpy(n, mesh->normal[f[0]], 3 * sizeof *n);
  return i;
}

static void move(const double o[3], const double d[3], double t, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = o[k] + t * d[k];
}

/* Turns d at an interface of normal n (either side), eta of the side that it comes from over the
 * other; false at total reflection. */
static bool bend(double d[3], const double n[3], double eta) {
  double back[3], facing[3];
  const bool against = abbe_vector_dot(d, n) < 0;
  for (int k = 0; k < 3; k++) {
    back[k] = -d[k];
    facing[k] = against ? n[k] : -n[k];
  }
  return abbe_optics_refract(back, facing, eta, d);
}

/* From o along d, which shows an object first: the ray that leaves it. */
static bool leave(const abbe_scene *scene, const solids *s, double size, double o[3], double d[3],
                  bool *reflected) {
  const double(*triangle)[9] = (const double(*)[9])s->triangle;
  abbe_bvh_hit hit;
  double n[3];
  const double off = 1e-9 * size;
  if (!abbe_bvh_trace(&s->bvh, triangle, o, d, 0, 0, INFINITY, &hit)) return false;
  const size_t object = object_at(scene, s, &hit, n);
  move(o, d, hit.t, o);
  *reflected = s->index[object] == 0;
  if (*reflected) {
    const double along = abbe_vector_dot(d, n);
    for (int k = 0; k < 3; k++) d[k] -= 2 * along * n[k];
  } else {
    if (!bend(d, n, 1 / s->index[object])) return false;
    if (!abbe_bvh_trace(&s->bvh, triangle, o, d, 0, off, INFINITY, &hit)) return false;
    if (object_at(scene, s, &hit, n) != object) return false;
    move(o, d, hit.t, o);
    if (!bend(d, n, s->index[object])) return false;
  }
  return !abbe_bvh_trace(&s->bvh, triangle, o, d, 0, off, INFINITY, &hit);
}

/* Around all objects, or around those alone that light leaves. */
static void make_view(const abbe_scene *scene, size_t index, bool all, abbe_view *view) {
  static const double up[3] = {0, 1, 0};
  const abbe_light *light = &scene->light[index];
  const bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double min[3], max[3], origin[3], forward[3], size = 0;
  abbe_scene_bounds(scene, true, true, min, max);
  for (int k = 0; k < 3; k++) size += (max[k] - min[k]) * (max[k] - min[k]);
  abbe_scene_bounds(scene, true, false, min, max);
  for (int k = 0; k < 3; k++) {
    const double middle = 0.5 * (min[k] + max[k]);
    origin[k] = sun ? middle - light->direction[k] * sqrt(size) : light->position[k];
    forward[k] = sun ? light->direction[k] : middle - light->position[k];
  }
  if (abbe_vector_length(forward) == 0) forward[2] = -1;
  abbe_view_look(origin, forward, up, sun, view);
  for (size_t i = 0; i < scene->object_count; i++)
    if (all || abbe_object_kind_of(&scene->object[i]) != ABBE_OBJECT_RECEIVER)
      abbe_view_fit(view, (const double(*)[3])scene->object[i].mesh.position,
                    scene->object[i].mesh.vertex_count);
  abbe_view_pad(view, 0.01);
  for (int axis = 0; axis < 2; axis++) {
    double *w = &view->window[2 * axis];
    const double half = 0.5 *
                        fmax(view->window[1] - view->window[0], view->window[3] - view->window[2]),
                 middle = 0.5 * (w[0] + w[1]);
    w[0] = middle - half;
    w[1] = middle + half;
  }
}

static bool meet_receiver(const abbe_landing_rays *r, const double o[3], const double d[3],
                          double least, abbe_bvh_hit *hit) {
  return abbe_bvh_trace(&r->receivers, (const double(*)[9])r->triangle, o, d, 0, least, INFINITY,
                        hit);
}

static void see_places(abbe_landing_rays *r) {
  for (size_t i = 0; i < r->side * r->side; i++) {
    const double uv[2] = {((double)(i % r->side) + 0.5) / (double)r->side,
                          ((double)(i / r->side) + 0.5) / (double)r->side};
    double o[3], d[3];
    abbe_bvh_hit hit;
    abbe_view_ray(&r->view, uv, o, d);
    r->seen[i] = meet_receiver(r, o, d, 0, &hit);
    if (r->seen[i]) move(o, d, hit.t, r->place[i]);
  }
}

static bool look_along(const abbe_landing_rays *r, const double at[3], double seen[3], double *t) {
  double uvz[3], o[3], d[3];
  abbe_bvh_hit hit;
  if (!abbe_view_project(&r->view, at, uvz)) return false;
  for (int k = 0; k < 2; k++)
    if (!(uvz[k] >= 0 && uvz[k] < 1)) return false;
  abbe_view_ray(&r->view, uvz, o, d);
  if (!meet_receiver(r, o, d, 0, &hit)) return false;
  move(o, d, hit.t, seen);
  *t = hit.t;
  return true;
}

bool abbe_landing_rays_look_exactly(void *user, const double at[3], double seen[3]) {
  double t;
  return look_along(user, at, seen, &t);
}

bool abbe_landing_rays_look(void *user, const double at[3], double seen[3]) {
  const abbe_landing_rays *r = user;
  double uvz[3];
  if (!abbe_view_project(&r->view, at, uvz)) return false;
  for (int k = 0; k < 2; k++)
    if (!(uvz[k] >= 0 && uvz[k] < 1)) return false;
  const size_t i =
      (size_t)(uvz[1] * (double)r->side) * r->side + (size_t)(uvz[0] * (double)r->side);
  memcpy(seen, r->place[i], 3 * sizeof *seen);
  return r->seen[i];
}

double abbe_landing_rays_texels(const abbe_landing_rays *r, const double at[3],
                                const double truth[3]) {
  double a[3], b[3];
  if (!abbe_view_project(&r->view, at, a) || !abbe_view_project(&r->view, truth, b))
    return INFINITY;
  return (double)r->side * hypot(a[0] - b[0], a[1] - b[1]);
}

/* Finds its place on a receiver; whether the light sees the place. */
static bool land(const abbe_landing_rays *r, double size, abbe_landing_ray *ray, bool *seen) {
  double there[3], t, from[3];
  abbe_bvh_hit hit;
  if (!meet_receiver(r, ray->origin, ray->direction, -1e-9 * size, &hit)) return false;
  ray->distance = hit.t;
  move(ray->origin, ray->direction, hit.t, ray->at);
  const double *c = r->triangle[hit.index];
  abbe_vector_triangle(c, c + 3, c + 6, ray->normal);
  abbe_vector_normalise(ray->normal);
  *seen = look_along(r, ray->at, there, &t);
  abbe_vector_subtract(there, ray->at, from);
  *seen = *seen && abbe_vector_length(from) < 1e-6 * size;
  return true;
}

static void follow(const abbe_scene *scene, const solids *s, const abbe_view *aim, size_t grid,
                   abbe_landing_rays *r) {
  double min[3], max[3], size = 0;
  abbe_scene_bounds(scene, true, true, min, max);
  for (int k = 0; k < 3; k++) size = fmax(size, max[k] - min[k]);
  for (size_t i = 0; i < grid * grid; i++) {
    const double uv[2] = {((double)(i % grid) + 0.5) / (double)grid,
                          ((double)(i / grid) + 0.5) / (double)grid};
    abbe_landing_ray ray;
    abbe_bvh_hit hit, before;
    bool seen;
    abbe_view_ray(aim, uv, ray.origin, ray.direction);
    if (!abbe_bvh_trace(&s->bvh, (const double(*)[9])s->triangle, ray.origin, ray.direction, 0, 0,
                        INFINITY, &hit))
      continue;
    if (meet_receiver(r, ray.origin, ray.direction, 0, &before) && before.t < hit.t) continue;
    if (!leave(scene, s, size, ray.origin, ray.direction, &ray.reflected)) continue;
    if (!land(r, size, &ray, &seen)) continue;
    if (seen)
      r->ray[r->count++] = ray;
    else
      r->hidden++;
  }
}

static abbe_result check(const abbe_scene *scene, size_t light, size_t side, size_t grid,
                         abbe_error *error) {
  if (scene->light_count == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "estimators look from a light, and the scene has an environment alone");
  if (light >= scene->light_count || side < 1 || side > MOST_SIDE || grid < 1 || grid > MOST_SIDE)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "light %zu of %zu, a texture of %zu and a grid of %zu a side: sides may be "
        "1 to %d",
        light + 1, scene->light_count, side, grid, MOST_SIDE);
  if (abbe_light_has_size(&scene->light[light]))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the light '%s' has a size, and estimators look from a point or along a "
                          "direction",
                          scene->light[light].name);
  if (count_faces(scene, true) > 0 && count_faces(scene, false) > 0) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "estimators bring light from refractors and mirrors to receivers; the scene "
      "has none of one");
}

abbe_result abbe_landing_rays_make(const abbe_scene *scene, size_t light, double lambda_nm,
                                   size_t side, size_t grid, abbe_landing_rays *out,
                                   abbe_error *error) {
  solids s = {.index = NULL};
  *out = (abbe_landing_rays){.side = side};
  abbe_result result = check(scene, light, side, grid, error);
  if (result != ABBE_OK) return result;
  abbe_view aim;
  make_view(scene, light, true, &out->view);
  make_view(scene, light, false, &aim);
  out->place = calloc(side * side, sizeof *out->place);
  out->seen = calloc(side * side, sizeof *out->seen);
  out->ray = calloc(grid * grid, sizeof *out->ray);
  if (out->place == NULL || out->seen == NULL || out->ray == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for what the light sees");
  if (result == ABBE_OK) result = make_receivers(scene, out, error);
  if (result == ABBE_OK) result = make_solids(scene, lambda_nm, &s, error);
  if (result == ABBE_OK) {
    see_places(out);
    follow(scene, &s, &aim, grid, out);
  } else {
    abbe_landing_rays_free(out);
  }
  free_solids(&s);
  return result;
}

void abbe_landing_rays_free(abbe_landing_rays *r) {
  if (r == NULL) return;
  abbe_bvh_free(&r->receivers);
  free(r->triangle);
  free(r->place);
  free(r->seen);
  free(r->ray);
  *r = (abbe_landing_rays){0};
}
