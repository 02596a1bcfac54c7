#include "gl/caustics/map_picture.h"

#include "colorimetry/rgb_space.h"

static abbe_result copy(const float *texel, size_t side, const char *const *names, abbe_image *out,
                        abbe_error *error) {
  abbe_result result = abbe_image_make(side, side, 3, names, out, error);
  for (size_t y = 0; y < side && result == ABBE_OK; y++)
    for (size_t x = 0; x < side; x++)
      for (size_t c = 0; c < 3; c++)
        out->data[(y * side + x) * 3 + c] = texel[((side - 1 - y) * side + x) * 4 + c];
  return result;
}

abbe_result abbe_map_picture_flux(const float *texel, size_t side, const abbe_map_layout *layout,
                                  double power, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"X", "Y", "Z"};
  abbe_result result = copy(texel, side, names, out, error);
  if (result != ABBE_OK) return result;
  for (size_t y = 0; y < side; y++) {
    const double height = power * abbe_map_layout_texel_size(layout, 1, side, side - 1 - y);
    for (size_t x = 0; x < side; x++)
      for (size_t c = 0; c < 3; c++)
        out->data[(y * side + x) * 3 + c] *=
            (float)(height * abbe_map_layout_texel_size(layout, 0, side, x));
  }
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_XYZ, out->xy);
  return ABBE_OK;
}

abbe_result abbe_map_picture_colour(const float *texel, size_t side, abbe_image *out,
                                    abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_result result = copy(texel, side, names, out, error);
  if (result == ABBE_OK) abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, out->xy);
  return result;
}
