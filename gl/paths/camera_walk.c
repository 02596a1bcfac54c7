#include "gl/paths/camera_walk.h"

enum { MOST_SEGMENTS = 224, PIXEL_THREADS = 8, BLOCK = 64 };
static const float touch = 1e-5f;

static float dot4(const float plane[4], v3 x) {
  return dot(vector_at(plane), x);
}

unsigned abbe_camera_next_interfaces(walker *const *w, int count, interface *h) {
  const tables *c = w[0]->c;
  abbe_rays rays;
  unsigned mask = 0, met = 0;
  for (int k = 0; k < RAYS; k++) {
    const path_state *at = &w[k < count ? k : 0]->at;
    mask |= k < count && at->share > 0 ? 1u << k : 0;
    rays.o[0][k] = at->p.x, rays.o[1][k] = at->p.y, rays.o[2][k] = at->p.z;
    rays.d[0][k] = at->d.x, rays.d[1][k] = at->d.y, rays.d[2][k] = at->d.z;
    rays.t[k] = 1e30f;
    rays.triangle[k] = -1;
  }
  for (int r = 0; r < c->refractor_count; r++) {
    int32_t before[RAYS];
    memcpy(before, rays.triangle, sizeof before);
    for (int k = 0; k < RAYS; k++) {
      rays.side[k] = (w[k < count ? k : 0]->at.inside >> r & 1u) != 0 ? -1 : 1;
      rays.t_min[k] = -1e-6f * c->refractors[r].sphere[3];
    }
    abbe_ray_trees_meet(&c->told->scene->trees, c->told->scene->refractor_tree[r], c->triangles,
                        mask, &rays);
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
  }
  return met;
}

/* Both branches; false where the medium does not change. */
static bool split(const walker *w, path_state *at, const interface *h, path_state *mirrored) {
  const uint32_t before = at->inside, after = before ^ 1u << h->refractor;
  const bool entering = (before >> h->refractor & 1u) == 0;
  at->p = h->p;
  *mirrored = *at;
  at->inside = after;
  if (stuff_of(w, before) == stuff_of(w, after)) return false;
  const float eta = medium_n(w, before) / medium_n(w, after);
  const v3 face_n = entering ? h->face_n : times(-1, h->face_n);
  v3 n = entering ? h->n : times(-1, h->n), through;
  if (dot(at->d, n) >= 0) n = face_n;
  const bool passes = refract_direction(at->d, n, eta, &through);
  mirrored->share *= passes ? fresnel(-dot(at->d, n), eta) : 1;
  mirrored->d = keep_side(face_n, reflect(at->d, n));
  at->d = keep_side(times(-1, face_n), through);
  at->share = passes ? at->share - mirrored->share : 0;
  at->interfaces = mirrored->interfaces = at->interfaces + 1;
  return true;
}

/* Returns the share that is given up. */
static float keep_pending(walker *w, const path_state *at) {
  int weakest = 0;
  for (int k = 1; k < PENDING; k++)
    if (w->pending[k].share < w->pending[weakest].share) weakest = k;
  const float least_share = w->pending[weakest].share;
  if (at->share <= least_share) return at->share;
  w->pending[weakest] = *at;
  return least_share;
}

static path_state take_pending(walker *w) {
  int strongest = 0;
  for (int k = 1; k < PENDING; k++)
    if (w->pending[k].share > w->pending[strongest].share) strongest = k;
  const path_state taken = w->pending[strongest];
  w->pending[strongest].share = 0;
  return taken;
}

/* The stronger branch goes on and the other waits; returns the share that is not followed. */
static float branch(walker *w, path_state *at, const interface *h, float least_share) {
  path_state mirrored;
  if (!split(w, at, h, &mirrored)) return 0;
  const bool reflects = mirrored.interfaces <= 0 || (mirrored.interfaces < w->c->told->exits &&
                                                     mirrored.share >= w->c->told->share_limit);
  const bool passes = at->share >= least_share;
  const float ended = (reflects ? 0 : mirrored.share) + (passes ? 0 : at->share);
  if (!reflects) mirrored.share = 0;
  if (!passes) at->share = 0;
  if (mirrored.share > at->share) {
    const path_state weaker = *at;
    *at = mirrored;
    mirrored = weaker;
  }
  return ended + keep_pending(w, &mirrored);
}

/* The nearest receiver: its place and sheet, as sights.glsl has them; false: there is none. */
static bool receiver_seen(const walker *w, v3 o, v3 d, float t_min, float t_max, v2 *place,
                          uint32_t *sheet) {
  int found = -1;
  float t = t_max;
  for (int i = 0; i < w->c->receiver_count; i++) {
    const path_receiver *r = &w->c->receivers[i];
    const float s = (r->normal[3] - dot4(r->normal, o)) / dot4(r->normal, d);
    if (!(s > t_min && s < t)) continue;
    const v3 from = off(plus(o, times(s, d)), vector_at(r->anchor));
    const float u = dot4(r->du, from) + r->du[3], v = dot4(r->dv, from) + r->dv[3];
    if (!(least(u, v) >= 0 && most(u, v) <= 1)) continue;
    t = s;
    found = i;
  }
  if (found < 0) return false;
  const path_receiver *r = &w->c->receivers[found];
  v3 p = plus(o, times(t, d));
  p = plus(p, times(r->normal[3] - dot4(r->normal, p), vector_at(r->normal)));
  const v3 from = off(p, vector_at(r->anchor));
  *place = (v2){dot4(r->du, from), dot4(r->dv, from)};
  *sheet = 2 * (uint32_t)found + (dot4(r->normal, d) > 0 ? 1 : 0);
  return true;
}

static void note_sight(walker *w, v2 place, uint32_t sheet, v3 weight) {
  places *to = w->to;
  if (to->next == to->end) {
#pragma omp atomic capture
    {
      to->next = *to->found;
      *to->found += BLOCK;
    }
    to->end = to->next + BLOCK;
  }
  const uint32_t i = to->next++;
  if (i >= w->c->sight_room) return;
  uint32_t *word = w->c->sights + ABBE_SIGHT_WORDS * (size_t)i;
  const float numbers[5] = {place.x, place.y, weight.x, weight.y, weight.z};
  for (int k = 0; k < 5; k++) word[k] = bits_of(numbers[k]);
  word[5] = w->sight_chain | sheet << 24;
  word[6] = (uint32_t)(w->band_set * w->c->band_count + w->band_at) + 1;
  if (w->sight_chain == 0) w->chain_end = i + 1;
  w->sight_chain = i + 1;
}

/* What a path has left shows what the rest of it has shown: its places are worth so many times
 * more. */
static void weigh_sights(const walker *w, v3 factor) {
  for (uint32_t i = w->sight_chain; i != 0;) {
    uint32_t *word = w->c->sights + ABBE_SIGHT_WORDS * (size_t)(i - 1);
    float weight[3];
    memcpy(weight, word + 2, sizeof weight);
    const v3 more = by_parts(vector_at(weight), factor);
    word[2] = bits_of(more.x), word[3] = bits_of(more.y), word[4] = bits_of(more.z);
    i = word[5] & 0xffffffu;
  }
}

/* XYZ of the background in the band that is taken, by its weight. */
static v3 background_of(const walker *w) {
  const float *m = w->c->told->scene->xyz_from_rgb, b = (float)w->c->told->scene->local->background;
  const float(*colour)[4] =
      w->c->band_texels +
      ABBE_BAND_COLOUR_TEXELS * (size_t)(w->band_set * w->c->band_count + w->band_at);
  const v3 xyz = {b * (m[0] + m[3] + m[6]), b * (m[1] + m[4] + m[7]), b * (m[2] + m[5] + m[8])};
  return plus(times(xyz.x, vector_at(colour[0])),
              plus(times(xyz.y, vector_at(colour[1])), times(xyz.z, vector_at(colour[2]))));
}

static int most_segments(const abbe_camera_paths *c) {
  const int most_here = MOST_SEGMENTS / ((c->eye_bands + PIXEL_THREADS) / PIXEL_THREADS);
  return most_here > 8 ? most_here : 8;
}

/* A segment, to the interface that it meets or to none; places of receivers are noted. */
static void follow_segment(walker *w, const interface *h) {
  const tables *c = w->c;
  path_state *at = &w->at;
  const float eye_n = medium_n(w, c->eye_inside);
  v2 place;
  uint32_t sheet;
  const float t_min = at->inside == 0 ? -touch * c->refractor_radius : 0;
  const bool receiver =
      receiver_seen(w, at->p, at->d, t_min, h != NULL ? h->t : 1e30f, &place, &sheet);
  if (h != NULL && !receiver) {
    w->left += branch(w, at, h, 0.5f * c->told->share_limit);
  } else {
    const float n = receiver ? eye_n / medium_n(w, at->inside) : eye_n;
    if (receiver)
      note_sight(w, place, sheet, times(n * n * at->share, band_weight(w)));
    else
      w->of_background += n * n * at->share;
    w->seen_share += at->share;
    at->share = 0;
  }
  if (at->share <= 0) *at = take_pending(w);
  if (--w->segments > 0) return;
  w->left += at->share;
  at->share = 0;
}

v3 abbe_camera_path_end(walker *w) {
  for (int k = 0; k < PENDING; k++) w->left += w->pending[k].share;
  const v3 weight = band_weight(w);
  const float left = w->left, seen_share = w->seen_share;
  const v3 tail = {1 + left * weight.x / most(seen_share * weight.x, 1e-30f),
                   1 + left * weight.y / most(seen_share * weight.y, 1e-30f),
                   1 + left * weight.z / most(seen_share * weight.z, 1e-30f)};
  weigh_sights(w, tail);
  return by_parts(tail, times(w->of_background, by_parts(weight, background_of(w))));
}

void abbe_camera_path_begin(walker *w, bool in_mirror, int band_at) {
  w->band_at = band_at;
  w->at = (path_state){.p = vector_at(w->c->told->eye_view),
                       .d = w->sight,
                       .share = 1,
                       .inside = w->c->eye_inside,
                       .interfaces = -1};
  path_state reflected;
  if (!split(w, &w->at, &w->first, &reflected)) reflected.share = 0;
  w->mirrored = reflected.share;
  reflected.share = reflected.share > 0 ? 1 : 0;
  if (in_mirror) w->at = reflected;
  w->segments = most_segments(w->c->told);
}

void abbe_camera_walk(walker *const *w, int count) {
  interface h[RAYS];
  for (bool goes_on = true; goes_on;) {
    const unsigned met = abbe_camera_next_interfaces(w, count, h);
    goes_on = false;
    for (int k = 0; k < count; k++) {
      if (w[k]->at.share <= 0) continue;
      follow_segment(w[k], (met >> k & 1u) != 0 ? &h[k] : NULL);
      goes_on |= w[k]->at.share > 0;
    }
  }
}
