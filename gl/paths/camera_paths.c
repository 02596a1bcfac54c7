#include "gl/paths/camera_paths.h"
#include "gl/device/shader_maths.h"
#include "gl/scene/spectra/camera_bands.h"

/* The functions and numbers that are the shaders' have their names. */
enum { PENDING = 4, MOST_SEGMENTS = 224, PIXEL_THREADS = 8, TASK = 64, BLOCK = 64 };
static const float touch = 1e-5f;

typedef struct path_state {
  v3 p, d;
  float share;
  uint32_t inside;
  int interfaces;
} path_state;

typedef struct interface {
  v3 p, n, face_n;
  float t;
  int refractor;
} interface;

/* Refractor and Receiver of common.glsl. */
typedef struct path_refractor {
  float sphere[4];
  int model, root, planes, first_same;
} path_refractor;
typedef struct path_receiver {
  float anchor[4], u[4], v[4], normal[4], du[4], dv[4];
} path_receiver;

/* What all pixels share. */
typedef struct tables {
  const abbe_camera_paths *told;
  const float (*triangles)[4], (*corners)[4], (*band_texels)[4];
  const path_refractor *refractors;
  const path_receiver *receivers;
  const abbe_camera_band *bands;
  const uint32_t *pixel;
  uint32_t *sights, *sight_pixels;
  size_t sight_room;
  float refractor_radius;
  int refractor_count, receiver_count, wavelengths, band_count, band_levels;
  uint32_t eye_inside;
} tables;

/* What is followed for a pixel; its places are a chain. */
typedef struct walker {
  const tables *c;
  path_state pending[PENDING];
  v3 sight;
  interface first;
  int refractor, band_set, band_at;
  uint32_t sight_chain;
  uint32_t *found; /* places of all threads, and where this one's block of them ends */
  uint32_t next, end;
} walker;

static int first_band(const walker *w, int r) {
  return (r * ABBE_CAMERA_BAND_SETS + w->band_set) * w->c->band_count;
}

static int medium_of(uint32_t inside) {
  return 31 - __builtin_clz(inside);
}

static int stuff_of(const walker *w, uint32_t inside) {
  return inside == 0 ? -1 : w->c->refractors[medium_of(inside)].first_same;
}

static float medium_n(const walker *w, uint32_t inside) {
  if (inside == 0) return 1;
  return w->c->bands[first_band(w, medium_of(inside)) + w->band_at].weight_n[3];
}

static v3 band_weight(const walker *w) {
  return vector_at(w->c->bands[w->band_set * w->c->band_count + w->band_at].weight_n);
}

static float dot4(const float plane[4], v3 x) {
  return dot(vector_at(plane), x);
}

static bool next_interface(const walker *w, const path_state *at, interface *h) {
  const tables *c = w->c;
  abbe_ray_hit hit = {.t = 1e30f, .triangle = -1};
  const float o[3] = {at->p.x, at->p.y, at->p.z}, d[3] = {at->d.x, at->d.y, at->d.z};
  for (int r = 0; r < c->refractor_count; r++) {
    const float side = (at->inside >> r & 1u) != 0 ? -1 : 1;
    if (abbe_ray_trees_meet(&c->told->scene->trees, c->told->scene->refractor_tree[r], c->triangles,
                            o, d, side, -1e-6f * c->refractors[r].sphere[3], &hit))
      h->refractor = r;
  }
  if (hit.triangle < 0) return false;
  const float(*t)[4] = c->triangles + 3 * (size_t)hit.triangle;
  const float(*corner)[4] = c->corners + 4 * (size_t)hit.triangle;
  const v3 e1 = vector_at(t[1]), e2 = vector_at(t[2]);
  const v3 n =
      plus(plus(times(1 - hit.u - hit.v, vector_at(corner[0])), times(hit.u, vector_at(corner[1]))),
           times(hit.v, vector_at(corner[2])));
  h->face_n = normalize(cross(e1, e2));
  h->n = dot(n, n) > 0 ? normalize(n) : h->face_n;
  h->p = plus(vector_at(t[0]), plus(times(hit.u, e1), times(hit.v, e2)));
  h->t = most(hit.t, 0);
  return true;
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
  if (w->next == w->end) {
#pragma omp atomic capture
    {
      w->next = *w->found;
      *w->found += BLOCK;
    }
    w->end = w->next + BLOCK;
  }
  const uint32_t i = w->next++;
  if (i >= w->c->sight_room) return;
  uint32_t *word = w->c->sights + ABBE_SIGHT_WORDS * (size_t)i;
  const float numbers[5] = {place.x, place.y, weight.x, weight.y, weight.z};
  for (int k = 0; k < 5; k++) word[k] = bits_of(numbers[k]);
  word[5] = w->sight_chain | sheet << 24;
  word[6] = (uint32_t)(w->band_set * w->c->band_count + w->band_at) + 1;
  w->sight_chain = i + 1;
}

static v3 by_parts(v3 a, v3 b) {
  return (v3){a.x * b.x, a.y * b.y, a.z * b.z};
}

/* What a path has left shows what the rest of it has shown: places noted after `from` are worth so
 * many times more. */
static void weigh_sights(const walker *w, uint32_t from, v3 factor) {
  for (uint32_t i = w->sight_chain; i != from;) {
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

/* XYZ of what is no receiver; places of receivers are noted. */
static v3 shown(walker *w, path_state at) {
  const tables *c = w->c;
  const uint32_t before = w->sight_chain;
  const float eye_n = medium_n(w, c->eye_inside);
  float of_background = 0, seen_share = 0, left = 0;
  for (int k = 0; k < PENDING; k++) w->pending[k].share = 0;
  for (int segment = most_segments(c->told); segment > 0 && at.share > 0; segment--) {
    interface h;
    v2 place;
    uint32_t sheet;
    const bool met = next_interface(w, &at, &h);
    const float t_min = at.inside == 0 ? -touch * c->refractor_radius : 0;
    const bool receiver = receiver_seen(w, at.p, at.d, t_min, met ? h.t : 1e30f, &place, &sheet);
    if (met && !receiver) {
      left += branch(w, &at, &h, 0.5f * c->told->share_limit);
    } else {
      const float n = receiver ? eye_n / medium_n(w, at.inside) : eye_n;
      if (receiver)
        note_sight(w, place, sheet, times(n * n * at.share, band_weight(w)));
      else
        of_background += n * n * at.share;
      seen_share += at.share;
      at.share = 0;
    }
    if (at.share <= 0) at = take_pending(w);
  }
  left += at.share;
  for (int k = 0; k < PENDING; k++) left += w->pending[k].share;
  const v3 weight = band_weight(w);
  const v3 tail = {1 + left * weight.x / most(seen_share * weight.x, 1e-30f),
                   1 + left * weight.y / most(seen_share * weight.y, 1e-30f),
                   1 + left * weight.z / most(seen_share * weight.z, 1e-30f)};
  weigh_sights(w, before, tail);
  return by_parts(tail, times(of_background, by_parts(weight, background_of(w))));
}

/* What a band shows through the first interface, or by unit share what it shows mirrored there. */
static v3 path_light(walker *w, bool in_mirror, float *mirrored) {
  path_state at = {.p = vector_at(w->c->told->eye_view),
                   .d = w->sight,
                   .share = 1,
                   .inside = w->c->eye_inside,
                   .interfaces = -1};
  path_state reflected;
  if (!split(w, &at, &w->first, &reflected)) reflected.share = 0;
  *mirrored = reflected.share;
  reflected.share = reflected.share > 0 ? 1 : 0;
  return shown(w, in_mirror ? reflected : at);
}

static void aim_at(walker *w, int x, int y) {
  const float *v = w->c->told->eye_view;
  const float across = mix(v[16], v[17], ((float)x + 0.5f) / w->c->told->eye_samples[0]);
  const float up = mix(v[18], v[19], ((float)y + 0.5f) / w->c->told->eye_samples[1]);
  const v3 side = plus(times(across, vector_at(v + 4)), times(up, vector_at(v + 8)));
  const int turn = w->c->told->sample_turn, right = (turn > 0 ? turn : x) & 1,
            above = (turn > 0 ? turn / 2 : y) & 1;
  w->sight = v[3] > 0.5f ? normalize(plus(vector_at(v + 12), side)) : vector_at(v + 12);
  w->band_set = w->c->told->shares_spectrum ? 1 + 2 * right + 3 * above - 4 * right * above : 0;
}

/* bands_wanted.glsl */
static float wanted_bands(const walker *w) {
  const tables *c = w->c;
  const uint32_t beyond = c->eye_inside ^ 1u << w->refractor;
  const int last = c->wavelengths - 1;
  const abbe_camera_band *to = c->bands + (beyond != 0 ? first_band(w, medium_of(beyond)) : 0);
  const abbe_camera_band *from =
      c->bands + (c->eye_inside != 0 ? first_band(w, medium_of(c->eye_inside)) : 0);
  float ends[2], least_apart = 0;
  for (int r = 0; r < c->refractor_count; r++) {
    const abbe_camera_band *own = c->bands + first_band(w, r);
    const float a = own[0].weight_n[3], b = own[last].weight_n[3];
    least_apart = most(least_apart, 0.6f * fabsf(a - b) / b);
  }
  for (int k = 0; k < 2; k++)
    ends[k] = (beyond != 0 ? to[k * last].weight_n[3] : 1) /
              (c->eye_inside != 0 ? from[k * last].weight_n[3] : 1);
  const float apart = fabsf(ends[0] - ends[1]) / ends[1];
  if (apart < least_apart) return 1e9f;
  const float cosine = clamp(-dot(w->sight, w->first.n), 0.05f, 1);
  const float turn = apart * (0.2f + sqrtf(1 - cosine * cosine) / cosine);
  return turn * (float)c->told->scene->size / (4 * w->first.t * c->told->pixel_angle) / 1.5f;
}

static void coarsen(bool coarser, int *base, int *count) {
  *base += coarser ? *count : 0;
  *count = coarser ? (*count + 1) >> 1 : *count;
}

static void choose_bands(const walker *w, int *base, int *count) {
  const float wanted = wanted_bands(w);
  *base = 0;
  *count = w->c->wavelengths;
  for (int k = 0; k < w->c->band_levels - 1; k++)
    coarsen((float)((*count + 1) >> 1) >= wanted, base, count);
  for (int k = 0; k < w->c->band_levels - 1; k++)
    coarsen(*count > w->c->told->eye_bands, base, count);
}

static void follow_pixel(walker *w, uint32_t pixel, uint32_t *out) {
  const int x = (int)(pixel & 0xffffu), y = (int)(pixel >> 16);
  int base, count;
  float mirrored, numbers[7] = {0};
  uint32_t in_mirror = 0;
  w->sight_chain = 0;
  aim_at(w, x, y);
  const path_state start = {
      .p = vector_at(w->c->told->eye_view), .d = w->sight, .inside = w->c->eye_inside};
  if (next_interface(w, &start, &w->first)) {
    w->refractor = w->first.refractor;
    choose_bands(w, &base, &count);
    const int step = w->c->told->interleaves && count > 2 ? 2 : 1;
    v3 sum = {0, 0, 0}, mirror = {0, 0, 0};
    /* What is mirrored is alike for all wavelengths: their joined band shows it. */
    w->band_at = w->c->band_count - 1;
    const v3 off_mirror = path_light(w, true, &mirrored);
    in_mirror = w->sight_chain;
    w->sight_chain = 0;
    const int turn = w->c->told->sample_turn;
    for (int i = step > 1 ? (turn > 0 ? turn ^ turn / 2 : x ^ y) & 1 : 0; i < count; i += step) {
      w->band_at = base + i;
      sum = plus(sum, path_light(w, false, &mirrored));
      mirror = plus(mirror, times(mirrored, band_weight(w)));
    }
    sum = plus(sum, by_parts(mirror, off_mirror));
    memcpy(numbers, (float[7]){sum.x, sum.y, sum.z, w->first.t, mirror.x, mirror.y, mirror.z},
           sizeof numbers);
  }
  for (int k = 0; k < 7; k++) out[k] = bits_of(numbers[k]);
  out[7] = in_mirror;
  out[8] = w->sight_chain;
}

static size_t follow_all(const tables *c, size_t first, size_t end) {
  uint32_t found = 0;
#pragma omp parallel for schedule(dynamic)
  for (size_t i = first; i < end; i += TASK) {
    walker w = {.c = c, .found = &found};
    for (size_t k = i; k < end && k < i + TASK; k++)
      follow_pixel(&w, c->pixel[k], c->sight_pixels + ABBE_SIGHT_PIXEL_WORDS * (k - first));
  }
  return found;
}

size_t abbe_camera_paths_follow(const abbe_camera_paths *paths, const abbe_sight_buffers *to,
                                size_t first, size_t count) {
  const abbe_gpu_scene *scene = paths->scene;
  abbe_gpu_maps m = {.gl = scene->gpu->gl, .whole = true};
  tables c = {.told = paths,
              .triangles = abbe_gpu_map(&m, scene->bvh[1], GL_MAP_READ_BIT),
              .corners = abbe_gpu_map(&m, scene->bvh[2], GL_MAP_READ_BIT),
              .band_texels = abbe_gpu_map(&m, scene->band_texels, GL_MAP_READ_BIT),
              .refractors = abbe_gpu_map(&m, scene->refractors, GL_MAP_READ_BIT),
              .receivers = abbe_gpu_map(&m, scene->receivers, GL_MAP_READ_BIT),
              .bands = abbe_gpu_map(&m, scene->bands, GL_MAP_READ_BIT),
              .pixel = abbe_gpu_map(&m, to->pixels, GL_MAP_READ_BIT),
              .sights = abbe_gpu_map(&m, to->sights, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT),
              .sight_pixels = abbe_gpu_map(&m, to->sight_pixels, GL_MAP_WRITE_BIT),
              .sight_room = to->sight_room,
              .refractor_radius = (float)scene->refractor_radius,
              .refractor_count = (int)scene->plan->refractor_count,
              .receiver_count = (int)scene->plan->parallelogram_count,
              .wavelengths = (int)scene->plan->desc.wavelengths,
              .band_count = (int)scene->band_count,
              .band_levels = (int)scene->band_levels,
              .eye_inside = scene->plan->eye_inside};
  size_t found = 0;
  if (m.whole) {
    c.pixel += ABBE_GPU_LIST_HEADER / sizeof *c.pixel;
    c.sights += ABBE_GPU_LIST_HEADER / sizeof *c.sights;
    found = follow_all(&c, first, first + count);
  }
  abbe_gpu_unmap(&m);
  return found;
}
