#include "base/report.h"

#include "base/number.h"
#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
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

void abbe_report_free(abbe_report *report) {
  if (report == NULL) return;
  free(report->note);
  *report = (abbe_report){0};
}

/* Doubles the array at each power of two; NULL where it must not or cannot grow. */
static abbe_note *room(abbe_report *report) {
  size_t count = report->count;
  if (count >= ABBE_REPORT_MAX_NOTES) return NULL;
  if ((count & (count - 1)) == 0) {
    size_t wanted = count == 0 ? 1 : 2 * count;
    abbe_note *larger = realloc(report->note, wanted * sizeof *larger);
    if (larger == NULL) return NULL;
    report->note = larger;
  }
  return &report->note[report->count];
}

void abbe_report_add(abbe_report *report, abbe_note_kind kind, size_t line, const char *name,
                     const char *format, ...) {
  if (report == NULL || (int)kind < 0 || kind >= ABBE_NOTE_KIND_COUNT) return;
  report->kinds[kind]++;
  abbe_note *note = room(report);
  if (note == NULL) return;
  report->count++;
  note->kind = kind;
  note->line = line;
  const char *file = report->file != NULL ? report->file : "";
  size_t length = strlen(file), most = sizeof note->file - 1;
  file += length > most ? length - most : 0;
  while (((unsigned char)*file & 0xc0) == 0x80) file++; /* to a whole letter */
  abbe_utf8_printable(file, strlen(file), false, note->file, sizeof note->file);
  char raw[sizeof note->text];
  va_list args;
  va_start(args, format);
  abbe_number_format_list(raw, sizeof raw, format, args);
  va_end(args);
  abbe_utf8_printable(raw, strlen(raw), false, note->text, sizeof note->text);
  if (name == NULL) name = "";
  abbe_utf8_printable(name, strlen(name), false, note->name, sizeof note->name);
}

void abbe_report_join(abbe_report *report, const abbe_report *from) {
  if (report == NULL) return;
  for (int kind = 0; kind < ABBE_NOTE_KIND_COUNT; kind++) report->kinds[kind] += from->kinds[kind];
  for (size_t i = 0; i < from->count; i++) {
    abbe_note *note = room(report);
    if (note == NULL) return;
    *note = from->note[i];
    report->count++;
  }
}

const char *abbe_note_kind_word(abbe_note_kind kind) {
  static const char *const words[] = {
#define ABBE_NOTE_WORD(code, word) word,
      ABBE_NOTE_KINDS(ABBE_NOTE_WORD)
#undef ABBE_NOTE_WORD
  };
  return (int)kind >= 0 && kind < ABBE_NOTE_KIND_COUNT ? words[kind] : "unknown";
}
