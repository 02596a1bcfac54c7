/* image_cube.h: through how many views a light sees in the published methods: one, or of receivers
 * the six of a cube around it, and of refractors and mirrors one around them or six. Faces and
 * their axes are those of gl/plan/examine/light_cube.h. Internal to gl/.
 */
#ifndef ABBE_GL_IMAGE_SPACE_IMAGE_CUBE_H
#define ABBE_GL_IMAGE_SPACE_IMAGE_CUBE_H

#include "gl/plan/examine/light_cube.h"
#include "gl/scene/gpu_scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_image_cube {
  size_t faces, object_faces; /* 1 or 6 each */
  abbe_view face[ABBE_LIGHT_CUBE_FACES], object_face[ABBE_LIGHT_CUBE_FACES];
} abbe_image_cube;

/* One view for all. */
void abbe_image_cube_one(const abbe_view *view, abbe_image_cube *out);
/* The cube around the scene's first light, a point or a spot. A face's map has `side` texels a
 * side, of which it shares `border` at each edge with its neighbours; 2 border < side. Objects are
 * seen through one view where that is at most 57 degrees off its middle, unless `whole` asks for
 * six. */
void abbe_image_cube_make(const abbe_gpu_scene *scene, size_t side, size_t border, bool whole,
                          abbe_image_cube *out);

#endif
