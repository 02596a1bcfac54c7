#include "colorimetry/picture_gamut/gamut_check.h"

#include "base/maths.h"
#include "colorimetry/chromaticity.h"
#include "colorimetry/difference.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/plot/chart.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* The CIE's diagrams of a picture's chromaticities. */

/* The cloud has one point for each cell of a diagram that has a pixel. */
enum { CELLS = 256, MAX_LOCUS = 512, CORNERS = 4, SERIES = ABBE_GAMUT_COUNT + 2 };
static const double side = 0.9; /* both diagrams lie within 0 to 0.9 */

typedef struct line {
  size_t count;
  double x[MAX_LOCUS], y[MAX_LOCUS];
} line;

typedef struct diagram {
  bool uniform; /* u', v' instead of x, y */
  line locus, gamut[ABBE_GAMUT_COUNT];
  size_t count;
  double *x, *y; /* [count] of the cloud */
} diagram;

static void add(const diagram *d, const double xy[2], line *to) {
  double at[2] = {xy[0], xy[1]};
  if (d->uniform) abbe_chromaticity_uv_of_xy(xy, at);
  to->x[to->count] = at[0];
  to->y[to->count++] = at[1];
}

static void add_lines(diagram *d) {
  double first, last, xy[8];
  abbe_chromaticity_locus_ends(ABBE_OBSERVER_CIE_1931, &first, &last);
  for (double nm = first; nm <= last && d->locus.count < MAX_LOCUS - 1; nm++) {
    abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, nm, xy);
    add(d, xy, &d->locus);
  }
  abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, first, xy);
  add(d, xy, &d->locus);
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++) {
    abbe_gamut_chromaticities((abbe_gamut)g, xy);
    for (int i = 0; i < CORNERS; i++) add(d, xy + 2 * (i % 3), &d->gamut[g]);
  }
}

static abbe_result add_cloud(const abbe_gamut_check *check, diagram *d, abbe_error *error) {
  unsigned char *has = calloc((size_t)CELLS * CELLS, 1);
  d->x = malloc(sizeof *d->x * CELLS * CELLS);
  d->y = malloc(sizeof *d->y * CELLS * CELLS);
  const bool made = has != NULL && d->x != NULL && d->y != NULL;
  for (size_t p = 0; made && p < check->width * check->height; p++) {
    double xyz[3], at[2];
    for (int c = 0; c < 3; c++) xyz[c] = (double)check->xyz[p][c];
    if (isnan(check->excess[p]) || !abbe_chromaticity_xy(xyz, at)) continue;
    if (d->uniform) {
      const double xy[2] = {at[0], at[1]};
      abbe_chromaticity_uv_of_xy(xy, at);
    }
    if (!(at[0] >= 0 && at[0] < side && at[1] >= 0 && at[1] < side)) continue;
    const size_t cell = (size_t)(at[1] / side * CELLS) * CELLS + (size_t)(at[0] / side * CELLS);
    if (has[cell] != 0) continue;
    has[cell] = 1;
    d->x[d->count] = at[0];
    d->y[d->count++] = at[1];
  }
  free(has);
  return made ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the diagram");
}

static void draw(const diagram *d, const char *title, abbe_chart_series series[SERIES],
                 abbe_chart *chart) {
  size_t n = 0;
  if (d->count > 0)
    series[n++] = (abbe_chart_series){.label = d->uniform ? NULL : "the picture",
                                      .style = ABBE_CHART_POINTS,
                                      .count = d->count,
                                      .x = d->x,
                                      .y = d->y,
                                      .colour = 2};
  series[n++] = (abbe_chart_series){.label = d->uniform ? NULL : "spectral locus",
                                    .style = ABBE_CHART_LINE,
                                    .count = d->locus.count,
                                    .x = d->locus.x,
                                    .y = d->locus.y,
                                    .colour = 1};
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++)
    series[n++] = (abbe_chart_series){.label = d->uniform ? NULL : abbe_gamut_text((abbe_gamut)g),
                                      .style = ABBE_CHART_LINE,
                                      .count = d->gamut[g].count,
                                      .x = d->gamut[g].x,
                                      .y = d->gamut[g].y,
                                      .colour = 3 + g};
  *chart = (abbe_chart){.title = title,
                        .x = {.label = d->uniform ? "u'" : "x", .min = 0, .max = side},
                        .y = {.label = d->uniform ? "v'" : "y", .min = 0, .max = side},
                        .series_count = n,
                        .series = series};
}

abbe_result abbe_gamut_check_diagram(const abbe_gamut_check *check, const char *path,
                                     const char *title, abbe_error *error) {
  assert(check->xyz && check->excess);
  abbe_chart charts[2];
  abbe_chart_series series[2][SERIES];
  diagram *d = calloc(2, sizeof *d);
  abbe_result result =
      d == NULL ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the diagram") : ABBE_OK;
  for (int k = 0; k < 2 && result == ABBE_OK; k++) {
    d[k].uniform = k == 1;
    add_lines(&d[k]);
    result = add_cloud(check, &d[k], error);
    draw(&d[k], k == 0 ? title : "CIE 1976", series[k], &charts[k]);
  }
  if (result == ABBE_OK) result = abbe_chart_write_grid(path, charts, 2, 2, 1280, 680, error);
  for (int k = 0; k < 2 && d != NULL; k++) {
    free(d[k].x);
    free(d[k].y);
  }
  free(d);
  return result;
}

static const double degrees = 57.29577951308232;

static bool find_channels(const abbe_image *image, size_t at[3], bool *is_xyz) {
  static const char *const names[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
  for (int set = 0; set < 2; set++) {
    bool all = true;
    for (int c = 0; c < 3; c++) {
      at[c] = abbe_image_find_channel(image, names[set][c]);
      all = all && at[c] != (size_t)-1;
    }
    *is_xyz = set == 1;
    if (all) return true;
  }
  return false;
}

static abbe_result take_picture(const abbe_image *image, const char *name, abbe_gamut_check *out,
                                abbe_error *error) {
  size_t at[3];
  bool is_xyz;
  if (!find_channels(image, at, &is_xyz))
    return abbe_error_set(error, ABBE_NOT_FOUND, "%s: it has no channels R, G, B nor X, Y, Z",
                          name);
  ABBE_TRY(abbe_picture_space_find(image, is_xyz, name, &out->space, error));
  abbe_image_count_odd(image, at, 3, &out->odd);
  const size_t pixels = image->width * image->height;
  out->width = image->width;
  out->height = image->height;
  out->xyz = calloc(pixels, sizeof *out->xyz);
  out->excess = calloc(pixels, sizeof *out->excess);
  if (out->xyz == NULL || out->excess == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its %zu pixels", name, pixels);
  for (size_t p = 0; p < pixels; p++) {
    double v[3];
    for (int c = 0; c < 3; c++) v[c] = (double)image->data[p * image->channels + at[c]];
    abbe_rgb_space_apply(out->space.to_xyz, v, v);
    for (int c = 0; c < 3; c++) out->xyz[p][c] = (float)v[c];
  }
  return ABBE_OK;
}

static void take_xyz(const abbe_gamut_check *check, size_t pixel, double xyz[3]) {
  for (int c = 0; c < 3; c++) xyz[c] = (double)check->xyz[pixel][c];
}

static bool is_lit(const double xyz[3]) {
  return xyz[1] > 0 && isfinite(xyz[0] + xyz[1] + xyz[2]);
}

static bool is_outside(const abbe_gamut_check *check, size_t pixel) {
  return (double)check->excess[pixel] > ABBE_GAMUT_CHECK_SLACK;
}

static void find_excess(abbe_gamut_check *out) {
  double from[9], light = 0, light_outside = 0, sum = 0;
  abbe_gamut_from_xyz(out->gamut, from);
  for (size_t p = 0; p < out->width * out->height; p++) {
    double xyz[3], rgb[3];
    take_xyz(out, p, xyz);
    out->excess[p] = NAN;
    if (!is_lit(xyz)) continue;
    abbe_rgb_space_apply(from, xyz, rgb);
    const double excess = abbe_gamut_excess(rgb);
    out->excess[p] = (float)excess;
    out->lit++;
    light += xyz[1];
    if (!is_outside(out, p)) continue;
    out->outside++;
    light_outside += xyz[1];
    sum += excess;
    if (excess <= out->excess_greatest) continue;
    out->excess_greatest = excess;
    out->x = p % out->width;
    out->y = p / out->width;
  }
  out->light_outside = light > 0 ? light_outside / light : 0;
  out->excess_mean = out->outside > 0 ? sum / (double)out->outside : 0;
}

static abbe_result find_white(abbe_gamut_check *out, abbe_error *error) {
  float *y = malloc(out->lit * sizeof *y);
  if (y == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu pixels", out->lit);
  size_t count = 0;
  for (size_t p = 0; p < out->width * out->height; p++)
    if (!isnan(out->excess[p])) y[count++] = out->xyz[p][1];
  qsort(y, count, sizeof *y, abbe_order_ascending_floats);
  out->white_y = (double)y[(99 * count + 99) / 100 - 1];
  free(y);
  return ABBE_OK;
}

/* Degrees between the hues of two Oklab colours, 0 to 180; 0 where one is grey, and where only
 * rounding turns them. */
static double hue_change(const double a[3], const double b[3]) {
  const double dot = a[1] * b[1] + a[2] * b[2], cross = a[1] * b[2] - a[2] * b[1];
  const double least = fmin(hypot(a[1], a[2]) / fabs(a[0]), hypot(b[1], b[2]) / fabs(b[0]));
  const double turn = fabs(atan2(cross, dot)) * degrees;
  return least > 1e-6 && turn > 1e-9 ? turn : 0;
}

static void add_cost(const double before[3], const double after[3], const double white[3],
                     abbe_gamut_cost *cost) {
  double lab[2][3], ok[2][3];
  abbe_difference_lab(before, white, lab[0]);
  abbe_difference_lab(after, white, lab[1]);
  abbe_oklab_of_xyz(before, ok[0]);
  abbe_oklab_of_xyz(after, ok[1]);
  const double difference = abbe_difference_ciede2000(lab[0], lab[1]);
  const double hue = hue_change(ok[0], ok[1]);
  cost->mean += difference;
  cost->greatest = fmax(cost->greatest, difference);
  cost->hue_mean += hue;
  cost->hue_greatest = fmax(cost->hue_greatest, hue);
}

static abbe_result find_costs(abbe_gamut_check *out, abbe_error *error) {
  const double white[3] = {out->white_y * 0.3127 / 0.3290, out->white_y,
                           out->white_y * (1 - 0.3127 - 0.3290) / 0.3290};
  double xy[8];
  abbe_gamut_chromaticities(out->gamut, xy);
  for (int k = ABBE_GAMUT_MAP_CLIP; k < ABBE_GAMUT_MAP_COUNT; k++) {
    abbe_gamut_map map;
    abbe_gamut_cost *cost = &out->cost[k];
    ABBE_TRY(abbe_gamut_map_make((abbe_gamut_map_kind)k, xy, &map, error));
    for (size_t p = 0; p < out->width * out->height; p++) {
      double before[3], after[3];
      if (!is_outside(out, p)) continue;
      take_xyz(out, p, before);
      take_xyz(out, p, after);
      abbe_gamut_map_apply(&map, after);
      add_cost(before, after, white, cost);
    }
    if (out->outside == 0) continue;
    cost->mean /= (double)out->outside;
    cost->hue_mean /= (double)out->outside;
  }
  return ABBE_OK;
}

abbe_result abbe_gamut_check_make(const abbe_image *image, const char *name, abbe_gamut gamut,
                                  abbe_gamut_check *out, abbe_error *error) {
  *out = (abbe_gamut_check){.gamut = gamut};
  if ((unsigned)gamut >= ABBE_GAMUT_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: there is no gamut number %d", name,
                          (int)gamut);
  abbe_result result = take_picture(image, name, out, error);
  if (result == ABBE_OK) find_excess(out);
  if (result == ABBE_OK && out->lit == 0)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: none of its %zu x %zu pixels is lit (Y above 0)", name, out->width,
                            out->height);
  if (result == ABBE_OK) result = find_white(out, error);
  if (result == ABBE_OK) result = find_costs(out, error);
  if (result != ABBE_OK) abbe_gamut_check_free(out);
  return result;
}

void abbe_gamut_check_free(abbe_gamut_check *check) {
  if (check == NULL) return;
  free(check->xyz);
  free(check->excess);
  *check = (abbe_gamut_check){0};
}

abbe_result abbe_gamut_check_overlay(const abbe_gamut_check *check, const char *path,
                                     abbe_error *error) {
  assert(check->xyz && check->excess);
  static const char *const names[] = {"R", "G", "B"};
  abbe_image image = {0};
  ABBE_TRY(abbe_image_make(check->width, check->height, 3, names, &image, error));
  for (size_t p = 0; p < check->width * check->height; p++) {
    const double y = (double)check->xyz[p][1] / check->white_y;
    double rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = y > 0 ? 0.7 * pow(fmin(y, 1), 1 / 2.2) : 0;
    if (is_outside(check, p)) /* dim excess too is seen on black */
      abbe_colour_map_at(ABBE_COLOUR_MAP_DIFFERENCE,
                         0.5 + 0.5 * sqrt((double)check->excess[p] / check->excess_greatest), rgb);
    for (size_t c = 0; c < 3; c++) image.data[3 * p + c] = (float)rgb[c];
  }
  abbe_rgb_encoding_srgb(image.xy, image.curve);
  abbe_result result = abbe_png_write(path, &image, 8, error);
  abbe_image_free(&image);
  return result;
}
