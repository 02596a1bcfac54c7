/* check_parts.h: the parts of spectral/editing/check.c, and what they share.
 * Internal to spectral/. */
#ifndef ABBE_SPECTRAL_EDITING_CHECK_PARTS_H
#define ABBE_SPECTRAL_EDITING_CHECK_PARTS_H

#include "base/error.h"
#include "spectral/materials/material_query.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One thing that a check of a material table found, and the list of them.
 *
 * It finds nothing itself: that is check.h's. */

/* X(code, name, what it means). */
#define ABBE_FINDING_KINDS(X)                                                                      \
  X(A_IS_ND, "a-is-n_d", "the column A holds n_d instead of Cauchy's A")                           \
  X(B_IN_NM2, "b-in-nm2", "Cauchy's B is in nm^2 instead of um^2")                                 \
  X(SWAPPED, "a-b-swapped", "Cauchy's A and B have changed places")                                \
  X(POLES, "poles", "Sellmeier poles are squared once too often, or once too seldom")              \
  X(ORDER, "coefficients-swapped", "two coefficients have changed places")                         \
  X(NO_INDEX, "no-index", "the formula has no real index inside its own range")                    \
  X(BELOW_ONE, "below-one", "n is below 1")                                                        \
  X(RISING, "rising", "n rises with the wavelength in the visible")                                \
  X(BIREFRINGENCE, "birefringence", "the two indices of a crystal do not go together")             \
  X(OFF_ND, "n_d", "n_d does not follow from the coefficients")                                    \
  X(OFF_VD, "v_d", "V_d does not follow from the coefficients")                                    \
  X(UNLIKE, "unlike-namesake", "the known material of this name is another")                       \
  X(EXTRAPOLATED, "extrapolated", "the index is used outside the range of its data")               \
  X(DARK, "not-visible", "the data do not cover 380 to 780 nm")                                    \
  X(SAME_NAME, "same-name", "two rows have one name")                                              \
  X(SAME, "duplicate", "two rows have the same numbers")                                           \
  X(NEAR, "near-duplicate", "two rows differ by less than can be measured")                        \
  X(NO_SOURCE, "no-source", "nothing says where the numbers come from")                            \
  X(UNITS, "units", "a range is missing, or a number in another unit")                             \
  X(FIT, "fit", "a recorded fit is not the row's")

typedef enum abbe_finding_kind {
#define ABBE_FINDING_ENUM(code, name, meaning) ABBE_FINDING_##code,
  ABBE_FINDING_KINDS(ABBE_FINDING_ENUM)
#undef ABBE_FINDING_ENUM
      ABBE_FINDING_KIND_COUNT
} abbe_finding_kind;

typedef enum abbe_finding_weight {
  ABBE_FINDING_NOTE,     /* to know, not to fix */
  ABBE_FINDING_DOUBTFUL, /* to look at */
  ABBE_FINDING_WRONG
} abbe_finding_weight;

#define ABBE_FINDING_NO_ROW SIZE_MAX

typedef struct abbe_finding {
  abbe_finding_kind kind;
  abbe_finding_weight weight;
  size_t row;      /* row of the table; 0 for a single material */
  size_t other;    /* the row that it is like, or ABBE_FINDING_NO_ROW */
  char *evidence;  /* a sentence with numbers */
  char *fix;       /* a sentence: what would be right */
  bool certain;    /* key set to value fixes it */
  const char *key; /* key of the record, such as "coefficients"; NULL without a value */
  char *value;     /* YAML, one line; NULL where the fix is not a value */
} abbe_finding;

/* Zero-initialise. */
typedef struct abbe_findings {
  size_t count, capacity;
  abbe_finding *finding; /* row by row, in the order of the kinds */
} abbe_findings;

void abbe_findings_free(abbe_findings *findings);

const char *abbe_finding_kind_name(abbe_finding_kind kind);
const char *abbe_finding_kind_meaning(abbe_finding_kind kind);
const char *abbe_finding_weight_name(abbe_finding_weight weight);

/* The check of one row. */
typedef struct abbe_check {
  const abbe_material *material;
  const abbe_material_table *known;  /* may be NULL */
  const abbe_material *namesake;     /* in known; NULL: none */
  abbe_material_published published; /* NaN where the record is silent */
  double low_nm, high_nm;            /* its range, or 380:780 where it has none */
  size_t row;
  abbe_findings *findings;
  abbe_error *error;
  abbe_result result; /* the first failure */
} abbe_check;

/* Whether the row's own range has data at lambda_nm: elsewhere nothing about it is judged. */
bool abbe_check_has(const abbe_check *c, double lambda_nm);

/* Whether coefficient k is the power of a wavelength, as the formula prints it. */
bool abbe_check_is_exponent(const abbe_dispersion *dispersion, size_t k);

/* A finding of this row, to be filled; a sink where there is no memory, noted in d->result. */
abbe_finding *abbe_check_find(abbe_check *c, abbe_finding_kind kind, abbe_finding_weight weight);

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void abbe_check_say(abbe_check *c, char **sentence, const char *format, ...);

/* key set to "[c0, c1, …]". */
void abbe_check_set_coefficients(abbe_check *c, abbe_finding *finding,
                                 const abbe_dispersion *right);

/* Whether the coefficients make sense only when they are read differently; if so, nothing else can
 * be checked. */
bool abbe_check_read_anew(abbe_check *c);
/* What the curve does over its range, and what is printed about it. */
void abbe_check_follow_curve(abbe_check *c);
/* Checks whether its data cover the visible, which is all that is checked of a conductor's
 * curve. */
void abbe_check_cover(abbe_check *c);
/* Rows that are alike. */
abbe_result abbe_check_compare_rows(const abbe_material_table *table, abbe_findings *findings,
                                    abbe_error *error);

#endif
