#include "gl/paths/mesh_walk.h"

bool abbe_walk_serves(const abbe_gpu_scene *scene, const abbe_shader_variant *v) {
  const bool meshes = v->walk && v->hierarchy && !v->spheres && !v->convex && !v->layers;
  const bool clear = !v->absorbing && !v->band_parts && !v->films && !v->mirrors &&
                     !scene->plan->crystals && scene->plan->tints == 0;
  return scene->gpu->software && meshes && clear && v->area_lights == 0 && !v->receiver_hierarchy &&
         v->receivers > 0;
}

void abbe_walk_map(abbe_gpu_maps *m, const abbe_gpu_scene *scene, int exits, float share_limit,
                   float least_share, abbe_walk_scene *out) {
  *out = (abbe_walk_scene){.scene = scene,
                           .triangles = abbe_gpu_map(m, scene->bvh[1], GL_MAP_READ_BIT),
                           .corners = abbe_gpu_map(m, scene->bvh[2], GL_MAP_READ_BIT),
                           .refractors = abbe_gpu_map(m, scene->refractors, GL_MAP_READ_BIT),
                           .receivers = abbe_gpu_map(m, scene->receivers, GL_MAP_READ_BIT),
                           .refractor_radius = (float)scene->refractor_radius,
                           .share_limit = share_limit,
                           .least_share = least_share,
                           .refractor_count = (int)scene->plan->refractor_count,
                           .receiver_count = (int)scene->plan->parallelogram_count,
                           .exits = exits};
}

unsigned abbe_walk_next(const abbe_walk_scene *c, const abbe_walk_path *const *at, int count,
                        abbe_walk_interface *h) {
  abbe_rays rays;
  unsigned mask = 0, met = 0;
  for (int k = 0; k < ABBE_RAYS; k++) {
    const abbe_walk_path *of = at[k < count ? k : 0];
    mask |= k < count && of->share > 0 ? 1u << k : 0;
    rays.o[0][k] = of->p.x, rays.o[1][k] = of->p.y, rays.o[2][k] = of->p.z;
    rays.d[0][k] = of->d.x, rays.d[1][k] = of->d.y, rays.d[2][k] = of->d.z;
    rays.t[k] = 1e30f;
    rays.triangle[k] = -1;
  }
  for (int r = 0; r < c->refractor_count; r++) {
    int32_t before[ABBE_RAYS];
    memcpy(before, rays.triangle, sizeof before);
    for (int k = 0; k < ABBE_RAYS; k++) {
      rays.side[k] = (at[k < count ? k : 0]->inside >> r & 1u) != 0 ? -1 : 1;
      rays.t_min[k] = -1e-6f * c->refractors[r].sphere[3];
    }
    abbe_ray_trees_meet(&c->scene->trees, c->scene->refractor_tree[r], c->triangles, mask, &rays);
    for (int k = 0; k < count; k++)
      if (rays.triangle[k] != before[k]) h[k].refractor = r;
  }
  for (int k = 0; k < count; k++) {
    if (rays.triangle[k] < 0) continue;
    met |= 1u << k;
    const float u = rays.u[k], v = rays.v[k];
    const float(*t)[4] = c->triangles + 3 * (size_t)rays.triangle[k];
    const float(*corner)[4] = c->corners + 4 * (size_t)rays.triangle[k];
    const v3 e1 = vector_at(t[1]), e2 = vector_at(t[2]);
    const v3 n = plus(plus(times(1 - u - v, vector_at(corner[0])), times(u, vector_at(corner[1]))),
                      times(v, vector_at(corner[2])));
    h[k].face_n = normalize(cross(e1, e2));
    h[k].n = dot(n, n) > 0 ? normalize(n) : h[k].face_n;
    h[k].p = plus(vector_at(t[0]), plus(times(u, e1), times(v, e2)));
    h[k].t = most(rays.t[k], 0);
    h[k].facet = (int)bits_of(t[0][3]);
  }
  return met;
}

static int stuff_of(const abbe_walk *w, uint32_t inside) {
  return inside == 0 ? -1 : w->of->refractors[abbe_walk_medium(inside)].first_same;
}

bool abbe_walk_split(const abbe_walk *w, abbe_walk_path *at, const abbe_walk_interface *h,
                     abbe_walk_path *mirrored) {
  const uint32_t before = at->inside, after = before ^ 1u << h->refractor;
  const bool entering = (before >> h->refractor & 1u) == 0;
  at->p = h->p;
  at->refractor = h->refractor;
  *mirrored = *at;
  at->inside = after;
  if (stuff_of(w, before) == stuff_of(w, after)) return false;
  const float eta = abbe_walk_n(w, before) / abbe_walk_n(w, after);
  const v3 face_n = entering ? h->face_n : times(-1, h->face_n);
  v3 n = entering ? h->n : times(-1, h->n), through;
  if (dot(at->d, n) >= 0) n = face_n;
  const bool passes = refract_direction(at->d, n, eta, &through);
  mirrored->share *= passes ? fresnel(-dot(at->d, n), eta) : 1;
  mirrored->d = keep_side(face_n, reflect(at->d, n));
  at->d = keep_side(times(-1, face_n), through);
  at->share = passes ? at->share - mirrored->share : 0;
  at->interfaces = mirrored->interfaces = at->interfaces + 1;
  at->interface_n = mirrored->interface_n = n;
  at->transmitted = true;
  mirrored->transmitted = false;
  at->path = at->path * 31u + 2u * (uint32_t)h->refractor + (uint32_t)h->facet * 7u + 1u;
  mirrored->path = at->path + 1u;
  return true;
}

/* Returns the share that is given up. */
static float keep_pending(abbe_walk *w, const abbe_walk_path *at) {
  int weakest = 0;
  for (int k = 1; k < ABBE_WALK_PENDING; k++)
    if (w->pending[k].share < w->pending[weakest].share) weakest = k;
  const float least_share = w->pending[weakest].share;
  if (at->share <= least_share) return at->share;
  w->pending[weakest] = *at;
  return least_share;
}

abbe_walk_path abbe_walk_take(abbe_walk *w) {
  int strongest = 0;
  for (int k = 1; k < ABBE_WALK_PENDING; k++)
    if (w->pending[k].share > w->pending[strongest].share) strongest = k;
  const abbe_walk_path taken = w->pending[strongest];
  w->pending[strongest].share = 0;
  return taken;
}

float abbe_walk_branch(abbe_walk *w, abbe_walk_path *at, const abbe_walk_interface *h) {
  abbe_walk_path mirrored;
  if (!abbe_walk_split(w, at, h, &mirrored)) return 0;
  const bool reflects = mirrored.interfaces <= 0 || (mirrored.interfaces < w->of->exits &&
                                                     mirrored.share >= w->of->share_limit);
  const bool passes = at->share >= w->of->least_share;
  const float ended = (reflects ? 0 : mirrored.share) + (passes ? 0 : at->share);
  if (!reflects) mirrored.share = 0;
  if (!passes) at->share = 0;
  if (mirrored.share > at->share) {
    const abbe_walk_path weaker = *at;
    *at = mirrored;
    mirrored = weaker;
  }
  return ended + keep_pending(w, &mirrored);
}

int abbe_walk_receiver_at(const abbe_walk_scene *of, v3 o, v3 d, float t_min, float t_max,
                          float *t) {
  int found = -1;
  *t = t_max;
  for (int i = 0; i < of->receiver_count; i++) {
    const abbe_walk_receiver *r = &of->receivers[i];
    const float s = (r->normal[3] - abbe_walk_dot4(r->normal, o)) / abbe_walk_dot4(r->normal, d);
    if (!(s > t_min && s < *t)) continue;
    const v3 from = off(plus(o, times(s, d)), vector_at(r->anchor));
    const float u = abbe_walk_dot4(r->du, from) + r->du[3],
                v = abbe_walk_dot4(r->dv, from) + r->dv[3];
    if (!(least(u, v) >= 0 && most(u, v) <= 1)) continue;
    *t = s;
    found = i;
  }
  return found;
}
