#include "gl/scene/spectra/camera_bands.h"

#include <math.h>
#include <stdlib.h>

size_t abbe_camera_bands_count(size_t wavelengths, size_t *levels) {
  size_t count = wavelengths;
  *levels = 1;
  for (size_t n = wavelengths; n > 1; (*levels)++) count += n = (n + 1) / 2;
  return count;
}

/* A pair of bands as one: weights add, index and attenuation are means by brightness. */
static void join_bands(const abbe_camera_band *a, const abbe_camera_band *b,
                       abbe_camera_band *out) {
  double wa = 1e-9, wb = 1e-9;
  for (int c = 0; c < 3; c++) {
    wa += fabs(a->weight_n[c]);
    wb += fabs(b->weight_n[c]);
    out->weight_n[c] = a->weight_n[c] + b->weight_n[c];
  }
  out->weight_n[3] = (float)((wa * a->weight_n[3] + wb * b->weight_n[3]) / (wa + wb));
  out->attenuation[0] = (float)((wa * a->attenuation[0] + wb * b->attenuation[0]) / (wa + wb));
}

static void join_levels(size_t count, abbe_camera_band *band) {
  for (; count > 1; band += count, count = (count + 1) / 2)
    for (size_t i = 0; i < (count + 1) / 2; i++) {
      band[count + i] = band[2 * i];
      if (2 * i + 1 < count) join_bands(&band[2 * i], &band[2 * i + 1], &band[count + i]);
    }
}

/* Weights by their white; a white without X, say, is shared evenly. */
static void weigh(const double xyz[3], const double white[3], size_t count, float out[4]) {
  for (int c = 0; c < 3; c++)
    out[c] = (float)(white[c] > 0 ? xyz[c] / white[c] : 1.0 / (double)count);
}

static void fill_first(const abbe_spectral_tables *tables, size_t refractor,
                       abbe_camera_band *band) {
  const abbe_weights *xyz = &tables->camera;
  for (size_t i = 0; i < xyz->count; i++) {
    weigh(xyz->weight[i], xyz->sum, xyz->count, band[i].weight_n);
    band[i].weight_n[3] = (float)tables->index[refractor * xyz->count + i];
    band[i].attenuation[0] = (float)tables->attenuation[refractor * xyz->count + i];
  }
  join_levels(xyz->count, band);
}

/* Where a share's wavelength stands in the plan's band. */
static double place_of(const abbe_wavelengths *w, size_t i, int share) {
  return w->edge_nm[i] +
         (share + 0.5) / ABBE_CAMERA_BAND_SHARES * (w->edge_nm[i + 1] - w->edge_nm[i]);
}

/* Bands meet midway between the share's own wavelengths, and end where the range ends. */
static abbe_result fill_share(const abbe_spectral_tables *tables, const abbe_weights_range *light,
                              const abbe_object *object, int share, abbe_camera_band *band,
                              abbe_error *error) {
  const abbe_wavelengths *w = &tables->all;
  double from = w->edge_nm[0];
  for (size_t i = 0; i < w->count; i++) {
    const double at = place_of(w, i, share);
    const double to =
        i + 1 < w->count ? 0.5 * (at + place_of(w, i + 1, share)) : w->edge_nm[w->count];
    double xyz[3], n;
    const abbe_result result = abbe_material_n(object->material, at, &n, error);
    if (result != ABBE_OK) return result;
    abbe_weights_range_xyz(light, from, to, xyz);
    weigh(xyz, tables->camera.sum, w->count, band[i].weight_n);
    band[i].weight_n[3] = (float)n;
    band[i].attenuation[0] = (float)(abbe_material_attenuation(object->material, at) +
                                     abbe_medium_scattering(object->medium, at));
    from = to;
  }
  join_levels(w->count, band);
  return ABBE_OK;
}

static void store_mirror(const abbe_mirror_band *from, abbe_camera_band *out) {
  for (int c = 0; c < 3; c++) out->weight_n[c] = (float)from->weight[c];
  out->weight_n[3] = 1;
  out->attenuation[0] = (float)from->straight;
  out->attenuation[1] = (float)from->factor;
  out->attenuation[2] = (float)from->n;
  out->attenuation[3] = (float)from->k;
}

static abbe_result fill_mirror(const abbe_object *mirror, const abbe_mirror_node *node,
                               const abbe_spectral_tables *tables, const abbe_weights_range *light,
                               abbe_camera_band *band, abbe_error *error) {
  const abbe_wavelengths *w = &tables->all;
  size_t count = w->count;
  abbe_mirror_band *of = calloc(count + 1, sizeof *of);
  abbe_result result =
      of != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = abbe_mirror_band_make(mirror, light, tables->camera.sum, w->edge_nm[i],
                                   w->edge_nm[i + 1], &node[i], &of[i], error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) store_mirror(&of[i], &band[i]);
  for (; count > 1 && result == ABBE_OK; count = (count + 1) / 2) {
    band += count;
    for (size_t i = 0; i < (count + 1) / 2; i++) {
      of[i] = of[2 * i];
      if (2 * i + 1 < count) {
        const abbe_mirror_band a = of[2 * i];
        abbe_mirror_band_join(&a, &of[2 * i + 1], &of[i]);
      }
      store_mirror(&of[i], &band[i]);
    }
  }
  free(of);
  return result;
}

abbe_result abbe_camera_bands_fill(const abbe_scene *scene, const abbe_plan *plan,
                                   const abbe_spectral_tables *tables, abbe_camera_band *out,
                                   abbe_error *error) {
  const abbe_wavelengths *w = &tables->all;
  size_t levels;
  const size_t count = abbe_camera_bands_count(w->count, &levels);
  abbe_weights_range light;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), w->edge_nm[0],
                             w->edge_nm[w->count], &light);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i]];
    for (int set = 0; set < ABBE_CAMERA_BAND_SETS && result == ABBE_OK; set++, out += count) {
      if (plan->mirror[i])
        result = fill_mirror(object, tables->mirror + i * w->count, tables, &light, out, error);
      else if (set == 0)
        fill_first(tables, i, out);
      else
        result = fill_share(tables, &light, object, set - 1, out, error);
    }
  }
  return result;
}
