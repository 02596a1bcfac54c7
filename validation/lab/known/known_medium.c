/* Media that scatter: a slab of mist in the sun from above and below, a light in mist, a shaft of
 * sunlight under still water seen from within and from above, and what is left of light. */
#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "scenes/medium/medium.h"
#include "validation/trace/transport/haze.h"

#include <math.h>

static const double pi = ABBE_PI, middle_nm = 560;

static const char reason[] = "as improbable as four standard errors, taken from the spread of the "
                             "passes; and 2e-3 of the value, for one direction stands for a view "
                             "of 1 degree, or one index for all wavelengths";

/* ---- the phase function ---- */

static abbe_result add_phase(abbe_known_run *run, float g, abbe_error *error) {
  enum { PARTS = 200000 };
  bool scatters = true;
  const abbe_haze haze = {.scatters = &scatters, .g = &g};
  double sum[2] = {0};
  for (int i = 0; i < PARTS; i++) {
    const double cosine = (2 * i + 1) / (double)PARTS - 1;
    const double share = 4 * pi / PARTS * (double)abbe_haze_phase(&haze, -1, (float)cosine);
    sum[0] += share;
    sum[1] += share * cosine;
  }
  abbe_known_answer row = {.unit = "1",
                           .exact = 1,
                           .traced = sum[0],
                           .tolerance = 1e-5,
                           .reason = "single precision near the forward peak"};
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "what is scattered with a mean cosine of %.2g goes somewhere", (double)g);
  ABBE_TRY(abbe_known_add(run, row, error));
  row.exact = (double)g;
  row.traced = sum[1];
  abbe_number_format(row.quantity, sizeof row.quantity, "its mean cosine, where it is to be %.2g",
                     (double)g);
  return abbe_known_add(run, row, error);
}

/* ---- a slab of mist ---- */

typedef struct slab {
  double scattering, absorption, g; /* 1/m */
  double thickness;                 /* m */
  double sun_deg, view_deg;         /* from upright, both in the plane of x and z */
  bool below;                       /* the camera is under it and looks up */
} slab;

/* The radiance from a beam of 1 W/m2: the integral over the depth of what is scattered there,
 * weakened along both paths. [Pbrt4] */
static double slab_radiance(const slab *s) {
  const double whole = s->scattering + s->absorption, depth = whole * s->thickness;
  const double sun = s->sun_deg / ABBE_KNOWN_DEGREES, view = s->view_deg / ABBE_KNOWN_DEGREES;
  const double m0 = cos(sun), m = cos(view), across = sin(sun) * sin(view);
  const double turned = s->below ? m0 * m + across : -m0 * m + across;
  const double source = s->scattering / whole * abbe_medium_phase(s->g, turned);
  if (s->below) return source * m0 / (m0 - m) * (exp(-depth / m0) - exp(-depth / m));
  return source * m0 / (m0 + m) * (1 - exp(-depth * (1 / m0 + 1 / m)));
}

/* The camera a metre off the slab's middle, on the line along which light leaves it at view_deg. */
static abbe_result slab_scene(const slab *s, double background, double irradiance, abbe_scene *out,
                              abbe_error *error) {
  const double sun = s->sun_deg / ABBE_KNOWN_DEGREES, view = s->view_deg / ABBE_KNOWN_DEGREES;
  const double side = s->below ? -1 : 1, away = s->thickness + 1;
  return abbe_known_scene(
      out, error,
      "background: %.17g\n"
      "camera: {eye: [%.17g, 0, %.17g], target: [0, 0, 0], up: [0, 1, 0], fov: 1}\n"
      "lights: [{name: sun, kind: directional, direction: [%.17g, 0, %.17g], irradiance: %.17g}]\n"
      "medium: {scattering: %.17g, absorption: %.17g, g: %.17g,\n"
      "         box: [[-40, -40, %.17g], [40, 40, %.17g]]}\n"
      "objects: [{name: far off, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0,\n"
      "           transform: [{translate: [%.17g, 0, %.17g]}]}]\n",
      background, away * tan(view), side * away, sin(sun), -cos(sun), irradiance, s->scattering,
      s->absorption, s->g, -0.5 * s->thickness, 0.5 * s->thickness, -3 * away * tan(view),
      -side * 3 * away);
}

/* Where the scene was made: the row, right to 2e-3 of its value, and of use to useful_share of it.
 * Frees the scene. */
static abbe_result add_row(abbe_known_run *run, abbe_known_setting *row, double useful_share,
                           abbe_result made, abbe_scene *scene, double from, double to,
                           abbe_error *error) {
  row->slack = 2e-3 * row->exact;
  row->useful = useful_share * row->exact;
  if (made == ABBE_OK) made = abbe_known_add_setting(run, row, scene, from, to, error);
  abbe_scene_free(scene);
  return made;
}

static abbe_result add_slab(abbe_known_run *run, const slab *s, double from, double to,
                            abbe_error *error) {
  char what[112];
  abbe_scene scene = {0};
  abbe_known_setting row = {.what = what,
                            .unit = "W/(m2 sr)",
                            .exact = slab_radiance(s),
                            .reason = reason,
                            .samples = 1 << 14,
                            .side = 8,
                            .channel = "Y"};
  abbe_number_format(
      what, sizeof what,
      "mist of depth %.2g, g %.2g, in the sun %.2g degrees off upright, from %s at %.2g",
      (s->scattering + s->absorption) * s->thickness, s->g, s->sun_deg,
      s->below ? "below" : "above", s->view_deg);
  abbe_result result = slab_scene(s, 0, 1, &scene, error);
  return add_row(run, &row, 3e-2, result, &scene, from, to, error);
}

/* The background behind the slab. */
static abbe_result add_left(abbe_known_run *run, double from, double to, abbe_error *error) {
  const slab s = {.scattering = 0.5, .absorption = 0.3, .thickness = 1, .view_deg = 60};
  abbe_scene scene = {0};
  abbe_known_setting row = {
      .what = "a background seen through mist of depth 0.8, 60 degrees off upright",
      .unit = "W/(m2 sr)",
      .exact = exp(-0.8 / cos(60 / ABBE_KNOWN_DEGREES)),
      .reason = reason,
      .samples = 1 << 12,
      .side = 8,
      .channel = "Y"};
  abbe_result result = slab_scene(&s, 1, 1e-9, &scene, error);
  return add_row(run, &row, 1e-2, result, &scene, from, to, error);
}

/* Sunlight that reaches a ball below it. */
static abbe_result add_reached(abbe_known_run *run, double from, double to, abbe_error *error) {
  abbe_scene scene = {0};
  abbe_known_setting row = {.what =
                                "sunlight that comes to a ball of 0.1 m under mist of depth 0.7",
                            .unit = "W",
                            .exact = pi * 0.01 * exp(-0.7),
                            .reason = reason,
                            .samples = 1 << 17,
                            .side = 8};
  abbe_result result = abbe_known_scene(
      &scene, error,
      "camera: {eye: [0, -2, 0], target: [0, 0, -1]}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
      "medium: {scattering: 0.6, absorption: 0.1, box: [[-3, -3, 1], [3, 3, 2]]}\n"
      "objects:\n"
      "- {name: ball, shape: sphere, radius: 0.1, levels: 3, material: water}\n"
      "- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 0.5,\n"
      "   transform: [{translate: [0, 0, -1]}]}\n");
  return add_row(run, &row, 1e-2, result, &scene, from, to, error);
}

/* Straight through 10 mm: what is not scattered is exp(-0.3). */
static abbe_result add_pencil(abbe_known_run *run, const char *material, double from, double to,
                              abbe_error *error) {
  char what[112];
  ABBE_OWNED(abbe_scene, scene) = {0};
  abbe_known_setting row = {.what = what,
                            .unit = "share",
                            .exact = -expm1(-0.3),
                            .reason = "as improbable as four standard errors, taken from the "
                                      "spread of the passes; and 1e-6 for single precision",
                            .samples = 1 << 21,
                            .side = 8,
                            .channel = "turned"};
  snprintf(what, sizeof what, "of a beam through 10 mm of haze of 30/m in %s, scattered", material);
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "camera: {eye: [0, -2, 0], target: [0, 0, -1]}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
      "objects:\n"
      "- {name: pane, shape: box, size: [1, 1, 0.01], material: %s, medium: {scattering: 30}}\n"
      "- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 0.5,\n"
      "   transform: [{translate: [0, 0, -1]}]}\n",
      material));
  row.slack = 1e-6;
  row.useful = 1e-2 * row.exact;
  return abbe_known_add_setting(run, &row, &scene, from, to, error);
}

/* ---- a light in mist ---- */

enum { LAMP_PARTS = 20000 };

/* Along a ray 0.2 m past a light of 1 W/sr, from 1 m before to 1 m behind it. */
static double lamp_radiance(double scattering, double absorption, double g) {
  const double whole = scattering + absorption, aside = 0.2;
  double sum = 0;
  for (int i = 0; i < LAMP_PARTS; i++) {
    const double t = 2 * (i + 0.5) / LAMP_PARTS, along = 1 - t;
    const double distance = hypot(aside, along);
    sum += 2.0 / LAMP_PARTS * scattering * abbe_medium_phase(g, along / distance) *
           exp(-whole * (t + distance)) / (distance * distance);
  }
  return sum;
}

static abbe_result add_lamp(abbe_known_run *run, double g, double from, double to,
                            abbe_error *error) {
  char what[112];
  abbe_scene scene = {0};
  abbe_known_setting row = {.what = what,
                            .unit = "W/(m2 sr)",
                            .exact = lamp_radiance(0.4, 0.1, g),
                            .reason = reason,
                            .samples = 1 << 16,
                            .side = 32,
                            .channel = "Y"};
  abbe_number_format(what, sizeof what, "a lamp in mist, g %.2g, seen 0.2 m past it", g);
  abbe_result result = abbe_known_scene(
      &scene, error,
      "camera: {eye: [-1.5, 0, 0], target: [0, 0, 0], fov: 0.5}\n"
      "lights: [{name: lamp, kind: point, position: [0, 0.2, 0], intensity: 1}]\n"
      "medium: {scattering: 0.4, absorption: 0.1, g: %.17g, box: [[-1, -1, -1], [1, 1, 1]]}\n"
      "objects: [{name: far off, shape: rectangle, width: 9, height: 9, reflectance: 0,\n"
      "           transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [5, 0, 0]}]}]\n",
      g);
  return add_row(run, &row, 3e-2, result, &scene, from, to, error);
}

/* ---- under water ---- */

typedef struct shaft {
  double n, angle;                  /* the sun's to the upright in air, in the plane of y and z */
  double scattering, g, irradiance; /* across the beam in the water, below its surface */
} shaft;

static void enter_water(double scattering, double g, double n, shaft *out) {
  *out = (shaft){.n = n, .angle = 30 / ABBE_KNOWN_DEGREES, .scattering = scattering, .g = g};
  const double inside = asin(sin(out->angle) / n);
  out->irradiance = (1 - abbe_closed_form_fresnel(out->angle, n)) * cos(out->angle) / cos(inside);
}

/* From the depth down along the unit d over a length: the way to each place is a straight line in
 * its depth. */
static double shaft_radiance(const shaft *s, double depth, const double d[3], double length) {
  const double inside = asin(sin(s->angle) / s->n);
  const double turned = -(sin(inside) * d[1] - cos(inside) * d[2]);
  const double slope = s->scattering * (1 - d[2] / cos(inside));
  const double first = s->scattering * depth / cos(inside);
  return s->irradiance * s->scattering * abbe_medium_phase(s->g, turned) * exp(-first) *
         -expm1(-slope * length) / slope;
}

static abbe_result water_scene(const char *camera, double fov, const shaft *s, const char *things,
                               abbe_scene *out, abbe_error *error) {
  return abbe_known_scene(
      out, error,
      "camera: {%s, fov: %.17g}\n"
      "lights: [{name: sun, kind: directional, direction: [0, %.17g, %.17g], irradiance: 1}]\n"
      "objects:\n"
      "- {name: water, shape: water, size: [0.8, 0.8, 0.41], cells: 8, material: water,\n"
      "   medium: {scattering: %.17g, g: %.17g}}\n"
      "- {name: bottom, shape: rectangle, width: 4, height: 4, reflectance: 0,\n"
      "   transform: [{translate: [0, 0, -0.4]}]}\n"
      "- {name: side, shape: rectangle, width: 2, height: 0.56, reflectance: 0,\n" /* to the sun */
      "   transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0, -0.41, -0.22]}]}\n"
      "%s",
      camera, fov, sin(s->angle), -cos(s->angle), s->scattering, s->g, things);
}

/* Mean over a square view of that half width along x, to a wall 0.6 m off. */
static double seen_from_within(const shaft *s) {
  enum { SIDE = 200 };
  const double half = tan(15 / ABBE_KNOWN_DEGREES);
  double sum = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    const double a = half * ((2 * (i % SIDE) + 1) / (double)SIDE - 1);
    const double b = half * ((2 * (i / SIDE) + 1) / (double)SIDE - 1);
    const double length = sqrt(1 + a * a + b * b), d[3] = {1 / length, a / length, b / length};
    sum += shaft_radiance(s, 0.2, d, 0.6 * length) / (SIDE * SIDE);
  }
  return sum;
}

static abbe_result index_of_water(double *n, abbe_error *error) {
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  ABBE_TRY(abbe_known_stage_make(
      &stage, error, "- {name: ball, shape: sphere, radius: 1, levels: 1, material: water}\n"));
  return abbe_known_stage_n(&stage, middle_nm, n, error);
}

static abbe_result add_shaft(abbe_known_run *run, bool above, double from, double to,
                             abbe_error *error) {
  static const char wall[] =
      "- {name: wall, shape: rectangle, width: 0.38, height: 1, reflectance: 0,\n"
      "   transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [0.3, 0, -0.2]}]}\n";
  const double down[3] = {0, 0, -1};
  abbe_scene scene = {0};
  double n = 0;
  shaft s = {0};
  ABBE_TRY(index_of_water(&n, error));
  enter_water(0.8, 0.5, n, &s);
  abbe_known_setting row = {
      .what = above ? "sunlight in still water, seen straight from above: photons gathered"
                    : "sunlight in still water, seen from within: photons find the eye",
      .unit = "W/(m2 sr)",
      .reason = reason,
      .once = true,
      .samples = above ? 1 << 20 : 1 << 23,
      .side = 8,
      .channel = "Y"};
  row.exact =
      above ? shaft_radiance(&s, 0, down, 0.4) / (n * n) * (1 - abbe_closed_form_fresnel(0, n))
            : seen_from_within(&s);
  abbe_result result = above
                           ? water_scene("eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0]", 4, &s,
                                         "", &scene, error)
                           : water_scene("eye: [-0.3, 0, -0.2], target: [1, 0, -0.2], inside: true",
                                         30, &s, wall, &scene, error);
  return add_row(run, &row, 5e-2, result, &scene, from, to, error);
}

/* Light of 1 W/m2 goes straight down into a cube of air with haze, whose face fills the picture:
 * gathers are cut by its walls. So little is scattered that a second time does not count. */
static abbe_result add_cube(abbe_known_run *run, double from, double to, abbe_error *error) {
  const double scattering = 0.05, side = 0.04;
  abbe_scene scene = {0};
  abbe_known_setting row = {.what = "a cube with haze of 0.05/m in the sun, all of its face",
                            .unit = "W/(m2 sr)",
                            .exact = -expm1(-2 * scattering * side) / 2 * abbe_medium_phase(0, 1),
                            .reason = reason,
                            .samples = 1 << 17,
                            .side = 8,
                            .channel = "Y"};
  const abbe_result made = abbe_known_scene(
      &scene, error,
      "camera: {eye: [0, 0, 20], target: [0, 0, 0], up: [0, 1, 0], fov: 0.1123}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
      "objects:\n"
      "- {name: cube, shape: box, size: [%.17g, %.17g, %.17g], material: air,\n"
      "   medium: {scattering: %.17g}}\n"
      "- {name: far off, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0,\n"
      "   transform: [{translate: [0, 0, -1]}]}\n",
      side, side, side, scattering);
  return add_row(run, &row, 3e-2, made, &scene, from, to, error);
}

abbe_result abbe_known_medium(abbe_known_run *run, abbe_error *error) {
  static const slab slabs[] = {
      {.scattering = 0.5, .thickness = 1, .sun_deg = 30, .view_deg = 50},
      {.scattering = 1.5,
       .absorption = 0.5,
       .g = 0.6,
       .thickness = 1,
       .sun_deg = 30,
       .view_deg = 50},
      {.scattering = 1e-3, .g = -0.4, .thickness = 1, .sun_deg = 30, .view_deg = 50},
      {.scattering = 1,
       .absorption = 0.5,
       .g = 0.8,
       .thickness = 1,
       .sun_deg = 30,
       .view_deg = 50,
       .below = true}};
  enum { SLABS = sizeof slabs / sizeof *slabs };
  ABBE_TRY(add_phase(run, 0, error));
  ABBE_TRY(add_phase(run, 0.8f, error));
  ABBE_TRY(add_phase(run, -0.5f, error));
  for (int i = 0; i < SLABS; i++)
    ABBE_TRY(add_slab(run, &slabs[i], 0.05 * i, 0.05 * (i + 1), error));
  ABBE_TRY(add_left(run, 0.2, 0.22, error));
  ABBE_TRY(add_reached(run, 0.22, 0.26, error));
  ABBE_TRY(add_pencil(run, "air", 0.26, 0.28, error));
  ABBE_TRY(add_cube(run, 0.28, 0.3, error));
  ABBE_TRY(add_lamp(run, 0, 0.3, 0.35, error));
  ABBE_TRY(add_lamp(run, 0.7, 0.35, 0.4, error));
  ABBE_TRY(add_shaft(run, false, 0.4, 0.8, error));
  return add_shaft(run, true, 0.8, 1, error);
}
