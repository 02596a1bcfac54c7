/* Derivatives of single rays through slabs, a prism and a ball and off mirrors, by numbers of the
 * scene, and of the light in outlines whose edges move. */
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"
#include "colorimetry/observer.h"
#include "spectral/dispersion/dispersion.h"
#include "validation/measure/derive/derivative.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define N_BK7 1.51680003 /* at d: where a ray is aimed, least deviation being flat there */

/* The light's direction, and in what is there, the key. */
#define HEAD                                                                                       \
  "camera: {eye: [0, -9, 9], target: [0, 0, -1]}\n"                                                \
  "lights: [{name: sun, kind: directional, direction: [%.17g, 0, %.17g], irradiance: 1,\n"         \
  "          illuminant: E}]\nobjects:\n"
#define FLOOR_AT(z)                                                                                \
  "- {name: floor, shape: rectangle, width: 40, height: 40, reflectance: 0.5,\n"                   \
  "   transform: [{translate: [0, 0, " z "]}]}\n"
#define FLOOR FLOOR_AT("-1")
#define WALL                                                                                       \
  "- {name: wall, shape: rectangle, width: 40, height: 40, reflectance: 0.5, transform:\n"         \
  "   [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [5, 0, 0]}]}\n"
#define SLAB(size, angle)                                                                          \
  "- {name: slab, shape: box, size: [0.5, 0.5, " size "], material: n-bk7,\n"                      \
  "   transform: [{rotate: {axis: [0, 1, 0], angle: " angle "}}]}\n"
#define PRISM(apex)                                                                                \
  "- {name: prism, shape: prism, apex: " apex ", side: 0.04, length: 0.06, material: n-bk7}\n"
#define BALL(radius) "- {name: ball, shape: sphere, radius: " radius ", material: n-bk7}\n"
#define MIRROR_BALL(radius)                                                                        \
  "- {name: ball, shape: sphere, radius: " radius ", mirror: 1}\n"                                 \
  "- {name: sky, shape: rectangle, width: 10, height: 10, reflectance: 0.5, transform:\n"          \
  "   [{translate: [-9, 0, 9]}]}\n"
#define FACET(angle)                                                                               \
  "- {name: facet, shape: rectangle, width: 0.1, height: 0.1, mirror: 1,\n"                        \
  "   transform: [{rotate: {axis: [0, 1, 0], angle: " angle "}}]}\n"                               \
  "- {name: sky, shape: rectangle, width: 2, height: 2, reflectance: 0.5, transform:\n"            \
  "   [{translate: [1.7, 0, 2]}]}\n"
#define CUP(radius)                                                                                \
  "- {name: cup, shape: lathe, around: 4096, profile: [[" radius ", -0.1], [" radius               \
  ", 0.1]], mirror: 1}\n"

#define MIRROR_AT(angle, width)                                                                    \
  "- {name: facet, shape: rectangle, width: " width ", height: 0.05, mirror: 1,\n"                 \
  "   transform: [{rotate: {axis: [0, 1, 0], angle: " angle "}}]}\n"
/* A pane and, below or above it, a receiver of 5 cm. */
#define PANE(width, z)                                                                             \
  "- {name: pane, shape: box, size: [0.1, 0.1, 0.01], material: n-bk7}\n"                          \
  "- {name: plate, shape: rectangle, width: " width ", height: 0.05, reflectance: 0.5,\n"          \
  "   transform: [{translate: [0, 0, " z "]}]}\n"

#define STRIP                                                                                      \
  "- {name: strip, shape: rectangle, width: %.17g, height: 20, reflectance: 0.5,\n"                \
  "   transform: [{translate: [0, 0, -0.1]}]}\n"

/* What a ray's answer is a function of, beside what it is derived by. */
typedef struct setting {
  double n, lambda_nm, n_d, v_d, thickness, incidence, apex, radius, height, absorption, area;
  double sun[2];
} setting;

/* A row: what is read of the brightest path, and the closed form of it as a function of the key. */
typedef struct ray_row {
  const char *quantity, *unit, *objects;
  double value; /* of the key in the text; of a material 0 */
  abbe_specular_shift shift, base;
  double off; /* where the ray is on the light's window, from its middle, of its width */
  double (*traced)(const abbe_specular_hit *hit, const setting *s);
  double (*exact)(double key, const setting *s);
  double share; /* of the exact value that it may be off */
} ray_row;

/* ---- what is read, and what is known ---- */

static double aside(const abbe_specular_hit *h, const setting *s) {
  (void)s;
  return hypot(h->p[0], h->p[1]);
}

static double flux_of(const abbe_specular_hit *h, const setting *s) {
  return h->flux / s->area;
}

static double turned(const abbe_specular_hit *h, const setting *s) {
  const double came[3] = {s->sun[0], 0, s->sun[1]};
  return abbe_known_angle(h->d, came);
}

/* Height below the middle at which it crosses the axis. */
static double crossing(const abbe_specular_hit *h, const setting *s) {
  (void)s;
  return -(h->p[2] - h->p[0] * h->d[2] / h->d[0]);
}

static double crossing_above(const abbe_specular_hit *h, const setting *s) {
  return -crossing(h, s);
}

static double along_x(const abbe_specular_hit *h, const setting *s) {
  (void)s;
  return fabs(h->p[0]);
}

/* In plan, light along x: where it crosses the diameter, from the axis. */
static double crossing_in_plan(const abbe_specular_hit *h, const setting *s) {
  (void)s;
  return h->p[0] - h->p[1] * h->d[0] / h->d[1];
}

static double shift_by_n(double n, const setting *s) {
  return abbe_closed_form_slab_shift(s->thickness, s->incidence, s->n + n);
}

static double shift_by_b(double b, const setting *s) {
  return shift_by_n(b * 1e6 / (s->lambda_nm * s->lambda_nm), s);
}

static double shift_by_v(double v, const setting *s) {
  return shift_by_n((s->n - s->n_d) * (s->v_d / (s->v_d + v) - 1), s);
}

static double shift_by_thickness(double thickness, const setting *s) {
  return abbe_closed_form_slab_shift(thickness, s->incidence, s->n);
}

static double shift_by_angle(double degrees, const setting *s) {
  return abbe_closed_form_slab_shift(s->thickness, degrees * ABBE_DEGREE, s->n);
}

static double passed_by(double n, double thickness, double absorption, const setting *s) {
  const double r = abbe_closed_form_fresnel(s->incidence, n);
  const double sine = sin(s->incidence) / n;
  return (1 - r) * (1 - r) * exp(-absorption * thickness / sqrt(1 - sine * sine));
}

static double passed_by_n(double n, const setting *s) {
  return passed_by(s->n + n, s->thickness, s->absorption, s);
}

static double passed_by_absorption(double more, const setting *s) {
  return passed_by(s->n, s->thickness, s->absorption + more, s);
}

static double passed_by_thickness(double thickness, const setting *s) {
  return passed_by(s->n, thickness, s->absorption, s);
}

static double least_by_n(double n, const setting *s) {
  double deviation = NAN;
  abbe_closed_form_prism_least(s->apex, s->n + n, &deviation);
  return deviation;
}

static double least_by_apex(double degrees, const setting *s) {
  double deviation = NAN;
  abbe_closed_form_prism_least(degrees * ABBE_DEGREE, s->n, &deviation);
  return deviation;
}

static double focus_by_n(double n, const setting *s) {
  return abbe_closed_form_ball_crossing(s->radius, s->n + n, s->height);
}

static double focus_by_radius(double radius, const setting *s) {
  return abbe_closed_form_ball_crossing(radius, s->n, s->height);
}

/* A ray that a circle reflects is as far from its middle along the axis as from where it met it. */
static double mirror_focus(double radius, const setting *s) {
  return radius / (2 * sqrt(1 - s->height * s->height / (radius * radius)));
}

static double image_by_tilt(double degrees, const setting *s) {
  (void)s;
  return 2 * tan(2 * degrees * ABBE_DEGREE);
}

/* ---- rays ---- */

#define CLEAR                                                                                      \
  { 0 }
#define BY_N                                                                                       \
  { .material = "n-bk7", .n = 1e-5 }
#define BY_B                                                                                       \
  { .material = "n-bk7", .b_um2 = 1e-5 }
#define BY_V                                                                                       \
  { .material = "n-bk7", .v = 0.01 }
#define BY_ABSORPTION                                                                              \
  { .material = "n-bk7", .absorption = 1e-3 }
#define SMOKY                                                                                      \
  { .material = "n-bk7", .absorption = 20 }
static const ray_row rays[] = {
    {"a slab's shift by its index", "m", HEAD FLOOR SLAB("0.03", "40"), 0, BY_N, CLEAR, 0, aside,
     shift_by_n, 1e-6},
    {"a slab's shift by Cauchy's B", "m/um2", HEAD FLOOR SLAB("0.03", "40"), 0, BY_B, CLEAR, 0,
     aside, shift_by_b, 1e-6},
    {"a slab's shift by its Abbe number", "m", HEAD FLOOR SLAB("0.03", "40"), 0, BY_V, CLEAR, 0,
     aside, shift_by_v, 1e-5},
    {"a slab's shift by its thickness", "m/m", HEAD FLOOR SLAB("%.17g", "40"), 0.03, CLEAR, CLEAR,
     0, aside, shift_by_thickness, 1e-6},
    {"a slab's shift by its tilt", "m/degree", HEAD FLOOR SLAB("0.03", "%.17g"), 40, CLEAR, CLEAR,
     0, aside, shift_by_angle, 1e-6},
    {"what a tilted slab passes by its index", "1", HEAD FLOOR SLAB("0.03", "40"), 0, BY_N, CLEAR,
     0, flux_of, passed_by_n, 1e-6},
    {"what it passes by its absorption", "m", HEAD FLOOR SLAB("0.03", "40"), 0, BY_ABSORPTION,
     SMOKY, 0, flux_of, passed_by_absorption, 1e-6},
    {"what it passes by its thickness", "1/m", HEAD FLOOR SLAB("%.17g", "40"), 0.03, SMOKY, SMOKY,
     0, flux_of, passed_by_thickness, 1e-6},
    {"a prism's least deviation by its index", "rad", HEAD WALL PRISM("60"), 0, BY_N, CLEAR, 0,
     turned, least_by_n, 1e-6},
    {"a prism's least deviation by its apex", "rad/degree", HEAD WALL PRISM("%.17g"), 60, CLEAR,
     CLEAR, 0, turned, least_by_apex, 1e-6},
    {"where a ball brings a ray to its axis, by its index", "m", HEAD FLOOR BALL("0.05"), 0, BY_N,
     CLEAR, 0.1, crossing, focus_by_n, 1e-6},
    {"the same by its radius", "m/m", HEAD FLOOR BALL("%.17g"), 0.05, CLEAR, CLEAR, 0.1, crossing,
     focus_by_radius, 1e-6},
    {"a mirror ball's focus by its radius", "m/m", HEAD FLOOR MIRROR_BALL("%.17g"), 0.05, CLEAR,
     CLEAR, 0.1, crossing_above, mirror_focus, 1e-6},
    {"a facet's image by its tilt", "m/degree", HEAD FLOOR FACET("%.17g"), 20, CLEAR, CLEAR, 0,
     along_x, image_by_tilt, 1e-6},
    {"where a cup's wall brings a ray to its diameter, by its radius", "m/m",
     HEAD FLOOR CUP("%.17g"), 0.5, CLEAR, CLEAR, 0.05, crossing_in_plan, mirror_focus, 1e-3},
};
enum { RAYS = sizeof rays / sizeof *rays };

static void aim(const ray_row *row, setting *s) {
  double deviation;
  s->sun[0] = 0;
  s->sun[1] = -1;
  if (row->traced == turned) {
    abbe_closed_form_prism_least(s->apex, N_BK7, &deviation);
    s->sun[0] = cos(deviation / 2);
    s->sun[1] = sin(deviation / 2);
  } else if (row->traced == crossing_in_plan) {
    s->sun[0] = cos(20 * ABBE_DEGREE);
    s->sun[1] = -sin(20 * ABBE_DEGREE);
  }
}

/* The brightest path of the ray, in a scene in which the key is `key`. */
static abbe_result follow(const ray_row *row, const setting *s, double key,
                          const abbe_specular_shift *shift, const abbe_specular *base,
                          abbe_scene *scene, abbe_specular *out, abbe_specular_hit *hit,
                          abbe_error *error) {
  abbe_specular_wave wave;
  ABBE_FREED abbe_specular_tree *tree = malloc(sizeof *tree);
  if (tree == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a ray");
  ABBE_TRY(abbe_known_scene(scene, error, row->objects, s->sun[0], s->sun[1], key, key));
  ABBE_TRY(abbe_specular_make(scene, 0, shift, out, error));
  if (base != NULL) ABBE_TRY(abbe_specular_match(out, base, row->quantity, error));
  ABBE_TRY(abbe_specular_wave_make(out, s->lambda_nm, &wave, error));
  const double up = row->traced == crossing_in_plan ? 0.15 : 0; /* m: over the near wall */
  const double at[4] = {0.5 + row->off, 0.5 + up / (2 * out->radius), 0.5, 0.5};
  abbe_specular_trace(out, &wave, at, 3, NULL, tree);
  *hit = (abbe_specular_hit){.p = {NAN, NAN, NAN}};
  for (size_t i = 0; i < tree->count; i++)
    if (tree->hit[i].flux > hit->flux) *hit = tree->hit[i];
  return ABBE_OK;
}

static abbe_result add_ray(abbe_known_run *run, const ray_row *row, abbe_error *error) {
  setting s = {.lambda_nm = ABBE_LINE_F_NM,
               .thickness = 0.03,
               .incidence = 40 * ABBE_DEGREE,
               .apex = 60 * ABBE_DEGREE,
               .radius = row->value > 0 ? row->value : 0.05,
               .absorption = row->base.absorption};
  if (row->traced == turned) s.lambda_nm = ABBE_LINE_D_NM;
  abbe_scene scene[3] = {{0}};
  abbe_specular specular[3] = {{0}};
  abbe_specular_hit hit[3];
  const double step = row->value != 0
                          ? 1e-5 * row->value
                          : row->shift.n + row->shift.b_um2 + row->shift.v + row->shift.absorption;
  aim(row, &s);
  abbe_result result =
      follow(row, &s, row->value, &row->base, NULL, &scene[2], &specular[2], &hit[2], error);
  for (int i = 0; i < 2 && result == ABBE_OK; i++) {
    const double by = i == 0 ? -1 : 1;
    abbe_specular_shift shift = row->base;
    shift.material = row->shift.material;
    if (row->value == 0) {
      shift.n += by * row->shift.n;
      shift.b_um2 += by * row->shift.b_um2;
      shift.v += by * row->shift.v;
      shift.absorption += by * row->shift.absorption;
    }
    const double key = row->value != 0 ? row->value + by * step : 0;
    result = follow(row, &s, key, &shift, &specular[2], &scene[i], &specular[i], &hit[i], error);
  }
  if (result == ABBE_OK) {
    const double window = 2 * specular[2].radius;
    s.area = window * window;
    s.height = row->off * window;
    for (size_t i = 0; i < scene[2].object_count; i++) {
      const abbe_material *m = scene[2].object[i].material;
      if (m == NULL) continue;
      const abbe_dispersion_numbers numbers = abbe_dispersion_describe(&m->dispersion);
      s.n = abbe_dispersion_n(&m->dispersion, s.lambda_nm);
      s.n_d = numbers.n_d;
      s.v_d = numbers.v_d;
    }
    abbe_known_answer answer = {.unit = row->unit,
                                .reason = "differences over 1e-5 of a key: their square, and the "
                                          "rounding of doubles over them"};
    abbe_number_format(answer.quantity, sizeof answer.quantity, "%s", row->quantity);
    answer.exact =
        (row->exact(row->value + step, &s) - row->exact(row->value - step, &s)) / (2 * step);
    answer.traced = (row->traced(&hit[1], &s) - row->traced(&hit[0], &s)) / (2 * step);
    answer.tolerance = row->share * fabs(answer.exact);
    if (row->share > 1e-4)
      answer.reason = "1e-3 of it: the cup's wall has 4096 flat faces with rounded normals";
    result = abbe_known_add(run, answer, error);
  }
  for (int i = 0; i < 3; i++) {
    abbe_specular_free(&specular[i]);
    abbe_scene_free(&scene[i]);
  }
  return result;
}

/* ---- outlines ---- */

/* A row: a number of all that lands. The first object is of the glass. */
typedef struct edge_row {
  const char *quantity, *unit, *objects;
  double value; /* of the key in the text; 0: the glass's B */
  abbe_derivative_number number;
  double (*exact)(const abbe_material *glass);
} edge_row;

/* A number of light of an equal-energy spectrum that passed both faces of a pane, by a B more. */
static double passed_of(const abbe_material *glass, double b_um2, abbe_derivative_number number) {
  double sum[3] = {0}, y = 0;
  for (int nm = 380; nm <= 780; nm++) {
    double xyz[3];
    const double um = nm / 1000.0, share = nm == 380 || nm == 780 ? 0.5 : 1;
    const double n = abbe_dispersion_n(&glass->dispersion, nm) + b_um2 / (um * um);
    const double passed = 1 - abbe_closed_form_fresnel(0, n);
    abbe_observer_xyz(nm, xyz);
    for (int c = 0; c < 3; c++) sum[c] += share * xyz[c] * passed * passed;
    y += share * xyz[1];
  }
  if (number == ABBE_DERIVATIVE_FLUX) return sum[1] / y;
  return sum[number - ABBE_DERIVATIVE_CHROMA_X] / (sum[0] + sum[1] + sum[2]);
}

static double passed_slope(const abbe_material *glass, abbe_derivative_number number) {
  return (passed_of(glass, 1e-4, number) - passed_of(glass, -1e-4, number)) / 2e-4;
}

static double facet_by_width(const abbe_material *glass) {
  (void)glass;
  return 0.05 * cos(45 * ABBE_DEGREE);
}

static double steep_by_floor(const abbe_material *glass) {
  (void)glass;
  return -0.05 / tan(60 * ABBE_DEGREE);
}

static double plate_by_width(const abbe_material *glass) {
  return 0.05 * passed_of(glass, 0, ABBE_DERIVATIVE_FLUX);
}

static double shadow_by_width(const abbe_material *glass) {
  return -plate_by_width(glass);
}

/* How much of light from above through a ball, or off it, falls onto a plate of a width below it: a
 * ray that is turned passes the ball's middle at the distance at which it came. */
static double below_ball(double n, double width) {
  enum { STEPS = 100000 };
  const double below = 0.1, half = 0.5 * width, reach = 10; /* m: the plate's, to both sides */
  double sum = 0;
  for (int k = 0; k < 2 * STEPS; k++) {
    const double cosine = (k / 2 + 0.5) / STEPS, i = acos(cosine), sine = sin(i);
    const double off = abbe_closed_form_fresnel(i, n);
    const double turn = k % 2 ? 2 * i - ABBE_PI : 2 * (i - asin(sine / n));
    if (!(cos(turn) > 0)) continue;
    const double from = 0.05 * sine;
    const double at = fabs((from - below * sin(turn)) / cos(turn));
    if (at > reach) continue;
    const double share = at > half ? asin(half / at) / (0.5 * ABBE_PI) : 1;
    sum += cosine / STEPS * share * (k % 2 ? off : (1 - off) * (1 - off));
  }
  return 2 * ABBE_PI * 0.05 * 0.05 * sum;
}

static double below_ball_by_width(const abbe_material *glass) {
  double sum = 0, y = 0;
  for (int nm = 380; nm <= 780; nm += 10) {
    double xyz[3];
    const double n = abbe_dispersion_n(&glass->dispersion, nm);
    abbe_observer_xyz(nm, xyz);
    y += xyz[1];
    sum += xyz[1] * (below_ball(n, 0.06 + 1e-4) - below_ball(n, 0.06 - 1e-4)) / 2e-4;
  }
  return sum / y;
}

static double passed_by_b(const abbe_material *glass) {
  return 0.05 * 0.05 * passed_slope(glass, ABBE_DERIVATIVE_FLUX);
}

static double x_by_b(const abbe_material *glass) {
  return passed_slope(glass, ABBE_DERIVATIVE_CHROMA_X);
}

static double y_by_b(const abbe_material *glass) {
  return passed_slope(glass, ABBE_DERIVATIVE_CHROMA_Y);
}

static const edge_row edges[] = {
    {"light off a mirror at 45 degrees by its width", "W/m", HEAD WALL MIRROR_AT("45", "%.17g"),
     0.05, ABBE_DERIVATIVE_FLUX, facet_by_width},
    {"light off a mirror that stands in a floor by the floor's height", "W/m",
     HEAD FLOOR_AT("%.17g") MIRROR_AT("60", "4"), -1, ABBE_DERIVATIVE_FLUX, steep_by_floor},
    {"light on a plate behind a pane by the plate's width", "W/m", HEAD PANE("%.17g", "-0.1"), 0.05,
     ABBE_DERIVATIVE_FLUX, plate_by_width},
    {"light through a pane by the width of a plate before it", "W/m",
     HEAD PANE("%.17g", "0.1") FLOOR, 0.05, ABBE_DERIVATIVE_FLUX, shadow_by_width},
    {"light below a ball by the width of a plate there", "W/m", HEAD BALL("0.05") STRIP, 0.06,
     ABBE_DERIVATIVE_FLUX, below_ball_by_width},
    {"Y of light through a pane by Cauchy's B", "W/um2", HEAD PANE("0.05", "-0.1"), 0,
     ABBE_DERIVATIVE_FLUX, passed_by_b},
    {"its chromaticity x by B", "1/um2", HEAD PANE("0.05", "-0.1"), 0, ABBE_DERIVATIVE_CHROMA_X,
     x_by_b},
    {"its chromaticity y by B", "1/um2", HEAD PANE("0.05", "-0.1"), 0, ABBE_DERIVATIVE_CHROMA_Y,
     y_by_b},
};
enum { EDGES = sizeof edges / sizeof *edges, INTERFACES = 3 };

/* The scene as it is, with the key less, and with it more. */
static abbe_result move_edge(const edge_row *row, double step, abbe_scene scene[3],
                             abbe_specular specular[3], abbe_error *error) {
  for (int i = 0; i < 3; i++) {
    const double by = i == 0 ? 0 : i == 1 ? -step : step;
    const abbe_specular_shift shift = {.material = "n-bk7", .b_um2 = row->value == 0 ? by : 0};
    ABBE_TRY(abbe_known_scene(&scene[i], error, row->objects, 0.0, -1.0, row->value + by));
    ABBE_TRY(abbe_specular_make(&scene[i], 0, &shift, &specular[i], error));
    ABBE_TRY(i == 0 ? abbe_specular_narrow(&specular[0], 380, 780, INTERFACES, error)
                    : abbe_specular_match(&specular[i], &specular[0], row->quantity, error));
  }
  return ABBE_OK;
}

static abbe_result add_edge(abbe_known_run *run, const edge_row *row, abbe_error *error) {
  const double step = 1e-6;
  abbe_scene scene[3] = {{0}};
  abbe_specular specular[3] = {{0}};
  abbe_spectral_sampling sampling = {0};
  abbe_derivative d = {0};
  const abbe_spectral_sampling_desc spectrum = {.min_nm = 380, .max_nm = 780, .uniform = 0.1};
  abbe_result result = move_edge(row, step, scene, specular, error);
  if (result == ABBE_OK) result = abbe_spectral_sampling_make(scene, &spectrum, &sampling, error);
  const abbe_derivative_key key = {
      .name = row->quantity, .step = step, .moved = {specular[1], specular[2]}};
  const abbe_derivative_desc desc = {.base = &specular[0],
                                     .keys = 1,
                                     .key = &key,
                                     .sampling = &sampling,
                                     .lines = 2048,
                                     .points = 32,
                                     .interfaces = INTERFACES,
                                     .seed = (uint32_t)run->options->seed,
                                     .threads = run->options->threads};
  if (result == ABBE_OK) result = abbe_derivative_make(&desc, &d, error);
  if (result == ABBE_OK) {
    abbe_known_answer answer = {.unit = row->unit,
                                .reason = "four standard errors, and 1e-5 of it for differences "
                                          "over a step"};
    abbe_number_format(answer.quantity, sizeof answer.quantity, "%s", row->quantity);
    answer.exact = row->exact(scene[0].object[0].material);
    answer.traced = abbe_derivative_number_of(&d, row->number, 1, &answer.standard_error);
    answer.tolerance = ABBE_KNOWN_SIGMAS * answer.standard_error + 1e-5 * fabs(answer.exact);
    answer.useful = 0.05 * fabs(answer.exact);
    result = abbe_known_add(run, answer, error);
  }
  abbe_derivative_free(&d);
  abbe_spectral_sampling_free(&sampling);
  for (int i = 0; i < 3; i++) {
    abbe_specular_free(&specular[i]);
    abbe_scene_free(&scene[i]);
  }
  return result;
}

abbe_result abbe_known_derive(abbe_known_run *run, abbe_error *error) {
  for (int i = 0; i < RAYS; i++) ABBE_TRY(add_ray(run, &rays[i], error));
  for (int i = 0; i < EDGES; i++) ABBE_TRY(add_edge(run, &edges[i], error));
  return abbe_known_pixels(run, error);
}
