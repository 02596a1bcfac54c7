/* Mirrors: what metals reflect, a ball's light from afar, images between two mirrors, and what a
 * ring throws onto its floor. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/maths.h"
#include "base/number.h"
#include "spectral/dispersion/dispersion.h"
#include "validation/trace/transport/mirrors.h"

#include <math.h>
#include <stdio.h>

/* ---- metals ---- */

static abbe_result add_metal(abbe_known_run *run, const char *metal, double degrees,
                             abbe_error *error) {
  const double lambda_nm[2] = {ABBE_LINE_D_NM, ABBE_LINE_D_NM + 1}, angle = degrees * ABBE_PI / 180;
  abbe_known_stage stage;
  abbe_mirrors mirrors = {0};
  double n = 0, k = 0;
  ABBE_TRY(abbe_known_stage_make(&stage, error,
                                 "- {name: ball, shape: sphere, radius: 1, mirror: %s}\n", metal));
  abbe_result result =
      abbe_material_nk(stage.scene.object[0].conductor, ABBE_LINE_D_NM, &n, &k, error);
  if (result == ABBE_OK) result = abbe_mirrors_make(&stage.geometry, lambda_nm, 1, &mirrors, error);
  abbe_known_answer row = {.unit = "share",
                           .exact = abbe_closed_form_conductor(angle, n, k),
                           .tolerance = 2e-6,
                           .reason = "single precision of n, k and some twenty operations"};
  if (result == ABBE_OK)
    row.traced = (double)abbe_mirrors_reflect(&mirrors, 0, (float)cos(angle), 0, 0);
  abbe_mirrors_free(&mirrors);
  abbe_known_stage_free(&stage);
  if (result != ABBE_OK) return result;
  abbe_number_format(row.quantity, sizeof row.quantity, "%s, reflected at %g degrees at d", metal,
                     degrees);
  return abbe_known_add(run, row, error);
}

static abbe_result add_metals(abbe_known_run *run, abbe_error *error) {
  static const char *const metals[] = {"silver", "aluminium", "gold", "copper"};
  for (int i = 0; i < 8; i++) ABBE_TRY(add_metal(run, metals[i / 2], i % 2 ? 60 : 0, error));
  return ABBE_OK;
}

/* ---- whole runs ---- */

typedef struct work {
  double from, to; /* range of the group */
} work;

/* For white receivers, whose caustic the picture shows. */
static const abbe_known_setting caustic = {.unit = "W/(m2 sr)",
                                           .reason = "as improbable as four standard errors, taken "
                                                     "from the spread of the passes; and 1e-3 of "
                                                     "the value for sizes and facets",
                                           .samples = 1 << 20,
                                           .side = 16,
                                           .channel = "caustic.Y"};

static abbe_result add_run(abbe_known_run *run, abbe_known_setting s, const abbe_scene *scene,
                           work w, abbe_error *error) {
  s.slack = 1e-3 * s.exact;
  s.useful = 3e-2 * s.exact;
  return abbe_known_add_setting(run, &s, scene, w.from, w.to, error);
}

/* Mean over the square of side 2 half around (x, 0, 0) of the irradiance by a light of 1 W/sr at
 * (at, 0, height). */
static double mean_irradiance(double at, double height, double x, double half) {
  enum { STEPS = 40 };
  double sum = 0;
  for (int i = 0; i < STEPS * STEPS; i++) {
    const double a = x - at + half * ((2 * (i % STEPS) + 1.0) / STEPS - 1);
    const double b = half * ((2 * (i / STEPS) + 1.0) / STEPS - 1);
    sum += height / pow(height * height + a * a + b * b, 1.5);
  }
  return sum / (STEPS * STEPS);
}

/* Irradiance that a whole mirror of a ball of radius r around the origin, in a beam of 1 W/m2 along
 * -z, makes across its light at p. From afar r^2 / (4 |p|^2) in every direction; here the narrow
 * bundle about the ray that comes to p spreads by 1 + 2 t / (r cos i) in its plane of incidence and
 * by 1 + 2 t cos i / r across it. [BornWolf1999, 4.6] */
static double ball_light(double r, const double p[3], double direction[3]) {
  double n[3] = {p[0], p[1], p[2] + abbe_vector_length(p)}, t = 0;
  for (int round = 0; round < 40; round++) { /* half way between the beam and p, seen from there */
    abbe_vector_normalise(n);
    for (int k = 0; k < 3; k++) direction[k] = p[k] - r * n[k];
    t = abbe_vector_length(direction);
    abbe_vector_normalise(direction);
    for (int k = 0; k < 3; k++) n[k] = direction[k] + (k == 2 ? 1 : 0);
  }
  abbe_vector_normalise(n);
  return 1 / ((1 + 2 * t / (r * n[2])) * (1 + 2 * t * n[2] / r));
}

/* A ball of radius R in a beam of E sends rho E R^2 / 4 into every direction, from afar. */
static abbe_result add_ball(abbe_known_run *run, double degrees, work w, abbe_error *error) {
  enum { STEPS = 32 };
  const double r = 0.02, beam = 1e4, angle = degrees * ABBE_PI / 180,
               half = 0.7 * tan(20 * ABBE_PI / 180);
  const double x = sin(angle), z = -cos(angle); /* from the beam's own direction on */
  ABBE_OWNED(abbe_scene, scene) = {0};
  abbe_known_setting s = caustic;
  char what[96];
  abbe_number_format(what, sizeof what, "mirror ball, light sent %g degrees off the beam", degrees);
  s.what = what;
  for (int i = 0; i < STEPS * STEPS; i++) {
    const double a = half * ((2 * (i % STEPS) + 1.0) / STEPS - 1);
    const double b = half * ((2 * (i / STEPS) + 1.0) / STEPS - 1);
    const double p[3] = {x - a * z, b, z + a * x};
    double d[3];
    const double light = ball_light(r, p, d);
    s.exact += 0.8 * beam / ABBE_PI * light * (d[0] * x + d[2] * z) / (STEPS * STEPS);
  }
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "camera: {eye: [%.17g, 0, %.17g], target: [%.17g, 0, %.17g], up: [0, 1, 0], fov: 40}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: %g}]\n"
      "objects:\n"
      "- {name: ball, shape: sphere, radius: %g, mirror: 0.8}\n"
      "- {name: screen, shape: rectangle, width: 0.54, height: 0.54, reflectance: 1,\n"
      "   transform: [{look: {from: [%.17g, 0, %.17g], to: [0, 0, 0], up: [0, 1, 0]}}]}\n",
      0.3 * x, 0.3 * z, x, z, beam, r, x, z));
  return add_run(run, s, &scene, w, error);
}

static const char between_mirrors[] =
    "- {name: left, shape: rectangle, width: 8, height: 8, mirror: 0.8, transform: [{rotate: "
    "{axis: [0, 1, 0], angle: 90}}, {translate: [-0.5, 0, 3.9]}]}\n"
    "- {name: right, shape: rectangle, width: 8, height: 8, mirror: 0.8, transform: [{rotate: "
    "{axis: [0, 1, 0], angle: 90}}, {translate: [0.5, 0, 3.9]}]}\n";

/* A light between two mirrors shines as its images do, each by 0.8 fainter than the one before. */
static abbe_result add_images(abbe_known_run *run, work w, abbe_error *error) {
  const double lamp = 0.1, height = 0.5, x = -0.15, half = 0.3;
  ABBE_OWNED(abbe_scene, scene) = {0};
  abbe_known_setting s = caustic;
  s.what = "lamp between two mirrors of 0.8, its images' light on the floor";
  for (int k = 1; k < 60; k++)
    for (int side = -1; side <= 1; side += 2)
      s.exact += pow(0.8, k) / ABBE_PI *
                 mean_irradiance(side * k + (k % 2 ? -lamp : lamp), height, x, half);
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "camera: {eye: [%g, 0, 2], target: [%g, 0, 0], up: [0, 1, 0], fov: %.17g}\n"
      "lights: [{name: lamp, kind: point, position: [%g, 0, %g], intensity: 1}]\n"
      "objects:\n"
      "- {name: floor, shape: rectangle, width: 20, height: 20, reflectance: 1}\n%s",
      x, x, 2 * atan(half / 2) * 180 / ABBE_PI, lamp, height, between_mirrors));
  return add_run(run, s, &scene, w, error);
}

/* A ray of 45 degrees meets the mirrors 1 m apart four times before it leaves them. */
static abbe_result add_passage(abbe_known_run *run, work w, abbe_error *error) {
  ABBE_OWNED(abbe_scene, scene) = {0};
  abbe_known_setting s = caustic;
  s.what = "uniform light seen by four reflections between two mirrors of 0.8";
  s.channel = "Y";
  s.samples = 1 << 16;
  s.exact = 2 * pow(0.8, 4);
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "camera: {eye: [0.25, 0, 0], target: [0.75, 0, -0.5], fov: 1}\n"
      "environment: {size: 64, uniform: 2}\n"
      "objects:\n"
      "- {name: mote, shape: rectangle, width: 1.0e-6, height: 1.0e-6, reflectance: 1,\n"
      "   transform: [{translate: [9, 9, 9]}]}\n"
      "- {name: below, shape: rectangle, width: 4, height: 4, mirror: 0.8,\n"
      "   transform: [{translate: [2, 0, -0.5]}]}\n"
      "- {name: above, shape: rectangle, width: 4, height: 4, mirror: 0.8,\n"
      "   transform: [{translate: [2, 0, 0.5]}]}\n"));
  return add_run(run, s, &scene, w, error);
}

/* ---- the ring ---- */

#define RADIUS 0.05 /* m */

typedef struct place {
  const char *what;
  double height, elevation, lamp[3]; /* radii, degrees */
  double at[2], half;                /* radii */
} place;

static const place places[] = {
    {"ring in the sun, before the nephroid's cusp", 1, 45, {0}, {0.2, 0}, 0.1},
    {"ring in the sun, within the nephroid", 1, 45, {0}, {0.75, 0}, 0.07},
    {"ring in the sun, high wall, light of two reflections too", 3, 45, {0}, {-0.6, 0.1}, 0.14},
    {"ring, a lamp by its wall, before the cardioid's cusp", 2, 0, {0.95, 0, 4}, {0, 0.05}, 0.1},
    {"ring, a lamp by its wall, within the cardioid", 2, 0, {0.95, 0, 4}, {-0.6, 0}, 0.07},
};

static abbe_result add_ring(abbe_known_run *run, const place *p, work w, abbe_error *error) {
  const bool sun = p->elevation > 0;
  const double e = p->elevation * ABBE_PI / 180, away = 20 * RADIUS;
  const double at[2] = {RADIUS * p->at[0], RADIUS * p->at[1]}, half = RADIUS * p->half;
  abbe_catacaustic c = {.radius = RADIUS, .height = RADIUS * p->height, .elevation = e};
  for (int k = 0; k < 3; k++) c.lamp[k] = RADIUS * p->lamp[k];
  ABBE_OWNED(abbe_scene, scene) = {0};
  abbe_known_setting s = caustic;
  size_t branches;
  char what[112], light[160];
  s.exact = abbe_catacaustic_mean(&c, at, half, 12, 0.9, 3, &branches) / ABBE_PI;
  snprintf(what, sizeof what, "%s: %zu ray%s", p->what, branches, branches == 1 ? "" : "s");
  s.what = what;
  if (sun)
    abbe_number_format(light, sizeof light,
                       "kind: directional, direction: [%.17g, 0, %.17g], irradiance: 1", cos(e),
                       -sin(e));
  else
    abbe_number_format(light, sizeof light,
                       "kind: point, position: [%.17g, %.17g, %.17g], intensity: 1", c.lamp[0],
                       c.lamp[1], c.lamp[2]);
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "camera: {eye: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, 0], up: [0, 1, 0], fov: "
      "%.17g}\n"
      "lights: [{name: lamp, %s}]\n"
      "objects:\n"
      "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 1}\n"
      "- {name: ring, shape: lathe, around: 2048, profile: [[%.17g, 0], [%.17g, %.17g]],\n"
      "   mirror: 0.9}\n",
      at[0], at[1], away, at[0], at[1], 2 * atan(half / away) * 180 / ABBE_PI, light, c.radius,
      c.radius, c.height));
  return add_run(run, s, &scene, w, error);
}

abbe_result abbe_known_mirror(abbe_known_run *run, abbe_error *error) {
  static const double degrees[] = {30, 90, 120, 150};
  enum { BALLS = 4, RINGS = sizeof places / sizeof *places, RUNS = BALLS + 2 + RINGS };
  ABBE_TRY(add_metals(run, error));
  for (int i = 0; i < RUNS; i++) {
    const work w = {(double)i / RUNS, (i + 1.0) / RUNS};
    ABBE_TRY(i < BALLS        ? add_ball(run, degrees[i], w, error)
             : i == BALLS     ? add_images(run, w, error)
             : i == BALLS + 1 ? add_passage(run, w, error)
                              : add_ring(run, &places[i - BALLS - 2], w, error));
  }
  return ABBE_OK;
}
