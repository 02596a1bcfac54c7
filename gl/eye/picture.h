/* picture.h: the picture's pixels from receivers and refractors: samples resolved or enlarged; and
 * what a reader gets of it. Internal to gl/.
 */
#ifndef ABBE_GL_EYE_PICTURE_H
#define ABBE_GL_EYE_PICTURE_H

#include "colorimetry/image/image.h"
#include "gl/eye/receivers_pass.h"
#include "gl/eye/refraction_pass.h"

#include <stdbool.h>

typedef struct abbe_picture {
  const abbe_receivers_pass *receivers;
  const abbe_refraction_pass *refraction;
  GLuint program, pixels; /* pixels 0: receivers have a sample a pixel, and their colour is the
                             picture; program 0: as it is */
  GLuint view;            /* view of that colour as a 2D texture, once it was requested */
} abbe_picture;

abbe_result abbe_picture_make(const abbe_receivers_pass *receivers,
                              const abbe_refraction_pass *refraction, abbe_picture *out,
                              abbe_error *error);
void abbe_picture_free(abbe_picture *picture);
abbe_result abbe_picture_run(abbe_picture *picture, abbe_error *error);

/* Its size, across and up: that of the request, or of its samples where it is coarse. */
void abbe_picture_size(const abbe_picture *picture, size_t out[2]);
/* The picture as a 2D texture, rows upward, in the space of the passes; the picture keeps it. It
 * may be wider and higher. */
GLuint abbe_picture_texture(abbe_picture *picture);

/* Channels as abbe_renderer_read, in the plan's space; all but distances times `unit`. */
abbe_result abbe_picture_read(const abbe_picture *picture, bool aovs, double unit, abbe_image *out,
                              abbe_error *error);

/* GL's rows run upwards: `count` of four floats a sample from `first` on, the mean of samples x
 * samples a pixel, into the image's channels from `to` on. */
void abbe_picture_copy_flipped(const float *from, size_t first, abbe_image *image, size_t to,
                               size_t count, size_t samples);

/* Three channels from `first` on, from ACEScg to XYZ. */
void abbe_picture_to_xyz(abbe_image *image, size_t first);

#endif
