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

/* What a context reads from, and the first thing that the library complained of. */
typedef struct stream {
  const char *path;
  int fd;
  int64_t size;
  int io_errno; /* of a failed system call; 0: the bytes themselves are at fault */
  char message[512];
} stream;

static stream *stream_of(exr_const_context_t context) {
  void *user = NULL;
  return exr_get_user_data(context, &user) == EXR_ERR_SUCCESS ? user : NULL;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message) {
  (void)code;
  stream *s = stream_of(context);
  if (s != NULL && s->message[0] == '\0')
    snprintf(s->message, sizeof s->message, "%s", message == NULL ? "" : message);
}

static const char *reason(const stream *s, exr_result_t code) {
  if (s->io_errno != 0) return strerror(s->io_errno);
  return s->message[0] ? s->message : exr_get_default_error_message(code);
}

static int64_t read_at(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t fail) {
  stream *s = user;
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
  return ((const stream *)user)->size;
}

static abbe_result fail_read(const stream *s, exr_result_t rv, abbe_error *error) {
  abbe_result code = s->io_errno != 0                        ? ABBE_IO
                     : rv == EXR_ERR_OUT_OF_MEMORY           ? ABBE_NO_MEMORY
                     : rv == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? ABBE_UNSUPPORTED
                                                             : ABBE_PARSE;
  return abbe_error_set(error, code, "%s: it cannot be read as OpenEXR: %s", s->path,
                        reason(s, rv));
}

/* The codec's number in the header; -1 where none is found. */
static int find_codec(const stream *s) {
  static const char key[] = "compression\0compression\0\1\0\0"; /* and the size's last byte, 0 */
  enum { HEAD = 1 << 17 }; /* a thousand channels and the attributes before */
  unsigned char *head = malloc(HEAD);
  const ssize_t size = head == NULL ? 0 : pread(s->fd, head, HEAD, 0);
  int codec = -1;
  for (ssize_t i = 0; codec < 0 && i + (ssize_t)sizeof key < size; i++)
    if (memcmp(head + i, key, sizeof key) == 0) codec = head[i + (ssize_t)sizeof key];
  free(head);
  return codec;
}

/* The library takes a codec that is younger than itself for ZIP. */
static abbe_result check_codec(const stream *s, abbe_error *error) {
  enum { FIRST_UNKNOWN = 10, HTJ2K_32 = 11 };
  const int codec = find_codec(s);
  if (codec < FIRST_UNKNOWN) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: %s compression (number %d) cannot be read; ZIP, PIZ and the others of "
                        "OpenEXR 3.1 can",
                        s->path, codec <= HTJ2K_32 ? "HTJ2K" : "an unknown", codec);
}

typedef struct layout {
  exr_storage_t storage;
  exr_compression_t compression;
  exr_attr_box2i_t data, display; /* the windows */
  const exr_attr_chlist_t *channels;
} layout;

static int64_t width_of(exr_attr_box2i_t window) {
  return (int64_t)window.max.x - window.min.x + 1;
}

static int64_t height_of(exr_attr_box2i_t window) {
  return (int64_t)window.max.y - window.min.y + 1;
}

static abbe_result unsupported(const stream *s, const char *what, abbe_error *error) {
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: %s; a flat picture in one part, all channels at full resolution, can",
                        s->path, what);
}

static abbe_result check_channels(const stream *s, const layout *l, abbe_error *error) {
  if (l->storage != EXR_STORAGE_SCANLINE && l->storage != EXR_STORAGE_TILED)
    return unsupported(s, "deep data cannot be read", error);
  if (l->compression == EXR_COMPRESSION_DWAA || l->compression == EXR_COMPRESSION_DWAB)
    return unsupported(s, "DWA compression cannot be read", error);
  if (l->channels->num_channels < 1 || l->channels->num_channels > ABBE_IMAGE_MAX_CHANNELS)
    return abbe_error_set(error, ABBE_PARSE, "%s: it has %d channels; 1 to %d can be read", s->path,
                          l->channels->num_channels, ABBE_IMAGE_MAX_CHANNELS);
  for (int i = 0; i < l->channels->num_channels; i++)
    if (l->channels->entries[i].x_sampling != 1 || l->channels->entries[i].y_sampling != 1)
      return unsupported(s, "subsampled channels cannot be read", error);
  return ABBE_OK;
}

/* No more data than the file's bytes can hold at the codecs' best (deflate packs 1032 to 1, others
 * less, halves become floats), and no window that is wider than a picture may be. */
static bool can_be_held(const stream *s, const layout *l) {
  const double best = 4096;
  double bytes = (double)width_of(l->data) * (double)height_of(l->data) *
                 l->channels->num_channels * sizeof(float);
  const exr_attr_box2i_t window[] = {l->data, l->display};
  for (int i = 0; i < 2; i++)
    if (width_of(window[i]) < 1 || width_of(window[i]) > ABBE_IMAGE_MAX_SIDE ||
        height_of(window[i]) < 1 || height_of(window[i]) > ABBE_IMAGE_MAX_SIDE)
      return false;
  return bytes <= best * (double)s->size;
}

static abbe_result check_layout(const stream *s, const layout *l, abbe_error *error) {
  abbe_result result = check_channels(s, l, error);
  if (result != ABBE_OK) return result;
  if (!can_be_held(s, l))
    return abbe_error_set(
        error, ABBE_PARSE,
        "%s: its header promises %lld x %lld pixels of data, %lld x %lld to be "
        "shown and %d channels, which its %lld bytes cannot hold or which is over "
        "%d a side",
        s->path, (long long)width_of(l->data), (long long)height_of(l->data),
        (long long)width_of(l->display), (long long)height_of(l->display),
        l->channels->num_channels, (long long)s->size, ABBE_IMAGE_MAX_SIDE);
  const exr_attr_box2i_t window[] = {l->data, l->display};
  for (int i = 0; result == ABBE_OK && i < 2; i++)
    result = abbe_image_check_expansion(
        s->path, (size_t)width_of(window[i]), (size_t)height_of(window[i]),
        (size_t)l->channels->num_channels, (size_t)s->size, ABBE_EXR_FREE_BYTES, error);
  return result;
}

static abbe_result read_layout(exr_context_t context, const stream *s, layout *l,
                               abbe_error *error) {
  int parts = 0;
  exr_result_t rv = exr_get_count(context, &parts);
  if (rv == 0 && parts != 1) return unsupported(s, "a file of several parts cannot be read", error);
  if (rv == 0) rv = exr_get_storage(context, 0, &l->storage);
  if (rv == 0) rv = exr_get_compression(context, 0, &l->compression);
  if (rv == 0) rv = exr_get_data_window(context, 0, &l->data);
  if (rv == 0) rv = exr_get_display_window(context, 0, &l->display);
  if (rv == 0) rv = exr_get_channels(context, 0, &l->channels);
  return rv == 0 ? check_layout(s, l, error) : fail_read(s, rv, error);
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

static abbe_result read_attributes(exr_context_t context, const stream *s, abbe_image *image,
                                   double *unit, abbe_error *error) {
  int32_t count = 0;
  if (exr_get_attribute_count(context, 0, &count) != 0) return ABBE_OK;
  for (int32_t i = 0; i < count; i++) {
    const exr_attribute_t *a = NULL;
    if (exr_get_attribute_by_index(context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a) != 0) continue;
    if (a->type == EXR_ATTR_CHROMATICITIES && strcmp(a->name, "chromaticities") == 0) {
      const exr_attr_chromaticities_t *c = a->chromaticities;
      const double xy[8] = {c->red_x,  c->red_y,  c->green_x, c->green_y,
                            c->blue_x, c->blue_y, c->white_x, c->white_y};
      memcpy(image->xy, xy, sizeof xy);
    }
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
    abbe_result result = abbe_image_set_attribute(image, a->name, a->string->str, error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

static abbe_image_window window_of(exr_attr_box2i_t box) {
  return (abbe_image_window){box.min.x, box.min.y, box.max.x, box.max.y};
}

/* A picture of the display window, all 0. */
static abbe_result make_image(exr_context_t context, const stream *s, const layout *l,
                              abbe_image *image, double *unit, abbe_error *error) {
  const char *names[ABBE_IMAGE_MAX_CHANNELS];
  for (int i = 0; i < l->channels->num_channels; i++) names[i] = l->channels->entries[i].name.str;
  abbe_result result = abbe_image_make((size_t)width_of(l->display), (size_t)height_of(l->display),
                                       (size_t)l->channels->num_channels, names, image, error);
  image->display_window = window_of(l->display);
  image->data_window = window_of(l->data);
  return result == ABBE_OK ? read_attributes(context, s, image, unit, error) : result;
}

/* Where the chunk that is decoded goes: its first sample belongs to the picture's pixel (x, y),
 * which may lie outside. */
typedef struct place {
  const abbe_image *image;
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
  exr_result_t rv = exr_decoding_initialize(context, 0, chunk, pipe);
  if (rv == 0) rv = exr_decoding_choose_default_routines(context, 0, pipe);
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
                                          : exr_decoding_update(context, 0, chunk, pipe);
  if (rv == 0 && !is_whole(pipe)) rv = EXR_ERR_CORRUPT_CHUNK;
  return rv == 0 ? exr_decoding_run(context, 0, pipe) : rv;
}

static bool is_shown(const place *to, int64_t width, int64_t height) {
  return to->x < (int64_t)to->image->width && to->x + width > 0 &&
         to->y < (int64_t)to->image->height && to->y + height > 0;
}

/* x, y: of the data window's pixels; chunks of which nothing is shown are not decoded. */
static exr_result_t read_lines(exr_context_t context, const layout *l, const abbe_image *image,
                               exr_decode_pipeline_t *pipe) {
  int32_t lines = 0;
  const int64_t width = width_of(l->data), height = height_of(l->data);
  const int64_t dx = (int64_t)l->data.min.x - l->display.min.x;
  const int64_t dy = (int64_t)l->data.min.y - l->display.min.y;
  place to = {.image = image, .x = dx};
  exr_result_t rv = exr_get_scanlines_per_chunk(context, 0, &lines);
  if (rv == 0 && lines < 1) return EXR_ERR_CORRUPT_CHUNK;
  for (int64_t y = 0; rv == 0 && y < height; y += lines) {
    exr_chunk_info_t chunk = {0};
    to.y = dy + y;
    if (!is_shown(&to, width, lines)) continue;
    rv = exr_read_scanline_chunk_info(context, 0, (int)(l->data.min.y + y), &chunk);
    if (rv == 0) rv = read_chunk(context, &chunk, width, height - y, &to, pipe);
  }
  return rv;
}

static exr_result_t read_tiles(exr_context_t context, const layout *l, const abbe_image *image,
                               exr_decode_pipeline_t *pipe) {
  uint32_t w = 0, h = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  const int64_t width = width_of(l->data), height = height_of(l->data);
  place to = {.image = image};
  exr_result_t rv = exr_get_tile_descriptor(context, 0, &w, &h, &levels, &rounding);
  if (rv == 0 && (w < 1 || h < 1)) return EXR_ERR_CORRUPT_CHUNK;
  for (int64_t y = 0; rv == 0 && y < height; y += h)
    for (int64_t x = 0; rv == 0 && x < width; x += w) {
      exr_chunk_info_t chunk = {0};
      to.x = (int64_t)l->data.min.x - l->display.min.x + x;
      to.y = (int64_t)l->data.min.y - l->display.min.y + y;
      if (!is_shown(&to, w, h)) continue;
      rv = exr_read_tile_chunk_info(context, 0, (int)(x / w), (int)(y / h), 0, 0, &chunk);
      if (rv == 0) rv = read_chunk(context, &chunk, width - x, height - y, &to, pipe);
    }
  return rv;
}

static abbe_result read_image(exr_context_t context, const stream *s, abbe_image *image,
                              abbe_error *error) {
  layout l = {0};
  double unit = 1;
  abbe_result result = read_layout(context, s, &l, error);
  if (result == ABBE_OK) result = make_image(context, s, &l, image, &unit, error);
  if (result != ABBE_OK) return result;
  exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
  exr_result_t rv = l.storage == EXR_STORAGE_TILED ? read_tiles(context, &l, image, &pipe)
                                                   : read_lines(context, &l, image, &pipe);
  exr_decoding_destroy(context, &pipe);
  size_t count = unit == 1 ? 0 : image->width * image->height * image->channels;
  for (size_t i = 0; i < count; i++) image->data[i] = (float)((double)image->data[i] * unit);
  return rv == 0 ? ABBE_OK : fail_read(s, rv, error);
}

static abbe_result open_stream(stream *s, FILE **file, abbe_error *error) {
  size_t size = 0;
  abbe_result result = abbe_file_open(s->path, file, &size, error);
  if (result != ABBE_OK) return result;
  s->fd = fileno(*file);
  s->size = (off_t)size;
  return ABBE_OK;
}

static abbe_result read_stream(stream *s, abbe_image *image, abbe_error *error) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = on_error;
  setup.user_data = s;
  setup.read_fn = read_at;
  setup.size_fn = stream_size;
  setup.max_image_width = setup.max_image_height = ABBE_IMAGE_MAX_SIDE;
  setup.max_tile_width = setup.max_tile_height = ABBE_IMAGE_MAX_SIDE;
  setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  abbe_result result = check_codec(s, error);
  if (result != ABBE_OK) return result;
  exr_context_t context = NULL;
  exr_result_t rv = exr_start_read(&context, s->path, &setup);
  if (rv != 0) return fail_read(s, rv, error);
  result = read_image(context, s, image, error);
  exr_finish(&context);
  return result;
}

abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(path && out, error);
  *out = (abbe_image){0};
  stream s = {.path = path, .fd = -1};
  FILE *file = NULL;
  abbe_image image = {0};
  abbe_result result = open_stream(&s, &file, error);
  if (result == ABBE_OK) result = read_stream(&s, &image, error);
  if (file != NULL) fclose(file);
  if (result != ABBE_OK)
    abbe_image_free(&image);
  else
    *out = image;
  return result;
}
