#include "gl/scene/spectra/camera_bands.h"

#include "base/maths.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/upsampling.h"
#include "gl/device/float4.h"
#include "gl/scene/spectra/band_parts.h"

#include <math.h>
#include <stdlib.h>

/* From so many wavelengths on bands are joined first; where bands have parts, from so many on
 * samples take every second one: half of fewer has too few parts. */
enum { REFINED_FROM = 9, PARTED_FROM = 6 };

/* A step, nm: attenuation hardly varies in it. */
#define STEP_NM 2.5

size_t abbe_camera_bands_count(size_t wavelengths, size_t *levels) {
  size_t count = wavelengths;
  *levels = 1;
  for (size_t n = wavelengths; n > 1; (*levels)++) count += n = (n + 1) / 2;
  return count;
}

/* Bands of all sets of a refractor. */
static size_t bands_apart(const abbe_plan *plan) {
  size_t levels;
  return ABBE_CAMERA_BAND_SETS * abbe_camera_bands_count(plan->desc.wavelengths, &levels);
}

size_t abbe_camera_bands_crystals(const abbe_plan *plan) {
  const size_t parts = abbe_plan_surfaces(plan) * ABBE_PART_TEXELS + ABBE_PART_LIGHT_TEXELS;
  return bands_apart(plan) * (ABBE_BAND_COLOUR_TEXELS + (plan->band_parts ? parts : 0));
}

size_t abbe_camera_bands_glow(const abbe_plan *plan) {
  const size_t crystals = plan->crystals ? plan->refractor_count * (2 + bands_apart(plan)) : 0;
  return abbe_camera_bands_crystals(plan) + crystals;
}

size_t abbe_camera_bands_texels(const abbe_plan *plan) {
  const size_t glow =
      plan->glowing ? plan->refractor_count * bands_apart(plan) * ABBE_PART_LIGHT_TEXELS : 0;
  return abbe_camera_bands_glow(plan) + glow;
}

bool abbe_camera_bands_refine(const abbe_plan *plan) {
  return plan->desc.wavelengths >= REFINED_FROM && !plan->desc.everything;
}

/* Where a band's path is dear: half the time for the same error. Facets are cheap and show bands
 * apart: there it would cost 5 % in CIEDE2000. */
bool abbe_camera_bands_interleave(const abbe_plan *plan) {
  const bool dear = plan->multi_refractor_paths || plan->layers;
  const bool few = plan->band_parts && plan->desc.wavelengths < PARTED_FROM;
  return dear && !few && !plan->desc.everything && !abbe_camera_bands_refine(plan);
}

/* A set of bands while it is made; a set's own wavelengths, where its bands begin and end, and
 * their steps: those of band i begin at step[i]. */
typedef struct band_set {
  const abbe_plan *plan;
  const abbe_spectral_tables *tables;
  double *lambda_nm, *edge_nm; /* [wavelengths], [wavelengths + 1] */
  double (*weight)[3];         /* [wavelengths] X, Y, Z, each of a sum of 1 */
  double (*colour)[9];         /* [wavelengths] XYZ of a colour's RGB */
  double rgb_from_xyz[9];
  bool lifts;   /* else colours are not separated */
  size_t *step; /* [wavelengths + 1] */
  abbe_band_steps steps;
  double (*glow)[3];   /* [refractors][steps] XYZ that they emit; NULL: none is fluorescent */
  double *share;       /* [steps] of a band that is made */
  unsigned char *part; /* [steps] */
} band_set;

static size_t steps_of(const band_set *s, size_t i) {
  return (size_t)fmax(ceil((s->edge_nm[i + 1] - s->edge_nm[i]) / STEP_NM), 1);
}

/* Set 0 has the plan's bands, as all have of lines. Those of a share meet midway between its own
 * wavelengths, and end where the range ends. */
static bool has_plan_bands(const abbe_plan *plan, int set) {
  return set == 0 || plan->lines > 0;
}

static double own_nm(const abbe_plan *plan, const abbe_wavelengths *w, int set, size_t i) {
  const double width = w->edge_nm[i + 1] - w->edge_nm[i];
  return has_plan_bands(plan, set) ? w->lambda_nm[i]
                                   : w->edge_nm[i] + (set - 0.5) / ABBE_CAMERA_BAND_SHARES * width;
}

static double edge_nm(const abbe_plan *plan, const abbe_wavelengths *w, int set, size_t i) {
  if (i == 0 || i == w->count || has_plan_bands(plan, set)) return w->edge_nm[i];
  return 0.5 * (own_nm(plan, w, set, i - 1) + own_nm(plan, w, set, i));
}

static void place(band_set *s, int set) {
  const abbe_wavelengths *w = &s->tables->all;
  for (size_t i = 0; i <= w->count; i++) {
    s->edge_nm[i] = edge_nm(s->plan, w, set, i);
    if (i < w->count) s->lambda_nm[i] = own_nm(s->plan, w, set, i);
  }
}

void abbe_camera_bands_range(const abbe_plan *plan, const abbe_wavelengths *all, int set,
                             size_t band, double range_nm[2]) {
  size_t joined = 1, count = all->count;
  for (; band >= count; joined *= 2, count = (count + 1) / 2) band -= count;
  const size_t end = (band + 1) * joined;
  range_nm[0] = edge_nm(plan, all, set, band * joined);
  range_nm[1] = edge_nm(plan, all, set, end < all->count ? end : all->count);
}

/* Weights by their white; a white without X, say, is shared evenly. */
static double of_white(double xyz, double white, size_t count) {
  return white > 0 ? xyz / white : 1.0 / (double)count;
}

/* What bands have of a colour in RGB, and RGB of XYZ. Of light that makes too few colours all bands
 * show the light's own. */
static void lift(const abbe_scene *scene, band_set *s) {
  abbe_upsampling all;
  const abbe_wavelengths *w = &s->tables->all;
  s->lifts = abbe_upsampling_make_by(s->plan->desc.observer, abbe_scene_illuminant(scene),
                                     w->edge_nm[0], w->edge_nm[w->count], &all, NULL) == ABBE_OK;
  if (!s->lifts) return;
  abbe_matrix3_invert(all.to_xyz, s->rgb_from_xyz);
  for (size_t i = 0; i < w->count; i++)
    abbe_upsampling_band(&all, ABBE_RGB_SPACE_XYZ, s->edge_nm[i], s->edge_nm[i + 1], s->colour[i]);
}

/* What refractors emit in each step, of a photon. */
static abbe_result fill_glow(const abbe_scene *scene, band_set *s, abbe_error *error) {
  const size_t count = s->steps.count;
  if (!s->plan->glowing) return ABBE_OK;
  s->glow = calloc(s->plan->refractor_count * count + 1, sizeof *s->glow);
  if (s->glow == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  for (size_t r = 0; r < s->plan->refractor_count; r++) {
    const abbe_material *m = scene->object[s->plan->refractor_object[r]].material;
    if (s->plan->mirror[r] || !abbe_material_is_fluorescent(m)) continue;
    double *weight = calloc(abbe_material_glow_rows(m), sizeof *weight);
    if (weight == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
    abbe_glow_rows_weigh(scene, s->plan, &scene->object[s->plan->refractor_object[r]], weight);
    for (size_t i = 0; i < s->tables->all.count; i++)
      for (size_t k = s->step[i]; k < s->step[i + 1]; k++) {
        const double width = (s->edge_nm[i + 1] - s->edge_nm[i]) / (double)steps_of(s, i);
        const double from = s->edge_nm[i] + width * (double)(k - s->step[i]);
        double photons = 0;
        for (size_t row = 0; row < abbe_material_glow_rows(m); row++)
          photons += weight[row] * abbe_material_row_emission(m, row, from, from + width);
        abbe_observer_xyz_of(s->plan->desc.observer, from + width / 2, s->glow[r * count + k]);
        for (int c = 0; c < 3; c++) s->glow[r * count + k][c] *= photons / (from + width / 2);
      }
    free(weight);
  }
  return ABBE_OK;
}

static abbe_result begin(const abbe_scene *scene, const abbe_weights_range *light, int set,
                         band_set *s, abbe_error *error) {
  const size_t count = s->tables->all.count;
  const double *white = s->tables->camera.sum;
  s->lambda_nm = calloc(count + 1, sizeof *s->lambda_nm);
  s->edge_nm = calloc(count + 1, sizeof *s->edge_nm);
  s->weight = calloc(count + 1, sizeof *s->weight);
  s->step = calloc(count + 1, sizeof *s->step);
  s->colour = calloc(count + 1, sizeof *s->colour);
  if (s->lambda_nm == NULL || s->edge_nm == NULL || s->weight == NULL || s->step == NULL ||
      s->colour == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  place(s, set);
  for (size_t i = 0; i < count; i++) {
    double xyz[3];
    abbe_weights_range_xyz(light, s->edge_nm[i], s->edge_nm[i + 1], xyz);
    for (int c = 0; c < 3; c++) s->weight[i][c] = of_white(xyz[c], white[c], count);
    s->step[i + 1] = s->step[i] + steps_of(s, i);
  }
  lift(scene, s);
  if (!s->plan->band_parts) return ABBE_OK;
  s->share = calloc(s->step[count] + 1, sizeof *s->share);
  s->part = calloc(s->step[count] + 1, sizeof *s->part);
  if (s->share == NULL || s->part == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bands");
  ABBE_TRY(abbe_band_steps_make(scene, s->plan, s->step[count], &s->steps, error));
  for (size_t i = 0; i < count; i++)
    ABBE_TRY(abbe_band_steps_fill(&s->steps, scene, s->plan, light, s->step[i], s->step[i + 1],
                                  s->edge_nm[i], s->edge_nm[i + 1], error));
  for (size_t i = 0; i < s->step[count]; i++)
    for (int c = 0; c < 3; c++)
      s->steps.xyz[i][c] = of_white(s->steps.xyz[i][c], white[c], s->step[count]);
  return fill_glow(scene, s, error);
}

static void end(band_set *s) {
  free(s->lambda_nm);
  free(s->edge_nm);
  free(s->weight);
  free(s->colour);
  free(s->step);
  free(s->glow);
  free(s->share);
  free(s->part);
  abbe_band_steps_free(&s->steps);
}

/* A band of a level: the wavelengths that it has of its own, and with what of its neighbours. */
typedef struct level_band {
  size_t i, count, joined; /* band i of so many, each of so many wavelengths */
  bool interleaved;
} level_band;

/* How much of the level's band k belongs to it. */
static double share_of(const level_band *b, size_t k) {
  if (k == b->i) return 1;
  if (!b->interleaved || b->count <= 2 || (k + 1 != b->i && k != b->i + 1)) return 0;
  return k == 0 || k + 1 == b->count ? 1 : 0.5;
}

/* The level's bands that it has something of: from the return to *last. */
static size_t bands_of(const level_band *b, size_t *last) {
  const bool beside = b->interleaved && b->count > 2;
  *last = beside && b->i + 1 < b->count ? b->i + 1 : b->i;
  return beside && b->i > 0 ? b->i - 1 : b->i;
}

static size_t least(size_t a, size_t b) {
  return a < b ? a : b;
}

static void weigh(const band_set *s, const level_band *b, float weight_n[4]) {
  double sum[3] = {0, 0, 0};
  size_t last, first = bands_of(b, &last);
  for (size_t k = first; k <= last; k++)
    for (size_t i = k * b->joined; i < least((k + 1) * b->joined, s->tables->all.count); i++)
      for (int c = 0; c < 3; c++) sum[c] += share_of(b, k) * s->weight[i][c];
  for (int c = 0; c < 3; c++) weight_n[c] = (float)sum[c];
}

/* Columns of the matrix from XYZ to the band's, by its weight. */
static void fill_colour(const band_set *s, const level_band *b, const float weight[4],
                        float (*out)[4]) {
  double sum[9] = {0}, of_xyz[9];
  size_t last, first = bands_of(b, &last);
  for (size_t k = first; k <= last; k++)
    for (size_t i = k * b->joined; i < least((k + 1) * b->joined, s->tables->all.count); i++)
      for (int n = 0; n < 9; n++) sum[n] += share_of(b, k) * s->colour[i][n];
  abbe_matrix3_multiply(sum, s->rgb_from_xyz, of_xyz);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) {
      const bool told = s->lifts && weight[row] > 1e-9F;
      out[column][row] =
          told ? (float)(of_xyz[3 * row + column] / (double)weight[row]) : row == column;
    }
}

/* Means by brightness over the band's own wavelengths: index, n and k of a metal. */
static abbe_result join_indices(const band_set *s, const abbe_scene *scene, const level_band *b,
                                size_t r, abbe_camera_band *out, abbe_error *error) {
  const abbe_object *object = &scene->object[s->plan->refractor_object[r]];
  const abbe_spectral_tables *t = s->tables;
  double all = 0, n = 0, metal_n = 0, metal_k = 0;
  for (size_t i = b->i * b->joined; i < least((b->i + 1) * b->joined, t->all.count); i++) {
    const abbe_mirror_node *node = &t->mirror[r * t->all.count + i];
    double weight = 1e-9, index = 1;
    abbe_result result = ABBE_OK;
    for (int c = 0; c < 3; c++) weight += s->weight[i][c];
    if (!s->plan->mirror[r])
      result = abbe_material_n(object->material, s->lambda_nm[i], &index, error);
    if (result != ABBE_OK) return result;
    all += weight;
    n += weight * index;
    metal_n += weight * node->n;
    metal_k += weight * node->k;
  }
  out->weight_n[3] = (float)(n / all);
  out->surface[2] = (float)(metal_n / all);
  out->surface[3] = (float)(metal_k / all);
  return ABBE_OK;
}

/* Means over the band's own wavelengths of the indices, as crystals' texels have them. */
static abbe_result join_crystal(const band_set *s, const abbe_scene *scene, const level_band *b,
                                size_t r, float texel[4], abbe_error *error) {
  const abbe_material *m = scene->object[s->plan->refractor_object[r]].material;
  double all = 0, square[3] = {0, 0, 0};
  for (size_t i = b->i * b->joined; i < least((b->i + 1) * b->joined, s->tables->all.count); i++) {
    double weight = 1e-9;
    for (int c = 0; c < 3; c++) weight += s->weight[i][c];
    all += weight;
    for (int axis = 0; axis < 3; axis++) {
      double n;
      ABBE_TRY(abbe_material_n_along(m, axis, s->lambda_nm[i], &n, error));
      square[axis] += weight / (n * n);
    }
  }
  const double x_z = square[0] - square[2], y_z = square[1] - square[2];
  const double cos2 = x_z != 0 ? fmin(fmax(y_z / x_z, 0), 1) : 1;
  texel[0] = (float)(0.5 * (square[0] + square[2]) / all);
  texel[1] = (float)(0.5 * x_z / all);
  texel[2] = (float)sqrt(1 - cos2);
  texel[3] = (float)sqrt(cos2);
  return ABBE_OK;
}

/* Glass takes any axes, and a crystal of two indices any x. */
static void place_axes(const abbe_scene *scene, const abbe_plan *plan, float (*texel)[4]) {
  static const double up[3] = {0, 0, 1};
  for (size_t r = 0; r < plan->refractor_count; r++) {
    const abbe_object *o = &scene->object[plan->refractor_object[r]];
    const bool crystal = o->material != NULL && abbe_material_is_crystal(o->material);
    const double *z = crystal ? o->axis : up;
    double other[3] = {0}, x[3];
    other[fabs(z[0]) < 0.6 ? 0 : 1] = 1;
    abbe_vector_cross(z, other, x);
    abbe_vector_normalise(x);
    abbe_float4_store(z, 0, texel[2 * r]);
    abbe_float4_store(crystal && abbe_material_is_biaxial(o->material) ? o->axis_x : x, 0,
                      texel[2 * r + 1]);
  }
}

/* The surface for a depth by the usual path, or by one reflection: attenuation, or the factor that
 * makes it so. */
static double surface_of(const band_set *s, size_t r, const abbe_camera_band *band, double depth) {
  if (!s->plan->mirror[r % s->plan->refractor_count]) return depth / s->steps.path_m[r];
  return abbe_mirror_factor((double)band->surface[2], (double)band->surface[3], exp(-depth));
}

/* Without parts all wavelengths are attenuated alike. */
static double even_surface(const band_set *s, const abbe_scene *scene, size_t r) {
  const abbe_object *object = &scene->object[s->plan->refractor_object[r]];
  if (s->plan->mirror[r]) return 1 - object->mirror_reflectance;
  return abbe_material_attenuation(object->material, s->lambda_nm[0]) +
         abbe_medium_scattering(object->medium, s->lambda_nm[0]);
}

static void store_part(const double xyz[3], unsigned p, float (*light)[4]) {
  for (unsigned c = 0; c < 3; c++) light[2 * c + p / 4][p % 4] = (float)xyz[c];
}

/* The parts of a band: texels of its surfaces, `apart` from one to the next, of its light, and of
 * their glow. */
static void fill_parts(band_set *s, const level_band *b, abbe_camera_band *band, size_t apart,
                       float (*texel)[4], float (*light)[4], float (*glow)[4]) {
  size_t last, first = bands_of(b, &last);
  const size_t count = s->tables->all.count;
  const size_t from = s->step[least(first * b->joined, count)];
  const size_t to = s->step[least((last + 1) * b->joined, count)];
  for (size_t k = first; k <= last; k++)
    for (size_t i = s->step[least(k * b->joined, count)];
         i < s->step[least((k + 1) * b->joined, count)]; i++)
      s->share[i - from] = share_of(b, k);
  const abbe_band_share whole = {from, to, s->share, NULL, 0};
  abbe_band_parts_split(&s->steps, &whole, s->part);
  const size_t refractors = s->plan->refractor_count;
  for (size_t r = 0; r < refractors; r++)
    band[r * apart].surface[s->plan->mirror[r] ? 1 : 0] =
        (float)surface_of(s, r, &band[r * apart], abbe_band_share_depth(&s->steps, &whole, r));
  double xyz[ABBE_BAND_PARTS][3];
  for (unsigned p = 0; p < ABBE_BAND_PARTS; p++) {
    const abbe_band_share one = {from, to, s->share, s->part, p};
    abbe_band_share_xyz(&s->steps, &one, xyz[p]);
    for (size_t r = 0; r < refractors && glow != NULL; r++) {
      abbe_band_steps emitted = s->steps;
      emitted.xyz = s->glow + r * s->steps.count;
      double glow_xyz[3];
      abbe_band_share_xyz(&emitted, &one, glow_xyz);
      store_part(glow_xyz, p, glow + ABBE_PART_LIGHT_TEXELS * r * apart);
    }
    for (size_t r = 0; r < s->steps.surfaces; r++) {
      const double own = abbe_band_share_depth(&s->steps, &one, r);
      const double depth = own < 0 ? abbe_band_share_depth(&s->steps, &whole, r) : own;
      const size_t light_texels = r < refractors ? 0 : ABBE_PART_LIGHT_TEXELS * apart;
      s->steps.mean[r][p] = depth;
      texel[light_texels + ABBE_PART_TEXELS * r * apart + p / 4][p % 4] =
          (float)surface_of(s, r, &band[r % refractors * apart], depth);
    }
  }
  abbe_band_parts_fit(&s->steps, &whole, xyz);
  for (unsigned p = 0; p < ABBE_BAND_PARTS; p++) store_part(xyz[p], p, light);
}

/* Where a set's bands are written: of the first surface, and from one to the next. */
typedef struct band_place {
  abbe_camera_band *band;
  size_t apart;
  float (*colour)[4];
  float (*texel)[4], (*light)[4]; /* NULL: no parts */
  float (*crystal)[4];            /* NULL: none is one */
  float (*glow)[4];               /* NULL: none glows */
} band_place;

static abbe_result fill_level(band_set *s, const abbe_scene *scene, level_band level,
                              const band_place *to, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (; level.i < level.count && result == ABBE_OK; level.i++) {
    abbe_camera_band *band = to->band + level.i;
    for (size_t r = 0; r < s->plan->refractor_count && result == ABBE_OK; r++) {
      weigh(s, &level, band[r * to->apart].weight_n);
      result = join_indices(s, scene, &level, r, &band[r * to->apart], error);
      band[r * to->apart].surface[s->plan->mirror[r] ? 1 : 0] = (float)even_surface(s, scene, r);
    }
    for (size_t r = 0; to->crystal != NULL && r < s->plan->refractor_count; r++)
      if (!s->plan->mirror[r] && result == ABBE_OK)
        result = join_crystal(s, scene, &level, r, to->crystal[r * to->apart + level.i], error);
    fill_colour(s, &level, band->weight_n, to->colour + ABBE_BAND_COLOUR_TEXELS * level.i);
    if (result == ABBE_OK && to->texel != NULL)
      fill_parts(s, &level, band, to->apart, to->texel + ABBE_PART_TEXELS * level.i,
                 to->light + ABBE_PART_LIGHT_TEXELS * level.i,
                 to->glow != NULL ? to->glow + ABBE_PART_LIGHT_TEXELS * level.i : NULL);
  }
  return result;
}

static abbe_result fill_set(band_set *s, const abbe_scene *scene, bool shares, band_place to,
                            abbe_error *error) {
  level_band level = {.count = s->tables->all.count,
                      .joined = 1,
                      .interleaved = shares && abbe_camera_bands_interleave(s->plan)};
  ABBE_TRY(fill_level(s, scene, level, &to, error));
  while (level.count > 1) {
    to.band += level.count;
    to.colour += ABBE_BAND_COLOUR_TEXELS * level.count;
    if (to.texel != NULL) to.texel += ABBE_PART_TEXELS * level.count;
    if (to.texel != NULL) to.light += ABBE_PART_LIGHT_TEXELS * level.count;
    if (to.crystal != NULL) to.crystal += level.count;
    if (to.glow != NULL) to.glow += ABBE_PART_LIGHT_TEXELS * level.count;
    level.count = (level.count + 1) / 2;
    level.joined *= 2;
    ABBE_TRY(fill_level(s, scene, level, &to, error));
  }
  return ABBE_OK;
}

abbe_result abbe_camera_bands_fill(const abbe_scene *scene, const abbe_plan *plan,
                                   const abbe_spectral_tables *tables, abbe_camera_band *out,
                                   float (*texel)[4], abbe_error *error) {
  const abbe_wavelengths *w = &tables->all;
  size_t levels;
  const size_t count = abbe_camera_bands_count(w->count, &levels);
  const size_t apart = ABBE_CAMERA_BAND_SETS * count;
  abbe_weights_range light;
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), w->edge_nm[0],
                             w->edge_nm[w->count], &light);
  abbe_result result = ABBE_OK;
  if (plan->crystals) place_axes(scene, plan, texel + abbe_camera_bands_crystals(plan));
  for (int set = 0; set < ABBE_CAMERA_BAND_SETS && result == ABBE_OK; set++) {
    band_set s = {.plan = plan, .tables = tables};
    band_place to = {.band = out + (size_t)set * count,
                     .apart = apart,
                     .colour = texel + ABBE_BAND_COLOUR_TEXELS * (size_t)set * count};
    if (plan->band_parts) {
      float(*const parts)[4] = texel + ABBE_BAND_COLOUR_TEXELS * apart;
      to.texel = parts + ABBE_PART_TEXELS * (size_t)set * count;
      to.light = parts + ABBE_PART_TEXELS * plan->refractor_count * apart +
                 ABBE_PART_LIGHT_TEXELS * (size_t)set * count;
    }
    if (plan->crystals)
      to.crystal = texel + abbe_camera_bands_crystals(plan) + 2 * plan->refractor_count +
                   (size_t)set * count;
    if (plan->glowing)
      to.glow = texel + abbe_camera_bands_glow(plan) + ABBE_PART_LIGHT_TEXELS * (size_t)set * count;
    result = begin(scene, &light, set, &s, error);
    if (result == ABBE_OK) result = fill_set(&s, scene, set > 0, to, error);
    end(&s);
  }
  return result;
}

void abbe_camera_bands_reflected(const abbe_plan *plan, const abbe_camera_band *band,
                                 const float (*texel)[4], size_t r, double xyz[3]) {
  size_t levels;
  const size_t count = abbe_camera_bands_count(plan->desc.wavelengths, &levels);
  const size_t apart = ABBE_CAMERA_BAND_SETS * count, at = r * apart + count - 1;
  const double n = (double)band[at].surface[2], k = (double)band[at].surface[3];
  const float(*parts)[4] = texel + ABBE_BAND_COLOUR_TEXELS * apart;
  const float(*factor)[4] = parts + ABBE_PART_TEXELS * at;
  const float(*light)[4] = parts + ABBE_PART_TEXELS * plan->refractor_count * apart +
                           ABBE_PART_LIGHT_TEXELS * (count - 1);
  for (unsigned c = 0; c < 3; c++) {
    xyz[c] = plan->band_parts ? 0 : abbe_mirror_reflected(n, k, (double)band[at].surface[1]);
    for (unsigned p = 0; p < ABBE_BAND_PARTS && plan->band_parts; p++)
      xyz[c] += (double)light[2 * c + p / 4][p % 4] *
                abbe_mirror_reflected(n, k, (double)factor[p / 4][p % 4]);
  }
}
