/* mirror_nodes.h: what mirrors reflect, as photons and the camera's rays have it at their
 * wavelengths. Internal to gl/.
 *
 * Light between two nodes is laid by what both of them carry, straight between them. A metal's
 * reflectance may bend more than that between few nodes; so each node has a factor, which makes the
 * polygon through all nodes, at normal incidence, the best one for the metal by least squares, by
 * the light's brightness.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_MIRROR_NODES_H
#define ABBE_GL_SCENE_SPECTRA_MIRROR_NODES_H

#include "base/error.h"
#include "colorimetry/weights.h"
#include "gl/plan/facts/plan_facts.h"
#include "spectral/wavelengths.h"

/* Absorbs factor times what Fresnel's reflectance of n + i k leaves, at most all; k below 0: the
 * factor itself, at all angles. So what grazes it is reflected, whatever the factor is. */
typedef struct abbe_mirror_node {
  double factor, n, k;
} abbe_mirror_node;

/* The factor with which n + i k reflects so much at normal incidence. */
double abbe_mirror_factor(double n, double k, double reflected);
/* What that factor reflects. */
double abbe_mirror_reflected(double n, double k, double factor);

/* out[w->count] of the mirror, at the wavelengths w, for that light over their range.
 * ABBE_OUT_OF_RANGE where its metal is not known there, ABBE_NO_MEMORY. */
abbe_result abbe_mirror_nodes_fill(const abbe_object *mirror, const abbe_wavelengths *w,
                                   const abbe_weights_range *light, abbe_mirror_node *out,
                                   abbe_error *error);

/* The material whose index gives how far along from node to node light is laid that first met
 * refractor i of the plan: its own; of a mirror, which sends all wavelengths in one direction, that
 * of the first refractor that is none. NULL: there is none. */
const abbe_material *abbe_mirror_nodes_laid_by(const abbe_scene *scene, const abbe_plan *plan,
                                               size_t i);

#endif
