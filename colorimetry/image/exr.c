#include "colorimetry/image/exr.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/exr_parts.h"

#include <errno.h>
#include <math.h>
#include <openexr.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static abbe_exr_stream *stream_of(exr_const_context_t context) {
  void *user = NULL;
  return exr_get_user_data(context, &user) == EXR_ERR_SUCCESS ? user : NULL;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message) {
  (void)code;
  abbe_exr_stream *s = stream_of(context);
  if (s != NULL && s->message[0] == '\0')
    snprintf(s->message, sizeof s->message, "%s", message == NULL ? "" : message);
}

static int64_t read_at(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t fail) {
  abbe_exr_stream *s = user;
  char *bytes = buffer;
  uint64_t done = 0;
  while (done < size) {
    ssize_t n = pread(s->fd, bytes + done, size - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      /* an offset past what the system can seek to is the file's lie, not the disk's failure */
      if (errno != EINVAL && errno != EOVERFLOW) s->io_errno = errno;
      fail(context, EXR_ERR_READ_IO, "%s", strerror(errno));
      return -1;
    }
    if (n == 0) break;
    done += (uint64_t)n;
  }
  return (int64_t)done;
}

static int64_t stream_size(exr_const_context_t context, void *user) {
  (void)context;
  return ((const abbe_exr_stream *)user)->size;
}

/* abbe:stored_unit, which whole files are in; *unit stays what it is where the text is none. */
static bool read_unit(const char *text, double *unit) {
  const char *end;
  int exponent;
  double value;
  if (!abbe_number_read(text, &end, &value) || *end != '\0' || !isfinite(value) ||
      frexp(value, &exponent) != 0.5)
    return false;
  *unit = value;
  return true;
}

/* The layout of Ocean: CHANNEL.wavelength is what light the channel has, in metres. It is called
 * as its wavelength is in the spectral layout. */
static abbe_result name_band(const exr_attribute_t *a, const abbe_exr_stream *s, abbe_image *image,
                             abbe_error *error) {
  const char *dot = strrchr(a->name, '.');
  double metres = NAN;
  char name[64], digits[32];
  const char *end = "";
  if (dot == NULL || strcmp(dot, ".wavelength") != 0) return ABBE_OK;
  size_t c = 0;
  while (c < image->channels && (strlen(image->channel[c]) != (size_t)(dot - a->name) ||
                                 memcmp(image->channel[c], a->name, (size_t)(dot - a->name)) != 0))
    c++;
  if (c == image->channels) return ABBE_OK;
  if (a->type == EXR_ATTR_FLOAT) metres = (double)a->f;
  if (a->type == EXR_ATTR_DOUBLE) metres = a->d;
  if (a->type == EXR_ATTR_STRING && !abbe_number_read(a->string->str, &end, &metres)) metres = NAN;
  if (*end != '\0' || !(metres > 1e-12 && metres < 1))
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: its attribute %s is no wavelength in metres, such as 5.5e-7",
                          s->path, a->name);
  abbe_number_format(digits, sizeof digits, "%.6g", 1e9 * metres); /* what a float has */
  abbe_number_read(digits, &end, &metres);
  abbe_image_band_name(metres, name, sizeof name);
  char *text = strdup(name);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", s->path);
  free(image->channel[c]);
  image->channel[c] = text;
  return ABBE_OK;
}

static abbe_result read_attributes(exr_context_t context, int part, const abbe_exr_stream *s,
                                   abbe_image *image, double *unit, abbe_error *error) {
  int32_t count = 0;
  if (exr_get_attribute_count(context, part, &count) != 0) return ABBE_OK;
  for (int32_t i = 0; i < count; i++) {
    const exr_attribute_t *a = NULL;
    if (exr_get_attribute_by_index(context, part, EXR_ATTR_LIST_FILE_ORDER, i, &a) != 0) continue;
    if (a->type == EXR_ATTR_CHROMATICITIES && strcmp(a->name, "chromaticities") == 0) {
      const exr_attr_chromaticities_t *c = a->chromaticities;
      const double xy[8] = {c->red_x,  c->red_y,  c->green_x, c->green_y,
                            c->blue_x, c->blue_y, c->white_x, c->white_y};
      memcpy(image->xy, xy, sizeof xy);
    }
    ABBE_TRY(name_band(a, s, image, error));
    if (a->type != EXR_ATTR_STRING || a->name[0] == '\0' || a->string->str == NULL) continue;
    if (strcmp(a->name, ABBE_EXR_STORAGE_NAME) == 0) continue;
    if (strcmp(a->name, ABBE_EXR_UNIT_NAME) == 0) {
      if (read_unit(a->string->str, unit)) continue;
      return abbe_error_set(error, ABBE_PARSE, "%s: %s is '%.40s'; a power of two is right",
                            s->path, ABBE_EXR_UNIT_NAME, a->string->str);
    }
    if (image->attribute_count == ABBE_IMAGE_MAX_ATTRIBUTES)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: it has more than %d text attributes, which is as many as can be "
                            "read",
                            s->path, ABBE_IMAGE_MAX_ATTRIBUTES);
    ABBE_TRY(abbe_image_set_attribute(image, a->name, a->string->str, error));
  }
  return ABBE_OK;
}

static abbe_image_window window_of(exr_attr_box2i_t box) {
  return (abbe_image_window){box.min.x, box.min.y, box.max.x, box.max.y};
}

/* A picture of the display window, all 0. */
static abbe_result make_image(exr_context_t context, const abbe_exr_stream *s,
                              const abbe_exr_layout *l, abbe_image *image, double *unit,
                              abbe_error *error) {
  const char *names[ABBE_IMAGE_MAX_CHANNELS];
  for (int i = 0; i < l->channels->num_channels; i++) names[i] = l->channels->entries[i].name.str;
  abbe_result result =
      abbe_image_make((size_t)abbe_exr_width(l->display), (size_t)abbe_exr_height(l->display),
                      (size_t)l->channels->num_channels, names, image, error);
  image->display_window = window_of(l->display);
  image->data_window = window_of(l->data);
  if (l->parts > 1)
    snprintf(image->part, sizeof image->part, "%d%s%.24s%s of %d", l->part + 1, l->name ? " '" : "",
             l->name ? l->name : "", l->name ? "'" : "", l->parts);
  return result == ABBE_OK ? read_attributes(context, l->part, s, image, unit, error) : result;
}

/* Where the chunk that is decoded goes: its first sample belongs to the picture's pixel (x, y),
 * which may lie outside. */
typedef struct place {
  const abbe_image *image;
  int part;
  int64_t x, y;
  exr_result_t (*decompress)(exr_decode_pipeline_t *pipe); /* the library's; NULL: nothing packs */
} place;

static uint32_t little_endian(const uint8_t *bytes, int count) {
  uint32_t value = 0;
  for (int i = count - 1; i >= 0; i--) value = value << 8 | bytes[i];
  return value;
}

static float float_of(uint32_t bits) {
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* IEEE 754's binary16: the exponent's bias is 112 less, and its greatest stands for infinity. */
static float half_of(uint32_t bits) {
  float value = float_of((bits & 0x7fff) << 13) * 0x1p112f;
  if (value >= 65536) value = float_of(0x7f800000 | (bits & 0x3ff) << 13);
  return bits & 0x8000 ? -value : value;
}

static float sample_of(const uint8_t *bytes, int type) {
  if (type == EXR_PIXEL_HALF) return half_of(little_endian(bytes, 2));
  uint32_t bits = little_endian(bytes, 4);
  return type == EXR_PIXEL_FLOAT ? float_of(bits) : (float)bits;
}

/* A chunk's lines, each channel after channel, into those pixels of the picture that they cover.
 * The library's own unpackers are not used: 3.1's for four halves that become neighbouring floats
 * lays them down in reverse. */
static exr_result_t unpack(exr_decode_pipeline_t *pipe) {
  const place *to = pipe->decoding_user_data;
  const abbe_image *image = to->image;
  const int64_t width = (int64_t)image->width, chunk_width = pipe->chunk.width;
  const int64_t from = to->x < 0 ? -to->x : 0;
  const int64_t past = to->x + chunk_width > width ? width - to->x : chunk_width;
  const uint8_t *line = pipe->unpacked_buffer;
  for (int64_t y = to->y; y < to->y + pipe->chunk.height; y++)
    for (int c = 0; c < pipe->channel_count; c++) {
      const int bytes = pipe->channels[c].bytes_per_element, type = pipe->channels[c].data_type;
      const bool shown = y >= 0 && y < (int64_t)image->height;
      for (int64_t x = from; shown && x < past; x++)
        image->data[(y * width + to->x + x) * (int64_t)image->channels + c] =
            sample_of(line + x * bytes, type);
      line += chunk_width * bytes;
    }
  return EXR_ERR_SUCCESS;
}

/* What no codec made smaller is stored as it is; 3.1 forgets that for B44. */
static exr_result_t decompress(exr_decode_pipeline_t *pipe) {
  const place *to = pipe->decoding_user_data;
  if (pipe->chunk.packed_size == pipe->chunk.unpacked_size) return EXR_ERR_SUCCESS;
  return to->decompress == NULL ? EXR_ERR_CORRUPT_CHUNK : to->decompress(pipe);
}

static exr_result_t begin(exr_context_t context, const exr_chunk_info_t *chunk, place *to,
                          exr_decode_pipeline_t *pipe) {
  exr_result_t rv = exr_decoding_initialize(context, to->part, chunk, pipe);
  if (rv == 0) rv = exr_decoding_choose_default_routines(context, to->part, pipe);
  to->decompress = pipe->decompress_fn;
  pipe->decoding_user_data = to;
  pipe->decompress_fn = decompress;
  pipe->unpack_and_convert_fn = unpack;
  return rv;
}

static bool is_whole(const exr_decode_pipeline_t *pipe) {
  uint64_t pixel = 0;
  for (int c = 0; c < pipe->channel_count; c++)
    pixel += (uint64_t)pipe->channels[c].bytes_per_element;
  return pixel * (uint64_t)pipe->chunk.width * (uint64_t)pipe->chunk.height ==
         pipe->chunk.unpacked_size;
}

/* Decodes one chunk of at most width x height pixels. */
static exr_result_t read_chunk(exr_context_t context, const exr_chunk_info_t *chunk, int64_t width,
                               int64_t height, place *to, exr_decode_pipeline_t *pipe) {
  if (chunk->width < 1 || chunk->height < 1 || chunk->width > width || chunk->height > height)
    return EXR_ERR_CORRUPT_CHUNK;
  exr_result_t rv = pipe->context == NULL ? begin(context, chunk, to, pipe)
                                          : exr_decoding_update(context, to->part, chunk, pipe);
  if (rv == 0 && !is_whole(pipe)) rv = EXR_ERR_CORRUPT_CHUNK;
  return rv == 0 ? exr_decoding_run(context, to->part, pipe) : rv;
}

static bool is_shown(const place *to, int64_t width, int64_t height) {
  return to->x < (int64_t)to->image->width && to->x + width > 0 &&
         to->y < (int64_t)to->image->height && to->y + height > 0;
}

/* x, y: of the data window's pixels; chunks of which nothing is shown are not decoded. */
static exr_result_t read_lines(exr_context_t context, const abbe_exr_layout *l,
                               const abbe_image *image, exr_decode_pipeline_t *pipe) {
  int32_t lines = 0;
  const int64_t width = abbe_exr_width(l->data), height = abbe_exr_height(l->data);
  const int64_t dx = (int64_t)l->data.min.x - l->display.min.x;
  const int64_t dy = (int64_t)l->data.min.y - l->display.min.y;
  place to = {.image = image, .part = l->part, .x = dx};
  exr_result_t rv = exr_get_scanlines_per_chunk(context, l->part, &lines);
  if (rv == 0 && lines < 1) return EXR_ERR_CORRUPT_CHUNK;
  for (int64_t y = 0; rv == 0 && y < height; y += lines) {
    exr_chunk_info_t chunk = {0};
    to.y = dy + y;
    if (!is_shown(&to, width, lines)) continue;
    rv = exr_read_scanline_chunk_info(context, l->part, (int)(l->data.min.y + y), &chunk);
    if (rv == 0) rv = read_chunk(context, &chunk, width, height - y, &to, pipe);
  }
  return rv;
}

static exr_result_t read_tiles(exr_context_t context, const abbe_exr_layout *l, int level,
                               const abbe_image *image, exr_decode_pipeline_t *pipe) {
  uint32_t w = 0, h = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  const int64_t width = abbe_exr_width(l->data), height = abbe_exr_height(l->data);
  place to = {.image = image, .part = l->part};
  exr_result_t rv = exr_get_tile_descriptor(context, l->part, &w, &h, &levels, &rounding);
  if (rv == 0 && (w < 1 || h < 1)) return EXR_ERR_CORRUPT_CHUNK;
  for (int64_t y = 0; rv == 0 && y < height; y += h)
    for (int64_t x = 0; rv == 0 && x < width; x += w) {
      exr_chunk_info_t chunk = {0};
      to.x = (int64_t)l->data.min.x - l->display.min.x + x;
      to.y = (int64_t)l->data.min.y - l->display.min.y + y;
      if (!is_shown(&to, w, h)) continue;
      rv = exr_read_tile_chunk_info(context, l->part, (int)(x / w), (int)(y / h), level, level,
                                    &chunk);
      if (rv == 0) rv = read_chunk(context, &chunk, width - x, height - y, &to, pipe);
    }
  return rv;
}

/* Which pixels are wanted: zeroed, all of the picture. */
typedef struct request {
  abbe_exr_levels *levels; /* NULL: pixels; else these alone */
  bool by_level;
  size_t level;
  const size_t *window;
} request;

static size_t count_levels(exr_context_t context, const abbe_exr_layout *l) {
  int32_t x = 1, y = 1;
  const bool same = memcmp(&l->data, &l->display, sizeof l->data) == 0;
  if (l->storage != EXR_STORAGE_TILED || !same ||
      exr_get_tile_levels(context, l->part, &x, &y) != 0)
    return 1;
  return (size_t)(x < y ? x : y);
}

/* The layout becomes that of a level, whose first pixel is (0, 0), and of a window in it. */
static abbe_result choose_level(exr_context_t context, const abbe_exr_stream *s, const request *r,
                                abbe_exr_layout *l, abbe_error *error) {
  int32_t width = 0, height = 0;
  if (!r->by_level) return ABBE_OK;
  if (r->level >= count_levels(context, l))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: it has no level %zu", s->path,
                          r->level);
  width = (int32_t)abbe_exr_width(l->data);
  height = (int32_t)abbe_exr_height(l->data);
  exr_result_t rv = 0;
  if (r->level > 0)
    rv = exr_get_level_sizes(context, l->part, (int)r->level, (int)r->level, &width, &height);
  if (rv != 0) return abbe_exr_fail(s, rv, error);
  l->data.min.x = l->data.min.y = 0;
  l->data.max.x = width - 1;
  l->data.max.y = height - 1;
  l->display = l->data;
  const size_t *w = r->window;
  if (w == NULL) return ABBE_OK;
  if (w[0] > w[2] || w[1] > w[3] || w[2] >= (size_t)width || w[3] >= (size_t)height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: pixels %zu, %zu to %zu, %zu are not in its level %zu of %d x %d",
                          s->path, w[0], w[1], w[2], w[3], r->level, (int)width, (int)height);
  l->display.min.x = (int32_t)w[0];
  l->display.min.y = (int32_t)w[1];
  l->display.max.x = (int32_t)w[2];
  l->display.max.y = (int32_t)w[3];
  return ABBE_OK;
}

static abbe_result read_image(exr_context_t context, const abbe_exr_stream *s, const request *r,
                              abbe_image *image, abbe_error *error) {
  abbe_exr_layout l = {0};
  double unit = 1;
  ABBE_TRY(abbe_exr_layout_find(context, s, &l, error));
  if (r->levels != NULL) {
    *r->levels =
        (abbe_exr_levels){count_levels(context, &l), (size_t)abbe_exr_width(l.display),
                          (size_t)abbe_exr_height(l.display), (size_t)l.channels->num_channels};
    return ABBE_OK;
  }
  ABBE_TRY(choose_level(context, s, r, &l, error));
  ABBE_TRY(make_image(context, s, &l, image, &unit, error));
  exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
  exr_result_t rv = l.storage == EXR_STORAGE_TILED
                        ? read_tiles(context, &l, (int)r->level, image, &pipe)
                        : read_lines(context, &l, image, &pipe);
  exr_decoding_destroy(context, &pipe);
  size_t count = unit == 1 ? 0 : image->width * image->height * image->channels;
  for (size_t i = 0; i < count; i++) image->data[i] = (float)((double)image->data[i] * unit);
  return rv == 0 ? ABBE_OK : abbe_exr_fail(s, rv, error);
}

size_t abbe_exr_file_length(const char *path) {
  const char *mark = access(path, F_OK) == 0 ? NULL : strrchr(path, '#');
  return mark != NULL ? (size_t)(mark - path) : strlen(path);
}

static abbe_result open_stream(abbe_exr_stream *s, FILE **file, abbe_error *error) {
  size_t size = 0;
  const size_t length = abbe_exr_file_length(s->path);
  char *name = strndup(s->path, length);
  if (name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", s->path);
  abbe_result result = abbe_file_open(name, file, &size, error);
  free(name);
  if (result != ABBE_OK) return result;
  s->part = s->path[length] == '#' ? s->path + length + 1 : NULL;
  s->fd = fileno(*file);
  s->size = (off_t)size;
  return ABBE_OK;
}

static abbe_result read_stream(abbe_exr_stream *s, const request *r, abbe_image *image,
                               abbe_error *error) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = on_error;
  setup.user_data = s;
  setup.read_fn = read_at;
  setup.size_fn = stream_size;
  setup.max_image_width = setup.max_image_height = ABBE_IMAGE_MAX_SIDE;
  setup.max_tile_width = setup.max_tile_height = ABBE_IMAGE_MAX_SIDE;
  setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  exr_context_t context = NULL;
  exr_result_t rv = exr_start_read(&context, s->path, &setup);
  if (rv != 0) return abbe_exr_fail_open(s, rv, error);
  const abbe_result result = read_image(context, s, r, image, error);
  exr_finish(&context);
  return result;
}

static abbe_result read_request(const char *path, const request *r, abbe_image *out,
                                abbe_error *error) {
  *out = (abbe_image){0};
  abbe_exr_stream s = {.path = path, .fd = -1};
  FILE *file = NULL;
  abbe_image image = {0};
  abbe_result result = open_stream(&s, &file, error);
  if (result == ABBE_OK) result = read_stream(&s, r, &image, error);
  if (file != NULL) fclose(file);
  if (result != ABBE_OK)
    abbe_image_free(&image);
  else
    *out = image;
  return result;
}

abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error) {
  return read_request(path, &(request){0}, out, error);
}

abbe_result abbe_exr_find_levels(const char *path, abbe_exr_levels *out, abbe_error *error) {
  abbe_image none;
  *out = (abbe_exr_levels){0};
  return read_request(path, &(request){.levels = out}, &none, error);
}

abbe_result abbe_exr_read_level(const char *path, size_t level, const size_t window[4],
                                abbe_image *out, abbe_error *error) {
  return read_request(path, &(request){.by_level = true, .level = level, .window = window}, out,
                      error);
}
