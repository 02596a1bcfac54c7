/* image.h: linear float images with named channels.
 *
 * Pixels are interleaved float32, row 0 at the top. It holds samples, names and text attributes;
 * files are exr.h's and png_file.h's business.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_IMAGE_H
#define ABBE_COLORIMETRY_IMAGE_IMAGE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_IMAGE_MAX_SIDE 32768
#define ABBE_IMAGE_MAX_CHANNELS 1024
#define ABBE_IMAGE_MAX_ATTRIBUTES 4096

typedef struct abbe_image_attribute {
  char *name;
  char *text;
} abbe_image_attribute;

/* A part of the plane that pixels are counted in, x to the right and y downwards; both ends are
 * included. */
typedef struct abbe_image_window {
  int32_t x0, y0, x1, y1;
} abbe_image_window;

typedef struct abbe_image {
  size_t width, height, channels;
  char **channel;  /* [channels] names: "R", "G", "B", "A", "caustic.R", … */
  float *data;     /* [height][width][channels] */
  double xy[8];    /* chromaticities of R, G, B, white; all 0: not stated */
  double curve[5]; /* encoding of values for a display (rgb_encoding.h); all 0: not encoded, or not
                      stated */
  int transfer; /* curve of values encoded for an HDR display, by [H273]: 16 PQ, 18 HLG; 0: curve */
  abbe_image_window display_window; /* where the pixels lie; (0, 0) is the first of one made here */
  abbe_image_window
      data_window; /* what the file it comes from had values for; elsewhere they are 0 */
  char part[40];   /* which part of a file of several this is: "2 'depth' of 3"; else "" */
  size_t attribute_count;
  abbe_image_attribute *attribute; /* text for the file's header */
} abbe_image;

/* A black image. names[channels] are copied. Sizes are checked before anything is allocated:
 * ABBE_INVALID_ARGUMENT for a zero or too large side or channel count, ABBE_NO_MEMORY. */
abbe_result abbe_image_make(size_t width, size_t height, size_t channels, const char *const *names,
                            abbe_image *out, abbe_error *error);
void abbe_image_free(abbe_image *image);

/* A small file may unfold into pixels that no memory holds. ABBE_UNSUPPORTED where width x height
 * pixels of so many float32 channels take more than free_bytes and more than
 * ABBE_IMAGE_MAX_EXPANSION times the file's own bytes. */
#define ABBE_IMAGE_MAX_EXPANSION 256
abbe_result abbe_image_check_expansion(const char *path, size_t width, size_t height,
                                       size_t channels, size_t file_bytes, size_t free_bytes,
                                       abbe_error *error);

/* What two pictures show is compared pixel by pixel of the plane: ABBE_INVALID_ARGUMENT, with the
 * names given, where a lies elsewhere than b. */
abbe_result abbe_image_check_place(const abbe_image *a, const char *name_a, const abbe_image *b,
                                   const char *name_b, abbe_error *error);

/* Adds or replaces a text attribute. ABBE_INVALID_ARGUMENT without a name or text, and for one more
 * than ABBE_IMAGE_MAX_ATTRIBUTES. */
abbe_result abbe_image_set_attribute(abbe_image *image, const char *name, const char *text,
                                     abbe_error *error);
/* The text of an attribute, or NULL. */
const char *abbe_image_attribute_text(const abbe_image *image, const char *name);

/* Adds another picture's channels behind the image's own, and its attributes where the image has
 * none of their names. ABBE_INVALID_ARGUMENT, the image untouched, where the sizes differ, where
 * they have a channel in common, and for too many channels. */
abbe_result abbe_image_append(abbe_image *image, const abbe_image *other, abbe_error *error);

/* Pixels with a sample that is infinite, and others with one that is not a number. */
typedef struct abbe_image_odd {
  size_t infinite, nan;
} abbe_image_odd;

/* Counts those of the given channels. */
void abbe_image_count_odd(const abbe_image *image, const size_t *channel, size_t count,
                          abbe_image_odd *out);

/* Index of the named channel, or (size_t)-1. */
size_t abbe_image_find_channel(const abbe_image *image, const char *name);

/* The channel of a band of wavelengths, by the one in its middle: "S0.550,000000nm" [Fichet2021].
 */
void abbe_image_band_name(double middle_nm, char *out, size_t size);
/* The middle of the band, nm, that a channel of such a name is of; false: of none. */
bool abbe_image_band_middle(const char *channel, double *middle_nm);

#endif
