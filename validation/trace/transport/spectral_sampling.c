#include "validation/trace/transport/spectral_sampling.h"

#include "colorimetry/observer.h"
#include "colorimetry/observer_integral.h"
#include "colorimetry/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FINE = 8192, MOST_CUTS = 2048 };

/* Bins of the density that is inverted: of equal width, cut where bands and lines of lights begin
 * and end. Each part of the range from one such cut to the next has whole steps. */
typedef struct fine {
  size_t bins, cuts;
  double *edge_nm;       /* [bins + 1] */
  double *density, *one; /* [bins]: of all lights, of one */
  size_t cut[MOST_CUTS]; /* [cuts]: edges, the range's ends among them */
} fine;

/* The scene's lights, and then its environment. */
static size_t lights_of(const abbe_scene *scene) {
  return scene->light_count + (scene->environment != NULL);
}

static const abbe_illuminant *illuminant_of(const abbe_scene *scene, size_t light) {
  return light < scene->light_count ? &scene->light[light].illuminant
                                    : &scene->environment->illuminant;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Edges of bands, then ends of lines inside the range; how many. */
static size_t place_cuts(const abbe_scene *scene, const abbe_spectral_sampling_desc *d,
                         double nm[MOST_CUTS]) {
  const size_t bands = d->bands > 0 ? d->bands : 1;
  size_t count = 0;
  for (size_t band = 0; band <= bands; band++)
    nm[count++] = band < bands ? d->min_nm + (d->max_nm - d->min_nm) * (double)band / (double)bands
                               : d->max_nm;
  for (size_t l = 0; l < lights_of(scene); l++) {
    double line[ABBE_ILLUMINANT_MOST_LINES];
    const size_t lines = abbe_illuminant_lines(illuminant_of(scene, l), line);
    for (size_t i = 0; i < 2 * lines; i++) {
      const double end = line[i / 2] + (i % 2 == 0 ? -1 : 1) * ABBE_ILLUMINANT_LINE_HALF_NM;
      if (end > d->min_nm && end < d->max_nm && count < MOST_CUTS) nm[count++] = end;
    }
  }
  qsort(nm, count, sizeof *nm, ascending);
  return count;
}

static abbe_result make_fine(const abbe_scene *scene, const abbe_spectral_sampling_desc *d, fine *f,
                             abbe_error *error) {
  double cut_nm[MOST_CUTS];
  const size_t cuts = place_cuts(scene, d, cut_nm);
  f->edge_nm = calloc(3 * (FINE + cuts + 1), sizeof *f->edge_nm);
  if (f->edge_nm == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of the spectrum");
  f->density = f->edge_nm + FINE + cuts + 1;
  f->one = f->density + FINE + cuts + 1;
  size_t edges = 0, next = 0;
  for (size_t i = 0; i <= FINE; i++) {
    const double nm = i < FINE ? d->min_nm + (d->max_nm - d->min_nm) * (double)i / FINE : d->max_nm;
    for (; next < cuts && cut_nm[next] <= nm; next++) {
      if (f->cuts > 0 && !(cut_nm[next] > f->edge_nm[f->cut[f->cuts - 1]])) continue;
      f->cut[f->cuts++] = edges;
      f->edge_nm[edges++] = cut_nm[next];
    }
    if (edges == 0 || nm > f->edge_nm[edges - 1]) f->edge_nm[edges++] = nm;
  }
  f->bins = edges - 1;
  return ABBE_OK;
}

/* The material of an object that is the first to have it and glows; else NULL. */
static const abbe_material *glowing(const abbe_scene *scene, size_t object) {
  const abbe_material *m = scene->object[object].material;
  if (m == NULL || !abbe_material_is_fluorescent(m)) return NULL;
  for (size_t i = 0; i < object; i++)
    if (scene->object[i].material == m) return NULL;
  return m;
}

static size_t count_glowing(const abbe_scene *scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene->object_count; i++) count += glowing(scene, i) != NULL;
  return count;
}

/* What the camera sees of a material's emission, as of a light. */
static void add_glow(const abbe_spectral_sampling_desc *d, const abbe_material *m, double part,
                     fine *f) {
  double sum = 0;
  for (size_t i = 0; i < f->bins; i++) {
    double xyz[3];
    abbe_observer_xyz_of(d->observer, 0.5 * (f->edge_nm[i] + f->edge_nm[i + 1]), xyz);
    f->one[i] =
        abbe_material_emission(m, f->edge_nm[i], f->edge_nm[i + 1]) * (xyz[0] + xyz[1] + xyz[2]);
    sum += f->one[i];
  }
  for (size_t i = 0; sum > 0 && i < f->bins; i++) f->density[i] += f->one[i] / sum * part;
}

/* What the camera sees of the lights, a share of 1 in all, mixed with an even density. */
static abbe_result fill_density(const abbe_scene *scene, const abbe_spectral_sampling_desc *d,
                                fine *f, abbe_error *error) {
  const double range = d->max_nm - d->min_nm;
  const double parts = (double)(lights_of(scene) + count_glowing(scene));
  for (size_t l = 0; l < lights_of(scene); l++) {
    const abbe_illuminant *illuminant = illuminant_of(scene, l);
    double sum = 0;
    for (size_t i = 0; i < f->bins; i++) {
      const double lambda = 0.5 * (f->edge_nm[i] + f->edge_nm[i + 1]);
      double xyz[3];
      abbe_observer_xyz_of(d->observer, lambda, xyz);
      f->one[i] = abbe_illuminant_power(illuminant, lambda) * (xyz[0] + xyz[1] + xyz[2]) *
                  (f->edge_nm[i + 1] - f->edge_nm[i]);
      sum += f->one[i];
    }
    if (!(sum > 0 && isfinite(sum)))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s%s%s sends nothing that the eye sees between %g and %g nm; the eye "
                            "sees %g to %g nm",
                            l < scene->light_count ? "light '" : "the environment",
                            l < scene->light_count ? scene->light[l].name : "",
                            l < scene->light_count ? "'" : "", d->min_nm, d->max_nm,
                            ABBE_OBSERVER_MIN_NM, ABBE_OBSERVER_MAX_NM);
    for (size_t i = 0; i < f->bins; i++) f->density[i] += f->one[i] / sum / parts;
  }
  for (size_t i = 0; i < scene->object_count; i++)
    if (glowing(scene, i) != NULL) add_glow(d, glowing(scene, i), 1 / parts, f);
  for (size_t i = 0; i < f->bins; i++)
    f->density[i] =
        (1 - d->uniform) * f->density[i] + d->uniform * (f->edge_nm[i + 1] - f->edge_nm[i]) / range;
  return ABBE_OK;
}

/* Sum of the density from one edge to another. */
static double share_between(const fine *f, size_t from, size_t to) {
  double sum = 0;
  for (size_t i = from; i < to; i++) sum += f->density[i];
  return sum;
}

/* Cuts the part of the range from one edge to another into steps of equal shares. */
static void cut(const fine *f, size_t from, size_t to, size_t first, size_t end,
                abbe_spectral_sampling *s) {
  const double all = share_between(f, from, to);
  size_t bin = from;
  double below = 0;
  s->lambda_nm[first] = f->edge_nm[from];
  for (size_t k = first + 1; k < end; k++) {
    const double wanted = all * (double)(k - first) / (double)(end - first);
    while (bin + 1 < to && below + f->density[bin] < wanted) below += f->density[bin++];
    const double share = fmin(fmax((wanted - below) / f->density[bin], 0), 1);
    s->lambda_nm[k] = f->edge_nm[bin] + share * (f->edge_nm[bin + 1] - f->edge_nm[bin]);
  }
}

/* Each part has as many steps as are nearest to its share, at least one. */
static void invert(const fine *f, abbe_spectral_sampling *s) {
  size_t first = 0;
  const size_t parts = f->cuts - 1;
  for (size_t part = 0; part < parts; part++) {
    const double wanted = share_between(f, 0, f->cut[part + 1]) * (double)s->steps;
    const size_t most = s->steps - (parts - 1 - part);
    size_t end = part + 1 < parts ? (size_t)lround(wanted) : s->steps;
    if (end > most) end = most;
    if (end <= first) end = first + 1;
    cut(f, f->cut[part], f->cut[part + 1], first, end, s);
    first = end;
  }
  s->lambda_nm[s->steps] = f->edge_nm[f->bins];
}

static abbe_result fill_colours(const abbe_scene *scene, abbe_spectral_sampling *s,
                                abbe_error *error) {
  abbe_wavelengths bands = {.count = s->steps, .lambda_nm = s->lambda_nm, .edge_nm = s->lambda_nm};
  for (size_t l = 0; l < s->lights; l++) {
    const abbe_illuminant *illuminant = illuminant_of(scene, l);
    abbe_weights weights;
    ABBE_TRY(
        abbe_weights_make_by(s->observer, &bands, illuminant, ABBE_RGB_SPACE_XYZ, &weights, error));
    double power = 0;
    memcpy(s->white[l], weights.sum, sizeof s->white[l]);
    for (size_t k = 0; k < s->steps; k++) {
      const double watts =
          abbe_observer_integral_power(illuminant, s->lambda_nm[k], s->lambda_nm[k + 1]);
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

/* A watt of every wavelength, in the measure in which the light's own watt has Y = 1. */
static abbe_result fill_glow(abbe_spectral_sampling *s, abbe_error *error) {
  static const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E};
  const abbe_wavelengths bands = {
      .count = s->steps, .lambda_nm = s->lambda_nm, .edge_nm = s->lambda_nm};
  const double range = s->lambda_nm[s->steps] - s->lambda_nm[0];
  abbe_weights weights;
  if (s->rows == s->lights) return ABBE_OK;
  ABBE_TRY(abbe_weights_make_by(s->observer, &bands, &even, ABBE_RGB_SPACE_XYZ, &weights, error));
  for (size_t l = 0; l < s->lights; l++) {
    float(*to)[3] = s->xyz + (s->lights + l) * s->steps;
    double light = 0;
    for (size_t k = 0; k < s->steps; k++) {
      const double share = (s->lambda_nm[k + 1] - s->lambda_nm[k]) / range;
      light += (double)s->power[l * s->steps + k] / (double)s->steps * weights.weight[k][1] / share;
    }
    for (size_t k = 0; k < s->steps; k++) {
      const double share = (s->lambda_nm[k + 1] - s->lambda_nm[k]) / range;
      for (int c = 0; c < 3; c++) to[k][c] = (float)(weights.weight[k][c] / share / light);
      s->power[(s->lights + l) * s->steps + k] = 1;
    }
  }
  abbe_weights_free(&weights);
  return ABBE_OK;
}

abbe_result abbe_spectral_sampling_make(const abbe_scene *scene,
                                        const abbe_spectral_sampling_desc *desc,
                                        abbe_spectral_sampling *out, abbe_error *error) {
  const double min_nm = desc->min_nm, max_nm = desc->max_nm, uniform = desc->uniform;
  *out = (abbe_spectral_sampling){0};
  if (!(min_nm > 0 && min_nm < max_nm && isfinite(max_nm)) || !(uniform >= 0.01 && uniform <= 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a range of wavelengths rises from above 0, as 380:780 does: not %g:%g",
                          min_nm, max_nm);
  if (desc->bands > ABBE_SPECTRAL_SAMPLING_STEPS / 16)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu bands are too many: at most %u",
                          desc->bands, ABBE_SPECTRAL_SAMPLING_STEPS / 16);
  abbe_spectral_sampling s = {.observer = desc->observer,
                              .steps = ABBE_SPECTRAL_SAMPLING_STEPS,
                              .lights = lights_of(scene),
                              .rows = lights_of(scene) * (count_glowing(scene) > 0 ? 2 : 1)};
  fine f = {0};
  s.lambda_nm = calloc(s.steps + 1, sizeof *s.lambda_nm);
  s.white = calloc(s.lights + 1, sizeof *s.white);
  s.xyz = calloc(s.rows * s.steps + 1, sizeof *s.xyz);
  s.power = calloc(s.rows * s.steps + 1, sizeof *s.power);
  abbe_result result = make_fine(scene, desc, &f, error);
  if (result == ABBE_OK && (!s.lambda_nm || !s.white || !s.xyz || !s.power))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of the spectrum");
  if (result == ABBE_OK) result = fill_density(scene, desc, &f, error);
  if (result == ABBE_OK) {
    invert(&f, &s);
    result = fill_colours(scene, &s, error);
    if (result == ABBE_OK) result = fill_glow(&s, error);
  }
  free(f.edge_nm);
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

double abbe_spectral_sampling_brightest(const abbe_spectral_sampling *s) {
  double most = 1;
  for (size_t i = s->lights * s->steps; i < s->rows * s->steps; i++)
    most = fmax(most, (double)s->xyz[i][1]);
  return most;
}

void abbe_spectral_sampling_colours(const abbe_spectral_sampling *s, abbe_rgb_space space,
                                    float (*rgb)[3]) {
  double matrix[9];
  abbe_rgb_space_from_xyz(space, matrix);
  for (size_t i = 0; i < s->rows * s->steps; i++) {
    double c[3] = {(double)s->xyz[i][0], (double)s->xyz[i][1], (double)s->xyz[i][2]};
    abbe_rgb_space_apply(matrix, c, c);
    for (int k = 0; k < 3; k++) rgb[i][k] = (float)c[k];
  }
}
