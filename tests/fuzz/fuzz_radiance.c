/* Radiance pictures: what is read has pixels that are not negative. */
#include "tests/fuzz/memory_file.h"

#include "colorimetry/image/radiance_file.h"

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
                                  NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  abbe_image image;
  abbe_error error = {0};
  if (abbe_radiance_read(memory_file(data, size), &image, &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && image.data == NULL && image.channel == NULL);
    return 0;
  }
  FUZZ_PROMISE(image.width >= 1 && image.width <= ABBE_IMAGE_MAX_SIDE && image.height >= 1 &&
               image.height <= ABBE_IMAGE_MAX_SIDE && image.channels == 3);
  for (size_t i = 0; i < image.width * image.height * 3; i++) FUZZ_PROMISE(image.data[i] >= 0);
  for (int i = 0; i < 8; i++) FUZZ_PROMISE(isfinite(image.xy[i]));
  abbe_image_free(&image);
  return 0;
}
