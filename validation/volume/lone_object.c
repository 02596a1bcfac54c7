#include "validation/volume/lone_object.h"

#include "validation/volume/volume_checkpoint.h"

#include <string.h>

abbe_result abbe_lone_object_make(const abbe_scene *scene, size_t object, size_t light,
                                  abbe_lone_object *out, abbe_error *error) {
  *out = (abbe_lone_object){0};
  if (scene->light_count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no light of its own, whose colour the volume would have");
  if (object >= scene->object_count || light >= scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "object %zu in light %zu: the scene has %zu objects and %zu lights",
                          object + 1, light + 1, scene->object_count, scene->light_count);
  out->object = scene->object[object];
  out->light = (abbe_light){.name = scene->light[light].name,
                            .kind = ABBE_LIGHT_DIRECTIONAL,
                            .direction = {0, 0, -1},
                            .power = 1,
                            .illuminant = scene->light[light].illuminant};
  out->scene = *scene;
  out->scene.object = &out->object;
  out->scene.object_count = 1;
  out->scene.light = &out->light;
  out->scene.light_count = 1;
  out->scene.environment = NULL;
  out->scene.soft_light = NULL;
  out->scene.environment_lights = 0;
  abbe_result result = abbe_volume_body_make(&out->object, &out->body, error);
  if (result == ABBE_OK)
    result = abbe_volume_body_find(&out->body, &out->object, &out->place, error);
  if (result == ABBE_OK) result = abbe_geometry_make(&out->scene, &out->geometry, error);
  return result;
}

void abbe_lone_object_free(abbe_lone_object *lone) {
  if (lone == NULL) return;
  abbe_geometry_free(&lone->geometry);
  *lone = (abbe_lone_object){0};
}

double abbe_lone_object_depth(const abbe_lone_object *lone) {
  return fabs(abbe_object_distance(&lone->object, lone->place.centre));
}

static uint64_t materials_key(const abbe_media *m, const abbe_mirrors *r, uint64_t h) {
  const size_t values = m->refractors * (m->steps + 1);
  h = abbe_volume_key(h, m->n, values * sizeof *m->n);
  if (m->attenuation != NULL)
    h = abbe_volume_key(h, m->attenuation, values * sizeof *m->attenuation);
  if (m->extraordinary != NULL) {
    h = abbe_volume_key(h, m->extraordinary, values * sizeof *m->extraordinary);
    h = abbe_volume_key(h, m->axis, m->refractors * sizeof *m->axis);
  }
  h = abbe_volume_key(h, r->reflectance, r->count * sizeof *r->reflectance);
  return abbe_volume_key(h, r->nk, r->count * (r->steps + 1) * sizeof *r->nk);
}

uint64_t abbe_lone_object_key(const abbe_lone_object *lone, const abbe_media *media,
                              const abbe_mirrors *mirrors, uint64_t h) {
  const abbe_geometry *g = &lone->geometry;
  const abbe_surface *s = &g->surface[0];
  const abbe_mesh *mesh = &lone->object.mesh;
  const double ball[4] = {(double)s->radius, (double)s->centre[0], (double)s->centre[1],
                          (double)s->centre[2]};
  h = materials_key(media, mirrors, h);
  h = abbe_volume_key(h, g->instructions, strlen(g->instructions));
  h = abbe_volume_key(h, g->origin, sizeof g->origin);
  h = abbe_volume_key(h, &g->unit, sizeof g->unit);
  h = abbe_volume_key(h, &s->kind, sizeof s->kind);
  h = abbe_volume_key(h, ball, sizeof ball);
  if (s->sphere) return h;
  h = abbe_volume_key(h, s->position, mesh->vertex_count * sizeof *s->position);
  h = abbe_volume_key(h, s->face, mesh->face_count * sizeof *s->face);
  return abbe_volume_key(h, s->normal,
                         (s->flat ? mesh->face_count : mesh->vertex_count) * sizeof *s->normal);
}
