#include "tests/extremes/report.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

extreme_report extreme_report_make(int count, char **argument) {
  extreme_report report = {0};
  int i = 1;
  for (; i < count && argument[i][0] == '-'; i++) {
    report.table = report.table || strcmp(argument[i], "--table") == 0;
    report.heavy = report.heavy || strcmp(argument[i], "--heavy") == 0;
  }
  report.count = count - i;
  report.groups = argument + i;
  return report;
}

bool extreme_report_wants(const extreme_report *report, const char *group) {
  for (int i = 0; i < report->count; i++)
    if (strcmp(report->groups[i], group) == 0) return true;
  return report->count == 0;
}

void extreme_row_break(extreme_row *row, const char *format, ...) {
  if (row->broken[0] != '\0') return;
  va_list args;
  va_start(args, format);
  vsnprintf(row->broken, sizeof row->broken, format, args);
  va_end(args);
}

void extreme_row_add(extreme_row *row, const char *format, ...) {
  size_t used = strlen(row->figures);
  va_list args;
  va_start(args, format);
  vsnprintf(row->figures + used, sizeof row->figures - used, format, args);
  va_end(args);
}

void extreme_report_add(extreme_report *report, const char *group, const char *name,
                        const extreme_row *row) {
  bool kept = row->broken[0] == '\0';
  report->rows++;
  if (!kept) report->broken++;
  if (report->table)
    printf("| %s | %s | %s | %s |\n", group, name, row->figures, kept ? "kept" : row->broken);
  else if (!kept)
    printf("%s: %s: %s (%s)\n", group, name, row->broken, row->figures);
  fflush(stdout);
}

int extreme_report_end(const extreme_report *report) {
  if (!report->table) printf("%zu extremes, %zu broken\n", report->rows, report->broken);
  return report->rows > 0 && report->broken == 0 ? 0 : 1;
}
