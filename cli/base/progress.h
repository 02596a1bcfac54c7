/* progress.h: a progress bar with the time left, on a terminal, for work over a second; and
 * whether the user asked to stop (Ctrl-C). Internal to cli/. */
#ifndef ABBE_CLI_BASE_PROGRESS_H
#define ABBE_CLI_BASE_PROGRESS_H

#include <stdbool.h>
#include <stdio.h>

typedef struct abbe_progress {
  const char *what;
  bool shown;  /* a bar stands on the terminal */
  bool silent; /* never show one */
  double start_s, last_s;
} abbe_progress;

/* Starts the clock and catches Ctrl-C, from then on until the program ends: between two works as
 * well; a second one ends it. A bar is shown only where stderr is a terminal. */
void abbe_progress_begin(abbe_progress *progress, const char *what, bool quiet);
/* `done` from 0 to 1; false where the user has asked to stop. Matches abbe_render_progress. */
bool abbe_progress_update(void *progress, double done);
/* Becomes other than 0 when the user stops the work, for work that polls it by itself. */
const volatile int *abbe_progress_stopped(void);
/* The same, and also after so many seconds from now, above 0; until abbe_progress_end. */
const volatile int *abbe_progress_stopped_after(double seconds);
/* Since the beginning, s. */
double abbe_progress_seconds(const abbe_progress *progress);
/* Clears the bar. */
void abbe_progress_end(abbe_progress *progress);

/* What the program says, as text that a terminal may show.
 *
 * Names and texts of files, of libraries and of the command line may hold what a terminal obeys.
 * Everything that is written to stdout or stderr, by whomever, becomes printable here
 * (base/text.h), so that no line of the program needs to think of it. */

/* From now on stdout and stderr are streams that make text printable. Without memory for them they
 * stay as they are. */
void abbe_output_begin(void);

/* What lies beneath stdout and stderr, for the program's own control characters. */
FILE *abbe_output_raw(FILE *stream);

#endif
