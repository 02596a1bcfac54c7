#include "gl/scene/spectra/spectral_tables.h"

#include "colorimetry/weights.h"
#include "gl/device/float4.h"
#include "gl/plan/examine/spectral_needs.h"

#include <math.h>

size_t abbe_interval_sums_texels(const abbe_plan *plan) {
  return plan->tints > 0 ? 3 : 2;
}

size_t abbe_interval_sums_size(const abbe_plan *plan, size_t steps, size_t nodes) {
  const size_t rows = plan->light_view_count * plan->refractor_count * (nodes + 1);
  return rows * abbe_interval_sums_texels(plan) * (steps + 1);
}

/* A part of a light's spectrum: X, Y, Z, or its share in each of three bands, and the middle of
 * each. */
typedef struct spectrum_part {
  double light[3], lambda_nm[3];
} spectrum_part;

static void weigh_part(const abbe_interval_sums *of, const abbe_weights_range *range, double from,
                       double to, spectrum_part *out) {
  const abbe_illuminant *illuminant = range->illuminant;
  const double min = range->min_nm, max = range->max_nm;
  const double width = (max - min) / (double)(of->bands > 0 ? of->bands : 1);
  if (of->bands == 0) abbe_weights_range_xyz(range, from, to, out->light);
  for (int c = 0; c < 3; c++) {
    const double low = min + width * (double)(of->band + (size_t)c);
    const double a = of->bands == 0 ? from : fmax(from, low);
    const double b = of->bands == 0 ? to : fmin(to, low + width);
    out->lambda_nm[c] = 0.5 * (a + fmax(a, b));
    if (of->bands > 0)
      out->light[c] = b > a ? abbe_weights_band_power(illuminant, min, max, a, b) : 0;
  }
}

/* One interval of refractor r from node b = i down to node a = i - 1, step by step. Where the index
 * stays, the place along is by wavelength; so it is without a material. */
static void fill_interval(const abbe_interval_sums *of, const abbe_wavelengths *w,
                          const abbe_weights_range *range, size_t r, size_t i, float (*out)[4]) {
  const abbe_material *material = abbe_mirror_nodes_laid_by(of->scene, of->plan, r);
  const size_t texels = abbe_interval_sums_texels(of->plan);
  double min = w->edge_nm[0], max = w->edge_nm[w->count];
  double a = i > 0 ? w->lambda_nm[i - 1] : w->edge_nm[0];
  double b = i < w->count ? w->lambda_nm[i] : w->edge_nm[w->count];
  double edge = i == 0 ? a : i == w->count ? b : w->edge_nm[i];
  if (w->count == 1) { /* the one node keeps its whole band in the interval before it */
    a = edge = i == 0 ? min : max;
    b = max;
  }
  const bool lines = of->plan->lines > 1; /* the nodes, with all light at the nearer one */
  double n_a = 1, n_b = 1, sum[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, taken[3] = {0, 0, 0},
         before = b;
  if (material != NULL) {
    abbe_material_n(material, a, &n_a, NULL);
    abbe_material_n(material, b, &n_b, NULL);
  }
  for (size_t k = 0; k <= of->steps; k++, out += texels) {
    size_t half = of->steps / 2;
    double lambda_nm = k <= half ? b + (edge - b) * (double)k / (double)half
                                 : edge + (a - edge) * (double)(k - half) / (double)half;
    double at[4] = {lambda_nm}, n[4], t[4]; /* here, then the middle of each of the three */
    spectrum_part part;
    weigh_part(of, range, lambda_nm, before, &part);
    for (int c = 0; c < 3; c++) at[1 + c] = part.lambda_nm[c];
    for (int c = 0; c < 4 && lines; c++) at[c] = k <= half ? b : a;
    for (int c = 0; c < 4; c++) {
      n[c] = n_b;
      if (material != NULL) abbe_material_n(material, at[c], &n[c], NULL);
      t[c] = n_a != n_b ? (n[c] - n_b) / (n_a - n_b) : b > a ? (b - at[c]) / (b - a) : 0;
    }
    for (int c = 0; c < 3; c++) {
      sum[c] += part.light[c];
      moment[c] += part.light[c] * t[1 + c];
      if (of->plan->tints > 0)
        taken[c] += part.light[c] * abbe_tint_attenuation(of->scene, of->plan, r, at[1 + c]);
    }
    abbe_float4_store(sum, t[0], out[0]);
    abbe_float4_store(moment, n[0], out[1]);
    if (of->plan->tints > 0) abbe_float4_store(taken, 0, out[2]);
    before = lambda_nm;
  }
}

float (*abbe_interval_sums_fill(const abbe_interval_sums *of, const abbe_wavelengths *w,
                                float (*out)[4]))[4] {
  const abbe_plan *plan = of->plan;
  const size_t an_interval = abbe_interval_sums_texels(plan) * (of->steps + 1);
  for (size_t light = 0; light < plan->light_view_count; light++) {
    abbe_weights_range range;
    abbe_weights_range_make_by(plan->desc.observer, &of->scene->light[light].illuminant,
                               w->edge_nm[0], w->edge_nm[w->count], &range);
    for (size_t k = 0; k < plan->refractor_count; k++)
      for (size_t i = 0; i <= w->count; i++, out += an_interval)
        fill_interval(of, w, &range, k, i, out);
  }
  return out;
}
