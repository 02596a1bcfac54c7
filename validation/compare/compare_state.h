/* compare_state.h: what the parts of a comparison share. Internal to validation/. */
#ifndef ABBE_VALIDATION_COMPARE_COMPARE_STATE_H
#define ABBE_VALIDATION_COMPARE_COMPARE_STATE_H

#include "validation/compare/compare.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { ABBE_COMPARE_BAD_REFERENCE = 1, ABBE_COMPARE_BAD_TEST = 2 };

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

#ifdef __cplusplus
}
#endif
#endif
