#include "gl/caustics/path_light.h"

#include "base/maths.h"

#define SEGMENT 2.0f
#define EVEN 0.25f
#define LEAST_LOG 9.210340f /* -log(1e-4), of the least that is left of light that is divided */
enum { MOST_PARTS = 16, HIT_ROWS = 8 };

/* Hits as they are read. */
typedef struct path_hits {
  lanes row[HIT_ROWS];
} path_hits;

static inline v3 interface_normal(uint32_t bits) {
  const float x = (float)(int32_t)(bits >> 11 & 2047u) / 2046.0f * 2 - 1,
              y = (float)(int32_t)(bits & 2047u) / 2046.0f * 2 - 1, z = 1 - fabsf(x) - fabsf(y);
  const v3 n = {x, y, bits >> 31 != 0 ? -z : z};
  return times(1 / length(n), n);
}

static size_t row_of(const abbe_path_splats *p, const photon_path *path, int interval) {
  const int number = interval < 0 ? 0 : interval < p->nodes ? interval : p->nodes;
  return path->rows + (size_t)number;
}

/* path_node.glsl */
static void read_hits(const abbe_path_splats *p, const photon_path *paths, int turn, path_hits *raw,
                      path_nodes *to) {
  for (int k = 0; k < LANES; k++) {
    const photon_path *path = &paths[k];
    const int number = path->interval_last - turn;
    const bool there = path->signature != 0 &&
                       (turn == 0 || (number >= path->node_first && number <= path->node_last &&
                                      turn <= path->intervals));
    const size_t at = path->hit_first + (there ? (size_t)(number - path->node_first) : 0);
    const uint32_t *word = p->node_signatures + at * p->signature_words;
    const bool hits = there && word[0] != 0;
    to->path[k] = hits ? word[0] : 0;
    to->index[k] = turn == 0 ? texel_at(p, row_of(p, path, number), 0)[1][3]
                             : texel_at(p, row_of(p, path, number + 1), p->steps)[1][3];
    for (int i = 0; i < HIT_ROWS; i++)
      raw->row[i][k] = hits ? p->node_hits[2 * at + (size_t)i / 4][i % 4] : 0;
    to->tile[k] = hits ? interface_tile(raw->row[7][k]) : NO_TILE;
    to->transmits[k] = (bits_of(raw->row[7][k]) >> 23 & 255u) > TILE_BITS ? 1 : 0;
    for (size_t i = 0; i < p->tint_count; i++) {
      const uint32_t bits = hits ? (word[i + 1] & ~255u) >> 1 : 0;
      to->of[i][k] = hits ? word[i + 1] & 255u : path->signature & 255u;
      memcpy(&to->amount[i][k], &bits, sizeof bits);
    }
  }
}

static inline void store(v3 v, lanes *to, int k) {
  to[0][k] = v.x;
  to[1][k] = v.y;
  to[2][k] = v.z;
}

static void place_segments(const abbe_path_splats *p, const path_hits *raw, path_nodes *to) {
  EACH_LANE {
    const v3 place = {raw->row[0][k], raw->row[1][k], raw->row[2][k]};
    const v3 from = {raw->row[4][k], raw->row[5][k], raw->row[6][k]};
    const v3 n = interface_normal(bits_of(raw->row[7][k])), outward = off(place, from);
    const float length_m = length(outward);
    const bool far = length_m > 1e-4f * (length(place) + length(from));
    const float through = to->transmits[k], transmits = far ? through : 0;
    const v3 d = times(1 / most(length_m, 1e-30f), outward);
    const float cosine = dot(d, n), passes = transmission(true, cosine, to->index[k]);
    const v3 along = off(d, times(cosine, n));
    store(place, to->segment + SEGMENT_PLACE, k);
    store(from, to->segment + SEGMENT_FROM, k);
    store(along, to->segment + SEGMENT_ALONG, k);
    store(n, to->segment + SEGMENT_N, k);
    to->far[k] = far;
    to->transmits[k] = transmits;
    to->passes[k] = most(transmits > 0 ? passes : 1, 1e-6f);
    to->flux[k] = raw->row[3][k];
    to->arrives[k] = raw->row[3][k] / to->passes[k];
    to->left_below[k] = to->left_above[k] = 1;
    to->range_below[k] = to->range_above[k] = 0;
    const v2 at = place_on_map(p, place);
    to->x[k] = at.x;
    to->y[k] = at.y;
  }
  for (int k = 0; k < LANES; k++) {
    if (to->tile[k] < 0) continue;
    const v3 place = {raw->row[0][k], raw->row[1][k], raw->row[2][k]};
    const v2 at = place_on_tile(p->tile[to->tile[k]], place);
    to->x[k] = at.x;
    to->y[k] = at.y;
  }
}

/* The depths of both parts of both halves of nodes' bands, and by how much they range at the most.
 */
static void attenuate(const abbe_path_splats *p, const photon_path *paths, int turn,
                      path_nodes *to) {
  lanes depth[4] = {{0}}, range = {0};
  for (int k = 0; k < LANES; k++) {
    const int number = paths[k].interval_last - turn, last = p->nodes - 1;
    const int node = number < 0 ? 0 : number > last ? last : number;
    for (size_t i = 0; i < p->tint_count; i++) {
      const float(*t)[4] = p->tints + 2 * ((size_t)node * p->refractors + (size_t)to->of[i][k]);
      for (int j = 0; j < 4; j++) depth[j][k] += to->amount[i][k] * t[0][j];
      range[k] += to->amount[i][k] * t[1][0];
    }
  }
  EACH_LANE {
    const bool lit = to->flux[k] > 0;
    const float below = least(depth[0][k], depth[1][k]), above = least(depth[2][k], depth[3][k]);
    to->left_below[k] = 0.5f * (exponential(-depth[0][k]) + exponential(-depth[1][k]));
    to->left_above[k] = 0.5f * (exponential(-depth[2][k]) + exponential(-depth[3][k]));
    to->range_below[k] = (lit & (below - range[k] < LEAST_LOG)) ? range[k] : 0;
    to->range_above[k] = (lit & (above - range[k] < LEAST_LOG)) ? range[k] : 0;
  }
}

SIDE_BY_SIDE __attribute__((flatten)) void abbe_path_nodes_read(const abbe_path_splats *p,
                                                                const photon_path *paths, int turn,
                                                                path_nodes *to) {
  path_hits raw;
  read_hits(p, paths, turn, &raw, to);
  place_segments(p, &raw, to);
  if (p->tint_count > 0) attenuate(p, paths, turn, to);
}

static inline int32_t parts_of(float moved, float size, int32_t least_parts, int32_t most_parts) {
  int32_t parts = 1;
  for (int i = 0; i < 7; i++) /* log2 of MOST_STEPS in spectral_tables.c */
    parts += (((float)parts * SEGMENT * size < moved) & (parts < most_parts)) ? parts : 0;
  parts = parts > least_parts ? parts : least_parts;
  return parts < most_parts ? parts : most_parts;
}

/* interval_span.glsl. Which of the spans go from node to node, along one path. */
static void follow_spans(const abbe_path_splats *p, const path_nodes *a, const path_nodes *b,
                         const path_nodes *c, path_trails *t, path_spans *s) {
  const bool bridges = p->bridges, doubts = p->doubts;
  const float far = (float)p->map_size / 16;
  EACH_LANE {
    const bool one = bridges & (a->path[k] != 0) & (a->path[k] == b->path[k]);
    const bool goes_on = (c->path[k] != 0) & (c->path[k] == b->path[k]);
    const v2 step = {b->x[k] - a->x[k], b->y[k] - a->y[k]};
    const v2 next = {c->x[k] - b->x[k], c->y[k] - b->y[k]};
    const v2 after = {goes_on ? next.x : 0, goes_on ? next.y : 0};
    const v2 before = {t->step[0][k], t->step[1][k]};
    const bool likewise =
        least(length2(off2(step, before)), length2(off2(step, after))) < 0.75f * length2(step);
    const float moved = most(fabsf(step.x), fabsf(step.y));
    const bool follows = one & ((moved < far) | !doubts | likewise);
    const int32_t taken = s->taken[k];
    s->bridges[k] = follows ? taken : 0;
    s->follows[k] = (follows | (t->followed[k] != 0)) ? taken : 0;
    s->followed[k] = t->followed[k];
    s->moved[k] = follows ? moved : t->moved[k];
    s->owes[k] = t->owes[k];
    t->step[0][k] = one ? step.x : 0;
    t->step[1][k] = one ? step.y : 0;
    t->moved[k] = moved;
    t->followed[k] = follows;
    t->owes[k] = (!follows & (b->path[k] != 0)) ? taken : 0;
  }
}

/* The line along which a span's light lies, from a node to the next. */
static void draw_lines(const path_nodes *z, const path_nodes *a, const path_nodes *b,
                       path_trails *t, path_spans *s) {
  const path_spans *of = s;
  for (int i = 0; i < SEGMENT_ROWS; i++) {
    EACH_LANE {
      const float at_z = z->segment[i][k], at_a = a->segment[i][k], at_b = b->segment[i][k];
      s->from[i][k] = s->bridges[k] ? at_a : at_z;
      s->to[i][k] = s->bridges[k] ? at_b : at_a;
    }
  }
  EACH_LANE {
    const bool bridges = s->bridges[k];
    const float index_z = z->index[k], index_a = a->index[k], index_b = b->index[k];
    const float transmits_a = a->transmits[k], transmits_b = b->transmits[k];
    const int32_t far_z = z->far[k], far_a = a->far[k], far_b = b->far[k];
    s->from_index[k] = bridges ? index_a : index_z;
    const float between = (bridges ? index_b : index_a) - s->from_index[k];
    s->per_index[k] = between != 0 ? 1 / between : 0;
    s->transmits[k] = bridges ? transmits_b : transmits_a;
    const v3 from = vector_of(of->from, k), to = vector_of(of->to, k), chord = off(to, from);
    const v3 by_a = off(from, vector_of(of->from + SEGMENT_FROM, k)),
             by_b = off(to, vector_of(of->to + SEGMENT_FROM, k));
    const v3 d = plus(times(1 / length(by_a), by_a), times(1 / length(by_b), by_b));
    const float across = dot(d, chord) / most(dot(chord, chord), 1e-30f);
    const v3 facing = off(d, times(across, chord));
    store(facing, s->facing, k);
    s->bends[k] = far_a & (bridges ? far_b : far_z) &
                  ((chord.x != 0) | (chord.y != 0) | (chord.z != 0)) &
                  (dot(facing, facing) > 1e-4f);
  }
  for (int i = 0; i < 4; i++) {
    const float *at_z = i < 3 ? z->segment[SEGMENT_ALONG + i] : z->arrives;
    const float *at_a = i < 3 ? a->segment[SEGMENT_ALONG + i] : a->arrives;
    const float *at_b = i < 3 ? b->segment[SEGMENT_ALONG + i] : b->arrives;
    EACH_LANE {
      const float back = (z->index[k] - a->index[k]) * s->per_index[k]; /* where z is, below 0 */
      const float bend = (at_z[k] - at_a[k] - back * (at_b[k] - at_a[k])) / (back * (back - 1));
      const float curve = ((s->followed[k] != 0) & (back < -0.05f)) ? bend : 0;
      const float before = t->curve[i][k];
      s->curve[i][k] = s->bridges[k] ? curve : before;
      t->curve[i][k] = s->curve[i][k];
    }
  }
}

/* How many parts, by how far the light moves and where the path ends. */
static void divide_spans(const abbe_path_splats *p, const lanes size, const path_nodes *a,
                         const path_nodes *b, path_trails *t, path_spans *s) {
  const int32_t steps = p->steps, half = p->steps / 2;
  EACH_LANE {
    const bool bridges = s->bridges[k], follows = s->follows[k];
    const float needed =
        clamp(2 * most(a->range_below[k], b->range_above[k]) / EVEN, 1, MOST_PARTS);
    int32_t least_parts = 1;
    for (int i = 0; i < 4; i++) least_parts += (float)least_parts < needed ? least_parts : 0;
    const float at = (b->index[k] - s->from_index[k]) * s->per_index[k];
    const v3 along = along_between(s, k, at);
    /* Where the interface reflects all before b, the path ends there, and not halfway. */
    const float transmits = s->transmits[k], turns = dot(along, along) >= 1 ? transmits : 0;
    const int32_t up_to = (follows & (turns > 0)) ? steps : half,
                  most_parts = bridges ? steps : up_to;
    const float moves = s->moved[k], moved = follows ? moves : 0, owed_moved = bridges ? moves : 0;
    const int32_t own = parts_of(moved, size[k], least_parts, most_parts);
    const int32_t owed = parts_of(owed_moved, size[k], t->left_parts[k], half);
    s->steps[k] = most_parts;
    s->parts[k] = ((s->taken[k] != 0) & (a->flux[k] > 0)) ? own : 0;
    s->owed[k] = s->owes[k] != 0 ? owed : 0;
    t->left_parts[k] = least_parts;
  }
}

/* Light that the spans' own parts have, or those that they owe, from node `first` to `second`. */
static void fill_lights(const path_nodes *first, const path_nodes *second, const path_nodes *a,
                        const path_nodes *b, const path_spans *s, bool owed, span_lights *to) {
  const lanes *left_a = owed ? &a->left_above : &a->left_below;
  const float own = owed ? 0 : 1;
  EACH_LANE {
    const float arrives_a = a->arrives[k], arrives_1 = first->arrives[k],
                arrives_2 = second->arrives[k], passes_a = a->passes[k];
    const float bridges = s->bridges[k] != 0 ? 1.0f : 0.0f, owned = most(bridges, own);
    const float follows = s->follows[k] != 0 ? owned : 0.0f, transmits = s->transmits[k];
    const float both = least(first->flux[k], second->flux[k]) > 0 ? 1.0f : 0.0f;
    to->arrives[k] = both > 0 ? arrives_1 : arrives_a;
    to->arrives_more[k] = both * (arrives_2 - arrives_1);
    to->curve[k] = own * bridges * s->curve[3][k];
    to->through[k] = follows * transmits;
    to->passes[k] = follows > 0 ? 1 - transmits : passes_a;
    to->passes_more[k] = follows * both * (second->passes[k] - first->passes[k]);
    to->flux_b[k] = bridges * b->flux[k];
    to->left_a[k] = (*left_a)[k];
  }
}

SIDE_BY_SIDE __attribute__((flatten)) void abbe_path_spans_make(const abbe_path_splats *p,
                                                                const photon_path *paths, int turn,
                                                                path_trails *t, path_spans *s) {
  const path_nodes *z = s->z, *a = s->a, *b = s->b;
  lanes size;
  for (int k = 0; k < LANES; k++) {
    const photon_path *path = &paths[k];
    const int number = path->interval_last - turn;
    const bool refined = path->refined != 0 && path->refined >> (number > 0 ? number : 0) & 1u;
    s->taken[k] = path->signature != 0 && turn < path->intervals && !refined;
    s->row[k] = row_of(p, path, number);
    s->owed_row[k] = row_of(p, path, number + 1);
    s->first[k] = path->signature & 255u;
    s->half_y[k] = texel_at(p, s->row[k], p->steps / 2)[0][1];
    size[k] = (float)(1 << path->footprint.level);
  }
  follow_spans(p, a, b, s->c, t, s);
  draw_lines(z, a, b, t, s);
  divide_spans(p, size, a, b, t, s);
  fill_lights(a, b, a, b, s, false, &s->own);
  fill_lights(z, a, a, b, s, true, &s->owing);
}
