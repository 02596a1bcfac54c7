/* AVIF pictures. What libavif and its decoders allocate does not fail. */
#include "tests/fuzz/memory_file.h"

#include "colorimetry/screen/screen_file.h"

#include <math.h>

const char *const fuzz_words[] = {"ftyp", "avif", "meta", "iloc", "ispe", "colr", "nclx",
                                  "prof", "irot", "clap", "pixi", "mdat", NULL};

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_image image;
  abbe_error error = {0};
  const char *path = memory_file(data, size);
  if (FUZZED(abbe_avif_read(path, &image, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && image.data == NULL && image.channel == NULL);
    return 0;
  }
  FUZZ_PROMISE(image.width >= 1 && image.height >= 1 && image.channels == 3);
  const size_t count = image.width * image.height * image.channels;
  fuzz_same(image.data, count * sizeof *image.data);
  for (size_t i = 0; i < count; i++) FUZZ_PROMISE(isfinite(image.data[i]));
  abbe_image_free(&image);
  return 0;
}
