#include "gl/plan/examine/models.h"

#include "colorimetry/weights.h"

#include <math.h>
#include <stdio.h>

enum { STEPS = 80 };

/* A medium, or a refractor with what is in it. */
typedef struct region {
  const abbe_medium *medium; /* NULL: clear */
  const abbe_object *object; /* NULL: the air */
} region;

static double scattering_at(const region *r, double nm) {
  return abbe_medium_scattering(r->medium, nm);
}

static double absorption_at(const region *r, double nm) {
  return abbe_medium_absorption(r->medium, nm) +
         (r->object != NULL ? abbe_material_attenuation(r->object->material, nm) : 0);
}

/* Means by what the observer sees, of a band or of all. */
static void mean_over(const region *r, const abbe_weights_range *range, double from_nm,
                      double to_nm, double *scattering, double *absorption) {
  const double step = (to_nm - from_nm) / STEPS;
  double total = 0;
  *scattering = *absorption = 0;
  for (int i = 0; i < STEPS; i++) {
    double xyz[3];
    const double from = from_nm + i * step, at = from + 0.5 * step;
    abbe_weights_range_xyz(range, from, from + step, xyz);
    const double weight = xyz[0] + xyz[1] + xyz[2] + 1e-9;
    *scattering += weight * scattering_at(r, at);
    *absorption += weight * absorption_at(r, at);
    total += weight;
  }
  *scattering /= total;
  *absorption /= total;
}

/* Under the first light, or the environment. */
static abbe_plan_haze haze_of(const abbe_scene *scene, const abbe_plan *plan, const region *r) {
  const abbe_render_desc *desc = &plan->desc;
  abbe_plan_haze out = {0};
  if (r->medium == NULL && r->object == NULL) return out;
  abbe_weights_range range;
  abbe_weights_range_make_by(desc->observer, abbe_scene_illuminant(scene), desc->min_nm,
                             desc->max_nm, &range);
  mean_over(r, &range, desc->min_nm, desc->max_nm, &out.scattering, &out.absorption);
  for (int k = 0; k < ABBE_PLAN_HAZE_BANDS; k++) {
    double absorption = 0;
    mean_over(r, &range, abbe_plan_haze_edge(desc, k), abbe_plan_haze_edge(desc, k + 1),
              &out.scatters[k], &absorption);
    out.takes[k] = out.scatters[k] + absorption;
  }
  out.g = r->medium != NULL ? r->medium->g : 0;
  return out;
}

/* Adds a medium that scatters; where the plan's capacity is full it is counted. */
static void add_shaft(abbe_plan *plan, int refractor, const abbe_plan_haze *haze) {
  abbe_plan_shaft shaft = {.refractor = refractor, .g = haze->g};
  for (int k = 0; k < ABBE_PLAN_HAZE_BANDS; k++)
    shaft.scattering = fmax(shaft.scattering, haze->scatters[k]);
  if (!(shaft.scattering > 0)) return;
  if (plan->shaft_count < ABBE_PLAN_MOST_SHAFTS)
    plan->shaft[plan->shaft_count++] = shaft;
  else
    plan->unseen_media++;
}

/* Media that the camera may look into through a surface, or see mirrored in one, and to which
 * photons come: the air and those of refractors. */
static void choose_shafts(const abbe_scene *scene, const abbe_object *around, abbe_plan *plan) {
  if (!plan->camera_sees_refractor) return;
  plan->haze_beyond = scene->medium != NULL;
  if (!plan->caustics) return;
  add_shaft(plan, -1, &plan->air_haze);
  for (size_t i = 0; i < plan->refractor_count && plan->multi_refractor_paths; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i]];
    const region r = {.object = object, .medium = object->medium};
    if (object->medium == NULL || plan->mirror[i]) continue;
    const abbe_plan_haze haze = object == around ? plan->eye_haze : haze_of(scene, plan, &r);
    add_shaft(plan, (int)i, &haze);
  }
}

void abbe_haze_model_choose(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *around = plan->around_eye;
  plan->hazy = abbe_scene_is_hazy(scene);
  if (!plan->hazy) return;
  plan->tinted_air = abbe_medium_is_coloured(scene->medium, plan->desc.min_nm, plan->desc.max_nm);
  plan->eye_in_air = around == NULL;
  const region air = {.medium = scene->medium};
  plan->air_haze = haze_of(scene, plan, &air);
  plan->eye_haze = plan->air_haze;
  if (around != NULL)
    plan->eye_haze = haze_of(scene, plan, &(region){.medium = around->medium, .object = around});
  choose_shafts(scene, around, plan);
}

static void note_shafts(const abbe_scene *scene, abbe_plan *plan) {
  const int first = plan->shaft[0].refractor;
  char more[48] = "";
  if (plan->shaft_count > 1) snprintf(more, sizeof more, " and %zu more", plan->shaft_count - 1);
  if (first < 0)
    abbe_plan_add(plan, ABBE_PASS_SHAFTS,
                  "bent and mirrored rays of the camera may run through haze in the air%s", more);
  else
    abbe_plan_add(plan, ABBE_PASS_SHAFTS,
                  "bent and mirrored rays of the camera may run through the medium of '%.40s'%s",
                  scene->object[plan->refractor_object[first]].name, more);
}

static bool some_refractor_scatters(const abbe_scene *scene) {
  bool some = false;
  for (size_t i = 0; i < scene->object_count; i++) some = some || scene->object[i].medium != NULL;
  return some;
}

void abbe_haze_model_note(const abbe_scene *scene, abbe_plan *plan) {
  if (!plan->hazy) return;
  abbe_plan_add(plan, ABBE_PASS_EYE_HAZE, "%s scatters %.3g of light a metre towards the eye",
                plan->eye_in_air ? "the air" : "what the eye is in", plan->eye_haze.scattering);
  if (plan->shaft_count > 0) note_shafts(scene, plan);
  abbe_plan_note(plan, "haze scatters light once");
  if (plan->unseen_media > 0)
    abbe_plan_note(plan,
                   "light in media is seen by bent rays in %d of them; %zu more only take of it",
                   ABBE_PLAN_MOST_SHAFTS, plan->unseen_media);
  if (!plan->multi_refractor_paths && some_refractor_scatters(scene))
    abbe_plan_note(plan, "media in refractors only take of light, where it is not followed from "
                         "interface to interface");
  if (plan->surrounded)
    abbe_plan_note(plan, "haze scatters the environment's lights, and not the rest of it");
  if (plan->tinted_air || (!plan->eye_in_air && plan->tinting))
    abbe_plan_note(plan, "what surfaces send through coloured haze to the eye is taken for white "
                         "light there");
}
