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
} reference;

/* Hits of paths, in the middle, and of the photons beside theirs: to the right, left, above and
 * below. per_apart: cells by which that is apart, inverted; 0: there is none. */
enum { BESIDE = 4 };
static const int beside[BESIDE][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
typedef struct path_company {
  lanes place[BESIDE + 1][3], x[BESIDE + 1], y[BESIDE + 1], per_apart[BESIDE], extent[2];
  int32_t tile[LANES];
} path_company;

/* The photon of a cell beside a photon's, from 1; 0: there is none. */
static uint32_t slot_beside(const abbe_path_splats *p, const abbe_photon *photon, int i) {
  const int x = (int)(photon->cell & 0xffffu) + beside[i][0],
            y = (int)(photon->cell >> 16) + beside[i][1];
  const bool there = x >= 0 && y >= 0 && x < p->grid[0] && y < p->grid[1];
  return there ? p->photon_of_cell[y * p->grid[0] + x] : 0;
}

static void find_company(const abbe_path_splats *p, const abbe_photon *photon, const reference *r,
                         size_t own, int k, path_company *to) {
  const float *at = p->hits[2 * own];
  for (int j = 0; j < 3; j++) to->place[BESIDE][j][k] = at[j];
  to->tile[k] = r->tile;
  to->extent[0][k] = (float)(photon->extent & 0xffffu) / 65535.0f;
  to->extent[1][k] = (float)(photon->extent >> 16) / 65535.0f;
  for (int i = 0; i < BESIDE; i++) {
    const uint32_t slot = r->signature != 0 ? slot_beside(p, photon, i) : 0;
    const size_t other =
        slot == 0 ? own : ((size_t)(slot - 1) * p->slots + r->order) * p->stride + r->sample;
    const bool there = slot != 0 && signature_at(p, p->signatures, other) == r->signature;
    const uint32_t offset = there ? p->photons[slot - 1].offset : photon->offset;
    const float x = (float)beside[i][0], y = (float)beside[i][1];
    const float along_x = x + snorm_of(offset, 0) - snorm_of(photon->offset, 0);
    const float along_y = y + snorm_of(offset, 1) - snorm_of(photon->offset, 1);
    to->per_apart[i][k] = there ? 1 / most(along_x * x + along_y * y, 0.25f) : 0;
    for (int j = 0; j < 3; j++) to->place[i][j][k] = p->hits[2 * (there ? other : own)][j];
  }
}

static void place_company(const abbe_path_splats *p, path_company *c) {
  for (int i = 0; i <= BESIDE; i++) {
    EACH_LANE {
      const v3 place = {c->place[i][0][k], c->place[i][1][k], c->place[i][2][k]};
      const v2 at = place_on_map(p, place);
      c->x[i][k] = at.x;
      c->y[i][k] = at.y;
    }
    for (int k = 0; k < LANES; k++) {
      if (c->tile[k] < 0) continue;
      const v3 place = {c->place[i][0][k], c->place[i][1][k], c->place[i][2][k]};
      const v2 at = place_on_tile(p->tile[c->tile[k]], place);
      c->x[i][k] = at.x;
      c->y[i][k] = at.y;
    }
  }
}

/* Half of what lies between the steps to both sides, or the only one; skew: half of their sum. */
static inline v2 image_of_side(v2 to_next, v2 to_last, v2 *skew) {
  const float next = fabsf(to_next.x) + fabsf(to_next.y),
              last = fabsf(to_last.x) + fabsf(to_last.y);
  const bool both = least(next, last) > 0;
  const float skews = both ? 0.5f : 0, share = both ? 0.5f : 1;
  *skew = (v2){skews * (to_next.x + to_last.x), skews * (to_next.y + to_last.y)};
  return times2(share, off2(to_next, to_last));
}

static inline v2 step_to(const path_company *c, int i, int k) {
  return times2(c->per_apart[i][k],
                (v2){c->x[i][k] - c->x[BESIDE][k], c->y[i][k] - c->y[BESIDE][k]});
}

typedef struct lane_footprints {
  lanes across[2], skew[2], wide, narrow;
} lane_footprints;

static void spread(const path_company *c, lane_footprints *to) {
  lanes sides[2][2], skews[2][2];
  for (int i = 0; i < 2; i++) {
    EACH_LANE {
      v2 sum;
      const v2 image = image_of_side(step_to(c, 2 * i, k), step_to(c, 2 * i + 1, k), &sum);
      sides[i][0][k] = c->extent[i][k] * image.x;
      sides[i][1][k] = c->extent[i][k] * image.y;
      skews[i][0][k] = c->extent[i][k] * sum.x;
      skews[i][1][k] = c->extent[i][k] * sum.y;
    }
  }
  EACH_LANE {
    const v2 a = {sides[0][0][k], sides[0][1][k]}, b = {sides[1][0][k], sides[1][1][k]};
    const v2 skew_a = {skews[0][0][k], skews[0][1][k]}, skew_b = {skews[1][0][k], skews[1][1][k]};
    const float xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
    const float half_trace = 0.5f * (xx + yy), root = length2((v2){0.5f * (xx - yy), xy});
    const float widest = sqrtf(half_trace + root), narrowest = sqrtf(most(half_trace - root, 0));
    const bool along = xx > yy, by_a = dot2(a, a) > dot2(b, b);
    const float by_x = 0.5f * (xx - yy) + root, by_y = 0.5f * (yy - xx) + root;
    const v2 side = {by_a ? a.x : b.x, by_a ? a.y : b.y};
    const v2 skew = {by_a ? skew_a.x : skew_b.x, by_a ? skew_a.y : skew_b.y};
    const bool round = narrowest > 0.6f * widest;
    const float side_m = most(length2(side), 1e-20f);
    const float axis_x = along ? by_x : xy, axis_y = along ? xy : by_y;
    const v2 axis = {round ? side.x : axis_x, round ? side.y : axis_y};
    const float wide = round ? side_m : widest, area = widest * narrowest;
    const v2 across = times2(wide / most(length2(axis), 1e-20f), axis);
    const float turn = dot2(across, side) < 0 ? -1 : 1;
    const float shorter = least(1, wide / most(length2(skew), 1e-20f));
    to->across[0][k] = turn * across.x;
    to->across[1][k] = turn * across.y;
    to->skew[0][k] = shorter * skew.x;
    to->skew[1][k] = shorter * skew.y;
    to->wide[k] = wide;
    to->narrow[k] = round ? area / wide : narrowest;
  }
}

/* A level of the map for what is so wide. */
static void choose_level(const abbe_path_splats *p, float wide, footprint *f) {
  const float narrowest = most(most(f->narrow, wide / MAX_ACROSS), 0.5f);
  const float fine = most(log2f(narrowest) + 1.25f, 0),
              whole = least(floorf(fine), (float)(p->map_levels - 1));
  f->level = (int)whole;
  f->to_next = f->level > 0 && f->level + 1 < p->map_levels ? clamp(fine - whole, 0, 1) : 0;
}

static footprint footprint_of(const abbe_path_splats *p, const lane_footprints *of, int k) {
  footprint f = {.narrow = of->narrow[k]};
  const float wide = of->wide[k];
  choose_level(p, wide, &f);
  const float scale = least(wide, 2 * (float)(1 << f.level) * MAX_ACROSS) / most(wide, 1e-20f);
  f.across = times2(scale, (v2){of->across[0][k], of->across[1][k]});
  f.skew = times2(scale, (v2){of->skew[0][k], of->skew[1][k]});
  return f;
}

/* photon_deposit.comp */
static photon_path path_at(const abbe_path_splats *p, uint32_t listed) {
  const uint32_t slots = (uint32_t)p->slots;
  const size_t item = listed / slots;
  photon_path out = {.order = listed % slots};
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
  r.tile = interface_tile(p->hits[2 * (path->coarse_first + r.sample) + 1][3]);
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
  const photon_path path = path_at(p, listed);
  for (int i = 0; i < BESIDE; i++) {
    const uint32_t slot = slot_beside(p, path.photon, i);
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
  path_company company;
  lane_footprints footprints;
  float own[3][LANES] = {{0}};
  splat_list to = {.splat = splats};
  for (size_t k = 0; k < LANES; k++) {
    const size_t i = first + k < p->count ? first + k : p->count - 1;
    fetch(p, p->paths[i + 2 * AHEAD < p->count ? i + 2 * AHEAD : i]);
    fetch_beside(p, p->paths[i + AHEAD < p->count ? i + AHEAD : i]);
    path[k] = path_at(p, p->paths[i]);
    const reference r = reference_of(p, &path[k]);
    find_company(p, path[k].photon, &r, path[k].coarse_first + r.sample, (int)k, &company);
    path[k].rows = p->table_first +
                   (p->light * p->refractors + (path[k].signature & 255u)) * (size_t)(p->nodes + 1);
    if (first + k >= p->count) path[k].signature = 0;
  }
  place_company(p, &company);
  spread(&company, &footprints);
  for (int k = 0; k < LANES; k++) path[k].footprint = footprint_of(p, &footprints, k);
  lay_paths(p, path, own, &to);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < LANES; k++) entry[i] += llrintf(own[i][k] / p->ledger_unit);
  return to.count;
}
