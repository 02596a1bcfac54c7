/* export_index.h: n(lambda) as other programs hold it, and how far off that is.
 *
 * Formats have a table, two terms of Cauchy's, n_d with an Abbe number, one index, or one for red,
 * green and blue each. Here are the numbers that serve a material best in such a form, the form's
 * value at any wavelength, and its worst and RMS error over 380 to 780 nm. It writes nothing.
 * Internal to scenes/export/.
 */
#ifndef ABBE_SCENES_EXPORT_EXPORT_INDEX_H
#define ABBE_SCENES_EXPORT_EXPORT_INDEX_H

#include "base/error.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

/* X(code, name, what value[] holds). */
#define ABBE_EXPORT_FORMS(X)                                                                       \
  X(TABLE, "table", "none: n every 5 nm from 360 to 830 nm, straight between")                     \
  X(CAUCHY, "cauchy", "A and B of A + B / lambda^2, B in um^2, by least squares")                  \
  X(ABBE, "abbe", "n_d and 20 / V_d [glTFDispersion]")                                             \
  X(ONE, "one", "n at one wavelength")                                                             \
  X(THREE, "three", "n at 611.4, 549.1 and 464.2 nm, for red, green and blue")

typedef enum abbe_export_form {
#define ABBE_EXPORT_FORM_ENUM(code, name, text) ABBE_EXPORT_FORM_##code,
  ABBE_EXPORT_FORMS(ABBE_EXPORT_FORM_ENUM)
#undef ABBE_EXPORT_FORM_ENUM
      ABBE_EXPORT_FORM_COUNT
} abbe_export_form;

const char *abbe_export_form_name(abbe_export_form form);

/* The table's wavelengths: those that pbrt and Mitsuba draw from. */
#define ABBE_EXPORT_TABLE_FIRST_NM 360.0
#define ABBE_EXPORT_TABLE_STEP_NM 5.0
#define ABBE_EXPORT_TABLE_COUNT 95

typedef struct abbe_export_index {
  abbe_export_form form;
  double value[3];
  double table[ABBE_EXPORT_TABLE_COUNT]; /* TABLE */
  double worst, worst_nm; /* largest |n - the material's| over 380 to 780 nm, and where */
  double rms;             /* over the same, each nanometre alike */
  bool held; /* the record does not vouch for all of 360 to 830 nm: at its ends n is held; errors
                are of the part that it vouches for */
} abbe_export_index;

/* lambda_nm is the wavelength of ONE. ABBE_OUT_OF_RANGE where the material has no index in 380 to
 * 780 nm, ABBE_UNSUPPORTED for a conductor. */
abbe_result abbe_export_index_make(const abbe_material *material, abbe_export_form form,
                                   double lambda_nm, abbe_export_index *out, abbe_error *error);

/* The form's index. */
double abbe_export_index_at(const abbe_export_index *index, double lambda_nm);

#endif
