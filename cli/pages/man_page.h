/* man_page.h: a manual page in roff, from a command's option table. */
#ifndef ABBE_CLI_PAGES_MAN_PAGE_H
#define ABBE_CLI_PAGES_MAN_PAGE_H

#include "cli/base/option_tables.h"

#include <stdio.h>

/* The page of a command or verb; of a command with verbs, the list of them. version: "0.1.0". */
void abbe_man_page_write(FILE *out, const abbe_option_table *table, const char *version);

/* The program's own page, in parts: what comes before the commands, one of them, and the rest. */
void abbe_man_page_begin(FILE *out, const char *version);
void abbe_man_page_command(FILE *out, const char *name, const char *summary);
void abbe_man_page_end(FILE *out);

/* abbe-mpi's, whose options are another page's. */
void abbe_man_page_ranks(FILE *out, const char *version);

#endif
