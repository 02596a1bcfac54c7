#include "gl/scene/spectra/spectral_tables.h"

#include "spectral/optics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 64 /* parts of an interval, or of a band */ };

static double straight_at(const abbe_material *metal, double lambda_nm) {
  double n = 0, k = 0;
  abbe_material_nk(metal, lambda_nm, &n, &k, NULL);
  return abbe_optics_fresnel_conductor(1, n, k);
}

/* What a metal absorbs at normal incidence; all, where there is none. */
static double taken_by(double n, double k) {
  return k < 0 ? 1 : 1 - abbe_optics_fresnel_conductor(1, n, k);
}

double abbe_mirror_factor(double n, double k, double reflected) {
  const double taken = taken_by(n, k);
  return taken > 0 ? (1 - reflected) / taken : 1;
}

double abbe_mirror_reflected(double n, double k, double factor) {
  return fmax(1 - factor * taken_by(n, k), 0);
}

/* A system of three diagonals, of least squares, within 0 and 1: by turns, each corner where it
 * does best beside its neighbours. */
static void solve(size_t count, const double *beside, const double *middle, const double *right,
                  double *corner) {
  enum { TURNS = 100 };
  for (int turn = 0; turn < TURNS; turn++)
    for (size_t i = 0; i < count; i++) {
      double rest = right[i];
      if (i > 0) rest -= beside[i] * corner[i - 1];
      if (i + 1 < count) rest -= beside[i + 1] * corner[i + 1];
      corner[i] = fmin(fmax(rest / middle[i], 0), 1);
    }
}

/* What counts: how bright the light is, then its colour, and last what nobody sees. */
static double weight_of(const abbe_weights_range *light, double from_nm, double to_nm) {
  double xyz[3];
  abbe_weights_range_xyz(light, from_nm, to_nm, xyz);
  return xyz[1] + 0.05 * (xyz[0] + xyz[2]) +
         1e-4 * (to_nm - from_nm) / (light->max_nm - light->min_nm);
}

/* The polygon through all nodes that is nearest to the metal's reflectance; capacity for 3 numbers
 * a node, zeroed. */
static void fit(const abbe_material *metal, const abbe_wavelengths *w,
                const abbe_weights_range *light, double *room, double *corner) {
  double *beside = room, *middle = room + w->count, *right = room + 2 * w->count;
  for (size_t i = 0; i + 1 < w->count; i++) {
    const double from = w->lambda_nm[i], width = w->lambda_nm[i + 1] - from;
    for (int k = 0; k < PARTS; k++) {
      const double t = (k + 0.5) / PARTS;
      const double here =
          weight_of(light, from + width * k / PARTS, from + width * (k + 1) / PARTS);
      const double straight = straight_at(metal, from + t * width);
      middle[i] += here * (1 - t) * (1 - t);
      middle[i + 1] += here * t * t;
      beside[i + 1] += here * t * (1 - t);
      right[i] += here * (1 - t) * straight;
      right[i + 1] += here * t * straight;
    }
  }
  solve(w->count, beside, middle, right, corner);
}

/* The mean over the one band that there is. */
static double mean_of(const abbe_material *metal, const abbe_wavelengths *w,
                      const abbe_weights_range *light) {
  const double from = w->edge_nm[0], width = w->edge_nm[1] - from;
  double sum = 0, all = 0;
  for (int k = 0; k < PARTS; k++) {
    const double here = weight_of(light, from + width * k / PARTS, from + width * (k + 1) / PARTS);
    all += here;
    sum += here * straight_at(metal, from + width * (k + 0.5) / PARTS);
  }
  return sum / all;
}

abbe_result abbe_mirror_nodes_fill(const abbe_object *mirror, const abbe_wavelengths *w,
                                   const abbe_weights_range *light, abbe_mirror_node *out,
                                   abbe_error *error) {
  for (size_t i = 0; i < w->count; i++) {
    out[i] = (abbe_mirror_node){.factor = 1 - mirror->mirror_reflectance, .k = -1};
    if (mirror->conductor == NULL) continue;
    abbe_result result =
        abbe_material_nk(mirror->conductor, w->lambda_nm[i], &out[i].n, &out[i].k, error);
    if (result != ABBE_OK) return result;
  }
  if (mirror->conductor == NULL) return ABBE_OK;
  double *room = calloc(4 * w->count + 1, sizeof *room), *corner = room + 3 * w->count;
  if (room == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a mirror's table");
  if (w->count > 1)
    fit(mirror->conductor, w, light, room, corner);
  else
    corner[0] = mean_of(mirror->conductor, w, light);
  for (size_t i = 0; i < w->count; i++) {
    const double taken = taken_by(out[i].n, out[i].k);
    out[i].factor = taken > 0 ? (1 - corner[i]) / taken : 1;
  }
  free(room);
  return ABBE_OK;
}

const abbe_material *abbe_mirror_nodes_laid_by(const abbe_scene *scene, const abbe_plan *plan,
                                               size_t i) {
  if (!plan->mirror[i]) return scene->object[plan->refractor_object[i]].material;
  for (size_t k = 0; k < plan->refractor_count; k++)
    if (!plan->mirror[k]) return scene->object[plan->refractor_object[k]].material;
  return NULL;
}
