/* A white furnace: where the same light comes from everywhere, clear glass cannot be seen. */
#include "validation/lab/known/known_light.h"

#include <stdio.h>

typedef struct room {
  const char *what, *objects;
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
     "- {name: ball, shape: sphere, radius: 0.04, material: fused-silica}\n"},
    {"cut diamond",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: diamond}\n"},
    {"ring of sf10", "- {name: ring, shape: ring, major: 0.03, minor: 0.012, material: sf10}\n"},
    {"bubble in a ball of n-bk7",
     "- {name: ball, shape: sphere, radius: 0.04, material: n-bk7}\n"
     "- {name: bubble, shape: sphere, radius: 0.025, material: air}\n"},
    {"cut calcite",
     "- {name: gem, shape: gem, sides: 6, girdle: 0.04, table: 0.024, crown: 0.013,\n"
     "   pavilion: 0.03, material: calcite, axis: [1, 0.4, 0.7]}\n"},
};

static const char furnace_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 2e-5 for "
    "paths that single precision loses on edges, and for those too long to be followed";

static abbe_result add_room(abbe_known_run *run, const room *r, double from, double to,
                            abbe_error *error) {
  abbe_scene scene = {0};
  char what[sizeof((abbe_known_answer){0}).quantity];
  snprintf(what, sizeof what, "%s, mean radiance of the picture", r->what);
  const abbe_known_setting setting = {.what = what,
                                      .unit = "W/(m2 sr)",
                                      .reason = furnace_reason,
                                      .exact = 1,
                                      .slack = 2e-5,
                                      .useful = 2e-3,
                                      .samples = 1 << 16,
                                      .side = 48,
                                      .channel = "Y"};
  abbe_result result = abbe_known_scene(&scene, error, "%s%s", furnace_head, r->objects);
  if (result == ABBE_OK) result = abbe_known_add_setting(run, &setting, &scene, from, to, error);
  abbe_scene_free(&scene);
  return result;
}

abbe_result abbe_known_furnace(abbe_known_run *run, abbe_error *error) {
  const int count = sizeof rooms / sizeof *rooms;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < count && result == ABBE_OK; i++)
    result = add_room(run, &rooms[i], (double)i / count, (i + 1.0) / count, error);
  return result;
}
