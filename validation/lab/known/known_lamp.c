/* Lights with a size, straight and off mirrors: form factors, penumbras, images through holes. */
#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include "base/number.h"

#include <math.h>

typedef struct work {
  double from, to; /* range of the group */
} work;

static const char reason[] = "as improbable as four standard errors, taken from the spread of the "
                             "passes; and 1e-3 of the value for what the picture is wide";

static abbe_result add_text(abbe_known_run *run, abbe_known_setting s, const char *text, work w,
                            abbe_error *error) {
  ABBE_OWNED(abbe_scene, scene) = {0};
  s.unit = "W/(m2 sr)";
  s.reason = reason;
  s.side = s.side > 0 ? s.side : 16;
  s.slack = 1e-3 * fabs(s.exact);
  s.useful = 3e-2 * fabs(s.exact);
  ABBE_TRY(abbe_known_scene(&scene, error, "%s", text));
  return abbe_known_add_setting(run, &s, &scene, w.from, w.to, error);
}

/* ---- form factors ---- */

/* A white floor at the origin, a fifth of a millimetre wide. */
#define SMALL_VIEW "camera: {eye: [0.05, 0, 0.1], target: [0, 0, 0], fov: 0.1}\n"
#define WHITE_FLOOR                                                                                \
  "objects:\n- {name: floor, shape: rectangle, width: 9, height: 9, reflectance: 1}\n"

static const double origin[3] = {0, 0, 0}, up[3] = {0, 0, 1};

static abbe_result add_disk(abbe_known_run *run, work w, abbe_error *error) {
  return add_text(run,
                  (abbe_known_setting){.what = "white floor under a coaxial disk light, radiance",
                                       .exact = 5 * abbe_closed_form_coaxial_disks(0, 0.3, 0.4),
                                       .samples = 1 << 16,
                                       .channel = "Y"},
                  SMALL_VIEW "lights: [{name: lamp, kind: disk, position: [0, 0, 0.4], direction: "
                             "[0, 0, -1], radius: 0.3, radiance: 5}]\n" WHITE_FLOOR,
                  w, error);
}

static abbe_result add_rectangle(abbe_known_run *run, work w, abbe_error *error) {
  /* 0.3 along x, 0.2 along y, off the axis */
  static const double corner[4][3] = {
      {0.05, -0.1, 0.4}, {0.35, -0.1, 0.4}, {0.35, 0.1, 0.4}, {0.05, 0.1, 0.4}};
  return add_text(run,
                  (abbe_known_setting){.what = "white floor beside a rectangle light, radiance",
                                       .exact = 5 * abbe_closed_form_polygon(corner, 4, origin, up),
                                       .samples = 1 << 16,
                                       .channel = "Y"},
                  SMALL_VIEW
                  "lights: [{name: lamp, kind: rectangle, position: [0.2, 0, 0.4], direction: "
                  "[0, 0, -1], width: 0.3, height: 0.2, radiance: 5}]\n" WHITE_FLOOR,
                  w, error);
}

/* In uniform light a patch under a mirror gets what the mirror's form factor says, less what the
 * patch keeps from it: its own image, twice as far. */
#define UNDER_A_MIRROR                                                                             \
  "camera: {eye: [0, 0, 0.19], target: [0, 0, 0], up: [0, 1, 0], fov: 90}\n"                       \
  "environment: {size: 64, uniform: 2}\nobjects:\n"

static const double seen = 4 * 0.19 * 0.19; /* m2 of the patch's plane */

static abbe_result add_mirror_disk(abbe_known_run *run, work w, abbe_error *error) {
  const double patch = 0.15, mirror = 0.2, h = 0.2;
  const double factor = abbe_closed_form_coaxial_disks(patch, mirror, h) -
                        abbe_closed_form_coaxial_disks(patch, patch, 2 * h);
  return add_text(
      run,
      (abbe_known_setting){.what = "white disk under a coaxial mirror disk of 0.7, mean radiance",
                           .exact = 0.7 * 2 * factor * ABBE_PI * patch * patch / seen,
                           .samples = 1 << 21,
                           .channel = "caustic.Y"},
      UNDER_A_MIRROR
      "- {name: patch, shape: lathe, around: 1024, profile: [[0, 0], [0.15, 0]], reflectance: 1}\n"
      "- {name: disk, shape: lathe, around: 1024, profile: [[0, 0.2], [0.2, 0.2]], mirror: 0.7}\n",
      w, error);
}

static abbe_result add_mirror_square(abbe_known_run *run, work w, abbe_error *error) {
  enum { STEPS = 64 };
  double corner[2][4][3], factor = 0;
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 4; k++) {
      const double half = i == 0 ? 0.2 : 0.15, side_x = k == 1 || k == 2 ? 1 : -1;
      corner[i][k][0] = half * side_x;
      corner[i][k][1] = half * (k < 2 ? -1 : 1);
      corner[i][k][2] = i == 0 ? 0.2 : 0.4;
    }
  for (int i = 0; i < STEPS * STEPS; i++) {
    const double p[3] = {0.15 * ((2 * (i % STEPS) + 1.0) / STEPS - 1),
                         0.15 * ((2 * (i / STEPS) + 1.0) / STEPS - 1), 0};
    for (int k = 0; k < 2; k++)
      factor += (k == 0 ? 1 : -1) *
                abbe_closed_form_polygon((const double(*)[3])corner[k], 4, p, up) / (STEPS * STEPS);
  }
  return add_text(
      run,
      (abbe_known_setting){.what = "white square under a mirror square of 0.7, mean radiance",
                           .exact = 0.7 * 2 * factor * 0.3 * 0.3 / seen,
                           .samples = 1 << 21,
                           .channel = "caustic.Y"},
      UNDER_A_MIRROR "- {name: patch, shape: rectangle, width: 0.3, height: 0.3, reflectance: 1}\n"
                     "- {name: square, shape: rectangle, width: 0.4, height: 0.4, mirror: 0.7,\n"
                     "   transform: [{translate: [0, 0, 0.2]}]}\n",
      w, error);
}

/* ---- penumbras ---- */

/* The light is 1 m above an edge that is 1 m above the floor: its penumbra is as wide as the
 * light, from -1 to 1 of half of that. */
static abbe_result add_penumbra(abbe_known_run *run, bool disk, double at, work w,
                                abbe_error *error) {
  const double half = 0.02, open = disk ? ABBE_PI * half * half : 4 * half * half;
  const double share = disk ? abbe_closed_form_penumbra(at) : 0.5 * (1 + at);
  char text[1024], what[112];
  abbe_number_format(what, sizeof what,
                     "%s light, %g of half its penumbra from the middle, radiance",
                     disk ? "disk" : "rectangle", at);
  abbe_number_format(
      text, sizeof text,
      "camera: {eye: [%.17g, 0, 0.1], target: [%.17g, 0, 0], up: [0, 1, 0], fov: 0.1}\n"
      "lights: [{name: lamp, kind: %s, position: [0, 0, 2], direction: [0, 0, -1], radiance: "
      "1000}]\n" WHITE_FLOOR
      "- {name: jaw, shape: rectangle, width: 1, height: 1, reflectance: 0,\n"
      "   transform: [{translate: [-0.5, 0, 1]}]}\n",
      at * half, at * half, disk ? "disk, radius: 0.02" : "rectangle, width: 0.04, height: 0.04");
  return add_text(run,
                  (abbe_known_setting){.what = what,
                                       .exact = 1000 * open / (4 * ABBE_PI) * share,
                                       .samples = 1 << 16,
                                       .side = 64,
                                       .channel = "Y"},
                  text, w, error);
}

/* ---- images ---- */

/* A mirror shows the light as far behind it as it is before it. */
static abbe_result add_seen_in_mirror(abbe_known_run *run, work w, abbe_error *error) {
  const double away = hypot(0.6, 1.2), slant = 1.2 / away,
               film = pow(2 * tan(2.5 * ABBE_PI / 180), 2);
  return add_text(
      run,
      (abbe_known_setting){.what = "disk light seen in a mirror of 0.8, mean radiance",
                           .exact = 0.8 * 7 * ABBE_PI * 0.02 * 0.02 * slant / (away * away) / film,
                           .samples = 1 << 16,
                           .side = 64,
                           .channel = "Y"},
      "camera: {eye: [-0.3, 0, 0.7], target: [0.3, 0, -0.5], fov: 5}\n"
      "lights: [{name: lamp, kind: disk, position: [0.3, 0, 0.5], direction: [0, 0, -1], radius: "
      "0.02, radiance: 7}]\n"
      "objects:\n- {name: pane, shape: rectangle, width: 1, height: 1, mirror: 0.8}\n"
      "- {name: mote, shape: rectangle, width: 1.0e-6, height: 1.0e-6, reflectance: 1,\n"
      "   transform: [{translate: [9, 9, 9]}]}\n",
      w, error);
}

/* Square of the distance from the picture's middle. */
static double squared(double x, double y) {
  return x * x + y * y;
}

/* Through a hole of side s, by way of a mirror, the light throws its own image onto a wall as far
 * behind the hole as it is before it: flux L (pi r^2) s^2 / a^2, and a mean square of the distance
 * from the middle of r^2 / 2 for the disk and 2 (2 s)^2 / 12 for the hole. `spread`: the second
 * moment, by the picture's half side. */
static abbe_result add_pinhole(abbe_known_run *run, bool spread, work w, abbe_error *error) {
  const double r = 0.02, s = 0.006, a = 1, half = 0.03; /* m; the last of what the picture shows */
  const double flux = 0.8 * 1e4 * ABBE_PI * r * r * s * s / (a * a);
  const double square = r * r / 2 + 2 * pow(2 * s, 2) / 12;
  char text[2048];
  abbe_number_format(
      text, sizeof text,
      /* light from above falls through the hole at z = 0, off the mirror at z = -0.5, onto a wall
       */
      "camera: {eye: [0.2, 0, -0.5], target: [0.5, 0, -0.5], fov: %.17g}\n"
      "lights: [{name: lamp, kind: disk, position: [0, 0, 1], direction: [0, 0, -1], radius: %g, "
      "radiance: 1e4}]\n"
      "objects:\n"
      "- {name: wall, shape: rectangle, width: 1, height: 1, reflectance: 1, transform: [{rotate: "
      "{axis: [0, 1, 0], angle: 90}}, {translate: [0.5, 0, -0.5]}]}\n"
      "- {name: mirror, shape: rectangle, width: 0.06, height: 0.06, mirror: 0.8, transform: "
      "[{rotate: {axis: [0, 1, 0], angle: 45}}, {translate: [0, 0, -0.5]}]}\n"
      "- {name: west, shape: rectangle, width: 1, height: 2, reflectance: 0, transform: "
      "[{translate: [%g, 0, 0]}]}\n"
      "- {name: east, shape: rectangle, width: 1, height: 2, reflectance: 0, transform: "
      "[{translate: [%g, 0, 0]}]}\n"
      "- {name: south, shape: rectangle, width: 0.01, height: 1, reflectance: 0, transform: "
      "[{translate: [0, %g, 0]}]}\n"
      "- {name: north, shape: rectangle, width: 0.01, height: 1, reflectance: 0, transform: "
      "[{translate: [0, %g, 0]}]}\n",
      2 * atan(half / 0.3) * 180 / ABBE_PI, r, -0.5 - s / 2, 0.5 + s / 2, -0.5 - s / 2,
      0.5 + s / 2);
  const double mean = flux / ABBE_PI / (4 * half * half);
  return add_text(
      run,
      (abbe_known_setting){
          .what = spread ? "disk light's image through a hole and off a mirror, second moment"
                         : "disk light's image through a hole and off a mirror, mean radiance",
          .exact = spread ? mean * square / (half * half) : mean,
          .samples = 1 << 23,
          .side = 128,
          .channel = "caustic.Y",
          .weight = spread ? squared : NULL},
      text, w, error);
}

abbe_result abbe_known_lamp(abbe_known_run *run, abbe_error *error) {
  static const double at[] = {-0.7, -0.3, 0.3, 0.7};
  enum { FIRST = 4, PENUMBRAS = 8, RUNS = FIRST + PENUMBRAS + 3 };
  for (int i = 0; i < RUNS; i++) {
    const work w = {(double)i / RUNS, (i + 1.0) / RUNS};
    const int k = i - FIRST;
    ABBE_TRY(i == 0           ? add_disk(run, w, error)
             : i == 1         ? add_rectangle(run, w, error)
             : i == 2         ? add_mirror_disk(run, w, error)
             : i == 3         ? add_mirror_square(run, w, error)
             : k < PENUMBRAS  ? add_penumbra(run, k < 4, at[k % 4], w, error)
             : k == PENUMBRAS ? add_seen_in_mirror(run, w, error)
                              : add_pinhole(run, k == PENUMBRAS + 2, w, error));
  }
  return ABBE_OK;
}
