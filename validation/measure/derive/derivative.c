#include "validation/measure/derive/derivative.h"

#include "base/maths.h"
#include "scenes/view/view.h"
#include "validation/measure/derive/line.h"
#include "validation/measure/derive/shown.h"
#include "validation/trace/transport/random.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = ABBE_DERIVATIVE_PARTS, SUMS = ABBE_DERIVATIVE_SUMS };

/* Across the light's window, of one wavelength. */
typedef struct light_line {
  abbe_line line;
  const abbe_derivative_desc *q;
  abbe_derivative_part *to;
  double place[2]; /* on the light */
  double lens[2];
  double xyz[3];
  abbe_specular_wave *wave; /* [1 + 2 keys] */
} light_line;

static void look(const abbe_line *line, size_t scene, const double at[2],
                 const abbe_specular_tree *known, abbe_specular_tree *out) {
  const light_line *l = (const light_line *)line;
  const double all[4] = {at[0], at[1], l->place[0], l->place[1]};
  abbe_specular_trace(scene == 0 ? line->base : line->moved[scene - 1], &l->wave[scene], all,
                      l->q->interfaces, known, out);
  for (size_t i = 0; l->to->picture != NULL && !out->failed && i < out->count; i++)
    abbe_film_of_hit(l->q->film, scene, l->wave[scene].lambda_nm, l->lens, known, out, i);
}

/* ---- what lands ---- */

/* By a tent that reaches to the neighbours' middles; x, y in texels. */
static void add_texels(double (*map)[3], size_t width, size_t height, double x, double y,
                       const double colour[3], double flux) {
  const double left = floor(x - 0.5), top = floor(y - 0.5);
  const double fx = x - 0.5 - left, fy = y - 0.5 - top;
  for (int k = 0; k < 4; k++) {
    const double column = left + k % 2, row = top + k / 2;
    if (!(column >= 0 && row >= 0 && column < (double)width && row < (double)height)) continue;
    double *to = map[(size_t)row * width + (size_t)column];
    const double share = flux * (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy);
    for (int c = 0; c < 3; c++) to[c] += share * colour[c];
  }
}

static void deposit(const abbe_line *line, size_t row, const abbe_specular_tree *tree,
                    double factor) {
  const light_line *l = (const light_line *)line;
  const abbe_derivative_desc *q = l->q;
  double *sum = l->to->sum[row], rgb[3];
  if (l->to->picture != NULL) abbe_rgb_space_apply(q->film->from_xyz, l->xyz, rgb);
  for (size_t i = 0; i < tree->count; i++) {
    const abbe_specular_hit *hit = &tree->hit[i];
    const double flux = factor * line->weight * hit->flux;
    double r[3], uv[2];
    abbe_vector_subtract(hit->p, q->base->centre, r);
    for (int c = 0; c < 3; c++) sum[c] += flux * l->xyz[c];
    for (int k = 0; k < 3; k++) sum[3 + k] += flux * l->xyz[1] * r[k];
    sum[6] += flux * l->xyz[1] * abbe_vector_dot(r, r);
    if (q->width > 0 && abbe_map_layout_project(&q->layout, hit->p, uv))
      add_texels(l->to->map + row * q->width * q->height, q->width, q->height,
                 uv[0] * (double)q->width, (1 - uv[1]) * (double)q->height, l->xyz, flux);
    if (l->to->picture != NULL && hit->film[2] > 0)
      add_texels(l->to->picture + row * q->film->width * q->film->height, q->film->width,
                 q->film->height, hit->film[0], hit->film[1], rgb, flux * hit->film[2]);
  }
}

/* What of the first's light has no like in the other, W. */
static double only_in(const abbe_line *line, const abbe_specular_tree *a,
                      const abbe_specular_tree *b) {
  double sum = 0;
  for (size_t i = 0; i < a->count; i++) {
    double least = INFINITY, off[3];
    for (size_t k = 0; k < b->count; k++) {
      abbe_vector_subtract(a->hit[i].p, b->hit[k].p, off);
      least = fmin(least, abbe_vector_length(off));
    }
    if (least > 1e-6 * line->base->far) sum += a->hit[i].flux;
  }
  return sum;
}

/* ---- parts ---- */

/* Lines of a part lie side by side, each with a wavelength and a place on the light of its own. */
static abbe_result start_line(const abbe_derivative_desc *q, size_t part, size_t index,
                              size_t lines, light_line *l, double *first, abbe_error *error) {
  uint32_t bits[4], more[4], lens[4];
  float within;
  abbe_random_bits((uint32_t)part, (uint32_t)index, q->seed, 0, bits);
  abbe_random_bits((uint32_t)part, (uint32_t)index, q->seed, 2, lens);
  l->line.axis = (int)(index % 2);
  l->line.at[1 - l->line.axis] =
      ((double)(index / 2) + bits[0] * 0x1p-32) / (double)((lines + 1) / 2);
  for (int k = 0; k < 2; k++) {
    l->place[k] = bits[1 + k] * 0x1p-32;
    l->lens[k] = lens[k] * 0x1p-32;
  }
  *first = bits[3] * 0x1p-32;
  /* The golden ratio's multiples lie evenly over the wavelengths, from a place of the part's own.
   */
  abbe_random_bits((uint32_t)part, 0, q->seed, 1, more);
  const uint32_t colour = (uint32_t)index * 2654435769u + more[0];
  const uint32_t step = abbe_spectral_sampling_step(colour, &within);
  const double lambda_nm = abbe_spectral_sampling_lambda(q->sampling, step, within);
  const float *xyz = q->sampling->xyz[q->light * q->sampling->steps + step];
  for (int c = 0; c < 3; c++) l->xyz[c] = (double)xyz[c];
  for (size_t i = 0; i <= 2 * q->keys; i++)
    ABBE_TRY(abbe_specular_wave_make(i == 0 ? l->line.base : l->line.moved[i - 1], lambda_nm,
                                     &l->wave[i], error));
  return ABBE_OK;
}

abbe_result abbe_derivative_part_run(const abbe_derivative_desc *q, size_t index,
                                     abbe_derivative_part *to, abbe_error *error) {
  const size_t lines = q->lines / PARTS;
  light_line l = {.q = q,
                  .to = to,
                  .line = {.keys = q->keys,
                           .points = q->points,
                           .base = q->base,
                           .to = &to->sums,
                           .weight = 1 / (double)lines,
                           .look = look,
                           .deposit = deposit,
                           .only_in = only_in}};
  const abbe_specular **moved = calloc(2 * q->keys + 1, sizeof *moved);
  double *step = calloc(q->keys + 1, sizeof *step);
  l.line.tree = malloc(ABBE_LINE_TREES * sizeof *l.line.tree);
  l.wave = calloc(1 + 2 * q->keys, sizeof *l.wave);
  abbe_result result = moved == NULL || step == NULL || l.line.tree == NULL || l.wave == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a line")
                           : ABBE_OK;
  for (size_t k = 0; k < q->keys && result == ABBE_OK; k++) {
    step[k] = q->key[k].step;
    for (size_t s = 0; s < 2; s++) moved[2 * k + s] = &q->key[k].moved[s];
  }
  l.line.moved = moved;
  l.line.step = step;
  for (size_t i = 0; i < lines && result == ABBE_OK; i++) {
    double first;
    result = start_line(q, index, i, lines, &l, &first, error);
    if (result == ABBE_OK) abbe_line_run(&l.line, first);
  }
  free(moved);
  free(step);
  free(l.line.tree);
  free(l.wave);
  return result;
}

static void take_part(const abbe_derivative_desc *q, size_t index, const abbe_derivative_part *p,
                      double (*mean)[3], double (*square)[3], abbe_derivative *out) {
  for (size_t i = 0; i < (1 + q->keys) * out->texels; i++)
    for (int c = 0; c < 3; c++) {
      mean[i][c] += p->map[i][c] / PARTS;
      square[i][c] += p->map[i][c] * p->map[i][c] / PARTS;
    }
  for (size_t k = 0; k <= q->keys; k++) {
    memcpy(out->sum[k][index], p->sum[k], sizeof p->sum[k]);
    if (k < q->keys) out->felt[k] = out->felt[k] || p->sums.felt[k];
  }
}

bool abbe_derivative_part_make(const abbe_derivative_desc *q, abbe_derivative_part *p) {
  const size_t rows = 1 + q->keys;
  *p = (abbe_derivative_part){0};
  p->map = calloc(rows * q->width * q->height + 1, sizeof *p->map);
  p->sum = calloc(rows, sizeof *p->sum);
  p->sums.felt = calloc(rows, sizeof *p->sums.felt);
  return p->map != NULL && p->sum != NULL && p->sums.felt != NULL;
}

void abbe_derivative_part_free(abbe_derivative_part *p) {
  free(p->map);
  free(p->sum);
  free(p->sums.felt);
}

static abbe_result run_parts(const abbe_derivative_desc *q, double (*mean)[3], double (*square)[3],
                             abbe_derivative *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  double light = 0, left = 0, jumps = 0, lost = 0;
  bool failed = false;
  const int threads = q->threads > 0 ? (int)q->threads : omp_get_max_threads();
#pragma omp parallel for ordered schedule(static, 1) num_threads(threads)
  for (int i = 0; i < PARTS; i++) {
    abbe_derivative_part p = {0};
    abbe_error own = {0};
    abbe_result here = ABBE_OK;
    bool given_up;
#pragma omp atomic read
    given_up = failed;
    const bool going = !given_up;
    if (going && !abbe_derivative_part_make(q, &p))
      here = abbe_error_set(&own, ABBE_NO_MEMORY, "no memory for a map of derivatives");
    if (going && here == ABBE_OK) here = abbe_derivative_part_run(q, (size_t)i, &p, &own);
#pragma omp ordered
    {
      if (going && here == ABBE_OK) {
        take_part(q, (size_t)i, &p, mean, square, out);
        light += p.sums.light;
        left += p.sums.left;
        jumps += p.sums.jumps;
        lost += p.sums.lost;
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
    abbe_derivative_part_free(&p);
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

static int64_t fit_points(const abbe_derivative_desc *q, abbe_view *view, abbe_specular_tree *tree,
                          double (*point)[3], size_t room, abbe_error *error) {
  enum { TRIALS = 4096 };
  abbe_specular_wave wave;
  size_t found = 0;
  const size_t steps = q->sampling->steps;
  for (uint32_t i = 0; i < TRIALS; i++) {
    float r[4];
    abbe_random4(i, 0, 0, 7, r);
    const double at[4] = {(double)r[0], (double)r[1], (double)r[2], (double)r[3]};
    const double lambda_nm = q->sampling->lambda_nm[(size_t)i * steps / TRIALS];
    if (abbe_specular_wave_make(q->base, lambda_nm, &wave, error) != ABBE_OK) return -1;
    abbe_specular_trace(q->base, &wave, at, q->interfaces, NULL, tree);
    for (size_t k = 0; k < tree->count && found < room; k++) {
      double way[3];
      abbe_vector_subtract(tree->hit[k].p, view->origin, way);
      const double z = abbe_vector_dot(way, view->forward);
      const double side =
          fmax(fabs(abbe_vector_dot(way, view->right)), fabs(abbe_vector_dot(way, view->up)));
      if (z > 0 && (view->orthographic || side < ABBE_VIEW_MAX_TANGENT * z) &&
          tree->hit[k].flux > 0)
        memcpy(point[found++], tree->hit[k].p, sizeof *point);
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
  ABBE_FREED double(*point)[3] = malloc(ROOM * sizeof *point);
  ABBE_FREED abbe_specular_tree *tree = malloc(sizeof *tree);
  if (point == NULL || tree == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for trial paths");
  const int64_t found = fit_points(q, &view, tree, point, ROOM, error);
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
  return result;
}
