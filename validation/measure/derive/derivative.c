#include "validation/measure/derive/derivative.h"

#include "base/maths.h"
#include "scenes/view/view.h"
#include "validation/trace/transport/random.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = ABBE_DERIVATIVE_PARTS, SUMS = ABBE_DERIVATIVE_SUMS, MOST_JUMPS = 64 };
/* Of a line: within so much a jump is found. */
#define NARROW 1e-13
/* Of the window: so far aside of a line a jump's slope is looked for. */
#define ASIDE 1e-9

typedef struct part {
  double (*map)[3]; /* [1 + keys][texels] */
  double (*sum)[SUMS];
  bool *felt;
  double light, left;
  double jumps, lost;
} part;

typedef struct line {
  const abbe_derivative_desc *q;
  part *to;
  double at[4]; /* the place on the window: at[axis] runs */
  int axis;
  double xyz[3], weight;
  abbe_specular_wave *wave; /* [1 + 2 keys] the base's, then of each key down and up */
} line;

static const abbe_specular *scene_of(const line *l, size_t i) {
  return i == 0 ? l->q->base : &l->q->key[(i - 1) / 2].moved[(i - 1) % 2];
}

static void look(const line *l, size_t scene, double t, abbe_specular_tree *out) {
  double at[4];
  memcpy(at, l->at, sizeof at);
  at[l->axis] = t;
  abbe_specular_trace(scene_of(l, scene), &l->wave[scene], at, l->q->interfaces, out);
}

/* ---- what lands ---- */

static void add_texel(double (*map)[3], const abbe_derivative_desc *q, ptrdiff_t column,
                      ptrdiff_t row, const double xyz[3], double flux) {
  if (column < 0 || row < 0 || column >= (ptrdiff_t)q->width || row >= (ptrdiff_t)q->height) return;
  double *to = map[(size_t)row * q->width + (size_t)column];
  for (int c = 0; c < 3; c++) to[c] += flux * xyz[c];
}

static void deposit(const line *l, size_t row, const abbe_specular_tree *tree, double factor) {
  const abbe_derivative_desc *q = l->q;
  double *sum = l->to->sum[row];
  for (size_t i = 0; i < tree->count; i++) {
    const double flux = factor * l->weight * tree->hit[i].flux;
    double r[3], uv[2];
    abbe_vector_subtract(tree->hit[i].p, q->base->centre, r);
    for (int c = 0; c < 3; c++) sum[c] += flux * l->xyz[c];
    for (int k = 0; k < 3; k++) sum[3 + k] += flux * l->xyz[1] * r[k];
    sum[6] += flux * l->xyz[1] * abbe_vector_dot(r, r);
    if (q->width == 0 || !abbe_map_layout_project(&q->layout, tree->hit[i].p, uv)) continue;
    const double x = uv[0] * (double)q->width - 0.5, y = (1 - uv[1]) * (double)q->height - 0.5;
    const double left = floor(x), top = floor(y), fx = x - left, fy = y - top;
    double(*map)[3] = l->to->map + row * q->width * q->height;
    for (int k = 0; k < 4; k++)
      add_texel(map, q, (ptrdiff_t)left + k % 2, (ptrdiff_t)top + k / 2, l->xyz,
                flux * (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy));
  }
}

/* But for rounding, which a key's step is far above. */
static bool same_hits(const abbe_specular_tree *a, const abbe_specular_tree *b, double far) {
  if (a->count != b->count) return false;
  for (size_t i = 0; i < a->count; i++) {
    double off[3];
    abbe_vector_subtract(a->hit[i].p, b->hit[i].p, off);
    if (fabs(a->hit[i].flux - b->hit[i].flux) > 1e-12 * a->hit[i].flux ||
        abbe_vector_length(off) > 1e-12 * far)
      return false;
  }
  return true;
}

/* What changes while all paths meet what they met. */
static void change_smoothly(const line *l, double t, const abbe_specular_tree *base) {
  for (size_t k = 0; k < l->q->keys; k++) {
    const double step = l->q->key[k].step, weight = 1 / (double)l->q->points;
    abbe_specular_tree moved[2];
    bool same[2], felt = false;
    for (int s = 0; s < 2; s++) {
      look(l, 1 + 2 * k + (size_t)s, t, &moved[s]);
      same[s] = moved[s].signature == base->signature;
      felt = felt || !same_hits(&moved[s], base, l->q->base->far);
    }
    l->to->felt[k] = l->to->felt[k] || felt;
    /* Within a step of a jump on both sides, or nothing but rounding. */
    if (!felt || (!same[0] && !same[1])) continue;
    const double by = weight / (step * (same[0] + same[1]));
    deposit(l, 1 + k, same[1] ? &moved[1] : base, by);
    deposit(l, 1 + k, same[0] ? &moved[0] : base, -by);
  }
}

/* ---- jumps ---- */

typedef struct jump {
  double low, high; /* on the line, nearly the same */
  uint64_t below, above;
} jump;

/* All places between two points where what paths meet in a scene changes, in any order. */
static size_t find_jumps(const line *l, size_t scene, double low, double high, jump *out) {
  jump stack[MOST_JUMPS] = {{.low = low, .high = high}};
  size_t waiting = 1, found = 0;
  abbe_specular_tree tree;
  look(l, scene, low, &tree);
  stack[0].below = tree.signature;
  look(l, scene, high, &tree);
  stack[0].above = tree.signature;
  while (waiting > 0 && found < MOST_JUMPS) {
    jump j = stack[--waiting];
    while (j.high - j.low > NARROW && j.below != j.above) {
      const double middle = 0.5 * (j.low + j.high);
      look(l, scene, middle, &tree);
      if (tree.signature == j.below)
        j.low = middle;
      else if (tree.signature == j.above)
        j.high = middle;
      else { /* a third thing in between */
        if (waiting < MOST_JUMPS)
          stack[waiting++] = (jump){middle, j.high, tree.signature, j.above};
        j.high = middle;
        j.above = tree.signature;
      }
    }
    if (j.below != j.above) out[found++] = j;
  }
  return found;
}

/* The same jump among those of a moved scene. */
static const jump *find_same(const jump *j, const jump *moved, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (moved[i].below == j->below && moved[i].above == j->above) return &moved[i];
  return NULL;
}

static double place_of(const jump *j) {
  return 0.5 * (j->low + j->high);
}

/* What of the first's light has no like in the other, W. */
static double only_in(const abbe_specular_tree *a, const abbe_specular_tree *b, const line *l) {
  double sum = 0;
  for (size_t i = 0; i < a->count; i++) {
    double least = INFINITY, off[3];
    for (size_t k = 0; k < b->count; k++) {
      abbe_vector_subtract(a->hit[i].p, b->hit[k].p, off);
      least = fmin(least, abbe_vector_length(off));
    }
    if (least > 1e-6 * l->q->base->far) sum += a->hit[i].flux;
  }
  return sum;
}

/* Lines along both axes cross an edge, and each sees a share of its change: by the square of the
 * edge's normal along it, so that no line counts that an edge nearly lies along. */
static double axis_share(const line *l, const jump *j) {
  const double from = place_of(j) - 100 * ASIDE, to = place_of(j) + 100 * ASIDE;
  jump beside[MOST_JUMPS];
  for (int side = 0; side < 2; side++) {
    line next = *l;
    next.at[1 - l->axis] += side == 0 ? ASIDE : -ASIDE;
    const jump *same = find_same(j, beside, find_jumps(&next, 0, from, to, beside));
    if (same == NULL) continue;
    const double slope = (place_of(same) - place_of(j)) / ASIDE;
    return 2 / (1 + slope * slope);
  }
  return 0; /* along the line */
}

static void change_by_jump(const line *l, size_t k, const jump *j, double share,
                           const jump *const moved[2]) {
  abbe_specular_tree below, above;
  look(l, 0, j->low, &below);
  look(l, 0, j->high, &above);
  if (below.count == 0 && above.count == 0) return;
  const int found = (moved[0] != NULL) + (moved[1] != NULL);
  const double size = share * l->weight * (only_in(&below, &above, l) + only_in(&above, &below, l));
  l->to->jumps += size;
  l->to->lost += found == 0 ? size : 0;
  if (found == 0) return;
  const double by =
      place_of(moved[1] != NULL ? moved[1] : j) - place_of(moved[0] != NULL ? moved[0] : j);
  if (fabs(by) <= 4 * NARROW) return;
  const double speed = share * by / (l->q->key[k].step * found);
  l->to->felt[k] = true;
  deposit(l, 1 + k, &below, speed);
  deposit(l, 1 + k, &above, -speed);
}

/* Of two points between which something jumps. */
static void change_between(const line *l, double low, double high) {
  jump here[MOST_JUMPS], moved[2][MOST_JUMPS];
  const size_t count = find_jumps(l, 0, low, high, here);
  double share[MOST_JUMPS];
  for (size_t i = 0; i < count; i++) share[i] = axis_share(l, &here[i]);
  for (size_t k = 0; k < l->q->keys; k++) {
    size_t counts[2];
    for (size_t s = 0; s < 2; s++) counts[s] = find_jumps(l, 1 + 2 * k + s, low, high, moved[s]);
    for (size_t i = 0; i < count; i++) {
      const jump *same[2];
      for (int s = 0; s < 2; s++) same[s] = find_same(&here[i], moved[s], counts[s]);
      change_by_jump(l, k, &here[i], share[i], same);
    }
  }
}

static void run_line(const line *l, double first) {
  abbe_specular_tree tree;
  look(l, 0, 0, &tree);
  double before = 0;
  uint64_t signature = tree.signature;
  for (size_t i = 0; i < l->q->points; i++) {
    const double t = ((double)i + first) / (double)l->q->points;
    look(l, 0, t, &tree);
    deposit(l, 0, &tree, 1 / (double)l->q->points);
    l->to->left += l->weight * tree.left / (double)l->q->points;
    for (size_t k = 0; k < tree.count; k++)
      l->to->light += l->weight * tree.hit[k].flux / (double)l->q->points;
    if (tree.count > 0) change_smoothly(l, t, &tree);
    if (l->q->keys > 0 && signature != tree.signature) change_between(l, before, t);
    before = t;
    signature = tree.signature;
  }
  look(l, 0, 1, &tree);
  if (l->q->keys > 0 && signature != tree.signature) change_between(l, before, 1);
}

/* ---- parts ---- */

/* Lines of a part lie side by side, each with a wavelength and a place on the light of its own. */
static abbe_result start_line(const abbe_derivative_desc *q, size_t part_index, size_t index,
                              size_t lines, line *l, double *first, abbe_error *error) {
  uint32_t bits[4], more[4];
  float within;
  abbe_random_bits((uint32_t)part_index, (uint32_t)index, q->seed, 0, bits);
  l->axis = (int)(index % 2);
  l->at[1 - l->axis] = ((double)(index / 2) + bits[0] * 0x1p-32) / (double)((lines + 1) / 2);
  l->at[2] = bits[1] * 0x1p-32;
  l->at[3] = bits[2] * 0x1p-32;
  *first = bits[3] * 0x1p-32;
  /* The golden ratio's multiples lie evenly over the wavelengths, from a place of the part's own.
   */
  abbe_random_bits((uint32_t)part_index, 0, q->seed, 1, more);
  const uint32_t colour = (uint32_t)index * 2654435769u + more[0];
  const uint32_t step = abbe_spectral_sampling_step(colour, &within);
  const size_t row = q->light * q->sampling->steps + step;
  for (int c = 0; c < 3; c++) l->xyz[c] = (double)q->sampling->xyz[row][c];
  const double lambda_nm = abbe_spectral_sampling_lambda(q->sampling, step, within);
  for (size_t i = 0; i < 1 + 2 * q->keys; i++)
    ABBE_TRY(abbe_specular_wave_make(scene_of(l, i), lambda_nm, &l->wave[i], error));
  return ABBE_OK;
}

static abbe_result run_part(const abbe_derivative_desc *q, size_t index, part *to,
                            abbe_error *error) {
  const size_t lines = q->lines / PARTS;
  line l = {.q = q, .to = to, .weight = 1 / (double)lines};
  l.wave = calloc(1 + 2 * q->keys, sizeof *l.wave);
  abbe_result result =
      l.wave == NULL ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a line") : ABBE_OK;
  for (size_t i = 0; i < lines && result == ABBE_OK; i++) {
    double first;
    result = start_line(q, index, i, lines, &l, &first, error);
    if (result == ABBE_OK) run_line(&l, first);
  }
  free(l.wave);
  return result;
}

static void take_part(const abbe_derivative_desc *q, size_t index, const part *p, double (*mean)[3],
                      double (*square)[3], abbe_derivative *out) {
  for (size_t i = 0; i < (1 + q->keys) * out->texels; i++)
    for (int c = 0; c < 3; c++) {
      mean[i][c] += p->map[i][c] / PARTS;
      square[i][c] += p->map[i][c] * p->map[i][c] / PARTS;
    }
  for (size_t k = 0; k <= q->keys; k++) {
    memcpy(out->sum[k][index], p->sum[k], sizeof p->sum[k]);
    if (k < q->keys) out->felt[k] = out->felt[k] || p->felt[k];
  }
}

static bool make_part(const abbe_derivative_desc *q, size_t texels, part *p) {
  const size_t rows = 1 + q->keys;
  p->map = calloc(rows * texels + 1, sizeof *p->map);
  p->sum = calloc(rows, sizeof *p->sum);
  p->felt = calloc(rows, sizeof *p->felt);
  return p->map != NULL && p->sum != NULL && p->felt != NULL;
}

static void free_part(part *p) {
  free(p->map);
  free(p->sum);
  free(p->felt);
}

static abbe_result run_parts(const abbe_derivative_desc *q, double (*mean)[3], double (*square)[3],
                             abbe_derivative *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  double light = 0, left = 0, jumps = 0, lost = 0;
  bool failed = false;
  const int threads = q->threads > 0 ? (int)q->threads : omp_get_max_threads();
#pragma omp parallel for ordered schedule(static, 1) num_threads(threads)
  for (int i = 0; i < PARTS; i++) {
    part p = {0};
    abbe_error own = {0};
    abbe_result here = ABBE_OK;
    bool given_up;
#pragma omp atomic read
    given_up = failed;
    const bool going = !given_up;
    if (going && !make_part(q, out->texels, &p))
      here = abbe_error_set(&own, ABBE_NO_MEMORY, "no memory for a map of derivatives");
    if (going && here == ABBE_OK) here = run_part(q, (size_t)i, &p, &own);
#pragma omp ordered
    {
      if (going && here == ABBE_OK) {
        take_part(q, (size_t)i, &p, mean, square, out);
        light += p.light;
        left += p.left;
        jumps += p.jumps;
        lost += p.lost;
        if (q->progress != NULL && !q->progress(q->user, (i + 1.0) / PARTS))
          here = abbe_error_set(&own, ABBE_CANCELLED, "the derivatives were stopped");
      }
      if (here != ABBE_OK && result == ABBE_OK) {
        if (error != NULL) *error = own;
        result = here;
#pragma omp atomic write
        failed = true;
      }
    }
    free_part(&p);
  }
  out->left = light + left > 0 ? left / (light + left) : 0;
  out->lost = jumps > 0 ? lost / jumps : 0;
  return result;
}

abbe_result abbe_derivative_make(const abbe_derivative_desc *q, abbe_derivative *out,
                                 abbe_error *error) {
  abbe_derivative d = {.keys = q->keys, .texels = q->width * q->height};
  const size_t rows = 1 + q->keys, values = rows * d.texels;
  double(*mean)[3] = calloc(values + 1, sizeof *mean);
  double(*square)[3] = calloc(values + 1, sizeof *square);
  d.map = calloc(values + 1, sizeof *d.map);
  d.error = calloc(values + 1, sizeof *d.error);
  d.sum = calloc(rows, sizeof *d.sum);
  d.felt = calloc(rows, sizeof *d.felt);
  memcpy(d.middle, q->base->centre, sizeof d.middle);
  abbe_result result = ABBE_OK;
  if (!mean || !square || !d.map || !d.error || !d.sum || !d.felt)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu maps of derivatives", rows);
  if (result == ABBE_OK) result = run_parts(q, mean, square, &d, error);
  for (size_t i = 0; i < values && result == ABBE_OK; i++)
    for (int c = 0; c < 3; c++) {
      const double spread = fmax(square[i][c] - mean[i][c] * mean[i][c], 0);
      d.map[i][c] = (float)mean[i][c];
      d.error[i][c] = (float)sqrt(spread / (PARTS - 1));
    }
  free(mean);
  free(square);
  if (result != ABBE_OK) abbe_derivative_free(&d);
  *out = d;
  return result;
}

void abbe_derivative_free(abbe_derivative *d) {
  free(d->map);
  free(d->error);
  free(d->sum);
  free(d->felt);
  *d = (abbe_derivative){0};
}

/* ---- the map's layout ---- */

static int64_t fit_points(const abbe_derivative_desc *q, abbe_view *view, double (*point)[3],
                          size_t room, abbe_error *error) {
  enum { TRIALS = 4096 };
  abbe_specular_wave wave;
  abbe_specular_tree tree;
  size_t found = 0;
  const size_t steps = q->sampling->steps;
  for (uint32_t i = 0; i < TRIALS; i++) {
    float r[4];
    abbe_random4(i, 0, 0, 7, r);
    const double at[4] = {(double)r[0], (double)r[1], (double)r[2], (double)r[3]};
    const double lambda_nm = q->sampling->lambda_nm[(size_t)i * steps / TRIALS];
    if (abbe_specular_wave_make(q->base, lambda_nm, &wave, error) != ABBE_OK) return -1;
    abbe_specular_trace(q->base, &wave, at, q->interfaces, &tree);
    for (size_t k = 0; k < tree.count && found < room; k++) {
      double way[3];
      abbe_vector_subtract(tree.hit[k].p, view->origin, way);
      const double z = abbe_vector_dot(way, view->forward);
      const double side =
          fmax(fabs(abbe_vector_dot(way, view->right)), fabs(abbe_vector_dot(way, view->up)));
      if (z > 0 && (view->orthographic || side < ABBE_VIEW_MAX_TANGENT * z) && tree.hit[k].flux > 0)
        memcpy(point[found++], tree.hit[k].p, sizeof *point);
    }
  }
  return (int64_t)found;
}

abbe_result abbe_derivative_fit(const abbe_derivative_desc *q, abbe_map_layout *out,
                                abbe_error *error) {
  enum { ROOM = 65536 };
  const abbe_light *light = q->base->light;
  const bool parallel = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double origin[3], along[3];
  const double up[3] = {0, 0, 1};
  abbe_vector_subtract(q->base->centre, light->position, along);
  for (int k = 0; k < 3; k++) origin[k] = light->position[k];
  if (parallel)
    for (int k = 0; k < 3; k++) {
      along[k] = light->direction[k];
      origin[k] = q->base->centre[k] - q->base->far * along[k];
    }
  abbe_view view;
  abbe_view_look(origin, along, up, parallel, &view);
  double(*point)[3] = malloc(ROOM * sizeof *point);
  if (point == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for trial paths");
  const int64_t found = fit_points(q, &view, point, ROOM, error);
  abbe_result result = found < 0 ? ABBE_OUT_OF_RANGE : ABBE_OK;
  if (found == 0)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "light '%s' throws nothing onto a receiver through the scene's "
                            "refractors and mirrors, so there is no map",
                            light->name);
  if (result == ABBE_OK) {
    abbe_view_fit(&view, (const double(*)[3])point, (size_t)found);
    abbe_view_pad(&view, 0.05);
    abbe_map_layout_make(&view, out);
    result = abbe_map_layout_check(out, error);
  }
  free(point);
  return result;
}
