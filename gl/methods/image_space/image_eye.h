/* image_eye.h: the camera's passes of the published methods that sum a caustic map: receivers lit
 * by light, shadow and map, and what is seen in refractors and mirrors. Internal to gl/.
 */
#ifndef ABBE_GL_IMAGE_SPACE_IMAGE_EYE_H
#define ABBE_GL_IMAGE_SPACE_IMAGE_EYE_H

#include "gl/methods/image_space/image_places.h"
#include "gl/scene/local_scene.h"

typedef struct abbe_image_eye {
  const abbe_gpu_scene *scene;
  const abbe_image_places *light; /* whose depth is the shadow map */
  abbe_camera_view camera;
  abbe_image_places places;
  GLuint receivers, refraction; /* programs */
  GLuint lit, lit_depth, picture;
  float (*colour)[3]; /* [wavelengths] of white: XYZ, or RGB as printed */
} abbe_image_eye;

/* colour is taken over also where this fails. more: definitions beside the variant's. */
abbe_result abbe_image_eye_make(const abbe_gpu_scene *scene, const abbe_image_places *light,
                                const abbe_shader_variant *variant, const char *more,
                                float (*colour)[3], abbe_image_eye *out, abbe_error *error);
void abbe_image_eye_free(abbe_image_eye *eye);
/* From where the scene's camera is now; the picture's size is as it was. */
void abbe_image_eye_look(abbe_image_eye *eye);
/* caustic_map: in the light's image, an array where that has more than one view. */
abbe_result abbe_image_eye_run(abbe_image_eye *eye, GLuint caustic_map, abbe_error *error);

#endif
