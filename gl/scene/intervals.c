/* The intervals between neighbouring wavelengths, in steps: what the deposit of their light reads.
 */
#include "colorimetry/weights.h"
#include "gl/renderer_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a step: XYZ up to it and how far along the index has moved; the sums of XYZ times that, and
 * the index; where landings keep lengths, the sums of XYZ times the attenuation, 1/m. */
static size_t interval_texels(const abbe_renderer *r) {
  return r->plan.lengths ? 3 : 2;
}

/* Opaque, and no float overflows. */
static const double most_per_m = 1e30;

/* A part of a light's spectrum: X, Y, Z, or its share in each of three bands, and the middle of
 * each. */
typedef struct part {
  double light[3], lambda_nm[3];
} part;

static void weigh_part(const abbe_renderer *r, const abbe_illuminant *illuminant, double min,
                       double max, double from, double to, part *out) {
  const double width = (max - min) / (double)(r->map_bands > 0 ? r->map_bands : 1);
  if (r->map_bands == 0) abbe_weights_band_xyz(illuminant, min, max, from, to, out->light);
  for (int c = 0; c < 3; c++) {
    const double low = min + width * (double)(r->map_band + (size_t)c);
    const double a = r->map_bands == 0 ? from : fmax(from, low);
    const double b = r->map_bands == 0 ? to : fmin(to, low + width);
    out->lambda_nm[c] = 0.5 * (a + fmax(a, b));
    if (r->map_bands > 0)
      out->light[c] = b > a ? abbe_weights_band_power(illuminant, min, max, a, b) : 0;
  }
}

static void store(const double v[3], double w, float out[4]) {
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
  out[3] = (float)w;
}

/* One interval from node b = i down to node a = i - 1, step by step. Where the index stays, the
 * place along is by wavelength. */
static void fill_interval(const abbe_renderer *r, const abbe_wavelengths *w, size_t light,
                          const abbe_material *material, size_t i, float (*out)[4]) {
  const abbe_illuminant *illuminant = &r->scene->light[light].illuminant;
  double min = w->edge_nm[0], max = w->edge_nm[w->count];
  double a = i > 0 ? w->lambda_nm[i - 1] : w->edge_nm[0];
  double b = i < w->count ? w->lambda_nm[i] : w->edge_nm[w->count];
  double edge = i == 0 ? a : i == w->count ? b : w->edge_nm[i];
  if (w->count == 1) { /* the one node keeps its whole band in the interval before it */
    a = edge = i == 0 ? min : max;
    b = max;
  }
  double n_a = 1, n_b = 1, sum[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, taken[3] = {0, 0, 0},
         before = b;
  abbe_material_n(material, a, &n_a, NULL);
  abbe_material_n(material, b, &n_b, NULL);
  for (size_t k = 0; k <= r->steps; k++, out += interval_texels(r)) {
    size_t half = r->steps / 2;
    double lambda_nm = k <= half ? b + (edge - b) * (double)k / (double)half
                                 : edge + (a - edge) * (double)(k - half) / (double)half;
    double at[4] = {lambda_nm}, n[4], t[4]; /* here, then the middle of each of the three */
    part piece;
    weigh_part(r, illuminant, min, max, lambda_nm, before, &piece);
    for (int c = 0; c < 3; c++) at[1 + c] = piece.lambda_nm[c];
    for (int c = 0; c < 4; c++) {
      n[c] = n_b;
      abbe_material_n(material, at[c], &n[c], NULL);
      t[c] = n_a != n_b ? (n[c] - n_b) / (n_a - n_b) : b > a ? (b - at[c]) / (b - a) : 0;
    }
    for (int c = 0; c < 3; c++) {
      sum[c] += piece.light[c];
      moment[c] += piece.light[c] * t[1 + c];
      if (!r->plan.lengths) continue;
      const double per_m = fmin(abbe_material_attenuation(material, at[1 + c]), most_per_m);
      taken[c] += piece.light[c] * per_m;
    }
    store(sum, t[0], out[0]);
    store(moment, n[0], out[1]);
    if (r->plan.lengths) store(taken, 0, out[2]);
    before = lambda_nm;
  }
}

/* The nodes that every photon takes, as a sampling of their own. */
abbe_result abbe_renderer_coarse_wavelengths(const abbe_renderer *r, const abbe_wavelengths *all,
                                             abbe_wavelengths *out, abbe_error *error) {
  const size_t n = all->count, last = r->nodes;
  *out = (abbe_wavelengths){.count = last,
                            .lambda_nm = calloc(last, sizeof *out->lambda_nm),
                            .edge_nm = calloc(last + 1, sizeof *out->edge_nm)};
  if (out->lambda_nm == NULL || out->edge_nm == NULL) {
    abbe_wavelengths_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  }
  for (size_t k = 0; k < last; k++)
    out->lambda_nm[k] = all->lambda_nm[abbe_renderer_coarse_node(n, last, k)];
  for (size_t k = 1; k < last; k++)
    out->edge_nm[k] =
        last == n ? all->edge_nm[k] : 0.5 * (out->lambda_nm[k - 1] + out->lambda_nm[k]);
  out->edge_nm[0] = all->edge_nm[0];
  out->edge_nm[last] = all->edge_nm[n];
  return ABBE_OK;
}

static float (*fill_intervals(const abbe_renderer *r, const abbe_wavelengths *w,
                              float (*out)[4]))[4] {
  for (size_t light = 0; light < r->plan.light_view_count; light++)
    for (size_t k = 0; k < r->plan.refractor_count; k++)
      for (size_t i = 0; i <= w->count; i++, out += interval_texels(r) * (r->steps + 1))
        fill_interval(r, w, light, r->scene->object[r->plan.refractor_object[k]].material, i, out);
  return out;
}

abbe_result abbe_renderer_upload_intervals(abbe_renderer *r, const abbe_wavelengths *w,
                                           abbe_error *error) {
  const bool refines = abbe_renderer_refines(r);
  const size_t sets = r->nodes + 1 + (refines ? w->count + 1 : 0);
  const size_t rows = r->plan.light_view_count * r->plan.refractor_count * sets;
  abbe_wavelengths coarse = {0};
  const size_t texels = rows * interval_texels(r) * (r->steps + 1);
  float(*table)[4] = calloc(texels + 1, sizeof *table);
  if (table == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  abbe_result result = abbe_renderer_coarse_wavelengths(r, w, &coarse, error);
  if (result == ABBE_OK) {
    float(*rest)[4] = fill_intervals(r, &coarse, table);
    if (refines) fill_intervals(r, w, rest);
    result = abbe_renderer_upload_attenuation(r, &coarse, w, error);
  }
  const size_t size = texels * sizeof *table;
  if (result == ABBE_OK && r->buffer[BINDING_INTERVALS] == 0) {
    result = abbe_renderer_make_buffer(r, size, table, &r->buffer[BINDING_INTERVALS], error);
  } else if (result == ABBE_OK) {
    r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_INTERVALS]);
    r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, table);
  }
  abbe_wavelengths_free(&coarse);
  free(table);
  return result;
}

abbe_result abbe_renderer_weigh_bands(abbe_renderer *r, size_t bands, size_t first,
                                      abbe_error *error) {
  abbe_wavelengths w = {0};
  r->map_bands = bands;
  r->map_band = first;
  abbe_result result = abbe_wavelengths_make(r->plan.desc.wavelengths, r->plan.desc.min_nm,
                                             r->plan.desc.max_nm, &w, error);
  if (result == ABBE_OK) result = abbe_renderer_upload_intervals(r, &w, error);
  abbe_wavelengths_free(&w);
  return result;
}
