#include "gl/plan/plan.h"

#include "base/thread/watch.h"
#include "gl/plan/examine/examine.h"
#include "scenes/lights/environment_lights.h"
#include "scenes/mesh/mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The plan's entries of a frame's passes, each with the fact that needs it.
 *
 * Written when all facts are known; whether a pass runs is in the table
 * (gl/plan/facts/plan_facts.h). */

static const char unlit[] = "no light meets a refractor";

/* Why no photons are followed. */
static const char *no_photons(const abbe_plan *plan) {
  return plan->volume ? "caustics are looked up in a volume" : unlit;
}

static int count_faces(const abbe_plan *plan, size_t light) {
  int faces = 0;
  for (size_t i = 0; i < plan->light_view_count; i++)
    if (plan->light_view[i].light == light) faces++;
  return faces;
}

static void list_maps(const abbe_scene *scene, abbe_plan *plan) {
  for (size_t i = 0; i < scene->light_count && plan->refractor_count > 0; i++) {
    const char *name = scene->light[i].name;
    if (plan->light_view[i].face >= 0)
      abbe_plan_add_about(plan, ABBE_CHOICE_LIGHT_MAP, i, name,
                          "a cube: %d of 6 faces, as '%.50s' is more than 76 degrees off the "
                          "middle of all refractors",
                          count_faces(plan, i), scene->object[plan->off_view[i]].name);
    else
      abbe_plan_add_about(plan, ABBE_CHOICE_LIGHT_MAP, i, name, "%s",
                          plan->reaches[i] ? "the light may meet a refractor"
                                           : "its cone misses every refractor");
  }
  const abbe_method_facts *method = abbe_method_of(plan->desc.profile);
  if (plan->caustics && method->own_passes)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MAPS, "%s knows none", method->called);
  else
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MAPS, "%s",
                  !plan->caustics ? no_photons(plan)
                  : plan->receiver_shadows
                      ? "a receiver may hide from a light where its light lands"
                  : plan->outside_map_view
                      ? "a receiver lies more than 76 degrees off the view of a light's map"
                      : "the lights' maps hold all receivers");
}

static void list_sizes(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_light *disk = NULL;
  for (size_t i = 0; i < scene->light_count && disk == NULL; i++)
    if (abbe_light_has_size(&scene->light[i])) disk = &scene->light[i];
  if (disk == NULL)
    abbe_plan_add(plan, ABBE_CHOICE_LIGHT_SIZE, "none");
  else
    abbe_plan_add(
        plan, ABBE_CHOICE_LIGHT_SIZE,
        "a %s, '%.40s' first: %zu points stand for each, with as many shadows, soft ones of convex "
        "solids; where nothing hides it receivers have its light in closed form",
        disk->kind == ABBE_LIGHT_DISK ? "disk" : "rectangle", disk->name, disk->points);
}

static void list_environment(const abbe_scene *scene, abbe_plan *plan) {
  const bool pinholes = plan->desc.transport == ABBE_TRANSPORT_PINHOLE;
  double kept = 0;
  for (size_t i = 0; i < scene->environment_lights; i++)
    kept += scene->light[scene->light_count - 1 - i].power;
  if (!plan->surrounded)
    abbe_plan_add(plan, ABBE_CHOICE_ENVIRONMENT, "none");
  else if (scene->environment_lights == 0)
    abbe_plan_add(plan, ABBE_CHOICE_ENVIRONMENT, "the camera sees it whole; %s",
                  pinholes ? "pinholes show all of it to receivers"
                           : "nothing in it stands out, so it lights receivers without shadows or "
                             "caustics (--transport pinhole: with): where it is alike all around, "
                             "clear objects and mirrors change nothing outside");
  else
    abbe_plan_add(
        plan, ABBE_CHOICE_ENVIRONMENT,
        "the camera sees it whole; %zu directional lights stand for the %.0f %% that stand out of "
        "it, sharp but for shadows of convex solids and balls; %s",
        scene->environment_lights, 100 * kept / scene->environment->luminance,
        pinholes ? "pinholes show the rest to receivers"
                 : "the rest lights receivers without shadows or caustics "
                   "(--transport pinhole: with)");
}

/* What a view draws of refractors for their back; `unmet`: why it draws none. */
static void list_back(abbe_plan *plan, abbe_pass pass, bool met, const char *unmet) {
  abbe_plan_add(plan, pass, "%s",
                !plan->layers ? "every refractor has an exact surface"
                : met         ? "a mesh without an exact surface ends at its back layer"
                              : unmet);
}

static void list_photons(abbe_plan *plan) {
  const abbe_method_facts *method = abbe_method_of(plan->desc.profile);
  const size_t least = abbe_plan_least_wavelengths(plan), most = plan->desc.wavelengths;
  if (!plan->caustics) {
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT, "%s", no_photons(plan));
    abbe_plan_add(plan, ABBE_PASS_PHOTONS, "%s", no_photons(plan));
    abbe_plan_add(plan, ABBE_PASS_SPECTRAL_MAP, "%s", no_photons(plan));
    return;
  }
  if (method->pixel != NULL)
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT, "a %s each for %zu x %zu pixels", method->pixel,
                  plan->desc.photons, plan->desc.photons);
  else
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT,
                  "at most %zu a side, where light meets a refractor", plan->desc.photons);
  if (method->estimates)
    abbe_plan_add(
        plan, ABBE_PASS_PHOTONS,
        "%zu wavelengths, %zu interface%s; receivers by the estimator '%s', %zu iteration%s", most,
        plan->desc.interfaces, plan->desc.interfaces > 1 ? "s" : "",
        abbe_estimator_name(plan->desc.estimator), plan->desc.iterations,
        plan->desc.iterations > 1 ? "s" : "");
  else if (least < most)
    abbe_plan_add(plan, ABBE_PASS_PHOTONS, "%zu to %zu wavelengths, as each photon's hits ask",
                  least, most);
  else
    abbe_plan_add(plan, ABBE_PASS_PHOTONS, "%zu wavelengths through the refractors", most);
  abbe_plan_add(plan, ABBE_PASS_SPECTRAL_MAP, "%zu x %zu texels%s%s%s%s", plan->desc.map_size,
                plan->desc.map_size,
                plan->edges ? ", splats in rows: a refractor has facets, so light ends at edges"
                            : "",
                plan->desc.faces > 1 ? " for each face of a cube around the light" : "",
                plan->desc.map_layout != NULL ? ", one light's laid out as asked" : "",
                plan->desc.history > 1 ? ", the mean of frames that follow one another" : "");
}

static void list_light(abbe_plan *plan) {
  const bool apart = plan->caustics && plan->dispersive && plan->desc.wavelengths > 1;
  abbe_plan_add(
      plan, ABBE_PASS_RECEIVER_DEPTH,
      plan->receivers == ABBE_RECEIVER_DEPTH ? "receivers are found by their depth from the light"
      : abbe_method_of(plan->desc.profile)->lamp ? "it casts the shadows; receivers are hit exactly"
                                                 : "receivers are hit exactly");
  abbe_plan_add(plan, ABBE_PASS_LIGHT_FRONT, "%s",
                plan->caustics ? "photons start where the light sees a refractor"
                               : no_photons(plan));
  list_back(plan, ABBE_PASS_LIGHT_BACK, plan->caustics, no_photons(plan));
  list_photons(plan);
  if (abbe_method_of(plan->desc.profile)->draws_photons)
    abbe_plan_add(plan, ABBE_PASS_GAP_FILL, "photons are drawn as '%s'",
                  abbe_fill_name(plan->desc.fill));
  else if (plan->fills)
    abbe_plan_add(plan, ABBE_PASS_GAP_FILL, "%s: %s", abbe_fill_name(plan->desc.fill),
                  apart ? "wavelengths land apart" : "the thesis fills whatever lands");
  else
    abbe_plan_add(plan, ABBE_PASS_GAP_FILL, apart ? "none, as asked" : "nothing lands apart");
}

static void list_pinholes(abbe_plan *plan) {
  const abbe_render_desc *d = &plan->desc;
  if (d->transport != ABBE_TRANSPORT_PINHOLE) return;
  abbe_plan_add(plan, ABBE_PASS_PINHOLES, "at most %zu samples of surfaces, footprints %s; %s",
                d->pinholes, d->footprint == ABBE_FOOTPRINT_ON ? "by curvature" : "off",
                abbe_method_of(d->profile)->surroundings
                    ? "each pixel sees each, whatever is between"
                    : "each receiver's map sees clusters of them and parts, and what lies behind");
}

static void list_absorption(abbe_plan *plan) {
  const char *none = abbe_plan_no_refraction(plan);
  abbe_plan_add(
      plan, ABBE_CHOICE_ABSORPTION, "%s",
      none != NULL ? none
      : plan->band_parts
          ? "paths keep how much they pass of what tints, photons' by material and the camera's in "
            "eight parts of each band of wavelengths: it asks for no more of these"
      : plan->absorbing ? "a material attenuates; path lengths are kept"
                        : "every material is clear");
}

static void list_picture(abbe_plan *plan) {
  const size_t samples = plan->desc.supersample, pixels = plan->desc.upsample;
  if (samples > plan->desc.receiver_samples)
    abbe_plan_add(plan, ABBE_PASS_EYE_PICTURE,
                  "%zu x %zu samples a pixel of refractors, one of receivers", samples, samples);
  else if (samples > 1)
    abbe_plan_add(plan, ABBE_PASS_EYE_PICTURE, "%zu x %zu samples a pixel", samples, samples);
  else if (pixels > 1)
    abbe_plan_add(plan, ABBE_PASS_EYE_PICTURE, "a sample for %zu x %zu pixels", pixels, pixels);
  else
    abbe_plan_add(plan, ABBE_PASS_EYE_PICTURE, "one sample a pixel: nothing is averaged");
}

static void list_eye(abbe_plan *plan) {
  const char *unseen = plan->refractor_count > 0 ? "the eye sees no refractor" : "nothing refracts";
  abbe_plan_add(plan, ABBE_PASS_EYE_RECEIVERS, "light, shadow and spectral map");
  abbe_plan_add(plan, ABBE_PASS_EYE_FRONT, "%s",
                plan->camera_sees_refractor ? "the pixels that show a refractor" : unseen);
  list_back(plan, ABBE_PASS_EYE_BACK, plan->camera_sees_refractor, unseen);
  if (plan->desc.adaptive > 1)
    abbe_plan_add(plan, ABBE_PASS_EYE_ADAPTIVE,
                  "%zu x %zu rays for a sample of a receiver where its light bends",
                  plan->desc.adaptive, plan->desc.adaptive);
  else if (abbe_method_of(plan->desc.profile)->own_passes)
    abbe_plan_add(plan, ABBE_PASS_EYE_ADAPTIVE, "%s knows none",
                  abbe_method_of(plan->desc.profile)->called);
  else
    abbe_plan_add(plan, ABBE_PASS_EYE_ADAPTIVE, "%s",
                  plan->desc.upsample > 1 ? "none: samples are far apart" : "none, as asked");
  if (plan->glowing)
    abbe_plan_add(
        plan, ABBE_PASS_EYE_GLOW,
        "a refractor is fluorescent: what excites it is found in 12 cells along each axis");
  if (plan->camera_sees_refractor && plan->eye_exits > 1)
    abbe_plan_add(plan, ABBE_PASS_EYE_REFRACTION,
                  "one direction a wavelength, until less than %g of its light is left, %zu exits "
                  "at most",
                  plan->eye_share, plan->eye_exits);
  else
    abbe_plan_add(plan, ABBE_PASS_EYE_REFRACTION, "%s",
                  plan->camera_sees_refractor ? "one direction a wavelength" : unseen);
  list_picture(plan);
  abbe_plan_add(plan, ABBE_CHOICE_TEXTURES, plan->textured ? "a receiver has one" : "none");
  abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_COLOURS,
                plan->receiver_colours
                    ? "tables of what they reflect of bands, for light arrives dispersed"
                    : "no dispersed light falls on a receiver in colours");
}

/* Adds maps, passes and what stands between them in the order in which they run. */
static void pass_list_add(const abbe_scene *scene, abbe_plan *plan) {
  list_maps(scene, plan);
  list_light(plan);
  list_pinholes(plan);
  list_absorption(plan);
  list_eye(plan);
  list_sizes(scene, plan);
  list_environment(scene, plan);
}

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
  if (plan->desc.wavelengths < 7 && plan->lines == 0 &&
      (asked == NULL || asked->wavelengths == 0)) {
    plan->desc.wavelengths = 7;
    rewrite(plan, ABBE_CHOICE_WAVELENGTHS, 7, "wavelengths");
    rewrite(plan, ABBE_PASS_PHOTONS, 7, "wavelengths");
  }
  plan->receiver_colours = plan->caustics && !plan->volume && plan->receiver_count > 0;
  plan->fills = plan->desc.fill != ABBE_FILL_NONE && plan->desc.wavelengths > 1;
  if (!plan->multi_refractor_paths && (asked == NULL || asked->exits == 0)) {
    plan->hit_slots += (plan->crystals ? 2 : 1) * (ABBE_RENDER_MAX_EXITS - plan->desc.exits);
    plan->desc.exits = ABBE_RENDER_MAX_EXITS;
    if (plan->eye_exits < plan->desc.exits) plan->eye_exits = plan->desc.exits;
    rewrite(plan, ABBE_CHOICE_INNER_REFLECTIONS, plan->desc.exits, "exits at most");
  }
}

/* asked: the request as it came; what it says itself stays. */
static void no_culling_apply(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan) {
  if (abbe_method_of(plan->desc.profile)->own_passes) return;
  plan->receiver_shadows = plan->textured = true;
  if (plan->refractor_count > 0) switch_refraction_on(scene, asked, plan);
  list_again(plan);
}

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
  const bool published = abbe_method_of(plan->desc.profile)->own_passes, caustics = plan->caustics;
  const bool apart = caustics && plan->dispersive && plan->desc.wavelengths > 1;
  plan->draw_back = plan->layers;
  plan->tiles = caustics && !published && (plan->receiver_shadows || plan->outside_map_view);
  plan->page_charts = plan->desc.transport == ABBE_TRANSPORT_PINHOLE && !published &&
                      plan->receivers == ABBE_RECEIVER_BVH;
  plan->fills = !abbe_method_of(plan->desc.profile)->draws_photons &&
                plan->desc.fill != ABBE_FILL_NONE &&
                ((apart && !published) || (published && caustics));
  plan->edges = caustics && !published && plan->facets;
  if (published) plan->crystals = plan->pleochroic = false;
  plan->band_parts = (plan->tinting || plan->colouring || plan->pleochroic) && !published;
  plan->glowing = plan->glowing && plan->band_parts && !plan->layers &&
                  plan->refractor_count <= ABBE_PLAN_MOST_GLOWING;
}

/* Whether it is alike all around, to a rounding: clear objects change nothing then. */
static bool is_even(const abbe_radiance_map *map) {
  for (size_t i = 3; i < 3 * map->width * map->height; i++)
    if (fabsf(map->rgb[i] - map->rgb[i % 3]) > 1e-3f * map->rgb[i % 3]) return false;
  return true;
}

/* Whether soft light, without shadows, would show: near receivers exact solids hide some. Paths
 * that go from one to the next are asked for by pinholes too. */
static bool shades_softly(const abbe_scene *scene, const abbe_plan *plan) {
  enum { MOST_PARALLELOGRAMS = 64 };
  const double least = 0.01; /* of an environment's light */
  double soft = plan->surrounded ? scene->environment->luminance : 0;
  for (size_t i = 0; i < scene->environment_lights; i++)
    soft -= scene->light[scene->light_count - 1 - i].power;
  if (!plan->surrounded || soft < least * scene->environment->luminance ||
      plan->refractor_count == 0 || plan->layers ||
      (plan->refractor_count > 1 && !plan->multi_refractor_paths) ||
      plan->receivers != ABBE_RECEIVER_EXACT || plan->parallelogram_count > MOST_PARALLELOGRAMS ||
      abbe_scene_is_hazy(scene) || (!plan->absorbing && is_even(&scene->environment->map)))
    return false;
  for (size_t k = 0; k < plan->refractor_count; k++)
    if (plan->model[k] == ABBE_REFRACTOR_BVH) return false;
  for (size_t i = 0; i < plan->receiver_count; i++)
    for (size_t k = 0; k < plan->refractor_count; k++)
      if (abbe_reach_is_near(&scene->object[plan->receiver_object[i]],
                             &scene->object[plan->refractor_object[k]]))
        return true;
  return false;
}

/* Whether the plan chooses the transport, and photons alone are what it would choose. */
static bool is_open(const abbe_render_desc *asked, const abbe_plan *plan) {
  return (asked == NULL || asked->transport == ABBE_TRANSPORT_AUTO) &&
         plan->desc.transport == ABBE_TRANSPORT_PHOTONS &&
         !abbe_method_of(plan->desc.profile)->own_passes;
}

/* Light goes on from rough mirrors through samples of them alone. */
static void choose_transport(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan) {
  for (size_t i = 0; i < scene->object_count; i++)
    plan->rough = plan->rough || abbe_brushing_is_rough(&scene->object[i].brushing);
  if (plan->rough && is_open(asked, plan)) abbe_render_desc_take_pinholes(&plan->desc);
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
  if (result == ABBE_OK) result = abbe_support_nesting(scene, out, error);
  if (result == ABBE_OK) result = abbe_support_roughness(scene, out, error);
  if (result == ABBE_OK) result = make_lists(scene, out, error);
  out->around_eye = abbe_scene_around_eye(scene);
  if (result == ABBE_OK) result = abbe_refractor_model_choose(scene, out, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result == ABBE_OK) abbe_receiver_model_choose(scene, out);
  if (result == ABBE_OK && is_open(desc, out) && shades_softly(scene, out))
    abbe_render_desc_take_pinholes(&out->desc);
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
  abbe_spectral_needs_count(scene, out);
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
  pass_list_add(scene, out);
  abbe_haze_model_note(scene, out);
  out->around_eye = NULL; /* the plan may outlive the scene */
  abbe_refractor_model_note(scene, out);
  abbe_spectral_needs_note(scene, out);
  if (out->desc.everything) no_culling_apply(scene, desc, out);
  if (!out->note_lost) return ABBE_OK;
  abbe_plan_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the plan");
}

bool abbe_plan_surrounds(const abbe_scene *scene) {
  return (scene->environment != NULL && scene->soft_light == NULL) || abbe_area_lights_any(scene);
}

abbe_result abbe_plan_surround(const abbe_scene *scene, const abbe_render_desc *desc,
                               const abbe_scene *before, abbe_scene *out, abbe_error *error) {
  abbe_render_desc d;
  ABBE_TRY(abbe_render_desc_resolve(desc, scene->camera.width, scene->camera.height, &d, error));
  /* wand2003 shows all of an environment through its pinholes. */
  const bool cut = scene->environment != NULL && !abbe_method_of(d.profile)->surroundings;
  const size_t others = cut ? d.environment_lights : 0;
  abbe_scene pointed;
  ABBE_TRY(
      abbe_area_lights_add(scene, d.light_points, ABBE_SCENE_MAX_LIGHTS - others, &pointed, error));
  const abbe_environment_lights_desc lights = {
      .count = others, .min_nm = d.min_nm, .max_nm = d.max_nm, .observer = d.observer};
  abbe_result result = abbe_environment_lights_add(&pointed, &lights, before, out, error);
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
  ABBE_TRY(
      abbe_render_desc_resolve(desc, scene->camera.width, scene->camera.height, &out->desc, error));
  if (!abbe_plan_surrounds(scene)) return make_plan(scene, desc, out, error);
  abbe_scene surrounded;
  ABBE_TRY(abbe_plan_surround(scene, desc, NULL, &surrounded, error));
  abbe_result result = make_plan(&surrounded, desc, out, error);
  abbe_environment_lights_drop(&surrounded);
  return result;
}
