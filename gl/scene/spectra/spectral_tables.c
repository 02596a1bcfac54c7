#include "gl/scene/spectra/spectral_tables.h"

#include "gl/device/float4.h"
#include "gl/plan/examine/examine.h"
#include "gl/scene/spectra/band_parts.h"
#include "spectral/optics.h"

#include <math.h>
#include <stdlib.h>

enum { HALF_STEPS = 32 };

/* A half of a band, in steps: attenuation of each and its brightness. */
typedef struct half {
  double per[HALF_STEPS], weight[HALF_STEPS], all;
} half;

static double range_of(const half *h) {
  double least = INFINITY, most = 0;
  for (int i = 0; i < HALF_STEPS; i++) {
    least = fmin(least, h->per[i]);
    most = fmax(most, h->per[i]);
  }
  return most - least;
}

/* Attenuation that leaves so much of an amount as the mean of the light from one part of its
 * brightness to another does. */
static double effective(const half *h, double amount, double from, double to) {
  double least = INFINITY, left = 0, all = 0, before = 0;
  for (int turn = 0; turn < 2; turn++, before = 0)
    for (int i = 0; i < HALF_STEPS; before += h->weight[i++]) {
      const double begins = fmax(before, from * h->all);
      const double w = fmin(before + h->weight[i], to * h->all) - begins;
      if (w <= 0) continue;
      if (turn == 0) least = fmin(least, h->per[i]);
      if (turn == 1) all += w;
      if (turn == 1) left += w * exp(-amount * (h->per[i] - least));
    }
  return least - log(left / all) / amount;
}

static void fill_half(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                      const abbe_weights_range *light, double from_nm, double to_nm, float *parts,
                      float *range) {
  const double amount =
      plan->mirror[r % plan->refractor_count]
          ? 1
          : abbe_usual_path(&scene->object[plan->refractor_object[r % plan->refractor_count]]);
  const double step = (to_nm - from_nm) / HALF_STEPS;
  half h = {.all = 0};
  for (int i = 0; i < HALF_STEPS; i++) {
    double xyz[3];
    abbe_weights_range_xyz(light, from_nm + step * i, from_nm + step * (i + 1), xyz);
    h.all += h.weight[i] = xyz[1] + 1e-12;
    h.per[i] = abbe_tint_attenuation(scene, plan, r, from_nm + step * (i + 0.5));
  }
  parts[0] = (float)effective(&h, amount, 0, 0.5);
  parts[1] = (float)effective(&h, amount, 0.5, 1);
  *range = fmaxf(*range, (float)range_of(&h));
}

/* out: [w->count][surfaces] attenuation of two parts of the half of the band below the node, and
 * of two above it, each of a half's brightness, as they leave their mean of a usual path; then the
 * most by which it differs within a half, and abbe_tint_of(). Of one node both halves are the whole
 * band. */
static void tint_nodes_fill(const abbe_scene *scene, const abbe_plan *plan,
                            const abbe_wavelengths *w, float (*out)[ABBE_TINT_TEXELS][4]) {
  const bool one = w->count == 1;
  abbe_weights_range light;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), w->edge_nm[0],
                             w->edge_nm[w->count], &light);
  const size_t surfaces = abbe_plan_surfaces(plan);
  for (size_t r = 0; r < surfaces; r++) {
    const int tint = abbe_tint_of(scene, plan, r);
    const size_t as = tint < 0 ? r : (size_t)tint; /* all that a path lists */
    for (size_t i = 0; i < w->count; i++) {
      float(*of)[4] = out[i * surfaces + r];
      const double end_nm = one ? w->edge_nm[1] : w->lambda_nm[i];
      const double begin_nm = one ? w->edge_nm[0] : w->lambda_nm[i];
      of[1][0] = 0;
      of[1][1] = (float)tint;
      fill_half(scene, plan, as, &light, w->edge_nm[i], end_nm, of[0], &of[1][0]);
      fill_half(scene, plan, as, &light, begin_nm, w->edge_nm[i + 1], of[0] + 2, &of[1][0]);
    }
  }
}

enum { MOST_STEPS = 128, MOST_SUMS = 1024 };

size_t abbe_spectral_tables_node(size_t wavelengths, size_t nodes, size_t k) {
  return nodes > 1 ? (k * (wavelengths - 1) + (nodes - 1) / 2) / (nodes - 1) : 0;
}

/* Several begin and end with the outer lines' own ends, as all light lies between two nodes. */
static abbe_result make_lines(const abbe_scene *scene, const abbe_plan *plan, abbe_wavelengths *out,
                              abbe_error *error) {
  double line[ABBE_PLAN_MOST_LINES], min = plan->desc.min_nm, max = plan->desc.max_nm;
  const size_t count = abbe_spectral_needs_lines(scene, min, max, line);
  if (count > 1) {
    min = line[0] -= ABBE_ILLUMINANT_LINE_HALF_NM;
    max = line[count - 1] += ABBE_ILLUMINANT_LINE_HALF_NM;
  }
  return abbe_wavelengths_of_nodes(count, line, min, max, out, error);
}

/* The nodes that every photon takes, as a sampling of their own. */
static abbe_result make_coarse(abbe_spectral_tables *t, size_t count, abbe_error *error) {
  const abbe_wavelengths *all = &t->all;
  abbe_wavelengths *out = &t->coarse;
  *out = (abbe_wavelengths){.count = count,
                            .lambda_nm = calloc(count, sizeof *out->lambda_nm),
                            .edge_nm = calloc(count + 1, sizeof *out->edge_nm)};
  if (out->lambda_nm == NULL || out->edge_nm == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  for (size_t k = 0; k < count; k++)
    out->lambda_nm[k] = all->lambda_nm[abbe_spectral_tables_node(all->count, count, k)];
  for (size_t k = 1; k < count; k++)
    out->edge_nm[k] =
        count == all->count ? all->edge_nm[k] : 0.5 * (out->lambda_nm[k - 1] + out->lambda_nm[k]);
  out->edge_nm[0] = all->edge_nm[0];
  out->edge_nm[count] = all->edge_nm[all->count];
  return ABBE_OK;
}

/* The material whose index gives how far along from node to node light is laid that first met
 * refractor i of the plan: its own; of a mirror, which sends all wavelengths in one direction, that
 * of the first refractor that is none. NULL: there is none. */
static const abbe_material *mirror_nodes_laid_by(const abbe_scene *scene, const abbe_plan *plan,
                                                 size_t i) {
  if (!plan->mirror[i]) return scene->object[plan->refractor_object[i]].material;
  for (size_t k = 0; k < plan->refractor_count; k++)
    if (!plan->mirror[k]) return scene->object[plan->refractor_object[k]].material;
  return NULL;
}

static abbe_result evaluate_materials(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_spectral_tables *t, abbe_error *error) {
  const size_t n = t->all.count, refractors = plan->refractor_count;
  t->index = calloc(refractors * n + 1, sizeof *t->index);
  t->attenuation = calloc(refractors * n + 1, sizeof *t->attenuation);
  t->attenuation_550 = calloc(refractors + 1, sizeof *t->attenuation_550);
  t->mirror = calloc(refractors * n + 1, sizeof *t->mirror);
  if (t->index == NULL || t->attenuation == NULL || t->attenuation_550 == NULL || t->mirror == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for spectra");
  for (size_t i = 0; i < refractors; i++) {
    const abbe_material *material = mirror_nodes_laid_by(scene, plan, i);
    const abbe_object *object = &scene->object[plan->refractor_object[i]];
    if (plan->mirror[i]) {
      abbe_weights_range light;
      abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene),
                                 t->all.edge_nm[0], t->all.edge_nm[n], &light);
      ABBE_TRY(abbe_mirror_nodes_fill(object, &t->all, &light, t->mirror + i * n, error));
    }
    for (size_t k = 0; k < n; k++) t->index[i * n + k] = 1;
    if (material == NULL) continue;
    if (!plan->mirror[i])
      t->attenuation_550[i] = abbe_material_attenuation(material, 550.0) +
                              abbe_medium_scattering(object->medium, 550.0);
    for (size_t k = 0; k < n; k++) {
      const double lambda_nm = t->all.lambda_nm[k];
      ABBE_TRY(abbe_material_n(material, lambda_nm, &t->index[i * n + k], error));
      if (!plan->mirror[i])
        t->attenuation[i * n + k] = abbe_material_attenuation(material, lambda_nm) +
                                    abbe_medium_scattering(object->medium, lambda_nm);
    }
  }
  return ABBE_OK;
}

/* Y of the light's band below and above each of the set's nodes, from column `first` of every
 * sample. */
static void weigh_halves(const abbe_weights_range *range, const abbe_wavelengths *w, size_t all,
                         int first, float (*sample)[4]) {
  for (size_t k = 0; k < w->count; k++) {
    const size_t i = w->count == all ? k : abbe_spectral_tables_node(all, w->count, k);
    double below[3], above[3];
    abbe_weights_range_xyz(range, w->edge_nm[k], w->lambda_nm[k], below);
    abbe_weights_range_xyz(range, w->lambda_nm[k], w->edge_nm[k + 1], above);
    sample[i][first] = (float)below[1];
    sample[i][first + 1] = (float)above[1];
  }
}

/* The coarse set's intervals' shares of the light, of X, Y and Z alike, by their mean. */
static void weigh_intervals(const abbe_weights_range *range, const abbe_wavelengths *w,
                            float *weight) {
  const size_t intervals = w->count - 1;
  double xyz[3], total = 0;
  for (size_t k = 0; k < intervals; k++) {
    abbe_weights_range_xyz(range, w->lambda_nm[k], w->lambda_nm[k + 1], xyz);
    weight[k] = (float)(xyz[0] + xyz[1] + xyz[2]);
    total += (double)weight[k];
  }
  for (size_t k = 0; k < intervals; k++)
    weight[k] = total > 0 ? (float)((double)weight[k] * (double)intervals / total) : 1;
}

static abbe_result weigh_lights(const abbe_scene *scene, const abbe_plan *plan,
                                abbe_spectral_tables *t, abbe_error *error) {
  const size_t n = t->all.count, lights = plan->light_view_count;
  t->sample_weight = calloc(lights * n + 1, sizeof *t->sample_weight);
  t->interval_weight = calloc(lights * t->coarse.count + 1, sizeof *t->interval_weight);
  if (t->sample_weight == NULL || t->interval_weight == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for weights");
  for (size_t i = 0; i < lights; i++) {
    abbe_weights_range range; /* both sets have the same ends */
    abbe_weights_range_make_by(plan->desc.observer, &scene->light[i].illuminant, t->all.edge_nm[0],
                               t->all.edge_nm[n], &range);
    weigh_halves(&range, &t->all, n, 0, t->sample_weight + i * n);
    weigh_halves(&range, &t->coarse, n, 2, t->sample_weight + i * n);
    weigh_intervals(&range, &t->coarse, t->interval_weight + i * (t->coarse.count - 1));
  }
  return ABBE_OK;
}

abbe_result abbe_spectral_tables_intervals(const abbe_spectral_tables *t, const abbe_scene *scene,
                                           const abbe_plan *plan, size_t bands, size_t first,
                                           float (**out)[4], abbe_error *error) {
  const bool refines = t->coarse.count < t->all.count;
  const abbe_interval_sums of = {scene, plan, t->steps, bands, first};
  const size_t coarse = abbe_interval_sums_size(plan, t->steps, t->coarse.count);
  const size_t all = refines ? abbe_interval_sums_size(plan, t->steps, t->all.count) : 0;
  *out = calloc(coarse + all + 1, sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for wavelengths");
  float(*rest)[4] = abbe_interval_sums_fill(&of, &t->coarse, *out);
  if (refines) abbe_interval_sums_fill(&of, &t->all, rest);
  return ABBE_OK;
}

static abbe_result fill_tints(const abbe_scene *scene, const abbe_plan *plan,
                              abbe_spectral_tables *t, abbe_error *error) {
  if (plan->tints == 0) return ABBE_OK;
  const bool refines = t->coarse.count < t->all.count;
  const size_t coarse = t->coarse.count * abbe_plan_surfaces(plan);
  t->tints =
      calloc(coarse + (refines ? t->all.count * abbe_plan_surfaces(plan) : 0), sizeof *t->tints);
  if (t->tints == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for attenuation");
  tint_nodes_fill(scene, plan, &t->coarse, t->tints);
  if (refines) tint_nodes_fill(scene, plan, &t->all, t->tints + coarse);
  return ABBE_OK;
}

abbe_result abbe_spectral_tables_make(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_spectral_tables *out, abbe_error *error) {
  const abbe_render_desc *desc = &plan->desc;
  abbe_spectral_tables *t = out;
  *t = (abbe_spectral_tables){.steps = MOST_STEPS};
  abbe_result result = plan->lines > 0 ? make_lines(scene, plan, &t->all, error)
                                       : abbe_wavelengths_make(desc->wavelengths, desc->min_nm,
                                                               desc->max_nm, &t->all, error);
  if (result == ABBE_OK) result = make_coarse(t, abbe_plan_least_wavelengths(plan), error);
  while (t->steps > 2 && t->steps * t->coarse.count > MOST_SUMS) t->steps /= 2;
  if (result == ABBE_OK) result = evaluate_materials(scene, plan, t, error);
  if (result == ABBE_OK)
    result = abbe_weights_make_by(desc->observer, &t->all, abbe_scene_illuminant(scene),
                                  ABBE_RGB_SPACE_XYZ, &t->camera, error);
  if (result != ABBE_OK || !plan->caustics || abbe_method_of(desc->profile)->own_passes)
    return result;
  result = weigh_lights(scene, plan, t, error);
  if (result == ABBE_OK)
    result = abbe_spectral_tables_intervals(t, scene, plan, 0, 0, &t->intervals, error);
  return result == ABBE_OK ? fill_tints(scene, plan, t, error) : result;
}

void abbe_spectral_tables_free(abbe_spectral_tables *t) {
  abbe_wavelengths_free(&t->all);
  abbe_wavelengths_free(&t->coarse);
  abbe_weights_free(&t->camera);
  free(t->index);
  free(t->attenuation);
  free(t->attenuation_550);
  free(t->mirror);
  free(t->intervals);
  free(t->tints);
  free(t->sample_weight);
  free(t->interval_weight);
  *t = (abbe_spectral_tables){0};
}

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
    ABBE_TRY(abbe_material_nk(mirror->conductor, w->lambda_nm[i], &out[i].n, &out[i].k, error));
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

size_t abbe_interval_sums_texels(const abbe_plan *plan) {
  return plan->tints > 0 ? 3 : 2;
}

size_t abbe_interval_sums_size(const abbe_plan *plan, size_t steps, size_t nodes) {
  const size_t rows = plan->light_view_count * abbe_plan_surfaces(plan) * (nodes + 1);
  return rows * abbe_interval_sums_texels(plan) * (steps + 1);
}

/* A part of a light's spectrum: X, Y, Z, or its share in each of three bands, and the middle of
 * each. */
typedef struct spectrum_part {
  double light[3], lambda_nm[3];
} spectrum_part;

static void weigh_part(const abbe_interval_sums *of, const abbe_weights_range *range, double from,
                       double to, spectrum_part *out) {
  const abbe_illuminant *illuminant = range->illuminant;
  const double min = range->min_nm, max = range->max_nm;
  const double width = (max - min) / (double)(of->bands > 0 ? of->bands : 1);
  if (of->bands == 0) abbe_weights_range_xyz(range, from, to, out->light);
  for (int c = 0; c < 3; c++) {
    const double low = min + width * (double)(of->band + (size_t)c);
    const double a = of->bands == 0 ? from : fmax(from, low);
    const double b = of->bands == 0 ? to : fmin(to, low + width);
    out->lambda_nm[c] = 0.5 * (a + fmax(a, b));
    if (of->bands > 0)
      out->light[c] = b > a ? abbe_weights_band_power(illuminant, min, max, a, b) : 0;
  }
}

/* One interval of refractor r from node b = i down to node a = i - 1, step by step. Where the index
 * stays, the place along is by wavelength; so it is without a material. */
static void fill_interval(const abbe_interval_sums *of, const abbe_wavelengths *w,
                          const abbe_weights_range *range, size_t r, size_t i, float (*out)[4]) {
  const abbe_material *material =
      mirror_nodes_laid_by(of->scene, of->plan, r % of->plan->refractor_count);
  const size_t texels = abbe_interval_sums_texels(of->plan);
  double min = w->edge_nm[0], max = w->edge_nm[w->count];
  double a = i > 0 ? w->lambda_nm[i - 1] : w->edge_nm[0];
  double b = i < w->count ? w->lambda_nm[i] : w->edge_nm[w->count];
  double edge = i == 0 ? a : i == w->count ? b : w->edge_nm[i];
  if (w->count == 1) { /* the one node keeps its whole band in the interval before it */
    a = edge = i == 0 ? min : max;
    b = max;
  }
  const bool lines = of->plan->lines > 1; /* the nodes, with all light at the nearer one */
  double n_a = 1, n_b = 1, sum[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, taken[3] = {0, 0, 0},
         before = b;
  if (material != NULL) {
    abbe_material_n(material, a, &n_a, NULL);
    abbe_material_n(material, b, &n_b, NULL);
  }
  for (size_t k = 0; k <= of->steps; k++, out += texels) {
    size_t middle = of->steps / 2;
    double lambda_nm = k <= middle ? b + (edge - b) * (double)k / (double)middle
                                   : edge + (a - edge) * (double)(k - middle) / (double)middle;
    double at[4] = {lambda_nm}, n[4], t[4]; /* here, then the middle of each of the three */
    spectrum_part part;
    weigh_part(of, range, lambda_nm, before, &part);
    for (int c = 0; c < 3; c++) at[1 + c] = part.lambda_nm[c];
    for (int c = 0; c < 4 && lines; c++) at[c] = k <= middle ? b : a;
    for (int c = 0; c < 4; c++) {
      n[c] = n_b;
      if (material != NULL) abbe_material_n(material, at[c], &n[c], NULL);
      t[c] = n_a != n_b ? (n[c] - n_b) / (n_a - n_b) : b > a ? (b - at[c]) / (b - a) : 0;
    }
    for (int c = 0; c < 3; c++) {
      sum[c] += part.light[c];
      moment[c] += part.light[c] * t[1 + c];
      if (of->plan->tints > 0)
        taken[c] += part.light[c] * abbe_tint_attenuation(of->scene, of->plan, r, at[1 + c]);
    }
    abbe_float4_store(sum, t[0], out[0]);
    abbe_float4_store(moment, n[0], out[1]);
    if (of->plan->tints > 0) abbe_float4_store(taken, 0, out[2]);
    before = lambda_nm;
  }
}

float (*abbe_interval_sums_fill(const abbe_interval_sums *of, const abbe_wavelengths *w,
                                float (*out)[4]))[4] {
  const abbe_plan *plan = of->plan;
  const size_t an_interval = abbe_interval_sums_texels(plan) * (of->steps + 1);
  for (size_t light = 0; light < plan->light_view_count; light++) {
    abbe_weights_range range;
    abbe_weights_range_make_by(plan->desc.observer, &of->scene->light[light].illuminant,
                               w->edge_nm[0], w->edge_nm[w->count], &range);
    for (size_t k = 0; k < abbe_plan_surfaces(plan); k++)
      for (size_t i = 0; i <= w->count; i++, out += an_interval)
        fill_interval(of, w, &range, k, i, out);
  }
  return out;
}
