/* screen_file.h: files that hold a picture encoded for a display, by their names' endings: PNG,
 * AVIF, WebP, GIF and JPEG, still, and frames of PNG as one that moves.
 *
 * It encodes nothing for a display (screen_png.h) and reads frames and AVIF. PNG and GIF are
 * Abbe's own or libpng's; the others are written where the build has found their libraries.
 */
#ifndef ABBE_COLORIMETRY_SCREEN_SCREEN_FILE_H
#define ABBE_COLORIMETRY_SCREEN_SCREEN_FILE_H

#include "colorimetry/image/image.h"

#include <stdbool.h>

/* A kind of file. Writers take the first three channels, clamped to [0, 1], not-a-number as 0, and
 * write beside and rename; ABBE_INVALID_ARGUMENT for what the kind does not hold, ABBE_IO where it
 * cannot be written or encoded. */
typedef struct abbe_screen_kind {
  const char *ending;  /* ".webp" */
  const char *name;    /* "WebP", as sentences have it */
  const char *bits;    /* "8 or 16", as sentences have it */
  int bit[2];          /* numbers of bits; the first is the default */
  bool alpha;          /* a fourth channel A is written, straight */
  const char *library; /* which the build lacks, and there is no writer then; NULL: it is there */
  abbe_result (*write)(const char *path, const abbe_image *image, int bits, abbe_error *error);
  /* frame[count], PNG files of one size, 1 to 1e6, at 0.1 to 1000 a second; for ever. NULL: this
   * kind holds one picture. */
  abbe_result (*move)(const char *path, const char *const *frame, size_t count, double per_second,
                      abbe_error *error);
  double most_per_second; /* of what moves */
} abbe_screen_kind;

/* The kind that a path's ending names, in whatever case; NULL: none of them. */
const abbe_screen_kind *abbe_screen_kind_of(const char *path);

/* Whether a file of that name is written by this build, with so many bits (0: its default), with
 * channel A, for an HDR display (transfer of abbe_image; 0: none), moving at so many frames a
 * second. ABBE_UNSUPPORTED without the library, else ABBE_INVALID_ARGUMENT, with what to take. A
 * path of another ending is a PNG. */
typedef struct abbe_screen_file_needs {
  int bits, transfer;
  bool alpha, moves;
  double per_second; /* of what moves */
} abbe_screen_file_needs;
abbe_result abbe_screen_file_check(const char *path, const abbe_screen_file_needs *needs,
                                   abbe_error *error);

/* Writes a picture by its ending, else as PNG, with so many bits; 0: the kind's default, and for PQ
 * and HLG a PNG's 16. A file states its colour: PNG by its chunks (png_file.h); AVIF by CICP [H273]
 * or an ICC profile; JPEG by an ICC profile; WebP likewise where it is not sRGB, which it is
 * without; GIF is sRGB, and other known encodings are refused. PQ and HLG are held by PNG and AVIF
 * alone. */
abbe_result abbe_screen_file_write(const char *path, const abbe_image *image, int bits,
                                   abbe_error *error);

/* Frames as one file that moves: APNG [PNG2025], which takes their compressed pixels as they are
 * and the colour of the first; WebP of quality 90 and GIF, both in sRGB. ABBE_INVALID_ARGUMENT for
 * a count or a rate out of range and frames that differ in size or kind, ABBE_PARSE for what is no
 * PNG. */
abbe_result abbe_screen_file_move(const char *path, const char *const *frame, size_t count,
                                  double per_second, abbe_error *error);

/* Reads the first picture of an AVIF: R, G, B from 0 to 1, encoded as the image's xy and curve or
 * transfer say; a profile's are made sRGB, and so are those that state nothing. ABBE_IO, ABBE_PARSE
 * for a broken file; ABBE_UNSUPPORTED for codes that are no display's RGB, for a picture that is to
 * be turned or cut out, for pixels that are too many for the file, and without libavif. */
abbe_result abbe_avif_read(const char *path, abbe_image *out, abbe_error *error);

/* ---- Internal to the folder ---- */

abbe_result abbe_avif_write(const char *path, const abbe_image *image, int bits, abbe_error *error);
abbe_result abbe_jpeg_write(const char *path, const abbe_image *image, int bits, abbe_error *error);
abbe_result abbe_webp_write(const char *path, const abbe_image *image, int bits, abbe_error *error);
abbe_result abbe_gif_write(const char *path, const abbe_image *image, int bits, abbe_error *error);
abbe_result abbe_animated_png_write(const char *path, const char *const *frame, size_t count,
                                    double per_second, abbe_error *error);
abbe_result abbe_webp_move(const char *path, const char *const *frame, size_t count,
                           double per_second, abbe_error *error);
abbe_result abbe_gif_move(const char *path, const char *const *frame, size_t count,
                          double per_second, abbe_error *error);

/* Pixels of 8 bits, samples (3 or 4) each, malloc'd. ABBE_NO_MEMORY. */
abbe_result abbe_screen_file_bytes(const char *path, const abbe_image *image, size_t samples,
                                   unsigned char **out, abbe_error *error);
/* Channels that are written: 4 where the fourth is A, else 3. */
size_t abbe_screen_file_samples(const abbe_image *image);
/* The bytes of a frame; width and height 0: the first, which sets them. Errors as above. */
abbe_result abbe_screen_file_frame(const char *path, size_t *width, size_t *height,
                                   unsigned char **out, abbe_error *error);

/* What the eye scatters of bright light, spread over a picture [Spencer1995].
 *
 * The point spread of an eye in daylight: 0.384 f0 + 0.478 f1 + 0.138 f2 a steradian at theta
 * degrees, with f0 = 2.61e6 exp(-(theta/0.02)^2), f1 = 20.91/(theta + 0.02)^3 and f2 =
 * 72.37/(theta + 0.02)^2. It has no lines and no halo of a dark-adapted eye, and no wavelength. */

#define ABBE_GLARE_MIN_DEG 0.1
#define ABBE_GLARE_MAX_DEG 120
#define ABBE_GLARE_MAX_PIXELS ((size_t)1 << 24)

/* The point spread, 1/sr, at an angle. */
double abbe_glare_spread(double theta_deg);

/* Spreads the first three channels, linear light, of a picture that is seen so many degrees high.
 * Each pixel's light stays in the picture: it goes on at the edges as in a mirror, and what would
 * go farther than the picture is wide or high stays at its pixel. Not-a-number is dark, and what is
 * infinite the greatest finite value. Exact but for the angle, which is in proportion to pixels.
 * ABBE_INVALID_ARGUMENT for too many pixels, ABBE_NO_MEMORY. */
abbe_result abbe_glare_add(abbe_image *image, double high_deg, abbe_error *error);

#endif
