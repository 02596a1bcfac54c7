/* lib_handles.h: what is behind the handles of pictures and scenes, and what every function of the
 * API requires of its caller. Internal to library/. */
#ifndef ABBE_LIBRARY_LIB_HANDLES_H
#define ABBE_LIBRARY_LIB_HANDLES_H

#include "gl/renderer.h"
#include "library/lib_scene.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <assert.h>

/* The pointers that a function of the API needs, checked before anything else. Where the condition
 * does not hold, a debug build stops at the assertion, and every other build returns
 * ABBE_INVALID_ARGUMENT from the function. */
#define ABBE_REQUIRE(condition, error)                                                             \
  do {                                                                                             \
    assert(condition);                                                                             \
    if (!(condition))                                                                              \
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,                                          \
                            "%s was called without what it needs: %s", __func__, #condition);      \
  } while (0)

struct abbe_lib_picture {
  abbe_image image;
};

/* A handle that takes over the image, which is zeroed; on failure, too, the image is freed. */
abbe_result abbe_library_picture_adopt(abbe_image *image, abbe_lib_picture **out,
                                       abbe_error *error);

struct abbe_lib_scene {
  char *path, *materials, *stone;
  char **set; /* [set_count] */
  size_t set_count;
  abbe_scene *now;  /* owned */
  abbe_scene *held; /* by the renderer: `now`, or an earlier one that is owned, or NULL */
  bool looked;      /* the camera is not the file's */
  abbe_context *context;
  abbe_renderer *renderer;
  abbe_render_desc desc;  /* the renderer's last request */
  abbe_map_layout layout; /* of maps to be rendered, where laid */
  bool laid;
  size_t laid_light;
  abbe_lib_progress progress;
  void *user;
};

/* A request of abbe_lib_scene_render: its settings and the device. */
typedef struct abbe_library_render_request {
  abbe_render_desc desc;
  int backend;
  bool redraw;
} abbe_library_render_request;
abbe_result abbe_library_render_request_read(const char *const *settings, size_t count,
                                             abbe_library_render_request *out, abbe_error *error);

/* Frees the renderer and what it holds of the scene. */
void abbe_library_scene_drop_renderer(abbe_lib_scene *scene);

/* A file that came with the library, found wherever it was installed: path, where something is
 * there; else that path in the share folder beside the file that this code was loaded from, or
 * where the build installs it, in text[size]; else path. */
const char *abbe_library_shipped_find(const char *path, char *text, size_t size);

#endif
