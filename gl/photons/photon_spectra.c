#include "gl/photons/photon_spectra.h"

#include "colorimetry/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t abbe_photon_spectra_node(size_t wavelengths, size_t nodes, size_t k) {
  return nodes > 1 ? (k * (wavelengths - 1) + (nodes - 1) / 2) / (nodes - 1) : 0;
}

bool abbe_photon_spectra_refines(const abbe_photon_spectra *spectra) {
  return spectra->nodes < spectra->scene->plan->desc.wavelengths;
}

/* Of a step: XYZ up to it and how far along the index has moved; the sums of XYZ times that, and
 * the index; where landings keep lengths, the sums of XYZ times the attenuation, 1/m. */
static size_t interval_texels(const abbe_photon_spectra *spectra) {
  return spectra->scene->plan->lengths ? 3 : 2;
}

/* Opaque, and no float overflows. */
static const double most_per_m = 1e30;

/* A part of a light's spectrum: X, Y, Z, or its share in each of three bands, and the middle of
 * each. */
typedef struct spectrum_part {
  double light[3], lambda_nm[3];
} spectrum_part;

static void weigh_part(const abbe_photon_spectra *spectra, const abbe_illuminant *illuminant,
                       double min, double max, double from, double to, spectrum_part *out) {
  const double width = (max - min) / (double)(spectra->map_bands > 0 ? spectra->map_bands : 1);
  if (spectra->map_bands == 0) abbe_weights_band_xyz(illuminant, min, max, from, to, out->light);
  for (int c = 0; c < 3; c++) {
    const double low = min + width * (double)(spectra->map_band + (size_t)c);
    const double a = spectra->map_bands == 0 ? from : fmax(from, low);
    const double b = spectra->map_bands == 0 ? to : fmin(to, low + width);
    out->lambda_nm[c] = 0.5 * (a + fmax(a, b));
    if (spectra->map_bands > 0)
      out->light[c] = b > a ? abbe_weights_band_power(illuminant, min, max, a, b) : 0;
  }
}

static void store(const double v[3], double w, float out[4]) {
  for (int k = 0; k < 3; k++) out[k] = (float)v[k];
  out[3] = (float)w;
}

/* One interval from node b = i down to node a = i - 1, step by step. Where the index stays, the
 * place along is by wavelength. */
static void fill_interval(const abbe_photon_spectra *spectra, const abbe_wavelengths *w,
                          size_t light, const abbe_material *material, size_t i, float (*out)[4]) {
  const abbe_illuminant *illuminant = &spectra->scene->local->light[light].illuminant;
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
  for (size_t k = 0; k <= spectra->steps; k++, out += interval_texels(spectra)) {
    size_t half = spectra->steps / 2;
    double lambda_nm = k <= half ? b + (edge - b) * (double)k / (double)half
                                 : edge + (a - edge) * (double)(k - half) / (double)half;
    double at[4] = {lambda_nm}, n[4], t[4]; /* here, then the middle of each of the three */
    spectrum_part piece;
    weigh_part(spectra, illuminant, min, max, lambda_nm, before, &piece);
    for (int c = 0; c < 3; c++) at[1 + c] = piece.lambda_nm[c];
    for (int c = 0; c < 4; c++) {
      n[c] = n_b;
      abbe_material_n(material, at[c], &n[c], NULL);
      t[c] = n_a != n_b ? (n[c] - n_b) / (n_a - n_b) : b > a ? (b - at[c]) / (b - a) : 0;
    }
    for (int c = 0; c < 3; c++) {
      sum[c] += piece.light[c];
      moment[c] += piece.light[c] * t[1 + c];
      if (!spectra->scene->plan->lengths) continue;
      const double per_m = fmin(abbe_material_attenuation(material, at[1 + c]), most_per_m);
      taken[c] += piece.light[c] * per_m;
    }
    store(sum, t[0], out[0]);
    store(moment, n[0], out[1]);
    if (spectra->scene->plan->lengths) store(taken, 0, out[2]);
    before = lambda_nm;
  }
}

/* The nodes that every photon takes, as a sampling of their own. */
abbe_result abbe_photon_spectra_coarse(const abbe_photon_spectra *spectra,
                                       const abbe_wavelengths *all, abbe_wavelengths *out,
                                       abbe_error *error) {
  const size_t n = all->count, last = spectra->nodes;
  *out = (abbe_wavelengths){.count = last,
                            .lambda_nm = calloc(last, sizeof *out->lambda_nm),
                            .edge_nm = calloc(last + 1, sizeof *out->edge_nm)};
  if (out->lambda_nm == NULL || out->edge_nm == NULL) {
    abbe_wavelengths_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  }
  for (size_t k = 0; k < last; k++)
    out->lambda_nm[k] = all->lambda_nm[abbe_photon_spectra_node(n, last, k)];
  for (size_t k = 1; k < last; k++)
    out->edge_nm[k] =
        last == n ? all->edge_nm[k] : 0.5 * (out->lambda_nm[k - 1] + out->lambda_nm[k]);
  out->edge_nm[0] = all->edge_nm[0];
  out->edge_nm[last] = all->edge_nm[n];
  return ABBE_OK;
}

static float (*fill_intervals(const abbe_photon_spectra *spectra, const abbe_wavelengths *w,
                              float (*out)[4]))[4] {
  for (size_t light = 0; light < spectra->scene->plan->light_view_count; light++)
    for (size_t k = 0; k < spectra->scene->plan->refractor_count; k++)
      for (size_t i = 0; i <= w->count; i++, out += interval_texels(spectra) * (spectra->steps + 1))
        fill_interval(
            spectra, w, light,
            spectra->scene->local->object[spectra->scene->plan->refractor_object[k]].material, i,
            out);
  return out;
}

static abbe_result upload_intervals(abbe_photon_spectra *spectra, const abbe_wavelengths *w,
                                    abbe_error *error) {
  const bool refines = abbe_photon_spectra_refines(spectra);
  const size_t sets = spectra->nodes + 1 + (refines ? w->count + 1 : 0);
  const size_t rows =
      spectra->scene->plan->light_view_count * spectra->scene->plan->refractor_count * sets;
  abbe_wavelengths coarse = {0};
  const size_t texels = rows * interval_texels(spectra) * (spectra->steps + 1);
  float(*table)[4] = calloc(texels + 1, sizeof *table);
  if (table == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  abbe_result result = abbe_photon_spectra_coarse(spectra, w, &coarse, error);
  if (result == ABBE_OK) {
    float(*rest)[4] = fill_intervals(spectra, &coarse, table);
    if (refines) fill_intervals(spectra, w, rest);
    result = abbe_photon_attenuation_upload(spectra, &coarse, w, error);
  }
  const size_t size = texels * sizeof *table;
  if (result == ABBE_OK && spectra->intervals == 0) {
    result = abbe_gpu_make_buffer(spectra->scene->gpu, size, table, &spectra->intervals, error);
  } else if (result == ABBE_OK) {
    spectra->scene->gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, spectra->intervals);
    spectra->scene->gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, table);
  }
  abbe_wavelengths_free(&coarse);
  free(table);
  return result;
}

abbe_result abbe_photon_spectra_weigh(abbe_photon_spectra *spectra, size_t bands, size_t first,
                                      abbe_error *error) {
  const abbe_render_desc *desc = &spectra->scene->plan->desc;
  abbe_wavelengths w = {0};
  spectra->map_bands = bands;
  spectra->map_band = first;
  abbe_result result =
      abbe_wavelengths_make(desc->wavelengths, desc->min_nm, desc->max_nm, &w, error);
  if (result == ABBE_OK) result = upload_intervals(spectra, &w, error);
  abbe_wavelengths_free(&w);
  return result;
}

/* Y of the light's band below and above each node, from column `first` of every sample. */
static void weigh_halves(const abbe_photon_spectra *spectra, const abbe_wavelengths *w,
                         size_t light, int first, float (*sample)[4]) {
  const abbe_illuminant *illuminant = &spectra->scene->local->light[light].illuminant;
  const size_t n = spectra->scene->plan->desc.wavelengths;
  const double min = w->edge_nm[0], max = w->edge_nm[w->count];
  for (size_t k = 0; k < w->count; k++) {
    const size_t i = w->count == n ? k : abbe_photon_spectra_node(n, w->count, k);
    double below[3], above[3];
    abbe_weights_band_xyz(illuminant, min, max, w->edge_nm[k], w->lambda_nm[k], below);
    abbe_weights_band_xyz(illuminant, min, max, w->lambda_nm[k], w->edge_nm[k + 1], above);
    sample[i][first] = (float)below[1];
    sample[i][first + 1] = (float)above[1];
  }
}

static abbe_result upload_sample_weights(abbe_photon_spectra *spectra, const abbe_wavelengths *w,
                                         abbe_error *error) {
  size_t n = w->count;
  abbe_wavelengths coarse = {0};
  float(*sample)[4] = calloc(spectra->scene->plan->light_view_count * n + 1, sizeof *sample);
  if (sample == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for weights");
  abbe_result result = abbe_photon_spectra_coarse(spectra, w, &coarse, error);
  for (size_t light = 0; light < spectra->scene->plan->light_view_count && result == ABBE_OK;
       light++) {
    weigh_halves(spectra, w, light, 0, sample + light * n);
    weigh_halves(spectra, &coarse, light, 2, sample + light * n);
  }
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(spectra->scene->gpu,
                                  spectra->scene->plan->light_view_count * n * sizeof *sample,
                                  sample, &spectra->sample_weights, error);
  abbe_wavelengths_free(&coarse);
  free(sample);
  return result;
}

abbe_result abbe_photon_spectra_make(const abbe_gpu_scene *scene, abbe_photon_spectra *out,
                                     abbe_error *error) {
  const abbe_render_desc *desc = &scene->plan->desc;
  abbe_wavelengths w = {0};
  out->scene = scene;
  out->nodes = abbe_plan_least_wavelengths(scene->plan);
  out->steps = 128;
  while (out->steps > 2 && out->steps * out->nodes > 1024) out->steps /= 2;
  abbe_result result =
      abbe_wavelengths_make(desc->wavelengths, desc->min_nm, desc->max_nm, &w, error);
  if (result == ABBE_OK) result = upload_intervals(out, &w, error);
  if (result == ABBE_OK) result = upload_sample_weights(out, &w, error);
  abbe_wavelengths_free(&w);
  return result;
}

void abbe_photon_spectra_free(abbe_photon_spectra *spectra) {
  if (spectra->scene == NULL) return;
  const GLuint buffers[] = {spectra->intervals, spectra->attenuation, spectra->sample_weights};
  spectra->scene->gpu->gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
}

abbe_result abbe_photon_spectra_take_all(abbe_photon_spectra *spectra, abbe_error *error) {
  spectra->nodes = spectra->scene->plan->desc.wavelengths;
  return abbe_photon_spectra_weigh(spectra, spectra->map_bands, spectra->map_band, error);
}
