/* The landscape of a search for angles. */
#include "cli/gem/gem.h"

#include "base/maths.h"
#include "colorimetry/plot/chart.h"

#include <stdio.h>
#include <stdlib.h>

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
  float *value = malloc(o->crowns * o->pavilions * sizeof *value);
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
  abbe_result result = abbe_chart_write(path, &chart, 1, 860, 640, error);
  free(value);
  return result;
}
