#include "base/summary.h"

#include <stdio.h>
#include <string.h>

enum { NAMED = 4 };

void abbe_summary_add(abbe_summary *summary, size_t row, const char *name) {
  if (row >= ABBE_SUMMARY_MAX_ROWS) return;
  size_t before = summary->count[row]++;
  char *names = summary->names[row];
  size_t used = strlen(names), room = sizeof summary->names[row] - used;
  if (before < NAMED) snprintf(names + used, room, "%s%.*s", before > 0 ? ", " : "", 36, name);
}

void abbe_summary_report(const abbe_summary *summary, const abbe_summary_row *rows, size_t count,
                         abbe_report *report) {
  for (size_t i = 0; i < count && i < ABBE_SUMMARY_MAX_ROWS; i++) {
    size_t met = summary->count[i];
    if (met == 0) continue;
    abbe_report_add(report, rows[i].kind, 0, NULL, "%s (%zu material%s: %s%s)", rows[i].text, met,
                    met == 1 ? "" : "s", summary->names[i], met > NAMED ? ", …" : "");
  }
}
