/* inner_light.h: how much light a convex faceted solid keeps inside, exit by exit.
 *
 * Rays of a grid over the solid, from a light or from the camera, followed in double precision at
 * one wavelength by Snell's and Fresnel's laws. No receivers, no colours, nothing random: the same
 * scene gives the same figures. The plan takes exits by them; no picture is made of them.
 * Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_INNER_LIGHT_H
#define ABBE_GL_PLAN_EXAMINE_INNER_LIGHT_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

/* The share of light, by which a plan chooses exits, that may stay inside, and its share that may
 * do so in paths that have become faint. */
#define ABBE_INNER_LIGHT_MOST 0.005
#define ABBE_INNER_LIGHT_MOST_FAINT 0.0025

/* Shares of the light that meets the solid, by exits, 1 to ABBE_RENDER_MAX_EXITS; [0]: what its
 * outside lets in, and 0. */
typedef struct abbe_inner_light {
  double kept[ABBE_RENDER_MAX_EXITS + 1];  /* inside after so many exits, in paths that go on */
  double faint[ABBE_RENDER_MAX_EXITS + 1]; /* in paths that have ended by then, below the share */
} abbe_inner_light;

/* The light through a view's window that meets the solid (ABBE_EXACT_CONVEX), of index n and an
 * attenuation in 1/m; a path ends where less than energy_share of its light is left. Light from
 * `light`, by its profile, or from all directions of the window alike (NULL). False, and all zero,
 * where no ray brings light. */
bool abbe_inner_light_follow(const abbe_exact *solid, const abbe_view *view,
                             const abbe_light *light, double n, double attenuation_per_m,
                             double energy_share, abbe_inner_light *out);

/* The fewest exits, from least to most, after which no more than ABBE_INNER_LIGHT_MOST is inside,
 * where what faint paths keep counts up to ABBE_INNER_LIGHT_MOST_FAINT; most, where none are
 * enough.
 */
size_t abbe_inner_light_exits(const abbe_inner_light *inside, size_t least, size_t most);

/* Exits and the share at which paths end, written into plan->desc, for the plan's one refractor, a
 * convex solid that light leaves for good; what was requested stays (NULL: nothing was). By the
 * light that keeps most inside or, where no light meets the solid, by the camera; at the middle of
 * the wavelengths. Returns the share of the light that is then still inside. */
double abbe_inner_light_plan(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan);

/* How far light is followed through refractors, from a light and from the camera. */

/* Exits at the most, the share of its light at which a path ends, both of the camera's rays, and
 * the capacity for hits of a photon. asked: the request as it came, or NULL. The wavelengths are
 * counted. */
void abbe_path_limits_choose(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan);

#endif
