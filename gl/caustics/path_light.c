#include "gl/caustics/path_light.h"

#include "base/maths.h"

#define ALL_INLINE static inline __attribute__((always_inline))

static void rect_of(const abbe_path_splats *p, int tile, float rect[4]) {
  const float side = (float)p->map_size, map[4] = {0, 0, side, side};
  memcpy(rect, tile == NO_TILE ? map : p->tile[tile] + 8, sizeof map);
}

/* As the device lists them (splat_list.glsl): to the 11 bits of a half, and of a place to 15 bits
 * below a texel. */
static inline float half(float x) {
  const float wide = x * 8193;
  return wide - (wide - x);
}

static inline float fixed(float x) {
  return (float)(int32_t)(x * 32768) / 32768;
}

void abbe_path_light_list(const abbe_path_splats *p, const photon_path *path, splat_list *to) {
  const splat_collect *s = &path->collected;
  const footprint *f = &path->footprint;
  abbe_splat *out = to->splat + to->count;
  float rect[4];
  rect_of(p, s->tile, rect);
  const float x = clamp(s->from.x + s->middle.x, rect[0], rect[2] - 0.01f),
              y = clamp(s->from.y + s->middle.y, rect[1], rect[3] - 0.01f);
  *out = (abbe_splat){.centre = {fixed(x), fixed(y)},
                      .across = {half(f->across.x), half(f->across.y)},
                      .shift = {half(s->shift.x), half(s->shift.y)},
                      .skew = {half(f->skew.x), half(f->skew.y)},
                      .narrow = half(f->narrow),
                      .to_next = half(f->to_next),
                      .level = f->level,
                      .tile = s->tile + 1};
  for (int c = 0; c < 3; c++) {
    out->units[c] = (uint32_t)least(s->flux[c] / p->unit + 0.5f, 2147483520.0f);
    const float per = 1 / most(s->flux[c], 1e-30f);
    out->off[c][0] = half(s->x[c] * per - s->middle.x);
    out->off[c][1] = half(s->y[c] * per - s->middle.y);
  }
  to->count += (out->units[0] | out->units[1] | out->units[2]) != 0;
}

/* Light of parts side by side: what they are given, and what that comes to. */
typedef struct part_lights {
  /* Up to where each goes; the first is where they begin. */
  float sums[SUM_ROWS][PART_LANES], end_x[PART_LANES], end_y[PART_LANES];
  /* flux: 0 where it does not land; lies: where X, Y and Z do. */
  float flux[3][PART_LANES], lies[3][2][PART_LANES], x[PART_LANES], y[PART_LANES];
  float shift_x[PART_LANES], shift_y[PART_LANES], entry[3][LANES];
} part_lights;

/* The parts of a span, or one of each span. */
typedef struct part_range {
  int span, stride; /* 0: all are of that span; 1: they are of it and those behind it */
  int count, tile;  /* parts and their tile */
  bool owed;
  const int32_t *here;                                   /* of one of each span: whether it is */
  const float (*before)[PART_LANES], *begin_x, *begin_y; /* where parts begin */
} part_range;

static void collect(const abbe_path_splats *p, const part_lights *l, int i, int tile,
                    photon_path *path, splat_list *to) {
  splat_collect *s = &path->collected;
  const float flux[3] = {l->flux[0][i], l->flux[1][i], l->flux[2][i]};
  const float weight = flux[0] + flux[1] + flux[2];
  if (!(weight > 0)) return;
  const v2 at = {l->x[i], l->y[i]}, shift = {l->shift_x[i], l->shift_y[i]};
  const v2 apart = off2(at, s->from);
  const bool elsewhere = tile != s->tile || most(fabsf(apart.x), fabsf(apart.y)) >
                                                0.75f * (float)(1 << path->footprint.level);
  if (s->weight > 0 && elsewhere) {
    abbe_path_light_list(p, path, to);
    s->weight = 0;
  }
  if (s->weight == 0) *s = (splat_collect){.from = at, .tile = tile};
  for (int c = 0; c < 3; c++) {
    s->flux[c] += flux[c];
    s->x[c] += flux[c] * (l->lies[c][0][i] - s->from.x);
    s->y[c] += flux[c] * (l->lies[c][1][i] - s->from.y);
  }
  s->shift = (v2){s->shift.x + shift.x, s->shift.y + shift.y};
  if (s->weight > 0) s->middle = (v2){s->middle.x + 0.5f * shift.x, s->middle.y + 0.5f * shift.y};
  s->weight += weight;
}

/* span_light.glsl */
static inline v3 place_between(const path_spans *s, int k, float t) {
  const v3 a = vector_of(s->from, k), b = vector_of(s->to, k), straight = mix3(a, b, t);
  const v3 from = mix3(vector_of(s->from + SEGMENT_FROM, k), vector_of(s->to + SEGMENT_FROM, k), t);
  const v3 mean = mix3(vector_of(s->from + SEGMENT_N, k), vector_of(s->to + SEGMENT_N, k), t);
  const v3 along = along_between(s, k, t), facing = vector_of(s->facing, k);
  const float cosine = sqrtf(most(1 - dot(along, along), 0) / dot(mean, mean));
  const v3 d = plus(along, times(cosine, mean));
  const float faces = dot(facing, d), reach = dot(facing, off(a, from)) / faces;
  const bool bends = s->bends[k] & (faces > 0);
  return (v3){bends ? from.x + reach * d.x : straight.x, bends ? from.y + reach * d.y : straight.y,
              bends ? from.z + reach * d.z : straight.z};
}

/* Where LANES parts from `at` on end: where they begin, if their span does not say. */
ALL_INLINE void end_parts(const abbe_path_splats *p, const path_spans *s, const part_range *r,
                          int at, part_lights *l) {
  lanes x, y, z;
  if (r->stride == 0 && !(s->follows[r->span] && (s->bridges[r->span] || !r->owed))) {
    EACH_LANE {
      l->end_x[at + k + 1] = r->begin_x[0];
      l->end_y[at + k + 1] = r->begin_y[0];
    }
    return;
  }
  EACH_LANE {
    const int of = r->span + r->stride * k;
    const float index = l->sums[SUM_INDEX][at + k + 1];
    const v3 to = place_between(s, of, (index - s->from_index[of]) * s->per_index[of]);
    x[k] = to.x;
    y[k] = to.y;
    z[k] = to.z;
  }
  const float *rows = p->tile[r->tile < 0 ? 0 : r->tile];
  if (r->tile >= 0) {
    EACH_LANE {
      const v2 to = place_on_tile(rows, (v3){x[k], y[k], z[k]});
      l->end_x[at + k + 1] = to.x;
      l->end_y[at + k + 1] = to.y;
    }
  } else {
    EACH_LANE {
      const v2 to = place_on_map(p, (v3){x[k], y[k], z[k]});
      const bool follows = r->stride == 0 || s->follows[r->span + k] != 0;
      const float begin_x = r->begin_x[at + k], begin_y = r->begin_y[at + k];
      l->end_x[at + k + 1] = follows ? to.x : begin_x;
      l->end_y[at + k + 1] = follows ? to.y : begin_y;
    }
  }
}

typedef struct light_part {
  lanes xyz[3], middles[3], middle, index, along, left[3];
} light_part;

ALL_INLINE void part_of(const path_spans *s, const part_range *r, int at, const part_lights *l,
                        light_part *part) {
  const path_nodes *first = r->owed ? s->z : s->a, *second = r->owed ? s->a : s->b;
  EACH_LANE {
    const int of = r->span + r->stride * k, i = at + k;
    const float before = r->before[SUM_ALONG][i], upto = l->sums[SUM_ALONG][i + 1];
    const float low = least(before, upto), high = most(before, upto);
    float all = 0, sum = 0;
    for (int c = 0; c < 3; c++) {
      const float xyz = fabsf(l->sums[c][i + 1] - r->before[c][i]);
      const float moment = fabsf(l->sums[3 + c][i + 1] - r->before[3 + c][i]);
      const float middle = clamp(moment / most(xyz, 1e-20f), low, high);
      part->xyz[c][k] = xyz;
      part->middles[c][k] = middle;
      part->left[c][k] = 1;
      all += xyz;
      sum += middle * xyz;
    }
    const float middle = sum / most(all, 1e-20f);
    const float index = mix(first->index[of], second->index[of], middle);
    part->middle[k] = middle;
    part->index[k] = index;
    part->along[k] = (index - s->from_index[of]) * s->per_index[of];
  }
}

ALL_INLINE void left_of(const abbe_path_splats *p, const path_spans *s, const part_range *r, int at,
                        const part_lights *l, light_part *part) {
  const path_nodes *a = s->a, *b = s->b;
  lanes depth[3] = {{0}};
  for (size_t j = 0; j < p->tint_count; j++) EACH_LANE {
      const int of = r->span + r->stride * k, i = at + k;
      const bool mixes = s->bridges[of] & (a->of[j][of] == b->of[j][of]);
      const float amount =
          mix(a->amount[j][of], b->amount[j][of], mixes ? clamp(part->along[k], 0, 1) : 0);
      for (int c = 0; c < 3; c++) {
        const size_t row = SUM_TAKEN + 3 * j + (size_t)c;
        depth[c][k] += amount * fabsf(l->sums[row][i + 1] - r->before[row][i]);
      }
    }
  for (int c = 0; c < 3; c++)
    EACH_LANE part->left[c][k] = exponential(-depth[c][k] / most(part->xyz[c][k], 1e-30f));
}

/* What leaves parts' interface and lands, and what the ledger is to know of it: as entry_of()
 * there, of what the nodes say of the light. */
ALL_INLINE void light_of(const abbe_path_splats *p, const path_spans *s, const part_range *r,
                         int at, const light_part *part, part_lights *l) {
  float rect[4];
  rect_of(p, r->tile, rect);
  const span_lights *lights = r->owed ? &s->owing : &s->own;
  EACH_LANE {
    const int of = r->span + r->stride * k, i = at + k;
    const v3 along = along_between(s, of, part->along[k]);
    const float through = transmission(true, sqrtf(most(1 - dot(along, along), 0)), part->index[k]);
    const float passes = lights->passes[of] + lights->through[of] * through;
    const float begin_x = r->begin_x[i], begin_y = r->begin_y[i], end_x = l->end_x[i + 1],
                end_y = l->end_y[i + 1];
    const float x = 0.5f * (begin_x + end_x), y = 0.5f * (begin_y + end_y);
    const float shift_x = end_x - begin_x, shift_y = end_y - begin_y;
    const bool lands = ((part->along[k] >= 0) & (part->along[k] <= 1)) |
                       ((x >= rect[0]) & (y >= rect[1]) & (x < rect[2]) & (y < rect[3]));
    const float began = r->before[SUM_ALONG][i], length = l->sums[SUM_ALONG][i + 1] - began;
    float flux_y = 0;
    for (int c = 0; c < 3; c++) {
      const float m = part->middles[c][k], arrives = lights->arrives[of] +
                                                     m * lights->arrives_more[of] +
                                                     m * (m - 1) * lights->curve[of];
      const float lies = (m - began) / (length == 0 ? 1 : length) - 0.5f;
      const float leaves =
          most((passes + (m - part->middle[k]) * lights->passes_more[of]) * arrives, 0);
      const float flux = leaves * part->xyz[c][k], kept_flux = flux * part->left[c][k];
      l->flux[c][i] = lands ? kept_flux : 0;
      flux_y = c == 1 ? flux : flux_y;
      l->lies[c][0][i] = x + lies * shift_x;
      l->lies[c][1][i] = y + lies * shift_y;
    }
    l->x[i] = x;
    l->y[i] = y;
    l->shift_x[i] = shift_x;
    l->shift_y[i] = shift_y;
    const float first_half =
        least(l->sums[1][i + 1], s->half_y[of]) - least(r->before[1][i], s->half_y[of]);
    const float share_a = r->owed ? part->xyz[1][k] : first_half;
    const float by_a = s->a->flux[of] * share_a,
                by_b = lights->flux_b[of] * (part->xyz[1][k] - share_a);
    const float kept = by_a * lights->left_a[of] + by_b * s->b->left_above[of];
    const float said = by_a + by_b, left_said = said > 0 ? kept / said : 1;
    const float left = part->left[1][k];
    const bool here = r->stride > 0 ? r->here[k] : i < r->count;
    l->entry[0][k] += here ? flux_y * left_said - kept : 0;
    l->entry[1][k] += here ? flux_y * (left_said - left) : 0;
    l->entry[2][k] += (here & !lands) ? flux_y * left : 0;
  }
}

/* Lays what is in *r; stride and owed are constants where it is called. */
ALL_INLINE void lay_parts(const abbe_path_splats *p, const path_spans *s, part_range r,
                          part_lights *l) {
  light_part part;
  for (int at = 0; at < r.count; at += LANES) end_parts(p, s, &r, at, l);
  for (int at = 0; at < r.count; at += LANES) {
    part_of(s, &r, at, l, &part);
    if (p->tint_count > 0) left_of(p, s, &r, at, l, &part);
    light_of(p, s, &r, at, &part, l);
  }
}

/* The sums up to a step of a row, as part number i's. */
static void read_sums(const abbe_path_splats *p, const path_spans *s, int span, size_t row,
                      int step, int i, part_lights *l) {
  const float(*t)[4] = texel_at(p, row, step);
  for (int c = 0; c < 3; c++) {
    l->sums[c][i] = t[0][c];
    l->sums[3 + c][i] = t[1][c];
  }
  l->sums[SUM_ALONG][i] = t[0][3];
  l->sums[SUM_INDEX][i] = t[1][3];
  for (size_t j = 0; j < p->tint_count; j++) {
    const size_t own = row + (size_t)s->a->of[j][span] * (size_t)(p->nodes + 1) -
                       (size_t)s->first[span] * (size_t)(p->nodes + 1);
    for (size_t c = 0; c < 3; c++) l->sums[SUM_TAKEN + 3 * j + c][i] = texel_at(p, own, step)[2][c];
  }
}

static int last_step(const abbe_path_splats *p, const path_spans *s, int span, bool owed, int k) {
  const int step = owed ? p->steps - (k + 1) * (p->steps / 2) / s->owed[span]
                        : (k + 1) * s->steps[span] / s->parts[span];
  return step < p->steps ? step : p->steps;
}

/* The parts of one span, those that it owes or its own. */
ALL_INLINE void lay_span(const abbe_path_splats *p, const path_spans *s, int span, bool owed,
                         part_lights *l) {
  const size_t row = owed ? s->owed_row[span] : s->row[span];
  const int count = owed ? s->owed[span] : s->parts[span];
  if (owed) read_sums(p, s, span, row, p->steps, 0, l);
  /* A row's first step has nothing before it. */
  for (int i = 0; i < SUM_ROWS && !owed; i++) l->sums[i][0] = 0;
  for (int k = 0; k < count; k++)
    read_sums(p, s, span, row, last_step(p, s, span, owed, k), k + 1, l);
  l->end_x[0] = s->a->x[span];
  l->end_y[0] = s->a->y[span];
  lay_parts(p, s,
            (part_range){.span = span,
                         .count = count,
                         .tile = s->a->tile[span],
                         .owed = owed,
                         .before = (const float(*)[PART_LANES])l->sums,
                         .begin_x = l->end_x,
                         .begin_y = l->end_y},
            l);
}

/* Spans of one part each. */
ALL_INLINE void lay_singles(const abbe_path_splats *p, const path_spans *s, const int32_t *single,
                            part_lights *l) {
  static const float none[SUM_ROWS][PART_LANES];
  for (int k = 0; k < LANES; k++)
    if (single[k]) read_sums(p, s, k, s->row[k], s->steps[k], k + 1, l);
  lay_parts(p, s,
            (part_range){.stride = 1,
                         .count = LANES,
                         .tile = NO_TILE,
                         .here = single,
                         .before = none,
                         .begin_x = s->a->x,
                         .begin_y = s->a->y},
            l);
}

/* Lays the parts that a span owes or its own. */
ALL_INLINE void lay_many(const abbe_path_splats *p, const path_spans *s, int span, bool owed,
                         part_lights *l, photon_path *path, float entry[3][LANES], splat_list *to) {
  memset(l->entry, 0, sizeof l->entry);
  lay_span(p, s, span, owed, l);
  const int count = owed ? s->owed[span] : s->parts[span];
  for (int i = 0; i < count; i++) collect(p, l, i, s->a->tile[span], path, to);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < LANES; k++) entry[i][span] += l->entry[i][k];
}

SIDE_BY_SIDE __attribute__((flatten)) void
abbe_path_light_lay(const abbe_path_splats *p, const path_spans *s, photon_path *paths,
                    float entry[3][LANES], splat_list *to) {
  part_lights l;
  int32_t single[LANES];
  int some = 0;
  for (int k = 0; k < LANES; k++)
    some += single[k] = s->parts[k] == 1 && s->owed[k] == 0 && s->a->tile[k] < 0;
  if (some > 0) {
    memcpy(l.entry, entry, sizeof l.entry);
    lay_singles(p, s, single, &l);
    memcpy(entry, l.entry, sizeof l.entry);
    for (int k = 0; k < LANES; k++)
      if (single[k]) collect(p, &l, k, NO_TILE, &paths[k], to);
  }
  for (int k = 0; k < LANES; k++) {
    if (s->owed[k] > 0) lay_many(p, s, k, true, &l, &paths[k], entry, to);
    if (s->parts[k] > 0 && !single[k]) lay_many(p, s, k, false, &l, &paths[k], entry, to);
  }
}
