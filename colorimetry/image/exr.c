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
  exr_get_user_data(context, &user); /* there is none of no context */
  return user;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message) {
  (void)code;
  abbe_exr_stream *s = stream_of(context);
#pragma omp critical(abbe_exr_message)
  if (s != NULL && s->message[0] == '\0') snprintf(s->message, sizeof s->message, "%s", message);
}

static int64_t read_at(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t fail) {
  abbe_exr_stream *s = user;
  char *bytes = buffer;
  uint64_t done = 0;
  while (done < size) {
    ssize_t n = pread(s->fd, bytes + done, size - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0 && offset + done < (uint64_t)s->size) { /* it has become shorter */
      errno = EIO;
      n = -1;
    }
    if (n < 0) {
      /* an offset past what the system can seek to is the file's lie, not the disk's failure */
      if (errno != EINVAL && errno != EOVERFLOW) s->io_errno = errno;
      fail(context, EXR_ERR_READ_IO, "%s", strerror(errno));
      s->failed =
          true; /* 3.1.5 writes before its buffer where a read of what is not packed is -1 */
      return 0;
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

/* A file whose chunks are read; `first` and what follows are of scan lines alone: the first chunk
 * that is shown, how many are, and of these the one that comes next, `step` chunks after the one
 * before, of all in a pass. In the first pass lines that are not there yet are as the one above
 * them. */
struct abbe_exr_reader {
  abbe_exr_stream stream;
  char *path;
  FILE *file;
  exr_context_t context;
  abbe_exr_source part[2]; /* the picture's, and what is data beside it */
  size_t parts;
  int64_t first, chunks, next, step, read;
  bool again; /* not the first pass */
};

static int channels_of(const abbe_exr_reader *r) {
  const abbe_exr_source *last = &r->part[r->parts - 1];
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

/* The chunks of a layout that go into an image, or into sums of three. */
typedef struct job {
  const abbe_exr_reader *reader;
  const abbe_exr_layout *layout;
  const abbe_image *image;
  abbe_exr_sums *sums; /* NULL: the channels themselves */
  bool repeat;         /* a chunk's last line stands for those up to the next */
  int64_t count, step;
  int level, across;      /* of tiles: the level, and how many stand side by side */
  uint32_t width, height; /* of a tile */
} job;

static bool is_shown(const abbe_exr_place *to, int64_t width, int64_t height) {
  return to->x < (int64_t)to->image->width && to->x + width > 0 &&
         to->y < (int64_t)to->image->height && to->y + height > 0;
}

static void repeat_line(const abbe_image *image, int64_t line, int64_t past) {
  const size_t row = image->width * image->channels;
  for (int64_t y = line + 1; y < past && y < (int64_t)image->height; y++)
    memcpy(image->data + (size_t)y * row, image->data + (size_t)line * row, row * sizeof(float));
}

static abbe_exr_place place_of(const job *j, int64_t x, int64_t y) {
  return (abbe_exr_place){.image = j->image,
                          .sums = j->sums,
                          .x = (int64_t)j->layout->data.min.x - j->layout->display.min.x + x,
                          .y = (int64_t)j->layout->data.min.y - j->layout->display.min.y + y};
}

/* Whether some channel of the part is wanted. */
static bool is_wanted(const abbe_exr_sums *sums, const abbe_exr_source *part) {
  bool wanted = sums == NULL;
  for (int c = 0; !wanted && c < part->layout.channels->num_channels; c++)
    wanted = sums->weight[part->first + c] != NULL;
  return wanted;
}

/* The chunk of all that are shown. */
static exr_result_t read_lines(const job *j, abbe_exr_source *part, int64_t chunk) {
  const abbe_exr_layout *l = j->layout;
  exr_context_t context = j->reader->context;
  int32_t lines = 0;
  const int64_t width = abbe_exr_width(l->data), height = abbe_exr_height(l->data);
  exr_result_t rv = exr_get_scanlines_per_chunk(context, l->part, &lines);
  const int64_t y = (j->reader->first + chunk) * lines;
  const abbe_exr_place to = place_of(j, 0, y);
  for (size_t p = 0; p < j->reader->parts && rv == 0; p++) {
    exr_chunk_info_t info = {0};
    if (!is_wanted(j->sums, &part[p])) continue;
    rv =
        exr_read_scanline_chunk_info(context, part[p].layout.part, (int)(l->data.min.y + y), &info);
    if (rv == 0) rv = abbe_exr_source_read(context, &part[p], &info, width, height - y, &to);
  }
  const int64_t past = y + j->step * lines < height ? y + j->step * lines : height;
  if (rv == 0 && j->repeat) repeat_line(j->image, to.y + lines - 1, to.y - y + past);
  return rv;
}

static exr_result_t read_tile(const job *j, abbe_exr_source *part, int64_t tile) {
  const abbe_exr_layout *l = j->layout;
  exr_chunk_info_t chunk = {0};
  const int64_t column = tile % j->across, row = tile / j->across;
  const int64_t x = column * j->width, y = row * j->height;
  const abbe_exr_place to = place_of(j, x, y);
  if (!is_shown(&to, j->width, j->height)) return EXR_ERR_SUCCESS;
  const exr_result_t rv = exr_read_tile_chunk_info(j->reader->context, l->part, (int)column,
                                                   (int)row, j->level, j->level, &chunk);
  return rv != 0
             ? rv
             : abbe_exr_source_read(j->reader->context, part, &chunk, abbe_exr_width(l->data) - x,
                                    abbe_exr_height(l->data) - y, &to);
}

/* By several threads; which of several broken chunks is complained of is left open. */
static exr_result_t run(const job *j) {
  const abbe_exr_reader *r = j->reader;
  const int64_t numbers = j->count * j->step > 0
                              ? abbe_exr_width(r->part[0].layout.data) *
                                    abbe_exr_height(r->part[0].layout.data) * channels_of(r)
                              : 0;
  (void)numbers; /* where there is no OpenMP */
  exr_result_t failed = EXR_ERR_SUCCESS;
#pragma omp parallel if (numbers / (j->step > 0 ? j->step : 1) > 1 << 20)
  {
    abbe_exr_source own[2] = {r->part[0], r->part[1]};
#pragma omp for schedule(dynamic)
    for (int64_t i = 0; i < j->count; i++) {
      exr_result_t rv;
#pragma omp atomic read
      rv = failed;
      if (rv != 0) continue;
      rv = j->layout->storage == EXR_STORAGE_TILED ? read_tile(j, own, i)
                                                   : read_lines(j, own, i * j->step);
      if (rv == 0) continue;
#pragma omp atomic write
      failed = rv;
    }
    for (size_t p = 0; p < r->parts; p++) abbe_exr_source_free(r->context, &own[p]);
  }
  return failed == 0 && r->stream.failed ? EXR_ERR_READ_IO : failed;
}

static exr_result_t run_tiles(job *j) {
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  const exr_result_t rv = exr_get_tile_descriptor(j->reader->context, j->layout->part, &j->width,
                                                  &j->height, &levels, &rounding);
  if (rv != 0) return rv;
  if (j->width < 1 || j->height < 1) return EXR_ERR_CORRUPT_CHUNK;
  j->step = 1;
  j->across = (int)((abbe_exr_width(j->layout->data) + j->width - 1) / j->width);
  j->count = j->across * ((abbe_exr_height(j->layout->data) + j->height - 1) / j->height);
  return run(j);
}

/* The chunks of lines that are shown. */
static exr_result_t find_lines(abbe_exr_reader *r) {
  const abbe_exr_layout *l = &r->part[0].layout;
  int32_t lines = 0;
  const exr_result_t rv = exr_get_scanlines_per_chunk(r->context, l->part, &lines);
  if (rv != 0 || lines < 1) return rv != 0 ? rv : EXR_ERR_CORRUPT_CHUNK;
  const int64_t above = (int64_t)l->display.min.y - l->data.min.y;
  const int64_t below = (int64_t)l->data.max.y - l->display.max.y;
  const int64_t top = above > 0 ? above : 0;
  const int64_t last = abbe_exr_height(l->data) - 1 - (below > 0 ? below : 0);
  r->first = top / lines;
  r->chunks = last / lines - r->first + 1;
  if (last < top || l->data.max.x < l->display.min.x || l->data.min.x > l->display.max.x)
    r->chunks = 0;
  return EXR_ERR_SUCCESS;
}

/* Each further pass reads the chunks in the middle between those that were read. */
static void advance(abbe_exr_reader *r) {
  r->next += r->again ? 2 * r->step : r->step;
  while (r->next >= r->chunks && r->step > 1) {
    r->again = true;
    r->step /= 2;
    r->next = r->step;
  }
}

/* One of what is no mipmap: of ripmaps OpenEXR's C core 3.1 looks for tiles in wrong chunks. */
static size_t count_levels(exr_context_t context, const abbe_exr_layout *l) {
  int32_t levels = 1, high = 1;
  uint32_t width, height;
  exr_tile_level_mode_t mode = EXR_TILE_ONE_LEVEL;
  exr_tile_round_mode_t rounding;
  const bool same = memcmp(&l->data, &l->display, sizeof l->data) == 0;
  if (l->storage != EXR_STORAGE_TILED || !same) return 1;
  exr_get_tile_descriptor(context, l->part, &width, &height, &mode, &rounding);
  if (mode == EXR_TILE_MIPMAP_LEVELS) exr_get_tile_levels(context, l->part, &levels, &high);
  return (size_t)levels;
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
  if (r->stream.part == NULL)
    ABBE_TRY(abbe_exr_find_data(r->context, &r->stream, picture, data, &r->parts, error));
  if (r->parts == 1) return ABBE_OK;
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
  for (int p = 0; p < 2 && r->context != NULL; p++) abbe_exr_source_free(r->context, &r->part[p]);
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
  job j = {.reader = r, .layout = &l, .image = out, .level = (int)level};
  return finish(r, run_tiles(&j), out, error);
}

/* The first pass of lines, every r->step-th chunk; or all tiles. */
static exr_result_t read_pass(abbe_exr_reader *r, const abbe_image *image, abbe_exr_sums *sums) {
  job j = {.reader = r, .layout = &r->part[0].layout, .image = image, .sums = sums, .repeat = true};
  r->first = r->chunks = r->next = r->read = 0;
  r->again = false;
  if (j.layout->storage == EXR_STORAGE_TILED) return run_tiles(&j);
  exr_result_t rv = find_lines(r);
  j.step = r->step;
  j.count = (r->chunks + r->step - 1) / r->step;
  if (rv == 0) rv = run(&j);
  r->read = j.count;
  r->next = (j.count - 1) * r->step;
  advance(r);
  return rv;
}

abbe_result abbe_exr_read_first(abbe_exr_reader *r, size_t most, abbe_image *out,
                                abbe_error *error) {
  ABBE_TRY(make(r, &r->part[0].layout, out, error));
  for (r->step = 1; out->width * out->height / (size_t)r->step > most / out->channels;)
    r->step *= 2;
  return finish(r, read_pass(r, out, NULL), out, error);
}

abbe_result abbe_exr_read_on(abbe_exr_reader *r, double seconds, abbe_image *image, double *share,
                             abbe_error *error) {
  const double until = abbe_clock_seconds() + seconds;
  const job j = {.reader = r, .layout = &r->part[0].layout, .image = image};
  exr_result_t rv = 0;
  while (rv == 0 && r->read < r->chunks && abbe_clock_seconds() < until) {
    rv = read_lines(&j, r->part, r->next);
    if (rv == 0 && r->stream.failed) rv = EXR_ERR_READ_IO;
    r->read++;
    advance(r);
  }
  *share = r->read < r->chunks ? (double)r->read / (double)r->chunks : 1;
  return rv == 0 ? ABBE_OK : abbe_exr_fail(&r->stream, rv, error);
}

abbe_result abbe_exr_read_header(abbe_exr_reader *r, abbe_image *out, abbe_error *error) {
  ABBE_TRY(make(r, &r->part[0].layout, out, error));
  free(out->data);
  out->data = NULL;
  return ABBE_OK;
}

abbe_result abbe_exr_read_sums(abbe_exr_reader *r, size_t count, const size_t *channel,
                               const double (*weight)[3], const double *factor, abbe_image *out,
                               abbe_image_odd *odd, abbe_error *error) {
  abbe_exr_sums sums = {0};
  for (size_t i = 0; i < count; i++) {
    sums.weight[channel[i]] = weight[i];
    sums.place[channel[i]] = 3 + i < out->channels ? 3 + i : 0;
    sums.factor[channel[i]] = factor[i];
  }
  r->step = 1;
  const exr_result_t rv = read_pass(r, out, &sums);
  *odd = sums.odd;
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
