#include "base/maths.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include <math.h>
#include <stdlib.h>

/* Panes under a slanting beam: what they reflect and pass with all reflections inside, clear,
 * coated and absorbing. */
#define ABOVE 2.0  /* m: the plane that the reflected light meets */
#define BELOW 0.06 /* m: the one under the pane */

/* A pane of 1 m x 1 m. The circle where the flux is taken lies where no light of the edges comes:
 * the far edge throws back, totally, what enters within its last millimetres. */
typedef struct pane {
  const char *material;
  double lambda_nm, thickness, degrees, circle;
  /* A crystal's axis is across the plane of incidence; the light's field across it or in it. */
  enum { PLAIN, CRYSTAL, COATED, POLARISED, ACROSS, WITHIN } kind;
} pane;

static abbe_result load(const pane *p, abbe_scene *scene, abbe_error *error) {
  double angle = p->degrees / ABBE_KNOWN_DEGREES, aside = ABOVE * tan(angle);
  /* Straight light would not reach the pane past a plane above it. */
  char upper[200] = "";
  if (p->degrees >= 30)
    abbe_number_format(
        upper, sizeof upper,
        "- {name: above, shape: rectangle, width: 1.2, height: 1.2, reflectance: 0.5,\n"
        "   transform: [{translate: [%.17g, 0, %.17g]}]}\n",
        aside, ABOVE);
  return abbe_known_scene(
      scene, error,
      "camera: {eye: [0, -9, 4], target: [0, 0, 0]}\n"
      "lights: [{name: sun, kind: directional, direction: [%.17g, 0, %.17g], irradiance: 1%s}]\n"
      "objects:\n"
      "- {name: pane, shape: box, size: [1, 1, %.17g], material: %s%s}\n"
      "- {name: below, shape: rectangle, width: 4, height: 4, reflectance: 0.5,\n"
      "   transform: [{translate: [0, 0, %.17g]}]}\n%s",
      sin(angle), -cos(angle),
      p->kind == ACROSS   ? ", polariser: {angle: 0}"
      : p->kind == WITHIN ? ", polariser: {angle: 90}"
                          : "",
      p->thickness, p->material,
      p->kind == CRYSTAL  ? ", axis: [0, 1, 0]"
      : p->kind == COATED ? ", coating: {layers: [[1.38, 1]], quarter: 550}"
                          : "",
      -BELOW, upper);
}

/* The circle on the plane below or above that the middle of the pane sends its light to. */
static abbe_result rings_of(const pane *p, bool reflected, abbe_rings *out, abbe_error *error) {
  double angle = p->degrees / ABBE_KNOWN_DEGREES, far = 10;
  double height = reflected ? ABOVE : -BELOW;
  const double centre[3] = {fabs(height) * tan(angle), 0, height}, edge[2] = {0, p->circle};
  const double way[3] = {sin(angle), 0, -cos(angle)}, up[3] = {0, 1, 0};
  double origin[3];
  abbe_view view;
  abbe_map_layout layout;
  for (int k = 0; k < 3; k++) origin[k] = centre[k] - far * way[k];
  abbe_view_look(origin, way, up, true, &view);
  for (int k = 0; k < 4; k++) view.window[k] = (k % 2 ? 1.05 : -1.05) * p->circle;
  view.near = far / 2;
  view.far = 2 * far;
  abbe_map_layout_make(&view, &layout);
  return abbe_rings_make(&layout, 128, 128, centre, edge, 1, out, error);
}

/* What an even irradiance of the beam's cosine would put into the circle's texels, W. */
static double all_light(const pane *p, const abbe_rings *rings) {
  enum { RADII = 2 * (ABBE_RINGS_STEPS + 1) };
  double radius[RADII], enclosed[RADII], flux = 0;
  abbe_rings_radii(rings, radius);
  for (int i = 0; i < RADII; i++)
    enclosed[i] = cos(p->degrees / ABBE_KNOWN_DEGREES) * ABBE_PI * radius[i] * radius[i];
  abbe_rings_expect(rings, enclosed, 1, &flux);
  return flux;
}

/* By the sine and tangent laws, from outside into index n. [BornWolf1999, 1.5.2] */
static double polarised(double angle, double n, bool across) {
  double inner = asin(sin(angle) / n);
  double r = angle == 0 ? (n - 1) / (n + 1)
             : across   ? sin(angle - inner) / sin(angle + inner)
                        : tan(angle - inner) / tan(angle + inner);
  return r * r;
}

/* The extraordinary wave is polarised across the plane of incidence and sees n_e, the ordinary one
 * in it, and sees n_o; neither makes any of the other, and each has its own absorption. */
static abbe_result exact_of_crystal(const pane *p, const abbe_material *material, double *reflected,
                                    double *passed, abbe_error *error) {
  double n[2], angle = p->degrees / ABBE_KNOWN_DEGREES, r, t;
  ABBE_TRY(abbe_material_n(material, p->lambda_nm, &n[0], error));
  ABBE_TRY(abbe_material_n_extraordinary(material, p->lambda_nm, &n[1], error));
  for (int wave = 0; wave < 2; wave++) {
    const double slanted = p->thickness / cos(asin(sin(angle) / n[wave]));
    const double per_m = abbe_material_attenuation_along(material, wave == 1 ? 2 : 0, p->lambda_nm);
    const double tau = exp(-per_m * slanted);
    abbe_closed_form_slab(polarised(angle, n[wave], wave == 1), tau, &r, &t);
    *reflected += r / 2;
    *passed += t / 2;
  }
  return ABBE_OK;
}

static abbe_result exact_of(const pane *p, const abbe_scene *scene, double *reflected,
                            double *passed, abbe_error *error) {
  const abbe_material *material = scene->object[0].material;
  double n = 0, angle = p->degrees / ABBE_KNOWN_DEGREES;
  if (p->kind == CRYSTAL) return exact_of_crystal(p, material, reflected, passed, error);
  ABBE_TRY(abbe_material_n(material, p->lambda_nm, &n, error));
  double slanted = p->thickness / cos(asin(sin(angle) / n));
  double tau = exp(-abbe_material_attenuation(material, p->lambda_nm) * slanted);
  double face = abbe_closed_form_fresnel(angle, n);
  if (p->kind == COATED) {
    const abbe_closed_film film = {1, 1.38, 0, n, 550 / (4 * 1.38) / p->lambda_nm};
    double r[2], t;
    for (int k = 0; k < 2; k++) abbe_closed_form_film(&film, angle, k == 1, &r[k], &t);
    face = (r[0] + r[1]) / 2; /* from inside too: nothing is absorbed */
  }
  if (p->kind < POLARISED) {
    abbe_closed_form_slab(face, tau, reflected, passed);
    return ABBE_OK;
  }
  for (int across = 0; across < 2; across++) { /* a sheet passes the half that is one of them */
    double r, t;
    if ((p->kind == ACROSS && across == 0) || (p->kind == WITHIN && across == 1)) continue;
    abbe_closed_form_slab(polarised(angle, n, across), tau, &r, &t);
    *reflected += r / 2;
    *passed += t / 2;
  }
  return ABBE_OK;
}

static const char pane_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 1e-4 of the "
    "beam, for the ragged edge of a circle of texels";

static abbe_result add_share(abbe_known_run *run, const pane *p, bool reflected, double from,
                             double to, abbe_error *error) {
  abbe_scene scene = {0};
  abbe_rings rings = {0};
  abbe_trace_desc desc = {0};
  double r = 0, t = 0, mean = 0, spread = 0;
  abbe_known_narrow(p->lambda_nm, &desc);
  size_t passes = abbe_known_passes(run, 1 << 22, &desc);
  if (p->kind == POLARISED) desc.polarisation = ABBE_TRACE_POLARISATION_ON;
  double(*sum)[3] = calloc(passes, sizeof *sum);
  abbe_result result = sum != NULL ? load(p, &scene, error)
                                   : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  if (result == ABBE_OK) result = exact_of(p, &scene, &r, &t, error);
  if (result == ABBE_OK) result = rings_of(p, reflected, &rings, error);
  if (result == ABBE_OK)
    result = abbe_known_measure(run, from, to, &scene, &desc, passes, &rings, sum, error);
  if (result == ABBE_OK) {
    double scale = 1 / all_light(p, &rings);
    abbe_known_mean(sum, passes, 1, 0, 1, 1, &mean, &spread);
    abbe_known_answer row = {.unit = "share",
                             .exact = reflected ? r : t,
                             .traced = mean * scale,
                             .standard_error = spread * scale,
                             .tolerance = abbe_known_sigmas(passes) * spread * scale + 1e-4,
                             .useful = 0.02 * (reflected ? r : t),
                             .reason = pane_reason};
    static const char *const kinds[] = {"",          "",         " under MgF2", ", polarised",
                                        ", s alone", ", p alone"};
    abbe_number_format(row.quantity, sizeof row.quantity, "%s%s, %g mm, %g nm, at %g degrees, %s",
                       p->material, kinds[p->kind], 1e3 * p->thickness, p->lambda_nm, p->degrees,
                       reflected ? "reflected" : "passed");
    result = abbe_known_add(run, row, error);
  }
  abbe_rings_free(&rings);
  abbe_scene_free(&scene);
  free(sum);
  return result;
}

/* What a pane does with the light: one run a row. */
typedef struct setting {
  pane pane;
  bool reflected;
} setting;

#define D_LINE 587.5618

static const setting clear[] = {
    {{"n-bk7", D_LINE, 0.005, 0, 0.25, PLAIN}, false},
    {{"n-bk7", D_LINE, 0.005, 30, 0.25, PLAIN}, true},
    {{"n-bk7", D_LINE, 0.005, 30, 0.25, PLAIN}, false},
    {{"n-bk7", D_LINE, 0.005, 60, 0.25, PLAIN}, true},
    {{"n-bk7", D_LINE, 0.005, 60, 0.25, PLAIN}, false},
    {{"diamond", D_LINE, 0.005, 0, 0.25, PLAIN}, false},
    {{"diamond", D_LINE, 0.005, 30, 0.25, PLAIN}, true},
    {{"diamond", D_LINE, 0.005, 30, 0.25, PLAIN}, false},
    {{"diamond", D_LINE, 0.005, 60, 0.25, PLAIN}, true},
    {{"diamond", D_LINE, 0.005, 60, 0.25, PLAIN}, false},
    {{"calcite", D_LINE, 0.005, 0, 0.25, CRYSTAL}, false},
    {{"calcite", D_LINE, 0.005, 60, 0.25, CRYSTAL}, true},
    {{"calcite", D_LINE, 0.005, 60, 0.25, CRYSTAL}, false},
    {{"n-bk7", D_LINE, 0.005, 60, 0.25, COATED}, true},
};
static const setting sheets[] = {
    {{"n-bk7", D_LINE, 0.005, 60, 0.25, POLARISED}, true},
    {{"diamond", D_LINE, 0.005, 60, 0.25, POLARISED}, true},
    {{"diamond", D_LINE, 0.005, 60, 0.25, POLARISED}, false},
    {{"n-bk7", D_LINE, 0.005, 60, 0.25, ACROSS}, true},
    {{"n-bk7", D_LINE, 0.005, 60, 0.25, WITHIN}, false},
};
static const setting absorbing[] = {
    {{"n-sf11", 546, 0.02, 0, 0.25, PLAIN}, false},
    {{"n-sf11", 436, 0.02, 0, 0.25, PLAIN}, false},
    {{"n-sf11", 400, 0.02, 0, 0.25, PLAIN}, false},
    {{"n-sf11", 400, 0.02, 45, 0.25, PLAIN}, false},
    {{"n-sf11", 400, 0.1, 0, 0.25, PLAIN}, false},
    {{"tourmaline-green", 640, 0.02, 0, 0.25, CRYSTAL}, false},
    {{"tourmaline-green", 640, 0.02, 45, 0.25, CRYSTAL}, false},
};

enum {
  CLEAR = sizeof clear / sizeof *clear,
  SHEETS = sizeof sheets / sizeof *sheets,
  ABSORBING = sizeof absorbing / sizeof *absorbing
};

abbe_result abbe_known_pane_setting(abbe_known_run *run, size_t index, bool absorbs,
                                    abbe_error *error) {
  const size_t count = absorbs ? ABSORBING : CLEAR;
  if (index >= count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "pane %zu is beyond the %zu there are",
                          index, count);
  const setting *s = absorbs ? &absorbing[index] : &clear[index];
  return add_share(run, &s->pane, s->reflected, (double)index / (double)count,
                   (double)(index + 1) / (double)count, error);
}

abbe_result abbe_known_pane(abbe_known_run *run, abbe_error *error) {
  for (size_t i = 0; i < CLEAR; i++) ABBE_TRY(abbe_known_pane_setting(run, i, false, error));
  return ABBE_OK;
}

abbe_result abbe_known_sheets(abbe_known_run *run, double to, abbe_error *error) {
  for (int i = 0; i < SHEETS; i++)
    ABBE_TRY(add_share(run, &sheets[i].pane, sheets[i].reflected, to * i / SHEETS,
                       to * (i + 1) / SHEETS, error));
  return ABBE_OK;
}

abbe_result abbe_known_absorption(abbe_known_run *run, abbe_error *error) {
  for (size_t i = 0; i < ABSORBING; i++) ABBE_TRY(abbe_known_pane_setting(run, i, true, error));
  return ABBE_OK;
}

/* Balls within balls: where refractors overlap the later one is there. */
typedef struct nest {
  const char *what, *core; /* material of the core; the shell is n-bk7 */
  double share;            /* radius of the core, in radii of the shell */
} nest;

/* Heights are shares of the outer radius; choices leave total reflections out. */
static abbe_result add_turn(abbe_known_run *run, const nest *it, abbe_known_stage *stage,
                            double height, abbe_error *error) {
  const double from[3] = {height, 0, 3}, down[3] = {0, 0, -1};
  double n = 0, core_n = 0, traced = NAN;
  ABBE_TRY(abbe_known_stage_n(stage, ABBE_LINE_D_NM, &n, error));
  ABBE_TRY(abbe_material_n(stage->scene.object[1].material, ABBE_LINE_D_NM, &core_n, error));
  ABBE_TRY(abbe_known_follow(stage, from, down, ABBE_LINE_D_NM, "tttt", error));
  /* The way out of the ball is the vertex before the last; towards the axis is towards -x. */
  if (stage->count >= 3) {
    const double *d = stage->vertex[stage->count - 2].direction;
    traced = atan2(-d[0], -d[2]);
  }
  abbe_known_answer row = {
      .unit = "degrees",
      .exact = abbe_closed_form_shell_turn(1, n, it->share, core_n, height) * ABBE_KNOWN_DEGREES,
      .traced = traced * ABBE_KNOWN_DEGREES,
      .tolerance = 1.2e-3,
      .reason =
          "2e-5 rad: at each of four surfaces a ray starts up to 4e-6 of the ball's size off, "
          "which the steep curve of the core turns into an angle"};
  abbe_number_format(row.quantity, sizeof row.quantity, "%s, ray at %g R, turned", it->what,
                     height);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_nest(abbe_known_run *run, abbe_error *error) {
  static const nest nests[] = {{"n-bk7 with a bubble of R/2", "air", 0.5},
                               {"n-bk7 around water of 0.8 R", "water", 0.8}};
  static const double heights[2][4] = {{0.1, 0.3, 0.6, 0.9}, {0.2, 0.6, 0.9, 0}};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    abbe_known_stage stage;
    ABBE_TRY(abbe_known_stage_make(&stage, error,
                                   "- {name: ball, shape: sphere, radius: 1, material: n-bk7}\n"
                                   "- {name: core, shape: sphere, radius: %g, material: %s}\n",
                                   nests[i].share, nests[i].core));
    for (int k = 0; k < 4 && heights[i][k] > 0 && result == ABBE_OK; k++)
      result = add_turn(run, &nests[i], &stage, heights[i][k], error);
    abbe_known_stage_free(&stage);
  }
  return result;
}
