/* gamut_check.h: how much of a picture a gamut cannot hold, where, and what bringing it inside
 * costs.
 */
#ifndef ABBE_COLORIMETRY_PICTURE_GAMUT_GAMUT_CHECK_H
#define ABBE_COLORIMETRY_PICTURE_GAMUT_GAMUT_CHECK_H

#include "colorimetry/gamut.h"
#include "colorimetry/image/picture_space.h"

/* Excess (abbe_gamut_excess) up to which a colour counts as inside: half a step of 10 bits. */
#define ABBE_GAMUT_CHECK_SLACK 5e-4

/* Changes of the pixels outside: CIEDE2000 under the white below, and hue in Oklab, degrees. */
typedef struct abbe_gamut_cost {
  double mean, greatest;
  double hue_mean, hue_greatest;
} abbe_gamut_cost;

typedef struct abbe_gamut_check {
  abbe_gamut gamut;
  abbe_picture_space space; /* the picture's space */
  size_t width, height;
  size_t lit;           /* pixels that are finite and of Y above 0 */
  size_t outside;       /* of the pixels: those outside */
  abbe_image_odd odd;   /* pixels that are not finite */
  double light_outside; /* their share of all lit pixels' Y */
  double excess_mean;   /* mean over the pixels outside; 0: none is */
  double excess_greatest;
  size_t x, y;    /* the pixel of the greatest excess, from the picture's corner */
  double white_y; /* 99 % of the lit pixels have no more */
  abbe_gamut_cost cost[ABBE_GAMUT_MAP_COUNT]; /* of each mapping; zeros for NONE */
  float (*xyz)[3];                            /* [height * width] relative to D65 */
  float *excess;                              /* [height * width]; NaN where it is not lit */
} abbe_gamut_check;

/* Checks the picture's R, G, B or X, Y, Z. ABBE_NOT_FOUND without these, ABBE_INVALID_ARGUMENT
 * where nothing is lit and for chromaticities that span no space, ABBE_NO_MEMORY. `name` is what
 * errors call the picture. */
abbe_result abbe_gamut_check_make(const abbe_image *image, const char *name, abbe_gamut gamut,
                                  abbe_gamut_check *out, abbe_error *error);
void abbe_gamut_check_free(abbe_gamut_check *check);

/* The picture in grey, with what is outside in colours of its excess, as a PNG. */
abbe_result abbe_gamut_check_overlay(const abbe_gamut_check *check, const char *path,
                                     abbe_error *error);
/* The lit pixels' chromaticities in the CIE's diagrams of 1931 and 1976, with the spectral locus
 * and all gamuts, as a .png or .svg. */
abbe_result abbe_gamut_check_diagram(const abbe_gamut_check *check, const char *path,
                                     const char *title, abbe_error *error);

#endif
