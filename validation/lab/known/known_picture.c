#include "validation/lab/known/forms/closed_form.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/plot/chart.h"
#include "spectral/dispersion/dispersion.h"
#include "validation/lab/known/known_answers.h"
#include "validation/lab/known/known_light.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Light under a sphere as the camera sees it: pictures of whole runs, ring by ring, against the
 * quadrature. The plane is seen past the sphere, straight or through a pane. */
#define RADIUS 0.04 /* m */
#define PLANE 4.0   /* radii below the centre */
#define REFLECTANCE 0.5
#define FOV_RAD 0.6

enum { SIDE = 128, RINGS = 4, RADII = (RINGS + 1) * (ABBE_RINGS_STEPS + 1) };

/* Radii; the shadow's edge at 1 under a beam and 7/3 under the point lies within a ring. */
static const double edges[2][RINGS + 1] = {{0, 0.6, 1.4, 2.4, 3.6}, {0, 0.3, 0.8, 1.6, 2.8}};

/* How the camera sees the plane: straight, or through a thin pane before it, whose own refraction
 * moves nothing by more than 3e-4 R. */
typedef struct view_of {
  double light;
  const double *edge;
  bool through;
} view_of;
/* Under the point light a pane would throw light of its own onto the plane. */
static const view_of views[] = {{0, edges[0], false}, {3, edges[1], false}, {0, edges[0], true}};
enum { VIEWS = sizeof views / sizeof *views };

#define PANE_M 2e-4

static const double eye[3] = {14 * RADIUS, 0, (9 - PLANE) * RADIUS};
static const double centre[3] = {0, 0, -PLANE *RADIUS};

static abbe_result load(const view_of *v, abbe_scene *scene, abbe_error *error) {
  char lamp[160], pane[300] = "";
  const double light = v->light, q = 0.3; /* share of the distance to the plane's middle */
  if (v->through)
    abbe_number_format(
        pane, sizeof pane,
        "- {name: pane, shape: box, size: [0.25, 0.25, %g], material: fused-silica,\n"
        "   transform: [{look: {from: [%.17g, 0, %.17g], to: [%.17g, 0, %.17g]}}]}\n",
        PANE_M, eye[0] + q * (centre[0] - eye[0]), eye[2] + q * (centre[2] - eye[2]), eye[0],
        eye[2]);
  if (light > 0)
    abbe_number_format(lamp, sizeof lamp, "kind: point, position: [0, 0, %.17g], intensity: 1",
                       light * RADIUS);
  else
    snprintf(lamp, sizeof lamp, "kind: directional, direction: [0, 0, -1], irradiance: 1");
  return abbe_known_scene(
      scene, error,
      "camera: {eye: [%.17g, %.17g, %.17g], target: [0, 0, %.17g], fov: %.17g}\n"
      "lights: [{name: lamp, %s}]\n"
      "objects:\n"
      "- {name: ball, shape: sphere, radius: %.17g, material: fused-silica}\n"
      "- {name: plane, shape: rectangle, width: 0.5, height: 0.5, reflectance: %g,\n"
      "   transform: [{translate: [0, 0, %.17g]}]}\n%s",
      eye[0], eye[1], eye[2], centre[2], FOV_RAD * ABBE_KNOWN_DEGREES, lamp, RADIUS, REFLECTANCE,
      centre[2], pane);
}

/* The camera's film as if it were a map's: rings of pixels. */
static abbe_result rings_of(const double edge[RINGS + 1], abbe_rings *out, abbe_error *error) {
  const double up[3] = {0, 0, 1}, half = tan(FOV_RAD / 2);
  double forward[3], metres[RINGS + 1];
  abbe_view view;
  abbe_map_layout layout;
  abbe_vector_subtract(centre, eye, forward);
  abbe_view_look(eye, forward, up, false, &view);
  for (int k = 0; k < 4; k++) view.window[k] = k % 2 ? half : -half;
  view.near = 0.01;
  view.far = 10;
  abbe_map_layout_make(&view, &layout);
  for (int i = 0; i <= RINGS; i++) metres[i] = edge[i] * RADIUS;
  return abbe_rings_make(&layout, SIDE, SIDE, centre, metres, RINGS, out, error);
}

/* For every pixel, the flux in W on it for a radiance of 1: pi over the reflectance, times the area
 * of the plane that it sees. */
static void flux_of_pixels(const abbe_rings *rings, float *flux) {
  const double half = tan(FOV_RAD / 2), film = pow(2 * half / SIDE, 2);
  for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
    const double uv[2] = {((double)(i % SIDE) + 0.5) / SIDE, 1 - ((double)(i / SIDE) + 0.5) / SIDE};
    double origin[3], d[3];
    abbe_map_layout_ray(&rings->layout, uv, origin, d);
    double off_axis = abbe_vector_dot(d, rings->layout.view.forward);
    double distance = (centre[2] - origin[2]) / d[2];
    double angle = film * off_axis * off_axis * off_axis; /* sr of the pixel */
    double area = d[2] < 0 ? angle * distance * distance / -d[2] : 0;
    flux[i] = (float)(ABBE_PI / REFLECTANCE * area);
  }
}

/* Rings of the mean picture so far: channel 0 all light, 1 the caustic's. */
static abbe_result sum_so_far(const abbe_tracer *tracer, const abbe_rings *rings, const float *flux,
                              float *buffer, double (*sum)[3], abbe_error *error) {
  static const char *const names[2] = {"Y", "caustic.Y"};
  double one[RINGS];
  ABBE_OWNED(abbe_image, picture) = {0};
  ABBE_TRY(abbe_tracer_picture(tracer, &picture, error));
  for (int k = 0; k < 2; k++) {
    size_t at = abbe_image_find_channel(&picture, names[k]);
    if (at == (size_t)-1)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture has no channel %s",
                            names[k]);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
      buffer[i] = flux[i] * picture.data[i * picture.channels + at];
    abbe_rings_sum(rings, buffer, 1, false, one);
    for (int i = 0; i < RINGS; i++) sum[i][k] = one[i];
  }
  return ABBE_OK;
}

static abbe_result trace(const abbe_known_run *run, const abbe_scene *scene,
                         const abbe_trace_desc *desc, size_t passes, const abbe_rings *rings,
                         double (*sum)[3], double from, double to, abbe_error *error) {
  double mean[RINGS][3] = {{0}}, before[RINGS][3];
  ABBE_FREED float *flux = calloc(2 * (size_t)SIDE * SIDE, sizeof *flux);
  ABBE_HELD(abbe_tracer, tracer) = NULL;
  ABBE_TRY(flux != NULL ? abbe_tracer_make(scene, desc, &tracer, error)
                        : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture"));
  flux_of_pixels(rings, flux);
  for (size_t p = 0; p < passes; p++) {
    memcpy(before, mean, sizeof mean);
    ABBE_TRY(abbe_tracer_pass(tracer, NULL, error));
    ABBE_TRY(sum_so_far(tracer, rings, flux, flux + (size_t)SIDE * SIDE, mean, error));
    for (int i = 0; i < RINGS; i++)
      for (int k = 0; k < 2; k++)
        sum[p * RINGS + (size_t)i][k] = ((double)p + 1) * mean[i][k] - (double)p * before[i][k];
    double done = from + (to - from) * (double)(p + 1) / (double)passes;
    ABBE_TRY(abbe_known_progress(run, done, error));
  }
  return ABBE_OK;
}

/* What a pane leaves of the radiance behind it, head on. */
static double left_by_pane(const view_of *v, double n) {
  double reflected = 0, passed = 1;
  if (v->through) abbe_closed_form_slab(abbe_closed_form_fresnel(0, n), 1, &reflected, &passed);
  return passed;
}

static abbe_result expect(const view_of *v, const abbe_scene *scene, bool all,
                          const abbe_rings *rings, double *flux, abbe_error *error) {
  abbe_sphere_setup setup = {.radius = RADIUS,
                             .light_distance = v->light * RADIUS,
                             .plane_distance = PLANE * RADIUS,
                             .power = 1,
                             .inner_orders = 24,
                             .outside = true,
                             .past = all};
  double radius[RADII], enclosed[RADII];
  abbe_sphere_quadrature *q = NULL;
  abbe_result result =
      abbe_material_n(scene->object[0].material, ABBE_LINE_D_NM, &setup.index, error);
  if (result == ABBE_OK) result = abbe_sphere_quadrature_make(&setup, &q, error);
  abbe_rings_radii(rings, radius);
  for (int i = 0; i < RADII && result == ABBE_OK; i++)
    result = abbe_sphere_quadrature_enclosed(q, radius[i], &enclosed[i], error);
  abbe_sphere_quadrature_free(q);
  if (result != ABBE_OK) return result;
  abbe_rings_expect(rings, enclosed, 1, flux);
  for (int i = 0; i < RINGS; i++) flux[i] *= left_by_pane(v, setup.index);
  return ABBE_OK;
}

static const char picture_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 1e-3 for the "
    "ragged edges of rings of pixels, each of which spreads its light evenly";
static const char through_reason[] =
    "as improbable as four standard errors; and 5e-3 for the photons' gather, which carries light "
    "over the edges of rings as far as its radius, and for the pane's slanting rays";

static abbe_result add_rows(abbe_known_run *run, const view_of *v, bool all,
                            const abbe_rings *rings, double (*sum)[3], size_t passes,
                            const double *exact, abbe_error *error) {
  const double floor = v->through ? 5e-3 : 1e-3;
  for (size_t i = 0; i < RINGS; i++) {
    double mean = 0, spread = 0, area = 0, e[2] = {rings->edge[i], rings->edge[i + 1]};
    abbe_known_mean(sum, passes, RINGS, i, i + 1, all ? 0 : 1, &mean, &spread);
    area = ABBE_PI * (e[1] - e[0]) * (e[1] + e[0]);
    double scale = REFLECTANCE / ABBE_PI / area; /* to radiance */
    abbe_known_answer row = {
        .unit = "W/(m2 sr)",
        .exact = exact[i] * scale,
        .traced = mean * scale,
        .standard_error = spread * scale,
        .tolerance = (abbe_known_sigmas(passes) * spread + floor * exact[i]) * scale,
        .useful = 0.05 * exact[i] * scale,
        .reason = v->through ? through_reason : picture_reason,
    };
    abbe_number_format(row.quantity, sizeof row.quantity, "fused-silica, %s, %s%s, ring %g-%g R",
                       v->light > 0 ? "point 3 R up" : "beam", all ? "all light" : "the caustic",
                       v->through ? " through a pane" : "", e[0] / RADIUS, e[1] / RADIUS);
    ABBE_TRY(abbe_known_add(run, row, error));
  }
  return ABBE_OK;
}

abbe_result abbe_known_picture_setting(abbe_known_run *run, size_t index, abbe_error *error) {
  if (index >= VIEWS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "picture %zu is beyond the %d there are",
                          index, (int)VIEWS);
  const view_of *v = &views[index];
  abbe_scene scene = {0};
  abbe_rings rings = {0};
  abbe_trace_desc desc = {
      .no_map = true, .space = ABBE_RGB_SPACE_XYZ, .width = SIDE, .height = SIDE};
  double exact[RINGS], from = (double)index / VIEWS;
  abbe_known_narrow(ABBE_LINE_D_NM, &desc);
  size_t passes = abbe_known_passes(run, 1 << 21, &desc);
  double(*sum)[3] = calloc(passes * RINGS, sizeof *sum);
  abbe_result result = sum != NULL ? load(v, &scene, error)
                                   : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  if (result == ABBE_OK) result = rings_of(v->edge, &rings, error);
  if (result == ABBE_OK)
    result = trace(run, &scene, &desc, passes, &rings, sum, from, from + 1.0 / VIEWS, error);
  for (int all = 0; all < 2 && result == ABBE_OK; all++) {
    result = expect(v, &scene, all == 1, &rings, exact, error);
    if (result == ABBE_OK) result = add_rows(run, v, all == 1, &rings, sum, passes, exact, error);
  }
  abbe_rings_free(&rings);
  abbe_scene_free(&scene);
  free(sum);
  return result;
}

abbe_result abbe_known_picture(abbe_known_run *run, abbe_error *error) {
  for (size_t i = 0; i < VIEWS; i++) ABBE_TRY(abbe_known_picture_setting(run, i, error));
  return ABBE_OK;
}

enum { MAX_GROUPS = 32 };

/* Columns of numbers, each [count]; one piece of memory. */
typedef struct columns {
  double *x, *share;                               /* values of every row */
  double *photons, *error, *low, *high, *expected; /* values of the rows that stand over photons */
  size_t levels;
} columns;

static abbe_result fill(const abbe_known_answers *a, columns *c, abbe_error *error) {
  double *all = calloc(7 * a->count, sizeof *all);
  if (all == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a chart of %zu rows",
                          a->count);
  double **const column[7] = {&c->x,   &c->share, &c->photons, &c->error,
                              &c->low, &c->high,  &c->expected};
  for (size_t k = 0; k < 7; k++) *column[k] = all + k * a->count;
  for (size_t i = 0; i < a->count; i++) {
    const abbe_known_answer *r = &a->row[i];
    c->x[i] = (double)i + 1;
    c->share[i] = r->tolerance > 0 ? r->error / r->tolerance : r->error == 0 ? 0 : NAN;
    if (!(r->photons > 0)) continue;
    size_t k = c->levels++;
    c->photons[k] = r->photons;
    c->error[k] = r->traced;
    c->low[k] = r->traced - r->standard_error;
    c->high[k] = r->traced + r->standard_error;
    c->expected[k] = r->exact;
  }
  return ABBE_OK;
}

static size_t add_groups(const abbe_known_answers *a, const columns *c,
                         abbe_chart_series series[MAX_GROUPS]) {
  size_t count = 0;
  for (size_t from = 0, to; from < a->count && count < MAX_GROUPS; from = to) {
    for (to = from; to < a->count && a->row[to].group == a->row[from].group;) to++;
    series[count++] = (abbe_chart_series){.label = a->row[from].group,
                                          .style = ABBE_CHART_POINTS,
                                          .count = to - from,
                                          .x = c->x + from,
                                          .y = c->share + from};
  }
  return count;
}

abbe_result abbe_known_chart_write(const char *path, const abbe_known_answers *answers,
                                   abbe_error *error) {
  if (answers->count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: there are no answers to draw", path);
  columns c = {0};
  ABBE_TRY(fill(answers, &c, error));
  double reach = 1; /* rows out of tolerance are to be seen */
  for (size_t i = 0; i < answers->count; i++)
    if (isfinite(c.share[i])) reach = fmax(reach, 1.1 * fabs(c.share[i]));
  abbe_chart_series groups[MAX_GROUPS];
  const size_t count = add_groups(answers, &c, groups);
  const abbe_chart_series falling[] = {
      {.label = "1 / square root of the photons, from the passes' spread",
       .style = ABBE_CHART_LINE,
       .count = c.levels,
       .x = c.photons,
       .y = c.expected},
      {.label = "measured against the quadrature",
       .style = ABBE_CHART_POINTS,
       .count = c.levels,
       .x = c.photons,
       .y = c.error,
       .low = c.low,
       .high = c.high},
  };
  const abbe_chart charts[] = {
      {.title = "Error of the rings under a sphere",
       .x = {.label = "photons", .log = true},
       .y = {.label = "relative error, RMS", .log = true},
       .series_count = 2,
       .series = falling},
      {.title = "Errors of all known answers",
       .x = {.label = "row", .max = 1.5 * (double)answers->count + 1}, /* space for the legend */
       .y = {.label = "error / tolerance", .min = -reach, .max = reach},
       .series_count = count,
       .series = groups},
  };
  const bool both = c.levels > 1;
  abbe_result result = abbe_chart_write(path, both ? charts : charts + 1, both ? 2 : 1, 960,
                                        both ? 900 : 480, error);
  free(c.x);
  return result;
}
