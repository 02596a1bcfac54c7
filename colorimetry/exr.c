#include "colorimetry/exr.h"

#include "spectral/file.h"

#include <errno.h>
#include <math.h>
#include <openexr.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a context reads from or writes to, and the first thing that the library complained of. */
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

/* While a header is written the library holds the lock that exr_get_user_data would take: a
 * writing context is told nothing but its result. */
static void ignore_error(exr_const_context_t context, exr_result_t code, const char *message) {
  (void)context;
  (void)code;
  (void)message;
}

static const char *reason(const stream *s, exr_result_t code) {
  if (s->io_errno != 0) return strerror(s->io_errno);
  return s->message[0] ? s->message : exr_get_default_error_message(code);
}

/* The texts that are the file's own: whether it is in scan lines or tiles, and what a stored 1
 * stands for. */
static const char storage_name[] = "type";
static const char unit_name[] = "abbe:stored_unit";

/* Writing */

static int64_t write_at(exr_const_context_t context, void *user, const void *buffer, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t fail) {
  stream *s = user;
  const char *bytes = buffer;
  for (uint64_t done = 0; done < size;) {
    ssize_t n = pwrite(s->fd, bytes + done, size - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      s->io_errno = n < 0 ? errno : ENOSPC;
      fail(context, EXR_ERR_WRITE_IO, "%s", strerror(s->io_errno));
      return -1;
    }
    done += (uint64_t)n;
  }
  return (int64_t)size;
}

static exr_result_t write_chromaticities(exr_context_t context, const double xy[8]) {
  bool stated = false;
  for (int i = 0; i < 8; i++) stated = stated || xy[i] != 0;
  if (!stated) return EXR_ERR_SUCCESS;
  exr_attr_chromaticities_t c = {(float)xy[0], (float)xy[1], (float)xy[2], (float)xy[3],
                                 (float)xy[4], (float)xy[5], (float)xy[6], (float)xy[7]};
  return exr_attr_set_chromaticities(context, 0, "chromaticities", &c);
}

/* How samples are stored: their type, and what a stored 1 stands for. */
typedef struct storage {
  exr_pixel_type_t type;
  double unit;
} storage;

static exr_result_t write_unit(exr_context_t context, double unit) {
  char text[32];
  if (unit == 1) return EXR_ERR_SUCCESS;
  snprintf(text, sizeof text, "%.17g", unit);
  return exr_attr_set_string(context, 0, unit_name, text);
}

static exr_result_t write_header(exr_context_t context, const abbe_image *image, storage as) {
  int part = 0;
  exr_result_t rv = exr_set_longname_support(context, 1);
  if (rv == 0) rv = exr_add_part(context, "", EXR_STORAGE_SCANLINE, &part);
  if (rv == 0)
    rv = exr_initialize_required_attr_simple(context, 0, (int32_t)image->width,
                                             (int32_t)image->height, EXR_COMPRESSION_ZIP);
  for (size_t i = 0; rv == 0 && i < image->channels; i++)
    rv =
        exr_add_channel(context, 0, image->channel[i], as.type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  if (rv == 0) rv = write_chromaticities(context, image->xy);
  if (rv == 0) rv = write_unit(context, as.unit);
  for (size_t i = 0; rv == 0 && i < image->attribute_count; i++)
    rv = exr_attr_set_string(context, 0, image->attribute[i].name, image->attribute[i].text);
  return rv == 0 ? exr_write_header(context) : rv;
}

/* Points every channel of the chunk at its samples, the first of which is at (x, y). */
static bool point_channels(exr_coding_channel_info_t *channels, int count, const abbe_image *image,
                           size_t x, size_t y) {
  for (int i = 0; i < count; i++) {
    size_t c = abbe_image_find_channel(image, channels[i].channel_name);
    if (c == (size_t)-1) return false;
    float *first = image->data + (y * image->width + x) * image->channels + c;
    channels[i].user_bytes_per_element = sizeof(float);
    channels[i].user_data_type = EXR_PIXEL_FLOAT;
    channels[i].user_pixel_stride = (int32_t)(image->channels * sizeof(float));
    channels[i].user_line_stride = (int32_t)(image->width * image->channels * sizeof(float));
    channels[i].decode_to_ptr = (uint8_t *)first;
  }
  return true;
}

static exr_result_t write_chunks(exr_context_t context, const abbe_image *image,
                                 exr_encode_pipeline_t *pipe) {
  int32_t lines = 0;
  exr_result_t rv = exr_get_scanlines_per_chunk(context, 0, &lines);
  for (size_t y = 0; rv == 0 && y < image->height; y += (size_t)lines) {
    exr_chunk_info_t chunk = {0};
    rv = exr_write_scanline_chunk_info(context, 0, (int)y, &chunk);
    if (rv != 0) break;
    rv = y == 0 ? exr_encoding_initialize(context, 0, &chunk, pipe)
                : exr_encoding_update(context, 0, &chunk, pipe);
    if (rv == 0 && !point_channels(pipe->channels, pipe->channel_count, image, 0, y))
      rv = EXR_ERR_UNKNOWN;
    if (rv == 0 && y == 0) rv = exr_encoding_choose_default_routines(context, 0, pipe);
    if (rv == 0) rv = exr_encoding_run(context, 0, pipe);
  }
  return rv;
}

static exr_result_t write_image(stream *s, const abbe_image *image, storage as) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = ignore_error;
  setup.user_data = s;
  setup.write_fn = write_at;
  exr_context_t context = NULL;
  exr_result_t rv = exr_start_write(&context, s->path, EXR_WRITE_FILE_DIRECTLY, &setup);
  if (rv != 0) return rv;
  exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
  rv = write_header(context, image, as);
  if (rv == 0) rv = write_chunks(context, image, &pipe);
  exr_encoding_destroy(context, &pipe);
  exr_result_t finished = exr_finish(&context); /* writes the table of chunks */
  return rv == 0 ? finished : rv;
}

static abbe_result check_image(const char *path, const abbe_image *image, abbe_error *error) {
  if (image->data == NULL || image->channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: the image to write is empty", path);
  for (size_t i = 0; i < image->channels; i++)
    if (abbe_image_find_channel(image, image->channel[i]) != i)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: two channels are named '%s'; names differ in a file", path,
                            image->channel[i]);
  for (size_t i = 0; i < image->attribute_count; i++)
    if (strcmp(image->attribute[i].name, storage_name) == 0 ||
        strcmp(image->attribute[i].name, unit_name) == 0)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: the attribute '%s' belongs to the file itself; another name can "
                            "be written",
                            path, image->attribute[i].name);
  return ABBE_OK;
}

static abbe_result write_file(const char *path, const abbe_image *image, storage as,
                              abbe_error *error) {
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  stream s = {.path = path, .fd = fileno(writer.stream), .size = -1};
  exr_result_t rv = write_image(&s, image, as);
  if (rv == EXR_ERR_SUCCESS && s.io_errno == 0) return abbe_file_writer_commit(&writer, error);
  abbe_file_writer_discard(&writer);
  abbe_result code = s.io_errno != 0               ? ABBE_IO
                     : rv == EXR_ERR_OUT_OF_MEMORY ? ABBE_NO_MEMORY
                                                   : ABBE_INVALID_ARGUMENT;
  return abbe_error_set(error, code, "%s: it cannot be written: %s", path, reason(&s, rv));
}

abbe_result abbe_exr_write(const char *path, const abbe_image *image, abbe_error *error) {
  abbe_result result = check_image(path, image, error);
  if (result != ABBE_OK) return result;
  return write_file(path, image, (storage){.type = EXR_PIXEL_FLOAT, .unit = 1}, error);
}

/* The power of two that half precision needs to hold count values. */
static double half_unit(const float *value, size_t count) {
  const double greatest_half = 65504;
  double most = 0;
  int exponent;
  for (size_t i = 0; i < count; i++)
    if (isfinite(value[i])) most = fmax(most, fabs((double)value[i]));
  if (most == 0 || (most >= 1 && most <= greatest_half)) return 1;
  frexp(most, &exponent); /* most is in [2^(exponent - 1), 2^exponent) */
  return ldexp(1, exponent - 15);
}

abbe_result abbe_exr_write_half(const char *path, const abbe_image *image, abbe_error *error) {
  abbe_result result = check_image(path, image, error);
  if (result != ABBE_OK) return result;
  size_t count = image->width * image->height * image->channels;
  storage as = {.type = EXR_PIXEL_HALF, .unit = half_unit(image->data, count)};
  if (as.unit == 1) return write_file(path, image, as, error);
  abbe_image scaled = *image;
  scaled.data = malloc(count * sizeof *scaled.data);
  if (scaled.data == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for %zu samples", path, count);
  for (size_t i = 0; i < count; i++) scaled.data[i] = (float)((double)image->data[i] / as.unit);
  result = write_file(path, &scaled, as, error);
  free(scaled.data);
  return result;
}

/* Reading */

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

typedef struct layout {
  exr_storage_t storage;
  exr_compression_t compression;
  exr_attr_box2i_t window;
  int64_t width, height;
  const exr_attr_chlist_t *channels;
} layout;

static abbe_result unsupported(const stream *s, const char *what, abbe_error *error) {
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: %s; a flat picture in one part, all channels at full resolution, can",
                        s->path, what);
}

/* No more samples than the file's bytes can hold at the compression's best (deflate packs 1032 to
 * 1, other codecs less, halves become floats; DWA drops whole blocks before it deflates). */
static bool is_bomb(const stream *s, const layout *l) {
  double ratio = l->compression == EXR_COMPRESSION_DWAA || l->compression == EXR_COMPRESSION_DWAB
                     ? 262144
                     : 4096;
  double bytes = (double)l->width * (double)l->height * l->channels->num_channels * sizeof(float);
  return bytes > ratio * (double)s->size;
}

/* OpenEXR 3.1's C core decodes B44 wrongly where a channel is not half, without a complaint. */
static bool decodes_wrongly(const layout *l) {
  if (l->compression != EXR_COMPRESSION_B44 && l->compression != EXR_COMPRESSION_B44A) return false;
  for (int i = 0; i < l->channels->num_channels; i++)
    if (l->channels->entries[i].pixel_type != EXR_PIXEL_HALF) return true;
  return false;
}

static abbe_result check_layout(const stream *s, const layout *l, abbe_error *error) {
  if (l->storage != EXR_STORAGE_SCANLINE && l->storage != EXR_STORAGE_TILED)
    return unsupported(s, "deep data cannot be read", error);
  if (l->channels->num_channels < 1 || l->channels->num_channels > ABBE_IMAGE_MAX_CHANNELS)
    return abbe_error_set(error, ABBE_PARSE, "%s: it has %d channels; 1 to %d can be read", s->path,
                          l->channels->num_channels, ABBE_IMAGE_MAX_CHANNELS);
  for (int i = 0; i < l->channels->num_channels; i++)
    if (l->channels->entries[i].x_sampling != 1 || l->channels->entries[i].y_sampling != 1)
      return unsupported(s, "subsampled channels cannot be read", error);
  if (decodes_wrongly(l))
    return unsupported(s, "B44 compression of other than half channels cannot be read", error);
  if (l->width < 1 || l->height < 1 || l->width > ABBE_IMAGE_MAX_SIDE ||
      l->height > ABBE_IMAGE_MAX_SIDE || is_bomb(s, l))
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: its header promises %lld x %lld pixels and %d channels, which its "
                          "%lld bytes cannot hold or which is over %d a side",
                          s->path, (long long)l->width, (long long)l->height,
                          l->channels->num_channels, (long long)s->size, ABBE_IMAGE_MAX_SIDE);
  return ABBE_OK;
}

static abbe_result read_layout(exr_context_t context, const stream *s, layout *l,
                               abbe_error *error) {
  int parts = 0;
  exr_result_t rv = exr_get_count(context, &parts);
  if (rv == 0 && parts != 1) return unsupported(s, "a file of several parts cannot be read", error);
  if (rv == 0) rv = exr_get_storage(context, 0, &l->storage);
  if (rv == 0) rv = exr_get_compression(context, 0, &l->compression);
  if (rv == 0) rv = exr_get_data_window(context, 0, &l->window);
  if (rv == 0) rv = exr_get_channels(context, 0, &l->channels);
  if (rv != 0) return fail_read(s, rv, error);
  l->width = (int64_t)l->window.max.x - l->window.min.x + 1;
  l->height = (int64_t)l->window.max.y - l->window.min.y + 1;
  return check_layout(s, l, error);
}

/* abbe:stored_unit, which whole files are in; *unit stays what it is where the text is none. */
static bool read_unit(const char *text, double *unit) {
  char *end;
  int exponent;
  double value = strtod(text, &end);
  if (end == text || *end != '\0' || !isfinite(value) || frexp(value, &exponent) != 0.5)
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
    if (strcmp(a->name, storage_name) == 0) continue;
    if (strcmp(a->name, unit_name) == 0) {
      if (read_unit(a->string->str, unit)) continue;
      return abbe_error_set(error, ABBE_PARSE, "%s: %s is '%.40s'; a power of two is right",
                            s->path, unit_name, a->string->str);
    }
    abbe_result result = abbe_image_set_attribute(image, a->name, a->string->str, error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

static abbe_result make_image(exr_context_t context, const stream *s, const layout *l,
                              abbe_image *image, double *unit, abbe_error *error) {
  const char *names[ABBE_IMAGE_MAX_CHANNELS];
  for (int i = 0; i < l->channels->num_channels; i++) names[i] = l->channels->entries[i].name.str;
  abbe_result result = abbe_image_make((size_t)l->width, (size_t)l->height,
                                       (size_t)l->channels->num_channels, names, image, error);
  return result == ABBE_OK ? read_attributes(context, s, image, unit, error) : result;
}

/* Decodes one chunk whose first sample belongs at (x, y); only one that fits is decoded. */
static exr_result_t read_chunk(exr_context_t context, const exr_chunk_info_t *chunk, bool first,
                               exr_decode_pipeline_t *pipe, const abbe_image *image, size_t x,
                               size_t y) {
  if (chunk->width < 1 || chunk->height < 1 || x + (size_t)chunk->width > image->width ||
      y + (size_t)chunk->height > image->height)
    return EXR_ERR_CORRUPT_CHUNK;
  exr_result_t rv = first ? exr_decoding_initialize(context, 0, chunk, pipe)
                          : exr_decoding_update(context, 0, chunk, pipe);
  if (rv == 0 && !point_channels(pipe->channels, pipe->channel_count, image, x, y))
    rv = EXR_ERR_CORRUPT_CHUNK;
  if (rv == 0 && first) rv = exr_decoding_choose_default_routines(context, 0, pipe);
  return rv == 0 ? exr_decoding_run(context, 0, pipe) : rv;
}

static exr_result_t read_lines(exr_context_t context, const layout *l, const abbe_image *image,
                               exr_decode_pipeline_t *pipe) {
  int32_t lines = 0;
  exr_result_t rv = exr_get_scanlines_per_chunk(context, 0, &lines);
  if (rv == 0 && lines < 1) return EXR_ERR_CORRUPT_CHUNK;
  for (size_t y = 0; rv == 0 && y < image->height; y += (size_t)lines) {
    exr_chunk_info_t chunk = {0};
    rv = exr_read_scanline_chunk_info(context, 0, (int)(l->window.min.y + (int64_t)y), &chunk);
    if (rv == 0) rv = read_chunk(context, &chunk, y == 0, pipe, image, 0, y);
  }
  return rv;
}

static exr_result_t read_tiles(exr_context_t context, const abbe_image *image,
                               exr_decode_pipeline_t *pipe) {
  uint32_t w = 0, h = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  exr_result_t rv = exr_get_tile_descriptor(context, 0, &w, &h, &levels, &rounding);
  if (rv == 0 && (w < 1 || h < 1)) return EXR_ERR_CORRUPT_CHUNK;
  for (size_t y = 0; rv == 0 && y < image->height; y += h)
    for (size_t x = 0; rv == 0 && x < image->width; x += w) {
      exr_chunk_info_t chunk = {0};
      rv = exr_read_tile_chunk_info(context, 0, (int)(x / w), (int)(y / h), 0, 0, &chunk);
      if (rv == 0) rv = read_chunk(context, &chunk, x == 0 && y == 0, pipe, image, x, y);
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
  exr_result_t rv = l.storage == EXR_STORAGE_TILED ? read_tiles(context, image, &pipe)
                                                   : read_lines(context, &l, image, &pipe);
  exr_decoding_destroy(context, &pipe);
  size_t count = unit == 1 ? 0 : image->width * image->height * image->channels;
  for (size_t i = 0; i < count; i++) image->data[i] = (float)((double)image->data[i] * unit);
  return rv == 0 ? ABBE_OK : fail_read(s, rv, error);
}

static abbe_result open_stream(stream *s, FILE **file, abbe_error *error) {
  struct stat status;
  *file = fopen(s->path, "rb");
  if (*file == NULL || fstat(fileno(*file), &status) != 0)
    return abbe_error_set(error, ABBE_IO, "%s: it cannot be read: %s", s->path, strerror(errno));
  if (!S_ISREG(status.st_mode))
    return abbe_error_set(error, ABBE_IO, "%s: it is not a file that can be read as a picture",
                          s->path);
  s->fd = fileno(*file);
  s->size = status.st_size;
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
  exr_context_t context = NULL;
  exr_result_t rv = exr_start_read(&context, s->path, &setup);
  if (rv != 0) return fail_read(s, rv, error);
  abbe_result result = read_image(context, s, image, error);
  exr_finish(&context);
  return result;
}

abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error) {
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
