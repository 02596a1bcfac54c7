/* renderer_state.h: what a renderer is made of. Internal to gl/: only renderer.c, renderer_parts.c
 * and their tests look inside.
 */
#ifndef ABBE_GL_RENDERER_STATE_H
#define ABBE_GL_RENDERER_STATE_H

#include "gl/caustics/caustics.h"
#include "gl/eye/adaptive_pass.h"
#include "gl/eye/picture.h"
#include "gl/haze/haze_pass.h"
#include "gl/methods/methods.h"
#include "gl/renderer.h"
#include "gl/renderer_inputs.h"
#include "gl/scene/local_scene.h"
#include "gl/scene/seen/seen_meshes.h"

struct abbe_renderer {
  abbe_context *context;
  abbe_gpu gpu;
  abbe_scene surrounded; /* the caller's, and lights for its environment; zeroed without one */
  abbe_local_scene local;
  abbe_map_layout given, local_given; /* the request's layout; the same there */
  abbe_plan plan;
  abbe_renderer_inputs inputs; /* what the parts below were made from */
  unsigned lacking;            /* of these, a bit each: are not there */
  abbe_gpu_scene scene;
  abbe_shader_variant variant;

  /* light */
  abbe_photon_lights views;
  abbe_refractor_faces faces;
  abbe_light_layers layers;
  abbe_receiver_atlas atlas;
  abbe_map_history history; /* of maps, from change to change */
  abbe_spectral_map map;
  abbe_caustics caustics;
  abbe_transports transports;
  abbe_method *method; /* in place of these and those below, or NULL */
  bool lit;            /* all of that is drawn: the maps hold the light as it is now */

  /* eye */
  abbe_camera_view camera;
  abbe_seen_meshes meshes;
  abbe_lighting lighting;
  abbe_receivers_pass receivers;
  abbe_refraction_pass refraction;
  abbe_refraction_kept kept; /* of the one before, between it and the next; else zero */
  abbe_adaptive_pass adaptive;
  abbe_picture picture;
  abbe_haze_pass haze;
  abbe_shaft_grid shafts;
  bool seen; /* the picture is drawn */

  GLuint baseline;   /* what abbe_renderer_baseline draws into; 0 before */
  double untimed_ms; /* of this frame, spent on its ledger */
};

#endif
