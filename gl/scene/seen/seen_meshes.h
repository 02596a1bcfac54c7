/* seen_meshes.h: the scene's meshes as its camera sees them: those that reach from close by to far away
 * are cut (cut_mesh.h), the others are the scene's. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SEEN_SEEN_MESHES_H
#define ABBE_GL_SCENE_SEEN_SEEN_MESHES_H

#include "gl/scene/gpu_scene.h"
#include "scenes/view/view.h"

typedef struct abbe_seen_meshes {
  const abbe_gpu_scene *scene;
  abbe_gpu_mesh *cut; /* [count] of each object; zeroed where it is not cut */
  uint32_t **face_of; /* [count] of each face of these, the object's own */
  size_t count;
} abbe_seen_meshes;

/* Errors as of abbe_gpu_meshes_upload. Freeing a zeroed one is safe. */
abbe_result abbe_seen_meshes_make(const abbe_gpu_scene *scene, const abbe_view *view,
                                  abbe_seen_meshes *out, abbe_error *error);
void abbe_seen_meshes_free(abbe_seen_meshes *seen);

bool abbe_seen_meshes_is_cut(const abbe_seen_meshes *seen, size_t object);
void abbe_seen_meshes_draw(const abbe_seen_meshes *seen, size_t object);
/* The same where the program in use numbers faces: its uniform at `location` is the number of the first
 * face that is drawn, of which the object's are number `face_first` on. */
void abbe_seen_meshes_draw_numbered(const abbe_seen_meshes *seen, size_t object, GLint location,
                                    size_t face_first);

#endif
