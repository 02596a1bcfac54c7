/* view_show.h: pictures as a screen shows them: through the display transform, or in false colours.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_SHOW_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_SHOW_H

#include "cli/view/picture/view_feed.h"
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

/* What rests, made what the screen shows of it by a thread of its own.
 *
 * The display's own transform takes as long as a moving picture or two; whoever watches would wait
 * for it. One picture at a time. */

typedef struct abbe_view_painter abbe_view_painter;

/* What is to be shown; all of it stays as it is until it is taken or stopped. */
typedef struct abbe_view_painting {
  const abbe_view_pictures *pictures;
  abbe_view_shown shown;
  double exposure;
  const abbe_display *display;
} abbe_view_painting;

/* Starts the thread. wake (may be NULL) is called on it whenever a picture is there.
 * ABBE_NO_MEMORY. */
abbe_result abbe_view_painter_make(void (*wake)(void), abbe_view_painter **out, abbe_error *error);
/* painter may be NULL, here and where it is stopped. */
void abbe_view_painter_free(abbe_view_painter *painter);

/* Only while it has nothing. */
void abbe_view_painter_give(abbe_view_painter *painter, const abbe_view_painting *painting);
/* What it was given last and what is not taken yet; NULL: nothing. */
const abbe_view_painting *abbe_view_painter_has(const abbe_view_painter *painter);
/* It has nothing any more; waits for it, about a millisecond. */
void abbe_view_painter_stop(abbe_view_painter *painter);
/* Once it is done, what came of it, as abbe_view_show has it, and it has nothing any more. False:
 * not yet. */
bool abbe_view_painter_take(abbe_view_painter *painter, unsigned char **pixels, abbe_result *result,
                            abbe_error *error);

/* What is known of a pixel's light: its spectrum with standard errors, and its colour. */

#define ABBE_VIEW_PROBE_BANDS 64

typedef struct abbe_view_probe {
  bool coloured;       /* something is seen there: */
  bool traced;         /* the colour is the traced picture's; else the rendered one's */
  double xyz[3];       /* relative to D65, radiance shared out as the picture's */
  double xy[2], uv[2]; /* CIE 1931 x, y and 1976 u', v' */
  double dominant_nm;  /* where the line from D65's white meets the locus; below 0: the complement,
                          on the line of purples; 0: too near to white */
  double purity;       /* purity of excitation, 0 to 1 */
  size_t bands;        /* bands of the traced picture; 0: none yet */
  double nm[ABBE_VIEW_PROBE_BANDS];       /* their middles */
  double radiance[ABBE_VIEW_PROBE_BANDS]; /* W/(m2 sr nm) */
  double stderr_of[ABBE_VIEW_PROBE_BANDS];
} abbe_view_probe;

void abbe_view_probe_make(const abbe_view_pictures *pictures, const size_t pixel[2],
                          abbe_view_probe *out);
/* Its spectrum is the spot's, where it has none of its own, or one of a picture of fewer passes. */
void abbe_view_probe_take_spot(abbe_view_probe *probe, size_t passes, const abbe_view_spot *spot);
/* Whether more than a hundredth of lights' light is a caustic at a pixel of the picture's
 * layers. */
bool abbe_view_probe_shows_caustic(const abbe_image *layers, const float *pixel);
/* Where the rendered picture has most colour of a dominant wavelength from nm[0] to nm[1], in its
 * part of left, top, right and bottom, pixels of the window. false: nowhere. */
bool abbe_view_probe_find_hue(const abbe_view_pictures *pictures, const double nm[2],
                              const double part[4], double xy[2]);

#endif
