/* Water: where single rays land under a wave, the focus under its crests, and the light that a wave
 * throws onto the bottom before that focus and behind it. */
#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"

#include <math.h>
#include <stdlib.h>

#define WAVELENGTH 0.1 /* m */
#define AMPLITUDE 0.002

/* A body as deep as the floor in it is, and a little more. */
static const char body[] =
    "- {name: water, shape: water, size: [0.4, 0.4, %.17g], cells: [1024, 32], material: water,\n"
    "   waves: [{amplitude: %.17g, wavelength: %.17g}]}\n"
    "- {name: bottom, shape: rectangle, width: 1, height: 1, reflectance: 1,\n"
    "   transform: [{translate: [0, 0, %.17g]}]}\n";

/* ---- single rays ---- */

static const char ray_reason[] = "1e-6 rad of a direction in single precision over the depth, and "
                                 "normals between vertices 1/256 "
                                 "of a wave apart, which are linear";

static abbe_result follow(abbe_known_stage *stage, double x, double lambda_nm, double *landing,
                          abbe_error *error) {
  const double from[3] = {x, 0.0013, 1}, down[3] = {0, 0, -1};
  ABBE_TRY(abbe_known_follow(stage, from, down, lambda_nm, "t", error));
  const abbe_route_vertex *last = &stage->vertex[stage->count > 0 ? stage->count - 1 : 0];
  const bool landed = stage->count == 2 && last->event == ABBE_ROUTE_LANDED;
  *landing = landed ? last->position[0] : NAN;
  return ABBE_OK;
}

static abbe_result add_rays(abbe_known_run *run, abbe_error *error) {
  enum { PLACES = 5 };
  abbe_wave_caustic w = {.amplitude = AMPLITUDE, .wavelength = WAVELENGTH, .depth = 0.25};
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  ABBE_TRY(abbe_known_stage_make(&stage, error, body, w.depth + 0.01, w.amplitude, w.wavelength,
                                 -w.depth));
  ABBE_TRY(abbe_known_stage_n(&stage, ABBE_LINE_D_NM, &w.index, error));
  for (int i = 0; i < PLACES; i++) {
    const double x = WAVELENGTH * (i + 0.3) / (2 * PLACES);
    abbe_known_answer row = {.unit = "m",
                             .exact = abbe_wave_caustic_landing(&w, x, NULL),
                             .tolerance = 2e-6,
                             .reason = ray_reason};
    ABBE_TRY(follow(&stage, x, ABBE_LINE_D_NM, &row.traced, error));
    abbe_number_format(row.quantity, sizeof row.quantity,
                       "a wave of 2 mm and 10 cm, 25 cm down: light %.4g mm off the crest lands",
                       1e3 * x);
    ABBE_TRY(abbe_known_add(run, row, error));
  }
  return ABBE_OK;
}

/* The crossing depends on the squared distance from the crest; through three to none at all. */
static abbe_result add_focus(abbe_known_run *run, const char *line, double lambda_nm,
                             abbe_error *error) {
  static const double steps[3] = {4, 8, 12}, factor[3] = {1.5, -0.6, 0.1};
  abbe_wave_caustic w = {.amplitude = AMPLITUDE, .wavelength = WAVELENGTH, .depth = 0.25};
  ABBE_OWNED(abbe_known_stage, stage) = {0};
  ABBE_TRY(abbe_known_stage_make(&stage, error, body, w.depth + 0.01, w.amplitude, w.wavelength,
                                 -w.depth));
  ABBE_TRY(abbe_known_stage_n(&stage, lambda_nm, &w.index, error));
  abbe_known_answer row = {.unit = "m",
                           .exact = abbe_wave_caustic_focus(&w),
                           .reason = "1e-3 of it: rays that converge by 0.003 rad, known to 1e-6"};
  row.tolerance = 1e-3 * row.exact;
  for (int i = 0; i < 3; i++) {
    const double x = steps[i] * WAVELENGTH / 256;
    double at = 0;
    ABBE_TRY(follow(&stage, x, lambda_nm, &at, error));
    const double crest = w.amplitude * (1 - cos(2 * ABBE_PI * x / w.wavelength));
    const double fell = w.depth + w.amplitude - crest;
    row.traced += factor[i] * (crest + fell * x / (x - at));
  }
  abbe_number_format(row.quantity, sizeof row.quantity,
                     "a wave of 2 mm and 10 cm: focus below its crest at the line %s", line);
  return abbe_known_add(run, row, error);
}

/* ---- what falls on the bottom ---- */

enum { BINS = 8, ACROSS = 256, DOWN = 32 };

/* Two waves across, each texel in the bin of its phase, 0 to pi either way. */
static abbe_result bins_of(const abbe_wave_caustic *w, abbe_rings *out, abbe_error *error) {
  const double origin[3] = {0, 0, 1}, down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  abbe_view view;
  *out = (abbe_rings){.width = ACROSS, .height = DOWN, .count = BINS};
  abbe_view_look(origin, down, up, true, &view);
  for (int k = 0; k < 4; k++) view.window[k] = (k % 2 ? 1 : -1) * (k < 2 ? 1 : 0.5) * w->wavelength;
  view.near = 0.5;
  view.far = 3;
  abbe_map_layout_make(&view, &out->layout);
  out->ring = malloc((size_t)ACROSS * DOWN);
  if (out->ring == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for texels");
  for (size_t i = 0; i < (size_t)ACROSS * DOWN; i++) {
    const double waves = 2 * ((double)(i % ACROSS) + 0.5) / ACROSS; /* from -1 wavelength */
    const double phase = fabs(waves - round(waves));                /* 0 to 1/2 */
    out->ring[i] = (uint8_t)fmin(BINS - 1, floor(2 * phase * BINS));
  }
  return ABBE_OK;
}

static const char light_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 2e-3 of the "
    "value, for the linear normals";

static abbe_result add_bins(abbe_known_run *run, const abbe_wave_caustic *w, double (*sum)[3],
                            size_t passes, abbe_error *error) {
  const double area = 2 * w->wavelength * w->wavelength / BINS;
  for (size_t b = 0; b < BINS; b++) {
    double mean, spread;
    const double from = 0.5 * w->wavelength * (double)b / BINS;
    const size_t rays = abbe_wave_caustic_branches(w, from + 0.25 * w->wavelength / BINS, 20000);
    abbe_known_mean(sum, passes, BINS, b, b + 1, 1, &mean, &spread);
    abbe_known_answer row = {
        .unit = "W/m2",
        .exact = abbe_wave_caustic_mean(w, from, from + 0.5 * w->wavelength / BINS, 2000000),
        .traced = mean / area,
        .standard_error = spread / area,
        .reason = light_reason};
    row.tolerance = abbe_known_sigmas(passes) * row.standard_error + 2e-3 * row.exact;
    row.useful = 0.05 * row.exact;
    abbe_number_format(row.quantity, sizeof row.quantity,
                       "light %.2g m under that wave, %.3g to %.3g mm off the crest: %zu ray%s",
                       w->depth, 1e3 * from, 1e3 * (from + 0.5 * w->wavelength / BINS), rays,
                       rays == 1 ? "" : "s");
    ABBE_TRY(abbe_known_add(run, row, error));
  }
  return ABBE_OK;
}

static abbe_result add_light(abbe_known_run *run, double depth, double from, double to,
                             abbe_error *error) {
  abbe_wave_caustic w = {.amplitude = AMPLITUDE, .wavelength = WAVELENGTH, .depth = depth};
  abbe_scene scene = {0};
  abbe_rings bins = {0};
  abbe_trace_desc desc = {0};
  abbe_known_narrow(ABBE_LINE_D_NM, &desc);
  const size_t passes = abbe_known_passes(run, 1 << 22, &desc);
  double(*sum)[3] = calloc(passes * BINS, sizeof *sum);
  abbe_result result =
      sum != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  char objects[1024];
  abbe_number_format(objects, sizeof objects, body, depth + 0.01, w.amplitude, w.wavelength,
                     -depth);
  if (result == ABBE_OK)
    result = abbe_known_scene(
        &scene, error,
        "camera: {eye: [0, -9, 4], target: [0, 0, 0]}\n"
        "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
        "objects:\n%s",
        objects);
  if (result == ABBE_OK)
    result = abbe_material_n(scene.object[0].material, ABBE_LINE_D_NM, &w.index, error);
  if (result == ABBE_OK)
    w.attenuation_per_m = abbe_material_attenuation(scene.object[0].material, ABBE_LINE_D_NM);
  if (result == ABBE_OK) result = bins_of(&w, &bins, error);
  if (result == ABBE_OK)
    result = abbe_known_measure(run, from, to, &scene, &desc, passes, &bins, sum, error);
  if (result == ABBE_OK) result = add_bins(run, &w, sum, passes, error);
  abbe_rings_free(&bins);
  abbe_scene_free(&scene);
  free(sum);
  return result;
}

/* ---- what is seen of it ---- */

/* Rows of a beam at 60 degrees: Fresnel's shares on entry and exit, Beer's law along both paths,
 * and one part in n^2 of the radiance, because it spreads over more directions in air.
 * [BornWolf1999, 4.8] */
static abbe_result add_seen(abbe_known_run *run, double from, double to, abbe_error *error) {
  const double angle = 60 / ABBE_KNOWN_DEGREES, depth = 0.1, middle_nm = 560;
  ABBE_OWNED(abbe_scene, scene) = {0};
  double n = 0;
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "camera: {eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 2}\n"
      "lights: [{name: sun, kind: directional, direction: [%.17g, 0, %.17g], irradiance: 1}]\n"
      "objects:\n"
      "- {name: water, shape: water, size: [1, 1, %.17g], material: water}\n"
      "- {name: bottom, shape: rectangle, width: 2, height: 2, reflectance: 1,\n"
      "   transform: [{translate: [0, 0, %.17g]}]}\n",
      sin(angle), -cos(angle), depth + 0.01, -depth));
  ABBE_TRY(abbe_material_n(scene.object[0].material, middle_nm, &n, error));
  abbe_known_setting s = {.what = "the bottom under 10 cm of still water, seen straight from above",
                          .unit = "W/(m2 sr)",
                          .reason = "as improbable as four standard errors, taken from the spread "
                                    "of the passes; and 2e-3 of the value, for one index stands "
                                    "for all wavelengths",
                          .samples = 1 << 22,
                          .side = 16,
                          .channel = "Y"};
  const double way = 1 + 1 / cos(asin(sin(angle) / n));
  const double per_m = abbe_material_attenuation(scene.object[0].material, middle_nm);
  s.exact = cos(angle) * (1 - abbe_closed_form_fresnel(angle, n)) *
            (1 - abbe_closed_form_fresnel(0, n)) * exp(-per_m * depth * way) / (n * n) / ABBE_PI;
  s.slack = 2e-3 * s.exact;
  s.useful = 5e-2 * s.exact;
  return abbe_known_add_setting(run, &s, &scene, from, to, error);
}

/* From under water: a ceiling that shines alike everywhere, n^2 times as bright through Fresnel's
 * share; and, beyond the critical angle, the bottom in the surface's mirror. */
static abbe_result add_below(abbe_known_run *run, bool mirrored, double from, double to,
                             abbe_error *error) {
  const double middle_nm = 560, pi = ABBE_PI;
  ABBE_OWNED(abbe_scene, scene) = {0};
  double n = 0;
  ABBE_TRY(abbe_known_scene(
      &scene, error,
      "ambient: %.17g\n"
      "camera: {eye: [0, 0, -0.2], target: [%g, 0, 0.4], up: [0, 1, 0], fov: 2, inside: true}\n"
      "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1.0e-9}]\n"
      "objects:\n"
      "- {name: water, shape: water, size: [9, 9, 0.41], material: water}\n"
      "- {name: bottom, shape: rectangle, width: 8, height: 8, reflectance: %g,\n"
      "   transform: [{translate: [0, 0, -0.4]}]}\n"
      "- {name: ceiling, shape: rectangle, width: 9, height: 9, reflectance: 1,\n"
      "   transform: [{translate: [0, 0, 1]}]}\n",
      pi, mirrored ? 1.2 : 0, mirrored ? 0.5 : 0));
  ABBE_TRY(abbe_material_n(scene.object[0].material, middle_nm, &n, error));
  const double through = n * n * (1 - abbe_closed_form_fresnel(0, n));
  abbe_known_setting s = {.what = mirrored ? "from under water, the bottom in the surface's mirror"
                                           : "from under water, the sky straight above",
                          .unit = "W/(m2 sr)",
                          .exact = mirrored ? 0.5 : through,
                          .reason = "as improbable as four standard errors, taken from the spread "
                                    "of the passes; and 2e-3 of the value, for one index stands "
                                    "for all wavelengths",
                          .samples = 1 << 14,
                          .side = 16,
                          .channel = "Y"};
  s.slack = 2e-3 * s.exact;
  s.useful = 3e-2 * s.exact;
  return abbe_known_add_setting(run, &s, &scene, from, to, error);
}

abbe_result abbe_known_water(abbe_known_run *run, abbe_error *error) {
  ABBE_TRY(add_rays(run, error));
  ABBE_TRY(add_focus(run, "F", ABBE_LINE_F_NM, error));
  ABBE_TRY(add_focus(run, "C", ABBE_LINE_C_NM, error));
  ABBE_TRY(add_light(run, 0.25, 0, 0.4, error));
  ABBE_TRY(add_light(run, 0.8, 0.4, 0.8, error));
  ABBE_TRY(add_seen(run, 0.8, 0.9, error));
  ABBE_TRY(add_below(run, false, 0.9, 0.95, error));
  return add_below(run, true, 0.95, 1, error);
}
