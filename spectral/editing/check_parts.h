/* check_parts.h: the parts of spectral/editing/check.c, and what they share.
 * Internal to spectral/. */
#ifndef ABBE_SPECTRAL_EDITING_CHECK_PARTS_H
#define ABBE_SPECTRAL_EDITING_CHECK_PARTS_H

#include "base/error.h"
#include "spectral/editing/finding.h"
#include "spectral/materials/material_numbers.h"
#include "spectral/materials/material_table.h"

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

/* Whether the coefficients make sense only when they are read in another way; true where they do,
 * since nothing else can be said of them then. */
bool abbe_check_read_anew(abbe_check *c);
/* What the curve does over its range, and what is printed about it. */
void abbe_check_follow_curve(abbe_check *c);
/* Whether its data cover the visible; the whole of what can be said of a conductor's curve. */
void abbe_check_cover(abbe_check *c);
/* Rows that are alike. */
abbe_result abbe_check_compare_rows(const abbe_material_table *table, abbe_findings *findings,
                                    abbe_error *error);

#endif
