/* cut_file.h: a file of a design, of whatever kind: GemCad's text (.asc) and binary (.gem), Gem Cut
 * Studio's (.gcs). */
#ifndef ABBE_SCENES_CUTS_CUT_FILE_H
#define ABBE_SCENES_CUTS_CUT_FILE_H

#include "base/report.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

#define ABBE_CUT_MAX_FILE (16u << 20) /* bytes */

/* By its name's end. report (may be NULL) gets what was left out, changed or assumed.
 * ABBE_UNSUPPORTED for another ending; ABBE_IO, and errors of the kind's own. */
abbe_result abbe_cut_file_read(const char *path, abbe_cut *out, abbe_report *report,
                               abbe_error *error);

/* The same with its stone, whose corners nearer than the share weld of half its width are one: where
 * the planes make none, the error names the file. Both outputs are to be freed. */
abbe_result abbe_cut_file_read_stone(const char *path, double weld, abbe_cut *cut,
                                     abbe_cut_polyhedron *stone, abbe_report *report,
                                     abbe_error *error);

#endif
