#include "gl/plan/examine/examine.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/pleochroism.h"
#include "colorimetry/weights.h"
#include "spectral/biaxial.h"
#include "spectral/film.h"
#include "spectral/optics.h"
#include "spectral/uniaxial.h"

#include <math.h>
#include <stdlib.h>

enum { STEPS = 81 };

abbe_result abbe_material_range_make(const abbe_material *material, double min_nm, double max_nm,
                                     abbe_material_range *out, abbe_error *error) {
  const double middle_nm = 0.5 * (min_nm + max_nm);
  *out = (abbe_material_range){.least_n = INFINITY,
                               .most_n = -INFINITY,
                               .least_per_m = INFINITY,
                               .most_per_m = -INFINITY,
                               .middle_per_m = abbe_material_attenuation(material, middle_nm)};
  for (int i = 0; i < STEPS; i++) {
    const double lambda_nm = min_nm + (max_nm - min_nm) * i / (STEPS - 1);
    double n = 0;
    ABBE_TRY(abbe_material_n(material, lambda_nm, &n, error));
    const double per_m = abbe_material_attenuation(material, lambda_nm);
    out->least_n = fmin(out->least_n, n);
    out->most_n = fmax(out->most_n, n);
    out->least_per_m = fmin(out->least_per_m, per_m);
    out->most_per_m = fmax(out->most_per_m, per_m);
  }
  return abbe_material_n(material, middle_nm, &out->middle_n, error);
}

/* 1/m: no light is left of a wavelength. */
#define MOST_PER_M 1e30
#define MOST_MIRROR_DEPTH 80.0

static const abbe_object *object_of(const abbe_scene *scene, const abbe_plan *plan, size_t r) {
  return &scene->object[plan->refractor_object[r]];
}

double abbe_tint_attenuation(const abbe_scene *scene, const abbe_plan *plan, size_t s,
                             double lambda_nm) {
  const size_t r = s % plan->refractor_count, axes = s / plan->refractor_count;
  const abbe_object *object = object_of(scene, plan, r);
  const bool along = axes > 0 && !plan->mirror[r] && abbe_material_is_pleochroic(object->material);
  if (!plan->mirror[r])
    return fmin((along ? abbe_material_attenuation_along(object->material, (int)axes - 1, lambda_nm)
                       : abbe_material_attenuation(object->material, lambda_nm)) +
                    abbe_medium_scattering(object->medium, lambda_nm),
                MOST_PER_M);
  double n = 0, k = 0, reflected = object->mirror_reflectance;
  if (object->conductor != NULL &&
      abbe_material_nk(object->conductor, lambda_nm, &n, &k, NULL) == ABBE_OK)
    reflected = abbe_optics_fresnel_conductor(1, n, k);
  return fmin(-log(fmax(reflected, 1e-300)), MOST_MIRROR_DEPTH);
}

static bool is_even(const abbe_scene *scene, const abbe_plan *plan, size_t r) {
  const double min = plan->desc.min_nm, max = plan->desc.max_nm;
  double least = INFINITY, most = 0;
  for (int i = 0; i < STEPS; i++) {
    const double here = abbe_tint_attenuation(scene, plan, r, min + (max - min) * i / (STEPS - 1));
    least = fmin(least, here);
    most = fmax(most, here);
  }
  return (float)least == (float)most;
}

/* In a crystal of two indices x and y are alike. */
static int tint_along(const abbe_scene *scene, const abbe_plan *plan, size_t r, size_t axis) {
  const abbe_object *object = object_of(scene, plan, r);
  if (axis == 1 && object->material->attenuation_yz[0] == NULL) axis = 0;
  for (size_t k = 0; k < r; k++) {
    const abbe_object *other = object_of(scene, plan, k);
    if (other->material == object->material && other->medium == object->medium)
      return tint_along(scene, plan, k, axis);
  }
  return (int)(r + (axis + 1) * plan->refractor_count);
}

int abbe_tint_of(const abbe_scene *scene, const abbe_plan *plan, size_t s) {
  const size_t r = s % plan->refractor_count, axes = s / plan->refractor_count;
  const abbe_object *object = object_of(scene, plan, r);
  if (plan->pleochroic && !plan->mirror[r] && abbe_material_is_pleochroic(object->material))
    return axes > 0 ? tint_along(scene, plan, r, axes - 1) : -1;
  for (size_t k = 0; k < r; k++) {
    const abbe_object *other = object_of(scene, plan, k);
    if (plan->mirror[k] == plan->mirror[r] && other->material == object->material &&
        other->medium == object->medium && other->conductor == object->conductor &&
        other->mirror_reflectance == object->mirror_reflectance)
      return abbe_tint_of(scene, plan, k);
  }
  return is_even(scene, plan, r) ? -1 : (int)r;
}

size_t abbe_tint_count(const abbe_scene *scene, const abbe_plan *plan) {
  size_t count = 0;
  for (size_t s = 0; s < abbe_plan_surfaces(plan) && count < ABBE_MOST_TINTS; s++)
    count += abbe_tint_of(scene, plan, s) == (int)s;
  return count;
}

/* Share of a light's white: less is seen by nobody, as the diamond's 760 to 780 nm. */
#define LEAST_EXTRAPOLATED 1e-3

/* The most that a material's wavelengths outside its valid range are of a light's white. */
static double extrapolated_share(const abbe_scene *scene, const abbe_material *material, double min,
                                 double max) {
  double most = 0;
  const double edges[2][2] = {{min, fmin(material->min_nm, max)},
                              {fmax(material->max_nm, min), max}};
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_illuminant *light = &scene->light[i].illuminant;
    double outside = 0, xyz[3], white[3];
    abbe_weights_band_xyz(light, min, max, min, max, white);
    for (int k = 0; k < 2; k++) {
      if (!(edges[k][0] < edges[k][1])) continue;
      abbe_weights_band_xyz(light, min, max, edges[k][0], edges[k][1], xyz);
      outside += xyz[0] + xyz[1] + xyz[2];
    }
    const double all = white[0] + white[1] + white[2];
    most = fmax(most, all > 0 ? outside / all : 1);
  }
  return most;
}

/* Published methods and the light of pinholes take a crystal for glass of its ordinary or middle
 * index, which absorbs by the mean over its axes. */
static const char *what_is_drawn(const abbe_plan *plan) {
  return abbe_method_of(plan->desc.profile)->own_passes
             ? "its ordinary or middle index alone is drawn, and the mean absorption over its axes"
         : plan->desc.transport == ABBE_TRANSPORT_PINHOLE
             ? "the camera sees both waves; the light on receivers has the ordinary or middle "
               "index alone, and the mean absorption over its axes"
             : "both waves are drawn; where one is reflected inside, one of the two goes on that "
               "it becomes";
}

static void note_birefringence(const abbe_material *m, double lambda_nm, abbe_plan *plan) {
  double n[3];
  if (!abbe_material_is_crystal(m)) return;
  for (int axis = 0; axis < 3; axis++)
    if (abbe_material_n_along(m, axis, lambda_nm, &n[axis], NULL) != ABBE_OK) return;
  abbe_plan_note(plan, "%s: double refraction by %.4f at %g nm: %s", m->name, fabs(n[2] - n[0]),
                 lambda_nm, what_is_drawn(plan));
}

/* How three indices lie in the scene. */
static void note_biaxial(const abbe_object *object, double low, double high, abbe_plan *plan) {
  const abbe_material *m = object->material;
  const double at_nm[3] = {low, high, (low + high) / 2};
  double n[3], twice[3];
  if (!abbe_material_is_biaxial(m)) return;
  for (int at = 0; at < 3; at++) {
    for (int axis = 0; axis < 3; axis++)
      if (abbe_material_n_along(m, axis, at_nm[at], &n[axis], NULL) != ABBE_OK) return;
    twice[at] = 2 * abbe_biaxial_half_angle(n) * 180 / ABBE_PI;
  }
  abbe_plan_note(
      plan,
      "%s: biaxial, %s; 2V about z is %.1f degrees at %g nm, %.1f and %.1f at the ends; x "
      "is %.2f %.2f %.2f, z %.2f %.2f %.2f; the outer indices are %.4f lower and %.4f higher than "
      "the middle one",
      m->name, twice[2] < 90 ? "positive" : "negative", twice[2], at_nm[2], twice[0], twice[1],
      object->axis_x[0], object->axis_x[1], object->axis_x[2], object->axis[0], object->axis[1],
      object->axis[2], n[1] - n[0], n[2] - n[1]);
}

/* A wave's field and its displacement are furthest apart between the axes of the extreme indices,
 * whatever the third is, and so are its ray and its normal. */
static void note_double_image(const abbe_material *m, double lambda_nm, abbe_plan *plan) {
  double n[3];
  if (!abbe_material_is_crystal(m)) return;
  for (int axis = 0; axis < 3; axis++)
    if (abbe_material_n_along(m, axis, lambda_nm, &n[axis], NULL) != ABBE_OK) return;
  const double most = abbe_uniaxial_walk_off(n[0], n[2], cos(atan(n[2] / n[0])));
  abbe_plan_note(plan,
                 "%s: double image: largest walk-off %.3f degrees, which moves an image by %.3f mm "
                 "per cm",
                 m->name, most * 180 / ABBE_PI, 10 * tan(most));
}

/* Indices that are alike, and axes that had to be turned. */
static void note_axes(const abbe_object *object, double lambda_nm, abbe_plan *plan) {
  double n[3];
  for (int axis = 0; axis < 3; axis++)
    if (abbe_material_n_along(object->material, axis, lambda_nm, &n[axis], NULL) != ABBE_OK) return;
  if (n[0] == n[1] && n[1] == n[2])
    abbe_plan_note(plan, "%s: its indices are equal: it is no crystal", object->material->name);
  else if (abbe_material_is_biaxial(object->material) && (n[0] == n[1] || n[1] == n[2]))
    abbe_plan_note(plan, "%s: two of its three indices are equal: it is a uniaxial crystal",
                   object->material->name);
  if (object->axes_turned > ABBE_PI / 180)
    abbe_plan_note(plan, "%s: x of its 'axes' was turned by %.1f degrees to be across z",
                   object->name, object->axes_turned * 180 / ABBE_PI);
}

static void note_pleochroism(const abbe_material *material, abbe_plan *plan) {
  enum { MM = 5 };
  if (!abbe_material_is_pleochroic(material)) return;
  abbe_pleochroism p;
  abbe_pleochroism_make(material, 1e-3 * MM, &p);
  const double *o = p.field_lab[0], *e = p.field_lab[2], *y = p.field_lab[1];
  if (abbe_material_is_biaxial(material)) {
    abbe_plan_note(plan,
                   "%s: pleochroic; %d mm pass CIELAB %.0f %.0f %.0f of fields along x, %.0f %.0f "
                   "%.0f along y and %.0f %.0f %.0f along z, at most %.0f apart",
                   material->name, MM, o[0], o[1], o[2], y[0], y[1], y[2], e[0], e[1], e[2],
                   p.largest);
    return;
  }
  abbe_plan_note(plan,
                 "%s: pleochroic; %d mm pass CIELAB %.0f %.0f %.0f of its ordinary ray and %.0f "
                 "%.0f %.0f of the extraordinary one, %.0f apart",
                 material->name, MM, o[0], o[1], o[2], e[0], e[1], e[2], p.largest);
}

static void note_fluorescence(const abbe_material *m, double low, double high, abbe_plan *plan) {
  const abbe_fluorescence *f = &m->fluorescence;
  if (!abbe_material_is_fluorescent(m)) return;
  const double *nm = abbe_spectrum_lambda_nm(f->emission);
  abbe_plan_note(plan,
                 "%s: fluorescent; of photons that excite it %.3g %% come back at %.4g to "
                 "%.4g nm, %.3g %% of these within the range%s",
                 m->name, 100 * f->yield, nm[0], nm[abbe_spectrum_count(f->emission) - 1],
                 100 * abbe_material_emission(m, low, high),
                 f->rows > 0 ? "; by a matrix, drawn in one colour" : "");
}

/* The first object of the material, of those that the plan does not have yet. */
static void note_object(const abbe_scene *scene, const abbe_material *material, abbe_plan *plan) {
  const double low = plan->desc.min_nm, high = plan->desc.max_nm;
  size_t before = 0, i = 0;
  for (size_t k = 0; k < plan->refractor_count; k++)
    before += scene->object[plan->refractor_object[k]].material == material;
  for (size_t met = 0; i < scene->object_count; i++)
    if (scene->object[i].material == material && met++ == before) break;
  if (i == scene->object_count || !abbe_material_is_crystal(material)) return;
  if (before == 0) note_biaxial(&scene->object[i], low, high, plan);
  note_axes(&scene->object[i], (low + high) / 2, plan);
}

abbe_result abbe_spectral_needs_examine(const abbe_scene *scene, const abbe_material *material,
                                        abbe_plan *plan, abbe_error *error) {
  const double min = plan->desc.min_nm, max = plan->desc.max_nm;
  bool outside = extrapolated_share(scene, material, min, max) > LEAST_EXTRAPOLATED;
  abbe_material_range range;
  ABBE_TRY(abbe_material_range_make(material, min, max, &range, error));
  /* as floats: the shaders hold it so */
  if ((float)range.least_n != (float)range.most_n) plan->dispersive = true;
  if (abbe_absorption_shows(scene, range.most_per_m)) plan->absorbing = true;
  if (plan->absorbing && range.least_per_m != range.most_per_m) plan->tinting = true;
  if (abbe_material_is_crystal(material)) plan->crystals = true;
  if (abbe_material_is_biaxial(material)) plan->biaxial = true;
  if (abbe_material_is_pleochroic(material)) plan->pleochroic = true;
  if (abbe_material_is_fluorescent(material)) plan->glowing = true;
  bool noted = false;
  for (size_t i = 0; i < plan->refractor_count && !noted; i++)
    noted = scene->object[plan->refractor_object[i]].material == material;
  if (!noted) note_birefringence(material, 0.5 * (min + max), plan);
  if (!noted) note_double_image(material, 0.5 * (min + max), plan);
  if (!noted) note_pleochroism(material, plan);
  if (!noted) note_fluorescence(material, min, max, plan);
  note_object(scene, material, plan);
  if (outside && !noted)
    abbe_plan_note(plan, "%s: the index is extrapolated outside its valid range, %g to %g nm",
                   material->name, material->min_nm, material->max_nm);
  return ABBE_OK;
}

abbe_result abbe_spectral_needs_mirror(const abbe_object *mirror, abbe_plan *plan, char *text,
                                       size_t size, abbe_error *error) {
  const double min = plan->desc.min_nm, max = plan->desc.max_nm;
  double least = INFINITY, most = -INFINITY;
  if (mirror->conductor == NULL) {
    abbe_number_format(text, size, "it reflects %g of the light at all wavelengths and angles",
                       mirror->mirror_reflectance);
    return ABBE_OK;
  }
  for (int i = 0; i < STEPS; i++) {
    double n, k;
    ABBE_TRY(
        abbe_material_nk(mirror->conductor, min + (max - min) * i / (STEPS - 1), &n, &k, error));
    const double reflectance = abbe_optics_fresnel_conductor(1, n, k);
    least = fmin(least, reflectance);
    most = fmax(most, reflectance);
  }
  if ((float)least != (float)most) plan->colouring = true;
  abbe_number_format(
      text, size, "it reflects %.2g to %.2g of what meets it straight, by wavelength", least, most);
  return ABBE_OK;
}

static const char *wavelengths_reason(const abbe_plan *plan, bool asked) {
  return abbe_plan_no_refraction(plan) != NULL ? abbe_plan_no_refraction(plan)
         : asked                               ? "as asked"
         : plan->lines > 0                     ? "the lines of the lights"
         : plan->dispersive                    ? "the index varies with wavelength"
         : plan->tinting                       ? "the attenuation varies with wavelength"
         : plan->colouring                     ? "a mirror's reflectance varies with wavelength"
         : plan->filmed                        ? "films reflect by wavelength"
         : plan->tinted_air                    ? "haze in the air varies with wavelength"
         : plan->mirror_count == plan->refractor_count
             ? "mirrors reflect all wavelengths alike"
             : "all indices are constant, one geometry serves all";
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

size_t abbe_spectral_needs_lines(const abbe_scene *scene, double min_nm, double max_nm,
                                 double lambda_nm[ABBE_PLAN_MOST_LINES]) {
  double all[ABBE_SCENE_MAX_LIGHTS * ABBE_ILLUMINANT_MOST_LINES];
  size_t count = 0, kept = 0;
  if (scene->environment != NULL) return 0;
  for (size_t i = 0; i < scene->light_count; i++) {
    const size_t lines = abbe_illuminant_lines(&scene->light[i].illuminant, all + count);
    if (lines == 0) return 0;
    count += lines;
  }
  qsort(all, count, sizeof *all, ascending);
  for (size_t i = 0; i < count; i++) {
    if (!(all[i] > min_nm && all[i] < max_nm)) continue;
    if (kept > 0 && !(all[i] > lambda_nm[kept - 1])) continue;
    if (kept == ABBE_PLAN_MOST_LINES) return 0;
    lambda_nm[kept++] = all[i];
  }
  return kept;
}

void abbe_spectral_needs_count(const abbe_scene *scene, abbe_plan *plan) {
  const bool asked = plan->desc.wavelengths != 0;
  const size_t own = abbe_method_of(plan->desc.profile)->wavelengths;
  const bool varies =
      plan->dispersive || plan->tinting || plan->colouring || plan->filmed || plan->tinted_air;
  if (!asked) plan->desc.wavelengths = !varies ? 1 : own > 0 ? own : ABBE_PLAN_WAVELENGTHS;
  double line[ABBE_PLAN_MOST_LINES];
  plan->lines = 0;
  if (varies && !asked && own == 0 && !plan->glowing &&
      !abbe_method_of(plan->desc.profile)->own_passes)
    plan->lines = abbe_spectral_needs_lines(scene, plan->desc.min_nm, plan->desc.max_nm, line);
  if (plan->lines > 0) plan->desc.wavelengths = plan->lines;
  if (abbe_plan_no_refraction(plan) != NULL) plan->desc.wavelengths = 1, plan->lines = 0;
  abbe_plan_add(plan, ABBE_CHOICE_WAVELENGTHS, "%zu from %g to %g nm: %s", plan->desc.wavelengths,
                plan->desc.min_nm, plan->desc.max_nm, wavelengths_reason(plan, asked));
}

/* Whether all lights are of one spectrum, up to a factor. */
static bool shine_alike(const abbe_scene *scene, double min, double max) {
  const abbe_illuminant *first = &scene->light[0].illuminant;
  for (size_t k = 1; k < scene->light_count; k++)
    for (int i = 0; i < STEPS; i++) {
      const double from = min + (max - min) * i / STEPS, to = min + (max - min) * (i + 1) / STEPS;
      const double share = abbe_weights_band_power(&scene->light[k].illuminant, min, max, from, to);
      if (fabs(share - abbe_weights_band_power(first, min, max, from, to)) > 1e-6) return false;
    }
  return true;
}

/* Whether the plan's model of the object knows its films. */
static bool draws_films(const abbe_scene *scene, const abbe_object *object, const abbe_plan *plan) {
  size_t r = 0;
  while (r < plan->refractor_count && object_of(scene, plan, r) != object) r++;
  return plan->filmed && r < plan->refractor_count &&
         (object->coatings->face == NULL || plan->model[r] == ABBE_REFRACTOR_BVH ||
          (plan->model[r] == ABBE_REFRACTOR_CONVEX && abbe_refractor_films(object, NULL)));
}

/* What a film reflects head on, in per cent. */
static void note_film(const abbe_object *object, const abbe_coating *coating, bool drawn,
                      abbe_plan *plan) {
  static const double nm[3] = {450, 550, 650};
  double r[2][3], ignored, thinnest = INFINITY;
  for (int i = 0; i < 3; i++) {
    double n = 0;
    if (abbe_material_n(object->material, nm[i], &n, NULL) != ABBE_OK ||
        abbe_coating_straight(coating, n, false, nm[i], &r[0][i], &ignored, NULL) != ABBE_OK ||
        abbe_coating_straight(coating, n, true, nm[i], &r[1][i], &ignored, NULL) != ABBE_OK)
      return;
  }
  for (size_t i = 0; i < coating->count && coating->layer[0].table == NULL; i++)
    thinnest = fmin(thinnest, coating->layer[i].nm);
  abbe_plan_note(plan,
                 "%s: film: R at 0 degrees at 450/550/650 nm is %.2f/%.2f/%.2f %% "
                 "from outside, %.2f/%.2f/%.2f %% from inside%s",
                 object->name, 100 * r[0][0], 100 * r[0][1], 100 * r[0][2], 100 * r[1][0],
                 100 * r[1][1], 100 * r[1][2],
                 drawn ? "" : "; it is drawn bare, and 'abbe trace' has the film");
  if (thinnest < 1)
    abbe_plan_note(plan, "%s: a layer of its film is %.2g nm, thinner than an index holds for",
                   object->name, thinnest);
}

/* Thinner than a quarter of its diagonal between two parallel faces. */
static bool is_pane(const abbe_object *o) {
  const abbe_exact *e = &o->exact;
  double diagonal = 0;
  if (o->material == NULL || e->kind != ABBE_EXACT_CONVEX) return false;
  for (int k = 0; k < 3; k++) diagonal = hypot(diagonal, o->max[k] - o->min[k]);
  for (size_t i = 0; i < e->count; i++)
    for (size_t j = 0; j < i; j++)
      if (abbe_vector_dot(e->plane[i], e->plane[j]) < -1 + 1e-9 &&
          e->plane[i][3] + e->plane[j][3] < 0.25 * diagonal)
        return true;
  return false;
}

/* What a clear pane reflects at that angle, of each polarisation by itself and of their mean. */
static void note_pane(const abbe_object *o, double lambda_nm, abbe_plan *plan) {
  const double degrees = 60;
  abbe_film_light light;
  double to[2] = {1, 0};
  if (!is_pane(o) || abbe_material_n(o->material, lambda_nm, &to[0], NULL) != ABBE_OK) return;
  abbe_film_light_at(NULL, 0, false, 1, to, cos(degrees * ABBE_DEGREE), lambda_nm, &light);
  const double s = light.reflected[ABBE_FILM_S], p = light.reflected[ABBE_FILM_P];
  abbe_plan_note(plan,
                 "%s: polarisation matters, for two slanted faces lie on one path: by their mean "
                 "it reflects %.4f of light at %g degrees, and %.4f by each polarisation ('abbe "
                 "trace --polarisation on')",
                 o->name, 2 * (s + p) / (2 + s + p), degrees, s / (1 + s) + p / (1 + p));
}

/* Polarisers, and crystals between them. */
static void note_polarisation(const abbe_scene *scene, abbe_plan *plan) {
  const char *left = "%s: its polariser is left out, so all light passes; 'abbe trace' has it";
  const char *behind = "%s: light that another crystal has polarised counts as unpolarised here; "
                       "'abbe trace' follows polarised light";
  const char *both = "%s: a thin plate's colours and optical activity are left out, here and in "
                     "'abbe trace', which adds the powers of its two waves";
  const abbe_object *in_line = abbe_scene_crystal_in_line(scene);
  if (in_line != NULL) abbe_plan_note(plan, behind, in_line->name);
  if (!abbe_scene_is_polarised(scene)) return;
  if (scene->camera.polariser.kind != ABBE_POLARISER_NONE) abbe_plan_note(plan, left, "camera");
  for (size_t i = 0; i < scene->light_count; i++)
    if (scene->light[i].polariser.kind != ABBE_POLARISER_NONE)
      abbe_plan_note(plan, left, scene->light[i].name);
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->material != NULL && abbe_material_is_crystal(o->material))
      abbe_plan_note(plan, both, o->name);
  }
}

/* What of its surface is rough, and how much. */
static void note_roughness(const abbe_object *o, abbe_plan *plan) {
  double all = 0, rough = 0, least = INFINITY, most = 0;
  if (o->roughness == NULL) return;
  for (size_t f = 0; f < o->mesh.face_count; f++) {
    const uint32_t *corner = o->mesh.face[f];
    const abbe_coating *c = abbe_coatings_on(o->roughness, f);
    double n[3];
    abbe_vector_triangle(o->mesh.position[corner[0]], o->mesh.position[corner[1]],
                         o->mesh.position[corner[2]], n);
    all += abbe_vector_length(n);
    if (c == NULL) continue;
    rough += abbe_vector_length(n);
    least = fmin(least, c->alpha);
    most = fmax(most, c->alpha);
  }
  abbe_plan_note(plan,
                 "%s: %.3g %% of its surface is rough, alpha %.3g to %.3g; drawn polished, and "
                 "'abbe trace' follows light from facet to facet",
                 o->name, 100 * rough / all, least, most);
}

/* Tables have films between their object and air. */
static void note_covered_films(const abbe_scene *scene, const abbe_object *object,
                               abbe_plan *plan) {
  for (size_t r = 0; r < plan->refractor_count; r++) {
    const abbe_object *other = object_of(scene, plan, r);
    if (other != object && !other->cloud && !plan->mirror[r] && abbe_reach_overlap(object, other))
      abbe_plan_note(plan, "%s: its films are left out where it touches '%s'", object->name,
                     other->name);
  }
}

void abbe_spectral_needs_note(const abbe_scene *scene, abbe_plan *plan) {
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    for (size_t k = 0; o->coatings != NULL && k < o->coatings->count; k++)
      note_film(o, &o->coatings->coating[k], draws_films(scene, o, plan), plan);
    if (o->coatings != NULL && draws_films(scene, o, plan)) note_covered_films(scene, o, plan);
    note_roughness(o, plan);
    note_pane(o, (plan->desc.min_nm + plan->desc.max_nm) / 2, plan);
  }
  note_polarisation(scene, plan);
  if (scene->camera.aperture > 0)
    abbe_plan_note(plan,
                   "the camera has an aperture: a mean of %zu pictures from its pupil; 1 is sharp",
                   plan->desc.lens);
  if (plan->camera_sees_refractor && !shine_alike(scene, plan->desc.min_nm, plan->desc.max_nm))
    abbe_plan_note(plan, "through refractors, colours are split by the first light's illuminant");
}
