/* wyman2006.h: photons in image space as they were published, and in units: passes of their own,
 * from the light's grid to the picture. Internal to gl/methods/.
 */
#ifndef ABBE_GL_METHODS_WYMAN2006_WYMAN2006_H
#define ABBE_GL_METHODS_WYMAN2006_WYMAN2006_H

#include "gl/methods/image_space/method.h"

/* An image that photons are drawn into, the light's or the camera's: as points, as polygons of
 * neighbours, or as points that are gathered, with a filter over frames.
 *
 * A texel holds the solid angle of photons, from the light, by its window area, and so light by
 * irradiance once the texel's area is known; of polygons in the camera's image, the ratio of solid
 * angles itself. */

/* A photon a pixel of the light's grid, one wavelength and one view at a time: where it meets its
 * first diffuse surface, from where, and how much of it. */

typedef struct abbe_wyman_photons {
  const abbe_gpu_scene *scene;
  const abbe_image_places *light;
  double background[4]; /* the plane that mirrors send light to, as printed: n . x = w */
  GLuint program;
  GLuint places, incident; /* places for the wavelength that was run last; wyman_photons.frag */
} abbe_wyman_photons;

/* definitions: of image_places.h. */
abbe_result abbe_wyman_photons_make(const abbe_gpu_scene *scene, const abbe_image_places *light,
                                    const abbe_shader_variant *variant, const char *definitions,
                                    abbe_wyman_photons *out, abbe_error *error);
void abbe_wyman_photons_free(abbe_wyman_photons *photons);

typedef struct abbe_wyman_target {
  const abbe_gpu_scene *scene;
  const abbe_wyman_photons *photons;
  const abbe_image_places *places; /* places of the image: its view and the receivers in it */
  bool camera, directions, polygons, gathers;
  GLuint draw, area, gather, filter; /* programs */
  GLuint sum, direction_sum, areas, filtered[2], gathered[2];
  abbe_method_history history;
  GLuint query;  /* fragments of polygons; 0: none are drawn */
  double layers; /* polygons over a pixel, mean of the last frame with statistics */
  GLuint light,
      light_directions; /* light of the last run, two of those above; directions: 0: none */
} abbe_wyman_target;

abbe_result abbe_wyman_target_make(const abbe_wyman_photons *photons,
                                   const abbe_image_places *places, bool camera,
                                   const abbe_shader_variant *variant, abbe_wyman_target *out,
                                   abbe_error *error);
void abbe_wyman_target_free(abbe_wyman_target *target);
/* The image's receivers and the light's places are drawn by then. colour: of each wavelength; kept:
 * photons are those of the last run, of one wavelength. */
abbe_result abbe_wyman_target_run(abbe_wyman_target *target, float (*colour)[3], bool next_frame,
                                  bool kept, abbe_error *error);

#endif
