#include "gl/paths/camera_walk.h"

enum { TASK = 64 };

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
  const v3 light = abbe_camera_path_end(w);
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
  if (g->count > 0) abbe_camera_walk(w, g->count);
  for (int k = 0; k < g->count; k++) add_path(g->of[k], w[k], in_mirror);
  g->count = 0;
}

static void begin_path_of(path_group *g, pixel_light *p, bool in_mirror, int band_at) {
  g->path[g->count] = p->start;
  g->of[g->count] = p;
  abbe_camera_path_begin(&g->path[g->count++], in_mirror, band_at);
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
  interface h[RAYS];
  for (int k = 0; k < count; k++) {
    p[k] = (pixel_light){.start = {.c = c, .to = to}};
    w[k] = &p[k].start;
    aim_at(w[k], (int)(pixel[k] & 0xffffu), (int)(pixel[k] >> 16));
    w[k]->at = (path_state){
        .p = vector_at(c->told->eye_view), .d = w[k]->sight, .share = 1, .inside = c->eye_inside};
  }
  const unsigned met = abbe_camera_next_interfaces(w, count, h);
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
