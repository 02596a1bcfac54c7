/* compare_state.h: what the parts of a comparison share. Internal to validation/. */
#ifndef ABBE_VALIDATION_COMPARE_COMPARE_STATE_H
#define ABBE_VALIDATION_COMPARE_COMPARE_STATE_H

#include "validation/compare/compare.h"

enum { ABBE_COMPARE_BAD_REFERENCE = 1, ABBE_COMPARE_BAD_TEST = 2 };

/* What is compared: REF and TEST; or what is under REF's noise, with the noise of REF's errors on
 * REF's side and none on TEST's, or with that of each on its own. */
typedef enum abbe_compare_sides {
  ABBE_COMPARE_TEST,
  ABBE_COMPARE_NOISE_OF_REFERENCE,
  ABBE_COMPARE_NOISE_OF_BOTH
} abbe_compare_sides;

typedef struct abbe_compare_state {
  const abbe_field *reference, *test;
  const abbe_compare_options *options;
  size_t pixels;
  unsigned char *bad; /* [pixels] 0: both sides are finite */
  abbe_comparison *out;
} abbe_compare_state;

/* Whether a pixel takes part: finite, and in the mask (NULL: anywhere). */
static inline bool abbe_compare_has(const abbe_compare_state *s, const abbe_mask *mask,
                                    size_t pixel) {
  return s->bad[pixel] == 0 && (mask == NULL || mask->in[pixel]);
}

/* REF's unit, the scale and the white, over the whole field. */
abbe_result abbe_compare_find_units(abbe_compare_state *s, abbe_error *error);
/* The metrics of light, of bands and of the Z-test, of one region. */
abbe_result abbe_compare_light(const abbe_compare_state *s, const abbe_mask *mask,
                               abbe_compare_region *region, abbe_error *error);
/* The metrics of colour, of both regions. */
abbe_result abbe_compare_colour(const abbe_compare_state *s, abbe_error *error);
/* XYZ of the two sides at a pixel, REF's in b. */
void abbe_compare_take_sides(const abbe_compare_state *s, abbe_compare_sides who, size_t pixel,
                             double b[3], double a[3]);
/* Whether the files have the standard errors for it. */
bool abbe_compare_knows(const abbe_compare_state *s, abbe_compare_sides who);
/* The metrics that look at a pixel's surroundings, of both regions of a picture. */
abbe_result abbe_compare_structure(const abbe_compare_state *s, abbe_error *error);

#endif
