/* Attenuation in parts of the wavelengths' bands, for landings that keep the length of their way
 * inside: what is left of a band follows from it, and not from its node alone. */
#include "gl/photons/photon_spectra.h"

#include "colorimetry/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 4, STEPS = 12, FEW_NODES = 16 };

/* Opaque, and no float overflows. */
static const double most_per_m = 1e30;

typedef struct band_half {
  float attenuation[PARTS]; /* 1/m */
  float share[PARTS];       /* of the half's Y */
} band_half;

typedef struct node_bands {
  band_half below, above; /* the node */
} node_bands;

/* Light through a material. */
typedef struct passage {
  const abbe_illuminant *illuminant;
  const abbe_material *material;
  double min_nm, max_nm;
  double way_m; /* usual inside */
} passage;

/* What attenuates as the part does over the usual way, the light's X + Y + Z together: a mean of
 * attenuations would take too much from light of a long way. And the part's Y. */
static double attenuation_of(const passage *p, double from, double to, double *y) {
  double weight[STEPS], per_m[STEPS], total = 0, left = 0, least = INFINITY;
  *y = 0;
  for (int k = 0; k < STEPS; k++) {
    const double a = from + (to - from) * k / STEPS, b = from + (to - from) * (k + 1) / STEPS;
    double xyz[3];
    abbe_weights_band_xyz(p->illuminant, p->min_nm, p->max_nm, a, b, xyz);
    weight[k] = xyz[0] + xyz[1] + xyz[2];
    per_m[k] = abbe_material_attenuation(p->material, 0.5 * (a + b));
    total += weight[k];
    *y += xyz[1];
  }
  for (int k = 0; k < STEPS; k++)
    if (total == 0 || weight[k] > 0) least = fmin(least, per_m[k]);
  for (int k = 0; k < STEPS; k++)
    left += (total > 0 ? weight[k] / total : 1.0 / STEPS) * exp(-p->way_m * (per_m[k] - least));
  return least - log(left) / p->way_m;
}

static void fill_half(const passage *p, size_t parts, double from, double to, band_half *out) {
  double y[PARTS] = {0}, total = 0;
  for (size_t k = 0; k < parts; k++) {
    const double a = from + (to - from) * (double)k / (double)parts;
    const double b = from + (to - from) * (double)(k + 1) / (double)parts;
    out->attenuation[k] = (float)fmin(attenuation_of(p, a, b, &y[k]), most_per_m);
    total += y[k];
  }
  for (size_t k = 0; k < PARTS; k++) {
    if (k >= parts) out->attenuation[k] = out->attenuation[0];
    out->share[k] = (float)(total > 0 ? y[k] / total : k < parts ? 1.0 / (double)parts : 0);
  }
}

/* Of few wavelengths halves are wide: as wide as the parts of more. */
static size_t parts_of(const abbe_wavelengths *w) {
  return w->count <= FEW_NODES ? PARTS : 1;
}

static void fill_node(const passage *p, const abbe_wavelengths *w, size_t i, node_bands *out) {
  const size_t parts = parts_of(w);
  const bool one = w->count == 1; /* its band is laid as one half */
  const double node = w->lambda_nm[i], above = w->edge_nm[i + 1];
  fill_half(p, parts, w->edge_nm[i], one ? above : node, &out->below);
  fill_half(p, parts, one ? w->edge_nm[i] : node, above, &out->above);
}

static void fill_bands(const abbe_photon_spectra *spectra, const abbe_wavelengths *w,
                       node_bands *out) {
  for (size_t light = 0; light < spectra->scene->plan->light_view_count; light++)
    for (size_t k = 0; k < spectra->scene->plan->refractor_count; k++) {
      const abbe_object *object =
          &spectra->scene->local->object[spectra->scene->plan->refractor_object[k]];
      double square = 0;
      for (int x = 0; x < 3; x++) square += pow(object->max[x] - object->min[x], 2);
      const passage p = {&spectra->scene->local->light[light].illuminant, object->material,
                         w->edge_nm[0], w->edge_nm[w->count], fmax(0.5 * sqrt(square), 1e-12)};
      for (size_t i = 0; i < w->count; i++) fill_node(&p, w, i, out++);
    }
}

abbe_result abbe_photon_attenuation_upload(abbe_photon_spectra *spectra,
                                           const abbe_wavelengths *coarse,
                                           const abbe_wavelengths *all, abbe_error *error) {
  if (!spectra->scene->plan->lengths) return ABBE_OK;
  const bool refines = coarse->count < all->count;
  const size_t rows =
      spectra->scene->plan->light_view_count * spectra->scene->plan->refractor_count;
  const size_t nodes = coarse->count + (refines ? all->count : 0);
  node_bands *table = calloc(rows * nodes + 1, sizeof *table);
  if (table == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for attenuation");
  fill_bands(spectra, coarse, table);
  if (refines) fill_bands(spectra, all, table + rows * coarse->count);
  const size_t size = rows * nodes * sizeof *table;
  abbe_result result = ABBE_OK;
  if (spectra->attenuation == 0) {
    result = abbe_gpu_make_buffer(spectra->scene->gpu, size, table, &spectra->attenuation, error);
  } else { /* never larger than at first */
    spectra->scene->gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, spectra->attenuation);
    spectra->scene->gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, table);
  }
  free(table);
  return result;
}

size_t abbe_photon_signature_bytes(const abbe_photon_spectra *spectra) {
  return spectra->scene->plan->lengths ? 8 : 4;
}

void abbe_photon_attenuate(const abbe_photon_spectra *spectra, size_t first, size_t lanes,
                           size_t count, float *hit, GLuint *signature) {
  if (!spectra->scene->plan->lengths) return;
  for (size_t i = 0; i < count; i++) {
    const GLuint path = signature[2 * i], refractor = path & 255u;
    const size_t node = first + i % lanes;
    float way_m = 0;
    memcpy(&way_m, &signature[2 * i + 1], sizeof way_m);
    signature[i] = path;
    if (path == 0 || refractor >= spectra->scene->plan->refractor_count ||
        node >= spectra->scene->plan->desc.wavelengths)
      continue;
    const abbe_material *material =
        spectra->scene->local->object[spectra->scene->plan->refractor_object[refractor]].material;
    const double per_m = abbe_material_attenuation(material, spectra->scene->lambda_nm[node]);
    hit[4 * i + 3] *= (float)exp(-per_m * (double)way_m);
  }
}
