/* image_places.h: what a light or the camera sees, as places: of receivers one a pixel, of
 * refractors and mirrors in front and behind one a pixel of a grid of its own, with normals; and
 * the depth of all. Through one view, or all around. A pass of the published methods. Internal to
 * gl/.
 */
#ifndef ABBE_GL_IMAGE_SPACE_IMAGE_PLACES_H
#define ABBE_GL_IMAGE_SPACE_IMAGE_PLACES_H

#include "colorimetry/image/image.h"
#include "gl/plan/examine/examine.h"
#include "gl/scene/gpu_scene.h"
#include "gl/scene/shader_variant.h"
#include "scenes/view/map_layout.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

/* What the published methods share, as all of them work in images: the light's
 * frustum, matrices, the light, a pass over a whole image, reading. */

typedef struct abbe_image_view {
  abbe_view view;
  double look[16], clip[16]; /* world to view, view to clip; column-major */
} abbe_image_view;

void abbe_image_view_make(const abbe_view *view, abbe_image_view *out);

/* A square around the spot's cone, or around all objects: of other lights, and in units also where
 * the cone is narrow, for a prism throws all of its light out of it. */
void abbe_image_view_fit_light(const abbe_gpu_scene *scene, abbe_view *out);

/* Uniforms of the program that is in use: a matrix; the view's own, world to clip; a view as
 * view.glsl has it. */
void abbe_image_view_set_matrix(const abbe_gpu_scene *scene, GLuint program, const char *name,
                                const double m[16]);
void abbe_image_view_set_clip(const abbe_gpu_scene *scene, GLuint program, const char *name,
                              const abbe_image_view *view);
void abbe_image_view_set_view(const abbe_gpu_scene *scene, GLuint program, const char *name,
                              const abbe_view *view);
/* The same of one of several views that follow one another. */
void abbe_image_view_set_face(const abbe_gpu_scene *scene, GLuint program, const char *name,
                              size_t face, const abbe_view *view);
/* spot, spot_inner and spot_colour: the light, white in Rec.709 at full strength, with a cone along
 * the direction; a point light's reaches everywhere. */
void abbe_image_view_set_lamp(const abbe_gpu_scene *scene, GLuint program,
                              const double direction[3]);
/* reflectance and texture_info of a receiver of the plan; *layer: of textures, the next. */
void abbe_image_view_set_surface(const abbe_gpu_scene *scene, GLuint program, size_t receiver,
                                 int *layer);
/* What only physical units need: rgb_from_xyz, xyz_from_rgb, forward, white, power, ambient. */
void abbe_image_view_set_units(const abbe_gpu_scene *scene, GLuint program, const abbe_view *light);

/* A triangle over all of the target; layer: of an array, -1: of none. */
abbe_result abbe_image_view_draw_screen(const abbe_gpu_scene *scene, GLuint target, int layer,
                                        size_t width, size_t height, abbe_error *error);

/* As of abbe_renderer_read and _read_map. */
abbe_result abbe_image_view_read(const abbe_gpu_scene *scene, GLuint picture, abbe_image *out,
                                 abbe_error *error);
abbe_result abbe_image_view_read_map(const abbe_gpu_scene *scene, GLuint map,
                                     const abbe_map_layout *layout, abbe_image *out,
                                     abbe_error *error);

/* What programs of the published methods get of the request: definitions, and the colours of
 * wavelengths. */

/* WAVELENGTHS, INTERFACES, AS_PRINTED and the estimators' numbers; the characters that are used. */
size_t abbe_image_tables_define(const abbe_render_desc *desc, char *out, size_t size);

/* Colours of unit light at each wavelength: XYZ, or RGB as printed; by_white: of the sum of all.
 * malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_image_tables_colours(const abbe_gpu_scene *scene, bool by_white, float (**out)[3],
                                      abbe_error *error);

/* What the methods are made of, from tables. */

typedef struct abbe_image_texture {
  GLuint *texture; /* NULL: it is not wanted */
  GLenum format;
  size_t width, height, layers; /* layers: 0: no array */
  bool linear;
} abbe_image_texture;
abbe_result abbe_image_textures_make(abbe_gpu *gpu, const abbe_image_texture *all, size_t count,
                                     abbe_error *error);

typedef struct abbe_image_program {
  GLuint *program;                          /* NULL: it is not wanted */
  const char *vertex, *geometry, *fragment; /* geometry: may be NULL */
  const char *more;                         /* definitions; may be NULL */
  bool plain;                               /* it needs none of the variant's */
} abbe_image_program;
abbe_result abbe_image_programs_make(const abbe_shader_variant *variant, abbe_gpu *gpu,
                                     const abbe_image_program *all, size_t count,
                                     abbe_error *error);

/* Through how many views a light sees in the published methods: one, or of receivers the six of a
 * cube around it, and of refractors and mirrors one around them or six. Faces and their axes are
 * those of gl/plan/examine/examine.h. */

typedef struct abbe_image_cube {
  size_t faces, object_faces; /* 1 or 6 each */
  abbe_view face[ABBE_LIGHT_CUBE_FACES], object_face[ABBE_LIGHT_CUBE_FACES];
} abbe_image_cube;

/* One view for all. */
void abbe_image_cube_one(const abbe_view *view, abbe_image_cube *out);
/* The cube around the scene's first light, a point or a spot. A face's map has `side` texels a
 * side, of which it shares `border` at each edge with its neighbours; 2 border < side. Objects are
 * seen through one view where that is at most 57 degrees off its middle, unless `whole` requires
 * six. */
void abbe_image_cube_make(const abbe_gpu_scene *scene, size_t side, size_t border, bool whole,
                          abbe_image_cube *out);

typedef struct abbe_image_places {
  const abbe_gpu_scene *scene;
  size_t faces, object_faces; /* 1, or six, layers of what follows: receivers', objects' */
  abbe_image_view view;       /* the first of receivers */
  abbe_image_view face[ABBE_LIGHT_CUBE_FACES], object_face[ABBE_LIGHT_CUBE_FACES];
  size_t size[2], grid[2];          /* pixels of receivers, and of objects, of a view */
  double shift[2];                  /* shift of the objects' pixels, in pixels, right and up */
  GLuint seen, objects, depth_only; /* programs */
  GLuint receivers;                 /* place, m; w: 1, or 0 where none is seen */
  GLuint depth;                     /* depth of receivers; of all, where shadows are drawn */
  GLuint places, normals, depths;   /* front and back of objects in each view */
  GLuint query;                     /* fragments of fronts; 0: they are not counted */
} abbe_image_places;

/* counts: how many pixels show objects is counted, as they are drawn. */
abbe_result abbe_image_places_make(const abbe_gpu_scene *scene, const abbe_image_cube *cube,
                                   const size_t size[2], const size_t grid[2], bool counts,
                                   abbe_image_places *out, abbe_error *error);
void abbe_image_places_free(abbe_image_places *places);
/* From now on through these, of as many faces. */
void abbe_image_places_look(abbe_image_places *places, const abbe_image_cube *cube);

abbe_result abbe_image_places_receivers(abbe_image_places *places, abbe_error *error);
/* Refractors and mirrors into the depth of all, too. */
abbe_result abbe_image_places_shadow(abbe_image_places *places, abbe_error *error);
abbe_result abbe_image_places_objects(abbe_image_places *places, abbe_error *error);
/* Waits for the device: the pixels that were counted, by an occlusion query. */
size_t abbe_image_places_count(const abbe_image_places *places);

/* For image_places.glsl, at units 2 to 4, into the program that is in use; what it is compiled for
 * besides: PLACES_CUBE and OBJECT_FACES of more faces than one. */
void abbe_image_places_set(const abbe_image_places *places, GLuint program);

#endif
