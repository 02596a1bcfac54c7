#include "gl/caustics/path_light.h"

#include "base/maths.h"
#include "scenes/volume/half.h"

typedef struct glint {
  float flux[3], along[3];
  v2 at, shift;
} glint;

static uint32_t halves(float a, float b) {
  return abbe_half_of_float(a) | (uint32_t)abbe_half_of_float(b) << 16;
}

static void rect_of(const abbe_path_splats *p, int tile, float rect[4]) {
  const float side = (float)p->map_size, map[4] = {0, 0, side, side};
  memcpy(rect, tile == NO_TILE ? map : p->tile[tile] + 8, sizeof map);
}

static bool on_the_map(const abbe_path_splats *p, v2 at, int tile) {
  float rect[4];
  rect_of(p, tile, rect);
  return at.x >= rect[0] && at.y >= rect[1] && at.x < rect[2] && at.y < rect[3];
}

void abbe_path_light_list(const abbe_path_splats *p, const splat *s, const footprint *f,
                          splat_list *to) {
  uint32_t *word = to->word + ABBE_SPLAT_WORDS * to->count;
  const uint32_t number = (uint32_t)(s->tile + 1);
  float rect[4];
  rect_of(p, s->tile, rect);
  const float x = clamp(s->from.x + s->middle.x, rect[0], rect[2] - 0.01f),
              y = clamp(s->from.y + s->middle.y, rect[1], rect[3] - 0.01f);
  word[0] = (uint32_t)(x * 32768) << 5 | number >> 2;
  word[1] = (uint32_t)(y * 32768) << 5 | (number & 3u) << 3 | (uint32_t)f->level;
  word[2] = halves(f->across.x, f->across.y);
  for (int c = 0; c < 3; c++) {
    word[3 + c] = (uint32_t)least(s->flux[c] / p->unit + 0.5f, 4294967040.0f);
    const float per = 1 / most(s->flux[c], 1e-30f);
    word[6 + c] = halves(s->x[c] * per - s->middle.x, s->y[c] * per - s->middle.y);
  }
  word[9] = halves(s->shift.x, s->shift.y);
  word[10] = halves(f->skew.x, f->skew.y);
  word[11] = halves(f->narrow, f->to_next);
  to->count += (word[3] | word[4] | word[5]) != 0;
}

static void collect(const abbe_path_splats *p, const glint *g, int tile, bool lands,
                    const footprint *f, splat *s, splat_list *to) {
  const float weight = lands ? g->flux[0] + g->flux[1] + g->flux[2] : 0;
  if (!(weight > 0)) return;
  const v2 apart = off2(g->at, s->from);
  const bool elsewhere =
      tile != s->tile || most(fabsf(apart.x), fabsf(apart.y)) > 0.75f * (float)(1 << f->level);
  if (s->weight > 0 && elsewhere) {
    abbe_path_light_list(p, s, f, to);
    s->weight = 0;
  }
  if (s->weight == 0) *s = (splat){.from = g->at, .tile = tile};
  const v2 here = off2(g->at, s->from);
  for (int c = 0; c < 3; c++) {
    s->flux[c] += g->flux[c];
    s->x[c] += g->flux[c] * (here.x + g->along[c] * g->shift.x);
    s->y[c] += g->flux[c] * (here.y + g->along[c] * g->shift.y);
  }
  s->shift = (v2){s->shift.x + g->shift.x, s->shift.y + g->shift.y};
  if (s->weight > 0)
    s->middle = (v2){s->middle.x + 0.5f * g->shift.x, s->middle.y + 0.5f * g->shift.y};
  s->weight += weight;
}

/* span_light.glsl */
typedef struct light_front {
  light_sums sums;
  v2 at;
  float taken[ABBE_PATH_TINTS][3];
} light_front;

typedef struct light_part {
  bool owed;
  float xyz[3], middles[3], middle, index, along;
} light_part;

static light_part part_of(const light_span *s, bool owed, const light_sums *before,
                          const light_sums *upto) {
  light_part p = {.owed = owed};
  const float low = least(before->along, upto->along), high = most(before->along, upto->along);
  float all = 0, sum = 0;
  for (int c = 0; c < 3; c++) {
    p.xyz[c] = fabsf(upto->xyz[c] - before->xyz[c]);
    p.middles[c] =
        clamp(fabsf(upto->moment[c] - before->moment[c]) / most(p.xyz[c], 1e-20f), low, high);
    all += p.xyz[c];
    sum += p.middles[c] * p.xyz[c];
  }
  p.middle = sum / most(all, 1e-20f);
  const float row_index = owed ? s->z->index : s->a->index;
  p.index = row_index + p.middle * ((owed ? s->a->index : s->index_b) - row_index);
  p.along = (p.index - s->from->index) * s->per_index;
  return p;
}

/* What leaves the part's interface, before it is absorbed. */
static glint light_of(const abbe_path_splats *p, const light_span *s, const light_part *part,
                      const light_sums *upto, light_front *front) {
  const path_node *first = part->owed ? s->z : s->a, *second = part->owed ? s->a : s->b;
  const bool both = first->flux > 0 && second->flux > 0;
  const float from = both ? first->left.arrives : s->a->left.arrives,
              span = both ? second->left.arrives - first->left.arrives : 0;
  glint g = {.at = s->a->at};
  float passes = s->a->left.passes, passes_span = 0, curve = 0;
  if (s->follows && (s->bridges || !part->owed)) {
    const light_segment *a = &s->from->left, *b = &s->to->left;
    const v2 at = map_position(
        p, place_between(a, b, &s->fan, (upto->index - s->from->index) * s->per_index), s->a->tile);
    if (s->bridges && !part->owed) curve = s->curve[3];
    passes = transmission(b->transmits, cosine_between(a, b, &s->fan, part->along), part->index);
    passes_span = both ? second->left.passes - first->left.passes : 0;
    g.at = (v2){0.5f * (front->at.x + at.x), 0.5f * (front->at.y + at.y)};
    g.shift = off2(at, front->at);
    front->at = at;
  }
  const float length = upto->along - front->sums.along;
  for (int c = 0; c < 3; c++) {
    const float m = part->middles[c], arrives = from + m * span + m * (m - 1) * curve;
    g.flux[c] = most((passes + (m - part->middle) * passes_span) * arrives, 0) * part->xyz[c];
    g.along[c] = (m - front->sums.along) / (length == 0 ? 1 : length) - 0.5f;
  }
  return g;
}

static void taken_at(const abbe_path_splats *p, const light_span *s, size_t k, size_t row, int step,
                     float out[3]) {
  const size_t own = row + (size_t)s->a->of[k] * (size_t)(p->nodes + 1) -
                     (size_t)s->first * (size_t)(p->nodes + 1);
  memcpy(out, texel_at(p, own, step)[2], 3 * sizeof *out);
}

static void begin_front(const abbe_path_splats *p, const light_span *s, size_t row, int step,
                        light_front *f) {
  *f = (light_front){.at = s->a->at};
  if (step == 0) return; /* a row's first step has nothing before it */
  f->sums = sums_at(p, row, step);
  for (size_t k = 0; k < p->tint_count; k++) taken_at(p, s, k, row, step, f->taken[k]);
}

static void left_of(const abbe_path_splats *p, const light_span *s, const light_part *part,
                    size_t row, int step, light_front *front, float left[3]) {
  float depth[3] = {0, 0, 0};
  for (size_t k = 0; k < p->tint_count; k++) {
    const float t = s->bridges && s->a->of[k] == s->b->of[k] ? clamp(part->along, 0, 1) : 0;
    const float amount = mix(s->a->amount[k], s->b->amount[k], t);
    float upto[3];
    taken_at(p, s, k, row, step, upto);
    for (int c = 0; c < 3; c++) depth[c] += amount * fabsf(upto[c] - front->taken[k][c]);
    memcpy(front->taken[k], upto, sizeof upto);
  }
  for (int c = 0; c < 3; c++)
    left[c] = p->tint_count > 0 ? expf(-depth[c] / most(part->xyz[c], 1e-30f)) : 1;
}

/* What the ledger is to know of a part: as entry_of() there, of what the nodes say of its light. */
static void enter(const light_span *s, const light_part *part, const light_sums *before,
                  const light_sums *upto, float flux, float left, bool lands, float entry[3]) {
  const float first_half = least(upto->xyz[1], s->half_y) - least(before->xyz[1], s->half_y);
  const float share_a = part->owed ? part->xyz[1] : first_half;
  const float by_a = s->a->flux * share_a,
              by_b = s->bridges ? s->b->flux * (part->xyz[1] - share_a) : 0;
  const float said = by_a + by_b,
              kept = by_a * (part->owed ? s->owed_left.b : s->left.a) + by_b * s->left.b;
  const float left_said = said > 0 ? kept / said : 1;
  entry[0] += flux * left_said - kept;
  entry[1] += flux * (left_said - left);
  entry[2] += lands ? 0 : flux * left;
}

static int last_step(const abbe_path_splats *p, const light_span *s, int k) {
  const int step = k < s->owed ? p->steps - (k + 1) * (p->steps / 2) / s->owed
                               : (k + 1 - s->owed) * s->steps / (s->parts > 0 ? s->parts : 1);
  return step < p->steps ? step : p->steps;
}

SIDE_BY_SIDE __attribute__((flatten)) void abbe_path_light_lay(const abbe_path_splats *p,
                                                               const light_span *s,
                                                               const footprint *f, splat *collected,
                                                               float entry[3], splat_list *to) {
  light_front front;
  if (s->owed > 0) begin_front(p, s, s->owed_row, p->steps, &front);
  for (int k = 0; k < s->owed + s->parts; k++) {
    if (k == s->owed) begin_front(p, s, s->row, 0, &front);
    const bool owed = k < s->owed;
    const size_t row = owed ? s->owed_row : s->row;
    const int step = last_step(p, s, k);
    const light_sums upto = sums_at(p, row, step);
    const light_part part = part_of(s, owed, &front.sums, &upto);
    glint g = light_of(p, s, &part, &upto, &front);
    float left[3];
    left_of(p, s, &part, row, step, &front, left);
    const bool lands = (part.along >= 0 && part.along <= 1) || on_the_map(p, g.at, s->a->tile);
    enter(s, &part, &front.sums, &upto, g.flux[1], left[1], lands, entry);
    front.sums = upto;
    for (int c = 0; c < 3; c++) g.flux[c] *= left[c];
    collect(p, &g, s->a->tile, lands, f, collected, to);
  }
}
