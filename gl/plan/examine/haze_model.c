#include "gl/plan/examine/haze_model.h"

#include "colorimetry/weights.h"

#include <math.h>

enum { STEPS = 80 };

/* A medium, or a refractor with what is in it. */
typedef struct region {
  const abbe_medium *medium; /* NULL: clear */
  const abbe_object *object; /* NULL: the air */
} region;

static double scattering_at(const region *r, double nm) {
  return abbe_medium_scattering(r->medium, nm);
}

static double absorption_at(const region *r, double nm) {
  return abbe_medium_absorption(r->medium, nm) +
         (r->object != NULL ? abbe_material_attenuation(r->object->material, nm) : 0);
}

/* Half of its diagonal. */
static double size_of(const region *r) {
  const double *min = r->object != NULL ? r->object->min : r->medium->min;
  const double *max = r->object != NULL ? r->object->max : r->medium->max;
  double square = 0;
  for (int k = 0; k < 3; k++) square += (max[k] - min[k]) * (max[k] - min[k]);
  return 0.5 * sqrt(square);
}

/* Means by Y. */
static void fill_means(const region *r, const abbe_weights_range *range, double step,
                       abbe_plan_haze *out) {
  double total = 0;
  for (int i = 0; i < STEPS; i++) {
    double xyz[3];
    const double from = range->min_nm + i * step, at = from + 0.5 * step;
    abbe_weights_range_xyz(range, from, from + step, xyz);
    const double weight = xyz[1] + 1e-9;
    out->scattering += weight * scattering_at(r, at);
    out->absorption += weight * absorption_at(r, at);
    total += weight;
  }
  out->scattering /= total;
  out->absorption /= total;
}

/* Of each primary what it loses of white light on a usual way: as far as light goes, within the
 * region. */
static void fill_colours(const region *r, const abbe_weights_range *range, double step,
                         abbe_rgb_space space, abbe_plan_haze *out) {
  const double mean = out->scattering + out->absorption;
  const double way = fmax(fmin(size_of(r), mean > 0 ? 1 / mean : INFINITY), 1e-9);
  double matrix[9], white[3] = {0}, left[3] = {0}, scattered[3] = {0};
  abbe_rgb_space_from_xyz(space, matrix);
  for (int i = 0; i < STEPS; i++) {
    double xyz[3], rgb[3];
    const double from = range->min_nm + i * step, at = from + 0.5 * step;
    const double scattering = scattering_at(r, at), takes = scattering + absorption_at(r, at);
    abbe_weights_range_xyz(range, from, from + step, xyz);
    abbe_rgb_space_apply(matrix, xyz, rgb);
    for (int k = 0; k < 3; k++) {
      white[k] += rgb[k];
      scattered[k] += rgb[k] * scattering;
      left[k] += rgb[k] * exp(-takes * way);
    }
  }
  for (int k = 0; k < 3; k++) {
    const bool told = white[k] > 0 && left[k] > 1e-6 * white[k];
    out->scatters[k] = white[k] > 0 ? fmax(scattered[k] / white[k], 0) : out->scattering;
    out->takes[k] = told ? fmax(-log(left[k] / white[k]) / way, 0) : mean;
  }
}

/* Under the first light, or the environment. */
static abbe_plan_haze haze_of(const abbe_scene *scene, const abbe_plan *plan, const region *r) {
  const double min = plan->desc.min_nm, max = plan->desc.max_nm, step = (max - min) / STEPS;
  abbe_plan_haze out = {0};
  if (r->medium == NULL && r->object == NULL) return out;
  abbe_weights_range range;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), min, max, &range);
  fill_means(r, &range, step, &out);
  fill_colours(r, &range, step, plan->desc.space, &out);
  out.g = r->medium != NULL ? r->medium->g : 0;
  return out;
}

/* The first refractor whose medium the camera may look into through its surface, or see mirrored in
 * it: light comes there by photons alone. */
static void choose_shafts(const abbe_scene *scene, abbe_plan *plan) {
  if (!plan->caustics || !plan->camera_sees_refractor || !plan->multi_refractor_paths) return;
  for (size_t i = 0; i < plan->refractor_count && !plan->shafts; i++) {
    const region r = {.object = &scene->object[plan->refractor_object[i]],
                      .medium = scene->object[plan->refractor_object[i]].medium};
    if (r.medium == NULL || plan->mirror[i]) continue;
    plan->shafts = true;
    plan->shaft_refractor = i;
    plan->shaft_haze = haze_of(scene, plan, &r);
  }
}

void abbe_haze_model_choose(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *around = abbe_scene_around_eye(scene);
  plan->hazy = abbe_scene_is_hazy(scene);
  if (!plan->hazy) return;
  plan->eye_in_air = around == NULL;
  const region air = {.medium = scene->medium};
  plan->air_haze = haze_of(scene, plan, &air);
  plan->eye_haze = plan->air_haze;
  choose_shafts(scene, plan);
  if (around == NULL) return;
  const region eye = {.medium = around->medium, .object = around};
  plan->eye_haze = haze_of(scene, plan, &eye);
}

void abbe_haze_model_note(const abbe_scene *scene, abbe_plan *plan) {
  if (!plan->hazy) return;
  abbe_plan_add(plan, ABBE_PASS_EYE_HAZE, "%s scatters %.3g of light a metre towards the eye",
                plan->eye_in_air ? "the air" : "what the eye is in", plan->eye_haze.scattering);
  if (plan->shafts)
    abbe_plan_add(plan, ABBE_PASS_SHAFTS,
                  "bent and mirrored rays of the camera may run through the medium of '%.40s'",
                  scene->object[plan->refractor_object[plan->shaft_refractor]].name);
  abbe_plan_note(
      plan, plan->shafts ? "haze scatters light once; seen in a mirror, or behind a refractor that "
                           "is clear, it is left out"
                         : "haze scatters light once, and on the eye's own ray up to what it meets "
                           "first: what is scattered behind a refractor or seen in a mirror is "
                           "left out");
  if (plan->caustics)
    abbe_plan_note(plan, "light from refractors is seen in haze from its last interface as far as "
                         "it lands on a receiver");
  if (plan->surrounded)
    abbe_plan_note(plan, "haze scatters the environment's lights, and not the rest of it");
  const bool coloured =
      abbe_medium_is_coloured(scene->medium, plan->desc.min_nm, plan->desc.max_nm);
  if (coloured || (!plan->eye_in_air && plan->tinting))
    abbe_plan_note(plan,
                   "haze is as for its mean over wavelengths under the first light: on the eye's "
                   "ray for each of red, green and blue, on light's way in the air for all");
}
