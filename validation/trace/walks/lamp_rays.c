#include "validation/trace/walks/light_path.h"

#include "base/maths.h"

enum { FEW_FACES = 256 /* faces of receivers, compared with each other */ };

static float above(const float n[3], const float a[3], const float p[3]) {
  return n[0] * (p[0] - a[0]) + n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2]);
}

/* Whether a corner of a receiver lies on the other side of a face's plane than the light. */
static bool stands_before(const abbe_geometry *g, const abbe_light *light, const float corner[3],
                          const float n[3]) {
  float lamp[3], toward = 0;
  for (int k = 0; k < 3; k++) toward -= n[k] * (float)light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_geometry_to_frame(g, light->position, lamp);
    toward = above(n, corner, lamp);
  }
  for (size_t i = 0; i < g->surface_count; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_RECEIVERS) continue;
    size_t count = s->sphere ? 0 : g->scene->object[s->object].mesh.vertex_count;
    for (size_t v = 0; v < count; v++) {
      float behind = above(n, corner, s->position[v]), size = 0;
      for (int k = 0; k < 3; k++)
        size = fmaxf(size, fmaxf(fabsf(s->position[v][k]), fabsf(corner[k])));
      if (toward > 0 ? behind < -1e-5f * size : behind > 1e-5f * size) return true;
    }
  }
  return false;
}

/* Receivers that are the walls of a convex space around the light hide nothing. */
bool abbe_lamp_is_hidden(const abbe_geometry *g, const abbe_light *light) {
  size_t faces = 0;
  for (size_t i = 0; i < g->surface_count; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_RECEIVERS) continue;
    faces += g->scene->object[s->object].mesh.face_count;
    if (s->sphere || faces > FEW_FACES) return true;
  }
  for (size_t i = 0; i < g->surface_count; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_RECEIVERS) continue;
    for (size_t f = 0; f < g->scene->object[s->object].mesh.face_count; f++) {
      const float *a = s->position[s->face[f][0]], *b = s->position[s->face[f][1]],
                  *c = s->position[s->face[f][2]];
      float e[3], h[3];
      for (int k = 0; k < 3; k++) {
        e[k] = b[k] - a[k];
        h[k] = c[k] - a[k];
      }
      float n[3] = {e[1] * h[2] - e[2] * h[1], e[2] * h[0] - e[0] * h[2],
                    e[0] * h[1] - e[1] * h[0]};
      float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      if (!(length > 0)) return true;
      for (int k = 0; k < 3; k++) n[k] /= length;
      if (stands_before(g, light, a, n)) return true;
    }
  }
  return false;
}

/* Rays to the light in the frame, or against its direction, where `far`; as abbe_geometry_leave has
 * it, off their faces. */
SIDE_BY_SIDE static void aim(const float lamp[3], int far, abbe_lamp_rays *s) {
  struct RTCRay16 *ray = &s->ray;
  for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
    const float p[3] = {s->p[0][k], s->p[1][k], s->p[2][k]};
    float d[3], size = s->size[k];
    for (int i = 0; i < 3; i++) d[i] = far ? lamp[i] : lamp[i] - p[i];
    const float limit = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), scale = far ? 1 : limit;
    for (int i = 0; i < 3; i++) d[i] /= scale;
    const float side = d[0] * s->ng[0][k] + d[1] * s->ng[1][k] + d[2] * s->ng[2][k];
    for (int i = 0; i < 3; i++) size = fabsf(p[i]) > size ? fabsf(p[i]) : size;
    const float offset = side < 0 ? -ABBE_GEOMETRY_OFFSET * size : ABBE_GEOMETRY_OFFSET * size;
    ray->org_x[k] = p[0] + offset * s->ng[0][k];
    ray->org_y[k] = p[1] + offset * s->ng[1][k];
    ray->org_z[k] = p[2] + offset * s->ng[2][k];
    ray->dir_x[k] = d[0];
    ray->dir_y[k] = d[1];
    ray->dir_z[k] = d[2];
    ray->tnear[k] = 0;
    ray->tfar[k] = far ? INFINITY : limit;
    ray->mask[k] = ABBE_GEOMETRY_RECEIVERS;
    ray->flags[k] = 0;
  }
}

void abbe_lamp_rays_trace(abbe_lamp_rays *s, const abbe_geometry *g, abbe_light_ledger *ledger,
                          abbe_ray_record *record) {
  if (s->count == 0) return;
  const bool far = s->light->kind == ABBE_LIGHT_DIRECTIONAL;
  float lamp[3];
  for (int k = 0; k < 3; k++) lamp[k] = -(float)s->light->direction[k];
  if (!far) abbe_geometry_to_frame(g, s->light->position, lamp);
  aim(lamp, far, s);
  abbe_ray_batch_occlude(&s->ray, s->count, g->embree, record);
  s->traced += s->count;
  for (size_t k = 0; k < s->count; k++) {
    s->photon[k]->hidden = s->ray.tfar[k] < 0;
    if (s->photon[k]->hidden) ledger->hidden += s->flux[k];
  }
  s->count = 0;
}

void abbe_lamp_rays_add(abbe_lamp_rays *s, const abbe_geometry *g, const abbe_light *light,
                        const abbe_hit *hit, abbe_photon_hit *photon, double flux,
                        abbe_light_ledger *ledger, abbe_ray_record *record) {
  const size_t at = s->count++;
  s->light = light;
  for (int k = 0; k < 3; k++) {
    s->p[k][at] = hit->p[k];
    s->ng[k][at] = hit->ng[k];
  }
  s->size[at] = hit->surface->sphere ? hit->surface->radius : 0;
  s->photon[at] = photon;
  s->flux[at] = flux;
  if (s->count == ABBE_RAY_LANES) abbe_lamp_rays_trace(s, g, ledger, record);
}
