/* A white furnace: where the same light comes from everywhere, clear glass cannot be seen. */
#include "validation/known/known_light.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 48 };

typedef struct room {
  const char *what, *objects;
} room;

/* Ambient light of pi W/m2 makes every white receiver as bright as the background, 1 W/(m2 sr). The
 * lamp that a scene must have adds 1e-12 of that. */
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
};

static const char furnace_reason[] =
    "as improbable as four standard errors, taken from the spread of the passes; and 2e-5 for "
    "paths that single precision loses on edges, and for those too long to be followed";

/* Mean of a channel over the picture of all passes so far. */
static abbe_result mean_of(const abbe_tracer *tracer, const char *channel, double *mean,
                           double *least, double *most, abbe_error *error) {
  abbe_image picture = {0};
  abbe_result result = abbe_tracer_picture(tracer, &picture, error);
  size_t at = abbe_image_find_channel(&picture, channel), pixels = picture.width * picture.height;
  *mean = 0;
  *least = INFINITY;
  *most = -INFINITY;
  if (result == ABBE_OK && at == (size_t)-1)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture has no channel %s", channel);
  for (size_t i = 0; result == ABBE_OK && i < pixels; i++) {
    double value = (double)picture.data[i * picture.channels + at];
    *mean += value / (double)pixels;
    *least = fmin(*least, value);
    *most = fmax(*most, value);
  }
  abbe_image_free(&picture);
  return result;
}

static abbe_result add_room(abbe_known_run *run, const room *r, double from, double to,
                            abbe_error *error) {
  abbe_scene scene = {0};
  abbe_tracer *tracer = NULL;
  abbe_trace_desc desc = {
      .no_map = true, .space = ABBE_RGB_SPACE_XYZ, .width = SIDE, .height = SIDE};
  size_t passes = abbe_known_passes(run, 1 << 16, &desc);
  double(*sum)[3] = calloc(passes, sizeof *sum), before = 0, mean = 0, least = 0, most = 0;
  abbe_result result = sum != NULL
                           ? abbe_known_scene(&scene, error, "%s%s", furnace_head, r->objects)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for passes");
  if (result == ABBE_OK) result = abbe_tracer_make(&scene, &desc, &tracer, error);
  for (size_t p = 0; p < passes && result == ABBE_OK; p++) {
    result = abbe_tracer_pass(tracer, NULL, error);
    if (result == ABBE_OK) result = mean_of(tracer, "Y", &mean, &least, &most, error);
    sum[p][1] = ((double)p + 1) * mean - (double)p * before;
    before = mean;
    double done = from + (to - from) * (double)(p + 1) / (double)passes;
    if (result == ABBE_OK) result = abbe_known_progress(run, done, error);
  }
  if (result == ABBE_OK) {
    double spread = 0;
    abbe_known_mean(sum, passes, 1, 0, 1, 1, &mean, &spread);
    abbe_known_answer row = {.unit = "W/(m2 sr)",
                             .exact = 1,
                             .traced = mean,
                             .standard_error = spread,
                             .tolerance = abbe_known_sigmas(passes) * spread + 2e-5,
                             .useful = 2e-3,
                             .reason = furnace_reason};
    snprintf(row.quantity, sizeof row.quantity, "%s, mean radiance of the picture", r->what);
    result = abbe_known_add(run, row, error);
  }
  abbe_tracer_free(tracer);
  abbe_scene_free(&scene);
  free(sum);
  return result;
}

abbe_result abbe_known_furnace(abbe_known_run *run, abbe_error *error) {
  const int count = sizeof rooms / sizeof *rooms;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < count && result == ABBE_OK; i++)
    result = add_room(run, &rooms[i], (double)i / count, (i + 1.0) / count, error);
  return result;
}
