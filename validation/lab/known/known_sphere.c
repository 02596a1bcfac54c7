/* What a sphere throws onto a plane: receiver maps of whole runs, ring by ring, against the
 * quadrature. */
#include "base/maths.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
  SIDE = 256, /* texels of the map */
  RINGS = 4,
  RADII = (RINGS + 1) * (ABBE_RINGS_STEPS + 1),
  BANDS = 40
};

#define RADIUS 0.04 /* m */

/* Shares of the flux that reaches the plane, inside each ring's outer edge. */
static const double quantile[RINGS] = {0.1, 0.35, 0.6, 0.85};

/* A sphere, a light and a plane; distances in radii from the centre. */
typedef struct setting {
  const char *material;
  double light; /* 0: a beam */
  double plane;
  bool two_faces; /* no inner walls, as matched physics without any has it */
} setting;

static abbe_sphere_setup setup_of(const setting *s, size_t orders) {
  return (abbe_sphere_setup){.radius = RADIUS,
                             .index = 1,
                             .light_distance = s->light * RADIUS,
                             .plane_distance = s->plane * RADIUS,
                             .power = 1,
                             .inner_orders = s->two_faces ? 0 : orders,
                             .outside = true};
}

/* W that fall on the sphere for a power of 1. */
static double incident(const setting *s) {
  if (s->light <= 0) return ABBE_PI * RADIUS * RADIUS;
  double q = 1 / s->light;
  return 2 * ABBE_PI * q * q / (1 + sqrt(1 - q * q));
}

static abbe_result load(const setting *s, double outer, abbe_scene *scene, abbe_error *error) {
  char light[160];
  if (s->light > 0)
    abbe_number_format(light, sizeof light, "kind: point, position: [0, 0, %.17g], intensity: 1",
                       s->light * RADIUS);
  else
    snprintf(light, sizeof light, "kind: directional, direction: [0, 0, -1], irradiance: 1");
  return abbe_known_scene(
      scene, error,
      "camera: {eye: [0, -1, 0.2], target: [0, 0, %.17g]}\n"
      "lights: [{name: lamp, %s, illuminant: D65}]\n"
      "objects:\n"
      "- {name: ball, shape: sphere, radius: %.17g, material: %s}\n"
      "- {name: plane, shape: rectangle, width: %.17g, height: %.17g, reflectance: 0.5,\n"
      "   transform: [{translate: [0, 0, %.17g]}]}\n",
      -s->plane * RADIUS, light, RADIUS, s->material, 6 * outer, 6 * outer, -s->plane * RADIUS);
}

/* ---- the rings ---- */

/* The radius that holds the share of all that meets the plane, by bisection of its logarithm. */
static abbe_result radius_of(const abbe_sphere_quadrature *q, double share, double *radius,
                             abbe_error *error) {
  double all = 0, flux = 0, low = 1e-6 * RADIUS, high = 1e3 * RADIUS;
  ABBE_TRY(abbe_sphere_quadrature_enclosed(q, INFINITY, &all, error));
  for (int step = 0; step < 40; step++) {
    *radius = sqrt(low * high);
    ABBE_TRY(abbe_sphere_quadrature_enclosed(q, *radius, &flux, error));
    if (flux < share * all)
      low = *radius;
    else
      high = *radius;
  }
  return ABBE_OK;
}

static abbe_result edges_of(const setting *s, double n, double edge[RINGS + 1], abbe_error *error) {
  abbe_sphere_setup setup = setup_of(s, 3);
  ABBE_HELD(abbe_sphere_quadrature, q) = NULL;
  setup.index = n;
  ABBE_TRY(abbe_sphere_quadrature_make(&setup, &q, error));
  edge[0] = 0;
  for (int i = 0; i < RINGS; i++) ABBE_TRY(radius_of(q, quantile[i], &edge[i + 1], error));
  return ABBE_OK;
}

/* The light's own view of the outermost ring. */
static abbe_result rings_of(const setting *s, const double edge[RINGS + 1], abbe_rings *out,
                            abbe_error *error) {
  const double below = s->plane * RADIUS, above = (s->light > 0 ? s->light : 2) * RADIUS;
  const double origin[3] = {0, 0, above}, down[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  const double centre[3] = {0, 0, -below};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(origin, down, up, s->light <= 0, &view);
  double half = 1.02 * edge[RINGS] / (s->light > 0 ? above + below : 1);
  for (int k = 0; k < 4; k++) view.window[k] = k % 2 ? half : -half;
  view.near = (above - RADIUS) / 2;
  view.far = 2 * (above + below);
  abbe_map_layout_make(&view, &layout);
  return abbe_rings_make(&layout, SIDE, SIDE, centre, edge, RINGS, out, error);
}

/* Scene and rings of a setting whose rings are laid for the index n. */
static abbe_result prepare(const setting *s, double lambda_nm, abbe_scene *scene, abbe_rings *rings,
                           double *n, abbe_error *error) {
  double edge[RINGS + 1];
  abbe_result result = load(s, RADIUS, scene, error);
  if (result == ABBE_OK) result = abbe_material_n(scene->object[0].material, lambda_nm, n, error);
  if (result == ABBE_OK) result = edges_of(s, *n, edge, error);
  abbe_scene_free(scene);
  if (result == ABBE_OK) result = load(s, edge[RINGS], scene, error);
  return result == ABBE_OK ? rings_of(s, edge, rings, error) : result;
}

/* ---- rows ---- */

static const char ring_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 2e-4 of the "
    "light on all rings, for how the ragged edges of rings of texels share out a pole";

typedef struct part {
  size_t first, end; /* rings */
  int channel;
} part;

static abbe_result add_part(abbe_known_run *run, const setting *s, const char *what,
                            const abbe_rings *rings, double (*sum)[3], size_t passes,
                            const double (*exact)[3], part p, abbe_error *error) {
  static const char *const names[3] = {"X", "Y", "Z"};
  double mean = 0, spread = 0, known = 0, all = 0, scale = 1 / incident(s);
  abbe_known_mean(sum, passes, rings->count, p.first, p.end, p.channel, &mean, &spread);
  for (size_t i = 0; i < rings->count; i++) {
    all += exact[i][p.channel];
    if (i >= p.first && i < p.end) known += exact[i][p.channel];
  }
  abbe_known_answer row = {
      .unit = "incident",
      .exact = known * scale,
      .traced = mean * scale,
      .standard_error = spread * scale,
      .tolerance = (abbe_known_sigmas(passes) * spread + 2e-4 * all) * scale,
      .useful = 0.02 * known * scale,
      .reason = ring_reason,
  };
  char light[24] = "beam";
  if (s->light > 0) abbe_number_format(light, sizeof light, "point %g R up", s->light);
  abbe_number_format(row.quantity, sizeof row.quantity, "%s%s, %s, plane %g R, %s %s %.3g-%.3g R",
                     s->material, s->two_faces ? " matched" : "", light, s->plane, names[p.channel],
                     what, rings->edge[p.first] / RADIUS, rings->edge[p.end] / RADIUS);
  return abbe_known_add(run, row, error);
}

/* Every ring by itself, and the circle that they fill. */
static abbe_result add_rows(abbe_known_run *run, const setting *s, const abbe_rings *rings,
                            double (*sum)[3], size_t passes, const double (*exact)[3],
                            int first_channel, int end_channel, abbe_error *error) {
  for (int c = first_channel; c < end_channel; c++) {
    for (size_t i = 0; i < rings->count; i++)
      ABBE_TRY(add_part(run, s, "ring", rings, sum, passes, exact, (part){i, i + 1, c}, error));
    ABBE_TRY(
        add_part(run, s, "circle", rings, sum, passes, exact, (part){0, rings->count, c}, error));
  }
  return ABBE_OK;
}

/* ---- runs ---- */

/* Flux on every ring for one wavelength: Y is power there. */
static abbe_result expect_one(const setting *s, double n, const abbe_rings *rings,
                              double (*exact)[3], abbe_error *error) {
  double radius[RADII], enclosed[RADII], flux[RINGS];
  abbe_sphere_setup setup = setup_of(s, 24);
  abbe_sphere_quadrature *q = NULL;
  setup.index = n;
  abbe_result result = abbe_sphere_quadrature_make(&setup, &q, error);
  abbe_rings_radii(rings, radius);
  for (int i = 0; i < RADII && result == ABBE_OK; i++)
    result = abbe_sphere_quadrature_enclosed(q, radius[i], &enclosed[i], error);
  abbe_sphere_quadrature_free(q);
  if (result != ABBE_OK) return result;
  abbe_rings_expect(rings, enclosed, 1, flux);
  for (int i = 0; i < RINGS; i++) exact[i][1] = flux[i];
  return ABBE_OK;
}

static abbe_result expect_white(const setting *s, const abbe_scene *scene, const abbe_rings *rings,
                                double (*exact)[3], abbe_error *error) {
  double radius[RADII], xyz[RADII][3], flux[RINGS];
  abbe_sphere_setup setup = setup_of(s, 10);
  abbe_rings_radii(rings, radius);
  ABBE_TRY(abbe_sphere_quadrature_xyz(&setup, scene->object[0].material,
                                      &scene->light[0].illuminant, ABBE_WAVELENGTH_MIN_NM,
                                      ABBE_WAVELENGTH_MAX_NM, BANDS, radius, RADII, xyz, error));
  for (int c = 0; c < 3; c++) {
    abbe_rings_expect(rings, &xyz[0][c], 3, flux);
    for (int i = 0; i < RINGS; i++) exact[i][c] = flux[i];
  }
  return ABBE_OK;
}

typedef struct share {
  double from, to; /* range of the group's work */
} share;

static abbe_result run_setting(abbe_known_run *run, const setting *s, bool white, share done,
                               abbe_error *error) {
  abbe_scene scene = {0};
  abbe_rings rings = {0};
  abbe_trace_desc desc = {.physics = {.matched = s->two_faces}};
  double n = 0, exact[RINGS][3] = {{0}};
  if (!white) abbe_known_narrow(ABBE_LINE_D_NM, &desc);
  size_t passes = abbe_known_passes(run, white ? 1 << 23 : 1 << 22, &desc);
  double(*sum)[3] = calloc(passes * RINGS, sizeof *sum);
  abbe_result result = sum != NULL ? prepare(s, ABBE_LINE_D_NM, &scene, &rings, &n, error)
                                   : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  if (result == ABBE_OK)
    result = white ? expect_white(s, &scene, &rings, exact, error)
                   : expect_one(s, n, &rings, exact, error);
  if (result == ABBE_OK)
    result = abbe_known_measure(run, done.from, done.to, &scene, &desc, passes, &rings, sum, error);
  if (result == ABBE_OK)
    result = add_rows(run, s, &rings, sum, passes, (const double(*)[3])exact, white ? 0 : 1,
                      white ? 3 : 2, error);
  abbe_rings_free(&rings);
  abbe_scene_free(&scene);
  free(sum);
  return result;
}

/* Three indices, two lights, three distances; and what matched physics has of two of them. */
static const setting settings[] = {
    {"fused-silica", 0, 1.25, false},
    {"fused-silica", 0, 2, false},
    {"fused-silica", 0, 4, false},
    {"fused-silica", 3, 1.25, false},
    {"fused-silica", 3, 2, false},
    {"fused-silica", 3, 4, false},
    {"sf10", 0, 1.25, false},
    {"sf10", 0, 2, false},
    {"sf10", 0, 4, false},
    {"sf10", 3, 1.25, false},
    {"sf10", 3, 2, false},
    {"sf10", 3, 4, false},
    {"diamond", 0, 1.25, false},
    {"diamond", 0, 2, false},
    {"diamond", 0, 4, false},
    {"diamond", 3, 1.25, false},
    {"diamond", 3, 2, false},
    {"diamond", 3, 4, false},
    {"sf10", 0, 2, true},
    {"sf10", 3, 2, true},
};
static const setting white_settings[] = {
    {"sf10", 0, 1.6, false}, {"sf10", 3, 2.2, false}, {"fused-silica", 0, 1.9, false}};

enum { SETTINGS = sizeof settings / sizeof *settings };
enum { WHITE_SETTINGS = sizeof white_settings / sizeof *white_settings };

abbe_result abbe_known_sphere_setting(abbe_known_run *run, size_t index, bool white,
                                      abbe_error *error) {
  const size_t count = white ? WHITE_SETTINGS : SETTINGS;
  if (index >= count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "sphere %zu is beyond the %zu there are",
                          index, count);
  const share done = {(double)index / (double)count, (double)(index + 1) / (double)count};
  return run_setting(run, white ? &white_settings[index] : &settings[index], white, done, error);
}

abbe_result abbe_known_sphere(abbe_known_run *run, abbe_error *error) {
  for (size_t i = 0; i < SETTINGS; i++) ABBE_TRY(abbe_known_sphere_setting(run, i, false, error));
  return ABBE_OK;
}

abbe_result abbe_known_white(abbe_known_run *run, abbe_error *error) {
  for (size_t i = 0; i < WHITE_SETTINGS; i++)
    ABBE_TRY(abbe_known_sphere_setting(run, i, true, error));
  return ABBE_OK;
}

/* ---- convergence ---- */

enum { LEVELS = 7, BLOCK = 16, CONVERGENCE_PASSES = 1024 };

/* Relative squared error of the rings, a mean over them, of the mean of passes [from, from +
 * count). */
static double squared_error(double (*sum)[3], size_t from, size_t count, const double (*exact)[3]) {
  double square = 0;
  for (size_t i = 0; i < RINGS; i++) {
    double mean = 0, spread = 0;
    abbe_known_mean(sum + from * RINGS, count, RINGS, i, i + 1, 1, &mean, &spread);
    square += pow(mean / exact[i][1] - 1, 2) / RINGS;
  }
  return square;
}

/* Root mean square of that over all blocks of so many passes. */
static double rms_error(double (*sum)[3], size_t passes, size_t count, const double (*exact)[3]) {
  size_t blocks = passes / count;
  double square = 0;
  for (size_t b = 0; b < blocks; b++)
    square += squared_error(sum, b * count, count, exact) / (double)blocks;
  return sqrt(square);
}

/* What the spread of all passes says of the mean of `count`. */
static double rms_expected(double (*sum)[3], size_t passes, size_t count,
                           const double (*exact)[3]) {
  double square = 0;
  for (size_t i = 0; i < RINGS; i++) {
    double mean = 0, spread = 0;
    abbe_known_mean(sum, passes, RINGS, i, i + 1, 1, &mean, &spread);
    square += pow(spread / exact[i][1], 2) * (double)passes / (double)count / RINGS;
  }
  return sqrt(square);
}

/* A root mean square of `values` errors, some of them bound to each other, is sure to this share.
 */
static double sure(double values) {
  return 1 / sqrt(2 * values);
}

static abbe_result add_levels(abbe_known_run *run, double (*sum)[3], size_t passes, size_t photons,
                              const double (*exact)[3], abbe_error *error) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (size_t level = 0, count = 1; level < LEVELS; level++, count *= 2) {
    double rms = rms_error(sum, passes, count, exact), expected;
    /* Rings share the photons: three of the four are free. */
    double blocks = (double)(passes / count), relative = sure(3 * blocks);
    expected = rms_expected(sum, passes, count, exact);
    double x = log((double)count), y = log(rms), weight = 1 / (relative * relative);
    w += weight, wx += weight * x, wy += weight * y, wxx += weight * x * x, wxy += weight * x * y;
    abbe_known_answer row = {
        .unit = "relative",
        .exact = expected,
        .traced = rms,
        .standard_error = relative * rms,
        .tolerance = ABBE_KNOWN_SIGMAS * relative * expected,
        .useful = 0.5 * expected,
        .photons = (double)(count * photons),
        .reason = "four standard errors of a root mean square over that many runs of four rings, "
                  "three of them free"};
    snprintf(row.quantity, sizeof row.quantity, "error of the rings after %zu photons, %zu runs",
             count * photons, passes / count);
    ABBE_TRY(abbe_known_add(run, row, error));
  }
  double determinant = w * wxx - wx * wx;
  abbe_known_answer row = {.unit = "power",
                           .exact = -0.5,
                           .traced = (w * wxy - wx * wy) / determinant,
                           .standard_error = sqrt(w / determinant),
                           .tolerance = ABBE_KNOWN_SIGMAS * sqrt(w / determinant),
                           .useful = 0.1,
                           .reason = "four standard errors of the slope through the points above"};
  snprintf(row.quantity, sizeof row.quantity, "slope of the error over the photons, both as logs");
  return abbe_known_add(run, row, error);
}

/* Error over stated standard error, which with so few passes follows Student's distribution. */
static abbe_result add_honesty(abbe_known_run *run, double (*sum)[3], size_t passes,
                               const double (*exact)[3], abbe_error *error) {
  const double free = BLOCK - 1, second = free / (free - 2);
  const double fourth = 3 * free * free / ((free - 2) * (free - 4));
  size_t blocks = passes / BLOCK;
  double square = 0;
  for (size_t b = 0; b < blocks; b++)
    for (size_t i = 0; i < RINGS; i++) {
      double mean = 0, spread = 0;
      abbe_known_mean(sum + b * BLOCK * RINGS, BLOCK, RINGS, i, i + 1, 1, &mean, &spread);
      square += pow((mean - exact[i][1]) / spread, 2) / (double)(blocks * RINGS);
    }
  double spread = sqrt((fourth - second * second) / (3 * (double)blocks)) / (2 * sqrt(second));
  abbe_known_answer row = {
      .unit = "1",
      .exact = sqrt(second),
      .traced = sqrt(square),
      .standard_error = spread,
      .tolerance = ABBE_KNOWN_SIGMAS * spread,
      .useful = 0.5,
      .reason = "four standard errors; Student's distribution of 15 degrees of freedom is a little "
                "wider than the normal one"};
  snprintf(row.quantity, sizeof row.quantity,
           "error over the standard error that a run of %d passes states", BLOCK);
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_convergence(abbe_known_run *run, abbe_error *error) {
  const setting s = {"sf10", 3, 2, false};
  abbe_scene scene = {0};
  abbe_rings rings = {0};
  abbe_trace_desc desc = {0};
  double n = 0, exact[RINGS][3] = {{0}};
  size_t passes = CONVERGENCE_PASSES;
  abbe_known_narrow(ABBE_LINE_D_NM, &desc);
  abbe_known_passes(run, 1 << 20, &desc);
  double(*sum)[3] = calloc(passes * RINGS, sizeof *sum);
  abbe_result result = sum != NULL ? prepare(&s, ABBE_LINE_D_NM, &scene, &rings, &n, error)
                                   : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  if (result == ABBE_OK) result = expect_one(&s, n, &rings, exact, error);
  if (result == ABBE_OK)
    result = abbe_known_measure(run, 0, 1, &scene, &desc, passes, &rings, sum, error);
  const double(*known)[3] = (const double(*)[3])exact;
  if (result == ABBE_OK) result = add_levels(run, sum, passes, desc.photons, known, error);
  if (result == ABBE_OK) result = add_honesty(run, sum, passes, known, error);
  abbe_rings_free(&rings);
  abbe_scene_free(&scene);
  free(sum);
  return result;
}
