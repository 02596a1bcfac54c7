/* sweep_report.h: sweeps for people: the Pareto front as text and JSON. Internal to cli/sweep/. */
#ifndef ABBE_CLI_SWEEP_SWEEP_REPORT_H
#define ABBE_CLI_SWEEP_SWEEP_REPORT_H

#include "validation/sweep/sweep_promises.h"
#include "validation/tradeoff/sweep_table.h"

/* The Pareto front by that time, the baselines and what the error is made of, on stdout. */
abbe_result abbe_sweep_report_print(const abbe_sweep_table *table, abbe_sweep_number time,
                                    abbe_sweep_number number, abbe_error *error);
abbe_result abbe_sweep_report_print_json(const abbe_sweep_table *table, abbe_sweep_number time,
                                         abbe_sweep_number number, abbe_error *error);

/* What presets promise beside what was met; nothing where they promise nothing. */
void abbe_sweep_report_print_promises(const abbe_sweep_promises *promises);

#endif
