/* agf.h: Zemax glass catalogues (AGF files) as material tables.
 *
 * Reads what real catalogues hold: any encoding, either line end, free text before the first glass,
 * coefficient lines that wrap, missing fields and '-', an n_d of 1 that stands for none. A glass
 * that cannot be used is noted with its line, its name and the reason, and does not stop the rest.
 * Writing is in spectral/formats/agf_write.h.
 */
#ifndef ABBE_SPECTRAL_FORMATS_AGF_H
#define ABBE_SPECTRAL_FORMATS_AGF_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

/* The glasses of size bytes of catalogue in its order, each fit for a table (abbe_material_check);
 * name stands for the file in messages and sources. Indices are relative to air at the catalogue's
 * reference temperature (that of TD), the range is that of LD, internal transmittances (IT) become
 * attenuation, n_d and V_d of NM are kept as published; a GC line that begins with "source:" is the
 * source. ABBE_PARSE where there is no NM line, ABBE_SCHEMA where no glass could be used. */
abbe_result abbe_agf_parse(const char *bytes, size_t size, const char *name,
                           abbe_material_table *out, abbe_report *report, abbe_error *error);
/* The same from a file of at most 64 MiB. */
abbe_result abbe_agf_load(const char *path, abbe_material_table *out, abbe_report *report,
                          abbe_error *error);

#endif
