/* The report as a page, and its maps as files. */
#include "cli/gem/gem.h"

#include "base/file.h"
#include "base/maths.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/plot/sheet.h"
#include "validation/measure/gem/gem_maps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double MARGIN = 42, LINE = 13.5;

static void put_numbers(abbe_sheet *s, const abbe_gem_report_facts *f, double y) {
  abbe_gem_judgement_row row[ABBE_GEM_JUDGEMENT_MOST_ROWS];
  const size_t count = abbe_gem_judgement_rows(f->judgement, row);
  const double right = ABBE_SHEET_A4_WIDTH - MARGIN;
  /* All rows are above the page's last line; a crystal has most. */
  const double line = fmin(LINE, (ABBE_SHEET_A4_HEIGHT - MARGIN - 4 - y) / (double)count);
  abbe_sheet_text(s, right - 70, y, 8, false, true, 0.4, "value");
  abbe_sheet_text(s, right, y, 8, false, true, 0.4, "standard error");
  for (size_t i = 0; i < count; i++) {
    char value[32], error[32];
    y += line;
    abbe_sheet_line(s, MARGIN, y + 4, right, y + 4, 0.9);
    abbe_gem_report_number(&row[i], value, error);
    abbe_sheet_text(s, MARGIN, y, 9, false, false, 0.1, row[i].text);
    abbe_sheet_text(s, right - 70, y, 9, true, true, 0, value);
    abbe_sheet_text(s, right, y, 9, false, true, 0.4, error);
  }
}

static abbe_result put_maps(abbe_sheet *s, const abbe_gem_report_facts *f, double y,
                            abbe_error *error) {
  enum { COLUMNS = 3 };
  const double each = (ABBE_SHEET_A4_WIDTH - 2 * MARGIN) / COLUMNS;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < ABBE_GEM_MAP_COUNT && result == ABBE_OK; i++) {
    const double x = MARGIN + each * (i % COLUMNS), top = y + (each + 14) * (i / COLUMNS);
    abbe_image image = {0};
    result = abbe_gem_map_paint(&f->page->own, (abbe_gem_map)i, &image, error);
    if (result == ABBE_OK)
      result = abbe_sheet_picture(s, x + 4, top + 12, each - 8, each - 8, &image, error);
    abbe_sheet_text(s, x + 4, top + 8, 8, false, false, 0.3, abbe_gem_map_text((abbe_gem_map)i));
    abbe_image_free(&image);
  }
  return result;
}

/* One curve for each axis, in percent. */
static abbe_result put_tilts(abbe_sheet *s, const abbe_gem_tilts *t, abbe_gem_tilt_curve curve,
                             const char *label, double y, double height, abbe_error *error) {
  enum { LISTS = 4 };
  const size_t all = ABBE_GEM_AXES * t->tilts;
  ABBE_FREED double *room = malloc(LISTS * all * sizeof *room);
  if (room == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a chart");
  abbe_chart_series series[ABBE_GEM_AXES] = {{0}};
  char name[ABBE_GEM_AXES][32];
  for (size_t i = 0; i < all; i++) {
    const abbe_gem_number n = t->curve[curve][i];
    room[i] = t->tilt_rad[i % t->tilts] * 180 / ABBE_PI;
    room[all + i] = 100 * n.value;
    room[2 * all + i] = 100 * (n.value - n.error);
    room[3 * all + i] = 100 * (n.value + n.error);
  }
  for (size_t a = 0; a < ABBE_GEM_AXES; a++) {
    const size_t at = a * t->tilts;
    snprintf(name[a], sizeof name[a], "axis at %.0f\u00b0", t->axis_rad[a] * 180 / ABBE_PI);
    series[a] = (abbe_chart_series){.label = name[a],
                                    .style = ABBE_CHART_JOINED_POINTS,
                                    .count = t->tilts,
                                    .x = room + at,
                                    .y = room + all + at,
                                    .low = room + 2 * all + at,
                                    .high = room + 3 * all + at};
  }
  const abbe_chart chart = {.x = {.label = "tilt, degrees"},
                            .y = {.label = label},
                            .series_count = ABBE_GEM_AXES,
                            .series = series};
  return abbe_sheet_chart(s, MARGIN, y, ABBE_SHEET_A4_WIDTH - 2 * MARGIN, height, 0.62, &chart,
                          error);
}

static abbe_result put_tilt_page(abbe_sheet *s, const abbe_gem_tilts *t, abbe_error *error) {
  static const struct {
    abbe_gem_tilt_curve curve;
    const char *label;
  } chart[] = {{ABBE_GEM_TILT_ISO, "brightness, %"},
               {ABBE_GEM_TILT_RETURN, "light return, %"},
               {ABBE_GEM_TILT_DOWN, "leakage, %"},
               {ABBE_GEM_TILT_FIRE, "fire, % of pixels"}};
  enum { CHARTS = sizeof chart / sizeof chart[0] };
  const double height = (ABBE_SHEET_A4_HEIGHT - 2 * MARGIN - 24) / CHARTS;
  abbe_sheet_turn(s);
  abbe_sheet_text(s, MARGIN, MARGIN + 10, 14, true, false, 0, "Rocked before the eye");
  for (int i = 0; i < CHARTS; i++) {
    if (chart[i].curve == ABBE_GEM_TILT_FIRE && !t->has_fire) continue;
    ABBE_TRY(put_tilts(s, t, chart[i].curve, chart[i].label, MARGIN + 24 + i * height, height - 8,
                       error));
  }
  return ABBE_OK;
}

abbe_result abbe_gem_report_sheet(const char *path, const abbe_gem_report_facts *f,
                                  abbe_error *error) {
  abbe_sheet *s;
  ABBE_TRY(abbe_sheet_make(path, &s, error));
  char text[400];
  abbe_result result = abbe_gem_report_page_put(s, f, error);
  abbe_sheet_turn(s);
  snprintf(text, sizeof text, "%s in %s", abbe_gem_input_title(&f->input->in),
           f->input->in.material->name);
  abbe_sheet_text(s, MARGIN, MARGIN + 12, 17, true, false, 0, text);
  snprintf(text, sizeof text, "%s, %g mm wide; level, seen from above",
           abbe_file_name(f->input->in.path), 1000 * f->input->width_m);
  abbe_sheet_text(s, MARGIN, MARGIN + 26, 8, false, false, 0.35, text);
  snprintf(text, sizeof text, "head's shadow of half angle %g degrees; D65, %zu wavelength%s%s",
           f->head_deg, f->judgement->view.wavelengths,
           f->judgement->view.wavelengths == 1 ? "" : "s",
           f->judgement->is_crystal ? "; both waves of the crystal" : "");
  abbe_sheet_text(s, MARGIN, MARGIN + 36, 8, false, false, 0.35, text);
  if (result == ABBE_OK) result = put_maps(s, f, MARGIN + 46, error);
  put_numbers(s, f, MARGIN + 46 + 2 * 184 + 22);
  abbe_sheet_text(s, MARGIN, ABBE_SHEET_A4_HEIGHT - MARGIN + 12, 7, false, false, 0.5,
                  "Definitions and sources: docs/gem-measures.md of Abbe");
  if (result == ABBE_OK && f->judgement->has_tilts)
    result = put_tilt_page(s, &f->judgement->tilts, error);
  if (result == ABBE_OK) return abbe_sheet_finish(s, error);
  abbe_sheet_free(s);
  return result;
}

static abbe_result write_map(const char *folder, const abbe_gem_judgement *j, int map,
                             abbe_error *error) {
  char path[4096];
  ABBE_OWNED(abbe_image, image) = {0};
  const bool picture = map < ABBE_GEM_MAP_COUNT;
  const int length = picture ? snprintf(path, sizeof path, "%s/%s.png", folder,
                                        abbe_gem_map_name((abbe_gem_map)map))
                             : snprintf(path, sizeof path, "%s/maps.exr", folder);
  if (length < 0 || (size_t)length >= sizeof path)
    return abbe_error_set(error, ABBE_IO, "%s: the folder's name is too long", folder);
  ABBE_TRY(picture ? abbe_gem_map_paint(&j->view, (abbe_gem_map)map, &image, error)
                   : abbe_gem_map_image(&j->view, &image, error));
  return picture ? abbe_png_write(path, &image, 8, error) : abbe_exr_write(path, &image, error);
}

abbe_result abbe_gem_report_maps(const char *folder, const abbe_gem_judgement *j,
                                 abbe_error *error) {
  for (int i = 0; i <= ABBE_GEM_MAP_COUNT; i++) ABBE_TRY(write_map(folder, j, i, error));
  return ABBE_OK;
}
