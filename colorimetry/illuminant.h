/* illuminant.h: relative spectral power distributions of light sources.
 *
 * A (the CIE's formula), D50 and D65 (the CIE's tables), E, or a tabulated spectrum of the user's
 * own. Only the shape matters: weights are normalised. The CIE's tables are interpolated linearly
 * between their 5 nm knots, as is a file of the user's own; outside its table a light is dark.
 */
#ifndef ABBE_COLORIMETRY_ILLUMINANT_H
#define ABBE_COLORIMETRY_ILLUMINANT_H

#include "base/error.h"
#include "spectral/spectrum.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_ILLUMINANT_KINDS(X) X(D65) X(D50) X(A) X(E) X(TABULATED)

typedef enum abbe_illuminant_kind {
#define ABBE_ILLUMINANT_ENUM(name) ABBE_ILLUMINANT_##name,
  ABBE_ILLUMINANT_KINDS(ABBE_ILLUMINANT_ENUM)
#undef ABBE_ILLUMINANT_ENUM
  ABBE_ILLUMINANT_KIND_COUNT
} abbe_illuminant_kind;

/* A zeroed struct is D65. */
typedef struct abbe_illuminant {
  abbe_illuminant_kind kind;
  abbe_spectrum *spectrum; /* TABULATED: relative power at nm, >= 0; owned; else NULL */
} abbe_illuminant;

/* "D65", "D50", "A", "E" (any case), or the path of a file of two columns, wavelength and relative
 * power, as spectral/dispersion/csv_points.h reads it: at least two rows, power >= 0 and not all 0. ABBE_PARSE
 * or ABBE_SCHEMA, with line and text, for a row that cannot be used. */
abbe_result abbe_illuminant_make(const char *name_or_path, abbe_illuminant *out,
                                 abbe_error *error);
void abbe_illuminant_free(abbe_illuminant *illuminant);

/* Relative spectral power at lambda_nm (arbitrary unit, 100 at 560 nm for the CIE's own). A
 * tabulated one is 0 outside its table. */
double abbe_illuminant_power(const abbe_illuminant *illuminant, double lambda_nm);

const char *abbe_illuminant_name(const abbe_illuminant *illuminant);

#ifdef __cplusplus
}
#endif
#endif
