/* method.h: a published method: passes of its own, made, run and read by one set of verbs, and what
 * these methods share. gl/methods/methods.h has the methods that there are, and the verbs for the
 * renderer. Internal to gl/methods/.
 */
#ifndef ABBE_GL_METHODS_IMAGE_SPACE_METHOD_H
#define ABBE_GL_METHODS_IMAGE_SPACE_METHOD_H

#include "gl/methods/image_space/image_places.h"
#include "gl/scene/local_scene.h"
#include "scenes/view/map_layout.h"

/* The camera's passes of the published methods that sum a caustic map: receivers lit
 * by light, shadow and map, and what is seen in refractors and mirrors. */

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

#define ABBE_METHOD_KEPT 3 /* frames beside this one */

/* Photons of the frames before. */
typedef struct abbe_method_history {
  GLuint sums[ABBE_METHOD_KEPT];
  size_t size[2], count; /* size; number of those that are drawn */
  size_t frame;          /* number of the next frame in the sequence */
  bool printed;          /* in 16 bits */
} abbe_method_history;

typedef struct abbe_method abbe_method;

typedef struct abbe_method_kind {
  size_t size; /* size of a struct that begins with an abbe_method, whose kind and scene alone are
                  set */
  abbe_result (*make)(abbe_method *method, const abbe_shader_variant *variant, abbe_error *error);
  /* What it has beside abbe_method's. */
  void (*free)(abbe_method *method);
  /* A frame; lit: the light's passes have run and hold. */
  abbe_result (*run)(abbe_method *method, bool lit, abbe_error *error);
  /* Whether a camera that moves leaves what the light's passes make as it is; NULL: it does not. */
  bool (*keeps_light)(const abbe_render_desc *desc);
  /* The light's map, after the method's gap fill where filled and it has one; NULL: it has none. */
  abbe_result (*map)(abbe_method *method, bool filled, GLuint *texture, abbe_error *error);
} abbe_method_kind;

struct abbe_method {
  const abbe_method_kind *kind;
  const abbe_gpu_scene *scene;
  abbe_map_layout layout;  /* layout of the light's one frustum; of a cube, its first face's */
  abbe_image_places light; /* what the light sees, and the camera's passes: of those that sum a */
  abbe_image_eye eye;      /* caustic map; else zero */
  float (*colour)[3];      /* and [wavelengths] of unit light: XYZ, or RGB as printed; malloc'd */
  GLuint picture;          /* its own to free, unless it is the eye's */
  size_t photon_count;     /* number in the last frame with statistics: pixels that show objects */
  double polygon_layers;   /* over a pixel, mean of the last frame with statistics */
  abbe_method_history *history; /* history of a filter over frames; NULL: it has none */
};

/* The methods that there are, each in its folder. */
extern const abbe_method_kind abbe_thesis_kind, abbe_shah2007_kind, abbe_wyman2006_kind,
    abbe_wand2003_kind;

/* Receivers, shadow and objects from the light, and how many photons there are. ABBE_GL. */
abbe_result abbe_method_see_from_light(abbe_method *method, abbe_error *error);

#endif
