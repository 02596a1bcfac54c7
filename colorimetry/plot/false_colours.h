/* false_colours.h: one number a pixel of a picture, in false colours with its scale: a band of
 * wavelengths, a distance, a standard error.
 *
 * What is a colour is screen_png.h's.
 */
#ifndef ABBE_COLORIMETRY_PLOT_FALSE_COLOURS_H
#define ABBE_COLORIMETRY_PLOT_FALSE_COLOURS_H

#include "colorimetry/image/image.h"
#include "colorimetry/plot/chart.h"

#include <stdbool.h>

/* Whether what a layer's name means is shown in false colours: a channel of that name ("depth.Z",
 * "S0.550,000000nm", "stderr.R"); a wavelength ("550nm") that a band of the picture holds; a layer
 * of standard errors ("stderr", "stderr.NAME"), whose R, G, B are no colour. */
bool abbe_false_colours_mean(const abbe_image *image, const char *layer);

/* Writes that layer to path (.png or .svg). A scale from 0 to a round number that 999 of 1000
 * values are below; between the least and the greatest, where all lie in the upper half; about 0 in
 * two colours, where some are negative; of standard errors by their logarithm, three decades. What
 * is not finite is green. `name` is what errors call the picture. ABBE_NOT_FOUND where nothing has
 * that name, with what there is. */
abbe_result abbe_false_colours_write(const char *path, const abbe_image *image, const char *layer,
                                     const char *name, abbe_error *error);

/* That scale of sorted finite values, ascending: the field's min, max, map and log. */
void abbe_false_colours_scale(const float *sorted, size_t count, bool is_error,
                              abbe_chart_field *field);

/* What is drawn: value[width * height], of errors by their logarithm. */
typedef struct abbe_false_colours_desc {
  size_t width, height;
  bool is_error;
  const char *title, *label; /* above the picture, and beside the scale */
} abbe_false_colours_desc;

/* Writes such values with such a scale; what of errors is below it becomes its beginning. */
abbe_result abbe_false_colours_draw(const char *path, const abbe_false_colours_desc *desc,
                                    float *value, abbe_error *error);

/* The values of that layer, image->width x image->height, malloc'd; for errors of R, G, B the
 * largest that Y's may be. *title, of title_size bytes, describes them, *is_error whether they are
 * errors. */
abbe_result abbe_false_colours_values(const abbe_image *image, const char *layer, const char *name,
                                      float **values, char *title, size_t title_size,
                                      bool *is_error, abbe_error *error);

#endif
