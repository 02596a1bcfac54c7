#include "gl/plan/everything.h"

#include "scenes/view/view.h"

#include <stdio.h>
#include <string.h>

/* Whether one view of the light holds all refractors. */
static bool holds_refractors(const abbe_scene *scene, const abbe_light *light,
                             const abbe_plan *plan) {
  static const double up[3] = {0, 1, 0};
  double min[3], max[3], forward[3];
  bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL, all = true;
  abbe_view view;
  abbe_scene_bounds(scene, true, false, min, max);
  for (int k = 0; k < 3; k++)
    forward[k] = sun ? light->direction[k] : 0.5 * (min[k] + max[k]) - light->position[k];
  abbe_view_look(sun ? min : light->position, forward, up, sun, &view);
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_mesh *mesh = &scene->object[plan->refractor_object[i]].mesh;
    all = abbe_view_fit(&view, (const double(*)[3])mesh->position, mesh->vertex_count) && all;
  }
  return sun || all;
}

static void say(abbe_plan *plan, const char *name) {
  for (size_t i = 0; i < plan->entry_count; i++) {
    abbe_plan_entry *entry = &plan->entry[i];
    if (strcmp(entry->name, name) != 0 || entry->runs) continue;
    entry->runs = true;
    snprintf(entry->reason, sizeof entry->reason, "no fact asks for it: switched on, as asked");
  }
}

static void rewrite(abbe_plan *plan, const char *name, size_t count, const char *what) {
  for (size_t i = 0; i < plan->entry_count; i++) {
    abbe_plan_entry *entry = &plan->entry[i];
    if (strcmp(entry->name, name) != 0) continue;
    entry->runs = true;
    snprintf(entry->reason, sizeof entry->reason, "%zu %s: everything is switched on, as asked",
             count, what);
  }
}

static void switch_refraction_on(const abbe_scene *scene, const abbe_render_desc *asked,
                                 abbe_plan *plan) {
  static const char *const passes[] = {"light: refractor front",  "light: refractor back",
                                       "light: photon placement", "maps on receivers",
                                       "light: photons",          "light: spectral map",
                                       "light: gap fill",         "absorption",
                                       "eye: refractor front",    "eye: refractor back",
                                       "eye: refraction",         "inner reflections"};
  for (size_t i = 0; i < scene->light_count; i++) {
    char name[64];
    if (!plan->reaches[i] && !holds_refractors(scene, &scene->light[i], plan)) continue;
    plan->reaches[i] = plan->caustics = true;
    snprintf(name, sizeof name, "map: %.50s", scene->light[i].name);
    say(plan, name);
  }
  plan->seen = plan->back = plan->absorbing = true;
  plan->pages = plan->caustics && plan->receiver_count > 0;
  if (plan->desc.wavelengths < 7 && (asked == NULL || asked->wavelengths == 0)) {
    plan->desc.wavelengths = 7;
    rewrite(plan, "wavelengths", 7, "wavelengths");
    rewrite(plan, "light: photons", 7, "wavelengths");
  }
  plan->fills = plan->desc.fill != ABBE_FILL_NONE && plan->desc.wavelengths > 1;
  if (!plan->walk && (asked == NULL || asked->orders == 0)) {
    plan->slots += ABBE_RENDER_MAX_ORDERS - plan->desc.orders;
    plan->desc.orders = ABBE_RENDER_MAX_ORDERS;
    if (plan->eye_exits < plan->desc.orders) plan->eye_exits = plan->desc.orders;
    rewrite(plan, "inner reflections", plan->desc.orders, "exits at most");
  }
  for (size_t i = 0; i < sizeof passes / sizeof *passes; i++)
    if ((plan->fills || strcmp(passes[i], "light: gap fill") != 0) &&
        (plan->pages || strcmp(passes[i], "maps on receivers") != 0))
      say(plan, passes[i]);
}

void abbe_everything_switch_on(const abbe_scene *scene, const abbe_render_desc *asked,
                               abbe_plan *plan) {
  if (abbe_profile_is_thesis(plan->desc.profile)) return;
  plan->receiver_shadows = plan->textured = true;
  say(plan, "shadows of receivers");
  say(plan, "textures");
  if (plan->refractor_count > 0) switch_refraction_on(scene, asked, plan);
}
