/* view_painter.h: what rests, made what the screen shows of it by a thread of its own.
 *
 * The display's own transform takes as long as a moving picture or two; whoever watches would wait
 * for it. One picture at a time. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_PAINTER_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_PAINTER_H

#include "cli/view/picture/view_feed.h"
#include "cli/view/picture/view_show.h"

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
