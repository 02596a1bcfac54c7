#include "gl/plan/pass_list.h"

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

static const char *knows_none(const abbe_plan *plan) {
  return abbe_profile_is_thesis(plan->desc.profile) ? "the thesis knows none"
                                                    : "the published method knows none";
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
  abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MAPS, "%s",
                !plan->caustics                                 ? no_photons(plan)
                : abbe_profile_is_published(plan->desc.profile) ? knows_none(plan)
                : plan->receiver_shadows ? "a receiver may hide from a light where its light lands"
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
        "a %s, '%.40s' first: %zu points stand for each, with as many sharp shadows; where "
        "nothing hides it receivers have its light in closed form",
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
    abbe_plan_add(plan, ABBE_CHOICE_ENVIRONMENT,
                  "the camera sees it whole; %zu directional lights, sharp, stand for the %.0f %% "
                  "that stand out of it; %s",
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
  const size_t least = abbe_plan_least_wavelengths(plan), most = plan->desc.wavelengths;
  if (!plan->caustics) {
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT, no_photons(plan));
    abbe_plan_add(plan, ABBE_PASS_PHOTONS, no_photons(plan));
    abbe_plan_add(plan, ABBE_PASS_SPECTRAL_MAP, no_photons(plan));
    return;
  }
  if (abbe_profile_is_wyman2006(plan->desc.profile))
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT, "a photon each for %zu x %zu pixels",
                  plan->desc.photons, plan->desc.photons);
  else if (abbe_profile_is_shah2007(plan->desc.profile))
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT, "a vertex each for %zu x %zu pixels",
                  plan->desc.photons, plan->desc.photons);
  else
    abbe_plan_add(plan, ABBE_PASS_PHOTON_PLACEMENT,
                  "at most %zu a side, where light meets a refractor", plan->desc.photons);
  if (abbe_profile_estimates(plan->desc.profile))
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
  abbe_plan_add(plan, ABBE_PASS_RECEIVER_DEPTH,
                plan->receivers == ABBE_RECEIVER_DEPTH
                    ? "receivers are found by their depth from the light"
                : abbe_profile_has_lamp(plan->desc.profile)
                    ? "it casts the shadows; receivers are hit exactly"
                    : "receivers are hit exactly");
  abbe_plan_add(plan, ABBE_PASS_LIGHT_FRONT, "%s",
                plan->caustics ? "photons start where the light sees a refractor"
                               : no_photons(plan));
  list_back(plan, ABBE_PASS_LIGHT_BACK, plan->caustics, no_photons(plan));
  list_photons(plan);
  if (abbe_profile_is_wyman2006(plan->desc.profile))
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
  abbe_plan_add(plan, ABBE_PASS_PINHOLES,
                "at most %zu samples of surfaces, '%s', footprints %s; %s", d->pinholes,
                abbe_sample_strategy_name(d->strategy),
                d->footprint == ABBE_FOOTPRINT_ON ? "by curvature" : "off",
                abbe_profile_is_wand2003(d->profile)
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
  else
    abbe_plan_add(plan, ABBE_PASS_EYE_ADAPTIVE, "%s",
                  abbe_profile_is_published(plan->desc.profile) ? knows_none(plan)
                  : plan->desc.upsample > 1                     ? "none: samples are far apart"
                                                                : "none, as asked");
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

void abbe_pass_list_add(const abbe_scene *scene, abbe_plan *plan) {
  list_maps(scene, plan);
  list_light(plan);
  list_pinholes(plan);
  list_absorption(plan);
  list_eye(plan);
  list_sizes(scene, plan);
  list_environment(scene, plan);
}
