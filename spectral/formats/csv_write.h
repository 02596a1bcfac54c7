/* csv_write.h: a material as a table of wavelength, n and k, with what is lost stated.
 *
 * Points that spectral/dispersion/csv_points.h reads again. A tabulated index keeps its points; a formula is
 * sampled.
 */
#ifndef ABBE_SPECTRAL_FORMATS_CSV_WRITE_H
#define ABBE_SPECTRAL_FORMATS_CSV_WRITE_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material.h"

#include <stdio.h>

/* Zero: the record's range within 380 to 780 nm, or all of it where it lies outside; 5 nm. */
typedef struct abbe_csv_sampling {
  double min_nm, max_nm, step_nm;
} abbe_csv_sampling;

/* Writes the columns wavelength_nm, n and, where the material absorbs or is a conductor, k. sampling may be NULL, and
 * is without effect on a tabulated index. ABBE_OUT_OF_RANGE where the range asked for is not the
 * record's and it does not extrapolate, ABBE_INVALID_ARGUMENT for a step that is not positive or
 * makes more than ABBE_SPECTRUM_MAX_COUNT points, ABBE_IO where the stream fails. */
abbe_result abbe_csv_write(const abbe_material *material, const abbe_csv_sampling *sampling,
                           FILE *to, abbe_report *report, abbe_error *error);

#endif
