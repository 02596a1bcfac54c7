#include "cli/view/inspect/inspect.h"

#include "base/clock.h"
#include "base/maths.h"
#include "colorimetry/plot/false_colours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, SAMPLES = 256 * 256 };
enum { BYTES = 4 * SIDE * SIDE }; /* of a tile; the byte behind says that it shows what was */
#define LOWEST (-10.0)            /* stops of the histogram of colours, from 0.18 */
#define HIGHEST 6.0
#define MOST_ZOOM 64.0

void abbe_inspect_tiles_free(abbe_inspect_picture *p) {
  for (size_t l = 0; l < ABBE_INSPECT_LEVELS; l++) {
    abbe_inspect_level *level = &p->level[l];
    for (size_t i = 0; level->tile != NULL && i < level->across * level->down; i++)
      free(level->tile[i]);
    free(level->tile);
    *level = (abbe_inspect_level){0};
  }
}

/* Pixels of a picture, and of that which is taken off it. */
typedef struct pair {
  abbe_inspect_source of, less;
} pair;

static void free_pair(pair *from) {
  abbe_image_free(&from->of.own);
  abbe_image_free(&from->less.own);
}

static abbe_result take_pair(const abbe_inspect *s, const abbe_inspect_picture *p, size_t level,
                             const size_t window[4], pair *out, abbe_error *error) {
  *out = (pair){0};
  abbe_result result = abbe_inspect_source_take(p, level, window, &out->of, error);
  if (result == ABBE_OK && s->look.difference)
    result = abbe_inspect_source_take(&s->picture[p->other], level, window, &out->less, error);
  if (result != ABBE_OK) free_pair(out);
  return result;
}

/* What is shown of a pixel: less the other picture's, as one number. */
static void value_at(const abbe_inspect *s, const abbe_inspect_picture *p, const pair *from,
                     size_t x, size_t y, double out[3]) {
  const abbe_inspect_picture *other = &s->picture[p->other];
  double matrix[9], its[3];
  abbe_inspect_mix_at(&p->mix, p, abbe_inspect_source_pixel(&from->of, x, y), out);
  if (!s->look.difference) return;
  abbe_inspect_mix_at(&p->minus, other, abbe_inspect_source_pixel(&from->less, x, y), its);
  for (int k = 0; k < 3; k++) out[k] -= its[k];
  if (abbe_inspect_is_colour(p->mix.kind)) {
    abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
    out[0] = matrix[3] * out[0] + matrix[4] * out[1] + matrix[5] * out[2];
  }
  out[1] = out[2] = out[0];
}

/* ---- scale and histogram ---- */

static bool is_colour(const abbe_inspect *s) {
  return !s->look.difference && abbe_inspect_is_colour(s->picture[s->at].entry[s->look.entry].kind);
}

static void count_bins(abbe_inspect_picture *p, const float *sorted, size_t count, bool colour) {
  memset(p->bin, 0, sizeof p->bin);
  for (size_t i = 0; i < count; i++) {
    const double v = (double)sorted[i];
    const double share = colour ? (log2(fmax(v, 1e-300) / 0.18) - LOWEST) / (HIGHEST - LOWEST)
                                : (v - p->scale.min) / (p->scale.max - p->scale.min);
    const double bin = floor(share * ABBE_INSPECT_BINS);
    p->bin[bin > 0 ? bin < ABBE_INSPECT_BINS - 1 ? (size_t)bin : ABBE_INSPECT_BINS - 1 : 0]++;
  }
}

/* Takes at most SAMPLES pixels, evenly. */
static abbe_result measure(const abbe_inspect *s, abbe_inspect_picture *p, abbe_error *error) {
  const bool colour = is_colour(s);
  const size_t coarse = ABBE_INSPECT_LEVELS; /* what is in memory is enough */
  double matrix[9], v[3];
  size_t step = 1, count = 0;
  pair from;
  ABBE_TRY(take_pair(s, p, coarse, NULL, &from, error));
  while ((p->width / step + 1) * (p->height / step + 1) > SAMPLES) step++;
  float *sorted = malloc((p->width / step + 1) * (p->height / step + 1) * sizeof *sorted);
  if (sorted == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", p->path);
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (size_t y = step / 2; y < p->height; y += step)
    for (size_t x = step / 2; x < p->width; x += step) {
      value_at(s, p, &from, x, y, v);
      if (colour) v[0] = matrix[3] * v[0] + matrix[4] * v[1] + matrix[5] * v[2];
      if (isfinite(v[0])) sorted[count++] = (float)v[0];
    }
  qsort(sorted, count, sizeof *sorted, abbe_order_ascending_floats);
  p->scale = (abbe_chart_field){0};
  abbe_false_colours_scale(sorted, count, false, &p->scale);
  if (s->look.difference) {
    p->scale.map = ABBE_COLOUR_MAP_DIFFERENCE;
    p->scale.min = -p->scale.max;
  }
  const double bright = count > 0 ? (double)sorted[count * 9 / 10] : 0;
  p->stops = bright > 0 ? log2(0.8 / bright) : 0;
  p->least_shown = count > 0 ? (double)sorted[0] : NAN;
  p->most_shown = count > 0 ? (double)sorted[count - 1] : NAN;
  count_bins(p, sorted, count, colour);
  free(sorted);
  return ABBE_OK;
}

/* ---- what is shown ---- */

static bool is_same(const abbe_inspect_look *a, const abbe_inspect_look *b) {
  return a->display == b->display && a->entry == b->entry && a->false_colours == b->false_colours &&
         a->difference == b->difference && a->exposure == b->exposure &&
         a->wavelength_nm == b->wavelength_nm && a->view.observer == b->view.observer &&
         a->view.from == b->view.from && a->view.to == b->view.to;
}

/* The other picture's entry of the same name, or its count. */
static size_t counterpart(const abbe_inspect_picture *p, size_t entry,
                          const abbe_inspect_picture *other) {
  size_t i = 0;
  while (i < other->count && (other->entry[i].kind != p->entry[entry].kind ||
                              strcmp(other->name[i], p->name[entry]) != 0))
    i++;
  return i;
}

/* What is taken off a picture. */
static abbe_result mix_other(const abbe_inspect_picture *p, const abbe_inspect_picture *other,
                             const abbe_inspect_look *look, abbe_inspect_mix *out,
                             abbe_error *error) {
  ABBE_TRY(abbe_image_check_place(&p->image, p->path, &other->image, other->path, error));
  if (p->width != other->width || p->height != other->height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s has %zu x %zu pixels, %s has %zu x %zu: there is no difference",
                          p->path, p->width, p->height, other->path, other->width, other->height);
  const size_t theirs = counterpart(p, look->entry, other);
  if (theirs == other->count)
    return abbe_error_set(error, ABBE_NOT_FOUND, "%s: it has no '%s'", other->path,
                          p->name[look->entry]);
  return abbe_inspect_mix_make(other, &other->entry[theirs], look, out, error);
}

static void replace(abbe_inspect_mix *old, const abbe_inspect_mix *new) {
  abbe_inspect_mix_free(old);
  *old = *new;
}

abbe_result abbe_inspect_show(abbe_inspect *s, size_t at, const abbe_inspect_look *look,
                              abbe_error *error) {
  abbe_inspect_picture *p = &s->picture[at];
  abbe_inspect_look own = *look;
  abbe_inspect_mix mix = {0}, its = {0};
  abbe_result result = ABBE_OK;
  if (at != s->at) own.entry = counterpart(&s->picture[s->at], own.entry, p);
  if (own.entry >= p->count) own.entry = 0;
  own.difference = own.difference && s->count > 1 && at != s->other;
  if (own.difference) result = mix_other(p, &s->picture[s->other], &own, &its, error);
  if (result == ABBE_OK) result = abbe_inspect_mix_make(p, &p->entry[own.entry], &own, &mix, error);
  if (result != ABBE_OK) {
    abbe_inspect_mix_free(&its);
    return result;
  }
  const bool same =
      p->mix.count > 0 && is_same(&p->look, &own) && (!own.difference || p->other == s->other);
  replace(&p->mix, &mix);
  replace(&p->minus, &its);
  p->look = s->look = own;
  p->other = s->other;
  s->at = at;
  if (same && !p->changed) return ABBE_OK;
  if (!same) abbe_inspect_tiles_free(p);
  p->changed = false;
  return measure(s, p, error);
}

/* The zoom at which the whole picture is seen. */
static double whole_zoom(const abbe_inspect_picture *image, size_t width, size_t height) {
  return fmin((double)width / (double)image->width, (double)height / (double)image->height);
}

void abbe_inspect_wheel(abbe_inspect *s, const size_t size[2], const double place[2],
                        double clicks) {
  const abbe_inspect_picture *image = &s->picture[s->at];
  const double side = fmax((double)image->width, (double)image->height), before = s->zoom;
  const double least = fmin(fmin(1, 16 / side), whole_zoom(image, size[0], size[1]));
  s->zoom = fmin(MOST_ZOOM, fmax(least, before * pow(1.25, fmax(-20, fmin(20, clicks)))));
  for (int k = 0; k < 2; k++)
    s->centre[k] += (place[k] - 0.5 * (double)size[k]) * (1 / before - 1 / s->zoom);
}

void abbe_inspect_fit(abbe_inspect *s, size_t width, size_t height) {
  const abbe_inspect_picture *image = &s->picture[s->at];
  s->centre[0] = 0.5 * (double)image->width;
  s->centre[1] = 0.5 * (double)image->height;
  s->zoom = whole_zoom(image, width, height);
  if (s->zoom > 1) s->zoom = fmin(floor(s->zoom), 32);
}

bool abbe_inspect_pixel(const abbe_inspect *s, const size_t size[2], const double place[2],
                        size_t pixel[2]) {
  const abbe_inspect_picture *image = &s->picture[s->at];
  const double most[2] = {(double)image->width, (double)image->height};
  for (int k = 0; k < 2; k++) {
    const double at = floor(s->centre[k] + (place[k] - 0.5 * (double)size[k]) / s->zoom);
    if (!(at >= 0 && at < most[k])) return false;
    pixel[k] = (size_t)at;
  }
  return true;
}

/* ---- tiles ---- */

/* The mean of the image's pixels that a tile's pixel covers, of 4 x 4 at most. */
static void cover(const abbe_inspect *s, const abbe_inspect_picture *p, const pair *from,
                  size_t side, size_t x, size_t y, float out[3]) {
  const size_t step = side > 4 ? side / 4 : 1;
  double sum[3] = {0}, v[3], count = 0;
  for (size_t j = y * side + step / 2; j < (y + 1) * side && j < p->height; j += step)
    for (size_t i = x * side + step / 2; i < (x + 1) * side && i < p->width; i += step) {
      value_at(s, p, from, i, j, v);
      for (int k = 0; k < 3; k++) sum[k] += v[k];
      count++;
    }
  for (int k = 0; k < 3; k++) out[k] = count > 0 ? (float)(sum[k] / count) : 0;
}

static unsigned char byte_of(double v) {
  return (unsigned char)(255 * (v > 0 ? v < 1 ? v : 1 : 0) + 0.5);
}

static void colour_falsely(const abbe_inspect_picture *p, double gain, float rgb[3]) {
  double colour[3];
  const double v = gain * (double)rgb[0];
  abbe_colour_map_at(p->scale.map, (v - p->scale.min) / (p->scale.max - p->scale.min), colour);
  for (int k = 0; k < 3; k++) rgb[k] = (float)colour[k];
}

static abbe_result make_tile(const abbe_inspect *s, const abbe_inspect_picture *p, size_t l,
                             const size_t at[2], unsigned char *out, abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  const double gain = exp2(s->look.exposure);
  const bool is_false = !is_colour(s) && (s->look.false_colours || s->look.difference);
  const size_t first[2] = {at[0] * SIDE << l, at[1] * SIDE << l}, past = ((size_t)SIDE << l) - 1;
  const size_t window[4] = {first[0], first[1], first[0] + past, first[1] + past};
  abbe_image image;
  pair from;
  ABBE_TRY(take_pair(s, p, l, window, &from, error));
  abbe_result result = abbe_image_make(SIDE, SIDE, 3, names, &image, error);
  for (size_t y = 0; y < SIDE && result == ABBE_OK; y++)
    for (size_t x = 0; x < SIDE; x++) {
      float *rgb = image.data + 3 * (y * SIDE + x);
      const size_t px = at[0] * SIDE + x, py = at[1] * SIDE + y;
      if (px << l >= p->width || py << l >= p->height) continue;
      cover(s, p, &from, (size_t)1 << l, px, py, rgb);
      if (is_false) colour_falsely(p, gain, rgb);
      for (int k = 0; k < 3 && !is_false; k++) rgb[k] = (float)(gain * (double)rgb[k]);
    }
  free_pair(&from);
  if (result == ABBE_OK && !is_false) result = abbe_display_apply(s->look.display, &image, error);
  for (size_t i = 0; i < SIDE * SIDE && result == ABBE_OK; i++) {
    for (size_t k = 0; k < 3; k++) out[4 * i + k] = byte_of((double)image.data[3 * i + k]);
    out[4 * i + 3] = 255;
  }
  abbe_image_free(&image);
  return result;
}

static size_t tiles_for(size_t pixels, size_t l) {
  return (((pixels - 1) >> l) + SIDE) / SIDE;
}

static abbe_result begin_level(abbe_inspect_picture *p, size_t l, abbe_error *error) {
  abbe_inspect_level *level = &p->level[l];
  if (level->tile != NULL) return ABBE_OK;
  level->across = tiles_for(p->width, l);
  level->down = tiles_for(p->height, l);
  level->tile = calloc(level->across * level->down, sizeof *level->tile);
  if (level->tile != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its tiles", p->path);
}

/* All tiles where what others look like depends on it. */
static void touch(abbe_inspect_picture *p, const size_t window[4]) {
  const bool all = !abbe_inspect_is_colour(p->mix.kind) || p->look.difference;
  p->changed = true;
  for (size_t l = 0; l < ABBE_INSPECT_LEVELS; l++) {
    const abbe_inspect_level *level = &p->level[l];
    for (size_t i = 0; level->tile != NULL && i < level->across * level->down; i++) {
      const size_t x = (i % level->across * SIDE) << l, y = (i / level->across * SIDE) << l;
      const size_t side = (size_t)SIDE << l;
      const bool apart =
          x > window[2] || y > window[3] || x + side <= window[0] || y + side <= window[1];
      if (level->tile[i] != NULL && (all || !apart)) level->tile[i][BYTES] = true;
    }
  }
}

void abbe_inspect_touch(abbe_inspect *s, size_t at, const size_t window[4]) {
  for (size_t i = 0; i < s->count; i++)
    if (i == at || (s->picture[i].look.difference && s->picture[i].other == at))
      touch(&s->picture[i], window);
}

/* Makes those from tile `from` to `to` that are not there, until the time is over. */
static abbe_result make_tiles(const abbe_inspect *s, abbe_inspect_picture *p, size_t l,
                              const size_t from[2], const size_t to[2], double seconds, bool *whole,
                              abbe_error *error) {
  abbe_inspect_level *level = &p->level[l];
  const double until = abbe_clock_seconds() + seconds;
  bool one = false;
  *whole = true;
  for (size_t y = from[1]; y <= to[1]; y++)
    for (size_t x = from[0]; x <= to[0]; x++) {
      unsigned char **tile = &level->tile[y * level->across + x];
      if (*tile != NULL && !(*tile)[BYTES]) continue;
      *whole = !one || abbe_clock_seconds() < until;
      if (!*whole) return ABBE_OK;
      if (*tile == NULL) *tile = malloc(BYTES + 1);
      abbe_result result = *tile != NULL ? make_tile(s, p, l, (const size_t[2]){x, y}, *tile, error)
                                         : abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
      if (result != ABBE_OK) {
        free(*tile);
        *tile = NULL;
        return result;
      }
      (*tile)[BYTES] = false;
      one = true;
    }
  return ABBE_OK;
}

/* The pixel of the finest tile that is there, from level l on. */
static const unsigned char *find_pixel(const abbe_inspect_picture *p, size_t l, size_t x,
                                       size_t y) {
  for (; l < ABBE_INSPECT_LEVELS; l++, x >>= 1, y >>= 1) {
    const abbe_inspect_level *level = &p->level[l];
    if (level->tile == NULL) continue;
    const unsigned char *tile = level->tile[y / SIDE * level->across + x / SIDE];
    if (tile != NULL) return tile + 4 * (y % SIDE * SIDE + x % SIDE);
  }
  return NULL;
}

/* The tiles of level l that a screen of that size shows; false: none. */
static bool find_tiles(const abbe_inspect *s, const size_t screen[2], size_t l, size_t from[2],
                       size_t to[2]) {
  const abbe_inspect_picture *image = &s->picture[s->at];
  const size_t pixels[2] = {image->width, image->height};
  for (int k = 0; k < 2; k++) {
    const double half = 0.5 * (double)screen[k] / s->zoom, most = (double)pixels[k];
    if (s->centre[k] + half <= 0 || s->centre[k] - half >= most) return false;
    from[k] = ((size_t)fmax(0, s->centre[k] - half) >> l) / SIDE;
    to[k] = ((size_t)fmin(most - 1, s->centre[k] + half) >> l) / SIDE;
  }
  return true;
}

/* Which pixel of the image is at each of the screen's along an axis; SIZE_MAX: none. */
static void find_places(double centre, double zoom, size_t screen, size_t pixels, size_t *out) {
  for (size_t i = 0; i < screen; i++) {
    const double at = floor(centre + ((double)i + 0.5 - 0.5 * (double)screen) / zoom);
    out[i] = at >= 0 && at < (double)pixels ? (size_t)at : SIZE_MAX;
  }
}

abbe_result abbe_inspect_draw(abbe_inspect *s, size_t width, size_t height, double seconds,
                              unsigned char *out, bool *whole, abbe_error *error) {
  static const unsigned char dark[4] = {22, 24, 28, 255};
  abbe_inspect_picture *p = &s->picture[s->at];
  const size_t screen[2] = {width, height};
  size_t l = 0, from[2], to[2];
  size_t *place = malloc((width + height) * sizeof *place);
  if (place == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture");
  while (l + 1 < ABBE_INSPECT_LEVELS && s->zoom * (double)((size_t)2 << l) <= 1) l++;
  abbe_result result = begin_level(p, l, error);
  *whole = true;
  if (result == ABBE_OK && find_tiles(s, screen, l, from, to))
    result = make_tiles(s, p, l, from, to, seconds, whole, error);
  find_places(s->centre[0], s->zoom, width, p->width, place);
  find_places(s->centre[1], s->zoom, height, p->height, place + width);
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x < width; x++) {
      const size_t px = place[x], py = place[width + y];
      const unsigned char *tile =
          px != SIZE_MAX && py != SIZE_MAX ? find_pixel(p, l, px >> l, py >> l) : NULL;
      memcpy(out + 4 * (y * width + x), tile != NULL ? tile : dark, 4);
    }
  free(place);
  return result;
}
