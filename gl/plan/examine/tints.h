/* tints.h: what refractors and mirrors take of light by wavelength, as photons' hits keep it: of
 * each of the first stuffs on a path how much it passed, which tells the rest at all wavelengths.
 * Internal to gl/.
 *
 * An amount is a path inside, m, or of a mirror one for each reflection straight on; attenuation is
 * optical depth by amount.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_TINTS_H
#define ABBE_GL_PLAN_EXAMINE_TINTS_H

#include "gl/plan/facts/plan_facts.h"

/* Stuffs whose amounts a hit keeps. */
enum { ABBE_MOST_TINTS = 3 };

/* Of refractor or mirror r, by amount; at most what leaves nothing, so that sums stay finite. */
double abbe_tint_attenuation(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                             double lambda_nm);

/* Of the plan's refractors and mirrors the first of the same stuff as r; -1: it takes of all
 * wavelengths alike. */
int abbe_tint_of(const abbe_scene *scene, const abbe_plan *plan, size_t r);
/* Of all stuffs, ABBE_MOST_TINTS at the most. */
size_t abbe_tint_count(const abbe_scene *scene, const abbe_plan *plan);

#endif
