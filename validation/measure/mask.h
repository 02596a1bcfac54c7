/* mask.h: which elements of a picture or map are looked at apart from the rest.
 *
 * A mask is a byte an element, 1 inside and 0 outside. It is found from the light itself, the
 * brightest elements that together hold a share of it, or taken from a picture that was drawn for
 * it. It knows nothing of rows and columns, and nothing is smoothed or grown.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_MEASURE_MASK_H
#define ABBE_VALIDATION_MEASURE_MASK_H

#include "colorimetry/image/image.h"
#include "validation/measure/field.h"

/* The share of a caustic's light that its mask holds, unless another is requested. */
#define ABBE_MASK_CAUSTIC_SHARE 0.95

/* A zeroed mask is empty. */
typedef struct abbe_mask {
  size_t count;      /* elements */
  size_t inside;     /* pixels of them in the mask */
  unsigned char *in; /* [count] 0 or 1 */
} abbe_mask;

/* The smallest set of brightest elements of light[count] (any unit) that holds `share` of the
 * total, 0 < share <= 1. What is negative or not a number holds no light; of equal elements the
 * first ones are taken. ABBE_INVALID_ARGUMENT where there is no light at all, or for a share or
 * count out of range; ABBE_NO_MEMORY. */
abbe_result abbe_mask_make_brightest(const double *light, size_t count, double share,
                                     abbe_mask *out, abbe_error *error);
/* The brightest pixels of a field's caustic: of the map itself (its Y, or the sum of its bands), or
 * of the layers caustic.* of a picture. ABBE_INVALID_ARGUMENT, with `name`, where a picture has no
 * such layers or the caustic is dark. */
abbe_result abbe_mask_make_caustic(const abbe_field *field, const char *name, double share,
                                   abbe_mask *out, abbe_error *error);
/* The pixels whose first channel ("R", then "Y", else the first there is) is above 0.5.
 * ABBE_INVALID_ARGUMENT where there is none. */
abbe_result abbe_mask_make_drawn(const abbe_image *image, abbe_mask *out, abbe_error *error);
void abbe_mask_free(abbe_mask *mask);

#endif
