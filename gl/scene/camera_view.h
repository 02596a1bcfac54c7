/* camera_view.h: what the scene's camera sees, and the samples of its picture. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_CAMERA_VIEW_H
#define ABBE_GL_SCENE_CAMERA_VIEW_H

#include "gl/plan/plan.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stddef.h>

typedef struct abbe_camera_view {
  abbe_view view;    /* whole samples, the last of which may stand for pixels beyond the picture */
  size_t samples[2]; /* across and up; they cover the picture, and less than one of them more */
  size_t receiver_samples[2];       /* the same of receivers */
  size_t room[2], receiver_room[2]; /* texels of their targets: as many, or some more */
} abbe_camera_view;

void abbe_camera_view_fit(const abbe_scene *scene, const abbe_render_desc *desc,
                          abbe_camera_view *out);

#endif
