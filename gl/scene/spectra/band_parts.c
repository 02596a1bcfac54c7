#include "gl/scene/spectra/band_parts.h"

#include "base/maths.h"
#include "spectral/optics.h"

#include <math.h>
#include <stdlib.h>

double abbe_usual_path(const abbe_object *object) {
  const abbe_mesh *mesh = &object->mesh;
  double volume = 0, area = 0;
  for (size_t i = 0; i < mesh->face_count; i++) {
    double from[3], to[3], across[3];
    const double *corner = mesh->position[mesh->face[i][0]];
    abbe_vector_subtract(mesh->position[mesh->face[i][1]], corner, from);
    abbe_vector_subtract(mesh->position[mesh->face[i][2]], corner, to);
    abbe_vector_cross(from, to, across);
    area += 0.5 * sqrt(abbe_vector_dot(across, across));
    abbe_vector_subtract(corner, object->min, from);
    volume += abbe_vector_dot(from, across) / 6;
  }
  return fmax(area > 0 ? 1.3 * 4 * fabs(volume) / area : 0, 1e-12);
}

/* A pleochroic refractor by its axes, of two indices x and z, and any other surface once. */
static bool splits(const abbe_scene *scene, const abbe_plan *plan, size_t s) {
  const size_t r = s % plan->refractor_count, axes = s / plan->refractor_count;
  const abbe_material *m = scene->object[plan->refractor_object[r]].material;
  if (!plan->pleochroic || plan->mirror[r] || !abbe_material_is_pleochroic(m)) return axes == 0;
  return axes > 0 && (axes != 2 || m->attenuation_yz[0] != NULL);
}

abbe_result abbe_band_steps_make(const abbe_scene *scene, const abbe_plan *plan, size_t count,
                                 abbe_band_steps *out, abbe_error *error) {
  const size_t refractors = plan->refractor_count, surfaces = abbe_plan_surfaces(plan);
  *out = (abbe_band_steps){.count = count,
                           .surfaces = surfaces,
                           .xyz = calloc(count + 1, sizeof *out->xyz),
                           .depth = calloc(surfaces * count + 1, sizeof *out->depth),
                           .path_m = calloc(surfaces + 1, sizeof *out->path_m),
                           .splits = calloc(surfaces + 1, sizeof *out->splits),
                           .mean = calloc(surfaces + 1, sizeof *out->mean)};
  if (out->xyz == NULL || out->depth == NULL || out->path_m == NULL || out->splits == NULL ||
      out->mean == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  for (size_t r = 0; r < surfaces; r++) {
    out->splits[r] = splits(scene, plan, r);
    out->path_m[r] = r >= refractors   ? out->path_m[r % refractors]
                     : plan->mirror[r] ? 0
                                       : abbe_usual_path(&scene->object[plan->refractor_object[r]]);
  }
  return ABBE_OK;
}

void abbe_band_steps_free(abbe_band_steps *steps) {
  free(steps->xyz);
  free(steps->depth);
  free(steps->path_m);
  free(steps->splits);
  free(steps->mean);
  *steps = (abbe_band_steps){0};
}

/* What surface s of the steps does at a wavelength. */
static abbe_result depth_of(const abbe_scene *scene, const abbe_plan *plan, size_t s, double path_m,
                            double lambda_nm, double *out, abbe_error *error) {
  const size_t r = s % plan->refractor_count, axes = s / plan->refractor_count;
  const abbe_object *object = &scene->object[plan->refractor_object[r]];
  double n = 0, k = 0, reflected = object->mirror_reflectance;
  abbe_result result = ABBE_OK;
  if (!plan->mirror[r]) {
    const bool along = axes > 0 && abbe_material_is_pleochroic(object->material);
    *out = path_m *
           ((along ? abbe_material_attenuation_along(object->material, (int)axes - 1, lambda_nm)
                   : abbe_material_attenuation(object->material, lambda_nm)) +
            abbe_medium_scattering(object->medium, lambda_nm));
  } else {
    if (object->conductor != NULL)
      result = abbe_material_nk(object->conductor, lambda_nm, &n, &k, error);
    if (object->conductor != NULL) reflected = abbe_optics_fresnel_conductor(1, n, k);
    *out = -log(fmax(reflected, 1e-300));
  }
  *out = fmin(*out, ABBE_BAND_MOST_DEPTH);
  return result;
}

abbe_result abbe_band_steps_fill(abbe_band_steps *steps, const abbe_scene *scene,
                                 const abbe_plan *plan, const abbe_weights_range *light,
                                 size_t first, size_t end, double from_nm, double to_nm,
                                 abbe_error *error) {
  for (size_t i = first; i < end; i++) {
    const double step = (to_nm - from_nm) / (double)(end - first);
    const double a = from_nm + step * (double)(i - first);
    abbe_weights_range_xyz(light, a, a + step, steps->xyz[i]);
    for (size_t r = 0; r < steps->surfaces; r++)
      ABBE_TRY(depth_of(scene, plan, r, steps->path_m[r], a + 0.5 * step,
                        &steps->depth[r * steps->count + i], error));
  }
  return ABBE_OK;
}

static double share_at(const abbe_band_share *band, size_t i) {
  return band->share != NULL ? band->share[i] : 1;
}

/* What a step weighs: of light that nobody sees a trace, so that it is somewhere, too. */
static double weight_of(const abbe_band_steps *s, const abbe_band_share *band, size_t i) {
  const double *xyz = s->xyz[band->first + i];
  if (band->part != NULL && band->part[i] != band->only) return 0;
  return share_at(band, i) * (xyz[0] + xyz[1] + xyz[2] + 1e-9);
}

/* A measure that is even for what differs in what is left: between 0 and 1. */
static double taken_at(const abbe_band_steps *s, size_t surface, size_t step) {
  const double depth = s->depth[surface * s->count + step];
  return depth / (1 + depth);
}

/* Sums of weight, of weight times the measure, and of its squares; the weighted variance. */
static double variance_of(const abbe_band_steps *s, const abbe_band_share *band, size_t surface,
                          double *mean) {
  double all = 0, sum = 0, squares = 0;
  for (size_t i = 0; i < band->end - band->first; i++) {
    const double w = weight_of(s, band, i), t = taken_at(s, surface, band->first + i);
    all += w;
    sum += w * t;
    squares += w * t * t;
  }
  *mean = all > 0 ? sum / all : 0;
  return all > 0 ? squares - sum * *mean : 0;
}

/* The mean of one surface over a part's steps; -1: it has none. */
static double mean_of(const abbe_band_steps *s, const abbe_band_share *band, size_t surface) {
  double mean;
  return variance_of(s, band, surface, &mean) > 0 || mean > 0 ? mean : -1;
}

/* Each step to the part that is nearest to it, again and again [Lloyd1982]. */
static void settle(const abbe_band_steps *s, const abbe_band_share *band, unsigned parts,
                   unsigned char *part) {
  enum { TURNS = 6 };
  for (int turn = 0; turn < TURNS; turn++) {
    for (size_t r = 0; r < s->surfaces; r++)
      for (unsigned p = 0; p < parts && s->splits[r]; p++) {
        const abbe_band_share one = {band->first, band->end, band->share, part, p};
        s->mean[r][p] = mean_of(s, &one, r);
      }
    for (size_t i = 0; i < band->end - band->first; i++) {
      double nearest = INFINITY;
      for (unsigned p = 0; p < parts; p++) {
        double square = 0;
        for (size_t r = 0; r < s->surfaces; r++)
          if (s->splits[r]) square += pow(taken_at(s, r, band->first + i) - s->mean[r][p], 2);
        if (!(square < nearest)) continue;
        nearest = square;
        part[i] = (unsigned char)p;
      }
    }
  }
}

void abbe_band_parts_split(const abbe_band_steps *steps, const abbe_band_share *band,
                           unsigned char *part) {
  const size_t count = band->end - band->first;
  for (size_t i = 0; i < count; i++) part[i] = 0;
  for (unsigned parts = 1; parts < ABBE_BAND_PARTS; parts++) {
    double most = 1e-15, border = 0;
    size_t surface = steps->surfaces;
    unsigned widest = 0;
    for (unsigned p = 0; p < parts; p++)
      for (size_t r = 0; r < steps->surfaces; r++) {
        if (!steps->splits[r]) continue;
        const abbe_band_share one = {band->first, band->end, band->share, part, p};
        double mean;
        const double variance = variance_of(steps, &one, r, &mean);
        if (!(variance > most)) continue;
        most = variance;
        border = mean;
        surface = r;
        widest = p;
      }
    if (surface == steps->surfaces) return; /* no part is uneven */
    for (size_t i = 0; i < count; i++)
      if (part[i] == widest && taken_at(steps, surface, band->first + i) > border)
        part[i] = (unsigned char)parts;
    settle(steps, band, parts + 1, part);
  }
}

void abbe_band_share_xyz(const abbe_band_steps *steps, const abbe_band_share *band, double xyz[3]) {
  for (int c = 0; c < 3; c++) xyz[c] = 0;
  for (size_t i = 0; i < band->end - band->first; i++)
    if (band->part == NULL || band->part[i] == band->only)
      for (int c = 0; c < 3; c++) xyz[c] += share_at(band, i) * steps->xyz[band->first + i][c];
}

double abbe_band_share_depth(const abbe_band_steps *steps, const abbe_band_share *band,
                             size_t surface) {
  const double *depth = steps->depth + surface * steps->count + band->first;
  double least = INFINITY, left = 0, all = 0;
  for (size_t i = 0; i < band->end - band->first; i++)
    if (weight_of(steps, band, i) > 0) least = fmin(least, depth[i]);
  for (size_t i = 0; i < band->end - band->first; i++) {
    const double w = weight_of(steps, band, i);
    all += w;
    left += w > 0 ? w * exp(-(depth[i] - least)) : 0;
  }
  return all > 0 ? least - log(left / all) : -1;
}

/* A passage: through two surfaces, so many usual paths in each. */
typedef struct passage {
  size_t surface[2];
  double length[2];
} passage;

/* Normal equations of what parts should hold: right is of X, Y and Z. */
typedef struct equations {
  double square[ABBE_BAND_PARTS][ABBE_BAND_PARTS], right[3][ABBE_BAND_PARTS];
} equations;

/* What the parts leave after a passage is to be what the band leaves; by brightness, long passages
 * would not count. */
static void add_passage(const abbe_band_steps *s, const abbe_band_share *band, const passage *p,
                        equations *to) {
  const double *first = s->depth + p->surface[0] * s->count + band->first;
  const double *second = s->depth + p->surface[1] * s->count + band->first;
  const double weight = 1 + p->length[0] + p->length[1];
  double left[ABBE_BAND_PARTS], xyz[3] = {0};
  for (size_t k = 0; k < ABBE_BAND_PARTS; k++)
    left[k] =
        exp(-p->length[0] * s->mean[p->surface[0]][k] - p->length[1] * s->mean[p->surface[1]][k]);
  for (size_t i = 0; i < band->end - band->first; i++) {
    const double by = exp(-p->length[0] * first[i] - p->length[1] * second[i]);
    for (int c = 0; c < 3; c++) xyz[c] += share_at(band, i) * by * s->xyz[band->first + i][c];
  }
  for (size_t k = 0; k < ABBE_BAND_PARTS; k++) {
    for (size_t j = 0; j < ABBE_BAND_PARTS; j++) to->square[k][j] += weight * left[k] * left[j];
    for (int c = 0; c < 3; c++) to->right[c][k] += weight * left[k] * xyz[c];
  }
}

/* The parts' light by least squares; of parts that are not used, none. */
static void solve(const equations *e, int c, const bool used[ABBE_BAND_PARTS],
                  double out[ABBE_BAND_PARTS]) {
  double m[ABBE_BAND_PARTS][ABBE_BAND_PARTS + 1] = {{0}};
  for (size_t k = 0; k < ABBE_BAND_PARTS; k++) {
    for (size_t j = 0; j < ABBE_BAND_PARTS; j++) m[k][j] = used[k] && used[j] ? e->square[k][j] : 0;
    m[k][k] = used[k] ? m[k][k] * (1 + 1e-9) + 1e-30 : 1; /* two parts may be alike */
    m[k][ABBE_BAND_PARTS] = used[k] ? e->right[c][k] : 0;
  }
  for (size_t k = 0; k < ABBE_BAND_PARTS; k++)
    for (size_t row = 0; row < ABBE_BAND_PARTS; row++) {
      const double by = row == k ? 0 : m[row][k] / m[k][k];
      for (size_t j = k; j <= ABBE_BAND_PARTS; j++) m[row][j] -= by * m[k][j];
    }
  for (size_t k = 0; k < ABBE_BAND_PARTS; k++) out[k] = m[k][ABBE_BAND_PARTS] / m[k][k];
}

/* Parts whose light would be below 0 have none, one after the other. */
static void solve_positive(const equations *e, int c, double out[ABBE_BAND_PARTS]) {
  bool used[ABBE_BAND_PARTS];
  size_t least = 0;
  for (size_t k = 0; k < ABBE_BAND_PARTS; k++) used[k] = true;
  do {
    solve(e, c, used, out);
    for (size_t k = 0; k < ABBE_BAND_PARTS; k++) least = out[k] < out[least] ? k : least;
    used[least] = false;
  } while (out[least] < 0);
}

void abbe_band_parts_fit(const abbe_band_steps *s, const abbe_band_share *band,
                         double xyz[ABBE_BAND_PARTS][3]) {
  static const double length[] = {0, 0.2, 0.5, 1, 2, 4};
  equations e = {0};
  size_t before = s->surfaces;
  for (size_t r = 0; r < s->surfaces; r++) {
    if (!s->splits[r]) continue;
    for (size_t l = 0; l < sizeof length / sizeof *length; l++) {
      add_passage(s, band, &(passage){{r, r}, {length[l], 0}}, &e);
      if (before < s->surfaces)
        add_passage(s, band, &(passage){{r, before}, {0.5 * length[l], 0.5 * length[l]}}, &e);
    }
    before = r;
  }
  for (int c = 0; c < 3; c++) {
    double all = 0, fitted = 0, part[ABBE_BAND_PARTS];
    solve_positive(&e, c, part);
    for (size_t k = 0; k < ABBE_BAND_PARTS; k++) all += xyz[k][c], fitted += part[k];
    for (size_t k = 0; k < ABBE_BAND_PARTS && fitted > 0; k++) xyz[k][c] = part[k] * all / fitted;
  }
}
