/* rii.h: materials from files of the refractiveindex.info database.
 *
 * A file holds one material: an index (formula 1 to 9, tabulated n or nk), maybe k, where the
 * numbers come from, and what a maker's catalogue says. It does not read the database's catalogue of
 * pages, the nonlinear index, or formulas for k. Writing is in spectral/formats/rii_write.h.
 */
#ifndef ABBE_SPECTRAL_FORMATS_RII_H
#define ABBE_SPECTRAL_FORMATS_RII_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material.h"

#include <stddef.h>

/* The material of size bytes of text [RefractiveIndexInfo], fit for a table. path stands for the
 * file in messages; name is the material's name, or NULL to make one of the path:
 * …/main/SiO2/nk/Malitson.yml is SiO2-Malitson, …/optical/N-BK7.yml is N-BK7. k becomes
 * attenuation, or the index a conductor's (spectral/materials/conductor.h), with a note; references and comments lose their HTML. Indices or wavelengths that the file calls
 * absolute (of the vacuum) are kept and get a warning. *out is freed by the caller where the result
 * is ABBE_OK. ABBE_SCHEMA or ABBE_PARSE, with file and line, where there is no usable index. */
abbe_result abbe_rii_parse(const char *text, size_t size, const char *path, const char *name,
                           abbe_material *out, abbe_report *report, abbe_error *error);
/* The same from a file of at most 16 MiB. */
abbe_result abbe_rii_load(const char *path, const char *name, abbe_material *out,
                          abbe_report *report, abbe_error *error);

#endif
