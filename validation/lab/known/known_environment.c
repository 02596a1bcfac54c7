#include "validation/lab/known/known_light.h"

#include <stdio.h>

/* Light from all around: what bodies meet of it, what floors get, and where it cannot be seen. */
typedef struct setting {
  const char *what, *channel;
  double exact;
  const char *camera, *environment, *objects;
} setting;

#define PI 3.14159265358979
#define FAR_CAMERA "{eye: [0.02, -0.4, 0.12], target: [0, 0, 0], fov: 12, size: [16, 16]}"
#define UNIFORM "{size: 64, uniform: 2}"
/* In view, and too small to be met. */
#define MOTE                                                                                       \
  "- {name: mote, shape: rectangle, width: 1.0e-6, height: 1.0e-6, reflectance: 1,\n"              \
  "   transform: [{translate: [-0.02, 0.4, -0.12]}]}\n"
#define FLOOR "- {name: floor, shape: rectangle, width: 200, height: 200, reflectance: 1}\n"
/* The middle of the floor, a millimetre wide. */
static const char low_camera[] =
    "{eye: [0, -0.5, 0.02], target: [0, 0, 0], fov: 0.1, size: [16, 16]}";
/* A bell of sigma 15 degrees: its irradiance over pi, by quadrature. */
#define BELL_OVERHEAD 0.12521171162291406

static const setting settings[] = {
    {"white floor under a bell overhead of 512 x 256 texels, radiance", "Y", BELL_OVERHEAD,
     low_camera, "{size: 512, spots: [{elevation: 90, radiance: 1, sigma: 15}]}", FLOOR},
    {"white floor under a bell overhead of 4096 x 2048 texels, radiance", "Y", BELL_OVERHEAD,
     low_camera, "{size: 4096, spots: [{elevation: 90, radiance: 1, sigma: 15}]}", FLOOR},
    {"ball, flux that it meets: pi x surface x radiance", NULL, 2 * PI * 4 * PI * 0.04 * 0.04,
     FAR_CAMERA, UNIFORM, MOTE "- {name: ball, shape: sphere, radius: 0.04, material: n-bk7}\n"},
    {"turned brick, flux that it meets: pi x surface x radiance", NULL,
     2 * PI * 2 * (0.1 * 0.03 + 0.1 * 0.05 + 0.03 * 0.05), FAR_CAMERA, UNIFORM,
     MOTE "- {name: brick, shape: box, size: [0.1, 0.03, 0.05], material: n-sf11,\n"
          "   transform: [{rotate: {axis: [1, 2, 0], angle: 35}}]}\n"},
    {"silver ball, flux that it meets: pi x surface x radiance", NULL,
     2 * PI * 4 * PI * 0.04 * 0.04, FAR_CAMERA, UNIFORM,
     MOTE "- {name: ball, shape: sphere, radius: 0.04, mirror: silver}\n"},
    {"cut diamond in uniform light, mean radiance of the picture", "Y", 2, FAR_CAMERA, UNIFORM,
     MOTE "- {name: stone, shape: brilliant, diameter: 0.07, material: diamond}\n"},
    {"mirror ring in uniform light, mean radiance of the picture", "Y", 2, FAR_CAMERA, UNIFORM,
     MOTE "- {name: ring, shape: ring, major: 0.03, minor: 0.012, mirror: 1}\n"},
    {"mirror of 0.5 before uniform light, mean radiance of the picture", "Y", 1, FAR_CAMERA,
     UNIFORM,
     MOTE "- {name: pane, shape: rectangle, width: 9, height: 9, mirror: 0.5,\n"
          "   transform: [{translate: [0, 0, -0.05]}]}\n"},
    {"white floor under a cosine dome, radiance", "Y", 2.0 / 3, low_camera, "{dome: cos}", FLOOR},
    {"white floor under a cosine dome that is tilted to the horizon, radiance", "Y", 2 / (3 * PI),
     low_camera, "{dome: cos, tilt: {axis: [1, 1, 0], angle: 90}}", FLOOR},
    {"white floor under a disk overhead, radiance", "Y",
     5 * 0.030153689607045804 /* sin^2 of 10 degrees */, low_camera,
     "{softboxes: [{elevation: 90, radius: 10, radiance: 5}]}", FLOOR},
    {"white floor, the sky half hidden by a square of form factor 0.5541", "Y",
     2 * (1 - 0.5541264239795719), low_camera, UNIFORM,
     FLOOR "- {name: lid, shape: rectangle, width: 0.4, height: 0.4, reflectance: 0,\n"
           "   transform: [{translate: [0, 0, 0.2]}]}\n"},
};

static const char reason[] = "as improbable as four standard errors, taken from the spread of the "
                             "passes; and 2e-4 of the value for the map's texels";

/* Draws from many texels want more bits of their random numbers. */
static abbe_result make_even(abbe_environment *e, size_t texels, abbe_error *error) {
  abbe_radiance_map map;
  ABBE_TRY(abbe_radiance_map_make(texels, &map, error));
  for (size_t i = 0; i < 3 * map.width * map.height; i++) map.rgb[i] = 2;
  abbe_alias_table_free(&e->texels);
  for (size_t i = 0; i < e->level_count; i++) abbe_radiance_map_free(&e->level[i]);
  abbe_radiance_map_free(&e->map);
  e->level_count = 0;
  e->map = map;
  return abbe_environment_prepare(e, error);
}

/* texels: in place of the setting's environment, even light of 2 from so many around; 0: none. */
static abbe_result add_setting(abbe_known_run *run, const setting *s, size_t texels, double from,
                               double to, abbe_error *error) {
  ABBE_OWNED(abbe_scene, scene) = {0};
  const abbe_known_setting known = {.what = s->what,
                                    .unit = s->channel ? "W/(m2 sr)" : "W",
                                    .reason = reason,
                                    .exact = s->exact,
                                    .slack = 2e-4 * s->exact,
                                    .useful = 2e-2 * s->exact,
                                    .samples = 1 << 19,
                                    .side = s->camera == low_camera ? 64 : 16,
                                    .channel = s->channel};
  ABBE_TRY(abbe_known_scene(&scene, error, "camera: %s\nenvironment: %s\nobjects:\n%s", s->camera,
                            s->environment, s->objects));
  if (texels > 0) ABBE_TRY(make_even(scene.environment, texels, error));
  return abbe_known_add_setting(run, &known, &scene, from, to, error);
}

static abbe_result add_even(abbe_known_run *run, size_t texels, double from, double to,
                            abbe_error *error) {
  char what[96];
  const setting s = {what, "Y", 2, low_camera, UNIFORM, FLOOR};
  snprintf(what, sizeof what, "white floor under even light of %zu x %zu texels, radiance", texels,
           texels / 2);
  return add_setting(run, &s, texels, from, to, error);
}

abbe_result abbe_known_environment(abbe_known_run *run, abbe_error *error) {
  static const size_t texels[] = {64, 1024, 4096, ABBE_RADIANCE_MAP_MAX_WIDTH};
  const int count = sizeof settings / sizeof *settings;
  const int all = count + (int)(sizeof texels / sizeof *texels);
  for (int i = 0; i < all; i++) {
    const double from = (double)i / all, to = (i + 1.0) / all;
    ABBE_TRY(i < count ? add_setting(run, &settings[i], 0, from, to, error)
                       : add_even(run, texels[i - count], from, to, error));
  }
  return ABBE_OK;
}

/* A white furnace: where the same light comes from everywhere, clear glass cannot be seen. */
typedef struct room {
  const char *what, *objects;
  size_t side; /* of its picture: haze needs more paths than glass */
} room;

/* Ambient light of pi W/m2 makes every white receiver as bright as the background, 1 W/(m2 sr). The
 * light that a scene must have adds 1e-12 of that. */
static const char furnace_head[] =
    "camera: {eye: [0.02, -0.4, 0.12], target: [0, 0, 0], fov: 16, size: [48, 48]}\n"
    "ambient: 3.14159265358979\n"
    "background: 1\n"
    "lights: [{name: lamp, kind: point, position: [0, 0, 5], intensity: 1.0e-12, illuminant: "
    "D65}]\n"
    "objects:\n"
    "- {name: floor, shape: rectangle, width: 0.2, height: 0.2, reflectance: 1,\n"
    "   transform: [{translate: [0, 0, -0.06]}]}\n";

static const room rooms[] = {
    {"ball of fused silica",
     "- {name: ball, shape: sphere, radius: 0.04, material: fused-silica}\n", 48},
    {"cut diamond",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: diamond}\n",
     48},
    {"ring of sf10", "- {name: ring, shape: ring, major: 0.03, minor: 0.012, material: sf10}\n",
     48},
    {"bubble in a ball of n-bk7",
     "- {name: ball, shape: sphere, radius: 0.04, material: n-bk7}\n"
     "- {name: bubble, shape: sphere, radius: 0.025, material: air}\n",
     48},
    {"cut calcite",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: calcite, axis: [1, 0.4, 0.7]}\n",
     48},
    {"frosted ball of n-bk7",
     "- {name: ball, shape: sphere, radius: 0.04, material: n-bk7, roughness: 1}\n", 48},
    {"cut diamond, partly frosted",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: diamond, roughness: {alpha: 0.3, faces: [table, pavilion]}}\n",
     48},
    {"frosted cut calcite",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: calcite, axis: [1, 0.4, 0.7], roughness: 0.5}\n",
     48},
    {"hazy ball of n-bk7",
     "- {name: ball, shape: sphere, radius: 0.04, material: n-bk7, medium: {scattering: 20, g: "
     "0.5}}\n",
     128},
    {"hazy cut calcite with a cloud and a bubble",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: calcite, axis: [1, 0.4, 0.7], medium: {scattering: 60},\n"
     "   clouds: [{radius: 0.006, medium: {scattering: 400, g: 0.8}}]}\n"
     "- {name: bubble, shape: sphere, radius: 0.004, material: air,\n"
     "   transform: [{translate: [0.014, 0, 0]}]}\n",
     48},
};

static const char furnace_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 2e-5 for "
    "paths that single precision loses on edges, and for those too long to be followed";

static abbe_result add_room(abbe_known_run *run, const room *r, double from, double to,
                            abbe_error *error) {
  ABBE_OWNED(abbe_scene, scene) = {0};
  char what[sizeof((abbe_known_answer){0}).quantity];
  snprintf(what, sizeof what, "%s, mean radiance of the picture", r->what);
  const abbe_known_setting known = {.what = what,
                                    .unit = "W/(m2 sr)",
                                    .reason = furnace_reason,
                                    .exact = 1,
                                    .slack = 2e-5,
                                    .useful = 2e-3,
                                    .samples = 1 << 16,
                                    .side = r->side,
                                    .channel = "Y"};
  ABBE_TRY(abbe_known_scene(&scene, error, "%s%s", furnace_head, r->objects));
  return abbe_known_add_setting(run, &known, &scene, from, to, error);
}

abbe_result abbe_known_furnace(abbe_known_run *run, abbe_error *error) {
  const int count = sizeof rooms / sizeof *rooms;
  for (int i = 0; i < count; i++)
    ABBE_TRY(add_room(run, &rooms[i], (double)i / count, (i + 1.0) / count, error));
  return ABBE_OK;
}
