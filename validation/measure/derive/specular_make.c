#include "validation/measure/derive/specular.h"

#include "base/maths.h"
#include "spectral/materials/material.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *refuse_light(const abbe_light *l) {
  return l != NULL && l->polariser.kind != ABBE_POLARISER_NONE ? "a polariser" : NULL;
}

static const char *refuse_object(const abbe_object *o) {
  const abbe_material *m = o->material;
  if (o->cloud || o->medium != NULL) return "a medium that scatters light";
  if (o->coatings != NULL) return "films";
  if (o->roughness != NULL || (o->mirror && abbe_brushing_is_rough(&o->brushing)))
    return "a rough surface";
  if (m == NULL || o->mirror) return NULL;
  if (m->extraordinary.count > 0 || m->outer[0].count > 0 || m->extraordinary.table != NULL ||
      m->outer[0].table != NULL)
    return "a crystal's two rays";
  return m->fluorescence.yield > 0 ? "fluorescence" : NULL;
}

static abbe_result refuse(const abbe_scene *scene, const abbe_light *light, abbe_error *error) {
  size_t refractors = 0;
  const char *what = refuse_light(light), *name = light != NULL ? light->name : NULL;
  if (what == NULL && scene->medium != NULL) what = "a medium in the air", name = "the scene";
  for (size_t i = 0; i < scene->object_count && what == NULL; i++) {
    what = refuse_object(&scene->object[i]);
    name = scene->object[i].name;
    refractors += abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR;
  }
  if (what == NULL && refractors > ABBE_SPECULAR_REFRACTORS)
    what = "more than 64 refractors", name = "the scene";
  if (what == NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: %s has %s, and derivatives are of light on smooth surfaces between "
                        "clear media; take that out, by --set or in the file",
                        scene->path != NULL ? scene->path : "the scene",
                        name != NULL ? name : "an object", what);
}

/* Faces with one normal, so that light is bent alike all over each. */
static bool is_flat(const abbe_mesh *mesh) {
  for (size_t f = 0; f < mesh->face_count; f++) {
    double n[3];
    const uint32_t *v = mesh->face[f];
    abbe_vector_triangle(mesh->position[v[0]], mesh->position[v[1]], mesh->position[v[2]], n);
    if (!abbe_vector_normalise(n)) continue;
    for (int k = 0; k < 3; k++)
      if (abbe_vector_dot(n, mesh->normal[v[k]]) < 1 - 1e-6) return false;
  }
  return true;
}

static uint32_t root_of(uint32_t *of, uint32_t v) {
  while (of[v] != v) v = of[v] = of[of[v]];
  return v;
}

static abbe_result make_sheets(const abbe_mesh *mesh, abbe_specular_surface *s, abbe_error *error) {
  if (is_flat(mesh)) return ABBE_OK;
  uint32_t *of = malloc((mesh->vertex_count + 1) * sizeof *of);
  s->sheet = malloc((mesh->face_count + 1) * sizeof *s->sheet);
  if (of == NULL || s->sheet == NULL) {
    free(of);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for triangles");
  }
  for (size_t v = 0; v < mesh->vertex_count; v++) of[v] = (uint32_t)v;
  for (size_t f = 0; f < mesh->face_count; f++)
    for (int k = 1; k < 3; k++) of[root_of(of, mesh->face[f][k])] = root_of(of, mesh->face[f][0]);
  for (size_t f = 0; f < mesh->face_count; f++) s->sheet[f] = root_of(of, mesh->face[f][0]);
  free(of);
  return ABBE_OK;
}

static abbe_result fill(const abbe_object *o, abbe_specular_surface *s, abbe_error *error) {
  const size_t planes = o->exact.count;
  s->object = o;
  if (o->exact.kind == ABBE_EXACT_SPHERE) return ABBE_OK;
  if (abbe_specular_has_planes(s)) {
    s->plane = malloc((planes + 1) * sizeof *s->plane);
    s->numbered = malloc((planes + 1) * sizeof *s->numbered);
    if (s->plane == NULL || s->numbered == NULL)
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for planes");
    for (size_t i = 0; i < planes; i++) s->plane[i] = s->numbered[i] = (uint32_t)i;
    return ABBE_OK;
  }
  s->triangle = abbe_bvh_triangles(&o->mesh);
  if (s->triangle == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for triangles");
  ABBE_TRY(make_sheets(&o->mesh, s, error));
  return abbe_bvh_make((const double(*)[9])s->triangle, o->mesh.face_count, &s->bvh, error);
}

/* A ball around all refractors and mirrors. */
static abbe_result surround(abbe_specular *s, abbe_error *error) {
  double low[3], high[3], middle[3], size[3];
  const bool any = abbe_scene_bounds(s->scene, true, s->light == NULL, low, high);
  if (!any && s->light != NULL)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "%s: there is neither a refractor nor a mirror that would throw a caustic",
        s->scene->path != NULL ? s->scene->path : "the scene");
  for (int k = 0; k < 3; k++) s->centre[k] = 0.5 * (low[k] + high[k]);
  abbe_vector_subtract(high, low, size);
  s->radius = 0.505 * abbe_vector_length(size);
  abbe_scene_bounds(s->scene, true, true, low, high);
  abbe_scene_hold_lights(s->scene, low, high);
  for (int k = 0; k < 3; k++) {
    low[k] = fmin(low[k], s->scene->camera.eye[k]);
    high[k] = fmax(high[k], s->scene->camera.eye[k]);
  }
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (low[k] + high[k]) - s->centre[k];
  abbe_vector_subtract(high, low, size);
  s->far = 4 * (abbe_vector_length(size) + abbe_vector_length(middle));
  return ABBE_OK;
}

static abbe_result aim(abbe_specular *s, abbe_error *error) {
  double along[3];
  memcpy(along, s->light->direction, sizeof along);
  if (s->light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_vector_subtract(s->centre, s->light->position, along);
    const double away = abbe_vector_length(along) - s->light->radius;
    if (away < 1.02 * s->radius)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: light '%s' stands among the refractors and mirrors (%.4g m from "
                            "their middle, which reach %.4g m); derivatives are of lights outside",
                            s->scene->path != NULL ? s->scene->path : "the scene", s->light->name,
                            away, s->radius);
    abbe_vector_normalise(along);
  }
  abbe_light_upright(along, s->across, s->up);
  return ABBE_OK;
}

abbe_result abbe_specular_make(const abbe_scene *scene, size_t light,
                               const abbe_specular_shift *shift, abbe_specular *out,
                               abbe_error *error) {
  abbe_specular s = {.scene = scene,
                     .light = light == ABBE_SPECULAR_NO_LIGHT ? NULL : &scene->light[light],
                     .count = scene->object_count};
  *out = (abbe_specular){0};
  ABBE_TRY(refuse(scene, s.light, error));
  if (shift != NULL) s.shift = *shift;
  s.window[0][1] = s.window[1][1] = 1;
  s.surface = calloc(s.count + 1, sizeof *s.surface);
  abbe_result result = s.surface == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for surfaces")
                           : surround(&s, error);
  if (result == ABBE_OK && s.light != NULL) result = aim(&s, error);
  uint32_t refractors = 0;
  for (size_t i = 0; i < s.count && result == ABBE_OK; i++) {
    result = fill(&scene->object[i], &s.surface[i], error);
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR)
      s.surface[i].refractor = refractors++;
  }
  if (result != ABBE_OK)
    abbe_specular_free(&s);
  else
    *out = s;
  return result;
}

void abbe_specular_free(abbe_specular *s) {
  for (size_t i = 0; s->surface != NULL && i < s->count; i++) {
    free(s->surface[i].plane);
    free(s->surface[i].numbered);
    free(s->surface[i].triangle);
    free(s->surface[i].sheet);
    abbe_bvh_free(&s->surface[i].bvh);
  }
  free(s->surface);
  *s = (abbe_specular){0};
}

static double apart(const double a[4], const double b[4], double size) {
  double sum = (a[3] - b[3]) * (a[3] - b[3]) / (size * size);
  for (int k = 0; k < 3; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/* The planes of both, one to one. */
static bool match_planes(abbe_specular_surface *s, const abbe_specular_surface *base, double size) {
  const size_t count = s->object->exact.count;
  bool taken[ABBE_SCENE_MAX_PLANES] = {false};
  if (count != base->object->exact.count) return false;
  for (size_t i = 0; i < count; i++) {
    size_t best = 0;
    double least = INFINITY;
    for (size_t j = 0; j < count; j++) {
      const double off = apart(s->object->exact.plane[i], base->object->exact.plane[j], size);
      if (off < least) least = off, best = j;
    }
    if (taken[best]) return false;
    taken[best] = true;
    s->plane[i] = (uint32_t)best;
    s->numbered[best] = (uint32_t)i;
  }
  return true;
}

abbe_result abbe_specular_match(abbe_specular *s, const abbe_specular *base, const char *key,
                                abbe_error *error) {
  bool same = s->count == base->count;
  for (size_t i = 0; i < s->count && same; i++) {
    const abbe_object *a = s->surface[i].object, *b = base->surface[i].object;
    same = abbe_object_kind_of(a) == abbe_object_kind_of(b) && a->exact.kind == b->exact.kind;
    if (same && abbe_specular_has_planes(&s->surface[i]))
      same = match_planes(&s->surface[i], &base->surface[i], base->radius);
    else if (same && s->surface[i].triangle != NULL)
      same = a->mesh.face_count == b->mesh.face_count;
  }
  if (!same || (s->light != NULL && s->light->kind != base->light->kind))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "'%s' changes which faces there are, and not only where they lie: it has "
                          "no derivative",
                          key);
  memcpy(s->across, base->across, sizeof s->across);
  memcpy(s->up, base->up, sizeof s->up);
  memcpy(s->centre, base->centre, sizeof s->centre);
  memcpy(s->window, base->window, sizeof s->window);
  s->radius = base->radius;
  s->far = base->far;
  return ABBE_OK;
}

abbe_result abbe_specular_index(const abbe_material *m, const abbe_specular_shift *shift,
                                double lambda_nm, double *n, double *attenuation,
                                abbe_error *error) {
  const double um = lambda_nm / 1000;
  *attenuation = abbe_material_attenuation(m, lambda_nm);
  ABBE_TRY(abbe_material_n(m, lambda_nm, n, error));
  if (shift == NULL || shift->material == NULL || strcmp(shift->material, m->name) != 0)
    return ABBE_OK;
  const abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
  if (shift->v != 0) *n = d.n_d + (*n - d.n_d) * d.v_d / (d.v_d + shift->v);
  *n += shift->n + shift->b_um2 / (um * um);
  *attenuation += shift->absorption;
  return ABBE_OK;
}

abbe_result abbe_specular_wave_make(const abbe_specular *s, double lambda_nm,
                                    abbe_specular_wave *out, abbe_error *error) {
  out->lambda_nm = lambda_nm;
  for (size_t i = 0; i < s->count; i++) {
    if (abbe_object_kind_of(s->surface[i].object) != ABBE_OBJECT_REFRACTOR) continue;
    const uint32_t r = s->surface[i].refractor;
    ABBE_TRY(abbe_specular_index(s->surface[i].object->material, &s->shift, lambda_nm, &out->n[r],
                                 &out->a[r], error));
  }
  return ABBE_OK;
}
