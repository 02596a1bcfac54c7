#include "validation/trace/transport/haze.h"

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
                           const float *attenuation, abbe_haze *out, abbe_error *error) {
  *out = (abbe_haze){0};
  if (!abbe_scene_is_hazy(g->scene)) return ABBE_OK;
  const size_t rows = g->refractor_count + 1, values = rows * (steps + 1);
  abbe_haze h = {.refractors = g->refractor_count, .steps = steps};
  h.scattering = calloc(values, sizeof *h.scattering);
  h.extinction = calloc(values, sizeof *h.extinction);
  h.scatters = calloc(rows, sizeof *h.scatters);
  h.coloured = calloc(rows, sizeof *h.coloured);
  h.g = calloc(rows, sizeof *h.g);
  if (!h.scattering || !h.extinction || !h.scatters || !h.coloured || !h.g) {
    abbe_haze_free(&h);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu media", rows);
  }
  bool hazy = false;
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
  *h = (abbe_haze){0};
}
