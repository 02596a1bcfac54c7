#include "validation/measure/outline.h"

#include "base/maths.h"
#include "colorimetry/rgb_space.h"
#include "validation/measure/field.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Adds factor times the field's caustic, or its colour where it has none apart, in Rec.709. */
static abbe_result add_picture(const abbe_field *field, const char *name, double factor,
                               bool caustic, double (*rgb)[3], abbe_error *error) {
  const bool apart = caustic && field->caustic.channels == 3;
  const abbe_field_samples *samples = apart ? &field->caustic : &field->colour;
  if (samples->channels != 3)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: there is no colour in it; R, G, B or X, Y, Z are wanted", name);
  double from_xyz[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  for (size_t i = 0; i < field->width * field->height; i++) {
    double v[3] = {samples->value[3 * i], samples->value[3 * i + 1], samples->value[3 * i + 2]};
    abbe_rgb_space_apply(field->to_xyz, v, v);
    abbe_rgb_space_apply(from_xyz, v, v);
    for (int c = 0; c < 3; c++) rgb[i][c] += factor * v[c];
  }
  return ABBE_OK;
}

abbe_result abbe_outline_load(const char *path, const char *minus,
                              const abbe_outline_options *options, abbe_outline *out,
                              abbe_image place[2], abbe_error *error) {
  abbe_field field = {0}, dark = {0};
  double(*rgb)[3] = NULL;
  abbe_result result = abbe_field_load(path, &field, error);
  if (result == ABBE_OK && minus != NULL) result = abbe_field_load(minus, &dark, error);
  if (result == ABBE_OK && minus != NULL &&
      (field.width != dark.width || field.height != dark.height))
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s has %zu x %zu pixels and %s %zu x %zu; they must be of one size",
                            path, field.width, field.height, minus, dark.width, dark.height);
  if (result == ABBE_OK && minus != NULL)
    result = abbe_image_check_place(&field.header, path, &dark.header, minus, error);
  for (int i = 0; i < 2; i++) {
    const abbe_image *header = i == 0 ? &field.header : &dark.header;
    place[i] = (abbe_image){.display_window = header->display_window};
    memcpy(place[i].part, header->part, sizeof header->part);
  }
  if (result == ABBE_OK) {
    rgb = calloc(field.width * field.height, sizeof *rgb);
    if (rgb == NULL)
      result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its pixels", path);
  }
  if (result == ABBE_OK) result = add_picture(&field, path, 1, minus == NULL, rgb, error);
  if (result == ABBE_OK && minus != NULL) result = add_picture(&dark, minus, -1, false, rgb, error);
  if (result == ABBE_OK)
    result =
        abbe_outline_make((const double(*)[3])rgb, field.width, field.height, options, out, error);
  free(rgb);
  abbe_field_free(&field);
  abbe_field_free(&dark);
  return result;
}

static const double most_blur = 64;

const char *abbe_outline_hue_name(abbe_outline_hue hue) {
#define ABBE_OUTLINE_NAME(code, name) name,
  static const char *const names[] = {ABBE_OUTLINE_HUES(ABBE_OUTLINE_NAME)};
#undef ABBE_OUTLINE_NAME
  return (int)hue >= 0 && hue < ABBE_OUTLINE_HUE_COUNT ? names[hue] : "unknown";
}

static abbe_result no_memory(size_t width, size_t height, abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY,
                        "there is no memory for an outline in %zu x %zu pixels", width, height);
}

/* --- smoothing --- */

/* One row or column of `count` pixels `step` apart, through a line of its own; light that would
 * leave the picture stays at its edge. */
static void blur_line(double (*at)[3], size_t count, size_t step, const double *kernel, long reach,
                      double (*line)[3]) {
  memset(line, 0, count * sizeof *line);
  for (size_t i = 0; i < count; i++)
    for (long k = -reach; k <= reach; k++) {
      long to = (long)i + k;
      to = to < 0 ? 0 : to >= (long)count ? (long)count - 1 : to;
      for (int c = 0; c < 3; c++) line[to][c] += kernel[labs(k)] * at[i * step][c];
    }
  for (size_t i = 0; i < count; i++) memcpy(at[i * step], line[i], sizeof *line);
}

static abbe_result blur(double (*rgb)[3], size_t width, size_t height, double sigma,
                        abbe_error *error) {
  if (sigma <= 0) return ABBE_OK;
  const long reach = (long)ceil(3 * sigma);
  double sum = 1, kernel[3 * 64 + 2] = {1};
  for (long k = 1; k <= reach; k++) {
    kernel[k] = exp(-0.5 * (double)(k * k) / (sigma * sigma));
    sum += 2 * kernel[k];
  }
  for (long k = 0; k <= reach; k++) kernel[k] /= sum;
  double(*line)[3] = malloc((width > height ? width : height) * sizeof *line);
  if (line == NULL) return no_memory(width, height, error);
  for (size_t y = 0; y < height; y++) blur_line(rgb + y * width, width, 1, kernel, reach, line);
  for (size_t x = 0; x < width; x++) blur_line(rgb + x, height, width, kernel, reach, line);
  free(line);
  return ABBE_OK;
}

/* --- hues --- */

/* The angle around the cube's grey diagonal, in sixths, and the distance from grey. */
static void hue_of(const double rgb[3], double hue[2]) {
  int most = 0, least = 0;
  for (int c = 1; c < 3; c++) {
    if (rgb[c] > rgb[most]) most = c;
    if (rgb[c] < rgb[least]) least = c;
  }
  hue[0] = 0;
  hue[1] = rgb[most] - rgb[least];
  if (!(hue[1] > 0)) return;
  const double turn = (rgb[(most + 1) % 3] - rgb[(most + 2) % 3]) / hue[1];
  hue[0] = fmod(2.0 * most + turn + 6, 6);
}

static abbe_outline_hue sector_of(double angle) {
  return (abbe_outline_hue)((int)floor(angle + 0.5) % ABBE_OUTLINE_HUE_COUNT);
}

static void find_places(abbe_outline *o) {
  double sum[ABBE_OUTLINE_HUE_COUNT][4] = {{0}}, all = 0;
  for (size_t i = 0; i < o->width * o->height; i++) {
    double *s = sum[sector_of(o->hue[i][0])];
    const double w = o->hue[i][1], x = (double)(i % o->width) + 0.5,
                 y = (double)(i / o->width) + 0.5;
    s[0] += w;
    s[1] += w * x;
    s[2] += w * y;
    s[3] += w * (x * x + y * y);
    all += w;
  }
  for (int h = 0; h < ABBE_OUTLINE_HUE_COUNT; h++) {
    abbe_outline_place *p = &o->place[h];
    if (!(sum[h][0] > 0)) continue;
    p->share = sum[h][0] / all;
    p->x = sum[h][1] / sum[h][0];
    p->y = sum[h][2] / sum[h][0];
    p->spread = sqrt(fmax(sum[h][3] / sum[h][0] - p->x * p->x - p->y * p->y, 0));
  }
}

/* --- the outline --- */

static abbe_result fill(double (*rgb)[3], double *light, double share, abbe_outline *o,
                        abbe_error *error) {
  double matrix[9], tinted = 0, sum = 0;
  const size_t count = o->width * o->height;
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, matrix);
  for (size_t i = 0; i < count; i++) {
    light[i] = matrix[3] * rgb[i][0] + matrix[4] * rgb[i][1] + matrix[5] * rgb[i][2];
    hue_of(rgb[i], o->hue[i]);
    tinted += o->hue[i][1];
    sum += fmax(rgb[i][0], 0) + fmax(rgb[i][1], 0) + fmax(rgb[i][2], 0);
  }
  o->tinted = sum > 0 ? fmin(tinted / sum, 1) : 0;
  find_places(o);
  return abbe_mask_make_brightest(light, count, share, &o->mask, error);
}

static double take_finite(const double (*from)[3], double (*to)[3], size_t count) {
  double matrix[9], light = 0;
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, matrix);
  for (size_t i = 0; i < count; i++) {
    const bool finite = isfinite(from[i][0]) && isfinite(from[i][1]) && isfinite(from[i][2]);
    for (int c = 0; c < 3; c++) {
      to[i][c] = finite ? from[i][c] : 0;
      light += matrix[3 + c] * to[i][c];
    }
  }
  return light;
}

static abbe_result check(size_t width, size_t height, const abbe_outline_options *o,
                         abbe_error *error) {
  if (width < 1 || height < 1 || width > ABBE_IMAGE_MAX_SIDE || height > ABBE_IMAGE_MAX_SIDE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a picture of %zu x %zu pixels has no outline; a side is 1 to %d", width,
                          height, ABBE_IMAGE_MAX_SIDE);
  if (!(o->share > 0 && o->share <= 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the share of the light inside the outline is %g; it may be above 0, "
                          "to 1",
                          o->share);
  if (!(o->blur <= most_blur))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the smoothing is %g pixels wide; it may be up to %g", o->blur,
                          most_blur);
  return ABBE_OK;
}

abbe_result abbe_outline_make(const double (*rgb)[3], size_t width, size_t height,
                              const abbe_outline_options *options, abbe_outline *out,
                              abbe_error *error) {
  abbe_outline_options o = options != NULL ? *options : (abbe_outline_options){0};
  if (o.share == 0) o.share = 0.9;
  if (o.blur == 0) o.blur = 1;
  *out = (abbe_outline){.width = width, .height = height};
  abbe_result result = check(width, height, &o, error);
  if (result != ABBE_OK) return result;
  const size_t count = width * height;
  double(*smooth)[3] = malloc(count * sizeof *smooth), *light = malloc(count * sizeof *light);
  out->hue = malloc(count * sizeof *out->hue);
  if (smooth == NULL || light == NULL || out->hue == NULL) {
    result = no_memory(width, height, error);
  } else {
    out->light = take_finite(rgb, smooth, count);
    result = blur(smooth, width, height, o.blur, error);
    if (result == ABBE_OK) result = fill(smooth, light, o.share, out, error);
  }
  free(smooth);
  free(light);
  if (result != ABBE_OK) abbe_outline_free(out);
  return result;
}

void abbe_outline_free(abbe_outline *outline) {
  if (outline == NULL) return;
  abbe_mask_free(&outline->mask);
  free(outline->hue);
  *outline = (abbe_outline){0};
}

/* --- two of them --- */

/* Inside, and beside a pixel outside or at the picture's edge. */
static bool on_rim(const abbe_outline *o, size_t x, size_t y) {
  const unsigned char *in = o->mask.in + y * o->width + x;
  if (!*in) return false;
  if (x == 0 || y == 0 || x + 1 == o->width || y + 1 == o->height) return true;
  return !in[-1] || !in[1] || !*(in - o->width) || !in[o->width];
}

/* Distances of every pixel: rows to the nearest pixel of the rim in its own column, or the
 * height. */
static double *column_distances(const abbe_outline *o) {
  double *rows = malloc(o->width * o->height * sizeof *rows);
  for (size_t x = 0; rows != NULL && x < o->width; x++) {
    double since = (double)o->height + (double)o->width;
    for (size_t y = 0; y < o->height; y++) {
      since = on_rim(o, x, y) ? 0 : since + 1;
      rows[y * o->width + x] = since;
    }
    since = (double)o->height + (double)o->width;
    for (size_t y = o->height; y-- > 0;) {
      since = on_rim(o, x, y) ? 0 : since + 1;
      rows[y * o->width + x] = fmin(rows[y * o->width + x], since);
    }
  }
  return rows;
}

static double nearest(const double *row, size_t width, size_t x) {
  double best = row[x] * row[x];
  for (size_t d = 1; d < width && (double)(d * d) < best; d++) {
    const double d2 = (double)(d * d);
    if (x >= d) best = fmin(best, d2 + row[x - d] * row[x - d]);
    if (x + d < width) best = fmin(best, d2 + row[x + d] * row[x + d]);
  }
  return sqrt(best);
}

/* Appends the distances from a's rim to b's; their number. */
static size_t add_distances(const abbe_outline *a, const double *rows_of_b, double *out) {
  size_t count = 0;
  for (size_t y = 0; y < a->height; y++)
    for (size_t x = 0; x < a->width; x++)
      if (on_rim(a, x, y)) out[count++] = nearest(rows_of_b + y * a->width, a->width, x);
  return count;
}

static abbe_result compare_rims(const abbe_outline *a, const abbe_outline *b,
                                abbe_outline_agreement *out, abbe_error *error) {
  double *rows_a = column_distances(a), *rows_b = column_distances(b);
  double *apart = malloc((a->mask.inside + b->mask.inside) * sizeof *apart);
  const bool room = rows_a != NULL && rows_b != NULL && apart != NULL;
  if (room) {
    size_t count = add_distances(a, rows_b, apart);
    count += add_distances(b, rows_a, apart + count);
    for (size_t i = 0; i < count; i++) out->mean_apart += apart[i] / (double)count;
    qsort(apart, count, sizeof *apart, abbe_order_ascending);
    out->p95_apart = apart[(size_t)(0.95 * (double)(count - 1))];
  }
  free(rows_a);
  free(rows_b);
  free(apart);
  return room ? ABBE_OK : no_memory(a->width, a->height, error);
}

static void compare_hues(const abbe_outline *a, const abbe_outline *b,
                         abbe_outline_agreement *out) {
  double total[2][ABBE_OUTLINE_HUE_COUNT] = {{0}};
  const size_t count = a->width * a->height;
  for (size_t i = 0; i < count; i++) {
    total[0][sector_of(a->hue[i][0])] += a->hue[i][1];
    total[1][sector_of(b->hue[i][0])] += b->hue[i][1];
  }
  for (size_t i = 0; i < count; i++) {
    const abbe_outline_hue h = sector_of(a->hue[i][0]);
    if (h != sector_of(b->hue[i][0]) || !(a->hue[i][1] > 0) || !(b->hue[i][1] > 0)) continue;
    out->hue[h].overlap += fmin(a->hue[i][1] / total[0][h], b->hue[i][1] / total[1][h]);
  }
  for (int h = 0; h < ABBE_OUTLINE_HUE_COUNT; h++) {
    const abbe_outline_place *p = &a->place[h], *q = &b->place[h];
    out->hue[h].apart = p->share > 0 && q->share > 0 ? hypot(p->x - q->x, p->y - q->y) : NAN;
  }
}

abbe_result abbe_outline_compare(const abbe_outline *a, const abbe_outline *b,
                                 abbe_outline_agreement *out, abbe_error *error) {
  *out = (abbe_outline_agreement){0};
  if (a->width != b->width || a->height != b->height || a->hue == NULL || b->hue == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "outlines in %zu x %zu and %zu x %zu pixels cannot be compared; they "
                          "must be of one size",
                          a->width, a->height, b->width, b->height);
  size_t both = 0, any = 0;
  for (size_t i = 0; i < a->width * a->height; i++) {
    both += a->mask.in[i] && b->mask.in[i];
    any += a->mask.in[i] || b->mask.in[i];
  }
  out->light_ratio = b->light / a->light;
  out->overlap = (double)both / (double)any;
  compare_hues(a, b, out);
  return compare_rims(a, b, out, error);
}
