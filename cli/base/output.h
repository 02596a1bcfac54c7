/* output.h: what the program says, as text that a terminal may show.
 *
 * Names and texts of files, of libraries and of the command line may hold what a terminal obeys.
 * Everything that is written to stdout or stderr, by whomever, becomes printable here
 * (base/text.h), so that no line of the program needs to think of it. Internal to cli/.
 */
#ifndef ABBE_CLI_BASE_OUTPUT_H
#define ABBE_CLI_BASE_OUTPUT_H

#include <stdio.h>

/* From now on stdout and stderr are streams that make text printable. Without memory for them they
 * stay as they are. */
void abbe_output_begin(void);

/* What lies beneath stdout and stderr, for the program's own control characters. */
FILE *abbe_output_raw(FILE *stream);

#endif
