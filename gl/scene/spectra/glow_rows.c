/* Which rows of a re-radiation matrix the light excites that comes to a refractor's middle. */
#include "gl/scene/spectra/band_parts.h"
#include "gl/scene/spectra/camera_bands.h"

#include "base/maths.h"
#include "colorimetry/weights.h"

#include <math.h>

/* Photons of each row by light of that irradiance, in the measure in which it has Y = 1. */
static void add_light(const abbe_plan *plan, const abbe_object *o,
                      const abbe_illuminant *illuminant, double irradiance, double *weight) {
  const abbe_material *m = o->material;
  const double first = plan->desc.min_nm, last = plan->desc.max_nm, path_m = abbe_usual_path(o);
  double y = 0;
  for (int adds = 0; adds < 2; adds++)
    for (double nm = ceil(first - 0.5); nm < last + 0.5; nm += 1) {
      const double from = fmax(nm - 0.5, first), to = fmin(nm + 0.5, last);
      const double watts = abbe_weights_band_power(illuminant, first, last, from, to);
      const double taken = 1 - exp(-path_m * abbe_material_attenuation(m, nm));
      double xyz[3];
      abbe_observer_xyz_of(plan->desc.observer, nm, xyz);
      if (adds == 0) y += watts * xyz[1];
      for (size_t r = 0; adds == 1 && r < abbe_material_glow_rows(m); r++)
        weight[r] += irradiance / fmax(y, 1e-300) * watts * nm * taken *
                     abbe_material_excites(m, nm) * abbe_material_row_yield(m, r, nm);
    }
}

void abbe_glow_rows_weigh(const abbe_scene *scene, const abbe_plan *plan, const abbe_object *o,
                          double *weight) {
  const size_t rows = abbe_material_glow_rows(o->material);
  double middle[3], sum = 0;
  for (int c = 0; c < 3; c++) middle[c] = 0.5 * (o->min[c] + o->max[c]);
  for (size_t r = 0; r < rows; r++) weight[r] = 0;
  for (size_t i = 0; rows > 1 && i < plan->light_view_count; i++) {
    if (plan->light_view[i].light != i) continue; /* one more face of a cube */
    const abbe_light *l = &scene->light[i];
    double to[3], irradiance = l->power;
    abbe_vector_subtract(middle, l->position, to);
    const double away = abbe_vector_length(to);
    if (l->kind != ABBE_LIGHT_DIRECTIONAL) {
      abbe_vector_normalise(to);
      irradiance *= abbe_light_profile(l, to) / fmax(away * away, 1e-30);
    }
    add_light(plan, o, &l->illuminant, irradiance, weight);
  }
  if (rows > 1) /* a ball meets four times what a face does */
    add_light(plan, o, abbe_scene_illuminant(scene), 4 * scene->ambient, weight);
  for (size_t r = 0; r < rows; r++) sum += weight[r];
  for (size_t r = 0; r < rows; r++) weight[r] = sum > 0 ? weight[r] / sum : 1 / (double)rows;
}
