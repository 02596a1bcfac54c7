#include "gl/plan/examine/haze_model.h"

#include "colorimetry/weights.h"

/* Means over the plan's range, by the Y of the first light, or of the environment. */
static abbe_plan_haze mean_of(const abbe_scene *scene, const abbe_plan *plan,
                              const abbe_medium *m) {
  enum { STEPS = 80 };
  const double min = plan->desc.min_nm, step = (plan->desc.max_nm - min) / STEPS;
  abbe_plan_haze out = {0};
  if (m == NULL) return out;
  abbe_weights_range range;
  double total = 0;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), min,
                             plan->desc.max_nm, &range);
  for (int i = 0; i < STEPS; i++) {
    double xyz[3];
    abbe_weights_range_xyz(&range, min + i * step, min + (i + 1) * step, xyz);
    const double weight = xyz[1] + 1e-9, at = min + (i + 0.5) * step;
    out.scattering += weight * abbe_medium_scattering(m, at);
    out.absorption += weight * abbe_medium_absorption(m, at);
    total += weight;
  }
  out.scattering /= total;
  out.absorption /= total;
  out.g = m->g;
  return out;
}

void abbe_haze_model_choose(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *around = abbe_scene_around_eye(scene);
  plan->hazy = abbe_scene_is_hazy(scene);
  if (!plan->hazy) return;
  plan->eye_in_air = around == NULL;
  plan->air_haze = mean_of(scene, plan, scene->medium);
  plan->eye_haze = plan->eye_in_air ? plan->air_haze : mean_of(scene, plan, around->medium);
}

void abbe_haze_model_note(const abbe_scene *scene, abbe_plan *plan) {
  if (!plan->hazy) return;
  abbe_plan_add(plan, ABBE_PASS_EYE_HAZE, "%s scatters %.3g of light a metre towards the eye",
                plan->eye_in_air ? "the air" : "what the eye is in", plan->eye_haze.scattering);
  abbe_plan_note(plan,
                 "haze scatters light once, and on the eye's own ray up to what it meets "
                 "first: what is scattered behind a refractor or seen in a mirror is left out");
  if (plan->caustics)
    abbe_plan_note(plan, "light from refractors is seen in haze as far as it lands on a receiver");
  if (plan->surrounded)
    abbe_plan_note(plan, "haze scatters the environment's lights, and not the rest of it");
  const abbe_object *around = abbe_scene_around_eye(scene);
  const double min = plan->desc.min_nm, max = plan->desc.max_nm;
  if (abbe_medium_is_coloured(scene->medium, min, max) ||
      (around != NULL && abbe_medium_is_coloured(around->medium, min, max)))
    abbe_plan_note(plan, "haze is as for its mean over wavelengths under the first light, on the "
                         "eye's ray and in the air");
}
