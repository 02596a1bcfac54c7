#include "gl/plan/examine/path_limits.h"

#include "base/number.h"
#include "gl/plan/examine/inner_light.h"

#include <math.h>

enum { MULTI_REFRACTOR_SLOTS = 16 };

/* Mesa 22's llvmpipe ends every loop of a thread after 65535 turns of any loops, and a thread may
 * follow all wavelengths. */
static size_t eye_exits(const abbe_plan *plan) {
  const size_t most = 32768 / plan->desc.wavelengths;
  return most < ABBE_PLAN_EYE_EXITS ? most : ABBE_PLAN_EYE_EXITS;
}

void abbe_path_limits_choose(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan) {
  const bool thesis = abbe_profile_is_published(plan->desc.profile);
  char inside[64] = "";
  /* What a view's layers do not show is missed more with every reflection: fewer are worth it. */
  if (thesis || plan->desc.exits == 0)
    plan->desc.exits = thesis ? 1 : plan->layers ? ABBE_PLAN_LAYER_EXITS : ABBE_PLAN_EXITS;
  if (plan->convex && plan->refractor_count == 1 && !plan->multi_refractor_paths &&
      abbe_plan_no_refraction(plan) == NULL)
    abbe_number_format(inside, sizeof inside, "; %.2g %% of it is still inside then",
                       100 * abbe_inner_light_plan(scene, asked, plan));
  /* Layers show less and less of what is inside; and who asks for few exits sees them. A smaller
   * share brings multi-refractor paths nothing that what is left does not show. */
  const bool few = asked != NULL && asked->exits > 0 && asked->exits < ABBE_PLAN_EXITS;
  const bool eye_goes_on = !thesis && !plan->layers && !few;
  plan->eye_exits = eye_goes_on ? eye_exits(plan) : plan->desc.exits;
  plan->eye_share = plan->desc.energy_share;
  if (!plan->multi_refractor_paths) plan->eye_share = fmin(plan->eye_share, ABBE_PLAN_EYE_SHARE);
  plan->hit_slots =
      plan->multi_refractor_paths ? MULTI_REFRACTOR_SLOTS : plan->desc.exits + (thesis ? 0 : 1);
  if (abbe_plan_no_refraction(plan) != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS, "%s", abbe_plan_no_refraction(plan));
  else if (plan->desc.exits == 1)
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS, "two interfaces only, as %s%s",
                  abbe_profile_is_thesis(plan->desc.profile) ? "in the thesis"
                  : thesis                                   ? "published"
                                                             : "asked",
                  inside);
  else
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS,
                  "followed until less than %g of the light is left, %zu exits at most%s",
                  plan->desc.energy_share, plan->desc.exits, inside);
}
