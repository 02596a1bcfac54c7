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
} abbe_lighting;

/* The program is in use, everything is bound, the camera is set. */
void abbe_lighting_use(const abbe_lighting *lighting, GLuint program);

#endif
