/* lighting.h: all that shaders need to light a receiver (receiver.glsl): tables, light layers,
 * spectral map, tiles. Internal to gl/. */
#ifndef ABBE_GL_EYE_LIGHTING_H
#define ABBE_GL_EYE_LIGHTING_H

#include "gl/beams/beam_list.h"
#include "gl/caustics/spectral_map.h"
#include "gl/light/light_layers.h"
#include "gl/light/receiver_atlas.h"
#include "gl/methods/transports/transports.h"
#include "gl/scene/local_scene.h"
#include "gl/scene/seen/seen_meshes.h"
#include "gl/scene/shader_variant.h"

struct abbe_lighting;

/* What refractors emit by fluorescence. Rays to them from the lights and from all around say how
 * much they absorb of it in each band, in each cell of a grid, and then what they send back: they
 * follow the camera's own paths. Zeroed: nothing glows. */
typedef struct abbe_glow_pass {
  const struct abbe_lighting *lighting;
  GLuint program, sums, cells; /* cells: texture of the source, photons by m3 and sr (glow.glsl) */
  float low[ABBE_PLAN_MOST_GLOWING][4];   /* corner of the grid, m; 1: it glows */
  float size[ABBE_PLAN_MOST_GLOWING][3];  /* m */
  float ball[ABBE_PLAN_MOST_GLOWING][4];  /* as it lights receivers: centre, radius, m */
  float light[ABBE_PLAN_MOST_GLOWING][3]; /* and its rgb radiance */
  bool lit;                               /* all of that is of the light as it is */
} abbe_glow_pass;

/* A plan that does not glow gets one that is zero; one that has stayed is left as it is. ABBE_GL,
 * ABBE_NO_MEMORY. */
abbe_result abbe_glow_pass_make(const struct abbe_lighting *lighting,
                                const abbe_shader_variant *variant, abbe_glow_pass *out,
                                abbe_error *error);
/* stays: nothing that it is made of has changed but the camera, and it is kept. */
void abbe_glow_pass_free(abbe_glow_pass *pass, bool stays);
/* In the light as it is, unless it is lit already; waits for the device. */
abbe_result abbe_glow_pass_run(abbe_glow_pass *glow, abbe_error *error);

typedef struct abbe_lighting {
  const abbe_gpu_scene *scene;
  const abbe_photon_lights *views;
  const abbe_light_layers *layers;
  const abbe_receiver_atlas *atlas;
  const abbe_spectral_map *map;
  const abbe_camera_view *camera;
  const abbe_transports *transports;
  const abbe_shaft_grid *shafts;
  const abbe_seen_meshes *meshes; /* the camera's */
  const abbe_glow_pass *glow;
} abbe_lighting;

/* The program is in use, everything is bound, the camera is set. */
void abbe_lighting_use(const abbe_lighting *lighting, GLuint program);

#endif
