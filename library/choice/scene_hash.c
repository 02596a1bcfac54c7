#include "library/choice/finer_scene.h"

enum { INDEX_STEPS = 9 };

/* FNV-1a, 64 bits. */
static unsigned long long hash(unsigned long long h, const void *data, size_t size) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < size; i++) h = (h ^ byte[i]) * 1099511628211u;
  return h & 0xffffffffffffffffu;
}

static const unsigned long long hash_start = 14695981039346656037u;

/* What a crystal has besides its ordinary or middle index and its mean loss. */
static unsigned long long hash_crystal(unsigned long long h, const abbe_object *o) {
  h = hash(h, o->axis, sizeof o->axis);
  if (abbe_material_is_biaxial(o->material)) h = hash(h, o->axis_x, sizeof o->axis_x);
  for (int i = 0; i < INDEX_STEPS; i++)
    for (int axis = 0; axis < 3; axis++) {
      const double lambda_nm = 380 + 50.0 * i;
      double numbers[2] = {0, abbe_material_attenuation_along(o->material, axis, lambda_nm)};
      abbe_material_n_along(o->material, axis, lambda_nm, &numbers[0], NULL);
      h = hash(h, numbers, sizeof numbers);
    }
  return h;
}

static unsigned long long hash_coatings(unsigned long long h, const abbe_coatings *c) {
  for (size_t i = 0; c != NULL && i < c->count; i++)
    for (int k = 0; k < INDEX_STEPS; k++) {
      abbe_film_layer layer[ABBE_FILM_MOST_LAYERS] = {{0, 0, 0}};
      abbe_coating_at(&c->coating[i], 380 + 50.0 * k, layer, NULL);
      h = hash(h, layer, c->coating[i].count * sizeof *layer);
    }
  return c != NULL && c->face != NULL ? hash(h, c->face, c->face_count) : h;
}

static unsigned long long hash_object(unsigned long long h, const abbe_object *o) {
  h = hash(h, o->mesh.position, o->mesh.vertex_count * sizeof *o->mesh.position);
  h = hash(h, o->mesh.face, o->mesh.face_count * sizeof *o->mesh.face);
  h = hash(h, o->reflectance, sizeof o->reflectance);
  h = hash(h, o->texture.data,
           o->texture.width * o->texture.height * o->texture.channels * sizeof *o->texture.data);
  for (int i = 0; i <= 40 && o->spectrum != NULL; i++) {
    const double value = abbe_spectrum_at(o->spectrum, 380 + 10.0 * i);
    h = hash(h, &value, sizeof value);
  }
  for (int i = 0; i < INDEX_STEPS && o->material != NULL; i++) {
    double lambda_nm = 380 + 50.0 * i, n = 0;
    abbe_material_n(o->material, lambda_nm, &n, NULL);
    double numbers[] = {n, abbe_material_attenuation(o->material, lambda_nm)};
    h = hash(h, numbers, sizeof numbers);
  }
  if (o->material != NULL && abbe_material_is_crystal(o->material)) h = hash_crystal(h, o);
  h = hash_coatings(h, o->coatings);
  if (!o->mirror) return h;
  h = hash(h, &o->mirror_reflectance, sizeof o->mirror_reflectance);
  if (abbe_brushing_is_rough(&o->brushing)) {
    const abbe_brushing *b = &o->brushing;
    const double numbers[] = {b->facets.x, b->facets.y, b->around ? 1 : 0};
    h = hash(h, numbers, sizeof numbers);
    h = hash(h, b->axis, sizeof b->axis);
    h = hash(h, b->centre, sizeof b->centre);
  }
  for (int i = 0; i < INDEX_STEPS && o->conductor != NULL; i++) {
    double nk[2] = {0, 0};
    abbe_material_nk(o->conductor, 380 + 50.0 * i, &nk[0], &nk[1], NULL);
    h = hash(h, nk, sizeof nk);
  }
  return h;
}

unsigned long long abbe_scene_hash(const abbe_scene *s) {
  unsigned long long h = hash_start;
  h = hash(h, s->camera.eye, sizeof s->camera.eye);
  h = hash(h, s->camera.target, sizeof s->camera.target);
  h = hash(h, s->camera.up, sizeof s->camera.up);
  const double loose[] = {s->camera.fov_y_rad, s->ambient, s->background};
  h = hash(h, loose, sizeof loose);
  const double lens[] = {s->camera.aperture, s->camera.focus};
  if (s->camera.aperture > 0) h = hash(h, lens, sizeof lens);
  for (size_t i = 0; i < s->light_count; i++) {
    const abbe_light *l = &s->light[i];
    const double numbers[] = {l->kind,         l->position[0],  l->position[1],
                              l->position[2],  l->direction[0], l->direction[1],
                              l->direction[2], l->radius,       l->cone_rad,
                              l->soft_rad,     l->power,        l->illuminant.kind};
    h = hash(h, numbers, sizeof numbers);
    double line[ABBE_ILLUMINANT_MOST_LINES];
    h = hash(h, line, abbe_illuminant_lines(&l->illuminant, line) * sizeof *line);
    for (int k = 0; k < INDEX_STEPS; k++) {
      double power = abbe_illuminant_power(&l->illuminant, 380 + 50.0 * k);
      h = hash(h, &power, sizeof power);
    }
  }
  if (s->environment != NULL) {
    const abbe_environment *e = s->environment;
    h = hash(h, e->to_map, sizeof e->to_map);
    h = hash(h, e->map.rgb, e->map.width * e->map.height * 3 * sizeof *e->map.rgb);
    for (int k = 0; k < INDEX_STEPS; k++) {
      double power = abbe_illuminant_power(&e->illuminant, 380 + 50.0 * k);
      h = hash(h, &power, sizeof power);
    }
  }
  for (size_t i = 0; i < s->object_count; i++) h = hash_object(h, &s->object[i]);
  return h;
}
