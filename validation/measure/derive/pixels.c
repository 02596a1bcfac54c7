#include "validation/measure/derive/pixels.h"

#include "colorimetry/reflectance/reflected_light.h"
#include "validation/measure/derive/shown.h"
#include "validation/trace/transport/random.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = ABBE_DERIVATIVE_PARTS };

/* A lamp's paths in all scenes. */
typedef struct lamp {
  abbe_specular base;
  abbe_derivative_key *key; /* [keys] */
} lamp;

typedef struct work {
  const abbe_pixels_desc *q;
  abbe_film film;
  lamp *lamp;                  /* [lights] */
  abbe_derivative_desc *light; /* [lights] */
  const abbe_specular **moved; /* [2 keys] of the camera */
  double *step;
} work;

/* ---- scenes ---- */

static abbe_result make_lamp(work *w, size_t index, abbe_error *error) {
  const abbe_pixels_desc *q = w->q;
  const double *nm = q->sampling->lambda_nm;
  lamp *l = &w->lamp[index];
  abbe_derivative_desc *d = &w->light[index];
  double low[3], high[3];
  if (!abbe_scene_bounds(q->scene, true, false, low, high)) return ABBE_OK;
  l->key = calloc(q->keys + 1, sizeof *l->key);
  if (l->key == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the keys");
  ABBE_TRY(abbe_specular_make(q->scene, index, &q->shift, &l->base, error));
  ABBE_TRY(abbe_specular_narrow(&l->base, nm[0], nm[q->sampling->steps], q->interfaces, error));
  for (size_t k = 0; k < q->keys; k++) {
    l->key[k].name = q->key[k].name;
    l->key[k].step = q->key[k].step;
    for (int s = 0; s < 2; s++) {
      if (index >= q->key[k].moved[s]->light_count)
        return abbe_error_set(error, ABBE_UNSUPPORTED, "'%s' changes how many lights there are",
                              q->key[k].name);
      ABBE_TRY(abbe_specular_make(q->key[k].moved[s], index, &q->key[k].shift[s],
                                  &l->key[k].moved[s], error));
      ABBE_TRY(abbe_specular_match(&l->key[k].moved[s], &l->base, q->key[k].name, error));
    }
  }
  *d = (abbe_derivative_desc){.base = &l->base,
                              .light = index,
                              .keys = q->keys,
                              .key = l->key,
                              .sampling = q->sampling,
                              .film = &w->film,
                              .width = q->map_side,
                              .height = q->map_side,
                              .lines = q->lines,
                              .points = q->points,
                              .interfaces = q->interfaces,
                              .seed = q->seed};
  abbe_error none = {0};
  const abbe_result result = abbe_derivative_fit(d, &d->layout, &none);
  if (result == ABBE_UNSUPPORTED) { /* nothing lands */
    d->base = NULL;
    return ABBE_OK;
  }
  if (result != ABBE_OK && error != NULL) *error = none;
  return result;
}

static abbe_result make_scenes(work *w, abbe_error *error) {
  const abbe_pixels_desc *q = w->q;
  const double *nm = q->sampling->lambda_nm, aspect = (double)q->width / (double)q->height;
  for (size_t i = 0; i <= 2 * q->keys; i++) {
    const abbe_pixels_key *key = i == 0 ? NULL : &q->key[(i - 1) / 2];
    const int s = (int)((i + 1) % 2);
    const abbe_scene *scene = i == 0 ? q->scene : key->moved[s];
    ABBE_TRY(abbe_shown_make(scene, i == 0 ? &q->shift : &key->shift[s],
                             i == 0 ? NULL : &w->film.scene[0], i == 0 ? "" : key->name, aspect,
                             nm[0], nm[q->sampling->steps], &w->film.scene[i], error));
    if (i > 0) w->moved[i - 1] = &w->film.scene[i].specular;
    if (i > 0) w->step[(i - 1) / 2] = key->step;
  }
  for (size_t i = 0; i < q->scene->light_count; i++) ABBE_TRY(make_lamp(w, i, error));
  return ABBE_OK;
}

/* What makes white of the first light, as a picture's ambient light and background have it. */
static void make_colours(work *w) {
  const abbe_spectral_sampling *s = w->q->sampling;
  double to_xyz[9], white[3] = {1, 1, 1}, scaled[9];
  abbe_spectral_sampling_colours(s, w->q->space, w->film.colour);
  abbe_rgb_space_from_xyz(w->q->space, w->film.from_xyz);
  abbe_rgb_space_to_xyz(w->q->space, to_xyz);
  abbe_rgb_space_apply(to_xyz, white, white);
  for (int row = 0; row < 3; row++)
    for (int k = 0; k < 3; k++)
      scaled[3 * row + k] =
          s->white[0][row] > 0 ? to_xyz[3 * row + k] * white[row] / s->white[0][row] : 0;
  abbe_matrix3_multiply(w->film.from_xyz, scaled, w->film.whiten);
}

/* Means over the steps of what each channel of every receiver reflects of each light, and of all of
 * it. */
static void fill_white(work *w) {
  const abbe_spectral_sampling *s = w->q->sampling;
  const abbe_scene *scene = w->q->scene;
  for (size_t i = 0; i < scene->object_count + 1; i++)
    for (size_t k = 0; k < s->steps; k++) {
      double channel[3] = {1, 0, 0};
      if (i < scene->object_count && abbe_object_kind_of(&scene->object[i]) != ABBE_OBJECT_RECEIVER)
        break;
      if (i < scene->object_count)
        abbe_reflectance_channels(scene->object[i].spectrum,
                                  0.5 * (s->lambda_nm[k] + s->lambda_nm[k + 1]), channel);
      for (size_t l = 0; l < scene->light_count; l++)
        for (int j = 0; j < 3; j++)
          for (int c = 0; c < 3; c++)
            w->film.white[i * scene->light_count + l][j][c] +=
                channel[j] * (double)w->film.colour[l * s->steps + k][c] / (double)s->steps;
    }
}

static void free_work(work *w) {
  for (size_t i = 0; w->film.scene != NULL && i <= 2 * w->q->keys; i++)
    abbe_shown_free(&w->film.scene[i]);
  for (size_t i = 0; w->lamp != NULL && i < w->q->scene->light_count; i++) {
    for (size_t k = 0; w->lamp[i].key != NULL && k < w->q->keys; k++)
      for (int s = 0; s < 2; s++) abbe_specular_free(&w->lamp[i].key[k].moved[s]);
    abbe_specular_free(&w->lamp[i].base);
    free(w->lamp[i].key);
  }
  free(w->film.scene);
  free(w->film.colour);
  free(w->film.white);
  free(w->lamp);
  free(w->light);
  free(w->moved);
  free(w->step);
}

static abbe_result make_work(const abbe_pixels_desc *q, work *w, abbe_error *error) {
  const size_t scenes = 1 + 2 * q->keys, lights = q->scene->light_count + 1;
  *w = (work){.q = q,
              .film = {.width = q->width,
                       .height = q->height,
                       .keys = q->keys,
                       .interfaces = q->interfaces,
                       .sampling = q->sampling}};
  w->film.scene = calloc(scenes, sizeof *w->film.scene);
  w->film.colour = calloc(q->sampling->rows * q->sampling->steps, sizeof *w->film.colour);
  w->film.white = calloc((q->scene->object_count + 1) * lights, sizeof *w->film.white);
  w->lamp = calloc(lights, sizeof *w->lamp);
  w->light = calloc(lights, sizeof *w->light);
  w->moved = calloc(scenes, sizeof *w->moved);
  w->step = calloc(scenes, sizeof *w->step);
  w->film.light = w->light;
  if (!w->film.scene || !w->film.colour || !w->film.white || !w->lamp || !w->light || !w->moved ||
      !w->step)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the keys' scenes");
  make_colours(w);
  fill_white(w);
  return make_scenes(w, error);
}

/* ---- parts ---- */

typedef struct part {
  double (*picture)[3]; /* [1 + keys][pixels] */
  double (**map)[3];    /* [lights], of the lamps' parts */
  abbe_derivative_part *lamp;
  abbe_line_sums sums;
} part;

static void add_sums(const abbe_line_sums *from, size_t keys, abbe_line_sums *to) {
  for (size_t k = 0; k < keys; k++) to->felt[k] = to->felt[k] || from->felt[k];
  to->light += from->light;
  to->left += from->left;
  to->jumps += from->jumps;
  to->lost += from->lost;
}

static abbe_result run_lamps(const work *w, size_t index, part *p, abbe_error *error) {
  for (size_t i = 0; i < w->q->scene->light_count; i++) {
    const abbe_derivative_desc *d = &w->light[i];
    if (d->base == NULL) continue;
    if (!abbe_derivative_part_make(d, &p->lamp[i]))
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light's map");
    p->lamp[i].picture = p->picture;
    p->map[i] = p->lamp[i].map;
    ABBE_TRY(abbe_derivative_part_run(d, index, &p->lamp[i], error));
    /* of the light and of what jumps the picture's own lines say how much is left out */
    for (size_t k = 0; k < w->q->keys; k++)
      p->sums.felt[k] = p->sums.felt[k] || p->lamp[i].sums.felt[k];
  }
  return ABBE_OK;
}

/* Lines along an axis lie side by side, each with a wavelength and places of its own. */
static abbe_result start_line(const work *w, size_t part_index, size_t index, size_t lines,
                              abbe_film_line *l, double *first, abbe_error *error) {
  uint32_t bits[12], more[4];
  float within;
  for (uint32_t i = 0; i < 3; i++)
    abbe_random_bits((uint32_t)part_index, (uint32_t)index, w->q->seed,
                     16 + 4 * (uint32_t)l->line.axis + i, bits + 4 * i);
  l->line.at[1 - l->line.axis] = ((double)index + bits[0] * 0x1p-32) / (double)lines;
  *first = bits[1] * 0x1p-32;
  for (int k = 0; k < ABBE_FILM_CHANCES; k++) l->chance[k] = bits[2 + k] * 0x1p-32;
  l->chance[4] = abbe_random_double(bits[6], bits[11]);
  abbe_random_bits((uint32_t)part_index, (uint32_t)l->line.axis, w->q->seed, 3, more);
  l->step = abbe_spectral_sampling_step((uint32_t)index * 2654435769u + more[0], &within);
  const double lambda_nm = abbe_spectral_sampling_lambda(w->q->sampling, l->step, within);
  for (size_t i = 0; i <= 2 * w->q->keys; i++)
    ABBE_TRY(abbe_specular_wave_make(&w->film.scene[i].specular, lambda_nm, &l->wave[i], error));
  return ABBE_OK;
}

static abbe_result run_film(const work *w, size_t index, part *p, abbe_error *error) {
  const abbe_pixels_desc *q = w->q;
  abbe_film_line l = {.line = {.keys = q->keys,
                               .base = &w->film.scene[0].specular,
                               .moved = w->moved,
                               .step = w->step,
                               .to = &p->sums},
                      .film = &w->film,
                      .map = p->map,
                      .picture = p->picture};
  abbe_film_line_begin(&l);
  l.line.tree = malloc(ABBE_LINE_TREES * sizeof *l.line.tree);
  l.wave = calloc(1 + 2 * q->keys, sizeof *l.wave);
  abbe_result result = l.line.tree == NULL || l.wave == NULL
                           ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a line")
                           : ABBE_OK;
  for (int axis = 0; axis < 2; axis++) {
    const size_t points = axis == 0 ? q->width : q->height;
    const size_t across = axis == 0 ? q->height : q->width;
    const size_t lines = (across * q->samples + 2 * PARTS - 1) / (2 * PARTS);
    l.line.axis = axis;
    l.line.points = points;
    l.line.weight = 0.5 / (double)lines;
    for (size_t i = 0; i < lines && result == ABBE_OK; i++) {
      double first;
      result = start_line(w, index, i, lines, &l, &first, error);
      if (result == ABBE_OK) abbe_line_run(&l.line, first);
    }
  }
  free(l.line.tree);
  free(l.wave);
  return result;
}

static abbe_result run_part(const work *w, size_t index, part *p, abbe_error *error) {
  const abbe_pixels_desc *q = w->q;
  const size_t lights = q->scene->light_count + 1;
  p->picture = calloc((1 + q->keys) * q->width * q->height, sizeof *p->picture);
  p->map = calloc(lights, sizeof *p->map);
  p->lamp = calloc(lights, sizeof *p->lamp);
  p->sums.felt = calloc(q->keys + 1, sizeof *p->sums.felt);
  if (!p->picture || !p->map || !p->lamp || !p->sums.felt)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture of derivatives");
  ABBE_TRY(run_lamps(w, index, p, error));
  return run_film(w, index, p, error);
}

static void free_part(const work *w, part *p) {
  for (size_t i = 0; p->lamp != NULL && i < w->q->scene->light_count; i++)
    abbe_derivative_part_free(&p->lamp[i]);
  free(p->picture);
  free(p->map);
  free(p->lamp);
  free(p->sums.felt);
}

/* Sums, and their squares: means at the end. */
static void take_part(const work *w, size_t index, const part *p, double (*mean)[3],
                      double (*square)[3], abbe_line_sums *sums, abbe_pixels *out) {
  for (size_t i = 0; i < (1 + w->q->keys) * out->pixels; i++)
    for (int c = 0; c < 3; c++) {
      mean[i][c] += p->picture[i][c] / PARTS;
      square[i][c] += p->picture[i][c] * p->picture[i][c] / PARTS;
    }
  const abbe_pixels_desc *q = w->q;
  const bool all = q->region[2] == 0;
  const size_t left = all ? 0 : q->region[0], top = all ? 0 : q->region[1];
  const size_t wide = all ? q->width : q->region[2], high = all ? q->height : q->region[3];
  for (size_t i = 0; i < (1 + q->keys) * wide * high; i++) {
    const size_t row = i / (wide * high), x = left + i % wide, y = top + i / wide % high;
    for (int c = 0; c < 3; c++)
      out->mean[row][index][c] +=
          p->picture[row * out->pixels + y * q->width + x][c] / (double)(wide * high);
  }
  add_sums(&p->sums, w->q->keys, sums);
}

static abbe_result run_parts(const work *w, double (*mean)[3], double (*square)[3],
                             abbe_pixels *out, abbe_error *error) {
  const abbe_pixels_desc *q = w->q;
  abbe_result result = ABBE_OK;
  abbe_line_sums sums = {.felt = out->felt};
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
    if (!given_up) here = run_part(w, (size_t)i, &p, &own);
#pragma omp ordered
    {
      if (!given_up && here == ABBE_OK) {
        take_part(w, (size_t)i, &p, mean, square, &sums, out);
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
    free_part(w, &p);
  }
  out->left = sums.light + sums.left > 0 ? sums.left / (sums.light + sums.left) : 0;
  out->lost = sums.jumps > 0 ? sums.lost / sums.jumps : 0;
  return result;
}

abbe_result abbe_pixels_make(const abbe_pixels_desc *q, abbe_pixels *out, abbe_error *error) {
  abbe_pixels p = {.keys = q->keys, .pixels = q->width * q->height};
  const size_t rows = 1 + q->keys, values = rows * p.pixels;
  work w;
  abbe_result result = make_work(q, &w, error);
  double(*mean)[3] = calloc(values, sizeof *mean);
  double(*square)[3] = calloc(values, sizeof *square);
  p.value = calloc(values, sizeof *p.value);
  p.error = calloc(values, sizeof *p.error);
  p.mean = calloc(rows, sizeof *p.mean);
  p.felt = calloc(rows, sizeof *p.felt);
  if (result == ABBE_OK && (!mean || !square || !p.value || !p.error || !p.mean || !p.felt))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pictures", rows);
  if (result == ABBE_OK) result = run_parts(&w, mean, square, &p, error);
  for (size_t i = 0; i < values && result == ABBE_OK; i++)
    for (int c = 0; c < 3; c++) {
      p.value[i][c] = (float)mean[i][c];
      p.error[i][c] = (float)sqrt(fmax(square[i][c] - mean[i][c] * mean[i][c], 0) / (PARTS - 1));
    }
  free(mean);
  free(square);
  free_work(&w);
  if (result != ABBE_OK) abbe_pixels_free(&p);
  *out = p;
  return result;
}

void abbe_pixels_free(abbe_pixels *p) {
  free(p->value);
  free(p->error);
  free(p->mean);
  free(p->felt);
  *p = (abbe_pixels){0};
}

void abbe_pixels_mean(const abbe_pixels *p, size_t row, double mean[3], double error[3]) {
  for (int c = 0; c < 3; c++) {
    double square = 0;
    mean[c] = 0;
    for (size_t i = 0; i < PARTS; i++) mean[c] += p->mean[row][i][c] / PARTS;
    for (size_t i = 0; i < PARTS; i++) square += pow(p->mean[row][i][c] - mean[c], 2);
    error[c] = sqrt(square / (PARTS * (PARTS - 1.0)));
  }
}
