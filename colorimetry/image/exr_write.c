#include "colorimetry/image/exr.h"
#include "colorimetry/image/exr_parts.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/picture_space.h"

#include <errno.h>
#include <math.h>
#include <openexr.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef ABBE_HAS_DEFLATE
#include <libdeflate.h>
#endif

typedef struct target {
  const char *path;
  int fd;
  int io_errno; /* error of a failed system call; 0: none */
} target;

/* While a header is written the library holds the lock that exr_get_user_data would take: a writing
 * context returns nothing but its result. */
static void ignore_error(exr_const_context_t context, exr_result_t code, const char *message) {
  (void)context;
  (void)code;
  (void)message;
}

static int64_t write_at(exr_const_context_t context, void *user, const void *buffer, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t fail) {
  target *s = user;
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

/* The parts of a file: what is seen; and where R, G and B have an ID, which would be that of all
 * layers beside them, a part for those that are no colours, as [ColorInterop2026] has it. */
enum { PICTURE, DATA, PARTS };

static bool is_data(const char *channel) {
  static const char *const layers[] = {"stderr.", "covariance.", "normal.", "depth."};
  for (size_t i = 0; i < sizeof layers / sizeof *layers; i++)
    if (strncmp(channel, layers[i], strlen(layers[i])) == 0) return true;
  return false;
}

static bool has_data(const abbe_image *image) {
  for (size_t i = 0; i < image->channels; i++)
    if (is_data(image->channel[i])) return true;
  return false;
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

static exr_result_t write_unit(exr_context_t context, int part, double unit) {
  char text[32];
  if (unit == 1) return EXR_ERR_SUCCESS;
  abbe_number_format(text, sizeof text, "%.17g", unit);
  return exr_attr_set_string(context, part, ABBE_EXR_UNIT_NAME, text);
}

/* *parts: how many the file has. */
static exr_result_t add_parts(exr_context_t context, const abbe_image *image, storage as,
                              int *parts) {
  static const char *const names[PARTS] = {"picture", "data"};
  const char *id = abbe_picture_space_id(image);
  *parts = id != NULL && has_data(image) ? PARTS : 1;
  exr_result_t rv = exr_set_longname_support(context, 1);
  for (int part = 0; rv == 0 && part < *parts; part++) {
    int added = 0;
    rv = exr_add_part(context, *parts > 1 ? names[part] : NULL, EXR_STORAGE_SCANLINE, &added);
    if (rv == 0)
      rv = exr_initialize_required_attr_simple(context, part, (int32_t)image->width,
                                               (int32_t)image->height, EXR_COMPRESSION_ZIP);
    if (rv == 0) rv = write_unit(context, part, as.unit);
    const char *own = part == DATA ? "data" : id;
    if (rv == 0 && own != NULL) rv = exr_attr_set_string(context, part, ABBE_EXR_ID_NAME, own);
  }
  for (size_t i = 0; rv == 0 && i < image->channels; i++)
    rv = exr_add_channel(context, *parts > 1 && is_data(image->channel[i]) ? DATA : PICTURE,
                         image->channel[i], as.type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  return rv;
}

static exr_result_t write_header(exr_context_t context, const abbe_image *image, storage as,
                                 int *parts) {
  exr_result_t rv = add_parts(context, image, as, parts);
  if (rv == 0) rv = write_chromaticities(context, image->xy);
  for (size_t i = 0; rv == 0 && i < image->attribute_count; i++)
    if (strcmp(image->attribute[i].name, ABBE_EXR_ID_NAME) != 0) /* is of what was read */
      rv = exr_attr_set_string(context, 0, image->attribute[i].name, image->attribute[i].text);
  return rv == 0 ? exr_write_header(context) : rv;
}

/* Points every channel of the chunk at its samples, the first of which is in line y. */
static void point_channels(exr_coding_channel_info_t *channels, int count, const abbe_image *image,
                           size_t y) {
  for (int i = 0; i < count; i++) {
    const size_t c = abbe_image_find_channel(image, channels[i].channel_name);
    const float *first = image->data + y * image->width * image->channels + c;
    channels[i].user_bytes_per_element = sizeof(float);
    channels[i].user_data_type = EXR_PIXEL_FLOAT;
    channels[i].user_pixel_stride = (int32_t)(image->channels * sizeof(float));
    channels[i].user_line_stride = (int32_t)(image->width * image->channels * sizeof(float));
    channels[i].encode_from_ptr = (const uint8_t *)first;
  }
}

/* What compresses a part's chunks, of one thread. */
typedef struct codec {
  exr_result_t (*compress)(exr_encode_pipeline_t *pipe); /* the library's, and its own to write */
  exr_result_t (*write)(exr_encode_pipeline_t *pipe);
  void *deflater;
  uint8_t *differences; /* [bytes] what is packed */
  size_t bytes;
} codec;

/* As the library packs for ZIP, in less time; false: it shall itself. The differences of
 * neighbouring bytes, those at even places first. */
static bool deflate(exr_encode_pipeline_t *pipe, codec *own) {
#ifdef ABBE_HAS_DEFLATE
  enum { LEVEL = 1 }; /* higher ones make floats smaller by less than a hundredth */
  const size_t size = pipe->packed_bytes, half = size / 2; /* a sample has 2 or 4 bytes */
  const uint8_t *in = pipe->packed_buffer;
  if (own->deflater == NULL) own->deflater = libdeflate_alloc_compressor(LEVEL);
  if (own->bytes < size) {
    free(own->differences);
    own->differences = malloc(size);
    own->bytes = own->differences != NULL ? size : 0;
  }
  if (pipe->compressed_alloc_size < size) {
    free(pipe->compressed_buffer);
    pipe->compressed_buffer = malloc(size);
    pipe->compressed_alloc_size = pipe->compressed_buffer != NULL ? size : 0;
  }
  uint8_t *a = own->differences;
  if (own->deflater == NULL || a == NULL || pipe->compressed_buffer == NULL) return false;
  for (size_t i = 0; i < half; i++) a[i] = in[2 * i];
  for (size_t i = 0; i < half; i++) a[half + i] = in[2 * i + 1];
  for (size_t i = size - 1; i > 0; i--) a[i] = (uint8_t)(a[i] - a[i - 1] + 128);
  pipe->compressed_bytes =
      libdeflate_zlib_compress(own->deflater, a, size, pipe->compressed_buffer, size);
  if (pipe->compressed_bytes == 0) pipe->compressed_bytes = size; /* it is not made smaller */
  return true;
#else
  (void)pipe;
  (void)own;
  return false;
#endif
}

/* A reader takes a chunk of its samples' size for samples as they are. 3.1.5's ZIP stores them so
 * where packing makes them more, but not where it makes them just as much (mended in 3.4.8). */
static exr_result_t compress(exr_encode_pipeline_t *pipe) {
  codec *own = pipe->encoding_user_data;
  const exr_result_t rv = deflate(pipe, own) ? EXR_ERR_SUCCESS : own->compress(pipe);
  if (rv == 0 && pipe->compressed_bytes == pipe->packed_bytes)
    memcpy(pipe->compressed_buffer, pipe->packed_buffer, pipe->packed_bytes);
  return rv;
}

/* The library takes chunks in the order of their lines alone. */
static exr_result_t write_in_turn(exr_encode_pipeline_t *pipe) {
  exr_result_t rv;
#pragma omp ordered
  rv = ((codec *)pipe->encoding_user_data)->write(pipe);
  return rv;
}

static exr_result_t choose_routines(exr_context_t context, int part, codec *own,
                                    exr_encode_pipeline_t *pipe) {
  const exr_result_t rv = exr_encoding_choose_default_routines(context, part, pipe);
  own->compress = pipe->compress_fn;
  own->write = pipe->write_fn;
  pipe->encoding_user_data = own;
  pipe->compress_fn = compress;
  pipe->write_fn = write_in_turn;
  pipe->yield_until_ready_fn = NULL; /* the library refuses what is not next, and does not wait */
  return rv;
}

static exr_result_t write_chunk(exr_context_t context, int part, const abbe_image *image, size_t y,
                                codec *own, exr_encode_pipeline_t *pipe) {
  exr_chunk_info_t chunk = {0};
  const bool begun = pipe->context != NULL;
  exr_result_t rv = exr_write_scanline_chunk_info(context, part, (int)y, &chunk);
  if (rv != 0) return rv;
  rv = begun ? exr_encoding_update(context, part, &chunk, pipe)
             : exr_encoding_initialize(context, part, &chunk, pipe);
  if (rv == 0) point_channels(pipe->channels, pipe->channel_count, image, y);
  if (rv == 0 && !begun) rv = choose_routines(context, part, own, pipe);
  return rv == 0 ? exr_encoding_run(context, part, pipe) : rv;
}

static exr_result_t write_chunks(exr_context_t context, int part, const abbe_image *image) {
  int32_t lines = 0;
  exr_result_t failed = exr_get_scanlines_per_chunk(context, part, &lines);
  if (failed != 0) return failed;
  const size_t chunks = (image->height + (size_t)lines - 1) / (size_t)lines;
#pragma omp parallel if (image->width * image->height * image->channels > 1 << 18)
  {
    codec own = {0};
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
#pragma omp for ordered schedule(static, 1)
    for (size_t i = 0; i < chunks; i++) {
      exr_result_t rv;
#pragma omp atomic read
      rv = failed;
      if (rv != 0) continue;
      rv = write_chunk(context, part, image, i * (size_t)lines, &own, &pipe);
      if (abbe_exr_starved()) rv = EXR_ERR_OUT_OF_MEMORY;
      if (rv == 0) continue;
#pragma omp atomic write
      failed = rv;
    }
    exr_encoding_destroy(context, &pipe);
#ifdef ABBE_HAS_DEFLATE
    libdeflate_free_compressor(own.deflater);
#endif
    free(own.differences);
  }
  return failed;
}

static exr_result_t write_image(target *s, const abbe_image *image, storage as) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = ignore_error;
  setup.user_data = s;
  setup.write_fn = write_at;
  abbe_exr_allocate_by(&setup);
  exr_context_t context = NULL;
  exr_result_t rv = exr_start_write(&context, s->path, EXR_WRITE_FILE_DIRECTLY, &setup);
  if (rv != 0) return abbe_exr_starved() ? EXR_ERR_OUT_OF_MEMORY : rv;
  int parts = 0;
  rv = write_header(context, image, as, &parts);
  for (int part = 0; rv == 0 && part < parts; part++) rv = write_chunks(context, part, image);
  exr_result_t finished = exr_finish(&context); /* writes the table of chunks */
  if (abbe_exr_starved()) return EXR_ERR_OUT_OF_MEMORY;
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
    if (strcmp(image->attribute[i].name, ABBE_EXR_STORAGE_NAME) == 0 ||
        strcmp(image->attribute[i].name, ABBE_EXR_UNIT_NAME) == 0)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: the attribute '%s' belongs to the file itself; another name can "
                            "be written",
                            path, image->attribute[i].name);
  return ABBE_OK;
}

static abbe_result write_file(const char *path, const abbe_image *image, storage as,
                              abbe_error *error) {
  abbe_file_writer writer = {0};
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  target t = {.path = path, .fd = fileno(writer.stream)};
  exr_result_t rv = write_image(&t, image, as);
  if (rv == EXR_ERR_SUCCESS) return abbe_file_writer_commit(&writer, error);
  abbe_file_writer_discard(&writer);
  abbe_result code = t.io_errno != 0               ? ABBE_IO
                     : rv == EXR_ERR_OUT_OF_MEMORY ? ABBE_NO_MEMORY
                                                   : ABBE_INVALID_ARGUMENT;
  return abbe_error_set(error, code, "%s: could not be written and is as it was: %s", path,
                        t.io_errno != 0 ? strerror(t.io_errno) : exr_get_default_error_message(rv));
}

abbe_result abbe_exr_write(const char *path, const abbe_image *image, abbe_error *error) {
  ABBE_TRY(check_image(path, image, error));
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
  ABBE_TRY(check_image(path, image, error));
  size_t count = image->width * image->height * image->channels;
  storage as = {.type = EXR_PIXEL_HALF, .unit = half_unit(image->data, count)};
  if (as.unit == 1) return write_file(path, image, as, error);
  abbe_image scaled = *image;
  scaled.data = malloc(count * sizeof *scaled.data);
  if (scaled.data == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for %zu samples", path, count);
  for (size_t i = 0; i < count; i++) scaled.data[i] = (float)((double)image->data[i] / as.unit);
  abbe_result result = write_file(path, &scaled, as, error);
  free(scaled.data);
  return result;
}
