#include "library/lib_picture.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/screen/screen_png.h"
#include "library/lib_handles.h"
#include "library/lib_settings.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

abbe_result abbe_library_picture_adopt(abbe_image *image, abbe_lib_picture **out,
                                       abbe_error *error) {
  abbe_lib_picture *picture = calloc(1, sizeof *picture);
  if (picture == NULL) {
    abbe_image_free(image);
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a picture");
  }
  picture->image = *image;
  *image = (abbe_image){0};
  *out = picture;
  return ABBE_OK;
}

abbe_result abbe_lib_picture_make(size_t width, size_t height, size_t channels,
                                  const char *const *names, const float *pixels,
                                  abbe_lib_picture **out, abbe_error *error) {
  ABBE_REQUIRE(names && out, error);
  abbe_image image = {0};
  *out = NULL;
  for (size_t i = 0; i < channels && i < ABBE_IMAGE_MAX_CHANNELS; i++)
    ABBE_REQUIRE(names[i], error);
  ABBE_TRY(abbe_image_make(width, height, channels, names, &image, error));
  if (pixels != NULL) memcpy(image.data, pixels, width * height * channels * sizeof *pixels);
  return abbe_library_picture_adopt(&image, out, error);
}

static bool is_png(const char *path) {
  const size_t n = strlen(path);
  return n > 4 && strcasecmp(path + n - 4, ".png") == 0;
}

abbe_result abbe_lib_picture_load(const char *path, abbe_lib_picture **out, abbe_error *error) {
  ABBE_REQUIRE(path && out, error);
  abbe_image image = {0};
  *out = NULL;
  ABBE_TRY((is_png(path) ? abbe_png_read : abbe_picture_file_read)(path, &image, error));
  return abbe_library_picture_adopt(&image, out, error);
}

void abbe_lib_picture_free(abbe_lib_picture *picture) {
  if (picture == NULL) return;
  abbe_image_free(&picture->image);
  free(picture);
}

size_t abbe_lib_picture_width(const abbe_lib_picture *picture) {
  return picture == NULL ? 0 : picture->image.width;
}

size_t abbe_lib_picture_height(const abbe_lib_picture *picture) {
  return picture == NULL ? 0 : picture->image.height;
}

size_t abbe_lib_picture_channels(const abbe_lib_picture *picture) {
  return picture == NULL ? 0 : picture->image.channels;
}

const char *abbe_lib_picture_channel(const abbe_lib_picture *picture, size_t index) {
  return index < abbe_lib_picture_channels(picture) ? picture->image.channel[index] : NULL;
}

float *abbe_lib_picture_pixels(abbe_lib_picture *picture) {
  return picture == NULL ? NULL : picture->image.data;
}

const char *abbe_lib_picture_attribute_name(const abbe_lib_picture *picture, size_t index) {
  const bool is_there = picture != NULL && index < picture->image.attribute_count;
  return is_there ? picture->image.attribute[index].name : NULL;
}

const char *abbe_lib_picture_attribute(const abbe_lib_picture *picture, const char *name) {
  const bool is_asked = picture != NULL && name != NULL;
  return is_asked ? abbe_image_attribute_text(&picture->image, name) : NULL;
}

/* The file says the space by chromaticities, for other programs. */
static abbe_result take_space(abbe_image *image, const char *text, abbe_error *error) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    if (strcasecmp(text, abbe_rgb_space_name((abbe_rgb_space)s)) != 0) continue;
    abbe_rgb_space_chromaticities((abbe_rgb_space)s, image->xy);
    memset(image->curve, 0, sizeof image->curve);
    return ABBE_OK;
  }
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "abbe:space '%.60s' is not acescg, rec709 or xyz", text);
}

abbe_result abbe_lib_picture_set_attribute(abbe_lib_picture *picture, const char *name,
                                           const char *text, abbe_error *error) {
  ABBE_REQUIRE(picture && name && text, error);
  if (strcmp(name, "abbe:space") == 0) {
    ABBE_TRY(take_space(&picture->image, text, error));
  }
  return abbe_image_set_attribute(&picture->image, name, text, error);
}

abbe_result abbe_lib_picture_save(const abbe_lib_picture *picture, const char *path,
                                  abbe_error *error) {
  ABBE_REQUIRE(picture && path, error);
  return abbe_exr_write(path, &picture->image, error);
}

abbe_result abbe_lib_picture_save_png(const abbe_lib_picture *picture, const char *path,
                                      const char *const *settings, size_t count,
                                      abbe_error *error) {
  ABBE_REQUIRE(picture && path, error);
  abbe_screen_png_desc desc = {0};
  static const char *const depths[] = {"8", "16"};
  static const int bits[] = {8, 16};
  int depth = -1;
  const abbe_lib_setting known[] = {ABBE_LIB_TEXT("config", &desc.display.config),
                                    ABBE_LIB_TEXT("display", &desc.display.display),
                                    ABBE_LIB_TEXT("view", &desc.display.view),
                                    ABBE_LIB_TEXT("layer", &desc.layer),
                                    ABBE_LIB_NUMBER("exposure", &desc.display.exposure,
                                                    -ABBE_DISPLAY_MAX_EXPOSURE,
                                                    ABBE_DISPLAY_MAX_EXPOSURE),
                                    ABBE_LIB_CHOICE("bits", &depth, depths)};
  desc.display.exposure = NAN;
  ABBE_TRY(abbe_library_settings_read("save_png", known, sizeof known / sizeof *known, settings,
                                      count, error));
  desc.stated = !isnan(desc.display.exposure);
  if (!desc.stated) desc.display.exposure = 0;
  desc.bits = depth < 0 ? 0 : bits[depth];
  return abbe_screen_png_write(path, &picture->image, &desc, error);
}
