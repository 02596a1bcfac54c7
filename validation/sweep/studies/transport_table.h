/* transport_table.h: ways for a caustic's light as tables: for programs, and for people. */
#ifndef ABBE_VALIDATION_SWEEP_STUDIES_TRANSPORT_TABLE_H
#define ABBE_VALIDATION_SWEEP_STUDIES_TRANSPORT_TABLE_H

#include "validation/sweep/studies/transport_study.h"

#include <stdio.h>

/* CSV: transport, footprint, region, lookup, the numbers, front_time, front_bytes.
 * ABBE_IO. */
abbe_result abbe_transport_table_save(const abbe_transport_study *study, const char *path,
                                      abbe_error *error);

/* Markdown: all of it; of each kind of volume the best that has no more bytes than the method as
 * printed, where that is there; and slopes by samples. */
void abbe_transport_table_print(const abbe_transport_study *study, FILE *out);

#endif
