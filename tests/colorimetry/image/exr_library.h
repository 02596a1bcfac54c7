/* exr_library.h: OpenEXR's own C++ library, which reads and writes the files that Abbe's are held
 * against. It shares no code with the C core that Abbe uses.
 */
#ifndef ABBE_TESTS_COLORIMETRY_IMAGE_EXR_LIBRARY_H
#define ABBE_TESTS_COLORIMETRY_IMAGE_EXR_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { EXR_LIBRARY_MAX_CHANNELS = 8 };

/* Windows are x0, y0, x1, y1, both ends included; the numbers of types and codecs are OpenEXR's. */
typedef struct exr_library_file {
  int data_window[4], display_window[4];
  int channels;
  const char *name[EXR_LIBRARY_MAX_CHANNELS];
  int type[EXR_LIBRARY_MAX_CHANNELS]; /* 0 whole numbers, 1 half, 2 float */
  int sampling;                       /* of the last channel, both ways; 0: 1 */
  int codec, line_order;
  int tile[2];           /* 0: in scan lines */
  int levels;            /* of tiles: 0 one, 1 a mipmap, 2 a ripmap */
  bool flat;             /* one and the same value everywhere */
  const char *part, *id; /* name and colorInteropID, of a file of several parts */
  /* CHANNEL.wavelength, Ocean's, as a float, of odd channels as a double; 0: none */
  float metres[EXR_LIBRARY_MAX_CHANNELS];
} exr_library_file;

/* Writes f to path, filled with values that differ from sample to sample. On failure false, and
 * why[size] says the reason. */
bool exr_library_write(const char *path, const exr_library_file *f, char *why, size_t size);

/* The same of a file of several parts, at least 2. */
bool exr_library_write_parts(const char *path, const exr_library_file *f, int parts, char *why,
                             size_t size);

/* Reads channels of a part, of which the first is 0, as floats: out is malloc'd, a plane of the
 * data window's size for each name. */
bool exr_library_read(const char *path, int part, const char *const *name, int count,
                      int data_window[4], int display_window[4], float **out, char *why,
                      size_t size);

#ifdef __cplusplus
}
#endif
#endif
