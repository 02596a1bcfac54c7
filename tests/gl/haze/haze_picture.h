/* haze_picture.h: what a small picture of haze comes to, for tests against closed forms. */
#ifndef ABBE_TESTS_GL_HAZE_HAZE_PICTURE_H
#define ABBE_TESTS_GL_HAZE_HAZE_PICTURE_H

#include "tests/gl/frame.h"

/* Mean of each channel of a picture of 16 by 16 pixels. */
static inline void mean_of(const char *text, const abbe_render_desc *asked, double out[3]) {
  abbe_render_desc desc = *asked;
  desc.width = desc.height = 16;
  desc.supersample = 1;
  desc.map_size = 64;
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, picture) = picture_of(renderer);
  for (size_t k = 0; k < 3; k++) {
    out[k] = 0;
    for (size_t i = 0; i < 256; i++) out[k] += (double)picture.data[i * picture.channels + k] / 256;
  }
}

/* The green one, in Rec.709: of white light Y. */
static inline double green_as(const char *text, size_t photons, abbe_coarse coarse) {
  double rgb[3];
  mean_of(
      text,
      &(abbe_render_desc){
          .photons = photons, .wavelengths = 3, .space = ABBE_RGB_SPACE_REC709, .coarse = coarse},
      rgb);
  return rgb[1];
}

static inline double green_of(const char *text, size_t photons) {
  return green_as(text, photons, ABBE_COARSE_NONE);
}

#endif
