#include "gl/plan/no_culling.h"

#include "gl/plan/examine/light_views.h"

#include <stdio.h>

/* What runs by now and did not. */
static void list_again(abbe_plan *plan) {
  for (size_t i = 0; i < plan->entry_count; i++) {
    abbe_plan_entry *entry = &plan->entry[i];
    if (entry->runs || !abbe_plan_runs(plan, entry->item, entry->index)) continue;
    entry->runs = true;
    snprintf(entry->reason, sizeof entry->reason, "no fact asks for it: switched on, as asked");
  }
}

static void rewrite(abbe_plan *plan, abbe_plan_item item, size_t count, const char *what) {
  for (size_t i = 0; i < plan->entry_count; i++) {
    abbe_plan_entry *entry = &plan->entry[i];
    if (entry->item != item) continue;
    entry->runs = true;
    snprintf(entry->reason, sizeof entry->reason, "%zu %s: everything is switched on, as asked",
             count, what);
  }
}

static void switch_refraction_on(const abbe_scene *scene, const abbe_render_desc *asked,
                                 abbe_plan *plan) {
  abbe_view view;
  for (size_t i = 0; i < scene->light_count; i++)
    if (plan->reaches[i] || abbe_light_views_fit(scene, &scene->light[i], plan, &view, NULL))
      plan->reaches[i] = plan->caustics = true;
  plan->camera_sees_refractor = plan->draw_back = plan->absorbing = true;
  plan->tiles = plan->caustics && plan->receiver_count > 0;
  if (plan->desc.wavelengths < 7 && (asked == NULL || asked->wavelengths == 0)) {
    plan->desc.wavelengths = 7;
    rewrite(plan, ABBE_CHOICE_WAVELENGTHS, 7, "wavelengths");
    rewrite(plan, ABBE_PASS_PHOTONS, 7, "wavelengths");
  }
  plan->receiver_colours = plan->caustics && !plan->volume && plan->receiver_count > 0;
  plan->fills = plan->desc.fill != ABBE_FILL_NONE && plan->desc.wavelengths > 1;
  if (!plan->multi_refractor_paths && (asked == NULL || asked->exits == 0)) {
    plan->hit_slots += ABBE_RENDER_MAX_EXITS - plan->desc.exits;
    plan->desc.exits = ABBE_RENDER_MAX_EXITS;
    if (plan->eye_exits < plan->desc.exits) plan->eye_exits = plan->desc.exits;
    rewrite(plan, ABBE_CHOICE_INNER_REFLECTIONS, plan->desc.exits, "exits at most");
  }
}

void abbe_no_culling_apply(const abbe_scene *scene, const abbe_render_desc *asked,
                           abbe_plan *plan) {
  if (abbe_profile_is_published(plan->desc.profile)) return;
  plan->receiver_shadows = plan->textured = true;
  if (plan->refractor_count > 0) switch_refraction_on(scene, asked, plan);
  list_again(plan);
}
