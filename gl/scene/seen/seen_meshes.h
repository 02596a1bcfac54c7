/* seen_meshes.h: the scene's meshes as its camera sees them: those that reach from close by to far
 * away are cut, the others are the scene's. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SEEN_SEEN_MESHES_H
#define ABBE_GL_SCENE_SEEN_SEEN_MESHES_H

#include "base/error.h"
#include "gl/scene/gpu_scene.h"
#include "scenes/mesh/mesh.h"
#include "scenes/view/view.h"

#include <stdbool.h>

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

void abbe_seen_meshes_draw(const abbe_seen_meshes *seen, size_t object);
/* The same where the program in use numbers faces: its uniform at `location` is the number of the
 * first face that is drawn, of which the object's are number `face_first` on. */
void abbe_seen_meshes_draw_numbered(const abbe_seen_meshes *seen, size_t object, GLint location,
                                    size_t face_first);

/* A mesh as a perspective view shows it, where some of its faces reach from close by to far away:
 * such faces are clipped to the window and cut where depth has grown sixteenfold. Single precision
 * interpolates places on each part as well as it knows them. Knows no GL. */

/* Whether it has a face whose depth grows more than that in front of the view. min and max: bounds.
 */
bool abbe_cut_mesh_needed(const abbe_mesh *mesh, const double min[3], const double max[3],
                          const abbe_view *view);

/* Its vertices, and those of the parts behind them; faces that are not cut, in their order, and
 * then the parts of the others. Parts next to each other share their corners to the bit. *face_of:
 * of each face of `out` the mesh's own; malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_cut_mesh_make(const abbe_mesh *mesh, const abbe_view *view, abbe_mesh *out,
                               uint32_t **face_of, abbe_error *error);

/* Draws the front or the back faces of all refractors, as a view shows them: normal and distance,
 * and which refractor. */

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
  bool both;                      /* or front and back, the nearest */
  const abbe_seen_meshes *meshes; /* as the camera sees them; NULL: the scene's */
  bool coarse;                    /* with fewer triangles, where meshes have many */
} abbe_faces_target;

abbe_result abbe_refractor_faces_make(const abbe_gpu_scene *scene, abbe_refractor_faces *out,
                                      abbe_error *error);

void abbe_refractor_faces_use(const abbe_refractor_faces *faces, const abbe_view *view);
/* Clears the target and draws into it, or clears it alone. The view is in use. ABBE_GL. */
abbe_result abbe_refractor_faces_draw(const abbe_refractor_faces *faces,
                                      const abbe_faces_target *target, bool clear_alone,
                                      abbe_error *error);

#endif
