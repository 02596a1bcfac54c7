#include "validation/trace/medium/glow.h"

#include "scenes/geometry/digest.h"

#include <stdlib.h>

static const abbe_material *material_of(const abbe_geometry *g, size_t refractor) {
  return g->scene->object[g->refractor_object[refractor]].material;
}

static float *row(float *table, const abbe_glow *g, int i) {
  return table + (size_t)i * (g->steps + 1);
}

/* Middle of a step, nm. */
static double middle(const abbe_glow *g, uint32_t k) {
  return abbe_spectral_sampling_lambda(g->sampling, k, 0.5f);
}

/* What excites it of the lights' power in each step; where there is none, of even power. */
static void choose(const abbe_glow *g, const abbe_media *media, int i) {
  const abbe_spectral_sampling *s = g->sampling;
  float *to = row(g->chosen, g, i), *share = row(g->excites, g, i);
  double sum = 0;
  for (uint32_t k = 0; k < g->steps; k++) {
    double power = 0;
    for (size_t l = 0; l < s->lights; l++) power += (double)s->power[l * s->steps + k];
    sum += (double)share[k] * (double)abbe_media_attenuation(media, i, k, 0.5f) *
           (power / (double)s->lights + 1e-3);
    to[k + 1] = (float)sum;
  }
  for (size_t k = 0; sum > 0 && k <= g->steps; k++) to[k] /= (float)sum;
}

/* Which rows of the matrix emit, and how much, of what excites it in each step. */
static void fill_rows(const abbe_glow *g, const abbe_material *m, size_t i, size_t first) {
  const double *nm = g->sampling->lambda_nm;
  const size_t rows = abbe_material_glow_rows(m);
  for (size_t r = 0; r < rows; r++)
    for (size_t k = 0; k <= g->steps; k++)
      row(g->emitted, g, (int)(first + r))[k] =
          (float)(abbe_material_row_emission(m, r, 1, nm[0]) +
                  abbe_material_row_emission(m, r, nm[0], nm[k]));
  for (size_t k = 0, r = 0; k < g->steps; k++) {
    const double at = middle(g, (uint32_t)k);
    while (r + 2 < rows && m->fluorescence.row[r + 1].nm <= at) r++;
    g->row[i * g->steps + k] = (uint32_t)(first + r);
    for (size_t j = 0; j < 2 && r + j < rows; j++)
      g->yield[i * g->steps + k][j] = (float)abbe_material_row_yield(m, r + j, at);
  }
}

static void fill(const abbe_geometry *geometry, abbe_media *media, const abbe_glow *g) {
  const double *nm = g->sampling->lambda_nm;
  size_t first = 0;
  for (size_t i = 0; i < geometry->refractor_count; i++) {
    const abbe_material *m = material_of(geometry, i);
    if (!abbe_material_is_fluorescent(m)) continue;
    fill_rows(g, m, i, first);
    first += abbe_material_glow_rows(m);
    media->haze.glows[i] = true;
    media->haze.coloured[i] = true;
    for (size_t k = 0; k <= g->steps; k++)
      row(g->excites, g, (int)i)[k] = (float)abbe_material_excites(m, nm[k]);
    choose(g, media, (int)i);
  }
}

abbe_result abbe_glow_make(const abbe_geometry *geometry, const abbe_spectral_sampling *sampling,
                           abbe_media *media, abbe_glow *out, abbe_error *error) {
  const size_t steps = sampling->steps, values = (geometry->refractor_count + 1) * (steps + 1);
  abbe_glow g = {.sampling = sampling, .steps = steps};
  size_t rows = 1;
  *out = g;
  if (sampling->rows == sampling->lights) return ABBE_OK;
  abbe_haze_free(&media->haze);
  ABBE_TRY(abbe_haze_make(geometry, sampling->lambda_nm, steps, media->attenuation, true,
                          &media->haze, error));
  for (size_t i = 0; i < geometry->refractor_count; i++)
    rows += abbe_material_glow_rows(material_of(geometry, i));
  rows *= steps + 1;
  g.row = calloc(values, sizeof *g.row);
  g.yield = calloc(values, sizeof *g.yield);
  g.excites = calloc(values, sizeof *g.excites);
  g.emitted = calloc(rows, sizeof *g.emitted);
  g.chosen = calloc(values, sizeof *g.chosen);
  *out = g;
  if (!g.row || !g.yield || !g.excites || !g.emitted || !g.chosen)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of fluorescence");
  fill(geometry, media, &g);
  media->films.key = abbe_digest_array(media->films.key, g.row, values, sizeof *g.row);
  media->films.key = abbe_digest_array(media->films.key, g.yield, values, sizeof *g.yield);
  media->films.key = abbe_digest_array(media->films.key, g.excites, values, sizeof *g.excites);
  media->films.key = abbe_digest_array(media->films.key, g.emitted, rows, sizeof *g.emitted);
  media->haze.glow = out;
  return ABBE_OK;
}

void abbe_glow_free(abbe_glow *g) {
  free(g->row);
  free(g->yield);
  free(g->excites);
  free(g->emitted);
  free(g->chosen);
  *g = (abbe_glow){0};
}

/* The step in which a rising table passes u; false: it ends below. */
static bool find(const float *table, size_t steps, float u, uint32_t *step, float *within) {
  size_t low = 0, high = steps;
  if (!(u >= table[0] && u < table[steps])) return false;
  while (high - low > 1) {
    const size_t at = low + (high - low) / 2;
    if (table[at] <= u)
      low = at;
    else
      high = at;
  }
  *step = (uint32_t)low;
  *within = fminf((u - table[low]) / (table[low + 1] - table[low]), 0x1.fffffep-1f);
  return true;
}

bool abbe_glow_emit(const abbe_glow *g, int i, float u, uint32_t *step, float *within) {
  const size_t at = (size_t)i * g->steps + *step;
  const float *yield = g->yield[at], first = yield[0] / (yield[0] + yield[1]);
  size_t from = g->row[at];
  if (!(yield[0] + yield[1] > 0)) return false;
  if (yield[1] > 0) {
    from += u >= first;
    u = u >= first ? (u - first) / (1 - first) : u / first;
    u = fminf(u, 0x1.fffffep-1f);
  }
  return find(row(g->emitted, g, (int)from), g->steps, u, step, within);
}

float abbe_glow_yield(const abbe_glow *g, int i, uint32_t step, uint32_t shown) {
  const size_t at = (size_t)i * g->steps + step;
  float sum = 0;
  for (size_t j = 0; j < 2; j++) {
    if (!(g->yield[at][j] > 0)) continue;
    const float *emitted = row(g->emitted, g, (int)(g->row[at] + j));
    sum += g->yield[at][j] * (emitted[shown + 1] - emitted[shown]);
  }
  return sum * (float)g->steps * (float)(middle(g, step) / middle(g, shown));
}

float abbe_glow_excite(const abbe_glow *g, int i, float u, uint32_t *step, float *within) {
  const float *chosen = row(g->chosen, g, i);
  const uint32_t shown = *step;
  if (!find(chosen, g->steps, u, step, within)) return 0;
  return abbe_glow_yield(g, i, *step, shown) /
         ((float)g->steps * (chosen[*step + 1] - chosen[*step]));
}

void abbe_glow_turn(float u, float v, float out[3]) {
  const float z = 2 * u - 1, r = sqrtf(fmaxf(1 - z * z, 0)), angle = 6.28318531f * v;
  out[0] = r * cosf(angle);
  out[1] = r * sinf(angle);
  out[2] = z;
}
