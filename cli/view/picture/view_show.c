#include "cli/view/picture/view_show.h"

#include "base/thread/watch.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

void abbe_view_pictures_free(abbe_view_pictures *pictures) {
  abbe_image_free(&pictures->rendered);
  abbe_image_free(&pictures->layers);
  abbe_image_free(&pictures->error);
  abbe_image_free(&pictures->traced);
  abbe_image_free(&pictures->map);
  *pictures = (abbe_view_pictures){0};
}

static bool same_size(const abbe_image *a, const abbe_image *b) {
  return a->data != NULL && b->data != NULL && a->width == b->width && a->height == b->height;
}

abbe_view_shown abbe_view_shown_of(const abbe_view_pictures *p, abbe_view_shown wish) {
  switch (wish) {
  case ABBE_VIEW_TRACED_PICTURE:
  case ABBE_VIEW_DIFFERENCE_PICTURE:
    return same_size(&p->rendered, &p->traced) ? wish : ABBE_VIEW_RENDERED_PICTURE;
  case ABBE_VIEW_ERROR_PICTURE:
    return same_size(&p->rendered, &p->error) ? wish : ABBE_VIEW_RENDERED_PICTURE;
  case ABBE_VIEW_CAUSTIC_PICTURE:
  case ABBE_VIEW_DIRECT_PICTURE:
  case ABBE_VIEW_DISTANCE_PICTURE:
    return same_size(&p->rendered, &p->layers) ? wish : ABBE_VIEW_RENDERED_PICTURE;
  case ABBE_VIEW_LUMINANCE_PICTURE:
    return wish;
  case ABBE_VIEW_MAP_PICTURE:
    return p->map.data != NULL ? wish : ABBE_VIEW_RENDERED_PICTURE;
  default:
    return ABBE_VIEW_RENDERED_PICTURE;
  }
}

bool abbe_view_channels(const abbe_image *image, const char *prefix, size_t channel[3]) {
  static const char letters[] = "RGB";
  for (size_t k = 0; k < 3; k++) {
    char name[64];
    snprintf(name, sizeof name, "%.40s%s%c", prefix, prefix[0] != '\0' ? "." : "", letters[k]);
    channel[k] = abbe_image_find_channel(image, name);
    if (channel[k] == (size_t)-1) return false;
  }
  return true;
}

void abbe_view_luminance_weights(double weight[3]) {
  double matrix[9];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (int k = 0; k < 3; k++) weight[k] = matrix[3 + k];
}

double abbe_view_luminance(const double weight[3], const abbe_image *image, const size_t channel[3],
                           size_t pixel) {
  double y = 0;
  for (size_t k = 0; k < 3; k++)
    y += weight[k] * (double)image->data[pixel * image->channels + channel[k]];
  return y;
}

static double mean_luminance(const abbe_image *image, const size_t channel[3]) {
  double sum = 0, weight[3];
  const size_t count = image->width * image->height;
  abbe_view_luminance_weights(weight);
  for (size_t i = 0; i < count; i++) sum += abbe_view_luminance(weight, image, channel, i);
  return sum / (double)count;
}

static unsigned char byte_of(double value) {
  const double seen =
      value > 0 ? value < 1 ? value : 1 : 0; /* no calls, for each part of a pixel */
  return (unsigned char)(255 * seen + 0.5);
}

static void put_colour(abbe_colour_map map, double t, unsigned char out[4]) {
  double rgb[3];
  abbe_colour_map_at(map, t, rgb);
  for (int k = 0; k < 3; k++) out[k] = byte_of(rgb[k]);
  out[3] = 255;
}

/* Shows the rendered picture's luminance, a decade for each third, up to what the exposure has as
 * white. */
static void show_luminance(const abbe_view_pictures *p, double gain, unsigned char *out) {
  size_t channel[3];
  double weight[3];
  if (!abbe_view_channels(&p->rendered, "", channel)) return;
  abbe_view_luminance_weights(weight);
  for (size_t i = 0; i < p->rendered.width * p->rendered.height; i++) {
    const double y = gain * abbe_view_luminance(weight, &p->rendered, channel, i);
    put_colour(ABBE_COLOUR_MAP_AMOUNT, 1 + log10(fmax(1e-30, y)) / 3, out + 4 * i);
  }
}

/* From the nearest to the farthest; black where nothing is seen. */
static void show_distance(const abbe_view_pictures *p, unsigned char *out) {
  const abbe_image *image = &p->layers;
  const size_t z = abbe_image_find_channel(image, "Z"), count = image->width * image->height;
  double near = INFINITY, far = 0;
  for (size_t i = 0; z != (size_t)-1 && i < count; i++) {
    const double d = (double)image->data[image->channels * i + z];
    if (d > 0) near = fmin(near, d);
    far = fmax(far, d);
  }
  for (size_t i = 0; z != (size_t)-1 && i < count; i++) {
    const double d = (double)image->data[image->channels * i + z];
    out[4 * i + 3] = 255;
    if (d > 0)
      put_colour(ABBE_COLOUR_MAP_AMOUNT, far > near ? (d - near) / (far - near) : 0.5, out + 4 * i);
  }
}

/* The map as a square in the middle, so bright that its lit texels have a mean Y of 0.2 before the
 * exposure. */
static void fill_map(const abbe_image *map, double gain, abbe_image *out) {
  const size_t side = out->width < out->height ? out->width : out->height;
  const size_t left = (out->width - side) / 2, above = (out->height - side) / 2;
  double matrix[9], sum = 0, lit = 0;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (size_t i = 0; i < map->width * map->height; i++) {
    const double y = (double)map->data[map->channels * i + 1];
    sum += fmax(0, y);
    lit += y > 0 ? 1 : 0;
  }
  const double scale = sum > 0 ? 0.2 * gain * lit / sum : 0;
  for (size_t y = 0; y < side; y++)
    for (size_t x = 0; x < side; x++) {
      const size_t from = y * map->height / side * map->width + x * map->width / side;
      float *to = &out->data[3 * ((y + above) * out->width + x + left)];
      double xyz[3], rgb[3];
      for (size_t k = 0; k < 3; k++) xyz[k] = scale * (double)map->data[map->channels * from + k];
      abbe_rgb_space_apply(matrix, xyz, rgb);
      for (int k = 0; k < 3; k++) to[k] = (float)rgb[k];
    }
}

/* Errors and differences. */
static void show_false(const abbe_view_pictures *p, abbe_view_shown shown, unsigned char *out) {
  const abbe_image *first = &p->rendered;
  const bool difference = shown == ABBE_VIEW_DIFFERENCE_PICTURE;
  const abbe_image *second = difference ? &p->traced : &p->error;
  size_t a[3], b[3];
  double weight[3];
  abbe_view_luminance_weights(weight);
  if (!abbe_view_channels(first, "", a) ||
      !abbe_view_channels(second, difference ? "" : "stderr", b))
    return;
  const double mean =
      fmax(1e-30, difference ? mean_luminance(second, b) : mean_luminance(first, a));
  for (size_t i = 0; i < first->width * first->height; i++) {
    const double y = abbe_view_luminance(weight, second, b, i);
    double t;
    if (difference)
      t = 0.5 +
          0.5 * (abbe_view_luminance(weight, first, a, i) - y) / (ABBE_VIEW_FULL_DIFFERENCE * mean);
    else
      t = log10(fmax(1e-30, fabs(y)) / (ABBE_VIEW_LEAST_ERROR * mean)) / 3;
    put_colour(difference ? ABBE_COLOUR_MAP_DIFFERENCE : ABBE_COLOUR_MAP_AMOUNT, t, out + 4 * i);
  }
}

/* Some rows, of three channels, to the screen's bytes. */
static abbe_result show_rows(const abbe_image *from, const size_t channel[3], double gain,
                             const abbe_display *display, const abbe_display_table *table,
                             size_t first, abbe_image *rows, unsigned char *out,
                             abbe_error *error) {
  const size_t count = rows->width * rows->height, before = first * rows->width;
  const float *data = from->data + from->channels * before;
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < 3; k++)
      rows->data[3 * i + k] = (float)(gain * (double)data[from->channels * i + channel[k]]);
  ABBE_TRY(table != NULL ? abbe_display_table_apply(table, rows, error)
                         : abbe_display_apply(display, rows, error));
  for (size_t i = 0; i < count; i++) {
    for (size_t k = 0; k < 3; k++)
      out[4 * (before + i) + k] = byte_of((double)rows->data[3 * i + k]);
    out[4 * (before + i) + 3] = 255;
  }
  return ABBE_OK;
}

/* Part by part, and between them it may be given up. */
static abbe_result show_colours(const abbe_image *from, const size_t channel[3], double gain,
                                const abbe_display *display, const abbe_display_table *table,
                                unsigned char *out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  enum { ROWS = 16 };
  ABBE_OWNED(abbe_image, rows) = {0};
  ABBE_TRY(abbe_image_make(from->width, from->height < ROWS ? from->height : ROWS, 3, names, &rows,
                           error));
  for (size_t y = 0; y < from->height; y += rows.height) {
    if (from->height - y < rows.height) rows.height = from->height - y;
    ABBE_TRY(abbe_watch_check(error));
    ABBE_TRY(show_rows(from, channel, gain, display, table, y, &rows, out, error));
  }
  return ABBE_OK;
}

abbe_result abbe_view_show(const abbe_view_pictures *p, abbe_view_shown shown, double exposure,
                           const abbe_display *display, const abbe_display_table *table,
                           unsigned char **out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  const size_t count = p->rendered.width * p->rendered.height;
  const double gain = exp2(exposure);
  *out = calloc(count + 1, 4);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to show the picture");
  shown = abbe_view_shown_of(p, shown);
  if (shown == ABBE_VIEW_ERROR_PICTURE || shown == ABBE_VIEW_DIFFERENCE_PICTURE) {
    show_false(p, shown, *out);
    return ABBE_OK;
  }
  if (shown == ABBE_VIEW_LUMINANCE_PICTURE || shown == ABBE_VIEW_DISTANCE_PICTURE) {
    if (shown == ABBE_VIEW_LUMINANCE_PICTURE)
      show_luminance(p, gain, *out);
    else
      show_distance(p, *out);
    return ABBE_OK;
  }
  const char *layer = shown == ABBE_VIEW_CAUSTIC_PICTURE  ? "caustic"
                      : shown == ABBE_VIEW_DIRECT_PICTURE ? "direct"
                                                          : "";
  const abbe_image *from = shown == ABBE_VIEW_TRACED_PICTURE ? &p->traced
                           : layer[0] != '\0'                ? &p->layers
                                                             : &p->rendered;
  size_t channel[3] = {0, 1, 2};
  abbe_image map = {0};
  const bool maps = shown == ABBE_VIEW_MAP_PICTURE;
  abbe_result result = maps ? abbe_image_make(from->width, from->height, 3, names, &map, error)
                       : abbe_view_channels(from, layer, channel)
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NOT_FOUND, "the picture has no such layer");
  if (result == ABBE_OK && maps) fill_map(&p->map, gain, &map);
  if (result == ABBE_OK)
    result =
        show_colours(maps ? &map : from, channel, maps ? 1 : gain, display, table, *out, error);
  abbe_image_free(&map);
  if (result == ABBE_OK) return ABBE_OK;
  free(*out);
  *out = NULL;
  return result;
}

struct abbe_view_table {
  pthread_t thread;
  const abbe_display *display;
  _Atomic(abbe_display_table *) made;
};

static void *make(void *user) {
  abbe_view_table *table = user;
  abbe_display_table *made = NULL;
  if (abbe_display_table_make(table->display, &made, NULL) == ABBE_OK)
    atomic_store(&table->made, made);
  return NULL;
}

abbe_view_table *abbe_view_table_begin(const abbe_display *display) {
  abbe_view_table *table = malloc(sizeof *table);
  if (table == NULL) return NULL;
  table->display = display;
  atomic_init(&table->made, NULL);
  if (pthread_create(&table->thread, NULL, make, table) == 0) return table;
  free(table);
  return NULL;
}

const abbe_display_table *abbe_view_table_get(const abbe_view_table *table) {
  return table != NULL ? atomic_load(&table->made) : NULL;
}

void abbe_view_table_free(abbe_view_table *table) {
  if (table == NULL) return;
  pthread_join(table->thread, NULL);
  abbe_display_table_free(atomic_load(&table->made));
  free(table);
}

struct abbe_view_painter {
  pthread_t thread;
  pthread_mutex_t lock;
  pthread_cond_t signal;
  void (*wake)(void);
  atomic_bool stops;
  bool quits, given, done;
  abbe_view_painting painting;
  unsigned char *pixels;
  abbe_result result;
  abbe_error error;
};

static bool is_wanted(void *user) {
  const abbe_view_painter *p = user;
  return !atomic_load(&p->stops);
}

/* The painter's thread, which holds the lock. */
static void paint(abbe_view_painter *p) {
  const abbe_view_painting *g = &p->painting;
  abbe_error error = {0};
  unsigned char *pixels = NULL;
  pthread_mutex_unlock(&p->lock);
  const abbe_result result =
      abbe_view_show(g->pictures, g->shown, g->exposure, g->display, NULL, &pixels, &error);
  pthread_mutex_lock(&p->lock);
  p->pixels = pixels;
  p->result = result;
  p->error = error;
  p->done = true;
  pthread_cond_broadcast(&p->signal);
  if (p->wake != NULL && !atomic_load(&p->stops)) p->wake();
}

static void *run(void *user) {
  abbe_view_painter *p = user;
  abbe_watch watch = {.goes_on = is_wanted, .user = p};
  pthread_mutex_lock(&p->lock);
  while (!p->quits) {
    if (!p->given || p->done) {
      pthread_cond_wait(&p->signal, &p->lock);
      continue;
    }
    watch.over = false;
    abbe_watch_set(&watch);
    paint(p);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

abbe_result abbe_view_painter_make(void (*wake)(void), abbe_view_painter **out, abbe_error *error) {
  abbe_view_painter *p = calloc(1, sizeof *p);
  *out = NULL;
  if (p == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the viewer");
  p->wake = wake;
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->signal, NULL);
  if (pthread_create(&p->thread, NULL, run, p) == 0) {
    *out = p;
    return ABBE_OK;
  }
  pthread_cond_destroy(&p->signal);
  pthread_mutex_destroy(&p->lock);
  free(p);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no thread for the viewer's screen");
}

void abbe_view_painter_free(abbe_view_painter *p) {
  if (p == NULL) return;
  abbe_view_painter_stop(p);
  pthread_mutex_lock(&p->lock);
  p->quits = true;
  pthread_cond_broadcast(&p->signal);
  pthread_mutex_unlock(&p->lock);
  pthread_join(p->thread, NULL);
  pthread_cond_destroy(&p->signal);
  pthread_mutex_destroy(&p->lock);
  free(p);
}

void abbe_view_painter_give(abbe_view_painter *p, const abbe_view_painting *painting) {
  pthread_mutex_lock(&p->lock);
  p->painting = *painting;
  p->given = true;
  p->done = false;
  atomic_store(&p->stops, false);
  pthread_cond_broadcast(&p->signal);
  pthread_mutex_unlock(&p->lock);
}

/* The one who gives and takes alone changes that. */
const abbe_view_painting *abbe_view_painter_has(const abbe_view_painter *p) {
  return p->given ? &p->painting : NULL;
}

void abbe_view_painter_stop(abbe_view_painter *p) {
  if (p == NULL || !p->given) return;
  atomic_store(&p->stops, true);
  pthread_mutex_lock(&p->lock);
  while (!p->done) pthread_cond_wait(&p->signal, &p->lock);
  free(p->pixels);
  p->pixels = NULL;
  p->given = p->done = false;
  pthread_mutex_unlock(&p->lock);
}

bool abbe_view_painter_take(abbe_view_painter *p, unsigned char **pixels, abbe_result *result,
                            abbe_error *error) {
  pthread_mutex_lock(&p->lock);
  const bool there = p->given && p->done;
  if (there) {
    *pixels = p->pixels;
    *result = p->result;
    if (error != NULL) *error = p->error;
    p->pixels = NULL;
    p->given = p->done = false;
  }
  pthread_mutex_unlock(&p->lock);
  return there;
}
