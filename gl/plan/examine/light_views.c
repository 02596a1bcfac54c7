#include "gl/plan/examine/light_views.h"

#include "gl/plan/examine/light_cube.h"
#include "gl/plan/examine/reach.h"

void abbe_light_views_reach(const abbe_scene *scene, abbe_plan *plan) {
  bool thesis = abbe_profile_is_published(plan->desc.profile);
  const bool lands = plan->receiver_count > 0 || abbe_scene_is_hazy(scene);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_object *object = &scene->object[plan->refractor_object[k]];
    for (size_t i = 0; i < scene->light_count && lands; i++)
      if (thesis || abbe_reach_light(&scene->light[i], object))
        plan->caustics = plan->reaches[i] = true;
    if (thesis || abbe_reach_eye(&scene->camera, plan->desc.width, plan->desc.height, object))
      plan->camera_sees_refractor = true;
  }
  for (size_t i = 0; i < scene->light_count && !plan->forward_transmission; i++)
    for (size_t k = 0; k < plan->refractor_count && plan->reaches[i] && !plan->forward_transmission;
         k++)
      for (size_t j = 0; j < plan->receiver_count && !plan->forward_transmission; j++)
        plan->forward_transmission =
            abbe_reach_through(&scene->light[i], &scene->object[plan->refractor_object[k]],
                               &scene->object[plan->receiver_object[j]]);
  if (plan->caustics || plan->camera_sees_refractor) return;
  plan->dispersive = plan->absorbing = plan->tinting = plan->colouring = false;
}

/* Receivers outside the view have tiles. */
static void find_aside(const abbe_scene *scene, abbe_plan *plan, abbe_view *view) {
  for (size_t k = 0; k < plan->receiver_count; k++) {
    const abbe_mesh *mesh = &scene->object[plan->receiver_object[k]].mesh;
    if (!abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count))
      plan->outside_map_view = true;
  }
}

/* What a mesh is inside is told by its layers, which no seam may cut. */
static abbe_result check_layers(const abbe_scene *scene, const abbe_plan *plan,
                                const abbe_light *light, int face, size_t refractor,
                                abbe_error *error) {
  const abbe_object *object = &scene->object[plan->refractor_object[refractor]];
  abbe_view view;
  if (plan->model[refractor] != ABBE_REFRACTOR_LAYERS) return ABBE_OK;
  abbe_light_cube_look(light->position, face, &view);
  if (abbe_view_fit(&view, (const double(*)[3])object->mesh.position, object->mesh.vertex_count))
    return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the light '%s' is so near to the refractor '%s' that no view holds its "
      "layers, 76 degrees to each side; ask for the model 'hierarchy', or move it "
      "away",
      light->name, object->name);
}

/* One view for each face of the cube through which light may reach a refractor; the first stands
 * in the light's own place. */
static abbe_result make_cube(const abbe_scene *scene, size_t light, abbe_plan *plan,
                             abbe_error *error) {
  const abbe_light *from = &scene->light[light];
  unsigned all = 0;
  bool first = true;
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const unsigned faces = abbe_light_cube_reached(from, &scene->object[plan->refractor_object[k]]);
    for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
      abbe_result result =
          faces >> face & 1 ? check_layers(scene, plan, from, face, k, error) : ABBE_OK;
      if (result != ABBE_OK) return result;
    }
    all |= faces;
  }
  plan->reaches[light] = all != 0;
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    abbe_view view;
    if ((all >> face & 1) == 0) continue;
    if (!first && plan->light_view_count == ABBE_SCENE_MAX_LIGHTS)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the refractors around the light '%s' need a cube of maps, and all "
                            "lights together more than %d maps; move it away from them, or leave "
                            "lights out",
                            from->name, ABBE_SCENE_MAX_LIGHTS);
    const size_t at = first ? light : plan->light_view_count++;
    const unsigned rest = first ? ABBE_LIGHT_CUBE_ALL & ~all : 0;
    plan->light_view[at] = (abbe_light_view){light, face, 1u << face | rest};
    plan->reaches[at] = plan->cubes = true;
    first = false;
    abbe_light_cube_look(from->position, face, &view);
    find_aside(scene, plan, &view);
  }
  return ABBE_OK;
}

bool abbe_light_views_fit(const abbe_scene *scene, const abbe_light *light, const abbe_plan *plan,
                          abbe_view *out, size_t *off) {
  static const double up[3] = {0, 1, 0};
  const bool sun = light->kind == ABBE_LIGHT_DIRECTIONAL;
  bool all = true;
  double min[3], max[3], forward[3];
  abbe_scene_bounds(scene, true, false, min, max);
  for (int k = 0; k < 3; k++) forward[k] = 0.5 * (min[k] + max[k]) - light->position[k];
  if (forward[0] == 0 && forward[1] == 0 && forward[2] == 0) forward[2] = -1;
  abbe_view_look(sun ? min : light->position, sun ? light->direction : forward, up, sun, out);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_mesh *mesh = &scene->object[plan->refractor_object[k]].mesh;
    if (abbe_view_fit(out, (const double(*)[3])mesh->position, mesh->vertex_count) || sun) continue;
    if (all && off != NULL) *off = plan->refractor_object[k];
    all = false;
  }
  return all;
}

/* Where one view of the light holds all refractors, it has that; else a cube of them. */
static abbe_result examine_view(const abbe_scene *scene, size_t light, abbe_plan *plan,
                                abbe_error *error) {
  const bool thesis = abbe_profile_is_published(plan->desc.profile);
  const abbe_light *from = &scene->light[light];
  abbe_view view;
  const bool cube = abbe_profile_estimates(plan->desc.profile) && plan->desc.faces == 0 &&
                    !abbe_render_desc_in_light(&plan->desc);
  if (thesis && from->kind == ABBE_LIGHT_SPOT) return ABBE_OK; /* its view is its cone */
  const bool fits = abbe_light_views_fit(scene, from, plan, &view, &plan->off_view[light]);
  if (fits) find_aside(scene, plan, &view);
  if (cube && (!fits || plan->outside_map_view)) plan->desc.faces = ABBE_LIGHT_CUBE_FACES;
  if (fits || plan->desc.faces > 1) return ABBE_OK;
  if (!thesis) return make_cube(scene, light, plan, error);
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the %s profile looks through one view, and the light '%s' sees the "
                        "refractor '%s' more than 76 degrees off the middle of all; move it away, "
                        "or take the default profile%s",
                        abbe_profile_name(plan->desc.profile), from->name,
                        scene->object[plan->off_view[light]].name,
                        abbe_profile_estimates(plan->desc.profile)
                            ? ", or six views (--faces 6; of wyman2006, with photons in the "
                              "camera's image)"
                            : "");
}

abbe_result abbe_light_views_choose(const abbe_scene *scene, abbe_plan *plan, abbe_error *error) {
  plan->light_view_count = scene->light_count;
  for (size_t i = 0; i < scene->light_count; i++)
    plan->light_view[i] = (abbe_light_view){i, -1, ABBE_LIGHT_CUBE_ALL};
  if (plan->refractor_count == 0) return ABBE_OK;
  for (size_t i = 0; i < scene->light_count; i++) {
    if (scene->light[i].kind == ABBE_LIGHT_DIRECTIONAL || !plan->reaches[i]) continue;
    abbe_result result = examine_view(scene, i, plan, error);
    if (result != ABBE_OK) return result;
  }
  plan->caustics = false;
  for (size_t i = 0; i < plan->light_view_count; i++)
    plan->caustics = plan->caustics || plan->reaches[i];
  return ABBE_OK;
}
