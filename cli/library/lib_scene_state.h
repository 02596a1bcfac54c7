/* lib_scene_state.h: what is behind a scene's handle. Internal to cli/library/. */
#ifndef ABBE_LIBRARY_LIB_SCENE_STATE_H
#define ABBE_LIBRARY_LIB_SCENE_STATE_H

#include "gl/renderer.h"
#include "cli/library/lib_scene.h"
#include "scenes/scene.h"

struct abbe_lib_scene {
  char *path, *materials, *stone;
  char **set; /* [set_count] */
  size_t set_count;
  abbe_scene *now;  /* owned */
  abbe_scene *held; /* by the renderer: `now`, or an earlier one that is owned, or NULL */
  bool looked;      /* the camera is not the file's */
  abbe_context *context;
  abbe_renderer *renderer;
  abbe_lib_progress progress;
  void *user;
};

/* Frees the renderer and what it holds of the scene. */
void abbe_library_scene_drop_renderer(abbe_lib_scene *scene);

#endif
