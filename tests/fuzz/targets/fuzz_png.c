/* PNG files, their chunks' checksums made right, so that what they say of their colour is looked
 * at, and ICC profiles by themselves: all that does not begin as a PNG. */
#include "tests/fuzz/memory_file.h"

#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <string.h>
#include <zlib.h>

const char *const fuzz_words[] = {
    "iCCP", "cICP", "gAMA", "cHRM", "sRGB", "tRNS", "PLTE", "zTXt", "RGB ", "GRAY",
    "XYZ ", "mntr", "para", "curv", "rTRC", "rXYZ", "mft2", "mAB ", "A2B0", "\x7f\xff\xff\xff",
    "\x80", NULL};

static uint32_t big_endian(const uint8_t *at) {
  return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static void mend(uint8_t *data, size_t size) {
  for (size_t at = 8; at + 12 <= size;) {
    const size_t length = big_endian(data + at);
    if (length > size - at - 12) return;
    const uint32_t sum = (uint32_t)crc32(0, data + at + 4, (uInt)length + 4);
    for (int i = 0; i < 4; i++) data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
    at += 12 + length;
  }
}

static void check_pixels(abbe_image *image) {
  FUZZ_PROMISE(image->width >= 1 && image->height >= 1 && image->channels == 3);
  FUZZ_PROMISE(abbe_rgb_encoding_is_srgb(image->xy, image->curve));
  fuzz_same(image->data, image->width * image->height * 3 * sizeof *image->data);
  for (size_t i = 0; i < image->width * image->height * 3; i++)
    FUZZ_PROMISE(image->data[i] >= 0 && image->data[i] <= 1);
  abbe_image_free(image);
}

static void try_profile(const uint8_t *data, size_t size) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_image image;
  abbe_error error = {0};
  FUZZ_PROMISE(abbe_image_make(4, 1, 3, names, &image, NULL) == ABBE_OK);
  for (int i = 0; i < 12; i++) image.data[i] = (float)i / 11;
  if (FUZZED(abbe_rgb_encoding_profile_to_srgb(&image, data, size, "f.png", &error), &error) ==
      ABBE_OK) {
    check_pixels(&image);
    return;
  }
  FUZZ_PROMISE(error.text[0] != '\0');
  abbe_image_free(&image);
}

int fuzz_input(const uint8_t *data, size_t size) {
  abbe_image image;
  abbe_error error = {0};
  if (size < 8 || memcmp(data, "\x89PNG", 4) != 0) {
    try_profile(data, size);
    return 0;
  }
  uint8_t *copy = malloc(size);
  FUZZ_PROMISE(copy != NULL);
  memcpy(copy, data, size);
  mend(copy, size);
  const char *path = memory_file(copy, size);
  free(copy);
  if (FUZZED(abbe_png_read(path, &image, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && image.data == NULL && image.channel == NULL);
    return 0;
  }
  check_pixels(&image);
  return 0;
}
