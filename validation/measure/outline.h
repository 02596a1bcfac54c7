/* outline.h: where a caustic's light falls and where each of its hues does, in one picture or two.
 *
 * Made for witnesses whose brightness or tone cannot be trusted: the outline is that of the
 * brightest pixels which hold a share of the light, a hue is what a pixel has beside white, and two
 * pictures agree where both put it in the same place. Pixels are smoothed a little first, since
 * noise alone would fray an outline and tint white. How far values are apart is compare.h's
 * business.
 */
#ifndef ABBE_VALIDATION_MEASURE_OUTLINE_H
#define ABBE_VALIDATION_MEASURE_OUTLINE_H

#include "base/error.h"
#include "colorimetry/image/image.h"
#include "validation/measure/mask.h"

#include <stddef.h>

/* X(code, name): sixths of the circle of hues, each around a primary of Rec.709 or a mixture of
 * two in equal parts. */
#define ABBE_OUTLINE_HUES(X)                                                                       \
  X(RED, "red")                                                                                    \
  X(YELLOW, "yellow") X(GREEN, "green") X(CYAN, "cyan") X(BLUE, "blue") X(MAGENTA, "magenta")

typedef enum abbe_outline_hue {
#define ABBE_OUTLINE_ENUM(code, name) ABBE_OUTLINE_##code,
  ABBE_OUTLINE_HUES(ABBE_OUTLINE_ENUM)
#undef ABBE_OUTLINE_ENUM
      ABBE_OUTLINE_HUE_COUNT
} abbe_outline_hue;

const char *abbe_outline_hue_name(abbe_outline_hue hue);

/* Zero means the default in every field. */
typedef struct abbe_outline_options {
  double share; /* share of the light inside the outline, up to 1; 0: 0.9 */
  double blur;  /* standard deviation of the smoothing, pixels, up to 64; 0: 1; negative: none */
} abbe_outline_options;

/* Where the light of one hue is: each pixel counts by how much its largest component of red, green
 * and blue exceeds its smallest. */
typedef struct abbe_outline_place {
  double share;  /* share of the light of all hues; the other members are 0 where this is 0 */
  double x, y;   /* its centre, pixels from the left and the top edge */
  double spread; /* root mean square distance from it, pixels */
} abbe_outline_place;

/* A zeroed outline is empty. */
typedef struct abbe_outline {
  size_t width, height;
  double light;     /* sum of Y over all pixels, not smoothed; unit of the picture */
  double tinted;    /* light of all hues over the sum of red, green and blue, 0 to 1 */
  abbe_mask mask;   /* inside the outline */
  double (*hue)[2]; /* [pixels] angle in sixths of the circle, 0 to 6, and weight >= 0 */
  abbe_outline_place place[ABBE_OUTLINE_HUE_COUNT];
} abbe_outline;

/* From linear Rec.709, rgb[width * height], row 0 at the top; what is not finite is dark.
 * ABBE_INVALID_ARGUMENT where there is no light, or for options out of range; ABBE_NO_MEMORY. */
abbe_result abbe_outline_make(const double (*rgb)[3], size_t width, size_t height,
                              const abbe_outline_options *options, abbe_outline *out,
                              abbe_error *error);
void abbe_outline_free(abbe_outline *outline);

typedef struct abbe_outline_agreement {
  double light_ratio; /* b's light over a's */
  double overlap; /* overlap of the two outlines' insides: common pixels over all of both, 0 to 1 */
  double mean_apart; /* mean distance from one outline to the other, both ways, pixels */
  double p95_apart;  /* its 95th percentile */
  struct {
    double apart;   /* between the centres, pixels; NaN where a side has nothing of the hue */
    double overlap; /* common part of the two distributions over the pixels, 0 to 1 */
  } hue[ABBE_OUTLINE_HUE_COUNT];
} abbe_outline_agreement;

/* ABBE_INVALID_ARGUMENT for different sizes, ABBE_NO_MEMORY. */
abbe_result abbe_outline_compare(const abbe_outline *a, const abbe_outline *b,
                                 abbe_outline_agreement *out, abbe_error *error);

/* Outlines of pictures and maps in files. */

/* The outline of the caustic's layers where the picture has them, else of its colour; with `minus`
 * (a picture of the same size and place, or NULL) of its colour less that one's. place[0] gets
 * the picture's display window, for abbe_image_check_place, and which part of its file it is;
 * place[1] the other one's. Errors of abbe_field_load and
 * abbe_outline_make; ABBE_INVALID_ARGUMENT where there is no colour or the two do not match. */
abbe_result abbe_outline_load(const char *path, const char *minus,
                              const abbe_outline_options *options, abbe_outline *out,
                              abbe_image place[2], abbe_error *error);

#endif
