/* renderer_state.h: what a renderer is made of. Internal to gl/: renderer.c alone and its tests
 * look inside.
 */
#ifndef ABBE_GL_RENDERER_STATE_H
#define ABBE_GL_RENDERER_STATE_H

#include "gl/caustics/caustics.h"
#include "gl/eye/picture.h"
#include "gl/renderer.h"
#include "gl/scene/local_scene.h"
#include "gl/thesis/thesis.h"

struct abbe_renderer {
  abbe_context *context;
  abbe_gpu gpu;
  abbe_local_scene local;
  abbe_map_layout given; /* the request's layout there, where the scene is moved */
  abbe_plan plan;
  abbe_gpu_scene scene;
  abbe_shader_variant variant;

  abbe_camera_view camera;
  abbe_photon_lights views;
  abbe_refractor_faces faces;
  abbe_light_layers layers;
  abbe_receiver_atlas atlas;
  abbe_spectral_map map;
  abbe_caustics caustics;
  abbe_lighting lighting;
  abbe_receivers_pass receivers;
  abbe_refraction_pass refraction;
  abbe_picture picture;
  abbe_thesis thesis; /* in place of all from the camera on */

  GLuint baseline;   /* what abbe_renderer_baseline draws into */
  bool drawn;        /* the last frame was, to its end */
  double untimed_ms; /* of this frame, spent on its ledger */
};

#endif
