/* renderer_state.h: what a renderer is made of. Internal to gl/: only renderer*.c and their
 * tests look inside. renderer.c has the frame, renderer_change.c what a change makes anew,
 * renderer_read.c what is read.
 */
#ifndef ABBE_GL_RENDERER_STATE_H
#define ABBE_GL_RENDERER_STATE_H

#include "gl/caustics/caustics.h"
#include "gl/eye/adaptive_pass.h"
#include "gl/eye/picture.h"
#include "gl/haze/haze_pass.h"
#include "gl/methods/methods.h"
#include "gl/plan/plan.h"
#include "gl/renderer.h"
#include "gl/scene/local_scene.h"
#include "gl/scene/seen/seen_meshes.h"
#include "scenes/scene.h"

#include <stdint.h>

/* What each part of a renderer is made from, as a number that is equal where
 * nothing of it has changed. It makes nothing.
 *
 * A number is a 64-bit digest of all values that the part and those that it stands on read, so that
 * a difference anywhere is seen whoever made it. */

/* The parts of a renderer, each made after those above it. */
typedef enum abbe_renderer_part {
  ABBE_PART_GEOMETRY, /* meshes, planes, triangles to be traversed, charts of receivers */
  ABBE_PART_SURFACES, /* reflectances and textures */
  ABBE_PART_SPECTRA,  /* tables over wavelength */
  ABBE_PART_SHADOWS,  /* planes of refractors' shadows: of geometry and lights' places */
  ABBE_PART_LIGHT, /* light views, photons, maps: of geometry, spectra, shadows and lights' beams */
  ABBE_PART_EYE,   /* targets and programs of the camera's passes */
  ABBE_PART_POWERS, /* how strong lights, ambient light and background are, and the picture's space:
                       nothing is made of it but a table */
  ABBE_PART_COUNT
} abbe_renderer_part;

typedef struct abbe_renderer_inputs {
  uint64_t part[ABBE_PART_COUNT];
  uint64_t
      sights;     /* where the camera's rays through refractors go: all of the eye but the lights */
  uint64_t pages; /* what pinholes show: of smooth mirrors and refractors no lamps */
  uint64_t glow;  /* what makes refractors glow: all but the camera */
} abbe_renderer_inputs;

void abbe_renderer_inputs_of(const abbe_scene *scene, const abbe_plan *plan,
                             abbe_renderer_inputs *out);

/* A bit, 1 << part, for each that differs. */
unsigned abbe_renderer_inputs_differ(const abbe_renderer_inputs *a, const abbe_renderer_inputs *b);

/* Compiles beside the renderer (renderer_ahead.c). */
typedef struct abbe_renderer_ahead abbe_renderer_ahead;

struct abbe_renderer {
  abbe_context *context;
  abbe_gpu gpu;
  abbe_scene surrounded; /* the caller's, and lights for its environment; zeroed without one */
  abbe_local_scene local;
  abbe_map_layout given, local_given; /* the request's layout; the same there */
  abbe_plan plan;
  abbe_renderer_inputs inputs; /* what the parts below were made from */
  unsigned lacking;            /* those of these, a bit each, that are not there */
  abbe_gpu_scene scene;
  abbe_shader_variant variant;

  /* light */
  abbe_photon_lights views;
  abbe_refractor_faces faces;
  abbe_light_layers layers;
  abbe_receiver_atlas atlas;
  abbe_map_history history; /* history of maps, from change to change */
  abbe_spectral_map map;
  abbe_caustics caustics;
  abbe_transports transports;
  bool pages_stay;     /* tiles of pinholes stay when light's passes are freed */
  bool glow_stays;     /* as it is when the camera's passes are freed */
  abbe_method *method; /* in place of these and those below, or NULL */
  bool lit;            /* all of that is drawn: the maps hold the light as it is now */

  /* camera */
  abbe_camera_view camera;
  abbe_seen_meshes meshes;
  abbe_lighting lighting;
  abbe_glow_pass glow;
  abbe_receivers_pass receivers;
  abbe_refraction_pass refraction;
  abbe_refraction_kept kept; /* kept from the one before, between it and the next; else zero */
  abbe_adaptive_pass adaptive;
  abbe_picture picture;
  abbe_haze_pass haze;
  abbe_shaft_grid shafts;
  bool seen; /* the picture is drawn */

  abbe_renderer_ahead *ahead; /* NULL: nothing compiles beside */

  GLuint baseline;   /* what abbe_renderer_baseline draws into; 0 before */
  double untimed_ms; /* time of this frame, spent on its ledger */
};

/* For the files of the renderer, whose public functions are on its context and in a state of its
 * own, between these two. */
abbe_result abbe_renderer_enter(abbe_context *context, abbe_error *error);
abbe_result abbe_renderer_leave(abbe_context *context, abbe_result result);

/* A caller's progress, which may make another context current: watch is told of it as user. */
typedef struct abbe_renderer_watched {
  abbe_context *context;
  abbe_render_progress progress;
  void *user;
  abbe_result result; /* result of making the context current again, with its error */
  abbe_error *error;
  void (*compiling)(void *user);
} abbe_renderer_watched;
bool abbe_renderer_watch(void *watched, double done);
/* After a cancel nothing more was dispatched: whatever the passes say, there is no result. */
abbe_result abbe_renderer_end_watch(abbe_renderer *renderer, abbe_result result, abbe_error *error);

/* Whether a published method draws in place of the passes here. */
bool abbe_renderer_has_method(const abbe_renderer *renderer);
/* ABBE_INVALID_ARGUMENT where its last change or frame failed. */
abbe_result abbe_renderer_check(const abbe_renderer *renderer, abbe_error *error);

/* Draws a frame in a context of its own; desc's progress stops it. */
typedef void abbe_renderer_draw_ahead(const abbe_scene *scene, const abbe_render_desc *desc);
/* Begins such a thread, where it serves and there is none yet. */
void abbe_renderer_thread_ahead(abbe_renderer *renderer, const abbe_scene *scene,
                                abbe_renderer_draw_ahead *draw);
/* Begins to compile the camera's programs beside, where that serves and nothing does so yet. */
void abbe_renderer_begin_ahead(abbe_renderer *renderer, const abbe_scene *scene);
/* Waits for them, as long as whoever watches lets it. */
void abbe_renderer_await_ahead(abbe_renderer *renderer);
/* Has it stop after the program that it is at, and waits for that. */
void abbe_renderer_end_ahead(abbe_renderer *renderer);

/* A stage's passes, made in the frame's order and freed in the other. */
abbe_result abbe_renderer_make_stage(abbe_renderer *renderer, abbe_pass_stage stage,
                                     const abbe_shader_variant *variant, abbe_error *error);
void abbe_renderer_free_stage(abbe_renderer *renderer, abbe_pass_stage stage);

#endif
