/* Derivatives of a camera's pixels: lamps over a floor, outlines in front of a bright ground,
 * panes, a plate within glass, and edges that are seen through a slab and in a mirror. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "colorimetry/observer.h"
#include "spectral/dispersion/dispersion.h"
#include "validation/measure/derive/pixels.h"

#include <math.h>

#define LOOK(eye, fov) "camera: {eye: " eye ", target: [0, 0, 0], up: [0, 1, 0], fov: " fov "}\n"
/* Far from all, so that what is black and the background alone are seen. */
#define FAR                                                                                        \
  "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1, illuminant: "     \
  "E}]\n"                                                                                          \
  "background: 1\nobjects:\n"
#define LAMP(x, intensity)                                                                         \
  LOOK("[0, 0, 2]", "0.1")                                                                         \
  "lights: [{name: lamp, kind: point, position: [" x ", 0, 0.8], intensity: " intensity            \
  ", illuminant: E}]\nobjects:\n"                                                                  \
  "- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 0.5}\n"
#define BALL(radius) "- {name: ball, shape: sphere, radius: " radius ", reflectance: 0}\n"
#define DISC(width)                                                                                \
  "- {name: plate, shape: rectangle, width: " width ", height: 0.4, reflectance: 0}\n"
#define PANE(thickness)                                                                            \
  "- {name: pane, shape: box, size: [1, 1, " thickness "], material: n-bk7}\n"                     \
  "- {name: mote, shape: rectangle, width: 1e-6, height: 1e-6, reflectance: 0,\n"                  \
  "   transform: [{translate: [0, 0, -1]}]}\n" /* a scene has to have a receiver */
#define CORE(reflectance)                                                                          \
  LOOK("[0, 0, 2]", "0.1")                                                                         \
  "environment: {uniform: 1, illuminant: E}\nobjects:\n"                                           \
  "- {name: ball, shape: sphere, radius: 1, material: n-bk7}\n"                                    \
  "- {name: plate, shape: rectangle, width: 0.2, height: 0.2, reflectance: " reflectance "}\n"
#define SLAB(thickness, edge)                                                                      \
  "- {name: slab, shape: box, size: [0.5, 0.5, " thickness "], material: n-bk7,\n"                 \
  "   transform: [{rotate: {axis: [0, 1, 0], angle: 40}}]}\n"                                      \
  "- {name: edge, shape: rectangle, width: 1, height: 1, reflectance: 0,\n"                        \
  "   transform: [{translate: [" edge ", 0, -1]}]}\n"
#define MIRROR(tilt)                                                                               \
  "- {name: facet, shape: rectangle, width: 0.5, height: 0.5, mirror: 1,\n"                        \
  "   transform: [{rotate: {axis: [0, 1, 0], angle: " tilt "}}]}\n"                                \
  "- {name: edge, shape: rectangle, width: 1, height: 1, reflectance: 0, transform:\n"             \
  "   [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [1, 0, 0.5]}]}\n"

enum { SIDE = 8, INTERFACES = 16, STRAIGHT = 3 };

/* A row: the mean Y of the picture by a number in its text, or by one of the glass. */
typedef struct pixel_row {
  const char *quantity, *unit, *text;
  double value; /* of the key in the text; 0: of the glass */
  abbe_specular_shift base, shift;
  size_t interfaces;
  double (*exact)(double key, const abbe_material *glass);
  double share; /* of the exact value that it may be off beside its standard errors */
} pixel_row;

/* ---- what is known: the mean Y as a function of the key ---- */

static double lamp_by_power(double power, const abbe_material *glass) {
  (void)glass;
  return 0.5 / ABBE_PI * power * 0.8; /* at a distance of 1 */
}

static double lamp_by_place(double x, const abbe_material *glass) {
  (void)glass;
  return 0.5 / ABBE_PI * 0.8 / pow(x * x + 0.64, 1.5);
}

#define BALL_FOV 30

static double ball_by_radius(double radius, const abbe_material *glass) {
  (void)glass;
  const double half = tan(0.5 * BALL_FOV * ABBE_DEGREE);
  return 1 - ABBE_PI * radius * radius / (4 - radius * radius) / (4 * half * half);
}

static double plate_by_width(double width, const abbe_material *glass) {
  (void)glass;
  const double half = 2 * tan(0.5 * BALL_FOV * ABBE_DEGREE);
  return 1 - width * 0.4 / (4 * half * half);
}

/* Mean by Y over an equal-energy spectrum. */
static double mean_of(const abbe_material *glass, double more, double key,
                      double (*f)(double n, double key)) {
  double sum = 0, y = 0;
  for (int nm = 380; nm <= 780; nm++) {
    double xyz[3];
    abbe_observer_xyz(nm, xyz);
    const double share = xyz[1] * (nm == 380 || nm == 780 ? 0.5 : 1);
    sum += share * f(abbe_dispersion_n(&glass->dispersion, nm) + more, key);
    y += share;
  }
  return sum / y;
}

/* What a pane passes and reflects of light from both sides, with all inner reflections: absorption
 * over its thickness. */
static double of_pane(double n, double depth) {
  const double r = abbe_closed_form_fresnel(0, n), a = exp(-depth), t = (1 - r) * (1 - r);
  return (t * a + r * t * a * a) / (1 - r * r * a * a) + r;
}

static double pane_by_n(double n, const abbe_material *glass) {
  return mean_of(glass, n, 20 * 0.03, of_pane);
}

static double pane_by_absorption(double more, const abbe_material *glass) {
  return mean_of(glass, 0, (20 + more) * 0.03, of_pane);
}

static double pane_by_thickness(double thickness, const abbe_material *glass) {
  return mean_of(glass, 0, 20 * thickness, of_pane);
}

/* All light meets the ball head on, and what the ball reflects of the plate's light comes back to
 * the plate, which is not followed. */
static double of_core(double n, double reflectance) {
  return reflectance * pow(1 - abbe_closed_form_fresnel(0, n), 2);
}

static double core_by_reflectance(double reflectance, const abbe_material *glass) {
  return mean_of(glass, 0, reflectance, of_core);
}

#define SLAB_FOV 0.5
#define SLAB_ANGLE (40 * ABBE_DEGREE)

/* The bright share of the picture times what the slab passes there: the edge, 3 m away, is met as
 * far aside as the slab moves the ray, which is less for rays that meet it more steeply. */
static double of_slab(double n, double thickness) {
  const double r = abbe_closed_form_fresnel(SLAB_ANGLE, n);
  const double shift = abbe_closed_form_slab_shift(thickness, SLAB_ANGLE, n);
  const double by_angle =
      (abbe_closed_form_slab_shift(thickness, SLAB_ANGLE + 1e-5, n) - shift) / 1e-5;
  return (1 - r) * (1 - r) * shift / (2 * (3 - by_angle) * tan(0.5 * SLAB_FOV * ABBE_DEGREE));
}

static double slab_by_thickness(double thickness, const abbe_material *glass) {
  return mean_of(glass, 0, thickness, of_slab);
}

/* The mirror turns the ray by twice its tilt; the edge is 1 m beyond it and 3 m away. */
static double mirror_by_tilt(double degrees, const abbe_material *glass) {
  (void)glass;
  return tan(2 * (degrees - 45) * ABBE_DEGREE) / (2 * 3 * tan(0.5 * SLAB_FOV * ABBE_DEGREE));
}

/* ---- rows ---- */

#define GLASS(...)                                                                                 \
  { .material = "n-bk7", __VA_ARGS__ }
static const pixel_row rows[] = {
    {"a floor's pixels by a lamp's power",
     "1/(m2 sr)",
     LAMP("0.6", "%.17g"),
     2,
     {0},
     {0},
     3,
     lamp_by_power,
     1e-5},
    {"the same by the lamp's place",
     "W/(m3 sr)",
     LAMP("%.17g", "1"),
     0.6,
     {0},
     {0},
     3,
     lamp_by_place,
     1e-5},
    {"a ground's by the radius of a black ball before it",
     "W/(m3 sr)",
     LOOK("[0, 0, 2]", "30") FAR BALL("%.17g"),
     0.3,
     {0},
     {0},
     3,
     ball_by_radius,
     1e-5},
    {"a ground's by the width of a black plate",
     "W/(m3 sr)",
     LOOK("[0, 0, 2]", "30") FAR DISC("%.17g"),
     0.3,
     {0},
     {0},
     3,
     plate_by_width,
     1e-5},
    {"a smoky pane's before white by its index", "W/(m2 sr)",
     LOOK("[0, 0, 2]", "0.1") FAR PANE("0.03"), 0, GLASS(.absorption = 20), GLASS(.n = 1e-5),
     INTERFACES, pane_by_n, 1e-3},
    {"the same by its absorption", "W/(m sr)", LOOK("[0, 0, 2]", "0.1") FAR PANE("0.03"), 0,
     GLASS(.absorption = 20), GLASS(.absorption = 1e-3), INTERFACES, pane_by_absorption, 1e-4},
    {"the same by its thickness",
     "W/(m3 sr)",
     LOOK("[0, 0, 2]", "0.1") FAR PANE("%.17g"),
     0.03,
     GLASS(.absorption = 20),
     {0},
     INTERFACES,
     pane_by_thickness,
     1e-4},
    {"a plate's in the middle of a glass ball by its reflectance",
     "W/(m2 sr)",
     CORE("%.17g"),
     0.5,
     {0},
     {0},
     STRAIGHT,
     core_by_reflectance,
     1e-3},
    {"an edge's seen through a tilted slab by its thickness",
     "W/(m3 sr)",
     LOOK("[0, 0, 2]", "0.5") FAR SLAB("%.17g", "0.495"),
     0.03,
     {0},
     {0},
     STRAIGHT,
     slab_by_thickness,
     5e-3},
    {"an edge's seen in a facet by its tilt",
     "W/(m2 sr degree)",
     LOOK("[0, 0, 2]", "0.5") FAR MIRROR("%.17g"),
     45,
     {0},
     {0},
     STRAIGHT,
     mirror_by_tilt,
     5e-3},
};
enum { ROWS = sizeof rows / sizeof *rows };

static abbe_result add_row(abbe_known_run *run, const pixel_row *row, abbe_error *error) {
  const abbe_specular_shift *by = &row->shift;
  const double step = row->value != 0 ? 1e-5 * row->value : by->n + by->absorption;
  abbe_scene scene[3] = {{0}};
  abbe_spectral_sampling sampling = {0};
  abbe_pixels pixels = {0};
  abbe_pixels_key key = {.name = row->quantity, .step = step};
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 3 && result == ABBE_OK; i++)
    result = abbe_known_scene(&scene[i], error, row->text,
                              row->value + (row->value != 0 ? (i - 1) * step : 0));
  for (int s = 0; s < 2; s++) {
    const double side = row->value != 0 ? 0 : s == 0 ? -1 : 1;
    key.moved[s] = &scene[2 * s];
    key.shift[s] = row->base;
    key.shift[s].n += side * by->n;
    key.shift[s].absorption += side * by->absorption;
  }
  const abbe_spectral_sampling_desc spectrum = {.min_nm = 380, .max_nm = 780, .uniform = 0.1};
  if (result == ABBE_OK)
    result = abbe_spectral_sampling_make(&scene[1], &spectrum, &sampling, error);
  const abbe_pixels_desc desc = {.scene = &scene[1],
                                 .shift = row->base,
                                 .keys = 1,
                                 .key = &key,
                                 .sampling = &sampling,
                                 .space = ABBE_RGB_SPACE_XYZ,
                                 .width = SIDE,
                                 .height = SIDE,
                                 .samples = 256,
                                 .lines = 64,
                                 .points = 4,
                                 .map_side = 8,
                                 .interfaces = row->interfaces,
                                 .seed = (uint32_t)run->options->seed,
                                 .threads = run->options->threads};
  if (result == ABBE_OK) result = abbe_pixels_make(&desc, &pixels, error);
  if (result == ABBE_OK) {
    const abbe_material *glass = scene[1].object[0].material;
    double mean[3], deviation[3];
    abbe_pixels_mean(&pixels, 1, mean, deviation);
    abbe_known_answer answer = {.unit = row->unit,
                                .reason = row->share > 1e-3
                                              ? "four standard errors, and a share for the "
                                                "directions beside the axis"
                                              : "four standard errors, and 1e-4 of it for "
                                                "differences over a step and faint paths"};
    abbe_number_format(answer.quantity, sizeof answer.quantity, "%s", row->quantity);
    answer.exact =
        (row->exact(row->value + step, glass) - row->exact(row->value - step, glass)) / (2 * step);
    answer.traced = mean[1];
    answer.standard_error = deviation[1];
    answer.tolerance = ABBE_KNOWN_SIGMAS * deviation[1] + row->share * fabs(answer.exact);
    answer.useful = 0.05 * fabs(answer.exact);
    result = abbe_known_add(run, answer, error);
  }
  abbe_pixels_free(&pixels);
  abbe_spectral_sampling_free(&sampling);
  for (int i = 0; i < 3; i++) abbe_scene_free(&scene[i]);
  return result;
}

abbe_result abbe_known_pixels(abbe_known_run *run, abbe_error *error) {
  for (int i = 0; i < ROWS; i++) ABBE_TRY(add_row(run, &rows[i], error));
  return ABBE_OK;
}
