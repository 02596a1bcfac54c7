#include "colorimetry/atlas/atlas.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/difference.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/observer_integral.h"
#include "colorimetry/plot/chart.h"
#include "colorimetry/rgb_space.h"
#include "spectral/wavelengths.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double luminance = 0.5;
static const double white[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
static const double first_nm = 380, last_nm = 730;

/* To Y = 0.5; false for light that nobody sees. */
static bool normalise(double xyz[3], double xy[2]) {
  if (!abbe_chromaticity_xy(xyz, xy)) return false;
  const double scale = luminance / xyz[1];
  for (int c = 0; c < 3; c++) xyz[c] *= scale;
  return true;
}

static double difference(const double a[3], const double b[3]) {
  double lab[2][3];
  abbe_difference_lab(a, white, lab[0]);
  abbe_difference_lab(b, white, lab[1]);
  return abbe_difference_ciede2000(lab[0], lab[1]);
}

/* All gamut mappings into all gamuts. */
typedef struct ways {
  abbe_gamut_map map[ABBE_GAMUT_COUNT][ABBE_GAMUT_MAP_COUNT];
} ways;

static abbe_result make_ways(ways *out, abbe_error *error) {
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++)
    for (int k = 0; k < ABBE_GAMUT_MAP_COUNT; k++) {
      double xy[8];
      abbe_gamut_chromaticities((abbe_gamut)g, xy);
      ABBE_TRY(abbe_gamut_map_make((abbe_gamut_map_kind)k, xy, &out->map[g][k], error));
    }
  return ABBE_OK;
}

static void fill_gamuts(const ways *into, abbe_atlas_row *row) {
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++) {
    double rgb[3];
    abbe_rgb_space_apply(into->map[g][0].from_xyz, row->xyz, rgb);
    row->excess[g] = abbe_gamut_excess(rgb);
    for (int k = 0; k < ABBE_GAMUT_MAP_COUNT; k++) {
      double mapped[3] = {row->xyz[0], row->xyz[1], row->xyz[2]};
      abbe_gamut_map_apply(&into->map[g][k], mapped);
      row->difference[g][k] = difference(row->xyz, mapped);
    }
  }
}

static abbe_result fill_row(const abbe_atlas *atlas, const abbe_illuminant *light,
                            const abbe_wavelengths *w, const ways *into, double nm,
                            abbe_atlas_row *row, abbe_error *error) {
  size_t band = 0;
  double uv[2][2];
  while (band + 1 < w->count && nm >= w->edge_nm[band + 1]) band++;
  *row = (abbe_atlas_row){.lambda_nm = nm};
  abbe_observer_xyz_of(atlas->observer, nm, row->xyz);
  abbe_observer_integral_by(atlas->observer, light, w->edge_nm[band], w->edge_nm[band + 1],
                            row->band_xyz);
  if (!normalise(row->xyz, row->xy) || !normalise(row->band_xyz, row->band_xy))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "at %g nm the light or the observer's table is dark; choose a range "
                          "where both have something",
                          nm);
  abbe_chromaticity_uv_of_xy(row->xy, uv[0]);
  abbe_chromaticity_uv_of_xy(row->band_xy, uv[1]);
  row->band_uv = hypot(uv[0][0] - uv[1][0], uv[0][1] - uv[1][1]);
  row->band_difference = difference(row->xyz, row->band_xyz);
  fill_gamuts(into, row);
  return ABBE_OK;
}

abbe_result abbe_atlas_make(const abbe_atlas_desc *desc, abbe_atlas *out, abbe_error *error) {
  static const abbe_illuminant d65 = {0};
  const bool whole = desc->min_nm == 0 && desc->max_nm == 0;
  *out = (abbe_atlas){.observer = desc->observer,
                      .min_nm = whole ? 400 : desc->min_nm,
                      .max_nm = whole ? 700 : desc->max_nm,
                      .bands = desc->bands == 0 ? 21 : desc->bands};
  if (!(out->min_nm >= first_nm && out->max_nm <= last_nm && out->min_nm < out->max_nm) ||
      (unsigned)desc->observer >= ABBE_OBSERVER_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an atlas of %g to %g nm for the observer %s: within %g to %g nm colours "
                          "are told apart",
                          out->min_nm, out->max_nm, abbe_observer_name(desc->observer), first_nm,
                          last_nm);
  const abbe_illuminant *light = desc->illuminant != NULL ? desc->illuminant : &d65;
  abbe_wavelengths w = {0};
  ways into;
  abbe_result result = abbe_wavelengths_make(out->bands, out->min_nm, out->max_nm, &w, error);
  if (result != ABBE_OK) return result;
  out->count = (size_t)floor(out->max_nm - out->min_nm) + 1;
  out->row = calloc(out->count, sizeof *out->row);
  if (out->row == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the atlas");
  if (result == ABBE_OK) result = make_ways(&into, error);
  for (size_t i = 0; i < out->count && result == ABBE_OK; i++)
    result = fill_row(out, light, &w, &into, out->min_nm + (double)i, &out->row[i], error);
  abbe_wavelengths_free(&w);
  if (result != ABBE_OK) abbe_atlas_free(out);
  return result;
}

void abbe_atlas_free(abbe_atlas *atlas) {
  if (atlas == NULL) return;
  free(atlas->row);
  *atlas = (abbe_atlas){0};
}

/* The greatest brightness that the display has for the colour, encoded. */
static void paint(const abbe_gamut_map *map, const double xyz[3], float pixel[3]) {
  double rgb[3] = {xyz[0], xyz[1], xyz[2]};
  abbe_gamut_map_apply(map, rgb);
  abbe_rgb_space_apply(map->from_xyz, rgb, rgb);
  const double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
  for (int c = 0; c < 3; c++) {
    const double x = fmin(fmax(rgb[c] / most, 0), 1);
    pixel[c] = (float)abbe_srgb_encoded(x);
  }
}

abbe_result abbe_atlas_picture(const abbe_atlas *atlas, const char *path, abbe_error *error) {
  assert(atlas->row);
  static const char *const names[] = {"R", "G", "B"};
  enum { STRIP = 60, GAP = 4, WIDE = 3 };
  const size_t height = 2 * STRIP + GAP;
  abbe_image image = {0};
  abbe_gamut_map map;
  ABBE_TRY(abbe_image_make(WIDE * atlas->count, height, 3, names, &image, error));
  abbe_rgb_encoding_display_p3(image.xy, image.curve);
  abbe_result result = abbe_gamut_map_make(ABBE_GAMUT_MAP_WHITE, image.xy, &map, error);
  for (size_t y = 0; y < height && result == ABBE_OK; y++)
    for (size_t x = 0; x < image.width; x++) {
      const abbe_atlas_row *row = &atlas->row[x / WIDE];
      float *pixel = image.data + 3 * (y * image.width + x);
      if (y < STRIP) paint(&map, row->xyz, pixel);
      if (y >= STRIP + GAP) paint(&map, row->band_xyz, pixel);
    }
  if (result == ABBE_OK) result = abbe_png_write(path, &image, 8, error);
  abbe_image_free(&image);
  return result;
}

enum { LINES = ABBE_GAMUT_COUNT + 1 };

static double height_of(const abbe_atlas_row *row, int line) {
  return line == 0 ? row->band_difference : row->difference[line - 1][ABBE_GAMUT_MAP_WHITE];
}

abbe_result abbe_atlas_plot(const abbe_atlas *atlas, const char *path, abbe_error *error) {
  assert(atlas->row);
  double *nm = calloc(atlas->count, (LINES + 1) * sizeof *nm);
  if (nm == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the plot");
  abbe_chart_series series[LINES];
  char label[40], title[120];
  snprintf(label, sizeof label, "%zu bands", atlas->bands);
  snprintf(title, sizeof title, "spectral colours, %s", abbe_observer_text(atlas->observer));
  for (size_t i = 0; i < atlas->count; i++) nm[i] = atlas->row[i].lambda_nm;
  for (int line = 0; line < LINES; line++) {
    double *y = nm + (size_t)(line + 1) * atlas->count;
    for (size_t i = 0; i < atlas->count; i++) y[i] = height_of(&atlas->row[i], line);
    series[line] =
        (abbe_chart_series){.label = line == 0 ? label : abbe_gamut_text((abbe_gamut)(line - 1)),
                            .style = ABBE_CHART_LINE,
                            .count = atlas->count,
                            .x = nm,
                            .y = y};
  }
  const abbe_chart chart = {.title = title,
                            .x.label = "wavelength, nm",
                            .y.label = "CIEDE2000 from the truth",
                            .series_count = LINES,
                            .series = series};
  abbe_result result = abbe_chart_write(path, &chart, 1, 0, 0, error);
  free(nm);
  return result;
}
