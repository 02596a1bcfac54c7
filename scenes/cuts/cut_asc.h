/* cut_asc.h: GemCad's text files of designs (.asc), in and out.
 *
 * Files of other programs are met with a word out of place; it is left out and noted. Every index
 * is listed in such a file: its line of symmetry is for people. Lines may end in any way, and the
 * text be UTF-8 or Windows-1252.
 */
#ifndef ABBE_SCENES_CUTS_CUT_ASC_H
#define ABBE_SCENES_CUTS_CUT_ASC_H

#include "base/report.h"
#include "scenes/cuts/cut.h"

#include <stdio.h>

/* name is for messages; report (may be NULL) gets what was left out, changed or assumed.
 * ABBE_PARSE for what is no design, ABBE_SCHEMA for values that none has, with the line. */
abbe_result abbe_cut_asc_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

/* Windows-1252, lines that end with a newline. What is read back has the same planes: numbers have
 * GemCad's digits, or all that they need. report (may be NULL) gets what the format does not hold.
 */
abbe_result abbe_cut_asc_write(const abbe_cut *cut, FILE *to, abbe_report *report,
                               abbe_error *error);

#endif
