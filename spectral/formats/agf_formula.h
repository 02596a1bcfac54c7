/* agf_formula.h: the thirteen dispersion formulas of Zemax glass catalogues, to our models and back.
 *
 * Coefficients are in the catalogue's order and for micrometres in air, as Zemax has them [ZemaxAGF]. It reads
 * no files: see spectral/formats/material_import.h and spectral/formats/material_write.h.
 * Internal to spectral/formats/.
 */
#ifndef ABBE_SPECTRAL_FORMATS_AGF_FORMULA_H
#define ABBE_SPECTRAL_FORMATS_AGF_FORMULA_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_AGF_COEFFICIENTS 10

typedef struct abbe_agf_formula {
  int number;                       /* 1 to 13 */
  double c[ABBE_AGF_COEFFICIENTS];  /* the CD line; 0 where the formula has no more */
} abbe_agf_formula;

/* The formula's name in Zemax (Schott, Sellmeier 1, …); NULL outside 1 to 13. */
const char *abbe_agf_formula_name(int number);

/* The model that computes the same n. ABBE_INVALID_ARGUMENT where there is no such formula, or all
 * coefficients are 0 or one is not finite. *out needs no freeing. */
abbe_result abbe_agf_formula_read(const abbe_agf_formula *formula, abbe_dispersion *out,
                                  abbe_error *error);

typedef enum abbe_agf_fidelity {
  ABBE_AGF_SAME,      /* reading it again gives the same model and coefficients */
  ABBE_AGF_REWRITTEN, /* the same n to rounding, through another formula */
  ABBE_AGF_FITTED     /* no formula of Zemax computes it: only near */
} abbe_agf_fidelity;

/* The Zemax formula that computes the dispersion. Where none does, the square of a Cauchy form of
 * four terms (formula 10), fitted over [min_nm, max_nm], with its largest error there in *max_error
 * (else 0). ABBE_INVALID_ARGUMENT where it cannot be fitted. */
abbe_result abbe_agf_formula_write(const abbe_dispersion *dispersion, double min_nm, double max_nm,
                                   abbe_agf_formula *out, abbe_agf_fidelity *fidelity,
                                   double *max_error, abbe_error *error);

/* The words and numbers of a line of a Zemax catalogue. */

enum { ABBE_AGF_MAX_FIELDS = 16 };

/* Numbers of a record that may go on over several lines. NaN stands for '-'. */
typedef struct abbe_agf_numbers {
  double value[ABBE_AGF_MAX_FIELDS];
  size_t count;
  bool bad;    /* something in it was no number */
  bool commas; /* it had decimal commas */
} abbe_agf_numbers;

/* What parts fields: blanks, tabs and commas. */
bool abbe_agf_is_blank(char c);
const char *abbe_agf_skip(const char *c);
/* The next field into text, cut to fit; past it. */
const char *abbe_agf_word(const char *c, char *text, size_t size);
/* Adds all that follow. */
void abbe_agf_numbers_read(const char *c, abbe_agf_numbers *to);
/* Number i, or otherwise where it is not there or not known. */
double abbe_agf_number(const abbe_agf_numbers *numbers, size_t i, double otherwise);

#endif
