/* view_show.h: pictures as a screen shows them: through the display transform, or in false colours.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_SHOW_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_SHOW_H

#include "cli/view/state/view_state.h"
#include "colorimetry/image/display_ocio.h"
#include "colorimetry/image/display_table.h"
#include "colorimetry/image/image.h"

/* For differences: that share of the mean Y of the traced picture is full red or blue. For errors:
 * from the one to the other share of the mean, a decade for each third. */
#define ABBE_VIEW_FULL_DIFFERENCE 0.25
#define ABBE_VIEW_LEAST_ERROR 0.001

/* Zeroed images are not there yet. */
typedef struct abbe_view_pictures {
  abbe_image rendered, layers, error, traced; /* layers: direct.*, caustic.* of the same size */
  size_t coarse;  /* pixels a side that one of rendered stands for, while things move; 0: one */
  size_t beyond;  /* pixels by which it is higher than the picture then, above it */
  abbe_image map; /* X, Y, Z of a light's texels */
} abbe_view_pictures;
void abbe_view_pictures_free(abbe_view_pictures *pictures);

/* Where PREFIX.R, PREFIX.G and PREFIX.B are ("": R, G, B); false where they are not. */
bool abbe_view_channels(const abbe_image *image, const char *prefix, size_t channel[3]);
/* How much of R, G and B is in Y, in ACEScg; and the Y of a pixel by that. */
void abbe_view_luminance_weights(double weight[3]);
double abbe_view_luminance(const double weight[3], const abbe_image *image, const size_t channel[3],
                           size_t pixel);

/* Which of the pictures a wish comes to: the rendered one where that is not there. */
abbe_view_shown abbe_view_shown_of(const abbe_view_pictures *pictures, abbe_view_shown wish);

/* out: 4 bytes a pixel, rows downward, malloc'd. Pictures are in ACEScg. table: by the display's,
 * which is quicker; may be NULL. ABBE_NO_MEMORY; ABBE_CANCELLED by the thread's watch; errors of
 * abbe_display_apply. */
abbe_result abbe_view_show(const abbe_view_pictures *pictures, abbe_view_shown shown,
                           double exposure, const abbe_display *display,
                           const abbe_display_table *table, unsigned char **out, abbe_error *error);

#endif
