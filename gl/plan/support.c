#include "gl/plan/support.h"

#include "scenes/geometry/vector.h"

abbe_result abbe_support_published(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error) {
  ABBE_REQUIRE(scene && plan, error);
  const char *profile = abbe_profile_name(plan->desc.profile);
  const bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  if (!abbe_profile_is_published(plan->desc.profile)) return ABBE_OK;
  if (scene->environment != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile knows no environment; this scene has one", profile);
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (!abbe_light_has_size(light)) continue;
    const double area = abbe_light_area(light);
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the light '%s' is a %s, and the %s profile's lights have no size; take the default "
        "profile, trace the scene, or make it a point or spot light of %.6g W/sr, which is what it "
        "sends along its normal",
        light->name, light->kind == ABBE_LIGHT_DISK ? "disk" : "rectangle", profile,
        light->points > 0 ? light->power * (double)light->points : light->power * area);
  }
  if (scene->light_count != 1)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile knows one light; this scene has %zu", profile,
                          scene->light_count);
  const bool rays = thesis || abbe_profile_is_wyman2006(plan->desc.profile);
  if (rays && scene->light[0].kind == ABBE_LIGHT_DIRECTIONAL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile knows point and spot lights; '%s' is directional",
                          profile, scene->light[0].name);
  if (plan->refractor_count == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the %s profile needs a refractor; this scene has none", profile);
  for (size_t i = 1; thesis && i < plan->refractor_count; i++)
    if (scene->object[plan->refractor_object[i]].material !=
        scene->object[plan->refractor_object[0]].material)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the %s profile knows one material; this scene has several", profile);
  return ABBE_OK;
}

/* A layout belongs to where its light is. */
static bool looks_from(const abbe_view *view, const abbe_light *light) {
  const bool directional = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double apart[3];
  if (view->orthographic != directional) return false;
  abbe_vector_subtract(directional ? view->forward : view->origin,
                       directional ? light->direction : light->position, apart);
  return abbe_vector_length(apart) <= 1e-6 * (directional ? 1 : view->near);
}

abbe_result abbe_support_layout(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  ABBE_REQUIRE(scene && plan, error);
  const abbe_map_layout *layout = plan->desc.map_layout;
  const size_t index = plan->desc.map_layout_light;
  if (layout == NULL) return ABBE_OK;
  if (index >= scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the map layout is for light %zu; the scene has %zu", index + 1,
                          scene->light_count);
  if (abbe_profile_is_published(plan->desc.profile))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the %s profile lays its map out by the light's cone; a given layout "
                          "goes with the default profile",
                          abbe_profile_name(plan->desc.profile));
  if (plan->refractor_count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the scene has no refractor, so there is no map to lay out");
  if (!looks_from(&layout->view, &scene->light[index]))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the map layout was made for a light in another place than '%s'; take "
                          "the map of that very light",
                          scene->light[index].name);
  return abbe_map_layout_check(layout, error);
}

abbe_result abbe_support_mirrors(const abbe_scene *scene, const abbe_plan *plan,
                                 abbe_error *error) {
  ABBE_REQUIRE(scene && plan, error);
  const abbe_object *mirror = abbe_scene_mirror(scene);
  const bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  if (mirror == NULL || (!thesis && plan->desc.model != ABBE_MODEL_LAYERS)) return ABBE_OK;
  if (thesis)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the object '%s' (line %zu) is a mirror, and the %s profile follows no "
                          "light off mirrors; leave it out, or take the default profile",
                          mirror->name, mirror->line, abbe_profile_name(plan->desc.profile));
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the object '%s' (line %zu) is a mirror, and the model 'layers' follows no "
                        "light off mirrors; leave it out, or take the model 'hierarchy'",
                        mirror->name, mirror->line);
}
