#include "scenes/environment/environment_source.h"

#include "base/maths.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/rgb_space.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { CUBE_PARTS = 4, CUBE_MAX_SIDE = 8192 };

/* --- the file --- */

static abbe_result read_image(const char *path, abbe_image *out, bool *is_exr, abbe_error *error) {
  abbe_picture_file_kind kind = ABBE_PICTURE_FILE_OTHER;
  ABBE_TRY(abbe_picture_file_find_kind(path, &kind, error));
  *is_exr = kind == ABBE_PICTURE_FILE_EXR;
  if (*is_exr || kind == ABBE_PICTURE_FILE_RADIANCE)
    return abbe_picture_file_read(path, out, error);
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: it is neither an OpenEXR nor a Radiance picture; surroundings are of "
                        "these",
                        path);
}

static bool find_channels(const abbe_image *image, const char *const names[3], size_t channel[3]) {
  for (int k = 0; k < 3; k++) {
    channel[k] = abbe_image_find_channel(image, names[k]);
    if (channel[k] == (size_t)-1) return false;
  }
  return true;
}

/* Row-major matrix to Rec.709 from the picture's own channels. */
static abbe_result colours_of(const char *path, const abbe_image *image, size_t channel[3],
                              double matrix[9], bool *assumed, abbe_error *error) {
  const bool rgb = find_channels(image, (const char *const[3]){"R", "G", "B"}, channel);
  const bool xyz = !rgb && find_channels(image, (const char *const[3]){"X", "Y", "Z"}, channel);
  abbe_picture_space space;
  double from_xyz[9];
  if (!rgb && !xyz && !find_channels(image, (const char *const[3]){"Y", "Y", "Y"}, channel))
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "%s: it has no channels R, G and B, or X, Y and Z, or Y", path);
  ABBE_TRY(abbe_picture_space_find(image, xyz, path, &space, error));
  *assumed = rgb && space.assumed;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  for (int i = 0; i < 3; i++) {
    double column[3] = {space.to_xyz[i], space.to_xyz[3 + i], space.to_xyz[6 + i]};
    abbe_rgb_space_apply(from_xyz, column, column);
    for (int k = 0; k < 3; k++) matrix[3 * k + i] = column[k];
  }
  return ABBE_OK;
}

/* The picture's pixels as Rec.709, three floats each, in place of its channels. */
static abbe_result convert(const char *path, abbe_image *image, bool *assumed, abbe_error *error) {
  size_t channel[3];
  double matrix[9];
  ABBE_TRY(colours_of(path, image, channel, matrix, assumed, error));
  abbe_image_odd odd;
  abbe_image_count_odd(image, channel, 3, &odd);
  bool same = true;
  for (int i = 0; i < 9; i++) same = same && fabs(matrix[i] - (i % 4 == 0)) < 1e-12;
  /* each pixel is read before it is written: 3 k is never beyond channels k, unless grey */
  float *to = image->data;
  if (image->channels < 3) {
    to = malloc(image->width * image->height * 3 * sizeof *to);
    if (to == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for it", path);
  }
  for (size_t i = 0; i < image->width * image->height; i++) {
    double rgb[3];
    for (int k = 0; k < 3; k++) {
      rgb[k] = (double)image->data[i * image->channels + channel[k]];
      if (isfinite(rgb[k]) && rgb[k] >= 0) continue;
      const abbe_result bad = abbe_error_set(
          error, ABBE_SCHEMA,
          "%s: the pixel at column %zu, row %zu is %g in the channel %s; radiance is finite and "
          "not negative (of all pixels %zu are infinite and %zu not a number)",
          path, i % image->width, i / image->width, rgb[k], image->channel[channel[k]],
          odd.infinite, odd.nan);
      if (to != image->data) free(to);
      return bad;
    }
    if (!same) abbe_rgb_space_apply(matrix, rgb, rgb);
    for (size_t k = 0; k < 3; k++) to[3 * i + k] = (float)fmax(rgb[k], 0);
  }
  if (to != image->data) free(image->data);
  image->data = to;
  return ABBE_OK;
}

/* --- layouts --- */

static abbe_result check_layout(const char *path, const abbe_image *image,
                                abbe_environment_layout *layout, abbe_error *error) {
  const size_t w = image->width, h = image->height;
  const bool latlong = w == 2 * h, cube = 3 * w == 4 * h || 4 * w == 3 * h || 6 * w == h;
  if (*layout == ABBE_LAYOUT_BY_ASPECT) *layout = cube ? ABBE_LAYOUT_CUBE : ABBE_LAYOUT_LATLONG;
  if (*layout == ABBE_LAYOUT_CUBE ? !cube : !latlong)
    return abbe_error_set(
        error, ABBE_SCHEMA,
        "%s: it is %zu x %zu pixels; a latitude-longitude picture is twice as "
        "wide as high, the cross of a cube 4:3 or 3:4, and a column of its faces 1:6",
        path, w, h);
  const size_t most = *layout == ABBE_LAYOUT_CUBE ? CUBE_MAX_SIDE : ABBE_RADIANCE_MAP_MAX_WIDTH;
  if (w > most || h > most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: its %zu x %zu pixels are too many: at most %zu a side are possible; "
                          "make it smaller",
                          path, w, h, most);
  const size_t least = 6 * w == h ? 2 : 6;
  if (h < 2 || w < (*layout == ABBE_LAYOUT_CUBE ? least : ABBE_RADIANCE_MAP_MIN_WIDTH))
    return abbe_error_set(error, ABBE_SCHEMA, "%s: %zu x %zu pixels are too few", path, w, h);
  return ABBE_OK;
}

/* Where each face lies, in faces, and its axes: direction = out + u right + v down, u and v from -1
 * to 1. Some are turned by half a turn: the back of an upright cross, the top and the bottom of a
 * column [OpenEXRImages]. */
typedef enum arrangement { LYING, UPRIGHT, COLUMN, ARRANGEMENTS } arrangement;

typedef struct cube_face {
  double out[3], right[3], down[3];
  size_t at[ARRANGEMENTS][2];
  bool turned[ARRANGEMENTS];
} cube_face;

static const size_t faces_across[ARRANGEMENTS] = {4, 3, 1};

static const cube_face faces[6] = {
    {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {{1, 1}, {1, 1}, {0, 4}}, {false, false, false}},
    {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {{3, 1}, {1, 3}, {0, 5}}, {false, true, false}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {{0, 1}, {0, 1}, {0, 0}}, {false, false, false}},
    {{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}, {{2, 1}, {2, 1}, {0, 1}}, {false, false, false}},
    {{0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {{1, 0}, {1, 0}, {0, 2}}, {false, false, true}},
    {{0, 0, -1}, {0, -1, 0}, {-1, 0, 0}, {{1, 2}, {1, 2}, {0, 3}}, {false, false, true}},
};

static arrangement arrangement_of(const abbe_image *image) {
  if (image->height == 6 * image->width) return COLUMN;
  return image->height > image->width ? UPRIGHT : LYING;
}

/* Bilinear within the face. */
static void cube_at(const abbe_image *image, const double direction[3], double rgb[3]) {
  const arrangement layout = arrangement_of(image);
  const double side = (double)(image->width / faces_across[layout]);
  int best = 0;
  for (int f = 1; f < 6; f++)
    if (abbe_vector_dot(direction, faces[f].out) > abbe_vector_dot(direction, faces[best].out))
      best = f;
  const cube_face *face = &faces[best];
  const size_t *at = face->at[layout];
  const double depth = abbe_vector_dot(direction, face->out);
  double place[2] = {abbe_vector_dot(direction, face->right) / depth,
                     abbe_vector_dot(direction, face->down) / depth};
  size_t low[2];
  double share[2];
  for (int k = 0; k < 2; k++) {
    if (face->turned[layout]) place[k] = -place[k];
    const double x = fmin(fmax((place[k] + 1) / 2 * side - 0.5, 0), side - 1);
    const double whole = fmax(fmin(floor(x), side - 2), 0);
    low[k] = (size_t)whole + at[k] * (size_t)side;
    share[k] = x - whole;
  }
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (int i = 0; i < 4; i++) {
    const double w = (i % 2 ? share[0] : 1 - share[0]) * (i / 2 ? share[1] : 1 - share[1]);
    const size_t x = low[0] + (size_t)(i % 2), y = low[1] + (size_t)(i / 2);
    for (size_t k = 0; k < 3; k++)
      rgb[k] += w * (double)image->data[3 * (y * image->width + x) + k];
  }
}

/* A texel of the map: the mean over what its share covers, CUBE_PARTS places a half. */
static void cube_texel(const abbe_image *image, const abbe_radiance_map *map, size_t column,
                       size_t row, float out[3]) {
  double sum[3] = {0}, whole = 0;
  for (int i = 0; i < 2 * CUBE_PARTS; i++)
    for (int j = 0; j < 2 * CUBE_PARTS; j++) {
      const double x = (i + 0.5) / CUBE_PARTS - 1, y = (j + 0.5) / CUBE_PARTS - 1;
      const double place = (double)row + 0.5 + y;
      const double share =
          (1 - fabs(x)) * (1 - fabs(y)) * fabs(sin(ABBE_PI * place / (double)map->height));
      double direction[3], rgb[3];
      abbe_radiance_map_direction(map, (double)column + 0.5 + x, place, direction);
      cube_at(image, direction, rgb);
      whole += share;
      for (int k = 0; k < 3; k++) sum[k] += share * rgb[k];
    }
  for (int k = 0; k < 3; k++) out[k] = (float)(sum[k] / whole);
}

static abbe_result from_cube(const abbe_image *image, abbe_radiance_map *out, abbe_error *error) {
  const size_t side = image->width / faces_across[arrangement_of(image)];
  const size_t width =
      4 * side < ABBE_RADIANCE_MAP_MAX_WIDTH ? 4 * side : ABBE_RADIANCE_MAP_MAX_WIDTH;
  ABBE_TRY(abbe_radiance_map_make(width, out, error));
  for (size_t row = 0; row < out->height; row++)
    for (size_t column = 0; column < width; column++)
      cube_texel(image, out, column, row, out->rgb + 3 * (row * width + column));
  return ABBE_OK;
}

static abbe_result from_latlong(const abbe_image *image, abbe_radiance_map *out,
                                abbe_error *error) {
  ABBE_TRY(abbe_radiance_map_make(image->width, out, error));
  memcpy(out->rgb, image->data, 3 * image->width * image->height * sizeof *out->rgb);
  return ABBE_OK;
}

abbe_result abbe_environment_picture_read(const char *path, abbe_environment_layout layout,
                                          abbe_radiance_map *out, abbe_error *error) {
  *out = (abbe_radiance_map){0};
  ABBE_OWNED(abbe_image, image) = {0};
  bool is_exr = false;
  ABBE_TRY(read_image(path, &image, &is_exr, error));
  ABBE_TRY(check_layout(path, &image, &layout, error));
  bool assumed = false;
  ABBE_TRY(convert(path, &image, &assumed, error));
  ABBE_TRY(layout == ABBE_LAYOUT_CUBE ? from_cube(&image, out, error)
                                      : from_latlong(&image, out, error));
  out->space_assumed = assumed && is_exr;
  memcpy(out->part, image.part, sizeof out->part);
  return ABBE_OK;
}
