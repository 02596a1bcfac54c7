#include "colorimetry/screen/screen_file.h"

#include "base/file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Each picture has 256 colours of its own: its colours in cells of 5 bits a channel are cut apart
 * at their mean, the box of the greatest sum of squares first [Heckbert1982]; errors of rounding
 * to them go to the pixels beside and below [Floyd1976], so that the mean of an area stays. */
enum { CELLS = 1 << 15, COLOURS = 256, CODES = 4096 };

typedef struct cell {
  double n, sum[3];
} cell;

typedef struct box {
  size_t from, to;
  double n, mean[3], most; /* most: of squares along the axis */
  int axis;
} box;

typedef struct gif {
  FILE *to;
  size_t width, height;
  cell cell[CELLS];
  unsigned order[CELLS];
  unsigned char palette[COLOURS][3];
  int16_t nearest[CELLS];        /* of a cell's middle; -1: not looked for yet */
  uint16_t next[CODES][COLOURS]; /* longer codes; 0: none */
  unsigned long bits;            /* not written yet */
  int bit_count, block_size;
  unsigned char block[255];
} gif;

static unsigned cell_of(const unsigned char *p) {
  return (unsigned)(p[0] >> 3) << 10 | (unsigned)(p[1] >> 3) << 5 | p[2] >> 3;
}

static void measure(const gif *g, box *b) {
  double square[3] = {0}, sum[3] = {0};
  b->n = b->most = 0;
  for (size_t i = b->from; i < b->to; i++) {
    const cell *c = &g->cell[g->order[i]];
    b->n += c->n;
    for (int k = 0; k < 3; k++) {
      sum[k] += c->sum[k];
      square[k] += c->sum[k] * c->sum[k] / c->n;
    }
  }
  for (int k = 0; k < 3; k++) {
    b->mean[k] = sum[k] / b->n;
    const double spread = square[k] - sum[k] * b->mean[k];
    if (b->to - b->from > 1 && spread > b->most) b->most = spread, b->axis = k;
  }
}

/* The cells above the mean go to the box `upper`. */
static void cut(gif *g, box *b, box *upper) {
  size_t low = b->from;
  for (size_t i = b->from; i < b->to; i++) {
    const cell *c = &g->cell[g->order[i]];
    if (c->sum[b->axis] > b->mean[b->axis] * c->n) continue;
    const unsigned other = g->order[low];
    g->order[low++] = g->order[i];
    g->order[i] = other;
  }
  *upper = (box){.from = low, .to = b->to};
  b->to = low;
  measure(g, b);
  measure(g, upper);
}

static void choose_colours(gif *g, const unsigned char *pixel) {
  box boxes[COLOURS] = {{0}};
  size_t used = 0, count = 1;
  memset(g->cell, 0, sizeof g->cell);
  for (size_t i = 0; i < g->width * g->height; i++) {
    cell *c = &g->cell[cell_of(pixel + 3 * i)];
    c->n++;
    for (int k = 0; k < 3; k++) c->sum[k] += pixel[3 * i + k];
  }
  for (unsigned i = 0; i < CELLS; i++)
    if (g->cell[i].n > 0) g->order[used++] = i;
  boxes[0].to = used;
  measure(g, &boxes[0]);
  for (; count < COLOURS; count++) {
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
      if (boxes[i].most > boxes[best].most) best = i;
    if (!(boxes[best].most > 0)) break;
    cut(g, &boxes[best], &boxes[count]);
  }
  for (size_t i = 0; i < COLOURS; i++)
    for (int k = 0; k < 3; k++)
      g->palette[i][k] = (unsigned char)lround(boxes[i < count ? i : 0].mean[k]);
  memset(g->nearest, -1, sizeof g->nearest);
}

static int nearest_of(gif *g, const unsigned char *p) {
  int16_t *found = &g->nearest[cell_of(p)];
  int least = INT32_MAX;
  if (*found >= 0) return *found;
  for (int i = 0; i < COLOURS; i++) {
    int far = 0;
    for (int k = 0; k < 3; k++) {
      const int d = (p[k] | 7) - 3 - g->palette[i][k];
      far += d * d;
    }
    if (far < least) least = far, *found = (int16_t)i;
  }
  return *found;
}

/* index[width * height]. */
static abbe_result dither(const char *path, gif *g, const unsigned char *pixel,
                          unsigned char *index, abbe_error *error) {
  int *owed = calloc(2 * 3 * (g->width + 2), sizeof *owed); /* sixteenths, of two rows */
  if (owed == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its rows", path);
  for (size_t y = 0; y < g->height; y++) {
    int *row = owed + 3 * (y % 2) * (g->width + 2),
        *below = owed + 3 * (1 - y % 2) * (g->width + 2);
    memset(below, 0, 3 * (g->width + 2) * sizeof *below);
    for (size_t x = 0; x < g->width; x++) {
      unsigned char p[3];
      for (int k = 0; k < 3; k++) {
        const int v = pixel[3 * (y * g->width + x) + k] +
                      (row[3 * (x + 1) + k] + 8 + 16 * CELLS) / 16 - CELLS; /* downwards */
        p[k] = (unsigned char)(v < 0 ? 0 : v > 255 ? 255 : v);
      }
      const int at = nearest_of(g, p);
      index[y * g->width + x] = (unsigned char)at;
      for (int k = 0; k < 3; k++) {
        const int e = p[k] - g->palette[at][k];
        row[3 * (x + 2) + k] += 7 * e;
        below[3 * x + k] += 3 * e;
        below[3 * (x + 1) + k] += 5 * e;
        below[3 * (x + 2) + k] += e;
      }
    }
  }
  free(owed);
  return ABBE_OK;
}

/* ---- the file [GIF89a] ---- */

static void put_u16(FILE *to, size_t value) {
  fputc((int)(value & 255), to);
  fputc((int)(value >> 8 & 255), to);
}

static void put_block(gif *g) {
  if (g->block_size == 0) return;
  fputc(g->block_size, g->to);
  fwrite(g->block, 1, (size_t)g->block_size, g->to);
  g->block_size = 0;
}

static void put_code(gif *g, unsigned code, int size) {
  g->bits |= (unsigned long)code << g->bit_count;
  for (g->bit_count += size; g->bit_count >= 8; g->bit_count -= 8, g->bits >>= 8) {
    g->block[g->block_size++] = (unsigned char)(g->bits & 255);
    if (g->block_size == sizeof g->block) put_block(g);
  }
}

/* LZW: codes of 9 bits and, as the table grows, up to 12. */
static void put_indices(gif *g, const unsigned char *index, size_t count) {
  enum { CLEAR = COLOURS, END, FIRST };
  unsigned free_code = FIRST, code = index[0];
  int size = 9;
  fputc(8, g->to);
  memset(g->next, 0, sizeof g->next);
  put_code(g, CLEAR, size);
  for (size_t i = 1; i < count; i++) {
    uint16_t *longer = &g->next[code][index[i]];
    if (*longer != 0) {
      code = *longer;
      continue;
    }
    put_code(g, code, size);
    code = index[i];
    if (free_code == CODES) {
      put_code(g, CLEAR, size);
      memset(g->next, 0, sizeof g->next);
      free_code = FIRST;
      size = 9;
      continue;
    }
    if (free_code == 1u << size) size++;
    *longer = (uint16_t)free_code++;
  }
  put_code(g, code, size);
  put_code(g, END, free_code == 1u << size && size < 12 ? size + 1 : size);
  put_code(g, 0, 7); /* the last byte's rest */
  g->bits = 0;
  g->bit_count = 0;
  put_block(g);
  fputc(0, g->to);
}

static void put_head(const gif *g, bool moves) {
  static const unsigned char screen[] = {0x70, 0, 0}, forever[] = {3, 1, 0, 0, 0};
  fputs("GIF89a", g->to);
  put_u16(g->to, g->width);
  put_u16(g->to, g->height);
  fwrite(screen, 1, sizeof screen, g->to);
  if (!moves) return;
  fputs("!\xff\x0bNETSCAPE2.0", g->to);
  fwrite(forever, 1, sizeof forever, g->to);
}

/* Shown for so many hundredths of a second. */
static abbe_result put_picture(const char *path, gif *g, const unsigned char *pixel,
                               size_t hundredths, abbe_error *error) {
  ABBE_FREED unsigned char *index = malloc(g->width * g->height);
  if (index == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its pixels", path);
  choose_colours(g, pixel);
  ABBE_TRY(dither(path, g, pixel, index, error));
  fputs("!\xf9\x04\x04", g->to); /* the next picture lies on this one */
  put_u16(g->to, hundredths);
  put_u16(g->to, 0);
  fputc(',', g->to);
  put_u16(g->to, 0);
  put_u16(g->to, 0);
  put_u16(g->to, g->width);
  put_u16(g->to, g->height);
  fputc(0x87, g->to);
  fwrite(g->palette, 3, COLOURS, g->to);
  put_indices(g, index, g->width * g->height);
  return ABBE_OK;
}

/* The end of a GIF, or of its beginning. */
static abbe_result end(gif *g, abbe_file_writer *writer, abbe_result result, abbe_error *error) {
  if (result == ABBE_OK) fputc(';', writer->stream);
  free(g);
  return abbe_file_writer_end(writer, result, error);
}

static abbe_result begin(const char *path, abbe_file_writer *writer, gif **out, abbe_error *error) {
  const abbe_result result = abbe_file_writer_open(writer, path, error);
  *out = result == ABBE_OK ? calloc(1, sizeof **out) : NULL;
  if (*out != NULL) (*out)->to = writer->stream;
  return result != ABBE_OK || *out != NULL
             ? result
             : abbe_file_writer_end(
                   writer, abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory", path),
                   error);
}

abbe_result abbe_gif_write(const char *path, const abbe_image *image, int bits, abbe_error *error) {
  abbe_file_writer writer;
  ABBE_FREED unsigned char *pixel = NULL;
  gif *g;
  (void)bits;
  if (abbe_rgb_encoding_is_known(image->xy, image->curve) &&
      !abbe_rgb_encoding_is_srgb(image->xy, image->curve))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a GIF is sRGB, and this display is not; the other kinds of file say "
                          "their colour space",
                          path);
  ABBE_TRY(abbe_screen_file_bytes(path, image, 3, &pixel, error));
  ABBE_TRY(begin(path, &writer, &g, error));
  g->width = image->width;
  g->height = image->height;
  put_head(g, false);
  return end(g, &writer, put_picture(path, g, pixel, 0, error), error);
}

abbe_result abbe_gif_move(const char *path, const char *const *frame, size_t count,
                          double per_second, abbe_error *error) {
  abbe_file_writer writer;
  gif *g;
  abbe_result result = begin(path, &writer, &g, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    const double from = 100 * (double)i / per_second, to = 100 * (double)(i + 1) / per_second;
    unsigned char *pixel;
    result = abbe_screen_file_frame(frame[i], &g->width, &g->height, &pixel, error);
    if (result == ABBE_OK && i == 0) put_head(g, true);
    if (result == ABBE_OK)
      result = put_picture(path, g, pixel, (size_t)(lround(to) - lround(from)), error);
    free(pixel);
  }
  return end(g, &writer, result, error);
}
