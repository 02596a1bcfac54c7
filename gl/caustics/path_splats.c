#include "gl/caustics/path_light.h"

#include "base/maths.h"

#include <stdlib.h>

#define SEGMENT 2.0f
#define EVEN 0.25f
#define LEAST_LEFT 1e-4f
enum { MAX_ACROSS = 12, MOST_PARTS = 16, TILE_BITS = 80, PAIR_INTERVALS = 8, AHEAD = 4 };

static v3 interface_normal(uint32_t bits) {
  const float x = (float)(bits >> 11 & 2047u) / 2046.0f * 2 - 1,
              y = (float)(bits & 2047u) / 2046.0f * 2 - 1, z = 1 - fabsf(x) - fabsf(y);
  const v3 n = {x, y, bits >> 31 != 0 ? -z : z};
  return times(1 / length(n), n);
}

static inline int interface_tile(float word) {
  return (int)(((bits_of(word) >> 23 & 255u) - 1u) % TILE_BITS) - 1;
}

static light_segment segment_of(const float landed[4], const float left[4], float index) {
  light_segment e = {.place = vector_at(landed), .interface_at = vector_at(left)};
  const uint32_t bits = bits_of(left[3]);
  e.n = interface_normal(bits);
  const v3 outward = off(e.place, e.interface_at);
  const float length_m = length(outward);
  e.far = length_m > 1e-4f * (length(e.place) + length(e.interface_at));
  e.transmits = e.far && (bits >> 23 & 255u) > TILE_BITS;
  const v3 d = times(1 / most(length_m, 1e-30f), outward);
  const float cosine = dot(d, e.n);
  e.along = off(d, times(cosine, e.n));
  e.passes = most(transmission(e.transmits, cosine, index), 1e-6f);
  e.arrives = landed[3] / e.passes;
  return e;
}

static light_fan fan_between(const light_segment *a, const light_segment *b, v3 curve) {
  const v3 chord = off(b->place, a->place), to_a = off(a->place, a->interface_at),
           to_b = off(b->place, b->interface_at);
  const v3 d = plus(times(1 / length(to_a), to_a), times(1 / length(to_b), to_b));
  light_fan f = {.curve = curve,
                 .facing = off(d, times(dot(d, chord) / most(dot(chord, chord), 1e-30f), chord))};
  f.bends = a->far && b->far && (chord.x != 0 || chord.y != 0 || chord.z != 0) &&
            dot(f.facing, f.facing) > 1e-4f;
  return f;
}

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

static path_node node_at(const abbe_path_splats *p, size_t at, bool there, float index,
                         v2 elsewhere) {
  path_node n = {.index = index, .at = elsewhere, .tile = NO_TILE};
  const uint32_t *word = p->node_signatures + at * p->signature_words;
  if (!there || word[0] == 0) return n;
  const float *landed = p->node_hits[2 * at], *left = p->node_hits[2 * at + 1];
  n.path = word[0];
  n.left = segment_of(landed, left, index);
  n.tile = interface_tile(left[3]);
  n.at = map_position(p, n.left.place, n.tile);
  n.flux = landed[3];
  for (size_t k = 0; k < p->tint_count; k++) {
    const uint32_t bits = (word[k + 1] & ~255u) >> 1;
    n.of[k] = word[k + 1] & 255u;
    memcpy(&n.amount[k], &bits, sizeof bits);
  }
  return n;
}

static inline const float (*tint_at(const abbe_path_splats *p, int of_node, uint32_t r))[4] {
  return p->tints + 2 * ((size_t)of_node * p->refractors + r);
}

/* The depths of both parts of a half of a node's band, and by how much they range at the most. */
static void depth_of(const abbe_path_splats *p, const path_node *n, int of_node, bool above,
                     float depth[2], float *range) {
  depth[0] = depth[1] = *range = 0;
  for (size_t k = 0; k < p->tint_count; k++) {
    const float(*t)[4] = tint_at(p, of_node, n->of[k]);
    for (int i = 0; i < 2; i++) depth[i] += n->amount[k] * t[0][(above ? 2 : 0) + i];
    *range += n->amount[k] * t[1][0];
  }
  if (!(n->flux > 0) || !(expf(least(*range - least(depth[0], depth[1]), 0)) > LEAST_LEFT))
    *range = 0;
}

static inline float left_after(const float depth[2]) {
  return 0.5f * (expf(-depth[0]) + expf(-depth[1]));
}

static left_over left_at_nodes(const abbe_path_splats *p, const path_node *a, const path_node *b,
                               int interval) {
  if (p->tint_count == 0) return (left_over){1, 1, 1};
  float depth_a[2], depth_b[2], range_a, range_b;
  const int last = p->nodes - 1, at_a = interval < 0 ? 0 : interval > last ? last : interval;
  depth_of(p, a, at_a, false, depth_a, &range_a);
  depth_of(p, b, interval > 1 ? interval - 1 : 0, true, depth_b, &range_b);
  const float needed = clamp(2 * most(range_a, range_b) / EVEN, 1, MOST_PARTS);
  int parts = 1;
  while ((float)parts < needed) parts *= 2;
  return (left_over){left_after(depth_a), left_after(depth_b), parts};
}

/* interval_span.glsl */
typedef struct trail {
  path_node z, a;
  bool followed, owes;
  v2 step;
  float moved, curve[4];
  size_t owed_row;
  left_over owed_left;
} trail;

/* A path whose light is laid; node 0 is `node_first`. */
typedef struct photon_path {
  const abbe_path_photon *photon;
  size_t order, hit_first, coarse_first, rows;
  int node_first, node_last, middle_twice, interval_last, intervals;
  uint32_t refined, signature;
} photon_path;

static bool moves_likewise(const abbe_path_splats *p, const photon_path *path, int number,
                           bool has_b, size_t hit_b, const path_node *b, v2 step, v2 before) {
  v2 after = {0, 0};
  if (has_b && number - 1 > path->node_first) {
    const uint32_t path_c = signature_at(p, p->node_signatures, hit_b - 1);
    if (path_c != 0 && path_c == b->path)
      after = off2(map_position(p, vector_at(p->node_hits[2 * (hit_b - 1)]), b->tile), b->at);
  }
  return least(length2(off2(step, before)), length2(off2(step, after))) < 0.75f * length2(step);
}

static int parts_of(float moved, float size, int least_parts, int most_parts) {
  int parts = 1;
  while ((float)parts * SEGMENT * size < moved && parts < most_parts) parts *= 2;
  parts = parts > least_parts ? parts : least_parts;
  return parts < most_parts ? parts : most_parts;
}

static void divide(const abbe_path_splats *p, light_span *s, const trail *t, bool taken,
                   float moved, float size) {
  const float moved_along = s->bridges ? moved : s->follows ? t->moved : 0;
  const bool ends = s->follows && !s->bridges && s->to->left.transmits &&
                    cosine_between(&s->from->left, &s->to->left, &s->fan,
                                   (s->index_b - s->from->index) * s->per_index) == 0;
  s->steps = s->bridges || ends ? p->steps : p->steps / 2;
  s->parts = taken && s->a->flux > 0 ? parts_of(moved_along, size, s->left.parts, s->steps) : 0;
  s->owed = t->owes ? parts_of(s->bridges ? moved : 0, size, s->owed_left.parts, p->steps / 2) : 0;
}

static void bend(light_span *s, const trail *t, const path_node *b) {
  const path_node *z = &t->z, *a = &t->a;
  const float back = (z->index - a->index) * s->per_index; /* where z lies, below 0 */
  const float of_z[4] = {z->left.along.x, z->left.along.y, z->left.along.z, z->left.arrives};
  const float of_a[4] = {a->left.along.x, a->left.along.y, a->left.along.z, a->left.arrives};
  const float of_b[4] = {b->left.along.x, b->left.along.y, b->left.along.z, b->left.arrives};
  for (int k = 0; k < 4; k++)
    s->curve[k] = t->followed && back < -0.05f
                      ? (of_z[k] - of_a[k] - back * (of_b[k] - of_a[k])) / (back * (back - 1))
                      : 0;
}

/* From node `number` to the one before it, which is b. taken: this pass lays it. */
static light_span span_of(const abbe_path_splats *p, trail *t, const photon_path *path, int number,
                          bool taken, bool has_b, size_t hit_b, size_t row, const path_node *b,
                          float size) {
  light_span s = {.z = &t->z,
                  .a = &t->a,
                  .b = b,
                  .from = &t->z,
                  .to = &t->a,
                  .row = row,
                  .index_b = b->index,
                  .owed_row = t->owed_row,
                  .owed_left = t->owed_left,
                  .first = path->signature & 255u};
  s.left = left_at_nodes(p, &t->a, b, number);
  const v2 step = off2(b->at, t->a.at);
  const float moved = most(fabsf(step.x), fabsf(step.y));
  bool one_path = p->bridges && t->a.path != 0 && t->a.path == b->path;
  const v2 before = t->step;
  t->step = one_path ? step : (v2){0, 0};
  one_path = one_path && (moved < (float)p->map_size / 16 || !p->doubts ||
                          moves_likewise(p, path, number, has_b, hit_b, b, step, before));
  s.bridges = taken && one_path;
  s.follows = s.bridges || (taken && t->followed);
  if (s.bridges) {
    s.from = &t->a;
    s.to = b;
  }
  const float between = s.to->index - s.from->index;
  s.per_index = between != 0 ? 1 / between : 0;
  memcpy(s.curve, t->curve, sizeof s.curve);
  if (s.bridges) bend(&s, t, b);
  if (s.follows)
    s.fan = fan_between(&s.from->left, &s.to->left, (v3){s.curve[0], s.curve[1], s.curve[2]});
  s.half_y = sums_at(p, row, p->steps / 2).xyz[1];
  divide(p, &s, t, taken, moved, size);
  t->owes = taken && !s.bridges && b->path != 0;
  t->owed_row = row;
  t->followed = one_path;
  memcpy(t->curve, s.curve, sizeof s.curve);
  t->moved = moved;
  return s;
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

static size_t row_of(const abbe_path_splats *p, const photon_path *path, int interval) {
  const int number = interval < 0 ? 0 : interval < p->nodes ? interval : p->nodes;
  return path->rows + (size_t)number;
}

static void lay_path(const abbe_path_splats *p, const photon_path *path, const footprint *f,
                     float entry[3], splat_list *to) {
  const size_t first_row = row_of(p, path, path->interval_last);
  splat collected = {.weight = 0};
  trail t = {.owed_row = first_row};
  t.z = t.a = node_at(p, path->hit_first + (size_t)(path->interval_last - path->node_first), true,
                      sums_at(p, first_row, 0).index, (v2){0, 0});
  for (int turn = 0; turn <= path->intervals; turn++) {
    const int number = path->interval_last - turn, node_b = number - 1;
    const bool last = turn == path->intervals;
    const bool taken = !last && (path->refined >> (number > 0 ? number : 0) & 1u) == 0;
    const bool has_b = !last && node_b >= path->node_first && node_b <= path->node_last;
    const size_t hit_b = path->hit_first + (has_b ? (size_t)(node_b - path->node_first) : 0),
                 row = row_of(p, path, number);
    const path_node b = node_at(p, hit_b, has_b, sums_at(p, row, p->steps).index, t.a.at);
    const light_span s =
        span_of(p, &t, path, number, taken, has_b, hit_b, row, &b, (float)(1 << f->level));
    abbe_path_light_lay(p, &s, f, &collected, entry, to);
    t.owed_left = s.left;
    t.z = t.a;
    t.a = b;
  }
  if (collected.weight > 0) abbe_path_light_list(p, &collected, f, to);
}

size_t abbe_path_splats_most(const abbe_path_splats *p) {
  const int spans = p->sample_count > p->fine_nodes ? p->sample_count : p->fine_nodes;
  return (size_t)(spans + 2) * (size_t)(2 * p->steps);
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

SIDE_BY_SIDE __attribute__((flatten)) size_t
abbe_path_splats_list(const void *paths, size_t i, uint32_t *splats, int64_t entry[3]) {
  const abbe_path_splats *p = paths;
  photon_path path = path_at(p, p->paths[i]);
  fetch(p, p->paths[i + AHEAD < p->count ? i + AHEAD : i]);
  float own[3] = {0, 0, 0};
  splat_list to = {.word = splats};
  const reference r = reference_of(p, &path);
  if (path.signature == 0) return 0;
  const footprint f = footprint_of(p, path.photon, &r);
  path.rows = p->table_first +
              (p->light * p->refractors + (path.signature & 255u)) * (size_t)(p->nodes + 1);
  lay_path(p, &path, &f, own, &to);
  for (int k = 0; k < 3; k++) entry[k] += llrintf(own[k] / p->ledger_unit);
  return to.count;
}
