/* material_write.h: materials as records of our own YAML tables.
 *
 * What is written reads back the same (spectral/materials/material_table.h), but for two things
 * that a record in memory no longer knows: a colour at a distance, a transmittance and k are
 * written as the attenuation that they became, and comments of the file (#) are not kept. To change
 * one record of a file and leave the rest, see spectral/editing/table_edit.h.
 */
#ifndef ABBE_SPECTRAL_FORMATS_MATERIAL_WRITE_H
#define ABBE_SPECTRAL_FORMATS_MATERIAL_WRITE_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material.h"
#include "spectral/materials/material_table.h"

#include <stdio.h>

/* The record as an item of the list `materials:`, each line indented by two spaces or more, to the
 * stream. ABBE_INVALID_ARGUMENT for a record that could not be read again (abbe_material_check),
 * before anything is written; ABBE_IO where the stream fails. */
abbe_result abbe_material_write(const abbe_material *material, FILE *to, abbe_error *error);

/* The whole table. ABBE_INVALID_ARGUMENT also where it is too large for a reader of YAML (a store
 * holds it: spectral/store/material_store.h); nothing is written then. */
abbe_result abbe_material_table_write(const abbe_material_table *table, FILE *to,
                                      abbe_error *error);

/* Material tables as Zemax glass catalogues (AGF), with what is lost stated.
 *
 * A formula that Zemax has is written as it is; a Cauchy form of up to four terms is written as
 * its square, which is a polynomial of Schott's kind with the same n; for any other the nearest
 * such polynomial is written and its largest error noted. */

/* Writes the table to the stream. In report: the materials left out (SKIPPED), what AGF has no
 * place for and the errors of fits (LOST), and what is written in another way (CHANGED); what
 * happens to many materials is one note with their number. ABBE_IO where the stream fails;
 * ABBE_NO_MEMORY. */
abbe_result abbe_agf_write(const abbe_material_table *table, FILE *to, abbe_report *report,
                           abbe_error *error);

/* A material as a table of wavelength, n and k, with what is lost stated.
 *
 * Points that spectral/dispersion/csv_points.h reads again. A tabulated index keeps its points; a
 * formula is sampled. */

/* Zero: the record's range within 380 to 780 nm, or all of it where it lies outside; 5 nm. */
typedef struct abbe_csv_sampling {
  double min_nm, max_nm, step_nm;
} abbe_csv_sampling;

/* Writes the columns wavelength_nm, n and, where the material absorbs or is a conductor, k.
 * sampling may be NULL, and is without effect on a tabulated index. ABBE_OUT_OF_RANGE where the
 * range asked for is not the record's and it does not extrapolate, ABBE_INVALID_ARGUMENT for a step
 * that is not positive or makes more than ABBE_SPECTRUM_MAX_COUNT points, ABBE_IO where the stream
 * fails. */
abbe_result abbe_csv_write(const abbe_material *material, const abbe_csv_sampling *sampling,
                           FILE *to, abbe_report *report, abbe_error *error);

/* A material as a file of the refractiveindex.info database, with what is lost stated.
 *
 * Formulas 1 to 9 cover every model of ours, so that no fit is needed; attenuation becomes a table
 * of k. The material's name is its file's, which the caller chooses. */

/* Writes the material to the stream. What the database has no place for is noted in report as LOST.
 * ABBE_INVALID_ARGUMENT as abbe_material_check has it, ABBE_IO where the stream fails. */
abbe_result abbe_rii_write(const abbe_material *material, FILE *to, abbe_report *report,
                           abbe_error *error);

/* A MaterialX document: an open_pbr_surface and its surfacematerial for each material.
 *
 * It has n_d, V_d and, of what absorbs, a colour at a depth in metres [OpenPBR]; what that loses is
 * noted, with the largest error of n. What has no n_d and V_d in its range, and a conductor, is
 * noted as SKIPPED. ABBE_IO where the stream fails, ABBE_NO_MEMORY. */
abbe_result abbe_mtlx_write(const abbe_material_table *table, FILE *to, abbe_report *report,
                            abbe_error *error);

#endif
