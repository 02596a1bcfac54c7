/* spectral_needs.h: what index, attenuation and light over the wavelengths require of the plan.
 *
 * What varies, how many wavelengths that takes, and what is extrapolated or taken for one.
 * Internal to gl/. */
#ifndef ABBE_GL_PLAN_EXAMINE_SPECTRAL_NEEDS_H
#define ABBE_GL_PLAN_EXAMINE_SPECTRAL_NEEDS_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"
#include "spectral/materials/material.h"

/* A refractor's material over the range: whether its index varies, whether it attenuates, and that
 * by wavelength; ABBE_OUT_OF_RANGE where its index is not known, and a note where what is seen of
 * it is extrapolated. Before the material's first refractor is added. */
abbe_result abbe_spectral_needs_examine(const abbe_scene *scene, const abbe_material *material,
                                        abbe_plan *plan, abbe_error *error);

/* A mirror's reflectance over the range: whether it varies; what it reflects, as a sentence's part
 * into `text`. ABBE_OUT_OF_RANGE where its metal is not known over all of it. */
abbe_result abbe_spectral_needs_mirror(const abbe_object *mirror, abbe_plan *plan, char *text,
                                       size_t size, abbe_error *error);

/* How many wavelengths, where the request leaves it open, and why. */
void abbe_spectral_needs_count(const abbe_scene *scene, abbe_plan *plan);
enum { ABBE_PLAN_MOST_LINES = 32 };
/* Lines of the scene's lights from min_nm to max_nm, ascending; how many. 0 where a light, or the
 * surroundings, have others than lines, or there are too many. */
size_t abbe_spectral_needs_lines(const abbe_scene *scene, double min_nm, double max_nm,
                                 double lambda_nm[ABBE_PLAN_MOST_LINES]);

/* A note where lights of several spectra are taken for one. */
void abbe_spectral_needs_note(const abbe_scene *scene, abbe_plan *plan);

/* What refractors and mirrors take of light by wavelength, as photons' hits keep it: of each of
 * the first stuffs on a path how much it passed, which gives the rest at all wavelengths.
 *
 * An amount is a path inside, m, or of a mirror one for each reflection straight on; attenuation
 * is optical depth by amount. */

/* Stuffs whose amounts a hit keeps. */
enum { ABBE_MOST_TINTS = 3 };

/* Attenuation by surface s (abbe_plan_surfaces), by amount; at most what leaves nothing, so that
 * sums stay finite. */
double abbe_tint_attenuation(const abbe_scene *scene, const abbe_plan *plan, size_t s,
                             double lambda_nm);

/* The first of the plan's surfaces that is of the same stuff as s; -1: it absorbs all wavelengths
 * alike, or is a pleochroic refractor's mean. A metre of a pleochroic crystal is shared among its
 * axes (crystals.glsl). */
int abbe_tint_of(const abbe_scene *scene, const abbe_plan *plan, size_t s);
/* The number of all stuffs, ABBE_MOST_TINTS at the most. */
size_t abbe_tint_count(const abbe_scene *scene, const abbe_plan *plan);

/* Between what a material's index and attenuation lie over a range of wavelengths.
 *
 * Where the plan reads n(lambda) and attenuation, and nowhere else: whether something varies,
 * whether light notices it at all, and one value that stands for all of it. */

typedef struct abbe_material_range {
  double least_n, most_n;
  double least_per_m, most_per_m; /* attenuation */
  double middle_n, middle_per_m;  /* at the range's middle */
} abbe_material_range;

/* At 81 wavelengths from min_nm to max_nm, and at their mean. ABBE_OUT_OF_RANGE where the index is
 * not known. */
abbe_result abbe_material_range_make(const abbe_material *material, double min_nm, double max_nm,
                                     abbe_material_range *out, abbe_error *error);

#endif
