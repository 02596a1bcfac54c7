#include "cli/gem/gem.h"

#include "base/file.h"
#include "base/maths.h"
#include "colorimetry/plot/chart.h"
#include "scenes/cuts/cut_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool ends_with(const char *path, const char *ending) {
  const size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

abbe_result abbe_gem_output_write(const char *path, const abbe_cut *cut,
                                  const abbe_cut_polyhedron *stone, double scale,
                                  const abbe_material *material, abbe_report *report,
                                  abbe_error *error) {
  const abbe_cut_solid_format solid = abbe_cut_solid_format_of(path);
  const bool asc = ends_with(path, ".asc"), gem = ends_with(path, ".gem");
  const bool gcs = ends_with(path, ".gcs");
  abbe_file_writer writer;
  if (!asc && !gem && !gcs && solid == ABBE_CUT_SOLID_COUNT)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "'%s': a design is written as .asc, .gem or .gcs, its solid as .stl, .obj or "
        ".glb",
        path);
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  abbe_result result =
      asc   ? abbe_cut_asc_write(cut, writer.stream, report, error)
      : gem ? abbe_cut_gem_write(cut, stone, writer.stream, report, error)
      : gcs ? abbe_cut_gcs_write(cut, stone, writer.stream, report, error)
            : abbe_cut_solid_write(cut, stone, scale, material, solid, writer.stream, error);
  return abbe_file_writer_end(&writer, result, error);
}

/* The landscape of a search for angles. */
static double degrees(double rad) {
  return rad * 180 / ABBE_PI;
}

/* An axis whose pixels have their angle in their middle. */
static abbe_chart_axis axis(const char *label, const double *rad, size_t count) {
  const double first = degrees(rad[0]), last = degrees(rad[count - 1]);
  const double half = count > 1 ? 0.5 * (last - first) / ((double)count - 1) : 0.5;
  return (abbe_chart_axis){.label = label, .min = first - half, .max = last + half};
}

abbe_result abbe_gem_optimise_plot(const char *path, const abbe_gem_input *in,
                                   const abbe_gem_optimum *o, const char *measure,
                                   abbe_error *error) {
  ABBE_FREED float *value = malloc(o->crowns * o->pavilions * sizeof *value);
  if (value == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a chart");
  for (size_t i = 0; i < o->crowns * o->pavilions; i++)
    value[(o->pavilions - 1 - i / o->crowns) * o->crowns + i % o->crowns] =
        (float)(100 * o->value[i].value);
  char title[300], label[64];
  snprintf(title, sizeof title, "%s in %s", abbe_gem_input_title(in), in->material->name);
  snprintf(label, sizeof label, "%s, %%", measure);
  const abbe_chart_field field = {.width = o->crowns,
                                  .height = o->pavilions,
                                  .value = value,
                                  .map = ABBE_COLOUR_MAP_AMOUNT,
                                  .label = label};
  const double x[2] = {degrees(o->crown_rad[o->best % o->crowns]), degrees(o->design_crown_rad)};
  const double y[2] = {degrees(o->pavilion_rad[o->best / o->crowns]),
                       degrees(o->design_pavilion_rad)};
  const abbe_chart_series series[2] = {
      {.label = "best", .style = ABBE_CHART_POINTS, .count = 1, .x = x, .y = y, .colour = 3},
      {.label = "the design",
       .style = ABBE_CHART_POINTS,
       .count = 1,
       .x = x + 1,
       .y = y + 1,
       .colour = 6}};
  const abbe_chart chart = {.title = title,
                            .x = axis("crown, degrees", o->crown_rad, o->crowns),
                            .y = axis("pavilion, degrees", o->pavilion_rad, o->pavilions),
                            .field = &field,
                            .series_count = 2,
                            .series = series};
  return abbe_chart_write(path, &chart, 1, 860, 640, error);
}
