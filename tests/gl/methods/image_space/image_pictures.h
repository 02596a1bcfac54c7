/* image_pictures.h: small pictures by photons in image space, of a pane and of a mirror over a
 * floor.
 */
#ifndef ABBE_TESTS_GL_IMAGE_SPACE_IMAGE_PICTURES_H
#define ABBE_TESTS_GL_IMAGE_SPACE_IMAGE_PICTURES_H

#include "tests/gl/frame.h"

#define PANE(material)                                                                             \
  "- {name: pane, shape: box, size: [0.3, 0.3, 0.001], transform: [{translate: [0.05, 0.03, "      \
  "0.3]}], material: " material "}\n"
#define MIRROR(share)                                                                              \
  "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: " share                     \
  ", transform: [{rotate: {axis: [0, 1, 0], angle: 60}}, {translate: [0.1, 0, 0.15]}]}\n"

static const abbe_render_desc small =
    FIELDS(.profile = ABBE_PROFILE_WYMAN2006_CIE, .width = 64, .height = 64, .photons = 512,
           .map_size = 128, .supersample = 1, .upsample = 1, .space = ABBE_RGB_SPACE_XYZ);

static inline double map_energy(const abbe_scene *scene, const abbe_render_desc *desc) {
  abbe_renderer *renderer = drawn_renderer(scene, desc);
  OWNED(abbe_image, map) = map_of(renderer, 0);
  abbe_renderer_free(renderer);
  return image_sum(&map, 1);
}

static inline void make_picture(const abbe_scene *scene, const abbe_render_desc *desc,
                                abbe_image *out) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, desc);
  *out = picture_of(renderer);
  assert_finite(out);
}

/* Mean of a channel over the middle of the picture, and how far its pixels are from it. */
static inline double middle(const abbe_image *image, double *spread) {
  double sum = 0, least = INFINITY, most = -INFINITY;
  const size_t from = image->width / 2 - 12, to = from + 24;
  for (size_t y = from; y < to; y++)
    for (size_t x = from; x < to; x++) {
      const double value = (double)image->data[(y * image->width + x) * image->channels + 1];
      sum += value / (24 * 24);
      least = fmin(least, value);
      most = fmax(most, value);
    }
  *spread = (most - least) / sum;
  return sum;
}

#endif
