/* image_places.h: what a light or the camera sees, as places: of receivers one a pixel, of
 * refractors and mirrors in front and behind one a pixel of a grid of its own, with normals; and
 * the depth of all. Through one view, or all around. A pass of the published methods. Internal to
 * gl/.
 */
#ifndef ABBE_GL_IMAGE_SPACE_IMAGE_PLACES_H
#define ABBE_GL_IMAGE_SPACE_IMAGE_PLACES_H

#include "gl/methods/image_space/image_view.h"
#include "gl/plan/examine/light_views.h"
#include "gl/scene/gpu_scene.h"
#include "gl/scene/shader_variant.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

/* Through how many views a light sees in the published methods: one, or of receivers the six of a
 * cube around it, and of refractors and mirrors one around them or six. Faces and their axes are
 * those of gl/plan/examine/light_views.h. */

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
