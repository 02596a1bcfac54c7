/* report.h: what a conversion met on its way: records left out, values changed or not carried.
 *
 * Importers and exporters go on after a bad record and note it here, with the line, the material
 * and a sentence; the caller shows the notes. It holds no results and prints nothing.
 */
#ifndef ABBE_BASE_REPORT_H
#define ABBE_BASE_REPORT_H

#include <stdbool.h>
#include <stddef.h>

/* X(code, word): from harmless to severe. */
#define ABBE_NOTE_KINDS(X)                                                                         \
  X(CHANGED, "changed") /* the same material, written differently */                               \
  X(RENAMED, "renamed") /* the same material, under another name */                                \
  X(LOST, "lost")       /* something in the record is not carried */                               \
  X(ASSUMED, "assumed") /* something that the record lacks is supplied */                          \
  X(SKIPPED, "skipped") /* the record as a whole is left out */

typedef enum abbe_note_kind {
#define ABBE_NOTE_ENUM(code, word) ABBE_NOTE_##code,
  ABBE_NOTE_KINDS(ABBE_NOTE_ENUM)
#undef ABBE_NOTE_ENUM
      ABBE_NOTE_KIND_COUNT
} abbe_note_kind;

typedef struct abbe_note {
  abbe_note_kind kind;
  size_t line;    /* in the source file, from 1; 0 where it has none */
  char file[128]; /* the end of its path, where there are several; else "" */
  char name[96];  /* the material's name; "" where no material is concerned */
  char text[320]; /* a sentence; printable */
} abbe_note;

/* Notes past this many are counted, not kept. */
#define ABBE_REPORT_MAX_NOTES 10000

/* Zero-initialise. */
typedef struct abbe_report {
  size_t count;                       /* notes in note[] */
  abbe_note *note;                    /* in the order in which they were met */
  size_t kinds[ABBE_NOTE_KIND_COUNT]; /* notes of each kind, those not kept included */
  const char *file;                   /* that the next notes are about; NULL: the only one */
} abbe_report;

void abbe_report_free(abbe_report *report);

/* Adds a note; report may be NULL, name NULL for none. Both become printable
 * (text.h). A note for which there is no memory is counted all the same. */
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
void abbe_report_add(abbe_report *report, abbe_note_kind kind, size_t line, const char *name,
                     const char *format, ...);

/* Adds what `from` has, as it is; report may be NULL. */
void abbe_report_join(abbe_report *report, const abbe_report *from);

const char *abbe_note_kind_word(abbe_note_kind kind);

/* What happens to many materials of a table in the same way, counted and noted once.
 *
 * An exporter lists what can be lost as rows, adds to a row as it meets it, and in the end turns
 * the rows that were met into notes: the row's sentence, how many materials, and the first names.
 */

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
