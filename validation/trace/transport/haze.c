#include "validation/trace/transport/haze.h"

#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

static const abbe_medium *medium_of(const abbe_geometry *g, size_t row) {
  return row < g->refractor_count ? g->scene->object[g->refractor_object[row]].medium
                                  : g->scene->medium;
}

/* A row of the tables; whether there is anything that the tables of attenuation do not have. */
static bool fill_row(const abbe_geometry *g, const double *lambda_nm, const float *attenuation,
                     size_t row, abbe_haze *h) {
  const abbe_medium *m = medium_of(g, row);
  const size_t at = row * (h->steps + 1);
  bool hazy = false;
  for (size_t k = 0; k <= h->steps; k++) {
    const double scattering = abbe_medium_scattering(m, lambda_nm[k]) * g->unit;
    double absorption = abbe_medium_absorption(m, lambda_nm[k]) * g->unit;
    hazy = hazy || scattering + absorption > 0;
    if (row < g->refractor_count && attenuation != NULL) absorption += (double)attenuation[at + k];
    h->scattering[at + k] = (float)scattering;
    h->extinction[at + k] = (float)(scattering + absorption);
    h->scatters[row] = h->scatters[row] || h->scattering[at + k] > 0;
    h->coloured[row] = h->coloured[row] || h->scattering[at + k] != h->scattering[at] ||
                       h->extinction[at + k] != h->extinction[at];
  }
  h->g[row] = m != NULL ? (float)m->g : 0;
  return hazy;
}

abbe_result abbe_haze_make(const abbe_geometry *g, const double *lambda_nm, size_t steps,
                           const float *attenuation, bool all, abbe_haze *out, abbe_error *error) {
  *out = (abbe_haze){0};
  if (!all && !abbe_scene_is_hazy(g->scene)) return ABBE_OK;
  const size_t rows = g->refractor_count + 1, values = rows * (steps + 1);
  abbe_haze h = {.refractors = g->refractor_count, .steps = steps};
  h.scattering = calloc(values, sizeof *h.scattering);
  h.extinction = calloc(values, sizeof *h.extinction);
  h.scatters = calloc(rows, sizeof *h.scatters);
  h.coloured = calloc(rows, sizeof *h.coloured);
  h.g = calloc(rows, sizeof *h.g);
  h.glows = calloc(rows, sizeof *h.glows);
  if (!h.scattering || !h.extinction || !h.scatters || !h.coloured || !h.g || !h.glows) {
    abbe_haze_free(&h);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu media", rows);
  }
  bool hazy = all;
  for (size_t row = 0; row < rows; row++) {
    const bool some = fill_row(g, lambda_nm, attenuation, row, &h);
    hazy = hazy || some;
    h.air = row == g->refractor_count && some;
  }
  if (h.air) {
    abbe_geometry_to_frame(g, g->scene->medium->min, h.low);
    abbe_geometry_to_frame(g, g->scene->medium->max, h.high);
  }
  if (!hazy) abbe_haze_free(&h);
  *out = h;
  return ABBE_OK;
}

void abbe_haze_free(abbe_haze *h) {
  if (h == NULL) return;
  free(h->scattering);
  free(h->extinction);
  free(h->scatters);
  free(h->coloured);
  free(h->g);
  free(h->glows);
  *h = (abbe_haze){0};
}

void abbe_haze_turn(const abbe_haze *h, int i, const float d[3], float u, float v, float out[3]) {
  const double g = (double)h->g[abbe_haze_row(h, i)], w = (double)u;
  const double s = (1 - g * g) / (1 - g + 2 * g * w);
  const double turned = fabs(g) < 1e-6 ? 2 * w - 1 : (1 + g * g - s * s) / (2 * g);
  const float cosine = fminf(fmaxf((float)turned, -1), 1);
  const float sine = sqrtf(1 - cosine * cosine), angle = 6.28318531f * v;
  float x[3], y[3];
  abbe_geometry_across(d, x, y);
  for (int k = 0; k < 3; k++)
    out[k] = cosine * d[k] + sine * (cosf(angle) * x[k] + sinf(angle) * y[k]);
}

/* In a ball of that depth across, the share that is scattered more than N times falls about as
 * exp(-N / (0.08 (1 - g) depth^2)), the slowest mode of diffusion. */
abbe_result abbe_haze_check(const abbe_haze *h, const abbe_geometry *g, abbe_error *error) {
  const double most = 1000;
  for (size_t row = 0; abbe_haze_is(h) && row < g->refractor_count; row++) {
    const abbe_object *o = &g->scene->object[g->refractor_object[row]];
    double size[3], scattering = 0;
    abbe_vector_subtract(o->max, o->min, size);
    for (size_t k = 0; k <= h->steps; k++)
      scattering = fmax(scattering, (double)h->scattering[row * (h->steps + 1) + k] / g->unit);
    const double across = abbe_vector_length(size), depth = scattering * across,
                 turned = 0.08 * (1 - (double)h->g[row]);
    if (depth + turned * depth * depth <= most) continue;
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the 'medium' of '%s' scatters light more often than can be followed: "
                          "give it a 'scattering' of at most %.2g per metre, or --physics matched, "
                          "which scatters once",
                          o->name, (sqrt(1 + 4 * turned * most) - 1) / (2 * turned) / across);
  }
  return ABBE_OK;
}
