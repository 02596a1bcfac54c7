/* What glows: its photons by those that it takes, slabs that absorb none and some of their own glow
 * from both sides, cubes, and a ball in light from all around. All have the index of the air. */
#include "base/number.h"
#include "colorimetry/observer.h"
#include "validation/lab/known/known_light.h"

#include <math.h>

static const double lit_nm = 450, excited_nm = 500, from_nm = 600, to_nm = 620, yield = 0.8;
static const double first_nm = 440, last_nm = 640; /* the range */

static const char reason[] = "as improbable as four standard errors, taken from the spread of the "
                             "passes; and 3e-3 of the value, for the steps of wavelengths";

/* A record that is excited alike at all wavelengths below its emission, a triangle. */
typedef struct glowing {
  abbe_material material;
  double excitation, absorption; /* 1/m; the latter of its own glow */
  bool matrix;
} glowing;

/* A matrix of two rows, each with a triangle of its own. */
static const struct { double nm, from_nm, yield; } rows[2] = {{420, 600, 0.4}, {480, 615, 0.9}};

static double row_yield(int i, double nm) {
  return rows[i].yield * (1 - fabs(nm - rows[i].nm) / (rows[1].nm - rows[0].nm));
}

static abbe_result add_rows(abbe_fluorescence *f, abbe_error *error) {
  for (int i = 0; i < 2; i++) {
    const double half = (to_nm - from_nm) / 2,
                 nm[3] = {rows[i].from_nm, rows[i].from_nm + half, rows[i].from_nm + 2 * half},
                 photons[3] = {0, rows[i].yield / half, 0};
    abbe_spectrum *emission = NULL;
    ABBE_TRY(abbe_spectrum_make(nm, photons, 3, ABBE_INTERPOLATION_LINEAR, &emission, error));
    ABBE_TRY(abbe_fluorescence_add_row(f, rows[i].nm, emission, error));
  }
  return abbe_fluorescence_sum_rows(f, error);
}

static abbe_result make(glowing *g, double excitation, double absorption, bool matrix,
                        abbe_error *error) {
  const double nm[3] = {from_nm, (from_nm + to_nm) / 2, to_nm}, photons[3] = {0, 1, 0};
  const double below[2] = {400, excited_nm}, taken[2] = {excitation, excitation},
               above[4] = {400, 500, 599, 700},
               kept[4] = {matrix ? excitation : 0, matrix ? excitation : 0, absorption, absorption};
  static char name[] = "glowing";
  abbe_material *m = &g->material;
  *g = (glowing){.excitation = excitation, .absorption = absorption, .matrix = matrix};
  m->name = name;
  m->dispersion = (abbe_dispersion){.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1}};
  m->min_nm = 300;
  m->max_nm = 900;
  ABBE_TRY(abbe_spectrum_make(above, kept, 4, ABBE_INTERPOLATION_LINEAR, &m->attenuation, error));
  if (matrix) return add_rows(&m->fluorescence, error);
  m->fluorescence.yield = yield;
  ABBE_TRY(abbe_spectrum_make(below, taken, 2, ABBE_INTERPOLATION_LINEAR,
                              &m->fluorescence.excitation, error));
  return abbe_spectrum_make(nm, photons, 3, ABBE_INTERPOLATION_LINEAR, &m->fluorescence.emission,
                            error);
}

static void drop(glowing *g) {
  abbe_spectrum_free(g->material.attenuation);
  abbe_fluorescence_free(&g->material.fluorescence);
}

static double y_of(double nm) {
  double xyz[3];
  abbe_observer_xyz_of(ABBE_OBSERVER_CIE_1931, nm, xyz);
  return xyz[1];
}

/* Y of a triangle of so many photons, over their energies. */
static double triangle_y(double low_nm, double photons) {
  enum { PARTS = 2000 };
  double sum = 0;
  for (int i = 0; i < PARTS; i++) {
    const double share = (i + 0.5) / PARTS, nm = low_nm + share * (to_nm - from_nm);
    sum += (2 - fabs(4 * share - 2)) / PARTS * photons / nm * y_of(nm);
  }
  return sum;
}

/* Of even light of Y = 1 from 440 to 640 nm, in *passes the Y of what does not excite; returns the
 * Y of what all the rest makes glow. Of a line, with Y = 1: that of its glow. Energy goes by the
 * photon. */
static double seen(const glowing *g, bool line, double *passes) {
  enum { PARTS = 2000 };
  double glow = triangle_y(from_nm, yield), quanta = 0, all = 0, excites = 0;
  if (g->matrix) glow = 0;
  for (int i = 0; i < 2 && g->matrix; i++)
    glow += triangle_y(rows[i].from_nm, row_yield(i, lit_nm));
  for (int i = 0; i < PARTS; i++) {
    const double even_nm = first_nm + (i + 0.5) / PARTS * (last_nm - first_nm);
    quanta += even_nm < excited_nm ? even_nm : 0;
    excites += even_nm < excited_nm ? y_of(even_nm) : 0;
    all += y_of(even_nm);
  }
  *passes = line ? 0 : 1 - excites / all;
  return glow * (line ? lit_nm / y_of(lit_nm) : quanta / all);
}

static abbe_result add(abbe_known_run *run, abbe_known_setting row, const glowing *g,
                       abbe_result made, abbe_scene *scene, double from, abbe_error *error) {
  row.min_nm = first_nm;
  row.max_nm = last_nm;
  row.side = 8;
  if (made == ABBE_OK) scene->object[0].material = &g->material;
  if (made == ABBE_OK) made = abbe_known_add_setting(run, &row, scene, from, from + 0.15, error);
  abbe_scene_free(scene);
  return made;
}

/* ---- slabs ---- */

/* Light of 1 W/m2 comes down at that angle. What is seen straight on of a depth x comes through the
 * rest of the slab. */
static double slab_radiance(const glowing *g, double thickness, double angle, bool below) {
  enum { PARTS = 20000 };
  double sum = 0, passes;
  for (int i = 0; i < PARTS; i++) {
    const double depth = (i + 0.5) / PARTS * thickness, out = below ? thickness - depth : depth;
    sum += g->excitation * thickness / PARTS *
           exp(-g->excitation * depth / cos(angle) - g->absorption * out);
  }
  return sum * seen(g, true, &passes) / (4 * ABBE_PI);
}

static abbe_result add_slab(abbe_known_run *run, double excitation, double absorption, bool below,
                            bool matrix, double from, abbe_error *error) {
  const double thickness = 0.01, angle = 30 / ABBE_KNOWN_DEGREES;
  char what[112];
  abbe_scene scene = {0};
  glowing g = {0};
  abbe_known_setting row = {
      .what = what, .unit = "W/(m2 sr)", .reason = reason, .samples = 1 << 18, .channel = "Y"};
  abbe_result result = make(&g, excitation, absorption, matrix, error);
  row.exact = slab_radiance(&g, thickness, angle, below);
  row.slack = 3e-3 * row.exact;
  row.useful = 3e-2 * row.exact;
  abbe_number_format(what, sizeof what,
                     "a slab of depth %.3g that glows%s, and %.3g of its own glow, from %s",
                     excitation * thickness, matrix ? " by a matrix" : "", absorption * thickness,
                     below ? "behind" : "before");
  if (result == ABBE_OK)
    result = abbe_known_scene(
        &scene, error,
        "camera: {eye: [0, 0, %.17g], target: [0, 0, 0], up: [0, 1, 0], fov: 1}\n"
        "lights: [{name: sun, kind: directional, direction: [%.17g, 0, %.17g], irradiance: 1,\n"
        "          illuminant: 450nm}]\n"
        "objects:\n"
        "- {name: slab, shape: box, size: [0.05, 0.05, %.17g], material: n-bk7}\n"
        "- {name: far off, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0,\n"
        "   transform: [{translate: [0, 0, %.17g]}]}\n",
        below ? -1.0 : 1.0, sin(angle), -cos(angle), thickness, below ? 1.2 : -1.2);
  result = add(run, row, &g, result, &scene, from, error);
  drop(&g);
  return result;
}

/* A cube in light straight from above, whose face fills the picture: gathers of photons are cut by
 * its walls. */
static abbe_result add_cube(abbe_known_run *run, double excitation, double from,
                            abbe_error *error) {
  const double size = 0.04, away = 20, seen_half = 0.49 * size;
  char what[112];
  abbe_scene scene = {0};
  glowing g = {0};
  abbe_known_setting row = {
      .what = what, .unit = "W/(m2 sr)", .reason = reason, .samples = 1 << 18, .channel = "Y"};
  abbe_result result = make(&g, excitation, 0, false, error);
  row.exact = slab_radiance(&g, size, 0, false);
  row.slack = 3e-3 * row.exact;
  row.useful = 3e-2 * row.exact;
  abbe_number_format(what, sizeof what, "a cube of depth %.3g that glows, all of its face",
                     excitation * size);
  if (result == ABBE_OK)
    result = abbe_known_scene(
        &scene, error,
        "camera: {eye: [0, 0, %.17g], target: [0, 0, 0], up: [0, 1, 0], fov: %.17g}\n"
        "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1,\n"
        "          illuminant: 450nm}]\n"
        "objects:\n"
        "- {name: cube, shape: box, size: [%.17g, %.17g, %.17g], material: n-bk7}\n"
        "- {name: far off, shape: rectangle, width: 0.004, height: 0.004, reflectance: 0,\n"
        "   transform: [{translate: [0, 0, -1]}]}\n",
        away, 2 * atan(seen_half / (away - size / 2)) * ABBE_KNOWN_DEGREES, size, size, size);
  result = add(run, row, &g, result, &scene, from, error);
  drop(&g);
  return result;
}

/* ---- a ball ---- */

static const char ball_scene[] =
    "camera: {eye: [0, -1, 0], target: [0, 0, 0], fov: 0.2}\n"
    "environment: {uniform: 1, illuminant: E}\n"
    "objects: [{name: ball, shape: sphere, radius: 0.1, levels: 5, material: n-bk7}]\n";
/* Photons are followed where something shows them. */
static const char floor_scene[] =
    "camera: {eye: [0, -1, 0], target: [0, 0, 0], fov: 0.2}\n"
    "environment: {uniform: 1, illuminant: E}\n"
    "objects:\n"
    "- {name: ball, shape: sphere, radius: 0.1, levels: 5, material: n-bk7}\n"
    "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5,\n"
    "   transform: [{translate: [0, 0, -0.3]}]}\n";

/* Straight through the middle, in light of 1 W/(m2 sr) from all around: what is left of the light
 * behind, and what glows of all that comes to each place. */
static double ball_radiance(const glowing *g, double radius) {
  enum { PARTS = 400 };
  const double excitation = g->excitation;
  double sum = 0, passes;
  const double glow = seen(g, false, &passes);
  for (int i = 0; i < PARTS; i++) {
    const double off = radius * (2 * (i + 0.5) / PARTS - 1);
    double around = 0; /* mean over directions */
    for (int k = 0; k < PARTS; k++) {
      const double c = 2 * (k + 0.5) / PARTS - 1;
      const double way = sqrt(radius * radius - off * off * (1 - c * c)) - off * c;
      around += exp(-excitation * way) / PARTS;
    }
    sum += excitation * around * 2 * radius / PARTS;
  }
  return passes + (1 - passes) * exp(-2 * excitation * radius) + sum * glow;
}

/* Photons by photon over the range, all absorbed alike up to the matrix's last row. */
static double mean_yield(void) {
  enum { PARTS = 2000 };
  double photons = 0, all = 0;
  for (int i = 0; i < PARTS; i++) {
    const double nm = first_nm + (i + 0.5) / PARTS * (rows[1].nm - first_nm);
    photons += nm * (row_yield(0, nm) + row_yield(1, nm));
    all += nm;
  }
  return photons / all;
}

static abbe_result add_ball(abbe_known_run *run, double excitation, const char *channel,
                            bool matrix, double from, abbe_error *error) {
  char what[112];
  abbe_scene scene = {0};
  glowing g;
  abbe_result result = make(&g, excitation, 0, matrix, error);
  const bool light = channel[0] == 'Y';
  abbe_known_setting row = {.what = what,
                            .unit = light ? "W/(m2 sr)" : "share",
                            .reason = light || matrix ? reason : "single precision",
                            .exact = light               ? ball_radiance(&g, 0.1)
                                     : channel[0] == 'y' ? (matrix ? mean_yield() : yield)
                                                         : 1,
                            .samples = 1 << 17,
                            .slack = 1e-6,
                            .useful = 2e-6,
                            .channel = channel};
  if (light || matrix) row.slack = 3e-3 * row.exact;
  if (light || matrix) row.useful = 3e-2 * row.exact;
  abbe_number_format(what, sizeof what,
                     light ? "a ball of depth %.3g that glows, in light from all around"
                     : channel[0] == 'y'
                         ? "photons emitted in a ball of depth %.3g by those that it takes%s"
                         : "the ledger of a ball of depth %.3g: what left by what came and glowed",
                     0.2 * excitation, matrix ? ", by a matrix" : "");
  if (result == ABBE_OK)
    result = abbe_known_scene(&scene, error, "%s", light ? ball_scene : floor_scene);
  result = add(run, row, &g, result, &scene, from, error);
  drop(&g);
  return result;
}

abbe_result abbe_known_fluorescent(abbe_known_run *run, abbe_error *error) {
  ABBE_TRY(add_ball(run, 5, "yield", false, 0, error));
  ABBE_TRY(add_ball(run, 5, "yield", true, 0.1, error));
  ABBE_TRY(add_ball(run, 5, "closed", false, 0.2, error));
  ABBE_TRY(add_slab(run, 2, 0, false, false, 0.3, error));
  ABBE_TRY(add_slab(run, 2, 0, false, true, 0.4, error));
  ABBE_TRY(add_slab(run, 200, 150, false, false, 0.5, error));
  ABBE_TRY(add_slab(run, 200, 150, true, false, 0.6, error));
  ABBE_TRY(add_cube(run, 0.5, 0.67, error));
  ABBE_TRY(add_cube(run, 100, 0.74, error));
  ABBE_TRY(add_ball(run, 0.5, "Y", false, 0.79, error));
  return add_ball(run, 10, "Y", false, 0.85, error);
}
