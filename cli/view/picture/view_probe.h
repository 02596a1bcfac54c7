/* view_probe.h: what is known of a pixel's light: its spectrum with standard errors, and its
 * colour. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_PROBE_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_PROBE_H

#include "cli/view/picture/view_show.h"
#include "cli/view/picture/view_spot.h"

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
