/* materials_report.h: what a conversion met on its way, told to a person or to a program. */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_REPORT_H
#define ABBE_CLI_MATERIALS_MATERIALS_REPORT_H

#include "base/report.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

/* One line a note to stderr; of each kind the first few, then how many more there are, unless all
 * are wanted. */
void abbe_materials_print_report(const char *program, const abbe_report *report, bool all);

/* Adds "notes", a list of kind, line, name and text, and the number of each kind. */
void abbe_materials_add_report(cJSON *to, const abbe_report *report);

#endif
