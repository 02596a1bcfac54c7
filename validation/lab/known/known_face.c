/* Flat faces: the shift of a slab, Fresnel's shares, the critical angle, films. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/maths.h"
#include "base/number.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/film.h"

#include <stdio.h>

/* ---- the slab ---- */

static abbe_result add_shift(abbe_known_run *run, double thickness, double degrees,
                             abbe_error *error) {
  abbe_known_stage stage;
  double n = 0, angle = degrees / ABBE_KNOWN_DEGREES, traced = NAN;
  ABBE_TRY(abbe_known_stage_make(
      &stage, error, "- {name: slab, shape: box, size: [%g, %g, %g], material: n-bk7}\n",
      8 * thickness, 8 * thickness, thickness));
  abbe_result result = abbe_known_stage_n(&stage, ABBE_LINE_D_NM, &n, error);
  const double d[3] = {sin(angle), 0, -cos(angle)};
  double from[3] = {-2 * thickness * d[0], 0, thickness / 2 - 2 * thickness * d[2]};
  if (result == ABBE_OK) result = abbe_known_follow(&stage, from, d, ABBE_LINE_D_NM, "tt", error);
  if (result == ABBE_OK && stage.count == 3) {
    double way[3], across[3];
    abbe_vector_subtract(stage.vertex[1].position, from, way);
    abbe_vector_cross(way, d, across);
    traced = abbe_vector_length(across);
  }
  abbe_known_stage_free(&stage);
  if (result != ABBE_OK) return result;
  abbe_known_answer row = {
      .unit = "thickness",
      .exact = abbe_closed_form_slab_shift(1, angle, n),
      .traced = traced / thickness,
      .tolerance = 4e-6,
      .reason = "a ray starts 2^-18 of the slab's size off the face that it leaves, 4e-6, and "
                "positions are rounded to 1e-7 of its width, eight thicknesses"};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "n-bk7, %g m thick, at %g degrees, sideways", thickness, degrees);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_slab(abbe_known_run *run, abbe_error *error) {
  static const double degrees[] = {5, 30, 45, 60, 80}, sizes[] = {1e-4, 1e4};
  for (int i = 0; i < 5; i++) ABBE_TRY(add_shift(run, 0.01, degrees[i], error));
  for (int i = 0; i < 2; i++) ABBE_TRY(add_shift(run, sizes[i], 45, error));
  return ABBE_OK;
}

/* ---- Fresnel ---- */

static const char wedge_text[] =
    "- {name: wedge, shape: prism, apex: 30, side: 1, length: 1, material: %s}\n";

#define WEDGE_RAD (30 / ABBE_KNOWN_DEGREES)
#define WEDGE_ALONG 0.3 /* m from the apex */

/* Follows the ray that meets the wedge's left face at the incidence; from inside it then meets the
 * right face at the wedge's angle less that of refraction. False where it does not get there. */
static abbe_result enter_wedge(abbe_known_stage *stage, double incidence, bool *there,
                               abbe_error *error) {
  double before = incidence - WEDGE_RAD / 2, apex_z = cos(WEDGE_RAD / 2) * 2 / 3;
  double d[3] = {cos(before), 0, sin(before)};
  double from[3] = {-WEDGE_ALONG * sin(WEDGE_RAD / 2) - d[0], 0,
                    apex_z - WEDGE_ALONG * cos(WEDGE_RAD / 2) - d[2]};
  abbe_result result = abbe_known_follow(stage, from, d, ABBE_LINE_D_NM, "tt", error);
  const abbe_route_vertex *v = stage->vertex;
  *there = result == ABBE_OK && stage->count > 1 && v[0].event == ABBE_ROUTE_TRANSMITTED &&
           v[1].normal[0] > 0.5;
  return result;
}

static abbe_result add_share(abbe_known_run *run, abbe_known_stage *stage, double degrees,
                             bool inside, abbe_error *error) {
  double n = 0, angle = degrees / ABBE_KNOWN_DEGREES, incidence = angle;
  ABBE_TRY(abbe_known_stage_n(stage, ABBE_LINE_D_NM, &n, error));
  if (inside) incidence = asin(n * sin(WEDGE_RAD - angle));
  bool there = false;
  ABBE_TRY(enter_wedge(stage, incidence, &there, error));
  /* The slope near the critical angle is steep: the traced ray's own angle differs by 1e-7. */
  double exact = abbe_closed_form_fresnel(angle, inside ? 1 / n : n);
  double slope = fabs(abbe_closed_form_fresnel(angle - 1e-6, inside ? 1 / n : n) - exact) / 1e-6;
  abbe_known_answer row = {
      .unit = "share",
      .exact = exact,
      .traced = there ? stage->vertex[inside ? 1 : 0].reflectance : NAN,
      .tolerance = 5e-7 + 5e-7 * slope,
      .reason = "single precision: 5e-7 of the light, and 5e-7 rad of the angle times the slope"};
  abbe_number_format(row.quantity, sizeof row.quantity, "n-bk7, reflected at %.4g degrees from %s",
                     degrees, inside ? "inside" : "outside");
  return abbe_known_add(run, row, error);
}

/* Bisects the incidence on the wedge between a ray that its second face passes and one that it
 * reflects totally. */
static abbe_result add_critical(abbe_known_run *run, const char *material, abbe_error *error) {
  abbe_known_stage stage;
  double n = 0, traced = NAN;
  ABBE_TRY(abbe_known_stage_make(&stage, error, wedge_text, material));
  abbe_result result = abbe_known_stage_n(&stage, ABBE_LINE_D_NM, &n, error);
  double low = -80 / ABBE_KNOWN_DEGREES, high = asin(fmin(n * sin(WEDGE_RAD), 0.99));
  for (int step = 0; step < 50 && result == ABBE_OK; step++) {
    double middle = (low + high) / 2;
    bool there;
    result = enter_wedge(&stage, middle, &there, error);
    if (result != ABBE_OK) break;
    traced = there ? acos(stage.vertex[1].cos_in) : NAN;
    if (!there || stage.vertex[1].event == ABBE_ROUTE_REFLECTED)
      low = middle;
    else
      high = middle;
  }
  abbe_known_stage_free(&stage);
  if (result != ABBE_OK) return result;
  abbe_known_answer row = {
      .unit = "degrees",
      .exact = asin(1 / n) * ABBE_KNOWN_DEGREES,
      .traced = traced * ABBE_KNOWN_DEGREES,
      .tolerance = 6e-5,
      .reason = "1e-6 rad: the cosine of incidence and the index in single precision"};
  snprintf(row.quantity, sizeof row.quantity, "%s, critical angle at d", material);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_fresnel(abbe_known_run *run, abbe_error *error) {
  static const double outside[] = {0, 30, 60, 75, 89}, inside[] = {0, 15, 30, 40, 41};
  static const char *const materials[] = {"n-bk7", "water", "diamond"};
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  double n = 0;
  ABBE_TRY(abbe_known_stage_make(&stage, error, wedge_text, "n-bk7"));
  ABBE_TRY(abbe_known_stage_n(&stage, ABBE_LINE_D_NM, &n, error));
  for (int i = 0; i < 5; i++) ABBE_TRY(add_share(run, &stage, outside[i], false, error));
  /* Brewster's */
  ABBE_TRY(add_share(run, &stage, atan(n) * ABBE_KNOWN_DEGREES, false, error));
  for (int i = 0; i < 5; i++) ABBE_TRY(add_share(run, &stage, inside[i], true, error));
  for (int i = 0; i < 3; i++) ABBE_TRY(add_critical(run, materials[i], error));
  return ABBE_OK;
}

/* ---- films ---- */

typedef struct film_row {
  const char *what;
  double from, n, k, thick_nm, to, degrees;
  char share; /* s or p: what is reflected of it; P: what passes at 0 degrees */
  bool three; /* at 450, 550 and 650 nm; else at 550 */
} film_row;

static abbe_result add_film(abbe_known_run *run, const film_row *f, double lambda_nm,
                            abbe_error *error) {
  const bool p = f->share == 'p', passes = f->share == 'P';
  const abbe_closed_film form = {f->from, f->n, f->k, f->to, f->thick_nm / lambda_nm};
  const abbe_film_layer layer = {f->n, f->k, f->thick_nm, NULL};
  const double angle = f->degrees / ABBE_KNOWN_DEGREES, to[2] = {f->to, 0};
  double reflected, passed;
  abbe_film_light light;
  abbe_closed_form_film(&form, angle, p, &reflected, &passed);
  abbe_film_light_at(&layer, 1, f->from > f->to, f->from, to, cos(angle), lambda_nm, &light);
  abbe_known_answer row = {.unit = "share",
                           .exact = passes ? passed : reflected,
                           .traced = passes ? light.transmitted[p] : light.reflected[p],
                           .tolerance = 1e-12,
                           .reason = "double precision: some hundred roundings"};
  abbe_number_format(row.quantity, sizeof row.quantity, "%s, %.4g nm, %s at %.4g degrees, %g nm%s",
                     f->what, f->thick_nm, passes ? "passed" : "reflected", f->degrees, lambda_nm,
                     !(f->degrees > 0) ? ""
                     : p               ? ", p"
                                       : ", s");
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_film(abbe_known_run *run, abbe_error *error) {
  static const double quarter = 550 / (4 * 1.38);
  const double snell = asin(1.61 * sin(20 / ABBE_KNOWN_DEGREES)) * ABBE_KNOWN_DEGREES;
  const film_row rows[] = {
      {"MgF2 on crown", 1, 1.38, 0, quarter, 1.52, 0, 's', true},
      {"no film on crown", 1, 1.38, 0, 0, 1.52, 0, 's', false},
      {"MgF2 on crown", 1, 1.38, 0, quarter, 1.52, 45, 's', false},
      {"MgF2 on crown", 1, 1.38, 0, quarter, 1.52, 45, 'p', false},
      {"MgF2 on crown", 1, 1.38, 0, 2 * quarter, 1.52, 0, 's', false},
      {"MgF2 on diamond", 1, 1.38, 0, quarter, 2.417, 0, 's', false},
      {"the root's index on diamond", 1, sqrt(2.417), 0, 550 / (4 * sqrt(2.417)), 2.417, 0, 's',
       false},
      {"2.4 on topaz", 1, 2.4, 0, 60, 1.61, 0, 's', true},
      {"2.4 on topaz", 1, 2.4, 0, 90, 1.61, 0, 's', true},
      {"2.4 on topaz", 1, 2.4, 0, 120, 1.61, 0, 's', true},
      {"2.4 on topaz", 1, 2.4, 0, 150, 1.61, 0, 's', true},
      {"2.4 on topaz, inside", 1.61, 2.4, 0, 120, 1, 20, 's', false},
      {"2.4 on topaz, inside", 1.61, 2.4, 0, 120, 1, 20, 'p', false},
      {"2.4 on topaz", 1, 2.4, 0, 120, 1.61, snell, 's', false},
      {"2.4 on topaz", 1, 2.4, 0, 120, 1.61, snell, 'p', false},
      {"2.4 on topaz, inside", 1.61, 2.4, 0, 120, 1, 45, 's', false},
      {"2.4 on topaz, inside", 1.61, 2.4, 0, 120, 1, 45, 'p', false},
      {"0.42 + 2.4i on topaz", 1, 0.42, 2.4, 10, 1.61, 0, 'P', false},
      {"0.42 + 2.4i on topaz, inside", 1.61, 0.42, 2.4, 10, 1, 0, 'P', false},
      {"0.42 + 2.4i on topaz", 1, 0.42, 2.4, 10, 1.61, 0, 's', false},
      {"0.42 + 2.4i on topaz, inside", 1.61, 0.42, 2.4, 10, 1, 0, 's', false},
      {"water in air", 1, 1.33, 0, 100, 1, 0, 's', false},
      {"water in air", 1, 1.33, 0, 5, 1, 0, 's', false},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (double nm = rows[i].three ? 450 : 550; nm < (rows[i].three ? 700 : 600); nm += 100)
      ABBE_TRY(add_film(run, &rows[i], nm, error));
  return ABBE_OK;
}
