/* Radiance pictures: what is read has pixels that are not negative. Headers of ENVI beside a cube
 * of 256 bytes: what is read has no more numbers than the cube. */
#include "tests/fuzz/memory_file.h"

#include "colorimetry/image/picture_file.h"

#include <math.h>

const char *const fuzz_words[] = {"#?RADIANCE\n",
                                  "FORMAT=32-bit_rle_rgbe\n",
                                  "FORMAT=32-bit_rle_xyze\n",
                                  "EXPOSURE=2\n",
                                  "COLORCORR=1 2 3\n",
                                  "PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n",
                                  "\n-Y 4 +X 8\n",
                                  "+X 8 -Y 4\n",
                                  "+Y ",
                                  "-X ",
                                  "\x02\x02",
                                  "\x01\x01\x01\x04",
                                  "\x88\xff",
                                  "\x80",
                                  "1e300",
                                  "ENVI\n",
                                  "samples = 4\n",
                                  "lines = 3\n",
                                  "bands = 5\n",
                                  "header offset = 7\n",
                                  "data type = 4\n",
                                  "interleave = bip\n",
                                  "wavelength = {500, 600}\n",
                                  "wavelength units = um\n",
                                  "reflectance scale factor = 100\n",
                                  "band names = {a, b}\n",
                                  "data gain values = {1, 2}\n",
                                  "{",
                                  "}",
                                  NULL};

static char folder[] = "/tmp/abbe-fuzz-picture-XXXXXX", header[64], cube[64];

static void tidy(void) {
  unlink(header);
  unlink(cube);
  rmdir(folder);
}

/* The bytes in memory and a cube, as files of one folder. */
static const char *picture_file(const uint8_t *data, size_t size) {
  const char *memory = memory_file(data, size);
  if (header[0] != '\0') return header;
  FUZZ_PROMISE(mkdtemp(folder) != NULL && atexit(tidy) == 0);
  snprintf(header, sizeof header, "%s/x.hdr", folder);
  snprintf(cube, sizeof cube, "%s/x", folder);
  FILE *file = fopen(cube, "wb");
  FUZZ_PROMISE(file != NULL && symlink(memory, header) == 0);
  for (int i = 0; i < 256; i++) fputc(i, file);
  fclose(file);
  return header;
}

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_image image;
  abbe_error error = {0};
  const char *path = picture_file(data, size);
  const bool envi = size > 4 && memcmp(data, "ENVI", 4) == 0;
  if (FUZZED((envi ? abbe_envi_read : abbe_radiance_read)(path, &image, &error), &error) !=
      ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && image.data == NULL && image.channel == NULL);
    return 0;
  }
  FUZZ_PROMISE(image.width >= 1 && image.width <= ABBE_IMAGE_MAX_SIDE && image.height >= 1 &&
               image.height <= ABBE_IMAGE_MAX_SIDE);
  const size_t count = image.width * image.height * image.channels;
  fuzz_same(image.data, count * sizeof *image.data);
  FUZZ_PROMISE(envi ? count <= 256 : image.channels == 3);
  for (size_t i = 0; i < count && !envi; i++) FUZZ_PROMISE(image.data[i] >= 0);
  for (int i = 0; i < 8; i++) FUZZ_PROMISE(isfinite(image.xy[i]));
  abbe_image_free(&image);
  return 0;
}
