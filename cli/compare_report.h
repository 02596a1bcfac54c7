/* compare_report.h: a comparison for people and as JSON, on stdout. */
#ifndef ABBE_CLI_COMPARE_REPORT_H
#define ABBE_CLI_COMPARE_REPORT_H

#include "validation/compare/compare_notes.h"

void abbe_compare_report_print(const abbe_file_comparison *comparison,
                               const abbe_compare_notes *notes);
abbe_result abbe_compare_report_print_json(const abbe_file_comparison *comparison,
                                           const abbe_compare_notes *notes,
                                           const abbe_compare_tolerance *tolerance, size_t count,
                                           abbe_error *error);

#endif
