#include "gl/paths/camera_paths.h"
#include "gl/paths/mesh_walk.h"
#include "gl/scene/spectra/camera_bands.h"

/* The functions and numbers that are the shaders' have their names. */
enum { MOST_SEGMENTS = 224, PIXEL_THREADS = 8, TASK = 64, BLOCK = 64, RAYS = ABBE_RAYS };

/* What all pixels share. */
typedef struct tables {
  const abbe_camera_paths *told;
  abbe_walk_scene scene;
  const float (*band_texels)[4];
  const abbe_camera_band *bands;
  const uint32_t *pixel;
  uint32_t *sights, *sight_pixels;
  size_t sight_room;
  int wavelengths, band_count, band_levels;
  uint32_t eye_inside;
} tables;

/* A thread's places of those of all threads, and where its block of them ends. */
typedef struct places {
  uint32_t *found;
  uint32_t next, end;
} places;

/* What is followed for a pixel: one path, whose places are a chain. */
typedef struct walker {
  const tables *c;
  places *to;
  abbe_walk walk;
  abbe_walk_path at;
  v3 sight;
  abbe_walk_interface first;
  int refractor, band_set, band_at, segments;
  uint32_t sight_chain, chain_end;
  float of_background, seen_share, left, mirrored;
} walker;

static v3 by_parts(v3 a, v3 b) {
  return (v3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static int first_band(const walker *w, int r) {
  return (r * ABBE_CAMERA_BAND_SETS + w->band_set) * w->c->band_count;
}

static void take_band(walker *w, int band) {
  w->band_at = band;
  w->walk.n = w->c->bands[first_band(w, 0) + band].weight_n + 3;
}

static v3 band_weight(const walker *w) {
  return vector_at(w->c->bands[w->band_set * w->c->band_count + w->band_at].weight_n);
}

/* The nearest receiver: its place and sheet, as sights.glsl has them; false: there is none. */
static bool receiver_seen(const walker *w, v3 o, v3 d, float t_min, float t_max, v2 *place,
                          uint32_t *sheet) {
  float t;
  const int found = abbe_walk_receiver_at(&w->c->scene, o, d, t_min, t_max, &t);
  if (found < 0) return false;
  const abbe_walk_receiver *r = &w->c->scene.receivers[found];
  v3 p = plus(o, times(t, d));
  p = plus(p, times(r->normal[3] - abbe_walk_dot4(r->normal, p), vector_at(r->normal)));
  const v3 from = off(p, vector_at(r->anchor));
  *place = (v2){abbe_walk_dot4(r->du, from), abbe_walk_dot4(r->dv, from)};
  *sheet = 2 * (uint32_t)found + (abbe_walk_dot4(r->normal, d) > 0 ? 1 : 0);
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
static void follow_segment(walker *w, const abbe_walk_interface *h) {
  const tables *c = w->c;
  abbe_walk_path *at = &w->at;
  const float eye_n = abbe_walk_n(&w->walk, c->eye_inside);
  v2 place;
  uint32_t sheet;
  const float t_min = at->inside == 0 ? -ABBE_WALK_TOUCH * c->scene.refractor_radius : 0;
  const bool receiver =
      receiver_seen(w, at->p, at->d, t_min, h != NULL ? h->t : 1e30f, &place, &sheet);
  if (h != NULL && !receiver) {
    w->left += abbe_walk_branch(&w->walk, at, h);
  } else {
    const float n = receiver ? eye_n / abbe_walk_n(&w->walk, at->inside) : eye_n;
    if (receiver)
      note_sight(w, place, sheet, times(n * n * at->share, band_weight(w)));
    else
      w->of_background += n * n * at->share;
    w->seen_share += at->share;
    at->share = 0;
  }
  if (at->share <= 0) *at = abbe_walk_take(&w->walk);
  if (--w->segments > 0) return;
  w->left += at->share;
  at->share = 0;
}

/* XYZ of what is no receiver; what a path has left shows what the rest of it has shown. */
static v3 end_path(walker *w) {
  for (int k = 0; k < ABBE_WALK_PENDING; k++) w->left += w->walk.pending[k].share;
  const v3 weight = band_weight(w);
  const float left = w->left, seen_share = w->seen_share;
  const v3 tail = {1 + left * weight.x / most(seen_share * weight.x, 1e-30f),
                   1 + left * weight.y / most(seen_share * weight.y, 1e-30f),
                   1 + left * weight.z / most(seen_share * weight.z, 1e-30f)};
  weigh_sights(w, tail);
  return by_parts(tail, times(w->of_background, by_parts(weight, background_of(w))));
}

/* What a band shows through the first interface, or by unit share what it shows mirrored there. */
static void begin_path(walker *w, bool in_mirror, int band_at) {
  take_band(w, band_at);
  w->at = (abbe_walk_path){.p = vector_at(w->c->told->eye_view),
                           .d = w->sight,
                           .share = 1,
                           .inside = w->c->eye_inside,
                           .interfaces = -1};
  abbe_walk_path reflected;
  if (!abbe_walk_split(&w->walk, &w->at, &w->first, &reflected)) reflected.share = 0;
  w->mirrored = reflected.share;
  reflected.share = reflected.share > 0 ? 1 : 0;
  if (in_mirror) w->at = reflected;
  w->segments = most_segments(w->c->told);
}

/* Follows so many paths side by side to their ends. */
static void follow_paths(walker *const *w, int count) {
  abbe_walk_interface h[RAYS];
  const abbe_walk_path *at[RAYS] = {0};
  for (int k = 0; k < count; k++) at[k] = &w[k]->at;
  for (bool goes_on = true; goes_on;) {
    const unsigned met = abbe_walk_next(&w[0]->c->scene, at, count, h);
    goes_on = false;
    for (int k = 0; k < count; k++) {
      if (w[k]->at.share <= 0) continue;
      follow_segment(w[k], (met >> k & 1u) != 0 ? &h[k] : NULL);
      goes_on |= w[k]->at.share > 0;
    }
  }
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
  const abbe_camera_band *to =
      c->bands + (beyond != 0 ? first_band(w, abbe_walk_medium(beyond)) : 0);
  const abbe_camera_band *from =
      c->bands + (c->eye_inside != 0 ? first_band(w, abbe_walk_medium(c->eye_inside)) : 0);
  float ends[2], least_apart = 0;
  for (int r = 0; r < c->scene.refractor_count; r++) {
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

/* What a pixel's paths come to; all of them begin as `start` does. */
typedef struct pixel_light {
  walker start;
  v3 sum, mirror, off_mirror;
  uint32_t in_mirror, chain;
} pixel_light;

/* Paths that are followed side by side. */
typedef struct path_group {
  walker path[RAYS];
  pixel_light *of[RAYS];
  int count;
} path_group;

static void add_path(pixel_light *p, walker *w, bool in_mirror) {
  const v3 light = end_path(w);
  if (in_mirror) {
    p->off_mirror = light;
    p->in_mirror = w->sight_chain;
    return;
  }
  p->sum = plus(p->sum, light);
  p->mirror = plus(p->mirror, times(w->mirrored, band_weight(w)));
  if (w->sight_chain == 0) return;
  w->c->sights[ABBE_SIGHT_WORDS * (size_t)(w->chain_end - 1) + 5] |= p->chain;
  p->chain = w->sight_chain;
}

static void follow_group(path_group *g, bool in_mirror) {
  walker *w[RAYS];
  for (int k = 0; k < g->count; k++) w[k] = &g->path[k];
  if (g->count > 0) follow_paths(w, g->count);
  for (int k = 0; k < g->count; k++) add_path(g->of[k], w[k], in_mirror);
  g->count = 0;
}

static void begin_path_of(path_group *g, pixel_light *p, bool in_mirror, int band_at) {
  g->path[g->count] = p->start;
  g->of[g->count] = p;
  begin_path(&g->path[g->count++], in_mirror, band_at);
  if (g->count == RAYS) follow_group(g, in_mirror);
}

static void begin_bands_of(path_group *g, pixel_light *p, uint32_t pixel) {
  const tables *c = p->start.c;
  const int x = (int)(pixel & 0xffffu), y = (int)(pixel >> 16), turn = c->told->sample_turn;
  int base, count;
  choose_bands(&p->start, &base, &count);
  const int step = c->told->interleaves && count > 2 ? 2 : 1;
  for (int i = step > 1 ? (turn > 0 ? turn ^ turn / 2 : x ^ y) & 1 : 0; i < count; i += step)
    begin_path_of(g, p, false, base + i);
}

/* Which refractor the camera's rays meet first, of so many pixels; returns a bit for each. */
static unsigned find_first(pixel_light *p, const uint32_t *pixel, int count, const tables *c,
                           places *to) {
  walker *w[RAYS];
  abbe_walk_interface h[RAYS];
  const abbe_walk_path *at[RAYS] = {0};
  for (int k = 0; k < count; k++) {
    p[k] = (pixel_light){.start = {.c = c,
                                   .walk = {.of = &c->scene,
                                            .apart = sizeof *c->bands / sizeof(float) *
                                                     ABBE_CAMERA_BAND_SETS * (size_t)c->band_count},
                                   .to = to}};
    w[k] = &p[k].start;
    at[k] = &w[k]->at;
    aim_at(w[k], (int)(pixel[k] & 0xffffu), (int)(pixel[k] >> 16));
    w[k]->at = (abbe_walk_path){
        .p = vector_at(c->told->eye_view), .d = w[k]->sight, .share = 1, .inside = c->eye_inside};
  }
  const unsigned met = abbe_walk_next(&c->scene, at, count, h);
  for (int k = 0; k < count; k++) {
    if ((met >> k & 1u) == 0) continue;
    w[k]->first = h[k];
    w[k]->refractor = h[k].refractor;
  }
  return met;
}

/* At most RAYS pixels. What is mirrored is alike for all wavelengths: their joined band shows it.
 */
static void follow_pixels(const tables *c, places *to, const uint32_t *pixel, int count,
                          uint32_t *out) {
  pixel_light p[RAYS];
  path_group g;
  g.count = 0;
  const unsigned met = find_first(p, pixel, count, c, to);
  for (int k = 0; k < count; k++)
    if ((met >> k & 1u) != 0) begin_path_of(&g, &p[k], true, c->band_count - 1);
  follow_group(&g, true);
  for (int k = 0; k < count; k++)
    if ((met >> k & 1u) != 0) begin_bands_of(&g, &p[k], pixel[k]);
  follow_group(&g, false);
  for (int k = 0; k < count; k++, out += ABBE_SIGHT_PIXEL_WORDS) {
    const v3 mirror = p[k].mirror, sum = plus(p[k].sum, by_parts(mirror, p[k].off_mirror));
    const float numbers[7] = {sum.x,    sum.y,    sum.z,   p[k].start.first.t,
                              mirror.x, mirror.y, mirror.z};
    for (int i = 0; i < 7; i++) out[i] = bits_of(numbers[i]);
    out[7] = p[k].in_mirror;
    out[8] = p[k].chain;
  }
}

static size_t follow_all(const tables *c, size_t first, size_t end) {
  uint32_t found = 0;
#pragma omp parallel for schedule(dynamic)
  for (size_t i = first; i < end; i += TASK) {
    places to = {.found = &found};
    const size_t last = end - i < TASK ? end : i + TASK;
    for (size_t k = i; k < last; k += RAYS)
      follow_pixels(c, &to, c->pixel + k, (int)(last - k < RAYS ? last - k : RAYS),
                    c->sight_pixels + ABBE_SIGHT_PIXEL_WORDS * (k - first));
  }
  return found;
}

size_t abbe_camera_paths_follow(const abbe_camera_paths *paths, const abbe_sight_buffers *to,
                                size_t first, size_t count) {
  const abbe_gpu_scene *scene = paths->scene;
  abbe_gpu_maps m = {.gl = scene->gpu->gl, .whole = true};
  tables c = {.told = paths,
              .band_texels = abbe_gpu_map(&m, scene->band_texels, GL_MAP_READ_BIT),
              .bands = abbe_gpu_map(&m, scene->bands, GL_MAP_READ_BIT),
              .pixel = abbe_gpu_map(&m, to->pixels, GL_MAP_READ_BIT),
              .sights = abbe_gpu_map(&m, to->sights, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT),
              .sight_pixels = abbe_gpu_map(&m, to->sight_pixels, GL_MAP_WRITE_BIT),
              .sight_room = to->sight_room,
              .wavelengths = (int)scene->plan->desc.wavelengths,
              .band_count = (int)scene->band_count,
              .band_levels = (int)scene->band_levels,
              .eye_inside = scene->plan->eye_inside};
  size_t found = 0;
  abbe_walk_map(&m, scene, paths->exits, paths->share_limit, 0.5f * paths->share_limit, &c.scene);
  if (m.whole) {
    c.pixel += ABBE_GPU_LIST_HEADER / sizeof *c.pixel;
    c.sights += ABBE_GPU_LIST_HEADER / sizeof *c.sights;
    found = follow_all(&c, first, first + count);
  }
  abbe_gpu_unmap(&m);
  return found;
}
