/* refractor_faces.h: draws the front or the back faces of all refractors, as a view shows them:
 * normal and distance, and which refractor. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SEEN_REFRACTOR_FACES_H
#define ABBE_GL_SCENE_SEEN_REFRACTOR_FACES_H

#include "gl/scene/gpu_scene.h"
#include "gl/scene/seen/seen_meshes.h"
#include "scenes/view/view.h"

#include <stdbool.h>

typedef struct abbe_refractor_faces {
  const abbe_gpu_scene *scene;
  GLuint program;
} abbe_refractor_faces;

/* One layer to draw into. */
typedef struct abbe_faces_target {
  GLuint layers, owner, depth; /* owner: only with front faces */
  int layer, owner_layer;      /* -1: a 2D texture */
  size_t width, height;
  GLfloat distance; /* that is kept where nothing is drawn, m */
  bool back;
  bool both;   /* or front and back, the nearest */
  const abbe_seen_meshes *meshes; /* as the camera sees them; NULL: the scene's */
  bool coarse; /* of fewer triangles, where meshes have many */
} abbe_faces_target;

abbe_result abbe_refractor_faces_make(const abbe_gpu_scene *scene, abbe_refractor_faces *out,
                                      abbe_error *error);

void abbe_refractor_faces_use(const abbe_refractor_faces *faces, const abbe_view *view);
/* Clears the target and draws into it, or clears it alone. The view is in use. ABBE_GL. */
abbe_result abbe_refractor_faces_draw(const abbe_refractor_faces *faces,
                                      const abbe_faces_target *target, bool clear_alone,
                                      abbe_error *error);

#endif
