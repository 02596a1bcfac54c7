#include "gl/plan/plan.h"

#include "base/thread/watch.h"
#include "gl/plan/examine/haze_model.h"
#include "gl/plan/examine/light_views.h"
#include "gl/plan/examine/path_limits.h"
#include "gl/plan/examine/precision.h"
#include "gl/plan/examine/receiver_model.h"
#include "gl/plan/examine/refractor_model.h"
#include "gl/plan/examine/spectral_needs.h"
#include "gl/plan/examine/tints.h"
#include "gl/plan/no_culling.h"
#include "gl/plan/pass_list.h"
#include "gl/plan/support.h"
#include "scenes/lights/area_lights.h"
#include "scenes/lights/environment_lights.h"
#include "scenes/mesh/coarse_mesh.h"

#include <stdlib.h>
#include <string.h>

static abbe_result make_lists(const abbe_scene *scene, abbe_plan *plan, abbe_error *error) {
  const size_t room = scene->object_count + 1;
  plan->refractor_object = calloc(room, sizeof *plan->refractor_object);
  plan->receiver_object = calloc(room, sizeof *plan->receiver_object);
  plan->receiver_model = calloc(room, sizeof *plan->receiver_model);
  plan->model = calloc(room, sizeof *plan->model);
  plan->mirror = calloc(room, sizeof *plan->mirror);
  if (plan->refractor_object == NULL || plan->receiver_object == NULL ||
      plan->receiver_model == NULL || plan->model == NULL || plan->mirror == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the plan");
  for (size_t i = 0; i < scene->object_count; i++) {
    if (abbe_object_kind_of(&scene->object[i]) != ABBE_OBJECT_RECEIVER) continue;
    plan->receiver_object[plan->receiver_count++] = i;
    plan->textured = plan->textured || scene->object[i].texture.data != NULL;
  }
  return ABBE_OK;
}

/* Maps of rays go with receivers that are parallelograms alone, as many as uniforms hold. */
static size_t count_pages(const abbe_plan *plan) {
  enum { MOST = 192 };
  const size_t pages = 2 * plan->parallelogram_count;
  const bool rays = plan->volume && plan->desc.volume->kind == ABBE_VOLUME_EXITS;
  const bool fit = pages * plan->light_view_count <= MOST;
  return rays && fit && plan->receivers == ABBE_RECEIVER_EXACT ? pages : 0;
}

/* Facts that follow from others. */
static void combine(abbe_plan *plan) {
  const bool published = abbe_profile_is_published(plan->desc.profile), caustics = plan->caustics;
  const bool apart = caustics && plan->dispersive && plan->desc.wavelengths > 1;
  plan->draw_back = plan->layers;
  plan->tiles = caustics && !published && (plan->receiver_shadows || plan->outside_map_view);
  plan->page_charts = plan->desc.transport == ABBE_TRANSPORT_PINHOLE && !published &&
                      plan->receivers == ABBE_RECEIVER_BVH;
  plan->fills = !abbe_profile_is_wyman2006(plan->desc.profile) &&
                plan->desc.fill != ABBE_FILL_NONE &&
                ((apart && !published) || (published && caustics));
  plan->edges = caustics && !published && plan->facets;
  plan->band_parts = (plan->tinting || plan->colouring) && !published;
}

/* Light goes on from rough mirrors through samples of them alone. */
static void choose_transport(const abbe_scene *scene, const abbe_render_desc *desc,
                             abbe_plan *plan) {
  for (size_t i = 0; i < scene->object_count; i++)
    plan->rough = plan->rough || abbe_brushing_is_rough(&scene->object[i].brushing);
  const bool open = desc == NULL || desc->transport == ABBE_TRANSPORT_AUTO;
  if (plan->rough && open && plan->desc.transport == ABBE_TRANSPORT_PHOTONS &&
      !abbe_profile_is_published(plan->desc.profile))
    abbe_render_desc_take_pinholes(&plan->desc);
}

/* Views of fewer triangles, where they are asked for and some mesh has many. */
static void choose_triangles(const abbe_scene *scene, abbe_plan *plan) {
  bool many = false;
  for (size_t k = 0; k < plan->refractor_count; k++)
    many = many || abbe_coarse_mesh_serves(&scene->object[plan->refractor_object[k]].mesh);
  plan->fewer_triangles = many ? plan->desc.coarse : ABBE_COARSE_NONE;
}

static abbe_result make_plan(const abbe_scene *scene, const abbe_render_desc *desc, abbe_plan *out,
                             abbe_error *error) {
  choose_transport(scene, desc, out);
  out->surrounded = scene->environment != NULL;
  for (size_t i = 0; i < scene->light_count; i++)
    out->sized_lights = out->sized_lights || abbe_light_has_size(&scene->light[i]);
  abbe_result result = abbe_support_mirrors(scene, out, error);
  if (result == ABBE_OK) result = abbe_support_roughness(scene, out, error);
  if (result == ABBE_OK) result = make_lists(scene, out, error);
  out->around_eye = abbe_scene_around_eye(scene);
  if (result == ABBE_OK) result = abbe_refractor_model_choose(scene, out, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result == ABBE_OK) abbe_receiver_model_choose(scene, out);
  if (result == ABBE_OK) result = abbe_support_haze(scene, out, error);
  if (result == ABBE_OK) result = abbe_support_published(scene, out, error);
  if (result == ABBE_OK) result = abbe_support_pinholes(scene, out, error);
  if (result == ABBE_OK) result = abbe_support_layout(scene, out, error);
  if (result == ABBE_OK) abbe_light_views_reach(scene, out);
  if (result == ABBE_OK) result = abbe_light_views_choose(scene, out, error);
  if (result == ABBE_OK) result = abbe_support_volume(scene, out, error);
  if (result == ABBE_OK) result = abbe_precision_check(scene, out, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result != ABBE_OK) {
    abbe_plan_free(out);
    return result;
  }
  if (out->desc.transport == ABBE_TRANSPORT_VOLUME) {
    out->volume = out->caustics;
    out->volume_pages = count_pages(out);
    out->caustics = false;
  }
  abbe_receiver_model_shadows(scene, out);
  abbe_haze_model_choose(scene, out);
  abbe_spectral_needs_count(out);
  abbe_path_limits_choose(scene, desc, out);
  result = abbe_watch_check(error); /* it may not have followed all light */
  if (result != ABBE_OK) {
    abbe_plan_free(out);
    return result;
  }
  choose_triangles(scene, out);
  combine(out);
  out->tints = out->caustics && out->band_parts ? abbe_tint_count(scene, out) : 0;
  out->receiver_colours = abbe_receiver_model_disperses(scene, out);
  abbe_pass_list_add(scene, out);
  abbe_haze_model_note(scene, out);
  out->around_eye = NULL; /* the plan may outlive the scene */
  abbe_refractor_model_note(scene, out);
  abbe_spectral_needs_note(scene, out);
  if (out->desc.everything) abbe_no_culling_apply(scene, desc, out);
  return ABBE_OK;
}

bool abbe_plan_surrounds(const abbe_scene *scene) {
  return (scene->environment != NULL && scene->soft_light == NULL) || abbe_area_lights_any(scene);
}

abbe_result abbe_plan_surround(const abbe_scene *scene, const abbe_render_desc *desc,
                               const abbe_scene *before, abbe_scene *out, abbe_error *error) {
  abbe_render_desc d;
  abbe_result result =
      abbe_render_desc_resolve(desc, scene->camera.width, scene->camera.height, &d, error);
  if (result != ABBE_OK) return result;
  /* wand2003 shows all of an environment through its pinholes. */
  const bool cut = scene->environment != NULL && !abbe_profile_is_wand2003(d.profile);
  const size_t others = cut ? d.environment_lights : 0;
  abbe_scene pointed;
  result =
      abbe_area_lights_add(scene, d.light_points, ABBE_SCENE_MAX_LIGHTS - others, &pointed, error);
  if (result != ABBE_OK) return result;
  const abbe_environment_lights_desc lights = {
      .count = others, .min_nm = d.min_nm, .max_nm = d.max_nm, .observer = d.observer};
  result = abbe_environment_lights_add(&pointed, &lights, before, out, error);
  free(pointed.light);
  return result;
}

abbe_result abbe_plan_make(const abbe_scene *scene, const abbe_render_desc *desc, abbe_plan *out,
                           abbe_error *error) {
  static const abbe_plan none = {0};
  return abbe_plan_make_after(&none, scene, desc, out, error);
}

abbe_result abbe_plan_make_after(const abbe_plan *before, const abbe_scene *scene,
                                 const abbe_render_desc *desc, abbe_plan *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  out->inside = before->inside;
  out->shape = before->shape;
  abbe_result result =
      abbe_render_desc_resolve(desc, scene->camera.width, scene->camera.height, &out->desc, error);
  if (result != ABBE_OK) return result;
  if (!abbe_plan_surrounds(scene)) return make_plan(scene, desc, out, error);
  abbe_scene surrounded;
  result = abbe_plan_surround(scene, desc, NULL, &surrounded, error);
  if (result != ABBE_OK) return result;
  result = make_plan(&surrounded, desc, out, error);
  abbe_environment_lights_drop(&surrounded);
  return result;
}
