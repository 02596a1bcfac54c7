#include "colorimetry/image/display_table.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A part x of a colour stands at the logarithm of 1 + FINEST x, taken as linear between powers of
 * two: its bits as a float are that. So many nodes to each power, up to the last. */
enum { POWERS = 16, PER_POWER = 3, NODES = POWERS * PER_POWER + 1 };
enum { ONE = 127 << 23, POWER = 1 << 23 }; /* bits of 1.0f; of twice as much, more */
static const float finest = 1024;
static const float most_off = 1.5F / 255; /* over the cells that are used */

struct abbe_display_table {
  const abbe_display *display;
  /* red runs fastest; the fourth: how far the middle of the cell from there on is off */
  float node[NODES * NODES * NODES][4];
};

static const size_t stride[3] = {1, NODES, (size_t)NODES *NODES};

static float part_at(double place) {
  const int32_t bits = ONE + (int32_t)(place * POWER / PER_POWER);
  float u;
  memcpy(&u, &bits, sizeof u);
  return (u - 1) / finest;
}

/* In nodes; below 0 or above the last where the table does not reach, or not a number. */
static float place_of(float part) {
  const float u = 1 + finest * part;
  int32_t bits;
  memcpy(&bits, &u, sizeof bits);
  if (!(u >= 1)) return -1;
  return (float)(bits - ONE) * ((float)PER_POWER / POWER);
}

static abbe_result show_colours(const abbe_display *display, float (*rgb)[3], size_t count,
                                abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  enum { ROW = 1024 }; /* images have a widest side */
  ABBE_OWNED(abbe_image, image) = {0};
  ABBE_TRY(abbe_image_make(ROW, (count + ROW - 1) / ROW, 3, names, &image, error));
  memcpy(image.data, rgb, count * sizeof *rgb);
  ABBE_TRY(abbe_display_apply(display, &image, error));
  memcpy(rgb, image.data, count * sizeof *rgb);
  return ABBE_OK;
}

/* What all nodes show, or the places so far beyond each. */
static abbe_result show_places(const abbe_display *display, double beyond, float (*rgb)[3],
                               abbe_error *error) {
  const size_t count = (size_t)NODES * NODES * NODES;
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) rgb[i][k] = part_at((double)(i / stride[k] % NODES) + beyond);
  return show_colours(display, rgb, count, error);
}

static float seen(float value) {
  return value > 0 ? value < 1 ? value : 1 : 0;
}

/* Whether a part of what the cell's corners show is less than half at one of what it is at another,
 * or full at one and not nearly at another: it goes to black, where curves are steep, or clips. */
static bool goes_far(const abbe_display_table *t, size_t cell, int part) {
  float least = INFINITY, most = -INFINITY;
  for (int k = 0; k < 8; k++) {
    const size_t at = cell + (k & 1) * stride[0] + (k >> 1 & 1) * stride[1] + (k >> 2) * stride[2];
    least = fminf(least, t->node[at][part]);
    most = fmaxf(most, t->node[at][part]);
  }
  const float much = 4 * most_off;
  return (least < 0.5F * most && most > much) || (most > 0.9999F && least < 1 - much);
}

/* middle: what the middles of cells show, between whose least and greatest corners they lie. */
static void find_errors(abbe_display_table *t, float (*middle)[3]) {
  const size_t count = (size_t)NODES * NODES * NODES, across = stride[0] + stride[1] + stride[2];
  for (size_t i = 0; i < count; i++) {
    float off = 0;
    for (int k = 0; k < 3 && i + across < count; k++) {
      const float between = 0.5F * (t->node[i][k] + t->node[i + across][k]);
      off = fmaxf(off, fabsf(seen(between) - seen(middle[i][k])));
      if (goes_far(t, i, k)) off = 1;
    }
    t->node[i][3] = off;
  }
}

abbe_result abbe_display_table_make(const abbe_display *display, abbe_display_table **out,
                                    abbe_error *error) {
  const size_t count = (size_t)NODES * NODES * NODES;
  abbe_display_table *table = malloc(sizeof *table);
  float(*rgb)[3] = malloc(count * sizeof *rgb);
  abbe_result result = ABBE_OK;
  *out = NULL;
  if (table == NULL || rgb == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a table of colours");
  if (result == ABBE_OK) result = show_places(display, 0, rgb, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    memcpy(table->node[i], rgb[i], sizeof *rgb);
  if (result == ABBE_OK) result = show_places(display, 0.5, rgb, error);
  if (result == ABBE_OK) find_errors(table, rgb);
  free(rgb);
  if (result == ABBE_OK) {
    table->display = display;
    *out = table;
    return ABBE_OK;
  }
  free(table);
  return result;
}

void abbe_display_table_free(abbe_display_table *table) {
  free(table);
}

/* Interpolates between the four corners of the tetrahedron that holds the colour: from the least
 * corner of its cell along the part that is farthest, then the next. False: the colour is beyond
 * the table, or in a cell that is too coarse. */
static bool look_up(const abbe_display_table *t, float rgb[3]) {
  size_t at = 0, step[3] = {stride[0], stride[1], stride[2]};
  float rest[3], sum[4];
  for (int k = 0; k < 3; k++) {
    const float place = place_of(rgb[k]);
    if (!(place >= 0 && place < NODES - 1)) return false;
    const int node = (int)place;
    rest[k] = place - (float)node;
    at += (size_t)node * stride[k];
  }
  if (rest[0] + rest[1] + rest[2] == 0) { /* black, where nothing is */
    memcpy(rgb, t->node[at], 3 * sizeof *rgb);
    return true;
  }
  if (t->node[at][3] > most_off) return false;
  for (int i = 0; i < 3; i++) { /* the greatest first */
    const int a = i == 1 ? 1 : 0, b = a + 1;
    if (rest[a] >= rest[b]) continue;
    const float r = rest[a];
    const size_t s = step[a];
    rest[a] = rest[b];
    step[a] = step[b];
    rest[b] = r;
    step[b] = s;
  }
  const float weight[4] = {1 - rest[0], rest[0] - rest[1], rest[1] - rest[2], rest[2]};
  const float *corner[4] = {t->node[at], t->node[at + step[0]], t->node[at + step[0] + step[1]],
                            t->node[at + step[0] + step[1] + step[2]]};
  for (int k = 0; k < 4; k++)
    sum[k] = weight[0] * corner[0][k] + weight[1] * corner[1][k] + weight[2] * corner[2][k] +
             weight[3] * corner[3][k];
  memcpy(rgb, sum, 3 * sizeof *rgb);
  return true;
}

abbe_result abbe_display_table_apply(const abbe_display_table *table, abbe_image *image,
                                     abbe_error *error) {
  assert(image->data && image->channels == 3);
  const size_t count = image->width * image->height;
  float(*rgb)[3] = (float(*)[3])image->data;
  size_t *beyond = malloc((count + 1) * sizeof *beyond), left = 0;
  if (beyond == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture");
  for (size_t i = 0; i < count; i++)
    if (!look_up(table, rgb[i])) beyond[left++] = i;
  float(*others)[3] = malloc((left + 1) * sizeof *others);
  abbe_result result =
      others != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture");
  for (size_t i = 0; i < left && result == ABBE_OK; i++)
    memcpy(others[i], rgb[beyond[i]], sizeof *others);
  if (result == ABBE_OK && left > 0) result = show_colours(table->display, others, left, error);
  for (size_t i = 0; i < left && result == ABBE_OK; i++)
    memcpy(rgb[beyond[i]], others[i], sizeof *others);
  free(others);
  free(beyond);
  return result;
}
