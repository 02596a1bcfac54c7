/* OpenEXR files, and the map layouts that may stand in them. What is read can be written again. */
#include "tests/fuzz/memory_file.h"

#include "colorimetry/image/exr.h"
#include "scenes/view/map_layout.h"

#include <string.h>

const char *const fuzz_words[] = {"channels\0chlist",
                                  "compression",
                                  "dataWindow",
                                  "displayWindow",
                                  "lineOrder",
                                  "tiles",
                                  "tiledesc",
                                  "string",
                                  "chromaticities",
                                  "abbe:stored_unit",
                                  "abbe:map_view",
                                  "abbe:map_warp_x",
                                  "perspective origin",
                                  "\x76\x2f\x31\x01\x02",
                                  "\xff\xff\xff\x7f",
                                  "\xff\xff\xff\xff",
                                  "\x80",
                                  NULL};

static void comes_back(const abbe_image *image) {
  static const char path[] = "fuzz_exr.back";
  abbe_image back = {0};
  abbe_error error = {0};
  if (abbe_exr_write(path, image, &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0'); /* two channels of one name, for one */
    return;
  }
  FUZZ_PROMISE(abbe_exr_read(path, &back, &error) == ABBE_OK);
  FUZZ_PROMISE(back.width == image->width && back.height == image->height &&
               back.channels == image->channels);
  for (size_t c = 0; c < image->channels; c++) {
    const size_t d = abbe_image_find_channel(&back, image->channel[c]);
    FUZZ_PROMISE(d < back.channels);
    for (size_t i = 0; i < image->width * image->height; i++)
      FUZZ_PROMISE(memcmp(&image->data[i * image->channels + c], &back.data[i * back.channels + d],
                          sizeof(float)) == 0);
  }
  abbe_image_free(&back);
  unlink(path);
}

int fuzz_input(const uint8_t *data, size_t size) {
  static unsigned turn;
  abbe_image image;
  abbe_error error = {0};
  const char *path = memory_file(data, size);
  if (FUZZED(abbe_exr_read(path, &image, &error), &error) != ABBE_OK) {
    FUZZ_PROMISE(error.text[0] != '\0' && image.data == NULL && image.channel == NULL);
    return 0;
  }
  FUZZ_PROMISE(image.width >= 1 && image.width <= ABBE_IMAGE_MAX_SIDE && image.height >= 1 &&
               image.height <= ABBE_IMAGE_MAX_SIDE && image.channels >= 1);
  fuzz_same(image.data, image.width * image.height * image.channels * sizeof *image.data);
  abbe_map_layout layout, zero;
  memset(&zero, 0, sizeof zero);
  if (FUZZED(abbe_map_layout_read(&image, "f.exr", &layout, &error), &error) == ABBE_OK)
    FUZZ_PROMISE(abbe_map_layout_check(&layout, &error) == ABBE_OK);
  else
    FUZZ_PROMISE(error.text[0] != '\0' && memcmp(&layout, &zero, sizeof zero) == 0);
  if (turn++ % 16 == 0) comes_back(&image); /* a share of them: the disk takes its time */
  abbe_image_free(&image);
  return 0;
}
