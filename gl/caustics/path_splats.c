#include "gl/caustics/path_light.h"

#include "base/maths.h"

#include <stdlib.h>

enum { MAX_ACROSS = 12, PAIR_INTERVALS = 8, AHEAD = LANES };

static inline uint32_t signature_at(const abbe_path_splats *p, const uint32_t *of, size_t at) {
  return of[at * p->signature_words];
}

/* photon_footprint.glsl */
typedef struct reference {
  size_t order, sample;
  uint32_t signature;
  int tile;
  v2 at;
} reference;

static float from_snorm(uint32_t word, int half) {
  const int16_t bits = (int16_t)(word >> 16 * half & 0xffffu);
  return most((float)bits / 32767.0f, -1);
}

static v2 neighbour_step(const abbe_path_splats *p, const abbe_path_photon *photon, int x, int y,
                         const reference *r) {
  static const v2 none = {0, 0};
  const int cx = (int)(photon->cell & 0xffffu) + x, cy = (int)(photon->cell >> 16) + y;
  if (cx < 0 || cy < 0 || cx >= p->grid[0] || cy >= p->grid[1] || r->signature == 0) return none;
  const uint32_t slot = p->photon_of_cell[cy * p->grid[0] + cx];
  if (slot == 0) return none;
  const size_t index = ((size_t)(slot - 1) * p->slots + r->order) * p->stride + r->sample;
  if (signature_at(p, p->signatures, index) != r->signature) return none;
  const uint32_t offset = p->photons[slot - 1].offset;
  const float along_x = (float)x + from_snorm(offset, 0) - from_snorm(photon->offset, 0);
  const float along_y = (float)y + from_snorm(offset, 1) - from_snorm(photon->offset, 1);
  const float apart = most(along_x * (float)x + along_y * (float)y, 0.25f);
  return times2(1 / apart, off2(map_position(p, vector_at(p->hits[2 * index]), r->tile), r->at));
}

static v2 image_of_side(v2 to_next, v2 to_last, v2 *skew) {
  *skew = (v2){0, 0};
  if (to_next.x == 0 && to_next.y == 0) return times2(-1, to_last);
  if (to_last.x == 0 && to_last.y == 0) return to_next;
  *skew = (v2){0.5f * (to_next.x + to_last.x), 0.5f * (to_next.y + to_last.y)};
  return times2(0.5f, off2(to_next, to_last));
}

/* A level of the map for what is so wide. */
static void choose_level(const abbe_path_splats *p, float wide, footprint *f) {
  const float narrowest = most(most(f->narrow, wide / MAX_ACROSS), 0.5f);
  const float fine = most(log2f(narrowest) + 1.25f, 0),
              whole = least(floorf(fine), (float)(p->map_levels - 1));
  f->level = (int)whole;
  f->to_next = f->level > 0 && f->level + 1 < p->map_levels ? clamp(fine - whole, 0, 1) : 0;
}

static footprint footprint_of(const abbe_path_splats *p, const abbe_path_photon *photon,
                              const reference *r) {
  v2 skew_a, skew_b;
  const float extent[2] = {(float)(photon->extent & 0xffffu) / 65535.0f,
                           (float)(photon->extent >> 16) / 65535.0f};
  const v2 right = neighbour_step(p, photon, 1, 0, r), left = neighbour_step(p, photon, -1, 0, r);
  const v2 above = neighbour_step(p, photon, 0, 1, r), below = neighbour_step(p, photon, 0, -1, r);
  const v2 a = times2(extent[0], image_of_side(right, left, &skew_a));
  const v2 b = times2(extent[1], image_of_side(above, below, &skew_b));
  const float xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
  const float half_trace = 0.5f * (xx + yy), root = length2((v2){0.5f * (xx - yy), xy});
  float wide = sqrtf(half_trace + root), narrow = sqrtf(most(half_trace - root, 0));
  v2 axis = xx > yy ? (v2){0.5f * (xx - yy) + root, xy} : (v2){xy, 0.5f * (yy - xx) + root};
  const bool by_a = dot2(a, a) > dot2(b, b);
  const v2 side = by_a ? a : b;
  if (narrow > 0.6f * wide) {
    const float area = wide * narrow;
    axis = side;
    wide = most(length2(side), 1e-20f);
    narrow = area / wide;
  }
  footprint f = {.narrow = narrow, .across = times2(wide / most(length2(axis), 1e-20f), axis)};
  f.skew = by_a ? times2(extent[0], skew_a) : times2(extent[1], skew_b);
  if (dot2(f.across, side) < 0) f.across = times2(-1, f.across);
  f.skew = times2(least(1, wide / most(length2(f.skew), 1e-20f)), f.skew);
  choose_level(p, wide, &f);
  const float scale = least(wide, 2 * (float)(1 << f.level) * MAX_ACROSS) / most(wide, 1e-20f);
  f.across = times2(scale, f.across);
  f.skew = times2(scale, f.skew);
  return f;
}

/* photon_deposit.comp */
static photon_path path_at(const abbe_path_splats *p, uint32_t listed) {
  const size_t item = listed / p->slots;
  photon_path out = {.order = listed % p->slots};
  size_t photon = item;
  if (p->fine_nodes > 0) {
    const int interval = (int)(p->pairs[item] % PAIR_INTERVALS);
    photon = p->pairs[item] / PAIR_INTERVALS;
    out.node_first = p->coarse_node[interval];
    out.node_last = out.interval_last = p->coarse_node[interval + 1];
    out.hit_first = (size_t)listed * (size_t)p->fine_nodes;
    out.middle_twice = 2 * interval + 1;
    out.intervals = out.node_last - out.node_first;
  } else {
    out.node_first = p->sample_first;
    out.node_last = p->sample_first + p->sample_count - 1;
    out.hit_first = (size_t)listed * p->stride;
    out.middle_twice = p->sample_count;
    out.interval_last = p->interval_end - 1;
    out.intervals = p->interval_end - p->interval_first;
    out.refined = p->wants != NULL ? p->wants[photon] << 1 : 0;
  }
  out.photon = p->photons + photon;
  out.coarse_first = (photon * p->slots + out.order) * p->stride;
  return out;
}

static reference reference_of(const abbe_path_splats *p, photon_path *path) {
  reference r = {.order = path->order, .tile = NO_TILE};
  for (int i = 0; i < p->sample_count; i++) {
    const uint32_t found = signature_at(p, p->signatures, path->coarse_first + (size_t)i);
    if (found != 0 && (r.signature == 0 || abs(2 * i - path->middle_twice) <
                                               abs(2 * (int)r.sample - path->middle_twice))) {
      r.signature = found;
      r.sample = (size_t)i;
    }
  }
  path->signature = r.signature;
  for (int i = 0; i < p->fine_nodes; i++) {
    const uint32_t found = signature_at(p, p->node_signatures, path->hit_first + (size_t)i);
    if (found > path->signature) path->signature = found;
  }
  if (r.signature == 0) return r;
  const size_t at = 2 * (path->coarse_first + r.sample);
  r.tile = interface_tile(p->hits[at + 1][3]);
  r.at = map_position(p, vector_at(p->hits[at]), r.tile);
  return r;
}

/* photon_deposit.comp: the light of all paths, span by span from long waves to short ones. */
static void lay_paths(const abbe_path_splats *p, photon_path *paths, float entry[3][LANES],
                      splat_list *to) {
  path_nodes ring[4];
  path_spans spans;
  path_trails trails = {.moved = {0}};
  int turns = 0;
  for (int k = 0; k < LANES; k++) {
    trails.left_parts[k] = 1;
    if (paths[k].signature != 0 && paths[k].intervals >= turns) turns = paths[k].intervals + 1;
  }
  for (int turn = 0; turn < 2; turn++) abbe_path_nodes_read(p, paths, turn, &ring[turn]);
  for (int turn = 0; turn < turns; turn++) {
    abbe_path_nodes_read(p, paths, turn + 2, &ring[(turn + 2) % 4]);
    spans.z = &ring[turn > 0 ? (turn + 3) % 4 : 0];
    spans.a = &ring[turn % 4];
    spans.b = &ring[(turn + 1) % 4];
    spans.c = &ring[(turn + 2) % 4];
    abbe_path_spans_make(p, paths, turn, &trails, &spans);
    abbe_path_light_lay(p, &spans, paths, entry, to);
  }
  for (int k = 0; k < LANES; k++)
    if (paths[k].collected.weight > 0) abbe_path_light_list(p, &paths[k], to);
}

size_t abbe_path_splats_most(const abbe_path_splats *p) {
  const int spans = p->sample_count > p->fine_nodes ? p->sample_count : p->fine_nodes;
  return LANES * (size_t)(spans + 2) * (size_t)(2 * p->steps);
}

/* Of a path that is laid soon, and of its photon: they lie far apart. */
static void fetch(const abbe_path_splats *p, uint32_t listed) {
  const photon_path path = path_at(p, listed);
  const size_t nodes = (size_t)(p->fine_nodes > 0 ? p->fine_nodes : p->sample_count);
  const char *hits = (const char *)(p->node_hits + 2 * path.hit_first);
  for (size_t i = 0; i < nodes * 2 * sizeof *p->hits; i += 64) __builtin_prefetch(hits + i);
  __builtin_prefetch(p->node_signatures + path.hit_first * p->signature_words);
  __builtin_prefetch(p->signatures + path.coarse_first * p->signature_words);
  __builtin_prefetch(path.photon);
}

/* And of its neighbours', once its own are there. */
static void fetch_beside(const abbe_path_splats *p, uint32_t listed) {
  static const int beside[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const photon_path path = path_at(p, listed);
  for (int i = 0; i < 4; i++) {
    const int x = (int)(path.photon->cell & 0xffffu) + beside[i][0],
              y = (int)(path.photon->cell >> 16) + beside[i][1];
    const bool there = x >= 0 && y >= 0 && x < p->grid[0] && y < p->grid[1];
    const uint32_t slot = there ? p->photon_of_cell[y * p->grid[0] + x] : 0;
    if (slot == 0) continue;
    const size_t at =
        ((size_t)(slot - 1) * p->slots + path.order) * p->stride + (size_t)(path.middle_twice / 2);
    __builtin_prefetch(p->signatures + at * p->signature_words);
    __builtin_prefetch(p->hits + 2 * at);
    __builtin_prefetch(p->photons + slot - 1);
  }
}

SIDE_BY_SIDE __attribute__((flatten)) size_t
abbe_path_splats_list(const void *paths, size_t first, abbe_splat *splats, int64_t entry[3]) {
  const abbe_path_splats *p = paths;
  photon_path path[LANES];
  float own[3][LANES] = {{0}};
  splat_list to = {.splat = splats};
  for (size_t k = 0; k < LANES; k++) {
    const size_t i = first + k < p->count ? first + k : p->count - 1;
    fetch(p, p->paths[i + 2 * AHEAD < p->count ? i + 2 * AHEAD : i]);
    fetch_beside(p, p->paths[i + AHEAD < p->count ? i + AHEAD : i]);
    path[k] = path_at(p, p->paths[i]);
    const reference r = reference_of(p, &path[k]);
    path[k].footprint = footprint_of(p, path[k].photon, &r);
    path[k].rows = p->table_first +
                   (p->light * p->refractors + (path[k].signature & 255u)) * (size_t)(p->nodes + 1);
    if (first + k >= p->count) path[k].signature = 0;
  }
  lay_paths(p, path, own, &to);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < LANES; k++) entry[i] += llrintf(own[i][k] / p->ledger_unit);
  return to.count;
}
