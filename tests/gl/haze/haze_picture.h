/* haze_picture.h: what a small picture of haze comes to, for tests against closed forms. */
#ifndef ABBE_TESTS_GL_HAZE_HAZE_PICTURE_H
#define ABBE_TESTS_GL_HAZE_HAZE_PICTURE_H

#include "tests/gl/frame.h"

/* Mean of the green channel of a picture of 16 by 16 pixels, in Rec.709: of white light Y. */
static double green_of(const char *text, size_t photons) {
  abbe_scene scene;
  abbe_image picture;
  abbe_render_desc desc = {.width = 16,
                           .height = 16,
                           .photons = photons,
                           .map_size = 64,
                           .wavelengths = 3,
                           .supersample = 1,
                           .space = ABBE_RGB_SPACE_REC709};
  load_text(text, &scene);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  draw_frame(renderer);
  read_picture(renderer, false, &picture);
  double sum = 0;
  for (size_t i = 0; i < 256; i++) sum += (double)picture.data[i * picture.channels + 1] / 256;
  abbe_image_free(&picture);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
  return sum;
}

#endif
