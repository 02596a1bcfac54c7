/* wavelengths.h: the sampling of the spectrum: nodes and the band that each stands for.
 *
 * Nodes are evenly spaced and include both ends of the range; bands meet midway between
 * neighbouring nodes and the outer two end where the range ends, so the bands tile the range. A
 * single node stands in the middle of its one band. It holds no colour: see colorimetry/weights.h.
 */
#ifndef ABBE_SPECTRAL_WAVELENGTHS_H
#define ABBE_SPECTRAL_WAVELENGTHS_H

#include "base/error.h"

#include <stddef.h>

#define ABBE_WAVELENGTH_MIN_NM 380.0 /* default range, inclusive */
#define ABBE_WAVELENGTH_MAX_NM 780.0
#define ABBE_WAVELENGTHS_MAX_COUNT 4096

typedef struct abbe_wavelengths {
  size_t count;      /* >= 1 */
  double *lambda_nm; /* [count] nodes, ascending, nm in air */
  double *edge_nm;   /* [count + 1] band edges, ascending; edge 0 and edge count are the range */
} abbe_wavelengths;

/* count nodes over [min_nm, max_nm]. ABBE_INVALID_ARGUMENT unless 1 <= count <=
 * ABBE_WAVELENGTHS_MAX_COUNT and 0 < min_nm < max_nm, both finite. *out is owned by the caller. */
abbe_result abbe_wavelengths_make(size_t count, double min_nm, double max_nm, abbe_wavelengths *out,
                                  abbe_error *error);
/* Those nodes, which ascend inside the range; bands meet midway between them. Errors as above. */
abbe_result abbe_wavelengths_of_nodes(size_t count, const double *lambda_nm, double min_nm,
                                      double max_nm, abbe_wavelengths *out, abbe_error *error);
/* Frees the arrays and zeroes the struct; safe on a zeroed one. */
void abbe_wavelengths_free(abbe_wavelengths *wavelengths);

#endif
