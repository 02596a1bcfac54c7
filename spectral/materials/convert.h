/* convert.h: a dispersion formula from the two numbers that people have, and the error it implies.
 *
 * Two numbers do not fix a curve. The form is made to have exactly the numbers given; how far it is
 * from the truth is estimated by doing the same to materials whose curves are known. */
#ifndef ABBE_SPECTRAL_MATERIALS_CONVERT_H
#define ABBE_SPECTRAL_MATERIALS_CONVERT_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/dispersion/fit.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

/* X(code, first number, second number). */
#define ABBE_GIVENS(X)                                                                             \
  X(ND_VD, "n_d", "V_d")            /* catalogues */                                               \
  X(ND_BG, "n_d", "B-G dispersion") /* the gem trade: n(430.8 nm) - n(686.7 nm) */                 \
  X(A_B, "A", "B")                  /* Cauchy's first two coefficients, B in um^2 */               \
  X(GLTF, "ior", "dispersion") /* glTF: n_d and 20 / V_d; 0 is no dispersion [glTFDispersion] */

typedef enum abbe_given_kind {
#define ABBE_GIVEN_ENUM(code, first, second) ABBE_GIVEN_##code,
  ABBE_GIVENS(ABBE_GIVEN_ENUM)
#undef ABBE_GIVEN_ENUM
      ABBE_GIVEN_KIND_COUNT
} abbe_given_kind;

typedef struct abbe_given {
  abbe_given_kind kind;
  double first, second;
  double first_half, second_half; /* half of the last digit given; 0: exact */
} abbe_given;

/* The names of the two numbers; "unknown" for a kind that is none. */
const char *abbe_given_first_name(abbe_given_kind kind);
const char *abbe_given_second_name(abbe_given_kind kind);

/* The form that has the numbers: ABBE_FIT_CAUCHY, n = A + B L^-2, or ABBE_FIT_SELLMEIER with one
 * term and c0 = 0. ABBE_INVALID_ARGUMENT, with what would be right, for an n_d outside (1, 10], a
 * V_d or dispersion not above 0 (glTF's may be 0), or a dispersion that no one-term Sellmeier form
 * has.
 */
abbe_result abbe_convert_make(const abbe_given *given, abbe_fit_form form, abbe_dispersion *out,
                              abbe_error *error);

#define ABBE_CONVERT_COMPARED 5

typedef struct abbe_convert_error {
  double rounding; /* largest change of n that the last digits given leave open */
  double typical;  /* mean of the known materials' rms errors, scaled to this dispersion */
  double largest;  /* largest error among them, scaled likewise */
  double at_nm;    /* where that is */
  size_t compared; /* known materials compared: those nearest in V_d, at most five */
  size_t worst;    /* index in the table of the one with the largest error */
} abbe_convert_error;

/* What the conversion implies over [min_nm, max_nm]. The same is done to the materials of `known`
 * that have data over the whole range and are nearest in V_d; each error is scaled by the ratio of
 * dispersions n_F - n_C. For A and B they are fitted, as such pairs mostly come from a fit. With
 * none to compare, compared is 0 and the errors NaN. ABBE_INVALID_ARGUMENT as above. */
abbe_result abbe_convert_judge(const abbe_given *given, abbe_fit_form form,
                               const abbe_material_table *known, double min_nm, double max_nm,
                               abbe_convert_error *out, abbe_error *error);

#endif
