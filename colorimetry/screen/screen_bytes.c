#include "colorimetry/image/png_file.h"
#include "colorimetry/screen/screen_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t abbe_screen_file_samples(const abbe_image *image) {
  return image->channels > 3 && strcmp(image->channel[3], "A") == 0 ? 4 : 3;
}

abbe_result abbe_screen_file_bytes(const char *path, const abbe_image *image, size_t samples,
                                   unsigned char **out, abbe_error *error) {
  const size_t pixels = image->width * image->height;
  *out = malloc(pixels * samples);
  if (*out == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its pixels", path);
  for (size_t i = 0; i < pixels; i++)
    for (size_t k = 0; k < samples; k++) {
      const float v = image->data[i * image->channels + k]; /* not-a-number is not above 0 */
      (*out)[i * samples + k] = (unsigned char)lround(255 * (double)(v > 0 ? fminf(v, 1) : 0));
    }
  return ABBE_OK;
}

abbe_result abbe_screen_file_frame(const char *path, size_t *width, size_t *height,
                                   unsigned char **out, abbe_error *error) {
  abbe_image image;
  *out = NULL;
  abbe_result result = abbe_png_read(path, &image, error);
  if (result != ABBE_OK) return result;
  if (*width == 0) *width = image.width, *height = image.height;
  if (image.width != *width || image.height != *height)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: it has %zux%zu pixels, and the frames before it %zux%zu", path,
                            image.width, image.height, *width, *height);
  if (result == ABBE_OK) result = abbe_screen_file_bytes(path, &image, 3, out, error);
  abbe_image_free(&image);
  return result;
}
