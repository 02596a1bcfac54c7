#include "library/choice/matched_physics.h"

#include "gl/plan/plan.h"

abbe_result abbe_matched_physics(const abbe_scene *scene, double min_nm, double max_nm,
                                 abbe_physics *out, abbe_error *error) {
  abbe_plan plan;
  const abbe_render_desc desc = {.min_nm = min_nm, .max_nm = max_nm};
  abbe_result result = abbe_plan_make(scene, &desc, &plan, error);
  if (result != ABBE_OK) return result;
  *out = (abbe_physics){.matched = true,
                        .orders = plan.desc.exits,
                        .energy_share = plan.desc.energy_share,
                        .eye_orders = plan.eye_exits,
                        .eye_share = plan.eye_share};
  abbe_plan_free(&plan);
  return ABBE_OK;
}
