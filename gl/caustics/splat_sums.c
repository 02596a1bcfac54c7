#include "gl/caustics/splat_sums.h"

#include "base/maths.h"
#include "gl/device/shader_maths.h"

#include <omp.h>
#include <stdlib.h>

/* The functions and numbers that are photon_splat.comp's have its names. */
#define LEAST_SIDE 0.25f
#define MOST_WIDE 0.84f
enum { MOST_IN_ROWS = 60, MOST_PARTS = 16 };

enum { PARTS = 64, MOST_THREADS = 4, TASK = 1 << 8, BLOCK = 1 << 13 };

/* Parts side by side, of one tile or of the map; places in texels of their level. */
typedef struct batch {
  const abbe_splat_sums *sums;
  uint32_t *word;
  int count;
  unsigned tile;
  float rect[4];
  __attribute__((aligned(64))) float x[PARTS];
  float y[PARTS], across[2][PARTS], beside[2][PARTS], per_area[PARTS];
  float off[3][2][PARTS]; /* where X, Y and Z lie */
  float per_size[PARTS];
  int32_t units[3][PARTS], side[PARTS], first[PARTS];
  /* Numbers of a part's least texel, and how many it is from there to its right and above. */
  int32_t texel[3][PARTS], right[3][PARTS], above[3][PARTS], share[3][4][PARTS];
} batch;

typedef struct splat {
  uint32_t units[3];
  float centre[2], across[2], shift[2], skew[2], beside[2], off[3][2], slope[3], next_share;
  float long_m, skew_m, beside_m; /* lengths */
  int level;
} splat;

typedef struct grid {
  int level, beside, across, along;
  float size;
} grid;

/* floor() of what an int holds, for many side by side. */
static inline int32_t whole_of(float x) {
  const int32_t toward_0 = (int32_t)x;
  return toward_0 - (x < (float)toward_0);
}

static float length_of(const float v[2]) {
  return sqrtf(v[0] * v[0] + v[1] * v[1]);
}

static splat splat_at(const abbe_splat *of, bool edges) {
  splat s = {.level = of->level};
  memcpy(s.units, of->units, sizeof s.units);
  memcpy(s.centre, of->centre, sizeof s.centre);
  memcpy(s.across, of->across, sizeof s.across);
  memcpy(s.shift, of->shift, sizeof s.shift);
  memcpy(s.skew, of->skew, sizeof s.skew);
  memcpy(s.off, of->off, sizeof s.off);
  s.long_m = length_of(s.across);
  s.skew_m = length_of(s.skew);
  const float per_m = of->narrow / most(s.long_m, 1e-20f);
  s.beside[0] = -s.across[1] * per_m;
  s.beside[1] = s.across[0] * per_m;
  s.beside_m = length_of(s.beside);
  s.next_share = clamp(2 * of->to_next - 1, 0, 1);
  if (!edges && of->to_next > 0) { /* over a whole level, and as coarse in the mean */
    s.level -= of->to_next < 0.25f ? 1 : 0;
    const float t = of->to_next < 0.25f ? of->to_next + 0.75f : of->to_next - 0.25f;
    s.next_share = t < 1 ? t * t * (3 - 2 * t) : 0;
  }
  const float shift_2 = most(s.shift[0] * s.shift[0] + s.shift[1] * s.shift[1], 1e-20f);
  for (int c = 0; c < 3; c++) {
    const float leads = s.off[c][0] * s.shift[0] + s.off[c][1] * s.shift[1];
    s.slope[c] = clamp(leads / shift_2, -1.0f / 6, 1.0f / 6);
  }
  return s;
}

static int in_rows(float parts) {
  return (int)ceilf(clamp(parts, 1, MOST_IN_ROWS));
}

static grid grid_of(int level, const splat *s, bool edges) {
  const float size = (float)(1 << level), narrow = most(s->beside_m / size, LEAST_SIDE);
  const bool turned = s->long_m > 0 && !edges;
  const float axis[2] = {turned ? fabsf(s->across[0]) / s->long_m : 1,
                         turned ? fabsf(s->across[1]) / s->long_m : 0};
  grid g = {.level = level, .size = size};
  g.beside = in_rows(edges ? narrow / MOST_WIDE : narrow * (axis[0] + axis[1]));
  float part = MOST_WIDE;
  if (!edges) {
    const float side = narrow / (float)g.beside;
    part = least((1 - side * axis[1]) / most(axis[0], 1e-3f),
                 (1 - side * axis[0]) / most(axis[1], 1e-3f));
  }
  g.across = in_rows((s->long_m + s->skew_m) / size / part);
  g.along = in_rows(most(fabsf(s->shift[0]), fabsf(s->shift[1])) / size - 0.25f);
  return g;
}

static int parts_of(const grid *g) {
  return g->beside * g->across * g->along;
}

/* A rectangle of a part, as halves of its sides; step: to its middle from a cell's. */
typedef struct shape {
  float across[2], beside[2], per_area;
} shape;

/* sign: of the side of the splat's middle, whose halves differ. */
static shape shape_of(const splat *s, const grid *g, float sign, bool edges) {
  float across[2], beside[2], shift[2], box[2];
  for (int k = 0; k < 2; k++) {
    across[k] = (s->across[k] + sign * s->skew[k]) / (float)g->across / g->size;
    beside[k] = s->beside[k] / (float)g->beside / g->size;
    shift[k] = s->shift[k] / (float)g->along / g->size;
    box[k] = clamp(fabsf(beside[k]) + fabsf(across[k]) + fabsf(shift[k]), LEAST_SIDE, 1);
    box[k] = most(box[k], fabsf(shift[k]));
  }
  if (edges)
    return (shape){.across = {0.5f * box[0], 0}, .beside = {0, 0.5f * box[1]}, .per_area = 1};
  const float wide = length_of(across);
  const float axis[2] = {wide > 0 ? across[0] / wide : 1, wide > 0 ? across[1] / wide : 0};
  float a = most(wide + fabsf(axis[0] * shift[0] + axis[1] * shift[1]), LEAST_SIDE);
  float b = most(length_of(beside) + fabsf(axis[0] * shift[1] - axis[1] * shift[0]), LEAST_SIDE);
  const float bound =
      most(a * fabsf(axis[0]) + b * fabsf(axis[1]), a * fabsf(axis[1]) + b * fabsf(axis[0]));
  a *= 0.5f * least(1, 1 / bound);
  b *= 0.5f * least(1, 1 / bound);
  return (shape){.across = {a * axis[0], a * axis[1]},
                 .beside = {-b * axis[1], b * axis[0]},
                 .per_area = 1 / (4 * a * b)};
}

/* The mean of what lies below 0 on a line from a to b. */
static inline float mean_below(float a, float b) {
  const float below_a = least(a, 0), below_b = least(b, 0);
  return 0.5f * (below_a + below_b) * (fabsf(below_a - below_b) + 1e-6f) / (fabsf(a - b) + 1e-6f);
}

/* What an edge of an area adds to how much of that lies below 0 in x, in y, and in both. */
static inline void below_edge(float ax, float ay, float bx, float by, float below[3]) {
  const float ya = least(ay, 0), yb = least(by, 0), rise = by - ay;
  const bool flat = fabsf(rise) < 1e-7f;
  const float run = bx - ax, slope = (flat ? 0 : run) / (flat ? 1 : rise);
  const float xa = ax + (ya - ay) * slope, xb = ax + (yb - ay) * slope;
  below[0] += rise * mean_below(ax, bx);
  below[1] += (yb - ya) * 0.5f * (xa + xb);
  below[2] += (yb - ya) * mean_below(xa, xb);
}

/* To where Y's middle has to lie for the texels to get what the part covers of them, and the lean
 * of that. */
SIDE_BY_SIDE static void place_rectangles(batch *b, float *lean) {
  const int count = b->count;
  for (int k = 0; k < count; k++) {
    const float corner_x = (float)whole_of(b->x[k] + 0.5f),
                corner_y = (float)whole_of(b->y[k] + 0.5f);
    const float x = b->x[k] - corner_x, y = b->y[k] - corner_y, per_area = b->per_area[k];
    const float px = b->across[0][k] + b->beside[0][k], py = b->across[1][k] + b->beside[1][k];
    const float mx = b->across[0][k] - b->beside[0][k], my = b->across[1][k] - b->beside[1][k];
    float below[3] = {0, 0, 0};
    below_edge(x - px, y - py, x + mx, y + my, below);
    below_edge(x + mx, y + my, x + px, y + py, below);
    below_edge(x + px, y + py, x - mx, y - my, below);
    below_edge(x - mx, y - my, x - px, y - py, below);
    const float below_x = clamp(below[0] * per_area, 0, 1),
                below_y = clamp(below[1] * per_area, 0, 1);
    b->x[k] = corner_x + 0.5f - below_x;
    b->y[k] = corner_y + 0.5f - below_y;
    lean[k] = clamp(below[2] * per_area, 0, 1) - below_x * below_y;
  }
}

/* The same of boxes, which have no lean. */
SIDE_BY_SIDE static void place_boxes(batch *b, float *lean) {
  const int count = b->count;
  for (int k = 0; k < count; k++) {
    const float corner_x = (float)whole_of(b->x[k] + 0.5f),
                corner_y = (float)whole_of(b->y[k] + 0.5f);
    const float x = b->x[k] - corner_x, y = b->y[k] - corner_y;
    b->x[k] = corner_x + 0.5f - clamp(0.5f - 0.5f * x / b->across[0][k], 0, 1);
    b->y[k] = corner_y + 0.5f - clamp(0.5f - 0.5f * y / b->beside[1][k], 0, 1);
    lean[k] = 0;
  }
}

/* What the four texels around X, Y or Z get, to the last unit. */
SIDE_BY_SIDE static void share_parts(batch *b, const float *lean, int c) {
  const int count = b->count;
  const bool tile = b->tile > 0;
  const float inner = tile ? 0.5f : 0, far = tile ? 0 : 1e30f;
  for (int k = 0; k < count; k++) {
    const float scale = b->per_size[k];
    const float left = b->rect[0] * scale, bottom = b->rect[1] * scale;
    const float right = b->rect[2] * scale, top = b->rect[3] * scale;
    float x = b->x[k] + b->off[c][0][k] - b->off[1][0][k];
    float y = b->y[k] + b->off[c][1][k] - b->off[1][1][k];
    /* What would lie beyond a tile's edge, where the receiver ends, is folded back. */
    x = least(most(x, 2 * left - x - far), most(2 * right - x + far, left));
    y = least(most(y, 2 * bottom - y - far), most(2 * top - y + far, bottom));
    x = clamp(x, left + inner, right - inner) - 0.5f;
    y = clamp(y, bottom + inner, top - inner) - 0.5f;
    const int32_t ix = whole_of(x), iy = whole_of(y), last = b->side[k] - 1;
    const float fx = x - (float)ix, fy = y - (float)iy, gx = 1 - fx, gy = 1 - fy;
    const int32_t lx = ix < 0 ? 0 : ix, ly = iy < 0 ? 0 : iy;
    b->right[c][k] = ((ix >= 0) & (ix < last)) ? 3 : 0;
    b->above[c][k] = ((iy >= 0) & (iy < last)) ? 3 * (last + 1) : 0;
    b->texel[c][k] = 3 * (b->first[k] + ly * (last + 1) + lx) + c;
    const float leans = clamp(lean[k], -least(fx * fy, gx * gy), least(fx * gy, gx * fy));
    const float units = (float)b->units[c][k];
    int32_t rest = b->units[c][k];
    const float part[3] = {gx * gy + leans, fx * gy - leans, gx * fy - leans};
    for (int i = 0; i < 3; i++) {
      const int32_t wanted = (int32_t)clamp(units * part[i], 0, 2147483520);
      const int32_t given = wanted < rest ? wanted : rest;
      b->share[c][i][k] = given;
      rest -= given;
    }
    b->share[c][3][k] = rest;
  }
}

static inline void add(uint32_t *word, int32_t units, bool wide) {
  *word += (uint32_t)units;
  if (wide) word[1] += *word < (uint32_t)units;
}

static inline void add_shares(const batch *b, bool wide) {
  const int words = wide ? 2 : 1;
  for (int k = 0; k < b->count; k++)
    for (int c = 0; c < 3; c++) {
      uint32_t *at = b->word + words * (ptrdiff_t)b->texel[c][k];
      const ptrdiff_t right = words * (ptrdiff_t)b->right[c][k],
                      above = words * (ptrdiff_t)b->above[c][k];
      add(at, b->share[c][0][k], wide);
      add(at + right, b->share[c][1][k], wide);
      add(at + above, b->share[c][2][k], wide);
      add(at + above + right, b->share[c][3][k], wide);
    }
}

static void flush(batch *b) {
  float lean[PARTS];
  if (b->sums->edges)
    place_boxes(b, lean);
  else
    place_rectangles(b, lean);
  for (int c = 0; c < 3; c++) share_parts(b, lean, c);
  if (b->sums->wide)
    add_shares(b, true);
  else
    add_shares(b, false);
  b->count = 0;
}

static void set_tile(batch *b, unsigned tile) {
  const float end = (float)b->sums->side - 0.01f;
  if (b->count > 0) flush(b);
  b->tile = tile;
  for (int k = 0; k < 4; k++) b->rect[k] = k < 2 ? 0 : end;
  if (tile == 0) return;
  const size_t *rect = b->sums->tiles->tile[tile - 1].rect;
  for (int k = 0; k < 4; k++) b->rect[k] = (float)rect[k < 2 ? 2 * k : 2 * k - 3];
}

/* Of a splat's light in one level, what goes for all of its parts. */
typedef struct level_light {
  const splat *s;
  const grid *g;
  float low, high; /* shares of the splat's light before and after it */
  float off[3][2];
  shape shapes[3]; /* before, in and behind the middle along */
  int32_t side, first;
  uint32_t given[3]; /* units */
} level_light;

static void push(batch *b, const level_light *l, float at, const float place[2],
                 const uint32_t units[3]) {
  const shape *of = &l->shapes[at < 0 ? 0 : at > 0 ? 2 : 1];
  const float scale = 1 / l->g->size;
  const int k = b->count;
  for (int i = 0; i < 2; i++) {
    b->across[i][k] = of->across[i];
    b->beside[i][k] = of->beside[i];
    for (int c = 0; c < 3; c++) b->off[c][i][k] = l->off[c][i] * scale;
  }
  for (int c = 0; c < 3; c++)
    b->units[c][k] = (int32_t)(units[c] < INT32_MAX ? units[c] : INT32_MAX);
  b->x[k] = (place[0] + at * l->s->across[0] + fabsf(at) * l->s->skew[0]) * scale;
  b->y[k] = (place[1] + at * l->s->across[1] + fabsf(at) * l->s->skew[1]) * scale;
  b->per_area[k] = of->per_area;
  b->per_size[k] = scale;
  b->side[k] = l->side;
  b->first[k] = l->first;
  if (++b->count == PARTS) flush(b);
}

/* A row of parts: of that number beside and along. Its light grows evenly with its columns. */
static void lay_row(batch *b, level_light *l, int beside, int row, bool last) {
  const splat *s = l->s;
  const grid *g = l->g;
  const float per_row = 1 / (float)g->along, per_across = 1 / (float)g->across;
  const float per_beside = 1 / (float)g->beside, t = (float)row * per_row;
  const float at_beside = ((float)beside + 0.5f) * per_beside - 0.5f,
              at_row = t + 0.5f * per_row - 0.5f;
  float before[3], each[3], place[2];
  for (int c = 0; c < 3; c++) {
    const float slope = 6 * s->slope[c], units = (float)s->units[c] * (l->high - l->low);
    before[c] = (float)s->units[c] * l->low +
                units * ((float)beside + t + slope * t * (t - 1)) * per_beside;
    each[c] = units * per_beside * per_across * per_row * (1 + slope * (2 * t + per_row - 1));
  }
  for (int i = 0; i < 2; i++)
    place[i] = s->centre[i] + l->off[1][i] + s->beside[i] * at_beside + s->shift[i] * at_row;
  for (int column = 0; column < g->across; column++) {
    uint32_t here[3];
    for (int c = 0; c < 3; c++) {
      uint32_t upto = (uint32_t)(before[c] + each[c] * (float)(column + 1));
      if (upto < l->given[c]) upto = l->given[c];
      if (upto > s->units[c] || (last && column + 1 == g->across)) upto = s->units[c];
      here[c] = upto - l->given[c];
      l->given[c] = upto;
    }
    if ((here[0] | here[1] | here[2]) != 0)
      push(b, l, ((float)column + 0.5f) * per_across - 0.5f, place, here);
  }
}

/* Lays a splat's light in one level. */
static void lay(batch *b, level_light *l) {
  const grid *g = l->g;
  const splat *s = l->s;
  const size_t side = b->sums->side, all = side * side;
  const float per_row = 1 / (float)g->along, back = 1 - per_row * per_row;
  l->side = (int32_t)(side >> g->level);
  l->first =
      (int32_t)((all - (all >> (2 * g->level))) / 3 * 4 + (b->tile > 0 ? b->sums->texels : 0));
  for (int i = 0; i < 2; i++) {
    for (int c = 0; c < 3; c++) l->off[c][i] = s->off[c][i] - back * s->slope[c] * s->shift[i];
  }
  for (int i = 0; i < 3; i++)
    if (i == 1 ? g->across % 2 == 1 : g->across > 1)
      l->shapes[i] = shape_of(s, g, (float)(i - 1), b->sums->edges);
  for (int beside = 0; beside < g->beside; beside++)
    for (int row = 0; row < g->along; row++)
      lay_row(b, l, beside, row, l->high == 1 && beside + 1 == g->beside && row + 1 == g->along);
}

static void add_splat(batch *b, const abbe_splat *listed) {
  const bool edges = b->sums->edges;
  if ((unsigned)listed->tile != b->tile) set_tile(b, (unsigned)listed->tile);
  const splat s = splat_at(listed, edges);
  grid fine = grid_of(s.level, &s, edges);
  if (edges && s.level > 0) {
    const grid finer = grid_of(s.level - 1, &s, edges);
    if (parts_of(&finer) <= MOST_PARTS) fine = finer;
  }
  level_light l = {.s = &s, .g = &fine, .high = 1 - s.next_share};
  lay(b, &l);
  if (!(s.next_share > 0)) return;
  const grid next = grid_of(fine.level + 1, &s, edges);
  l.g = &next;
  l.low = l.high;
  l.high = 1;
  lay(b, &l);
}

/* A thread's own: where it adds, and what its items have listed. */
typedef struct worker {
  uint32_t *word;
  abbe_splat *splats;
  int64_t entry[3];
} worker;

/* Adds the splats of some items; with all that it calls, which rounds and divides faster on newer
 * processors. */
SIDE_BY_SIDE __attribute__((flatten)) static void add_items(const abbe_splat_sums *sums,
                                                            const abbe_splat_source *source,
                                                            worker *w, size_t first, size_t end) {
  batch b;
  b.sums = sums;
  b.word = w->word;
  b.count = 0;
  set_tile(&b, 0);
  for (size_t i = first; i < end; i += source->step) {
    const size_t count = source->list(source->from, i, w->splats, w->entry);
    for (size_t k = 0; k < count; k++) add_splat(&b, w->splats + k);
  }
  flush(&b);
}

static void merge(const abbe_splat_sums *sums, const worker *of, int threads, size_t numbers) {
#pragma omp parallel for num_threads(threads)
  for (size_t i = 0; i < numbers; i++)
    for (int k = 1; k < threads; k++)
      if (!sums->wide) {
        of[0].word[i] += of[k].word[i];
      } else {
        const uint32_t low = of[k].word[2 * i];
        of[0].word[2 * i] += low;
        of[0].word[2 * i + 1] += of[k].word[2 * i + 1] + (of[0].word[2 * i] < low);
      }
}

abbe_result abbe_splat_sums_add(const abbe_splat_sums *sums, const abbe_splat_source *source,
                                int64_t entry[3], bool (*goes_on)(void *user), void *user,
                                abbe_error *error) {
  const size_t numbers = 3 * sums->texels * (sums->tiles != NULL ? 2 : 1), count = source->count;
  const size_t list = source->most;
  worker of[MOST_THREADS] = {{.word = sums->word, .splats = malloc(list * sizeof *of->splats)}};
  int threads = 1;
  if (of[0].splats == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path's splats");
  /* Each thread has sums of its own, so none waits for another. */
  while (count >= BLOCK && threads < MOST_THREADS && threads < omp_get_max_threads()) {
    worker *next = &of[threads];
    next->word = calloc(numbers, (sums->wide ? 2 : 1) * sizeof *next->word);
    next->splats = malloc(list * sizeof *next->splats);
    if (next->word == NULL || next->splats == NULL) {
      free(next->word);
      free(next->splats);
      break;
    }
    threads++;
  }
  for (size_t at = 0; at < count && (goes_on == NULL || goes_on(user)); at += BLOCK) {
    const size_t end = count - at < BLOCK ? count : at + BLOCK;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t i = at; i < end; i += TASK)
      add_items(sums, source, &of[omp_get_thread_num()], i, end - i < TASK ? end : i + TASK);
  }
  if (threads > 1) merge(sums, of, threads, numbers);
  for (int k = 0; k < threads; k++) {
    for (int i = 0; i < 3; i++) entry[i] += of[k].entry[i];
    if (k > 0) free(of[k].word);
    free(of[k].splats);
  }
  return ABBE_OK;
}
