#include "gl/plan/examine/examine.h"

#include "base/maths.h"
#include "colorimetry/weights.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

/* Whether there are refractors that scatter; says how often they do. */
static bool note_scattering(const abbe_scene *scene, abbe_plan *plan) {
  const double middle_nm = 0.5 * (plan->desc.min_nm + plan->desc.max_nm);
  bool some = false;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    double size[3];
    if (o->medium == NULL) continue;
    some = true;
    abbe_vector_subtract(o->max, o->min, size);
    const double across = abbe_vector_length(size);
    abbe_plan_note(plan,
                   "%s: light is scattered %.2g times on %.3g m, from corner to corner of it; once "
                   "is drawn, and 'abbe trace' follows all",
                   o->name, across * abbe_medium_scattering(o->medium, middle_nm), across);
  }
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
  if (note_scattering(scene, plan) && !plan->multi_refractor_paths)
    abbe_plan_note(plan, "media in refractors only take of light, where it is not followed from "
                         "interface to interface");
  if (plan->surrounded)
    abbe_plan_note(plan, "haze scatters the environment's lights, and not the rest of it");
  if (plan->tinted_air || (!plan->eye_in_air && plan->tinting))
    abbe_plan_note(plan, "what surfaces send through coloured haze to the eye is taken for white "
                         "light there");
}

enum { MAX_PARALLELOGRAMS = 96 };

void abbe_receiver_model_choose(const abbe_scene *scene, abbe_plan *plan) {
  /* The published methods look their receivers up; an exact estimator meets them as the default
   * profile does. */
  const bool looked_up =
      abbe_method_of(plan->desc.profile)->lamp && plan->desc.estimator != ABBE_ESTIMATOR_EXACT;
  const abbe_object *general = NULL, *beyond = NULL;
  plan->receivers = looked_up ? ABBE_RECEIVER_DEPTH : ABBE_RECEIVER_EXACT;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_object *object = &scene->object[plan->receiver_object[i]];
    const bool flat = object->exact.kind == ABBE_EXACT_PARALLELOGRAMS;
    const bool room = flat && object->exact.count <= MAX_PARALLELOGRAMS - plan->parallelogram_count;
    plan->receiver_model[i] = looked_up ? ABBE_RECEIVER_DEPTH
                              : room    ? ABBE_RECEIVER_EXACT
                                        : ABBE_RECEIVER_BVH;
    if (plan->receiver_model[i] == ABBE_RECEIVER_EXACT)
      plan->parallelogram_count += object->exact.count;
    if (!flat && general == NULL) general = object;
    if (flat && !room && beyond == NULL) beyond = object;
  }
  if (!looked_up && (general != NULL || beyond != NULL)) plan->receivers = ABBE_RECEIVER_BVH;
  const char *model = abbe_receiver_model_name(plan->receivers);
  if (looked_up)
    abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_MODEL, "%s: the %s profile knows no other model",
                  model, abbe_profile_name(plan->desc.profile));
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

/* Whether the parallelogram's plane has everything on one side of it: all other corners, those of
 * the refractors' bounds, and the places that light comes from. To 1e-6 of its own size: what is
 * larger may lie close to what is small. */
static bool bounds_all(const abbe_scene *scene, const abbe_plan *plan, const double p[9]) {
  const double tolerance = 1e-6 * (abbe_vector_length(p + 3) + abbe_vector_length(p + 6));
  double low = 0, high = 0;
  for (size_t i = 0; i < plan->receiver_count; i++) {
    const abbe_exact *exact = &scene->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count; k++)
      for (int c = 0; c < 4; c++) {
        const double *q = exact->parallelogram[k];
        double corner[3];
        for (int x = 0; x < 3; x++)
          corner[x] = q[x] + (c & 1 ? q[3 + x] : 0) + (c & 2 ? q[6 + x] : 0);
        double side = abbe_reach_side(p, corner);
        low = fmin(low, side);
        high = fmax(high, side);
      }
  }
  for (size_t i = 0; i < 8 * plan->refractor_count; i++) {
    const abbe_object *object = &scene->object[plan->refractor_object[i / 8]];
    double corner[3];
    for (int x = 0; x < 3; x++) corner[x] = i >> x & 1 ? object->max[x] : object->min[x];
    double side = abbe_reach_side(p, corner);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    double from[3];
    for (int x = 0; x < 3; x++)
      from[x] = light->kind == ABBE_LIGHT_DIRECTIONAL ? p[x] - light->direction[x] * 1e6
                                                      : light->position[x];
    double side = abbe_reach_side(p, from);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  return low > -tolerance || high < tolerance;
}

void abbe_receiver_model_shadows(const abbe_scene *scene, abbe_plan *plan) {
  plan->receiver_shadows = plan->receivers != ABBE_RECEIVER_EXACT;
  for (size_t i = 0; i < plan->receiver_count && !plan->receiver_shadows; i++) {
    const abbe_exact *exact = &scene->object[plan->receiver_object[i]].exact;
    for (size_t k = 0; k < exact->count && !plan->receiver_shadows; k++)
      plan->receiver_shadows = !bounds_all(scene, plan, exact->parallelogram[k]);
  }
  abbe_plan_add(plan, ABBE_CHOICE_RECEIVER_SHADOWS,
                plan->receiver_shadows ? "a receiver may stand between a light and another"
                                       : "the receivers bound a convex room around the lights");
}

bool abbe_receiver_model_is_coloured(const abbe_object *object) {
  const double even = 0.01;
  double least = INFINITY, most = 0;
  if (object->texture.data != NULL) return true;
  if (object->spectrum == NULL) {
    for (int k = 0; k < 3; k++) {
      least = fmin(least, object->reflectance[k]);
      most = fmax(most, object->reflectance[k]);
    }
    return most - least > even * most;
  }
  const double *value = abbe_spectrum_value(object->spectrum);
  for (size_t i = 0; i < abbe_spectrum_count(object->spectrum); i++) {
    least = fmin(least, value[i]);
    most = fmax(most, value[i]);
  }
  return most - least > even * most;
}

bool abbe_receiver_model_disperses(const abbe_scene *scene, const abbe_plan *plan) {
  if (!plan->caustics || !plan->dispersive || plan->desc.wavelengths < 2 ||
      abbe_method_of(plan->desc.profile)->own_passes)
    return false;
  for (size_t i = 0; i < plan->receiver_count; i++)
    if (abbe_receiver_model_is_coloured(&scene->object[plan->receiver_object[i]])) return true;
  return false;
}

/* A parallelogram's corners, one more for each side of the light's window and one for the
 * camera. */
enum { MAX_CORNERS = 12 };

/* Share of a window's width: shaders round where they look up what it holds. */
static const double rounding = 1e-4;

static const int margin = 2;

typedef struct polygon {
  double at[MAX_CORNERS][3];
  size_t count;
} polygon;

/* Keeps what has n . (x - origin) >= d, by Sutherland and Hodgman. */
static void clip(const double n[3], const double origin[3], double d, polygon *p) {
  polygon kept = {.count = 0};
  for (size_t i = 0; i < p->count; i++) {
    const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
    double from[3], to[3];
    abbe_vector_subtract(a, origin, from);
    abbe_vector_subtract(b, origin, to);
    const double before = abbe_vector_dot(n, from) - d, after = abbe_vector_dot(n, to) - d;
    if (before >= 0 && kept.count < MAX_CORNERS) memcpy(kept.at[kept.count++], a, sizeof from);
    if ((before >= 0) == (after >= 0) || kept.count == MAX_CORNERS) continue;
    const double t = before / (before - after);
    for (int k = 0; k < 3; k++) kept.at[kept.count][k] = a[k] + t * (b[k] - a[k]);
    kept.count++;
  }
  *p = kept;
}

/* One side of a view's window: sign 1 keeps what is above the bound, -1 below. */
static void clip_side(const abbe_view *view, const double axis[3], double bound, double sign,
                      polygon *p) {
  double n[3];
  for (int k = 0; k < 3; k++)
    n[k] = sign * (axis[k] - (view->orthographic ? 0 : bound * view->forward[k]));
  clip(n, view->origin, view->orthographic ? sign * bound : 0, p);
}

bool abbe_lit_window_cone(const abbe_light *light, abbe_view *out) {
  static const double up[3] = {0, 0, 1};
  if (light->kind != ABBE_LIGHT_SPOT || !(light->cone_rad < ABBE_LIT_WINDOW_MAX_CONE)) return false;
  const double t = tan(light->cone_rad), window[4] = {-t, t, -t, t};
  abbe_view_look(light->position, light->direction, up, false, out);
  memcpy(out->window, window, sizeof window);
  return true;
}

bool abbe_lit_window(const abbe_view *light, const abbe_view *eye, const double parallelogram[9],
                     size_t width, size_t height, int out[4]) {
  polygon p = {.count = 4};
  for (int c = 0; c < 4; c++) /* around */
    for (int k = 0; k < 3; k++)
      p.at[c][k] = parallelogram[k] + (c == 1 || c == 2 ? parallelogram[3 + k] : 0) +
                   (c >= 2 ? parallelogram[6 + k] : 0);
  for (int axis = 0; axis < 2; axis++) {
    const double *side = axis == 0 ? light->right : light->up, *bound = light->window + 2 * axis;
    const double room = rounding * (bound[1] - bound[0]);
    clip_side(light, side, bound[0] - room, 1, &p);
    clip_side(light, side, bound[1] + room, -1, &p);
  }
  clip(eye->forward, eye->origin, eye->orthographic ? -INFINITY : 0.5 * eye->near, &p);
  const double size[2] = {(double)width, (double)height};
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (size_t i = 0; i < p.count; i++) {
    double uvz[3];
    abbe_view_project(eye, p.at[i], uvz);
    for (int axis = 0; axis < 2; axis++) {
      low[axis] = fmin(low[axis], uvz[axis] * size[axis]);
      high[axis] = fmax(high[axis], uvz[axis] * size[axis]);
    }
  }
  for (int axis = 0; axis < 2; axis++) {
    out[axis] = (int)fmin(fmax(floor(low[axis]) - margin, 0), size[axis]);
    out[2 + axis] = (int)fmin(fmax(ceil(high[axis]) + margin, 0), size[axis]);
  }
  return p.count > 0 && out[0] < out[2] && out[1] < out[3];
}
