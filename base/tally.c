#include "base/tally.h"

#include <stdio.h>
#include <string.h>

enum { NAMED = 4 };

void abbe_tally_add(abbe_tally *tally, size_t row, const char *name) {
  if (row >= ABBE_TALLY_MAX_ROWS) return;
  size_t before = tally->count[row]++;
  char *names = tally->names[row];
  size_t used = strlen(names), room = sizeof tally->names[row] - used;
  if (before < NAMED) snprintf(names + used, room, "%s%.*s", before > 0 ? ", " : "", 36, name);
}

void abbe_tally_report(const abbe_tally *tally, const abbe_tally_row *rows, size_t count,
                       abbe_report *report) {
  for (size_t i = 0; i < count && i < ABBE_TALLY_MAX_ROWS; i++) {
    size_t met = tally->count[i];
    if (met == 0) continue;
    abbe_report_add(report, rows[i].kind, 0, NULL, "%s (%zu material%s: %s%s)", rows[i].text, met,
                    met == 1 ? "" : "s", tally->names[i], met > NAMED ? ", …" : "");
  }
}
