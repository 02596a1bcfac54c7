/* illuminant.h: relative spectral power distributions of light sources.
 *
 * A (the CIE's formula), D50 and D65 (the CIE's tables), E; C, F1 to F12 and the CIE's LED sources
 * (its tables); daylight and black bodies by their temperature; light of spectral lines; or a
 * tabulated spectrum of the user's own. Only the shape matters: weights are normalised. Tables are
 * interpolated linearly between their knots (daylight's at 10 nm), as is a file of the user's own.
 * Outside its table a light is dark: beyond 380 to 780 nm for F and LED, beyond 300 to 830 nm for
 * daylight and black bodies. */
#ifndef ABBE_COLORIMETRY_ILLUMINANT_H
#define ABBE_COLORIMETRY_ILLUMINANT_H

#include "base/error.h"
#include "spectral/spectrum.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_ILLUMINANT_KINDS(X) X(D65) X(D50) X(A) X(E) X(TABULATED)

typedef enum abbe_illuminant_kind {
#define ABBE_ILLUMINANT_ENUM(name) ABBE_ILLUMINANT_##name,
  ABBE_ILLUMINANT_KINDS(ABBE_ILLUMINANT_ENUM)
#undef ABBE_ILLUMINANT_ENUM
      ABBE_ILLUMINANT_KIND_COUNT
} abbe_illuminant_kind;

/* Every name, for messages and for help. */
#define ABBE_ILLUMINANT_NAMES                                                                      \
  "D65, D50, A, E, C, F1 to F12, LED-B1 to LED-B5, LED-BH1, LED-RGB1, LED-V1, LED-V2, D5503 "      \
  "(daylight of that many K; D55: of so many hundreds), 3200K (a black body), sodium, mercury, "   \
  "hydrogen, 632.8nm (a laser), line-d (Fraunhofer's i, h, g, F', F, e, d, D, C', C, r)"

/* A zeroed struct is D65. */
typedef struct abbe_illuminant {
  abbe_illuminant_kind kind;
  abbe_spectrum *spectrum; /* TABULATED: relative power at nm, >= 0; owned; else NULL */
  char name[12];           /* TABULATED: "F11", "D5503", "sodium"; empty of a file's */
} abbe_illuminant;

/* A line of the spectrum is a triangle of that half width, nm: narrower than what a prism
 * parts. */
#define ABBE_ILLUMINANT_LINE_HALF_NM 1e-3
enum { ABBE_ILLUMINANT_MOST_LINES = 8 };
/* Middles of its lines, nm in air, ascending; how many. 0 of a light that is not named as one of
 * lines. */
size_t abbe_illuminant_lines(const abbe_illuminant *illuminant,
                             double lambda_nm[ABBE_ILLUMINANT_MOST_LINES]);

/* A name of ABBE_ILLUMINANT_NAMES (any case; "FL11" is F11), or the path of a file of two columns,
 * wavelength and relative power, as spectral/dispersion/csv_points.h reads it: at least two rows,
 * power >= 0 and not all 0. Daylight [CIE15] is of 4000 to 25000 K; in two or three digits, as in
 * D55, it is of so many hundreds by the c2 of 1931, 1.438e7 nm K (D55: 5503 K). Black bodies are of
 * ABBE_COLOUR_TEMPERATURE_MIN to _MAX, with c2 = 1.4388e7 nm K. A line of its own is one that the
 * eye sees. ABBE_INVALID_ARGUMENT for other temperatures and lines; ABBE_PARSE or ABBE_SCHEMA, with
 * line and text, for a row that cannot be used; ABBE_NOT_FOUND for what is neither name nor file.
 */
abbe_result abbe_illuminant_make(const char *name_or_path, abbe_illuminant *out, abbe_error *error);
void abbe_illuminant_free(abbe_illuminant *illuminant);

/* Relative spectral power at lambda_nm (arbitrary unit, 100 at 560 nm for the CIE's own). A
 * tabulated one is 0 outside its table. */
double abbe_illuminant_power(const abbe_illuminant *illuminant, double lambda_nm);

/* The name that was requested; "tabulated" for a file. */
const char *abbe_illuminant_name(const abbe_illuminant *illuminant);

/* Whether it names a light, whatever files there are, also one of a temperature or line that cannot
 * be. NULL does not. */
bool abbe_illuminant_is_name(const char *name);
/* The lights that have names of their own, one by one: NULL beyond the last. */
const char *abbe_illuminant_listed(size_t index);

#endif
