#include "gl/scene/spectra/band_attenuation.h"

#include "gl/scene/spectra/band_parts.h"

#include <math.h>
#include <stdlib.h>

/* Of a step, nm, and the least of a part. */
#define STEP_NM 2.5
enum { LEAST_STEPS = 2, NODE_PARTS = 2 * ABBE_HALF_PARTS };

size_t abbe_band_attenuation_texels(const abbe_plan *plan, size_t nodes) {
  return 2 * nodes * (plan->refractor_count + plan->light_view_count);
}

/* Where part k of node i begins and ends: of one node, both halves are the whole band. */
static void place(const abbe_wavelengths *w, size_t i, size_t k, double range[2]) {
  const bool one = w->count == 1, above = k >= ABBE_HALF_PARTS;
  const double from = above && !one ? w->lambda_nm[i] : w->edge_nm[i];
  const double to = above || one ? w->edge_nm[i + 1] : w->lambda_nm[i];
  const double step = (to - from) / ABBE_HALF_PARTS;
  range[0] = from + step * (double)(k % ABBE_HALF_PARTS);
  range[1] = range[0] + step;
}

static void fill_shares(const abbe_weights_range *light, const abbe_wavelengths *w, size_t i,
                        float (*out)[4]) {
  for (size_t half = 0; half < 2; half++) {
    double y[ABBE_HALF_PARTS], total = 0;
    for (size_t k = 0; k < ABBE_HALF_PARTS; k++) {
      double range[2], xyz[3];
      place(w, i, half * ABBE_HALF_PARTS + k, range);
      abbe_weights_range_xyz(light, range[0], range[1], xyz);
      total += y[k] = xyz[1];
    }
    for (size_t k = 0; k < ABBE_HALF_PARTS; k++)
      out[half][k] = (float)(total > 0 ? y[k] / total : 1.0 / ABBE_HALF_PARTS);
  }
}

/* What a surface takes of a part, that of a node: attenuation, 1/m, or the factor of a mirror. */
static abbe_result surface_of(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                              const abbe_band_steps *steps, double node_nm, float *out,
                              abbe_error *error) {
  const abbe_object *object = &scene->object[plan->refractor_object[r]];
  const abbe_band_share part = {0, steps->count, NULL, NULL, 0};
  const double depth = abbe_band_share_depth(steps, &part, r);
  double n = 0, k = -1;
  abbe_result result = ABBE_OK;
  if (plan->mirror[r] && object->conductor != NULL)
    result = abbe_material_nk(object->conductor, node_nm, &n, &k, error);
  *out =
      (float)(plan->mirror[r] ? abbe_mirror_factor(n, k, exp(-depth)) : depth / steps->path_m[r]);
  return result;
}

/* The steps of a part serve all of them in turn. */
static abbe_result fill_node(const abbe_scene *scene, const abbe_plan *plan,
                             const abbe_wavelengths *w, size_t i, const abbe_weights_range *light,
                             abbe_band_steps *steps, float (*out)[4], abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t k = 0; k < NODE_PARTS && result == ABBE_OK; k++) {
    double range[2];
    place(w, i, k, range);
    result =
        abbe_band_steps_fill(steps, scene, plan, light, 0, steps->count, range[0], range[1], error);
    for (size_t r = 0; r < plan->refractor_count && result == ABBE_OK; r++)
      result = surface_of(scene, plan, r, steps, w->lambda_nm[i],
                          &out[2 * r + k / ABBE_HALF_PARTS][k % ABBE_HALF_PARTS], error);
  }
  return result;
}

abbe_result abbe_band_attenuation_fill(const abbe_scene *scene, const abbe_plan *plan,
                                       const abbe_wavelengths *w, float (*out)[4],
                                       abbe_error *error) {
  const double part_nm = (w->edge_nm[w->count] - w->edge_nm[0]) / (double)(w->count * NODE_PARTS);
  const size_t count = (size_t)fmax(ceil(part_nm / STEP_NM), LEAST_STEPS);
  abbe_weights_range light;
  abbe_band_steps steps;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), w->edge_nm[0],
                             w->edge_nm[w->count], &light);
  abbe_result result = abbe_band_steps_make(scene, plan, count, &steps, error);
  for (size_t i = 0; i < w->count && result == ABBE_OK; i++, out += 2 * plan->refractor_count)
    result = fill_node(scene, plan, w, i, &light, &steps, out, error);
  abbe_band_steps_free(&steps);
  for (size_t k = 0; k < plan->light_view_count && result == ABBE_OK; k++) {
    abbe_weights_range_make_by(plan->desc.observer, &scene->light[k].illuminant, w->edge_nm[0],
                               w->edge_nm[w->count], &light);
    for (size_t i = 0; i < w->count; i++, out += 2) fill_shares(&light, w, i, out);
  }
  return result;
}
