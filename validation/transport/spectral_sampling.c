#include "validation/transport/spectral_sampling.h"

#include "colorimetry/observer.h"
#include "colorimetry/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FINE = 8192 }; /* bins of the density that is inverted */

static double fine_nm(double min_nm, double max_nm, size_t i) {
  return min_nm + (max_nm - min_nm) * (double)i / FINE;
}

/* The scene's lights, and then its environment. */
static size_t lights_of(const abbe_scene *scene) {
  return scene->light_count + (scene->environment != NULL);
}

static const abbe_illuminant *illuminant_of(const abbe_scene *scene, size_t light) {
  return light < scene->light_count ? &scene->light[light].illuminant
                                    : &scene->environment->illuminant;
}

/* What the camera sees of the lights, a share of 1 in all, over the fine bins; beyond them density
 * has capacity for one light's. */
static abbe_result visible_density(const abbe_scene *scene, const abbe_spectral_sampling_desc *d,
                                   double *density, abbe_error *error) {
  const double min_nm = d->min_nm, max_nm = d->max_nm;
  double *one = density + FINE;
  for (size_t l = 0; l < lights_of(scene); l++) {
    const abbe_illuminant *illuminant = illuminant_of(scene, l);
    double sum = 0;
    for (size_t i = 0; i < FINE; i++) {
      double lambda = 0.5 * (fine_nm(min_nm, max_nm, i) + fine_nm(min_nm, max_nm, i + 1)), xyz[3];
      abbe_observer_xyz_of(d->observer, lambda, xyz);
      one[i] = abbe_illuminant_power(illuminant, lambda) * (xyz[0] + xyz[1] + xyz[2]);
      sum += one[i];
    }
    if (!(sum > 0 && isfinite(sum)))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s%s%s sends nothing that the eye sees between %g and %g nm; the eye "
                            "sees %g to %g nm",
                            l < scene->light_count ? "light '" : "the environment",
                            l < scene->light_count ? scene->light[l].name : "",
                            l < scene->light_count ? "'" : "", min_nm, max_nm, ABBE_OBSERVER_MIN_NM,
                            ABBE_OBSERVER_MAX_NM);
    for (size_t i = 0; i < FINE; i++) density[i] += one[i] / sum / (double)lights_of(scene);
  }
  return ABBE_OK;
}

/* Sum of the density below a place in bins. */
static double share_below(const double *density, double place) {
  const size_t whole = place < FINE ? (size_t)place : FINE - 1;
  double sum = 0;
  for (size_t i = 0; i < whole; i++) sum += density[i];
  return sum + (place - (double)whole) * density[whole];
}

/* Cuts the part of the range between two places in bins into steps of equal shares. */
static void cut(const double *density, const double place[2], size_t first, size_t end,
                double min_nm, double max_nm, abbe_spectral_sampling *s) {
  const double from = share_below(density, place[0]), to = share_below(density, place[1]);
  size_t bin = (size_t)place[0];
  double below = share_below(density, (double)bin);
  s->lambda_nm[first] = min_nm + (max_nm - min_nm) * place[0] / FINE;
  for (size_t k = first + 1; k < end; k++) {
    const double wanted = from + (to - from) * (double)(k - first) / (double)(end - first);
    while (bin + 1 < FINE && below + density[bin] < wanted) below += density[bin++];
    const double share = fmin(fmax((wanted - below) / density[bin], 0), 1);
    s->lambda_nm[k] = min_nm + (max_nm - min_nm) * ((double)bin + share) / FINE;
  }
}

/* Each band has as many steps as are nearest to its share, at least one. */
static void invert(const double *density, double min_nm, double max_nm, size_t bands,
                   abbe_spectral_sampling *s) {
  size_t first = 0;
  for (size_t band = 0; band < bands; band++) {
    const double place[2] = {FINE * (double)band / (double)bands,
                             FINE * (double)(band + 1) / (double)bands};
    const double wanted = share_below(density, place[1]) * (double)s->steps;
    const size_t most = s->steps - (bands - 1 - band);
    size_t end = band + 1 < bands ? (size_t)lround(wanted) : s->steps;
    if (end > most) end = most;
    if (end <= first) end = first + 1;
    cut(density, place, first, end, min_nm, max_nm, s);
    first = end;
  }
  s->lambda_nm[s->steps] = max_nm;
}

/* The light's power from one wavelength to another; a table's corner may lie between them. */
static double power_between(const abbe_illuminant *illuminant, double from, double to) {
  enum { PARTS = 8 };
  double sum = 0;
  for (int i = 0; i < PARTS; i++)
    sum += abbe_illuminant_power(illuminant, from + (to - from) * (i + 0.5) / PARTS);
  return sum * (to - from) / PARTS;
}

static abbe_result fill_colours(const abbe_scene *scene, abbe_spectral_sampling *s,
                                abbe_error *error) {
  abbe_wavelengths bands = {.count = s->steps, .lambda_nm = s->lambda_nm, .edge_nm = s->lambda_nm};
  for (size_t l = 0; l < s->lights; l++) {
    const abbe_illuminant *illuminant = illuminant_of(scene, l);
    abbe_weights weights;
    abbe_result result =
        abbe_weights_make_by(s->observer, &bands, illuminant, ABBE_RGB_SPACE_XYZ, &weights, error);
    if (result != ABBE_OK) return result;
    double power = 0;
    memcpy(s->white[l], weights.sum, sizeof s->white[l]);
    for (size_t k = 0; k < s->steps; k++) {
      const double watts = power_between(illuminant, s->lambda_nm[k], s->lambda_nm[k + 1]);
      power += watts;
      s->power[l * s->steps + k] = (float)watts;
      for (int c = 0; c < 3; c++)
        s->xyz[l * s->steps + k][c] = (float)((double)s->steps * weights.weight[k][c]);
    }
    abbe_weights_free(&weights);
    for (size_t k = 0; k < s->steps; k++)
      s->power[l * s->steps + k] *= (float)((double)s->steps / power);
  }
  return ABBE_OK;
}

abbe_result abbe_spectral_sampling_make(const abbe_scene *scene,
                                        const abbe_spectral_sampling_desc *desc,
                                        abbe_spectral_sampling *out, abbe_error *error) {
  const double min_nm = desc->min_nm, max_nm = desc->max_nm, uniform = desc->uniform;
  const size_t bands = desc->bands > 0 ? desc->bands : 1;
  *out = (abbe_spectral_sampling){0};
  if (!(min_nm > 0 && min_nm < max_nm && isfinite(max_nm)) || !(uniform >= 0.01 && uniform <= 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a range of wavelengths rises from above 0, as 380:780 does: not %g:%g",
                          min_nm, max_nm);
  if (bands > ABBE_SPECTRAL_SAMPLING_STEPS / 16)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu bands are too many: at most %u", bands,
                          ABBE_SPECTRAL_SAMPLING_STEPS / 16);
  abbe_spectral_sampling s = {.observer = desc->observer,
                              .steps = ABBE_SPECTRAL_SAMPLING_STEPS,
                              .lights = lights_of(scene)};
  double *density = calloc(2 * FINE, sizeof *density);
  s.lambda_nm = calloc(s.steps + 1, sizeof *s.lambda_nm);
  s.white = calloc(s.lights + 1, sizeof *s.white);
  s.xyz = calloc(s.lights * s.steps + 1, sizeof *s.xyz);
  s.power = calloc(s.lights * s.steps + 1, sizeof *s.power);
  abbe_result result = ABBE_OK;
  if (!density || !s.lambda_nm || !s.white || !s.xyz || !s.power)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of the spectrum");
  if (result == ABBE_OK) result = visible_density(scene, desc, density, error);
  if (result == ABBE_OK) {
    for (size_t i = 0; i < FINE; i++) density[i] = (1 - uniform) * density[i] + uniform / FINE;
    invert(density, min_nm, max_nm, bands, &s);
    result = fill_colours(scene, &s, error);
  }
  free(density);
  if (result != ABBE_OK) abbe_spectral_sampling_free(&s);
  *out = s;
  return result;
}

void abbe_spectral_sampling_free(abbe_spectral_sampling *s) {
  if (s == NULL) return;
  free(s->lambda_nm);
  free(s->white);
  free(s->xyz);
  free(s->power);
  *s = (abbe_spectral_sampling){0};
}

void abbe_spectral_sampling_colours(const abbe_spectral_sampling *s, abbe_rgb_space space,
                                    float (*rgb)[3]) {
  double matrix[9];
  abbe_rgb_space_from_xyz(space, matrix);
  for (size_t i = 0; i < s->lights * s->steps; i++) {
    double c[3] = {(double)s->xyz[i][0], (double)s->xyz[i][1], (double)s->xyz[i][2]};
    abbe_rgb_space_apply(matrix, c, c);
    for (int k = 0; k < 3; k++) rgb[i][k] = (float)c[k];
  }
}
