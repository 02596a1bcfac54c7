#include "gl/photons/photon_paths.h"
#include "gl/paths/mesh_walk.h"

/* The functions and numbers that are the shaders' have their names. */
enum { MOST_SEGMENTS = 128, PAIR_INTERVALS = 8, MOST_RECEIVERS = 128, BLOCK = 1 << 12, TASK = 64 };
enum { RAYS = ABBE_RAYS };
enum {
  REACHED = ABBE_LEDGER_REACHED,
  REFLECTED = ABBE_LEDGER_REFLECTED,
  TRAPPED = ABBE_LEDGER_TRAPPED,
  MISSED = ABBE_LEDGER_MISSED,
  ENTRIES = ABBE_LEDGER_ENTRIES
};
static const uint32_t ON_A_TILE = 0x40000000u;

/* Light of common.glsl. */
typedef struct path_light {
  float near_view[24], map_view[24], position[4], direction[4], white[4], misc[4], cube[4];
} path_light;

/* What all photons share. */
typedef struct job {
  const abbe_trace_pass *pass;
  const abbe_photon_batch *told;
  abbe_walk_scene scene;
  const path_light *light;
  const abbe_photon *photons;
  const uint32_t *pairs;
  const float (*spectra)[4], (*sample_weight)[4];
  float (*hits)[4];
  uint32_t *signatures, *marks;
  size_t items, slots, stride, wavelengths, nodes;
  float grid[2], ledger_unit;
  bool shadows, tiles;
  int tile_of_side[2 * MOST_RECEIVERS];
  float tile[ABBE_RECEIVER_TILES][ABBE_TILE_FLOATS];
  float chart[MOST_RECEIVERS][ABBE_TILE_FLOATS]; /* to its coordinates, while tiles are chosen */
} job;

/* Of a photon or of an interval of its. */
typedef struct task {
  size_t item, photon, sample;
  int wavelength, interval, low, high; /* low and high: -1 where there is no interval */
} task;

typedef struct photon_ray {
  v3 o, d;
  abbe_walk_interface first;
  float flux;
} photon_ray;

typedef struct receiver_hit {
  int receiver, tile; /* -1: none */
  bool held, on_tile;
  uint32_t part;
  v3 place;
} receiver_hit;

static bool receiver_lit(const job *j, v3 p, v3 n, v3 d, float distance_m) {
  float t;
  if (!j->shadows) return true;
  const float gap = 8e-6f * (fabsf(p.x) + fabsf(p.y) + fabsf(p.z));
  const v3 from = plus(p, times(dot(n, d) < 0 ? gap : -gap, n));
  return abbe_walk_receiver_at(&j->scene, from, times(-1, d), 0, distance_m * (1 - 2e-5f), &t) < 0;
}

static float light_to(const path_light *l, v3 p, v3 *d) {
  *d = vector_at(l->direction);
  if ((int)l->position[3] == 2) return 1e30f;
  const v3 along = off(p, vector_at(l->position));
  const float distance_m = length(along);
  *d = times(1 / distance_m, along);
  return distance_m;
}

static bool is_on_view(const float v[24], v3 p) {
  const v3 d = off(p, vector_at(v));
  const float z = v[3] > 0.5f ? dot(d, vector_at(v + 12)) : 1;
  const float x = dot(d, vector_at(v + 4)) / z, y = dot(d, vector_at(v + 8)) / z;
  const float u = (x - v[16]) / (v[17] - v[16]), w = (y - v[18]) / (v[19] - v[18]);
  return z > 0 && u >= 0 && w >= 0 && u < 1 && w < 1;
}

static v2 place_on(const float *rows, v3 at) {
  return (v2){dot(vector_at(rows), at) + rows[3], dot(vector_at(rows + 4), at) + rows[7]};
}

/* Where the light's map does not hold a place: the tile that does. */
static void look_beside_map(const job *j, int side, receiver_hit *to) {
  to->tile = j->tile_of_side[side];
  if (j->pass->atlas->fits) {
    const v2 at = place_on(j->chart[side / 2], to->place);
    to->place = (v3){at.x, at.y, (float)side};
    to->on_tile = true;
  } else if (to->tile >= 0) {
    const float *rows = j->tile[to->tile], *rect = rows + 8;
    const v2 at = place_on(rows, to->place);
    to->on_tile = at.x >= rect[0] && at.y >= rect[1] && at.x < rect[2] && at.y < rect[3];
  }
  to->held = to->on_tile;
  to->part += to->on_tile ? 7919u * ((uint32_t)side + 1u) : 0u;
}

static receiver_hit meet_receiver(const job *j, v3 p, v3 d, float t_min, float t_max) {
  float t;
  v3 from;
  receiver_hit to = {.receiver = abbe_walk_receiver_at(&j->scene, p, d, t_min, t_max, &t),
                     .tile = -1};
  if (to.receiver < 0) return to;
  const v3 n = vector_at(j->scene.receivers[to.receiver].normal);
  to.place = plus(p, times(t, d));
  to.part = (uint32_t)to.receiver + 1u;
  const float distance_m = light_to(j->light, to.place, &from);
  to.held =
      is_on_view(j->light->map_view, to.place) && receiver_lit(j, to.place, n, from, distance_m);
  if (!to.held && j->tiles)
    look_beside_map(j, 2 * to.receiver + (dot(n, d) > 0 ? 1 : 0), &to);
  else
    to.tile = -1;
  return to;
}

/* A free slot, the path's own if it can be; -1: all are used. */
static int take_slot(uint32_t path, uint32_t slots, uint32_t *used) {
  const uint32_t at = (path * 2654435761u >> 8) % slots;
  const uint32_t unused = ~*used & (0xffffffffu >> (32 - slots)), from_there = unused >> at << at;
  const uint32_t of = from_there != 0 ? from_there : unused;
  if (of == 0) return -1;
  const int slot = __builtin_ctz(of);
  *used |= 1u << slot;
  return slot;
}

/* outgoing_segment.glsl */
static float interface_word(v3 n, bool transmits, int tile) {
  const float scale = 1 / most(fabsf(n.x) + fabsf(n.y) + fabsf(n.z), 1e-20f);
  const uint32_t x = (uint32_t)rintf((n.x * scale * 0.5f + 0.5f) * 2046),
                 y = (uint32_t)rintf((n.y * scale * 0.5f + 0.5f) * 2046);
  const uint32_t exponent = 1u + (uint32_t)(tile + 1) + (transmits ? 80u : 0u);
  const uint32_t bits = (n.z < 0 ? 0x80000000u : 0u) | exponent << 23 | x << 11 | y;
  float word;
  memcpy(&word, &bits, sizeof word);
  return word;
}

static void keep_hit(const job *j, const task *t, const photon_ray *r, const abbe_walk_path *at,
                     const receiver_hit *to, size_t slot) {
  const uint32_t owner = (uint32_t)r->first.refractor;
  const bool last = at->transmitted && at->inside == 0 && at->refractor == (int)owner;
  const v3 n = dot(at->interface_n, at->d) < 0 ? times(-1, at->interface_n) : at->interface_n;
  const size_t path = t->item * j->slots + slot, index = path * j->stride + t->sample;
  const float word = interface_word(n, last, to->tile);
  const float hit[8] = {to->place.x, to->place.y, to->place.z, at->share * r->flux,
                        at->p.x,     at->p.y,     at->p.z,     word};
  memcpy(j->hits[2 * index], hit, sizeof hit);
  j->marks[path] = 1;
  j->signatures[index] =
      ((at->path * 31u + to->part) << 8 & (j->tiles ? ~ON_A_TILE : 0xffffffffu)) | 0x80000000u |
      (to->on_tile ? ON_A_TILE : 0u) | owner;
}

static void end_path(const job *j, const task *t, const photon_ray *r, const abbe_walk_path *at,
                     const receiver_hit *to, uint32_t *used, float entry[ENTRIES]) {
  const bool lands = to->receiver >= 0 && to->held;
  const int slot = lands ? take_slot(at->path, (uint32_t)j->slots, used) : -1;
  if (slot >= 0)
    keep_hit(j, t, r, at, to, (size_t)slot);
  else if (lands || (to->receiver < 0 && at->inside != 0))
    entry[TRAPPED] += at->share;
  else
    entry[at->interfaces == 0 && at->inside == 0 ? REFLECTED : MISSED] += at->share;
}

/* A photon of one wavelength that is followed. */
typedef struct walker {
  task of;
  const photon_ray *ray;
  abbe_walk walk;
  abbe_walk_path at;
  uint32_t used;
  float entry[ENTRIES];
} walker;

/* Such, side by side. */
typedef struct group {
  walker walker[RAYS];
  int count;
} group;

/* photon_walk.glsl. The first interface is the same at all wavelengths. */
static void begin(const job *j, const task *t, const photon_ray *r, walker *w) {
  *w = (walker){.of = *t,
                .ray = r,
                .walk = {.of = &j->scene,
                         .n = j->spectra[t->wavelength],
                         .apart = 4 * j->wavelengths,
                         .pending = {{.share = 0}}},
                .at = {.p = r->o,
                       .d = r->d,
                       .interface_n = r->d,
                       .share = 1,
                       .interfaces = -1,
                       .refractor = -1},
                .entry = {[REACHED] = 1}};
  w->entry[TRAPPED] += abbe_walk_branch(&w->walk, &w->at, &r->first);
}

/* A segment, to the interface that it meets or to none. */
static void follow_segment(const job *j, walker *w, const abbe_walk_interface *h) {
  abbe_walk_path *at = &w->at;
  const float t_min = at->inside == 0 ? -ABBE_WALK_TOUCH * j->scene.refractor_radius : 0;
  const receiver_hit to = meet_receiver(j, at->p, at->d, t_min, h != NULL ? h->t : 1e30f);
  if (to.receiver < 0 && h != NULL) {
    w->entry[TRAPPED] += abbe_walk_branch(&w->walk, at, h);
  } else {
    end_path(j, &w->of, w->ray, at, &to, &w->used, w->entry);
    at->share = 0;
  }
  if (at->share <= 0) *at = abbe_walk_take(&w->walk);
}

static void follow(const job *j, group *g) {
  const abbe_walk_path *at[RAYS] = {0};
  abbe_walk_interface h[RAYS];
  bool goes_on = g->count > 0;
  for (int k = 0; k < g->count; k++) at[k] = &g->walker[k].at;
  for (int segment = 0; goes_on && segment < MOST_SEGMENTS; segment++) {
    const unsigned met = abbe_walk_next(&j->scene, at, g->count, h);
    goes_on = false;
    for (int k = 0; k < g->count; k++) {
      walker *w = &g->walker[k];
      if (w->at.share > 0) follow_segment(j, w, (met >> k & 1u) != 0 ? &h[k] : NULL);
      goes_on |= w->at.share > 0;
    }
  }
  for (int k = 0; k < g->count; k++) {
    walker *w = &g->walker[k];
    w->entry[TRAPPED] += w->at.share;
    for (int i = 0; i < ABBE_WALK_PENDING; i++) w->entry[TRAPPED] += w->walk.pending[i].share;
  }
}

/* light_profile() of common.glsl, where it is none. */
static bool is_dark(const path_light *l, v3 d) {
  const float c = dot(d, vector_at(l->direction)), outer = l->direction[3], inner = l->misc[0];
  const int kind = (int)l->position[3];
  if (kind >= 3) return c <= 0;
  return kind == 1 && (inner <= outer ? c < outer : c <= outer);
}

/* photon_start.glsl, but for the interface, which is met here. */
static void aim(const job *j, const abbe_photon *from, photon_ray *r) {
  const float *v = j->light->near_view;
  const float x = ((float)(from->cell & 0xffffu) + 0.5f + snorm_of(from->offset, 0)) / j->grid[0];
  const float y = ((float)(from->cell >> 16) + 0.5f + snorm_of(from->offset, 1)) / j->grid[1];
  const v3 side = plus(times(mix(v[16], v[17], x), vector_at(v + 4)),
                       times(mix(v[18], v[19], y), vector_at(v + 8)));
  const bool perspective = v[3] > 0.5f;
  r->o = perspective ? vector_at(v) : plus(vector_at(v), side);
  r->d = perspective ? normalize(plus(vector_at(v + 12), side)) : vector_at(v + 12);
  r->flux = from->flux;
}

/* Returns a bit for each of so many items whose photon comes to a refractor. */
static unsigned start(const job *j, const task *t, int count, photon_ray *r) {
  abbe_walk_path path[RAYS];
  const abbe_walk_path *at[RAYS] = {0};
  abbe_walk_interface h[RAYS];
  for (int k = 0; k < count; k++) {
    aim(j, &j->photons[t[k].photon], &r[k]);
    path[k] =
        (abbe_walk_path){.p = r[k].o, .d = r[k].d, .share = is_dark(j->light, r[k].d) ? 0 : 1};
    at[k] = &path[k];
  }
  unsigned met = abbe_walk_next(&j->scene, at, count, h);
  for (int k = 0; k < count; k++) {
    if ((met >> k & 1u) == 0) continue;
    r[k].first = h[k];
    const float from_light = (int)j->light->position[3] == 2 ? 1e30f : h[k].t;
    if (!receiver_lit(j, h[k].p, h[k].n, r[k].d, from_light)) met &= ~(1u << k);
  }
  return met;
}

/* Units of a sum. */
static int64_t units_of(float share, float scale) {
  return (int64_t)(share * scale + 0.5f);
}

/* The coarse set entered light for the refined interval, too: its ends take that back. */
static void enter(const job *j, const task *t, float flux, const float entry[ENTRIES],
                  int64_t sum[ENTRIES]) {
  const float *weight = j->sample_weight[j->told->light * j->wavelengths + (size_t)t->wavelength];
  const bool coarse = j->told->set == ABBE_TRACE_COARSE;
  const bool at_low = t->wavelength == t->low, at_high = t->wavelength == t->high;
  const float below = coarse ? weight[2] : at_low ? 0 : weight[0];
  const float above = coarse ? weight[3] : at_high ? 0 : weight[1];
  const float back = at_low ? weight[3] : at_high ? weight[2] : 0, scale = flux / j->ledger_unit;
  if (t->wavelength < (int)j->told->ledger_first) return;
  for (int k = 0; k < ENTRIES; k++)
    if (entry[k] > 0)
      sum[k] += units_of(entry[k], below * scale) + units_of(entry[k], above * scale) -
                units_of(entry[k], back * scale);
}

/* photon_nodes.glsl */
static int coarse_node(const job *j, int k) {
  const int spaces = j->nodes > 1 ? (int)j->nodes - 1 : 1;
  return (k * ((int)j->wavelengths - 1) + ((int)j->nodes - 1) / 2) / spaces;
}

static void follow_group(const job *j, group *g, int64_t sum[ENTRIES]) {
  follow(j, g);
  for (int k = 0; k < g->count; k++) {
    const walker *w = &g->walker[k];
    enter(j, &w->of, w->ray->flux, w->entry, sum);
  }
  g->count = 0;
}

/* The item's task, but for the wavelength. */
static task task_of(const job *j, size_t item) {
  task t = {.item = item, .photon = item, .low = -1, .high = -1};
  if (j->pairs == NULL) return t;
  t.photon = j->pairs[item] / PAIR_INTERVALS;
  t.interval = (int)(j->pairs[item] % PAIR_INTERVALS);
  t.low = coarse_node(j, t.interval);
  t.high = coarse_node(j, t.interval + 1);
  return t;
}

/* At most RAYS items from there on. */
static void follow_items(const job *j, size_t first, int count, int64_t sum[ENTRIES]) {
  task t[RAYS];
  photon_ray r[RAYS];
  group g;
  g.count = 0;
  for (int k = 0; k < count; k++) t[k] = task_of(j, first + (size_t)k);
  const unsigned met = start(j, t, count, r);
  for (int k = 0; k < count; k++) {
    if ((met >> k & 1u) == 0) continue;
    for (t[k].sample = 0; t[k].sample < j->told->sample_count; t[k].sample++) {
      const size_t sample = t[k].sample;
      t[k].wavelength = j->told->set == ABBE_TRACE_COARSE ? coarse_node(j, (int)sample)
                        : j->pairs != NULL                ? t[k].low + (int)sample
                                                          : (int)(j->told->sample_first + sample);
      if (j->pairs != NULL && t[k].wavelength > t[k].high) break;
      begin(j, &t[k], &r[k], &g.walker[g.count++]);
      if (g.count == RAYS) follow_group(j, &g, sum);
    }
  }
  follow_group(j, &g, sum);
}

static void follow_all(const job *j, abbe_gpu *gpu, int64_t sum[ENTRIES]) {
  for (size_t at = 0; at < j->items && abbe_gpu_ask(gpu); at += BLOCK) {
    const size_t end = j->items - at < BLOCK ? j->items : at + BLOCK;
#pragma omp parallel for schedule(dynamic) reduction(+ : sum[:ENTRIES])
    for (size_t i = at; i < end; i += TASK)
      for (size_t k = i; k < end && k < i + TASK; k += RAYS)
        follow_items(j, k, (int)(end - k < RAYS ? end - k : RAYS), sum);
  }
}

bool abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *v) {
  return abbe_walk_serves(pass->spectra->scene, v) && v->receivers <= MOST_RECEIVERS && !v->haze &&
         !v->cubes;
}

/* What photon_trace.comp reads of tiles. */
static void take_tiles(job *j) {
  static const abbe_receiver_tile whole = {.window = {0, 1, 0, 1}, .rect = {0, 1, 0, 1}};
  const abbe_receiver_charts *charts = &j->pass->spectra->scene->charts;
  const abbe_receiver_tiles *tiles = &j->pass->atlas->tiles[j->told->light];
  for (int i = 0; i < 2 * MOST_RECEIVERS; i++) j->tile_of_side[i] = -1;
  for (size_t i = 0; j->tiles && i < (size_t)j->scene.receiver_count; i++)
    abbe_receiver_tile_pack(&whole, charts->parallelogram[i], j->chart[i]);
  for (size_t k = 0; j->tiles && k < tiles->count; k++) {
    const size_t side = tiles->tile[k].chart_side;
    j->tile_of_side[side] = (int)k;
    abbe_receiver_tile_pack(&tiles->tile[k], charts->parallelogram[side / 2], j->tile[k]);
  }
}

/* Lists begin behind their header; `most`: of what is on one. */
static const void *map_list(abbe_gpu_maps *m, GLuint list, size_t header, size_t *most) {
  const uint32_t *word = abbe_gpu_map(m, list, GL_MAP_READ_BIT);
  if (word == NULL) return NULL;
  *most = *word < *most ? *word : *most;
  return word + header / sizeof *word;
}

void abbe_photon_paths_follow(const abbe_trace_pass *pass, const abbe_photon_batch *batch,
                              const abbe_hits *hits) {
  const abbe_gpu_scene *scene = pass->spectra->scene;
  const abbe_photon_light *light = &pass->start->views->light[batch->light];
  abbe_gpu *gpu = scene->gpu;
  abbe_gpu_maps m = {.gl = gpu->gl, .whole = true};
  int64_t sum[ENTRIES] = {0};
  size_t photons = light->photon_count, pairs = batch->most_pairs;
  job j = {.pass = pass,
           .told = batch,
           .slots = scene->plan->hit_slots,
           .stride = hits->stride,
           .wavelengths = scene->plan->desc.wavelengths,
           .nodes = pass->spectra->nodes,
           .grid = {(float)light->cells[0], (float)light->cells[1]},
           .ledger_unit = (float)abbe_photon_ledger_unit(pass->ledger, batch->light),
           .shadows = scene->plan->receiver_shadows,
           .tiles = pass->atlas->used};
  abbe_gpu_clear_buffer(gpu, hits->signatures);
  abbe_gpu_clear_buffer(gpu, hits->marks);
  abbe_walk_map(&m, scene, (int)scene->plan->desc.exits, scene->plan->desc.energy_share, 0,
                &j.scene);
  j.light = abbe_gpu_map(&m, pass->start->views->lights, GL_MAP_READ_BIT);
  j.spectra = abbe_gpu_map(&m, scene->spectra, GL_MAP_READ_BIT);
  j.sample_weight = abbe_gpu_map(&m, pass->spectra->sample_weights, GL_MAP_READ_BIT);
  j.photons = map_list(&m, pass->start->photons, ABBE_PHOTON_HEADER, &photons);
  if (batch->set == ABBE_TRACE_REFINED)
    j.pairs = map_list(&m, batch->pairs, ABBE_GPU_LIST_HEADER, &pairs);
  j.items = batch->set == ABBE_TRACE_REFINED ? pairs : photons;
  j.hits = abbe_gpu_map(&m, hits->hits, GL_MAP_WRITE_BIT);
  j.signatures = abbe_gpu_map(&m, hits->signatures, GL_MAP_WRITE_BIT);
  j.marks = abbe_gpu_map(&m, hits->marks, GL_MAP_WRITE_BIT);
  take_tiles(&j);
  if (m.whole) {
    j.light += batch->light;
    follow_all(&j, gpu, sum);
  }
  const bool whole = m.whole;
  abbe_gpu_unmap(&m);
  if (whole) abbe_photon_ledger_enter(pass->ledger, sum);
}
