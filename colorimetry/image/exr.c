#include "colorimetry/image/exr.h"

#include "base/clock.h"
#include "base/file.h"
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

static abbe_image_window window_of(exr_attr_box2i_t box) {
  return (abbe_image_window){box.min.x, box.min.y, box.max.x, box.max.y};
}

/* A part whose chunks are read into the picture's channels from `first` on. */
typedef struct source {
  abbe_exr_layout layout;
  exr_decode_pipeline_t pipe;
  exr_result_t (*decompress)(exr_decode_pipeline_t *pipe); /* the library's; NULL: nothing packs */
  double unit;
  int first;
} source;

/* A file whose chunks are read; `next` and what follows are of scan lines alone: the chunk that
 * comes next, `step` chunks after the one before, of all in a pass. In the first pass lines that
 * are not there yet are as the one above them. */
struct abbe_exr_reader {
  abbe_exr_stream stream;
  char *path;
  FILE *file;
  exr_context_t context;
  source part[2]; /* the picture's, and what is data beside it */
  size_t parts;
  int64_t next, step, read, chunks;
  bool again; /* not the first pass */
};

static int channels_of(const abbe_exr_reader *r) {
  const source *last = &r->part[r->parts - 1];
  return last->first + last->layout.channels->num_channels;
}

/* A picture of the display window, all 0. */
static abbe_result make_image(abbe_exr_reader *r, const abbe_exr_layout *l, abbe_image *image,
                              abbe_error *error) {
  const char *names[ABBE_IMAGE_MAX_CHANNELS];
  for (size_t p = 0; p < r->parts; p++)
    for (int i = 0; i < r->part[p].layout.channels->num_channels; i++)
      names[r->part[p].first + i] = r->part[p].layout.channels->entries[i].name.str;
  abbe_result result =
      abbe_image_make((size_t)abbe_exr_width(l->display), (size_t)abbe_exr_height(l->display),
                      (size_t)channels_of(r), names, image, error);
  image->display_window = window_of(l->display);
  image->data_window = window_of(l->data);
  if (l->parts > (int)r->parts)
    snprintf(image->part, sizeof image->part, "%d%s%.24s%s of %d", l->part + 1, l->name ? " '" : "",
             l->name ? l->name : "", l->name ? "'" : "", l->parts);
  for (size_t p = 0; p < r->parts && result == ABBE_OK; p++)
    result =
        abbe_exr_unit_read(r->context, r->part[p].layout.part, &r->stream, &r->part[p].unit, error);
  return result == ABBE_OK ? abbe_exr_attributes_read(r->context, l->part, &r->stream, image, error)
                           : result;
}

/* Where the chunk that is decoded goes: its first sample belongs to the picture's pixel (x, y),
 * which may lie outside. */
typedef struct place {
  const source *part;
  const abbe_image *image;
  int64_t x, y;
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
        image->data[(y * width + to->x + x) * (int64_t)image->channels + to->part->first + c] =
            (float)(to->part->unit * (double)sample_of(line + x * bytes, type));
      line += chunk_width * bytes;
    }
  return EXR_ERR_SUCCESS;
}

/* What no codec made smaller is stored as it is; 3.1 forgets that for B44. */
static exr_result_t decompress(exr_decode_pipeline_t *pipe) {
  const place *to = pipe->decoding_user_data;
  if (pipe->chunk.packed_size == pipe->chunk.unpacked_size) return EXR_ERR_SUCCESS;
  return to->part->decompress == NULL ? EXR_ERR_CORRUPT_CHUNK : to->part->decompress(pipe);
}

static exr_result_t begin(exr_context_t context, source *from, const exr_chunk_info_t *chunk) {
  const int part = from->layout.part;
  exr_result_t rv = exr_decoding_initialize(context, part, chunk, &from->pipe);
  if (rv == 0) rv = exr_decoding_choose_default_routines(context, part, &from->pipe);
  from->decompress = from->pipe.decompress_fn;
  from->pipe.decompress_fn = decompress;
  from->pipe.unpack_and_convert_fn = unpack;
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
static exr_result_t read_chunk(exr_context_t context, source *from, const exr_chunk_info_t *chunk,
                               int64_t width, int64_t height, place *to) {
  if (chunk->width < 1 || chunk->height < 1 || chunk->width > width || chunk->height > height)
    return EXR_ERR_CORRUPT_CHUNK;
  exr_result_t rv = from->pipe.context == NULL
                        ? begin(context, from, chunk)
                        : exr_decoding_update(context, from->layout.part, chunk, &from->pipe);
  to->part = from;
  from->pipe.decoding_user_data = to;
  if (rv == 0 && !is_whole(&from->pipe)) rv = EXR_ERR_CORRUPT_CHUNK;
  if (rv == 0) rv = exr_decoding_run(context, from->layout.part, &from->pipe);
  return abbe_exr_starved() ? EXR_ERR_OUT_OF_MEMORY : rv;
}

static bool is_shown(const place *to, int64_t width, int64_t height) {
  return to->x < (int64_t)to->image->width && to->x + width > 0 &&
         to->y < (int64_t)to->image->height && to->y + height > 0;
}

static void repeat_line(const abbe_image *image, int64_t line, int64_t past) {
  const size_t row = image->width * image->channels;
  if (line < 0) return;
  for (int64_t y = line + 1; y < past && y < (int64_t)image->height; y++)
    memcpy(image->data + (size_t)y * row, image->data + (size_t)line * row, row * sizeof(float));
}

/* Chunks of which nothing is shown are not decoded. */
static exr_result_t read_lines(abbe_exr_reader *r, int64_t chunk, const abbe_image *image) {
  const abbe_exr_layout *l = &r->part[0].layout;
  int32_t lines = 0;
  const int64_t width = abbe_exr_width(l->data), height = abbe_exr_height(l->data);
  const int64_t dx = (int64_t)l->data.min.x - l->display.min.x;
  const int64_t dy = (int64_t)l->data.min.y - l->display.min.y;
  exr_result_t rv = exr_get_scanlines_per_chunk(r->context, l->part, &lines);
  if (rv != 0 || lines < 1) return rv != 0 ? rv : EXR_ERR_CORRUPT_CHUNK;
  const int64_t y = chunk * lines;
  r->chunks = (height + lines - 1) / lines;
  place to = {.image = image, .x = dx, .y = dy + y};
  if (!is_shown(&to, width, lines)) return 0;
  for (size_t p = 0; p < r->parts && rv == 0; p++) {
    exr_chunk_info_t info = {0};
    rv = exr_read_scanline_chunk_info(r->context, r->part[p].layout.part, (int)(l->data.min.y + y),
                                      &info);
    if (rv == 0) rv = read_chunk(r->context, &r->part[p], &info, width, height - y, &to);
  }
  const int64_t past = y + r->step * lines < height ? y + r->step * lines : height;
  if (rv == 0 && !r->again) repeat_line(image, dy + y + lines - 1, dy + past);
  return rv;
}

/* The next chunk; of what is there each further pass reads those in the middle between. */
static exr_result_t read_next(abbe_exr_reader *r, const abbe_image *image) {
  const exr_result_t rv = read_lines(r, r->next, image);
  r->read++;
  r->next += r->again ? 2 * r->step : r->step;
  while (r->next >= r->chunks && r->step > 1) {
    r->again = true;
    r->step /= 2;
    r->next = r->step;
  }
  return rv;
}

static exr_result_t read_tiles(abbe_exr_reader *r, const abbe_exr_layout *l, int level,
                               const abbe_image *image) {
  exr_context_t context = r->context;
  uint32_t w = 0, h = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  const int64_t width = abbe_exr_width(l->data), height = abbe_exr_height(l->data);
  place to = {.image = image};
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
      if (rv == 0) rv = read_chunk(context, &r->part[0], &chunk, width - x, height - y, &to);
    }
  return rv;
}

static size_t count_levels(exr_context_t context, const abbe_exr_layout *l) {
  int32_t x = 1, y = 1;
  const bool same = memcmp(&l->data, &l->display, sizeof l->data) == 0;
  if (l->storage != EXR_STORAGE_TILED || !same ||
      exr_get_tile_levels(context, l->part, &x, &y) != 0)
    return 1;
  return (size_t)(x < y ? x : y);
}

/* The layout becomes that of a level, whose first pixel is (0, 0), and of a window in it. */
static abbe_result choose_level(const abbe_exr_reader *r, size_t level, const size_t *w,
                                abbe_exr_layout *l, abbe_error *error) {
  int32_t width = 0, height = 0;
  const abbe_exr_stream *s = &r->stream;
  if (level >= count_levels(r->context, l))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: it has no level %zu", s->path, level);
  width = (int32_t)abbe_exr_width(l->data);
  height = (int32_t)abbe_exr_height(l->data);
  exr_result_t rv = 0;
  if (level > 0)
    rv = exr_get_level_sizes(r->context, l->part, (int)level, (int)level, &width, &height);
  if (rv != 0) return abbe_exr_fail(s, rv, error);
  l->data.min.x = l->data.min.y = 0;
  l->data.max.x = width - 1;
  l->data.max.y = height - 1;
  l->display = l->data;
  if (w == NULL) return ABBE_OK;
  if (w[0] > w[2] || w[1] > w[3] || w[2] >= (size_t)width || w[3] >= (size_t)height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: pixels %zu, %zu to %zu, %zu are not in its level %zu of %d x %d",
                          s->path, w[0], w[1], w[2], w[3], level, (int)width, (int)height);
  l->display.min.x = (int32_t)w[0];
  l->display.min.y = (int32_t)w[1];
  l->display.max.x = (int32_t)w[2];
  l->display.max.y = (int32_t)w[3];
  return ABBE_OK;
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

static exr_result_t start(abbe_exr_reader *r) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = on_error;
  setup.user_data = &r->stream;
  setup.read_fn = read_at;
  setup.size_fn = stream_size;
  setup.max_image_width = setup.max_image_height = ABBE_IMAGE_MAX_SIDE;
  setup.max_tile_width = setup.max_tile_height = ABBE_IMAGE_MAX_SIDE;
  setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  abbe_exr_allocate_by(&setup);
  const exr_result_t rv = exr_start_read(&r->context, r->path, &setup);
  return abbe_exr_starved() ? EXR_ERR_OUT_OF_MEMORY : rv;
}

/* A part that is asked for by its name comes alone. */
static abbe_result find_parts(abbe_exr_reader *r, abbe_error *error) {
  abbe_exr_layout *picture = &r->part[0].layout, *data = &r->part[1].layout;
  r->parts = 1;
  ABBE_TRY(abbe_exr_layout_find(r->context, &r->stream, picture, error));
  if (r->stream.part != NULL || !abbe_exr_find_data(r->context, picture, data)) return ABBE_OK;
  r->parts = 2;
  r->part[1].first = picture->channels->num_channels;
  return abbe_exr_check_layout(&r->stream, data, channels_of(r), error);
}

abbe_result abbe_exr_open(const char *path, abbe_exr_reader **out, abbe_error *error) {
  abbe_exr_reader *r = calloc(1, sizeof *r);
  *out = NULL;
  if (r != NULL) r->path = strdup(path);
  if (r == NULL || r->path == NULL) {
    free(r);
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
  }
  r->stream = (abbe_exr_stream){.path = r->path, .fd = -1};
  abbe_result result = open_stream(&r->stream, &r->file, error);
  const exr_result_t rv = result == ABBE_OK ? start(r) : 0;
  if (rv != 0) result = abbe_exr_fail_open(&r->stream, rv, error);
  if (result == ABBE_OK) result = find_parts(r, error);
  if (result == ABBE_OK)
    *out = r;
  else
    abbe_exr_close(r);
  return result;
}

void abbe_exr_close(abbe_exr_reader *r) {
  if (r == NULL) return;
  for (int p = 0; p < 2 && r->context != NULL; p++)
    exr_decoding_destroy(r->context, &r->part[p].pipe);
  if (r->context != NULL) exr_finish(&r->context);
  if (r->file != NULL) fclose(r->file);
  free(r->path);
  free(r);
}

void abbe_exr_find_levels(const abbe_exr_reader *r, abbe_exr_levels *out) {
  const abbe_exr_layout *l = &r->part[0].layout;
  *out = (abbe_exr_levels){count_levels(r->context, l), (size_t)abbe_exr_width(l->display),
                           (size_t)abbe_exr_height(l->display), (size_t)channels_of(r)};
}

/* What of an image could be made is given up where it cannot be read. */
static abbe_result finish(const abbe_exr_reader *r, exr_result_t rv, abbe_image *image,
                          abbe_error *error) {
  if (rv == 0) return ABBE_OK;
  abbe_image_free(image);
  return abbe_exr_fail(&r->stream, rv, error);
}

static abbe_result make(abbe_exr_reader *r, const abbe_exr_layout *l, abbe_image *out,
                        abbe_error *error) {
  *out = (abbe_image){0};
  const abbe_result result = make_image(r, l, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}

abbe_result abbe_exr_read_level(abbe_exr_reader *r, size_t level, const size_t window[4],
                                abbe_image *out, abbe_error *error) {
  abbe_exr_layout l = r->part[0].layout;
  *out = (abbe_image){0};
  if (l.storage != EXR_STORAGE_TILED)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: it has no levels", r->path);
  ABBE_TRY(choose_level(r, level, window, &l, error));
  ABBE_TRY(make(r, &l, out, error));
  return finish(r, read_tiles(r, &l, (int)level, out), out, error);
}

abbe_result abbe_exr_read_first(abbe_exr_reader *r, size_t most, abbe_image *out,
                                abbe_error *error) {
  const abbe_exr_layout *l = &r->part[0].layout;
  exr_result_t rv = 0;
  ABBE_TRY(make(r, l, out, error));
  r->next = r->read = 0;
  r->again = false;
  for (r->step = 1; out->width * out->height / (size_t)r->step > most / out->channels;)
    r->step *= 2;
  if (l->storage == EXR_STORAGE_TILED) {
    rv = read_tiles(r, l, 0, out);
  } else {
    do rv = read_next(r, out);
    while (rv == 0 && !r->again && r->next < r->chunks);
  }
  return finish(r, rv, out, error);
}

abbe_result abbe_exr_read_on(abbe_exr_reader *r, double seconds, abbe_image *image, double *share,
                             abbe_error *error) {
  const double until = abbe_clock_seconds() + seconds;
  exr_result_t rv = 0;
  while (rv == 0 && r->read < r->chunks && abbe_clock_seconds() < until) rv = read_next(r, image);
  *share = r->read < r->chunks ? (double)r->read / (double)r->chunks : 1;
  return rv == 0 ? ABBE_OK : abbe_exr_fail(&r->stream, rv, error);
}

abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error) {
  abbe_exr_reader *r = NULL;
  *out = (abbe_image){0};
  ABBE_TRY(abbe_exr_open(path, &r, error));
  const abbe_result result = abbe_exr_read_first(r, SIZE_MAX, out, error);
  abbe_exr_close(r);
  return result;
}
