#include "gl/scene/spectra/band_attenuation.h"

#include "colorimetry/weights.h"

#include <math.h>

enum { STEPS = 12, FEW_NODES = 16 };

/* Light through a material. */
typedef struct passage {
  const abbe_weights_range *light;
  const abbe_object *object;
  double path_m; /* usual inside */
} passage;

/* What attenuates as the part does over the usual path, the light's X + Y + Z together: a mean of
 * attenuations would take too much from light of a long path. And the part's Y. */
static double attenuation_of(const passage *p, double from, double to, double *y) {
  double weight[STEPS], per_m[STEPS], total = 0, left = 0, least = INFINITY;
  *y = 0;
  for (int k = 0; k < STEPS; k++) {
    const double a = from + (to - from) * k / STEPS, b = from + (to - from) * (k + 1) / STEPS;
    double xyz[3];
    abbe_weights_range_xyz(p->light, a, b, xyz);
    weight[k] = xyz[0] + xyz[1] + xyz[2];
    per_m[k] = abbe_material_attenuation(p->object->material, 0.5 * (a + b)) +
               abbe_medium_scattering(p->object->medium, 0.5 * (a + b));
    total += weight[k];
    *y += xyz[1];
  }
  for (int k = 0; k < STEPS; k++)
    if (total == 0 || weight[k] > 0) least = fmin(least, per_m[k]);
  for (int k = 0; k < STEPS; k++)
    left += (total > 0 ? weight[k] / total : 1.0 / STEPS) * exp(-p->path_m * (per_m[k] - least));
  return least - log(left) / p->path_m;
}

static void fill_half(const passage *p, size_t parts, double from, double to, abbe_band_half *out) {
  double y[ABBE_HALF_PARTS] = {0}, total = 0;
  for (size_t k = 0; k < parts; k++) {
    const double a = from + (to - from) * (double)k / (double)parts;
    const double b = from + (to - from) * (double)(k + 1) / (double)parts;
    out->attenuation[k] = (float)fmin(attenuation_of(p, a, b, &y[k]), ABBE_BAND_MOST_PER_M);
    total += y[k];
  }
  for (size_t k = 0; k < ABBE_HALF_PARTS; k++) {
    if (k >= parts) out->attenuation[k] = out->attenuation[0];
    out->share[k] = (float)(total > 0 ? y[k] / total : k < parts ? 1.0 / (double)parts : 0);
  }
}

/* Of few wavelengths halves are wide: as wide as the parts of more. */
static size_t parts_of(const abbe_wavelengths *w) {
  return w->count <= FEW_NODES ? ABBE_HALF_PARTS : 1;
}

static void fill_node(const passage *p, const abbe_wavelengths *w, size_t i, abbe_node_bands *out) {
  const size_t parts = parts_of(w);
  const bool one = w->count == 1; /* its band is laid as one half */
  const double node = w->lambda_nm[i], above = w->edge_nm[i + 1];
  fill_half(p, parts, w->edge_nm[i], one ? above : node, &out->below);
  fill_half(p, parts, one ? w->edge_nm[i] : node, above, &out->above);
}

abbe_node_bands *abbe_band_attenuation_fill(const abbe_scene *scene, const abbe_plan *plan,
                                            const abbe_wavelengths *w, abbe_node_bands *out) {
  for (size_t light = 0; light < plan->light_view_count; light++) {
    abbe_weights_range range;
    abbe_weights_range_make_by(plan->desc.observer, &scene->light[light].illuminant,
                               w->edge_nm[0], w->edge_nm[w->count], &range);
    for (size_t k = 0; k < plan->refractor_count; k++) {
      const abbe_object *object = &scene->object[plan->refractor_object[k]];
      double square = 0;
      for (int x = 0; x < 3; x++) square += pow(object->max[x] - object->min[x], 2);
      const passage p = {&range, object, fmax(0.5 * sqrt(square), 1e-12)};
      for (size_t i = 0; i < w->count; i++) fill_node(&p, w, i, out++);
    }
  }
  return out;
}
