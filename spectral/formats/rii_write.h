/* rii_write.h: a material as a file of the refractiveindex.info database, with what is lost stated.
 *
 * Formulas 1 to 9 cover every model of ours, so that no fit is needed; attenuation becomes a table
 * of k. The material's name is its file's, which the caller chooses.
 */
#ifndef ABBE_SPECTRAL_FORMATS_RII_WRITE_H
#define ABBE_SPECTRAL_FORMATS_RII_WRITE_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material.h"

#include <stdio.h>

/* Writes the material to the stream. What the database has no place for is noted in report as LOST.
 * ABBE_INVALID_ARGUMENT as abbe_material_check has it, ABBE_IO where the stream fails. */
abbe_result abbe_rii_write(const abbe_material *material, FILE *to, abbe_report *report,
                           abbe_error *error);

#endif
