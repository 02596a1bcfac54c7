/* lib_picture.h: a picture as a program outside has it: channels of floats, files, attributes.
 *
 * Pixels are interleaved float32, row 0 at the top, scene-linear unless the attribute abbe:space or
 * the file says otherwise. It knows no scene; lib_scene.h makes pictures, lib_comparison.h compares
 * them.
 */
#ifndef ABBE_LIBRARY_LIB_PICTURE_H
#define ABBE_LIBRARY_LIB_PICTURE_H

#include "base/error.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_lib_picture abbe_lib_picture;

/* names[channels] and pixels[height][width][channels] are copied; pixels NULL: black.
 * ABBE_INVALID_ARGUMENT for a side of 0 or above 32768, no channel or above 1024; ABBE_NO_MEMORY.
 */
abbe_result abbe_lib_picture_make(size_t width, size_t height, size_t channels,
                                  const char *const *names, const float *pixels,
                                  abbe_lib_picture **out, abbe_error *error);
/* An OpenEXR file as it is, its channels in the order of their names; a Radiance picture; an ENVI
 * header's cube, its bands as channels; a .png as sRGB-encoded values from 0 to 1. ABBE_IO,
 * ABBE_PARSE, ABBE_UNSUPPORTED; of ENVI also ABBE_NOT_FOUND and ABBE_INVALID_ARGUMENT. */
abbe_result abbe_lib_picture_load(const char *path, abbe_lib_picture **out, abbe_error *error);
void abbe_lib_picture_free(abbe_lib_picture *picture);

/* Sizes in pixels; 0 of no picture. */
size_t abbe_lib_picture_width(const abbe_lib_picture *picture);
size_t abbe_lib_picture_height(const abbe_lib_picture *picture);
size_t abbe_lib_picture_channels(const abbe_lib_picture *picture);
/* "R", "stderr.R", "caustic.R", "S0.550,000000nm", …; NULL past the last one. */
const char *abbe_lib_picture_channel(const abbe_lib_picture *picture, size_t index);
/* The picture's own, to be read and written until it is freed. */
float *abbe_lib_picture_pixels(abbe_lib_picture *picture);

/* Names of its text attributes in their order, NULL past the last one; the text of one, or NULL. */
const char *abbe_lib_picture_attribute_name(const abbe_lib_picture *picture, size_t index);
const char *abbe_lib_picture_attribute(const abbe_lib_picture *picture, const char *name);
/* Adds or replaces one. "abbe:space" with acescg, rec709 or xyz says what R, G, B are.
 * ABBE_INVALID_ARGUMENT. */
abbe_result abbe_lib_picture_set_attribute(abbe_lib_picture *picture, const char *name,
                                           const char *text, abbe_error *error);

/* As OpenEXR, float32, whole or not at all. ABBE_IO. */
abbe_result abbe_lib_picture_save(const abbe_lib_picture *picture, const char *path,
                                  abbe_error *error);
/* For a screen, through OpenColorIO: .png, .webp, .jpg, .gif or .avif by its ending. Settings:
 * config (a file; else $OCIO, else the one that ships), display, view, layer (its channels LAYER.R
 * …), exposure (stops, -60 to 60; else what the scene's camera says), bits (8 or 16). ABBE_COLOUR,
 * ABBE_UNSUPPORTED for what the build has no library for, ABBE_NOT_FOUND without colour, ABBE_IO.
 */
abbe_result abbe_lib_picture_save_png(const abbe_lib_picture *picture, const char *path,
                                      const char *const *settings, size_t count, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
