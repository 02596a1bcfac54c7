/* csv_points.h: measured points from a text file of columns: wavelength, n, and k or uncertainty;
 * or wavelength and the power of a light, or a reflectance.
 *
 * Columns are parted by commas, semicolons, tabs or blanks; with semicolons a decimal comma is
 * understood. What follows a '#' and empty lines are passed over. A header may name the
 * columns and the unit (wavelength_nm, wl (um), n, k, uncertainty, sigma, du); a second header
 * "wl,k" begins a block of k, as refractiveindex.info writes it. It reads no coefficients.
 */
#ifndef ABBE_SPECTRAL_DISPERSION_CSV_POINTS_H
#define ABBE_SPECTRAL_DISPERSION_CSV_POINTS_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/dispersion/points.h"

#include <stdbool.h>
#include <stddef.h>

/* What a third column holds where no header names it. */
typedef enum abbe_csv_third { ABBE_CSV_UNCERTAINTY, ABBE_CSV_K, ABBE_CSV_IGNORED } abbe_csv_third;

/* What the columns beside the wavelength hold. */
typedef enum abbe_csv_quantity {
  ABBE_CSV_INDEX,      /* n or k or both, and uncertainties */
  ABBE_CSV_POWER,      /* one column, 0 or more; a line that cannot be used is an error */
  ABBE_CSV_REFLECTANCE /* the same, of a surface */
} abbe_csv_quantity;

typedef struct abbe_csv_options {
  abbe_csv_quantity quantity;
  const char *column; /* a power's or reflectance's column: the one that the header names so (any
                         case), beside which there may be others; NULL: there are two columns */
  double unit_nm; /* unit of the first column: 1 for nm, 1000 for um; 0: the header's, or else nm
                     where all are above 100 and um where all are below 50 */
  abbe_csv_third third;
  bool repeats; /* keep several points at one wavelength, as measured ones may be */
} abbe_csv_options;

typedef struct abbe_csv_points {
  abbe_points n;     /* in order; each error is its uncertainty, 0 where none is given */
  abbe_points k;     /* in order; may be empty */
  abbe_points power; /* in order; of a power or reflectance, which has no others */
  size_t first_line; /* the line of the first number */
} abbe_csv_points;

void abbe_csv_points_free(abbe_csv_points *points);

/* Reads size bytes of text (any encoding of base/foreign_text.h); name stands for the file in
 * messages, options may be NULL. A line that cannot be used is noted in report and passed over, and
 * so are, without options->repeats, points at a wavelength that was there before; in a light's file
 * these are ABBE_PARSE or ABBE_SCHEMA, with line and text. ABBE_PARSE where the unit is not clear;
 * ABBE_SCHEMA where no point remains. */
abbe_result abbe_csv_points_parse(const char *text, size_t size, const char *name,
                                  const abbe_csv_options *options, abbe_csv_points *out,
                                  abbe_report *report, abbe_error *error);
/* The same from a file of at most 16 MiB. */
abbe_result abbe_csv_points_load(const char *path, const abbe_csv_options *options,
                                 abbe_csv_points *out, abbe_report *report, abbe_error *error);

#endif
