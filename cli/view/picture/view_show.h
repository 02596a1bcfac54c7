/* view_show.h: pictures as a screen shows them: through the display transform, or in false colours.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_SHOW_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_SHOW_H

#include "cli/view/state/view_state.h"
#include "colorimetry/image/display_ocio.h"
#include "colorimetry/image/display_table.h"
#include "colorimetry/image/image.h"
#include "gl/device/api.h"

#include <stddef.h>

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

/* A display's table of colours (colorimetry/image/display_table.h), made on a thread of its own,
 * since that takes as long as some moving pictures. */

typedef struct abbe_view_table abbe_view_table;

/* Begins to make it, of a display that lives as long. NULL without memory or a thread. */
abbe_view_table *abbe_view_table_begin(const abbe_display *display);
/* NULL as long as it is not there, and of NULL: the transform itself serves as well, only slower.
 */
const abbe_display_table *abbe_view_table_get(const abbe_view_table *table);
/* Waits for its thread. table may be NULL. */
void abbe_view_table_free(abbe_view_table *table);

/* The picture in the window: a texture, and how it is brought under the panel. */

/* Zeroed but for gl: no picture. */
typedef struct abbe_view_screen {
  const abbe_gl *gl; /* functions of the window's context, which is current in all of these */
  unsigned texture, framebuffer;
  size_t width, height; /* size of the texture */
  size_t side;          /* pixels of the window that one of it is, each way, */
  size_t seen[2];       /* and how many of these are the picture, across and down */
} abbe_view_screen;
void abbe_view_screen_free(abbe_view_screen *screen);

/* Becomes a picture of that size, 4 bytes a pixel, rows downward. Each is side x side of the
 * window's, which are so many in all; what is more of them is to the right and above. */
void abbe_view_screen_take(abbe_view_screen *screen, const unsigned char *pixels, size_t width,
                           size_t height, size_t side, const size_t seen[2]);
/* Into the left upper corner of a window of that height, no farther across than that width. It is
 * copied there, for to draw it as a widget takes a software rasteriser twice as long. Before there
 * is a picture it is a dark pixel, enlarged, so that the driver has compiled that by then. */
void abbe_view_screen_draw(abbe_view_screen *screen, size_t width, size_t height);

#endif
