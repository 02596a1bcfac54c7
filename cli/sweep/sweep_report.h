/* sweep_report.h: sweeps for people: the front as text and JSON, and a page with pictures. */
#ifndef ABBE_CLI_SWEEP_SWEEP_REPORT_H
#define ABBE_CLI_SWEEP_SWEEP_REPORT_H

#include "gl/device/context.h"
#include "validation/sweep/sweep_table.h"

/* The front, the baselines and what the error is made of, on stdout. */
abbe_result abbe_sweep_report_print(const abbe_sweep_table *table, abbe_sweep_number number,
                                    abbe_error *error);
abbe_result abbe_sweep_report_print_json(const abbe_sweep_table *table, abbe_sweep_number number,
                                         abbe_error *error);

/* What the presets in a file (NULL: the shipped ones) promise for the table's class of scenes,
 * beside what it measured: the errors as they are, the times by the ratio of the cheapest point's.
 */
abbe_result abbe_sweep_report_print_promises(const abbe_sweep_table *table, const char *file,
                                             abbe_error *error);

/* A Markdown page of one or more sweeps, beside it the pictures of each scene: the reference, the
 * cheapest, the middle and the most accurate setting of its front, and the two baselines. Scenes
 * and references are read from the paths in the tables; what is gone leaves out its pictures, with
 * a note. */
abbe_result abbe_sweep_report_write(const char *path, const abbe_sweep_table *tables, size_t count,
                                    abbe_sweep_number number, abbe_context_backend backend,
                                    abbe_error *error);

#endif
