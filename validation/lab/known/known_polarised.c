/* Polarised light along paths from the camera: sheets, piles of plates, metals, tourmaline; and a
 * furnace. Panes in a beam are known_pane.c's. */
#include "base/maths.h"
#include "base/number.h"
#include "spectral/dispersion/dispersion.h"
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define FIRST 0.5 /* the panes' part of the work */
#define METAL "titanium"
#define METAL_NM 550.0

/* A panel of radiance 1 overhead, and behind it what the camera must have in view. */
#define PANEL                                                                                      \
  "lights: [{kind: rectangle, position: [0, 0, 9], direction: [0, 0, -1], width: 60, height: 60, " \
  "radiance: 1}]\n"                                                                                \
  "objects:\n- {name: lid, shape: rectangle, width: 60, height: 60, reflectance: 0,\n"             \
  "   transform: [{translate: [0, 0, 12]}]}\n"

static const char reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 2e-5 for "
    "sampling of the spectrum and the angles of a pixel";

/* Adds the mean radiance of the scene's picture at lambda_nm; or, not of "Y", a share of light. */
static abbe_result add(abbe_known_run *run, const char *what, double exact, double lambda_nm,
                       const char *channel, const char *text, abbe_error *error) {
  const bool seen = strcmp(channel, "Y") == 0;
  ABBE_OWNED(abbe_scene, scene) = {0};
  const abbe_known_setting setting = {.what = what,
                                      .unit = seen ? "W/(m2 sr)" : "share",
                                      .reason = reason,
                                      .exact = exact,
                                      .slack = 2e-5,
                                      .useful = fmax(0.02 * exact, 1e-3),
                                      .samples = 1 << 16,
                                      .lambda_nm = lambda_nm,
                                      .polarised = true,
                                      .side = seen ? 24 : 8,
                                      .channel = channel};
  ABBE_TRY(abbe_known_scene(&scene, error, "%s", text));
  return abbe_known_add_setting(run, &setting, &scene, FIRST, 1, error);
}

/* Malus: half of cos^2 of the angle between two sheets. */
static abbe_result add_sheets(abbe_known_run *run, double degrees, abbe_error *error) {
  char text[512], what[112];
  const double c = cos(degrees / ABBE_KNOWN_DEGREES);
  abbe_number_format(
      text, sizeof text,
      "camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 5, polariser: {angle: %g}}\n"
      "lights: [{kind: rectangle, position: [0, 0, 0], direction: [0, 0, 1], width: 1, height: 1,\n"
      "  radiance: 1, polariser: {angle: 25}}]\n"
      "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5,\n"
      "   transform: [{translate: [0, 0, -1]}]}\n",
      25 + degrees);
  abbe_number_format(what, sizeof what, "two polarisers at %g degrees", degrees);
  return add(run, what, c * c / 2, 0, "Y", text, error);
}

/* ---- a pile of plates at Brewster's angle ---- */

/* What plates one behind another pass of light of one polarisation. */
static double pile_passes(int plates, double r, double t) {
  double reflected = 0, passed = 1;
  for (int i = 0; i < plates; i++) {
    const double between = 1 - reflected * r;
    reflected = r + t * t * reflected / between;
    passed *= t / between;
  }
  return passed;
}

/* Seen from below, against a sky of 1; sheet: the field across the plane of incidence (0), in it
 * (1), or both (2). */
static abbe_result add_pile(abbe_known_run *run, int plates, int sheet, abbe_error *error) {
  static const char *const names[] = {"s", "p", "all"};
  char text[2048], what[112];
  abbe_scene scene = {0};
  double n = 0, exact = 0, r, t;
  abbe_result result =
      abbe_known_scene(&scene, error,
                       "camera: {eye: [0, 0, 9], target: [0, 0, 0], up: [0, 1, 0]}\n"
                       "environment: {uniform: 1}\nobjects:\n- {name: a, shape: sphere, radius: 1, "
                       "material: n-bk7}\n");
  if (result == ABBE_OK)
    result = abbe_material_n(scene.object[0].material, ABBE_LINE_D_NM, &n, error);
  abbe_scene_free(&scene);
  if (result != ABBE_OK) return result;
  const double angle = atan(n);
  int length = abbe_number_format(
      text, sizeof text, "camera: {eye: [%.17g, 0, %.17g], target: [0, 0, 0], fov: 0.1%s}\n" PANEL,
      -20 * sin(angle), -20 * cos(angle),
      sheet == 0   ? ", polariser: {angle: 0}"
      : sheet == 1 ? ", polariser: {angle: 90}"
                   : "");
  for (int i = 0; i < plates; i++)
    length +=
        abbe_number_format(text + length, sizeof text - (size_t)length,
                           "- {name: plate%d, shape: box, size: [40, 40, 0.01], material: n-bk7,\n"
                           "   transform: [{translate: [0, 0, %g]}]}\n",
                           i, 0.02 * i);
  for (int p = 0; p < 2; p++) {
    const abbe_closed_film bare = {1, n, 0, n, 0};
    double through;
    if (sheet == 1 - p) continue;
    abbe_closed_form_film(&bare, angle, p == 1, &r, &through);
    abbe_closed_form_slab(r, 1, &r, &t);
    exact += pile_passes(plates, r, t) / 2;
  }
  snprintf(what, sizeof what, "%d plate%s of n-bk7 at Brewster's angle pass, %s", plates,
           plates > 1 ? "s" : "", names[sheet]);
  return add(run, what, exact, ABBE_LINE_D_NM, "Y", text, error);
}

/* ---- tourmaline ---- */

#define STONE "tourmaline-green"
#define STONE_NM 640.0
#define STONE_THICK 0.003
#define MIRROR 0.02 /* m, near a plate, whose thickness a ray meets in single precision */

/* Shares of its two waves, ordinary first, that a plate reflects and passes head on, its axis in
 * its face. */
static abbe_result plate_of(const abbe_material *stone, double r[2], double t[2],
                            abbe_error *error) {
  for (int wave = 0; wave < 2; wave++) {
    double n;
    ABBE_TRY(abbe_material_n_along(stone, 2 * wave, STONE_NM, &n, error));
    const double face = pow((n - 1) / (n + 1), 2);
    const double per_m = abbe_material_attenuation_along(stone, 2 * wave, STONE_NM);
    abbe_closed_form_slab(face, exp(-per_m * STONE_THICK), &r[wave], &t[wave]);
  }
  return ABBE_OK;
}

/* Two plates, axes in their faces, straight on; nothing turns o into e. */
static abbe_result add_tourmaline(abbe_known_run *run, bool crossed, abbe_error *error) {
  char text[1024];
  abbe_number_format(
      text, sizeof text,
      "camera: {eye: [0, 0, -20], target: [0, 0, 0], up: [0, 1, 0], fov: 0.1}\n" PANEL
      "- {name: a, shape: box, size: [1, 1, %g], material: " STONE ", axis: [1, 0, 0]}\n"
      "- {name: b, shape: box, size: [1, 1, %g], material: " STONE ", axis: [%s],\n"
      "   transform: [{translate: [0, 0, 0.1]}]}\n",
      STONE_THICK, STONE_THICK, crossed ? "0, 1, 0" : "1, 0, 0");
  abbe_scene scene = {0};
  double r[2], t[2];
  abbe_result result = abbe_known_scene(&scene, error, "%s", text);
  if (result == ABBE_OK) result = plate_of(scene.object[1].material, r, t, error);
  abbe_scene_free(&scene);
  if (result != ABBE_OK) return result;
  double exact = 0;
  for (int wave = 0; wave < 2; wave++) {
    const int other = crossed ? 1 - wave : wave;
    exact += t[wave] * t[other] / (1 - r[wave] * r[other]) / 2;
  }
  return add(run,
             crossed ? "two plates of " STONE ", crossed" : "two plates of " STONE ", parallel",
             exact, STONE_NM, "Y", text, error);
}

/* ---- two metal mirrors ---- */

/* at: in widths. */
static int put_mirror(char *out, size_t size, int number, double wide, const double at[3],
                      const double n[3]) {
  return abbe_number_format(
      out, size,
      "- {name: mirror%d, shape: rectangle, width: %g, height: %g, mirror: " METAL ",\n"
      "   transform: [{rotate: {axis: [%.17g, %.17g, 0], angle: %.17g}}, {translate: [%.17g, "
      "%.17g, "
      "%.17g]}]}\n",
      number, wide, wide, -n[1], n[0], acos(n[2]) * ABBE_KNOWN_DEGREES, wide * at[0], wide * at[1],
      wide * at[2]);
}

/* At 45 degrees p reflects the square of s [BornWolf1999, 14.2]. Off both the camera sees light
 * that is the same from everywhere. */
static abbe_result add_mirrors(abbe_known_run *run, bool crossed, abbe_error *error) {
  const double c = sqrt(0.5), places[2][3] = {{0, 0, 0}, {0, 0, 4}};
  const double normals[2][3] = {{-c, 0, c}, {crossed ? 0 : c, crossed ? c : 0, -c}};
  char text[1024];
  int length =
      abbe_number_format(text, sizeof text,
                         "camera: {eye: [-4, 0, 0], target: [0, 0, 0], fov: 0.1}\n"
                         "background: 1\nlights: [{kind: point, position: [0, 90, 0], "
                         "intensity: 1.0e-12}]\nobjects:\n- {name: floor, shape: rectangle, "
                         "width: 1, height: 1, reflectance: 0,\n   transform: "
                         "[{translate: [0, 0, -60]}]}\n");
  for (int i = 0; i < 2; i++)
    length += put_mirror(text + length, sizeof text - (size_t)length, i, 1, places[i], normals[i]);
  abbe_scene scene = {0};
  double nk[2] = {0};
  abbe_result result = abbe_known_scene(&scene, error, "%s", text);
  if (result == ABBE_OK)
    result = abbe_material_nk(scene.object[1].conductor, METAL_NM, &nk[0], &nk[1], error);
  abbe_scene_free(&scene);
  if (result != ABBE_OK) return result;
  const double mean = abbe_closed_form_conductor(ABBE_PI / 4, nk[0], nk[1]);
  const double s = (sqrt(1 + 8 * mean) - 1) / 2;
  return add(run,
             crossed ? "two mirrors of " METAL " at 45 degrees, crossed"
                     : "two mirrors of " METAL " at 45 degrees, in one plane",
             crossed ? s * s * s : (s * s + s * s * s * s) / 2, METAL_NM, "Y", text, error);
}

/* The same mirrors between two plates of tourmaline with upright axes, a black wall behind the
 * camera. In one plane what is level stays so; crossed, the mirrors turn it upright, and each wave
 * of the one plate is the other of the other. */
static abbe_result add_turned(abbe_known_run *run, bool crossed, abbe_error *error) {
  const double c = sqrt(0.5), away = 2 * MIRROR, places[2][3] = {{0, 0, 0}, {0, 0, 4}};
  const double normals[2][3] = {{-c, 0, c}, {crossed ? 0 : c, crossed ? c : 0, -c}};
  char text[2048];
  int length = abbe_number_format(
      text, sizeof text,
      "camera: {eye: [%g, 0, 0], target: [0, 0, 0], fov: 0.1}\n"
      "background: 1\nlights: [{kind: point, position: [0, 9, 0], intensity: 1.0e-12}]\n"
      "objects:\n- {name: wall, shape: rectangle, width: %g, height: %g, reflectance: 0,\n"
      "   transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [%g, 0, 0]}]}\n",
      -2 * away, MIRROR, MIRROR, -4 * away);
  for (int i = 0; i < 2; i++)
    length +=
        put_mirror(text + length, sizeof text - (size_t)length, i, MIRROR, places[i], normals[i]);
  abbe_number_format(
      text + length, sizeof text - (size_t)length,
      "- {name: a, shape: box, size: [%g, %g, %g], material: " STONE ", axis: [0, 0, 1],\n"
      "   transform: [{translate: [%g, 0, 0]}]}\n"
      "- {name: b, shape: box, size: [%g, %g, %g], material: " STONE ", axis: [0, 0, 1],\n"
      "   transform: [{translate: [%g, %g, %g]}]}\n",
      STONE_THICK, MIRROR, MIRROR, -away, crossed ? MIRROR : STONE_THICK,
      crossed ? STONE_THICK : MIRROR, MIRROR, crossed ? 0.0 : away, crossed ? away : 0.0, 2 * away);
  abbe_scene scene = {0};
  double nk[2] = {0}, r[2], t[2], exact = 0;
  abbe_result result = abbe_known_scene(&scene, error, "%s", text);
  if (result == ABBE_OK)
    result = abbe_material_nk(scene.object[1].conductor, STONE_NM, &nk[0], &nk[1], error);
  if (result == ABBE_OK) result = plate_of(scene.object[3].material, r, t, error);
  abbe_scene_free(&scene);
  if (result != ABBE_OK) return result;
  const double s = (sqrt(1 + 8 * abbe_closed_form_conductor(ABBE_PI / 4, nk[0], nk[1])) - 1) / 2;
  for (int wave = 0; wave < 2; wave++) {
    const int other = crossed ? 1 - wave : wave; /* the ordinary wave is level, s of the first */
    const double mirrors = crossed ? s * s * s : wave == 0 ? s * s : s * s * s * s;
    exact += t[wave] * mirrors * t[other] / (1 - r[wave] * mirrors * r[other] * mirrors) / 2;
  }
  return add(run,
             crossed ? "two crossed mirrors of " METAL " between two plates of " STONE
                     : "two mirrors of " METAL " in one plane between two plates of " STONE,
             exact, STONE_NM, "Y", text, error);
}

/* What a metal face of normal n makes of the field of light along k, which becomes the mirrored
 * way: s is across both, p across s and the way. */
static void mirror_field(double complex metal, const double n[3], double k[3],
                         double complex field[3]) {
  double s[3], p[3], q[3], out[3];
  const double cosine = -abbe_vector_dot(k, n);
  for (int i = 0; i < 3; i++) out[i] = k[i] + 2 * cosine * n[i];
  abbe_vector_cross(k, n, s);
  const double length = abbe_vector_length(s);
  for (int i = 0; i < 3; i++) s[i] /= length;
  abbe_vector_cross(k, s, p);
  abbe_vector_cross(out, s, q);
  const double complex square = metal * metal, inner = csqrt(square - 1 + cosine * cosine);
  double complex of_s = (cosine - inner) / (cosine + inner);
  double complex of_p = (square * cosine - inner) / (square * cosine + inner);
  of_s *= field[0] * s[0] + field[1] * s[1] + field[2] * s[2];
  of_p *= field[0] * p[0] + field[1] * p[1] + field[2] * p[2];
  for (int i = 0; i < 3; i++) field[i] = of_s * s[i] + of_p * q[i];
  for (int i = 0; i < 3; i++) k[i] = out[i];
}

/* A lamp of right-handed light off two metal mirrors at 45 degrees, whose planes are turned against
 * each other by as much: what the camera sees of it, and what photons bring to where the camera
 * is. */
static abbe_result add_both_ways(abbe_known_run *run, bool photons, abbe_error *error) {
  const double c = sqrt(0.5), places[2][3] = {{0, 0, 0}, {0, 0, 4}};
  const double normals[2][3] = {{-c, 0, c}, {0.5, 0.5, -c}};
  const double lamp[3] = {4 * c, 4 * c, 4};
  char text[2048], light[256];
  abbe_number_format(light, sizeof light,
                     photons ? "kind: spot, target: [0, 0, 4], cone: 0.2, intensity: 1"
                             : "kind: rectangle, direction: [-1, -1, 0], width: 1, height: 1, "
                               "radiance: 1");
  int length = abbe_number_format(
      text, sizeof text,
      "camera: {eye: [-4, 0, 0], target: [0, 0, 0], fov: 0.1}\n"
      "lights: [{%s, position: [%.17g, %.17g, %g], polariser: {kind: right}}]\n"
      "objects:\n- {name: screen, shape: rectangle, width: 2, height: 2, reflectance: 0.5,\n"
      "   transform: [{rotate: {axis: [0, 1, 0], angle: 90}}, {translate: [-8, 0, 0]}]}\n",
      light, lamp[0], lamp[1], lamp[2]);
  for (int i = 0; i < 2; i++)
    length += put_mirror(text + length, sizeof text - (size_t)length, i, 1, places[i], normals[i]);
  /* behind the lamp: photons are followed where mirrors show the camera a receiver */
  snprintf(text + length, sizeof text - (size_t)length,
           "- {name: wall, shape: rectangle, width: 2, height: 2, reflectance: 0.5,\n"
           "   transform: [{rotate: {axis: [1, -1, 0], angle: 90}}, {translate: [6, 6, 4]}]}\n");
  abbe_scene scene = {0};
  double n = 0, k = 0, way[3] = {-c, -c, 0}, all = 0;
  abbe_result result = abbe_known_scene(&scene, error, "%s", text);
  if (result == ABBE_OK)
    result = abbe_material_nk(scene.object[1].conductor, METAL_NM, &n, &k, error);
  abbe_scene_free(&scene);
  if (result != ABBE_OK) return result;
  /* what is upright is -i of what is level, along x - y: so it turns as the lamp's sheet has it */
  double complex field[3] = {c * c, -c * c, -I * c};
  for (int i = 1; i >= 0; i--) mirror_field(n + I * k, normals[i], way, field);
  for (int i = 0; i < 3; i++) all += creal(field[i] * conj(field[i]));
  return add(run,
             photons ? "right-handed light off two mirrors of " METAL ", as photons bring it"
                     : "right-handed light off two mirrors of " METAL ", as the camera sees it",
             photons ? all : all / 2, METAL_NM, photons ? "deposited" : "Y", text, error);
}

/* ---- the furnace ---- */

static abbe_result add_furnace(abbe_known_run *run, const char *stone, abbe_error *error) {
  char text[512], what[112];
  snprintf(text, sizeof text,
           "camera: {eye: [0.02, -0.4, 0.12], target: [0, 0, 0], fov: 6}\n"
           "environment: {uniform: 1}\nobjects:\n"
           "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
           "   pavilion: 0.03, material: %s}\n",
           stone);
  snprintf(what, sizeof what, "cut %s in even light", stone);
  return add(run, what, 1, 0, "Y", text, error);
}

abbe_result abbe_known_polarised(abbe_known_run *run, abbe_error *error) {
  static const double angles[] = {0, 30, 90};
  static const char *const stones[] = {"diamond", "calcite", "topaz"};
  static const int plates[] = {1, 4, 10};
  ABBE_TRY(abbe_known_sheets(run, FIRST, error));
  for (int i = 0; i < 3; i++) ABBE_TRY(add_sheets(run, angles[i], error));
  for (int i = 0; i < 9; i++) ABBE_TRY(add_pile(run, plates[i / 3], i % 3, error));
  for (int i = 0; i < 2; i++) ABBE_TRY(add_mirrors(run, i == 1, error));
  for (int i = 0; i < 2; i++) ABBE_TRY(add_both_ways(run, i == 1, error));
  for (int i = 0; i < 2; i++) ABBE_TRY(add_tourmaline(run, i == 1, error));
  for (int i = 0; i < 2; i++) ABBE_TRY(add_turned(run, i == 1, error));
  for (int i = 0; i < 3; i++) ABBE_TRY(add_furnace(run, stones[i], error));
  return ABBE_OK;
}
