/* summary.h: what happens to many materials of a table in the same way, counted and noted once.
 *
 * An exporter lists what can be lost as rows, adds to a row as it meets it, and in the end turns
 * the rows that were met into notes: the row's sentence, how many materials, and the first names.
 */
#ifndef ABBE_BASE_SUMMARY_H
#define ABBE_BASE_SUMMARY_H

#include "base/report.h"

#include <stddef.h>

enum { ABBE_SUMMARY_MAX_ROWS = 16 };

typedef struct abbe_summary_row {
  abbe_note_kind kind;
  const char *text;
} abbe_summary_row;

/* Zero-initialise. */
typedef struct abbe_summary {
  size_t count[ABBE_SUMMARY_MAX_ROWS];
  char names[ABBE_SUMMARY_MAX_ROWS][160];
} abbe_summary;

/* Counts the material under the row; rows past the last are ignored. */
void abbe_summary_add(abbe_summary *summary, size_t row, const char *name);

/* A note in report for each of rows[count] that was met. */
void abbe_summary_report(const abbe_summary *summary, const abbe_summary_row *rows, size_t count,
                         abbe_report *report);

#endif
