#include "gl/plan/examine/examine.h"

#include "base/maths.h"
#include "base/number.h"
#include "base/thread/watch.h"
#include "scenes/geometry/digest.h"
#include "spectral/optics.h"

#include <math.h>
#include <string.h>

enum { MULTI_REFRACTOR_SLOTS = 16 };

/* Mesa 22's llvmpipe ends every loop of a thread after 65535 turns of any loops, and a thread may
 * follow all wavelengths. */
static size_t eye_exits(const abbe_plan *plan) {
  const size_t most = 32768 / plan->desc.wavelengths;
  return most < ABBE_PLAN_EYE_EXITS ? most : ABBE_PLAN_EYE_EXITS;
}

/* Whether light is followed through one convex faceted solid alone, whichever model has it. */
static bool is_lone_solid(const abbe_scene *scene, const abbe_plan *plan) {
  return plan->facets && (plan->convex || plan->bvh) && plan->refractor_count == 1 &&
         !plan->mirror[0] && scene->object[plan->refractor_object[0]].material != NULL;
}

void abbe_path_limits_choose(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan) {
  const bool thesis = abbe_method_of(plan->desc.profile)->own_passes;
  const size_t waves = plan->crystals && !thesis ? 2 : 1;
  char inside[64] = "";
  /* What a view's layers do not show is missed more with every reflection: fewer are worth it,
   * unless planes beside them show all. */
  if (thesis || plan->desc.exits == 0)
    plan->desc.exits = thesis                          ? 1
                       : plan->layers && !plan->convex ? ABBE_PLAN_LAYER_EXITS
                                                       : ABBE_PLAN_EXITS;
  if (is_lone_solid(scene, plan) && abbe_plan_no_refraction(plan) == NULL)
    abbe_number_format(inside, sizeof inside, "; %.2g %% of it is still inside then",
                       100 * abbe_inner_light_plan(scene, asked, plan));
  /* Layers show less and less of what is inside; and a request for few exits shows them. A smaller
   * share brings multi-refractor paths nothing that what is left does not show. */
  const bool few = asked != NULL && asked->exits > 0 && asked->exits < ABBE_PLAN_EXITS;
  const bool eye_goes_on = !thesis && (!plan->layers || plan->convex) && !few;
  plan->eye_exits = eye_goes_on ? eye_exits(plan) : plan->desc.exits;
  plan->eye_share = plan->desc.energy_share;
  if (!plan->multi_refractor_paths) plan->eye_share = fmin(plan->eye_share, ABBE_PLAN_EYE_SHARE);
  const bool share_is_open = asked == NULL || asked->energy_share == 0;
  if (plan->mirror_count > 0 && share_is_open && !thesis) plan->eye_share = ABBE_PLAN_MIRROR_SHARE;
  plan->hit_slots = plan->multi_refractor_paths ? waves * MULTI_REFRACTOR_SLOTS
                                                : waves * plan->desc.exits + (thesis ? 0 : 1);
  if (abbe_plan_no_refraction(plan) != NULL)
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS, "%s", abbe_plan_no_refraction(plan));
  else if (plan->desc.exits == 1)
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS, "two interfaces only, as %s%s",
                  thesis ? "published" : "asked", inside);
  else
    abbe_plan_add(plan, ABBE_CHOICE_INNER_REFLECTIONS,
                  "followed until less than %g of the light is left, %zu exits at most%s",
                  plan->desc.energy_share, plan->desc.exits, inside);
}

enum { GRID = 64 }; /* rays a side */

/* Where the ray enters the solid: how far along it, and by which plane; -1: it misses. */
static int entry_of(const abbe_exact *solid, const double p[3], const double d[3], double *at) {
  double enter = 0, leave = INFINITY;
  int facet = -1;
  for (size_t i = 0; i < solid->count; i++) {
    const double *plane = solid->plane[i];
    const double slope = abbe_vector_dot(plane, d), gap = plane[3] - abbe_vector_dot(plane, p);
    if (slope == 0 && gap < 0) return -1;
    if (slope > 0) leave = fmin(leave, gap / slope);
    if (slope < 0 && gap / slope > enter) {
      enter = gap / slope;
      facet = (int)i;
    }
  }
  *at = enter;
  return enter < leave ? facet : -1;
}

/* The inner face that a ray inside meets next, from a point on the facet `from`; -1: none. */
static int inner_face_of(const abbe_exact *solid, int from, const double p[3], const double d[3],
                         double *at) {
  double nearest = INFINITY;
  int facet = -1;
  for (size_t i = 0; i < solid->count; i++) {
    const double *plane = solid->plane[i];
    const double slope = abbe_vector_dot(plane, d);
    if ((int)i == from || !(slope > 0)) continue;
    const double t = fmax((plane[3] - abbe_vector_dot(plane, p)) / slope, 0);
    if (t >= nearest) continue;
    nearest = t;
    facet = (int)i;
  }
  *at = nearest;
  return facet;
}

static void move(double p[3], double along, const double d[3]) {
  for (int k = 0; k < 3; k++) p[k] += along * d[k];
}

typedef struct matter {
  double n, attenuation_per_m, energy_share;
} matter;

/* One ray of that weight, from p along d; returns its weight where it meets the solid. */
static double follow(const abbe_exact *solid, const matter *m, double weight, double p[3],
                     const double d[3], abbe_inner_light *out) {
  const double back[3] = {-d[0], -d[1], -d[2]};
  double along, inner[3];
  int facet = entry_of(solid, p, d, &along);
  if (facet < 0) return 0;
  const double *plane = solid->plane[facet];
  double share = 1 - abbe_optics_fresnel(abbe_vector_dot(plane, back), 1 / m->n);
  if (!abbe_optics_refract(back, plane, 1 / m->n, inner)) return weight;
  move(p, along, d);
  out->kept[0] += weight * share;
  for (size_t exits = 1; exits <= ABBE_RENDER_MAX_EXITS; exits++) {
    facet = inner_face_of(solid, facet, p, inner, &along);
    if (facet < 0) return weight;
    plane = solid->plane[facet];
    const double cosine = abbe_vector_dot(plane, inner);
    share *= abbe_optics_transmittance(m->attenuation_per_m, along);
    share *= abbe_optics_fresnel(fmin(cosine, 1), m->n);
    if (share < m->energy_share) {
      for (size_t k = exits; k <= ABBE_RENDER_MAX_EXITS; k++) out->faint[k] += weight * share;
      return weight;
    }
    out->kept[exits] += weight * share;
    move(p, along, inner);
    move(inner, -2 * cosine, plane);
  }
  return weight;
}

bool abbe_inner_light_follow(const abbe_exact *solid, const abbe_view *view,
                             const abbe_light *light, double n, double attenuation_per_m,
                             double energy_share, abbe_inner_light *out) {
  const matter m = {n, attenuation_per_m, energy_share};
  double total = 0;
  memset(out, 0, sizeof *out);
  for (int i = 0; i < GRID * GRID; i++) {
    const double uv[2] = {(i % GRID + 0.5) / GRID, (i / GRID + 0.5) / GRID};
    double p[3], d[3];
    abbe_view_ray(view, uv, p, d);
    /* in a window of tangents a part's solid angle goes with the cube of the cosine */
    const double cosine = view->orthographic ? 1 : abbe_vector_dot(d, view->forward);
    const double weight =
        cosine * cosine * cosine * (light != NULL ? abbe_light_profile(light, d) : 1);
    if (weight > 0) total += follow(solid, &m, weight, p, d, out);
  }
  for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS && total > 0; k++) {
    out->kept[k] /= total;
    out->faint[k] /= total;
  }
  return total > 0;
}

size_t abbe_inner_light_exits(const abbe_inner_light *inside, size_t least, size_t most) {
  size_t exits = least;
  while (exits < most &&
         inside->kept[exits] + fmin(inside->faint[exits], ABBE_INNER_LIGHT_MOST_FAINT) >
             ABBE_INNER_LIGHT_MOST)
    exits++;
  return exits;
}

/* The worst of what the scene's lights keep inside, in every entry; else what the camera sees
 * there. */
static void follow_all(const abbe_scene *scene, const abbe_plan *plan, abbe_inner_light *out) {
  static const double up[3] = {0, 0, 1};
  const abbe_object *object = &scene->object[plan->refractor_object[0]];
  abbe_material_range range;
  double centre[3], size[3];
  bool met = false;
  memset(out, 0, sizeof *out);
  if (abbe_material_range_make(object->material, plan->desc.min_nm, plan->desc.max_nm, &range,
                               NULL) != ABBE_OK)
    return;
  for (int k = 0; k < 3; k++) centre[k] = 0.5 * (object->min[k] + object->max[k]);
  abbe_vector_subtract(object->max, object->min, size);
  for (size_t i = 0; i <= scene->light_count && abbe_watch_goes_on(); i++) {
    const abbe_light *light = i < scene->light_count ? &scene->light[i] : NULL;
    if (light != NULL ? !abbe_reach_light(light, object) : met || !plan->camera_sees_refractor)
      continue;
    const bool parallel = light != NULL && light->kind == ABBE_LIGHT_DIRECTIONAL;
    double from[3], forward[3];
    memcpy(from, light != NULL ? light->position : scene->camera.eye, sizeof from);
    for (int k = 0; k < 3 && parallel; k++)
      from[k] = centre[k] - light->direction[k] * abbe_vector_length(size);
    abbe_vector_subtract(centre, from, forward);
    abbe_view view;
    abbe_view_look(from, forward, up, parallel, &view);
    abbe_view_fit(&view, (const double(*)[3])object->mesh.position, object->mesh.vertex_count);
    abbe_inner_light one;
    /* A cone so narrow that it passes between the rays is taken for a wide one. */
    for (int narrow = 0; narrow < 2; narrow++)
      if (abbe_inner_light_follow(&object->exact, &view, narrow ? NULL : light, range.middle_n,
                                  range.middle_per_m, plan->desc.energy_share, &one))
        break;
    met = true;
    for (size_t k = 0; k <= ABBE_RENDER_MAX_EXITS; k++) {
      out->kept[k] = fmax(out->kept[k], one.kept[k]);
      out->faint[k] = fmax(out->faint[k], one.faint[k]);
    }
  }
}

static bool is_little(const abbe_inner_light *inside, size_t exits) {
  return inside->kept[exits] + inside->faint[exits] <= ABBE_INNER_LIGHT_MOST;
}

/* A digest of all that it is found from; for pictures of light that moves without the places of
 * lights: what was found before serves. */
static uint64_t digest_of(const abbe_scene *scene, const abbe_plan *plan, bool share_is_open,
                          bool exits_are_open) {
  const abbe_object *object = &scene->object[plan->refractor_object[0]];
  const bool open[4] = {share_is_open, exits_are_open, plan->camera_sees_refractor,
                        plan->desc.coarse == ABBE_COARSE_ALL};
  abbe_material_range range = {0};
  abbe_material_range_make(object->material, plan->desc.min_nm, plan->desc.max_nm, &range, NULL);
  const double inputs[3] = {range.middle_n, range.middle_per_m, plan->desc.energy_share};
  uint64_t h = abbe_digest(plan->desc.exits, open, sizeof open);
  h = abbe_digest(h, inputs, sizeof inputs);
  h = abbe_digest_array(h, object->exact.plane, object->exact.count, sizeof *object->exact.plane);
  h = abbe_digest_array(h, object->mesh.position, object->mesh.vertex_count,
                        sizeof *object->mesh.position);
  bool met = false;
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (!abbe_reach_light(light, object)) continue;
    const int kind = (int)light->kind;
    const double cone[2] = {light->cone_rad, light->soft_rad};
    met = true;
    h = abbe_digest(h, &kind, sizeof kind);
    h = abbe_digest(h, cone, sizeof cone);
    if (plan->desc.coarse == ABBE_COARSE_ALL) continue;
    h = abbe_digest(h, light->position, sizeof light->position);
    h = abbe_digest(h, light->direction, sizeof light->direction);
  }
  if (!met) h = abbe_digest(h, scene->camera.eye, sizeof scene->camera.eye);
  return h != 0 ? h : 1;
}

/* Returns what is still inside. */
static double look_inside(const abbe_scene *scene, bool share_is_open, bool exits_are_open,
                          abbe_plan *plan) {
  abbe_inner_light inside, lower;
  follow_all(scene, plan, &inside);
  if (exits_are_open)
    plan->desc.exits = abbe_inner_light_exits(&inside, ABBE_PLAN_EXITS, ABBE_PLAN_MOST_EXITS);
  if (share_is_open && exits_are_open && !is_little(&inside, plan->desc.exits)) {
    plan->desc.energy_share = ABBE_PLAN_LOW_SHARE;
    follow_all(scene, plan, &lower);
    const size_t exits = abbe_inner_light_exits(&lower, ABBE_PLAN_EXITS, ABBE_PLAN_MOST_EXITS);
    /* Where no exits are enough, faint paths are not what keeps the light. */
    if (is_little(&lower, exits)) {
      plan->desc.exits = exits;
      inside = lower;
    } else {
      plan->desc.energy_share = ABBE_PLAN_SHARE;
    }
  }
  return inside.kept[plan->desc.exits] + inside.faint[plan->desc.exits];
}

double abbe_inner_light_plan(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan) {
  const bool share_is_open = asked == NULL || asked->energy_share == 0;
  const bool exits_are_open = asked == NULL || asked->exits == 0;
  const uint64_t of = digest_of(scene, plan, share_is_open, exits_are_open);
  abbe_plan_inside *inside = &plan->inside;
  if (inside->of == of) {
    plan->desc.exits = inside->exits;
    plan->desc.energy_share = inside->energy_share;
    return inside->left;
  }
  const double left = look_inside(scene, share_is_open, exits_are_open, plan);
  *inside = (abbe_plan_inside){of, plan->desc.exits, plan->desc.energy_share, left};
  return left;
}
