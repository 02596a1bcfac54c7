#include "gl/plan/plan.h"

#include "base/number.h"
#include "colorimetry/weights.h"
#include "gl/plan/inner_light.h"
#include "gl/plan/light_cube.h"
#include "gl/plan/no_culling.h"
#include "gl/plan/pass_list.h"
#include "gl/plan/precision.h"
#include "gl/plan/reach.h"
#include "gl/plan/transport.h"
#include "scenes/geometry/vector.h"
#include "scenes/view/view.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of a light's white: what is less is seen by nobody, as the diamond's 760 to 780 nm. */
#define LEAST_EXTRAPOLATED 1e-3

enum { MAX_PARALLELOGRAMS = 96, RANGE_STEPS = 81, MAX_MODEL_ENTRIES = 48, WALK_SLOTS = 16 };

/* The most that a material's wavelengths outside its valid range are of a light's white. */
static double extrapolated_share(const abbe_scene *scene, const abbe_material *material, double min,
                                 double max) {
  double most = 0;
  const double edges[2][2] = {{min, fmin(material->min_nm, max)},
                              {fmax(material->max_nm, min), max}};
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_illuminant *light = &scene->light[i].illuminant;
    double outside = 0, xyz[3], white[3];
    abbe_weights_band_xyz(light, min, max, min, max, white);
    for (int k = 0; k < 2; k++) {
      if (!(edges[k][0] < edges[k][1])) continue;
      abbe_weights_band_xyz(light, min, max, edges[k][0], edges[k][1], xyz);
      outside += xyz[0] + xyz[1] + xyz[2];
    }
    const double all = white[0] + white[1] + white[2];
    most = fmax(most, all > 0 ? outside / all : 1);
  }
  return most;
}

/* Whether n and the attenuation over the range ask for more than constants. */
static abbe_result examine_material(const abbe_scene *scene, const abbe_material *material,
                                    abbe_plan *plan, abbe_error *error) {
  double min = plan->desc.min_nm, max = plan->desc.max_nm, first = 0, first_per_m = 0;
  bool outside = extrapolated_share(scene, material, min, max) > LEAST_EXTRAPOLATED;
  for (int i = 0; i < RANGE_STEPS; i++) {
    double lambda_nm = min + (max - min) * i / (RANGE_STEPS - 1), n = 0;
    abbe_result result = abbe_material_n(material, lambda_nm, &n, error);
    if (result != ABBE_OK) return result;
    double per_m = abbe_material_attenuation(material, lambda_nm);
    if (i == 0) first = n;
    if (i == 0) first_per_m = per_m;
    if ((float)n != (float)first) plan->dispersive = true; /* the shaders hold it so */
    if (per_m != first_per_m) plan->tinting = true;
    if (per_m > 0) plan->absorbing = true;
  }
  for (size_t i = 0; i < plan->refractor_count && outside; i++)
    if (scene->object[plan->refractor_object[i]].material == material) outside = false;
  if (outside)
    abbe_plan_note(plan, "%s: the index is extrapolated outside its valid range, %g to %g nm",
                   material->name, material->min_nm, material->max_nm);
  return ABBE_OK;
}

/* Parallelograms as they come, as many as there is room for; triangles of all others. */
static void choose_receiver_models(const abbe_scene *scene, abbe_plan *plan) {
  const bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  const abbe_object *general = NULL, *beyond = NULL;
  plan->receivers = thesis ? ABBE_RECEIVER_DEPTH : ABBE_RECEIVER_EXACT;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_object *object = &scene->object[plan->receiver_object[i]];
    const bool flat = object->exact.kind == ABBE_EXACT_PARALLELOGRAMS;
    const bool room = flat && object->exact.count <= MAX_PARALLELOGRAMS - plan->parallelogram_count;
    plan->receiver_model[i] = thesis ? ABBE_RECEIVER_DEPTH
                              : room ? ABBE_RECEIVER_EXACT
                                     : ABBE_RECEIVER_HIERARCHY;
    if (plan->receiver_model[i] == ABBE_RECEIVER_EXACT)
      plan->parallelogram_count += object->exact.count;
    if (!flat && general == NULL) general = object;
    if (flat && !room && beyond == NULL) beyond = object;
  }
  if (!thesis && (general != NULL || beyond != NULL)) plan->receivers = ABBE_RECEIVER_HIERARCHY;
  const char *model = abbe_receiver_model_name(plan->receivers);
  if (thesis)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: the thesis profile knows no other model",
                  model);
  else if (general != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: '%.50s' is a general mesh", model,
                  general->name);
  else if (beyond != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL,
                  "%s: with '%.50s' there are more than %d parallelograms", model, beyond->name,
                  MAX_PARALLELOGRAMS);
  else
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: every receiver is a rectangle or a box",
                  model);
}

/* Refractors beyond those that the plan has room for are counted. */
static void list_model(abbe_plan *plan, size_t object, const char *name, const char *reason,
                       size_t *unlisted) {
  if (plan->entry_count < MAX_MODEL_ENTRIES)
    abbe_plan_add_about(plan, ABBE_CHOICE_REFRACTOR_MODEL, object, name, "%s", reason);
  else
    ++*unlisted;
}

static abbe_result examine_objects(const abbe_scene *scene, abbe_plan *plan, abbe_error *error) {
  bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  plan->refractor_object = calloc(scene->object_count + 1, sizeof *plan->refractor_object);
  plan->receiver_object = calloc(scene->object_count + 1, sizeof *plan->receiver_object);
  plan->receiver_model = calloc(scene->object_count + 1, sizeof *plan->receiver_model);
  plan->model = calloc(scene->object_count + 1, sizeof *plan->model);
  if (plan->refractor_object == NULL || plan->receiver_object == NULL ||
      plan->receiver_model == NULL || plan->model == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the plan");
  const char *walk = abbe_transport_walk(scene, plan);
  size_t unlisted = 0;
  plan->walk = walk != NULL;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    if (object->material == NULL) {
      plan->receiver_object[plan->receiver_count++] = i;
      plan->textured = plan->textured || object->texture.data != NULL;
      continue;
    }
    if (plan->refractor_count == 255)
      return abbe_error_set(error, ABBE_UNSUPPORTED, "the scene has more than 255 refractors");
    if (abbe_transport_invisible(scene, object, plan)) {
      list_model(plan, i, object->name,
                 "clear, and its index is that of air: light does not notice it", &unlisted);
      continue;
    }
    abbe_result result = examine_material(scene, object->material, plan, error);
    if (result != ABBE_OK) return result;
    result = abbe_transport_check(object, plan, error);
    if (result != ABBE_OK) return result;
    abbe_refractor_model model = abbe_transport_model(object, plan);
    plan->refractor_object[plan->refractor_count] = i;
    plan->model[plan->refractor_count++] = model;
    plan->spheres = plan->spheres || model == ABBE_REFRACTOR_SPHERE;
    plan->convex = plan->convex || model == ABBE_REFRACTOR_CONVEX;
    plan->layers = plan->layers || model == ABBE_REFRACTOR_LAYERS;
    plan->hierarchy = plan->hierarchy || model == ABBE_REFRACTOR_HIERARCHY;
    char why[192], reason[224];
    abbe_transport_reason(object, plan, why, sizeof why);
    snprintf(reason, sizeof reason, "%s: %s", abbe_refractor_model_name(model), why);
    list_model(plan, i, object->name, reason, &unlisted);
  }
  if (unlisted > 0)
    abbe_plan_add(plan, ABBE_CHOICE_MORE_REFRACTORS, "and %zu refractors more", unlisted);
  abbe_plan_add(plan, ABBE_CHOICE_REFRACTORS_IN_TURN, "%s",
                plan->refractor_count == 0 ? "nothing refracts"
                : plan->walk               ? walk
                : thesis                   ? "the thesis profile follows two interfaces"
                : plan->desc.model == ABBE_MODEL_LAYERS
                    ? "light goes through two layers and no further, as asked"
                : plan->refractor_count < 2 ? "light that leaves the refractor cannot meet it again"
                                            : "there are more refractors than are followed");
  choose_receiver_models(scene, plan);
  return ABBE_OK;
}

/* Whether the parallelogram's plane has everything on one side of it: all other corners, those of
 * the refractors' bounds, and the places that light comes from. */
static bool bounds_all(const abbe_scene *scene, const abbe_plan *plan, const double p[9],
                       double tolerance) {
  double low = 0, high = 0;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_exact *exact = &scene->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count; k++)
      for (int c = 0; c < 4; c++) {
        const double *q = exact->parallelogram[k];
        double corner[3];
        for (int x = 0; x < 3; x++)
          corner[x] = q[x] + (c & 1 ? q[3 + x] : 0) + (c & 2 ? q[6 + x] : 0);
        double side = abbe_transport_side(p, corner);
        low = fmin(low, side);
        high = fmax(high, side);
      }
  }
  for (size_t i = 0; i < 8 * plan->refractor_count; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i / 8]];
    double corner[3];
    for (int x = 0; x < 3; x++) corner[x] = i >> x & 1 ? object->max[x] : object->min[x];
    double side = abbe_transport_side(p, corner);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    double from[3];
    for (int x = 0; x < 3; x++)
      from[x] = light->kind == ABBE_LIGHT_DIRECTIONAL ? p[x] - light->direction[x] * 1e6
                                                      : light->position[x];
    double side = abbe_transport_side(p, from);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  return low > -tolerance || high < tolerance;
}

/* Receivers that bound a convex room with the lights inside cannot shadow one another. */
static void examine_shadows(const abbe_scene *scene, abbe_plan *plan) {
  double min[3], max[3], size = 0;
  abbe_scene_bounds(scene, true, true, min, max);
  for (int k = 0; k < 3; k++) size = fmax(size, max[k] - min[k]);
  plan->receiver_shadows = plan->receivers != ABBE_RECEIVER_EXACT;
  for (size_t i = 0; i < plan->receiver_count && !plan->receiver_shadows; i++) {
    const abbe_exact *exact = &scene->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count && !plan->receiver_shadows; k++)
      plan->receiver_shadows = !bounds_all(scene, plan, exact->parallelogram[k], 1e-6 * size);
  }
  abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_SHADOWS,
                plan->receiver_shadows ? "a receiver may stand between a light and another"
                                       : "the receivers bound a convex room around the lights");
}

/* Which lights and whether the eye may meet a refractor; what none of them meets takes no light
 * and costs nothing. */
static void examine_reach(const abbe_scene *scene, abbe_plan *plan) {
  bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_object *object = &scene->object[plan->refractor_object[k]];
    for (size_t i = 0; i < scene->light_count; i++)
      if (thesis || abbe_reach_light(&scene->light[i], object))
        plan->caustics = plan->reaches[i] = true;
    if (thesis || abbe_reach_eye(&scene->camera, plan->desc.width, plan->desc.height, object))
      plan->seen = true;
  }
  for (size_t i = 0; i < scene->light_count && !plan->through; i++)
    for (size_t k = 0; k < plan->refractor_count && plan->reaches[i] && !plan->through; k++)
      for (size_t j = 0; j < plan->receiver_count && !plan->through; j++)
        plan->through =
            abbe_reach_through(&scene->light[i], &scene->object[plan->refractor_object[k]],
                               &scene->object[plan->receiver_object[j]]);
  if (plan->caustics || plan->seen) return;
  plan->dispersive = plan->absorbing = plan->tinting = false;
}

static const char *wavelengths_reason(const abbe_plan *plan, bool asked) {
  return abbe_plan_no_refraction(plan) != NULL ? abbe_plan_no_refraction(plan)
         : asked                               ? "as asked"
         : plan->dispersive                    ? "the index varies with wavelength"
         : plan->tinting                       ? "the attenuation varies with wavelength"
                         : "all indices are constant, one geometry serves all";
}

static void resolve_wavelengths(abbe_plan *plan) {
  bool asked = plan->desc.wavelengths != 0;
  if (!asked)
    plan->desc.wavelengths = plan->dispersive || plan->tinting ? ABBE_PLAN_WAVELENGTHS : 1;
  if (abbe_plan_no_refraction(plan) != NULL) plan->desc.wavelengths = 1;
  abbe_plan_add(plan, ABBE_CHOICE_WAVELENGTHS, "%zu from %g to %g nm: %s", plan->desc.wavelengths,
                plan->desc.min_nm, plan->desc.max_nm, wavelengths_reason(plan, asked));
}

/* Mesa 22's llvmpipe ends every loop of a thread after 65535 turns of any loops, and a thread may
 * follow all wavelengths. */
static size_t eye_exits(const abbe_plan *plan) {
  const size_t most = 32768 / plan->desc.wavelengths;
  return most < ABBE_PLAN_EYE_EXITS ? most : ABBE_PLAN_EYE_EXITS;
}

static void resolve_exits(const abbe_scene *scene, const abbe_render_desc *asked, abbe_plan *plan) {
  const bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  char inside[64] = "";
  /* What a view's layers do not show is missed more with every reflection: fewer are worth it. */
  if (thesis || plan->desc.orders == 0)
    plan->desc.orders = thesis ? 1 : plan->layers ? ABBE_PLAN_LAYER_EXITS : ABBE_PLAN_EXITS;
  if (plan->convex && plan->refractor_count == 1 && !plan->walk &&
      abbe_plan_no_refraction(plan) == NULL)
    abbe_number_format(inside, sizeof inside, "; %.2g %% of it is still inside then",
                       100 * abbe_inner_light_plan(scene, asked, plan));
  /* Layers show less and less of what is inside; and who asks for few exits sees them. A smaller
   * share brings a walk nothing that what is left does not show. */
  const bool few = asked != NULL && asked->orders > 0 && asked->orders < ABBE_PLAN_EXITS;
  const bool eye_goes_on = !thesis && !plan->layers && !few;
  plan->eye_exits = eye_goes_on ? eye_exits(plan) : plan->desc.orders;
  plan->eye_share = plan->desc.energy_share;
  if (!plan->walk) plan->eye_share = fmin(plan->eye_share, ABBE_PLAN_EYE_SHARE);
  plan->slots = plan->walk ? WALK_SLOTS : plan->desc.orders + (thesis ? 0 : 1);
  if (abbe_plan_no_refraction(plan) != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS, "%s", abbe_plan_no_refraction(plan));
  else if (plan->desc.orders == 1)
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS, "two interfaces only, as %s%s",
                  thesis ? "in the thesis" : "asked", inside);
  else
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS,
                  "followed until less than %g of the light is left, %zu exits at most%s",
                  plan->desc.energy_share, plan->desc.orders, inside);
}

/* The scene's rule, that the later object wins, is not the renderer's. */
static void note_overlaps(const abbe_scene *scene, abbe_plan *plan) {
  const abbe_object *first[2] = {NULL, NULL};
  size_t pairs = 0;
  for (size_t i = 0; i < plan->refractor_count; i++)
    for (size_t k = i + 1; k < plan->refractor_count; k++) {
      const abbe_object *a = &scene->object[plan->refractor_object[i]];
      const abbe_object *b = &scene->object[plan->refractor_object[k]];
      if (!abbe_transport_overlap(a, b)) continue;
      if (pairs++ > 0) continue;
      first[0] = a;
      first[1] = b;
    }
  if (pairs == 0) return;
  char more[48] = "";
  if (pairs > 1)
    snprintf(more, sizeof more, " (and %zu pair%s more)", pairs - 1, pairs > 2 ? "s" : "");
  abbe_plan_note(
      plan,
      "the refractors '%.50s' and '%.50s'%s overlap, to judge by their bounds; each is taken as if "
      "it stood in air alone",
      first[0]->name, first[1]->name, more);
}

/* Whether all lights are of one spectrum, up to a factor. */
static bool shine_alike(const abbe_scene *scene, double min, double max) {
  const abbe_illuminant *first = &scene->light[0].illuminant;
  for (size_t k = 1; k < scene->light_count; k++)
    for (int i = 0; i < RANGE_STEPS; i++) {
      const double from = min + (max - min) * i / RANGE_STEPS,
                   to = min + (max - min) * (i + 1) / RANGE_STEPS;
      const double share = abbe_weights_band_power(&scene->light[k].illuminant, min, max, from, to);
      if (fabs(share - abbe_weights_band_power(first, min, max, from, to)) > 1e-6) return false;
    }
  return true;
}

/* What entries rest on that all facts together decide. */
static void combine(abbe_plan *plan) {
  const bool thesis = abbe_profile_is_thesis(plan->desc.profile), caustics = plan->caustics;
  const bool apart = caustics && plan->dispersive && plan->desc.wavelengths > 1;
  plan->back = plan->layers;
  plan->pages = caustics && !thesis && (plan->receiver_shadows || plan->aside);
  plan->fills = plan->desc.fill != ABBE_FILL_NONE && (apart || (thesis && caustics));
  plan->lengths = caustics && plan->tinting && !plan->walk && !thesis;
}

static void add_notes(const abbe_scene *scene, abbe_plan *plan) {
  if (plan->refractor_count > 1 && !plan->walk)
    abbe_plan_note(plan, "light that leaves one refractor and meets another goes on unrefracted");
  if (!plan->walk) note_overlaps(scene, plan);
  if (plan->seen && !shine_alike(scene, plan->desc.min_nm, plan->desc.max_nm))
    abbe_plan_note(plan, "through refractors, colours are split by the first light's illuminant");
}

static abbe_result check_thesis(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  if (!abbe_profile_is_thesis(plan->desc.profile)) return ABBE_OK;
  if (scene->light_count != 1)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the thesis profile knows one light; this scene has %zu",
                          scene->light_count);
  if (scene->light[0].kind == ABBE_LIGHT_DIRECTIONAL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the thesis profile knows point and spot lights; '%s' is directional",
                          scene->light[0].name);
  if (plan->refractor_count == 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the thesis profile needs a refractor; this scene has none");
  for (size_t i = 1; i < plan->refractor_count; i++)
    if (scene->object[plan->refractor_object[i]].material !=
        scene->object[plan->refractor_object[0]].material)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the thesis profile knows one material; this scene has several");
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

static abbe_result check_layout(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error) {
  const abbe_map_layout *layout = plan->desc.map_layout;
  const size_t index = plan->desc.map_layout_light;
  if (layout == NULL) return ABBE_OK;
  if (index >= scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the map layout is for light %zu; the scene has %zu", index + 1,
                          scene->light_count);
  if (abbe_profile_is_thesis(plan->desc.profile))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thesis profile lays its map out by the light's cone; a given layout "
                          "goes with the default profile");
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

static abbe_result check_lights(const abbe_scene *scene, abbe_error *error) {
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (light->kind != ABBE_LIGHT_DISK) continue;
    double area = 3.14159265358979323846 * light->radius * light->radius;
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the light '%s' is a disk, and the renderer's lights have no size; trace "
                          "the scene, or make it a point or spot light of %.6g W/sr, which is what "
                          "it sends along its normal",
                          light->name, light->power * area);
  }
  return ABBE_OK;
}

/* Receivers outside the view have pages. */
static void find_aside(const abbe_scene *scene, abbe_plan *plan, abbe_view *view) {
  for (size_t k = 0; k < plan->receiver_count; k++) {
    const abbe_mesh *mesh = &scene->object[plan->receiver_object[k]].mesh;
    if (!abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count))
      plan->aside = true;
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

/* One lamp for each face of the cube through which light may reach a refractor; the first stands
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
    if (!first && plan->light_count == ABBE_SCENE_MAX_LIGHTS)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the refractors around the light '%s' need a cube of maps, and all "
                            "lights together more than %d maps; move it away from them, or leave "
                            "lights out",
                            from->name, ABBE_SCENE_MAX_LIGHTS);
    const size_t at = first ? light : plan->light_count++;
    const unsigned rest = first ? ABBE_LIGHT_CUBE_ALL & ~all : 0;
    plan->lamp[at] = (abbe_plan_lamp){light, face, 1u << face | rest};
    plan->reaches[at] = plan->cubes = true;
    first = false;
    abbe_light_cube_look(from->position, face, &view);
    find_aside(scene, plan, &view);
  }
  return ABBE_OK;
}

/* Where one view of the light holds all refractors, it has that; else a cube of them. */
static abbe_result examine_view(const abbe_scene *scene, size_t light, abbe_plan *plan,
                                abbe_error *error) {
  static const double up[3] = {0, 1, 0};
  const bool thesis = abbe_profile_is_thesis(plan->desc.profile);
  const abbe_light *from = &scene->light[light];
  double min[3], max[3], forward[3];
  if (thesis && from->kind == ABBE_LIGHT_SPOT) return ABBE_OK; /* its view is its cone */
  abbe_scene_bounds(scene, true, false, min, max);
  for (int k = 0; k < 3; k++) forward[k] = 0.5 * (min[k] + max[k]) - from->position[k];
  if (forward[0] == 0 && forward[1] == 0 && forward[2] == 0) forward[2] = -1;
  abbe_view view;
  abbe_view_look(from->position, forward, up, false, &view);
  for (size_t k = 0; k < plan->refractor_count; k++) {
    const abbe_object *object = &scene->object[plan->refractor_object[k]];
    if (abbe_view_fit(&view, (const double(*)[3])object->mesh.position, object->mesh.vertex_count))
      continue;
    plan->off_view[light] = plan->refractor_object[k];
    if (!thesis) return make_cube(scene, light, plan, error);
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the thesis profile looks through one view, and the light '%s' sees the "
                          "refractor '%s' more than 76 degrees off the middle of all; move it "
                          "away, or take the default profile",
                          from->name, object->name);
  }
  find_aside(scene, plan, &view);
  return ABBE_OK;
}

static abbe_result examine_views(const abbe_scene *scene, abbe_plan *plan, abbe_error *error) {
  plan->light_count = scene->light_count;
  for (size_t i = 0; i < scene->light_count; i++)
    plan->lamp[i] = (abbe_plan_lamp){i, -1, ABBE_LIGHT_CUBE_ALL};
  if (plan->refractor_count == 0) return ABBE_OK;
  for (size_t i = 0; i < scene->light_count; i++) {
    if (scene->light[i].kind == ABBE_LIGHT_DIRECTIONAL || !plan->reaches[i]) continue;
    abbe_result result = examine_view(scene, i, plan, error);
    if (result != ABBE_OK) return result;
  }
  plan->caustics = false;
  for (size_t i = 0; i < plan->light_count; i++)
    plan->caustics = plan->caustics || plan->reaches[i];
  return ABBE_OK;
}

abbe_result abbe_plan_make(const abbe_scene *scene, const abbe_render_desc *desc, abbe_plan *out,
                           abbe_error *error) {
  ABBE_REQUIRE(scene && out, error);
  memset(out, 0, sizeof *out);
  abbe_result result =
      abbe_render_desc_resolve(desc, scene->camera.width, scene->camera.height, &out->desc, error);
  if (result == ABBE_OK) result = check_lights(scene, error);
  if (result == ABBE_OK) result = examine_objects(scene, out, error);
  if (result == ABBE_OK) result = check_thesis(scene, out, error);
  if (result == ABBE_OK) result = check_layout(scene, out, error);
  if (result == ABBE_OK) examine_reach(scene, out);
  if (result == ABBE_OK) result = examine_views(scene, out, error);
  if (result == ABBE_OK) result = abbe_precision_check(scene, out, error);
  if (result != ABBE_OK) {
    abbe_plan_free(out);
    return result;
  }
  examine_shadows(scene, out);
  resolve_wavelengths(out);
  resolve_exits(scene, desc, out);
  combine(out);
  abbe_pass_list_add(scene, out);
  add_notes(scene, out);
  if (out->desc.everything) abbe_no_culling_apply(scene, desc, out);
  return ABBE_OK;
}
