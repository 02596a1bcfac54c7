/* agf_write.h: material tables as Zemax glass catalogues (AGF), with what is lost stated.
 *
 * A formula that Zemax has is written as it is; a Cauchy form of up to four terms is written as its
 * square, which is a polynomial of Schott's kind with the same n; for any other the nearest such
 * polynomial is written and its largest error noted.
 */
#ifndef ABBE_SPECTRAL_FORMATS_AGF_WRITE_H
#define ABBE_SPECTRAL_FORMATS_AGF_WRITE_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material_table.h"

#include <stdio.h>

/* Writes the table to the stream. In report: the materials left out (SKIPPED), what AGF has no place
 * for and the errors of fits (LOST), and what is written in another way (CHANGED); what happens to
 * many materials is one note with their number. ABBE_IO where the stream fails; ABBE_NO_MEMORY. */
abbe_result abbe_agf_write(const abbe_material_table *table, FILE *to, abbe_report *report,
                           abbe_error *error);

#endif
